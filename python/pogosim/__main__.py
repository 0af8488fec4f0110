"""`python -m pogosim` is the command `pogosim`."""

from __future__ import annotations

import sys

from pogosim.command.main import main

sys.exit(main())
