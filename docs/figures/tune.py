"""Runs the searches of docs/optimization.md, and tells whether they find what they must.

    .venv/bin/python docs/figures/tune.py                    # all; takes half an hour on two cores
    .venv/bin/python docs/figures/tune.py --quick archive    # one scene with fewer evaluations

docs/figures/all.py writes the numbers into the page, and draws. The exit code is 1 if a search does not find it, 2 if
one cannot run. Needs the library and the examples (./build.sh).
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
    from tuning import SCENES
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"tune.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SCENES)}; without: all")
    parser.add_argument("--quick", action="store_true", help="fewer searches and evaluations")
    options = parser.parse_args(arguments)
    if unknown := sorted(set(options.names) - set(SCENES)):
        parser.error(f"no scene is called {', '.join(unknown)}; there are {', '.join(SCENES)}")
    wrong = 0
    for name in options.names or SCENES:
        start_s = time.monotonic()
        try:
            with tempfile.TemporaryDirectory() as folder:
                outcome = SCENES[name](Path(folder), options.quick)
        except FileNotFoundError as error:
            print(f"{name}: {error}. ./build.sh builds the library and the examples", file=sys.stderr)
            return 2
        except subprocess.CalledProcessError as error:
            said = (error.stderr or b"").decode(errors="replace")
            print(f"{name}: {error}", said, sep="\n", file=sys.stderr)
            return 2
        print(f"{name} ({time.monotonic() - start_s:.0f} s)", *outcome.quoted, sep="\n", flush=True)
        wrong += sum(not claim.is_true for claim in outcome.claims)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
