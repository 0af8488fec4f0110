"""`python -m pogosim.fit_communication_profile`: fits the article's equation to the robots' own measurements.

The name that other scripts call; `pogosim fit-comm` has the options.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from pogosim.command.main import ended
from pogosim.communication import fit_command

# As its authors have fitted it. Residuals of probabilities are at most 1, so that this loss is least squares.
DEFAULTS = ("--objective", "huber", "--huber-delta", "1.35", "-o", ".")


def main(arguments: Sequence[str] | None = None, prog: str = "fit_communication_profile") -> int:
    """Run the command: results and pictures go to the working folder. Options are those of `pogosim fit-comm`."""
    return fit_command.main([*DEFAULTS, *(sys.argv[1:] if arguments is None else arguments)], prog)


if __name__ == "__main__":
    sys.exit(ended("fit_communication_profile", main))
