"""`python -m pogosim` is the command `pogosim`."""

from __future__ import annotations

import sys

from pogobot_simulator import pogosim

sys.exit(pogosim())
