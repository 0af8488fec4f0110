"""Runs the scenes of docs/validation.md, and tells whether the simulator gives what theory says.

    .venv/bin/python docs/figures/validate.py                    # all; takes several minutes
    .venv/bin/python docs/figures/validate.py --quick vicsek     # one scene with fewer runs, wider tolerances

docs/figures/all.py writes the numbers into the page, and draws. The exit code is 1 if a scene disagrees, 2 if one
cannot run. Needs the library and the examples (./build.sh).
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

try:
    from validation import SCENES
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"validate.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SCENES)}; without: all")
    parser.add_argument("--quick", action="store_true", help="fewer runs")
    options = parser.parse_args(arguments)
    if unknown := sorted(set(options.names) - set(SCENES)):
        parser.error(f"no scene is called {', '.join(unknown)}; there are {', '.join(SCENES)}")
    disagreements = 0
    for name in options.names or SCENES:
        start_s = time.monotonic()
        try:
            with tempfile.TemporaryDirectory() as folder:
                outcome = SCENES[name](Path(folder), options.quick)
        except (FileNotFoundError, subprocess.CalledProcessError) as error:
            print(f"{name}: {error}. ./build.sh builds the library and the examples", file=sys.stderr)
            return 2
        print(f"{name} ({time.monotonic() - start_s:.0f} s)", *outcome.lines, sep="\n", flush=True)
        disagreements += sum(not comparison.agrees for comparison in outcome.comparisons)
    return 1 if disagreements else 0


if __name__ == "__main__":
    sys.exit(main())
