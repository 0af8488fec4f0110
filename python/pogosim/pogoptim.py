"""Search for the parameters of a program that make an objective as large as possible.

    pogoptim -c conf/optim/simple.yaml -S ./examples/run_and_tumble/run_and_tumble -r 5 --max-evals 20

`python -m pogosim.pogoptim` is the same command.
"""

from __future__ import annotations

import sys

from pogosim.command.main import pogoptim
from pogosim.errors import OptimizeError
from pogosim.optimize.command import main
from pogosim.optimize.objective import fd_fn, objective_fn

__all__ = ["OptimizeError", "fd_fn", "main", "objective_fn"]

if __name__ == "__main__":
    sys.exit(pogoptim())
