"""`python -m pogosim` is the command `pogosim`."""

from __future__ import annotations

import sys

from pogosim.command.main import pogosim_command

sys.exit(pogosim_command())
