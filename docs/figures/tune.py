"""Runs the searches of docs/optimization.md, and tells whether they find what they must.

    .venv/bin/python docs/figures/tune.py                    # all; takes half an hour on two cores
    .venv/bin/python docs/figures/tune.py --quick archive    # one scene with fewer evaluations
    .venv/bin/python docs/figures/tune.py --keep             # also draws, and writes the numbers into the page

The exit code is 1 if a search does not find it, 2 if one cannot run. Needs the library and the examples (./build.sh).
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
    from pictures import DOCS, from_figure, keep
    from quotes import quote
    from tuning import SCENES
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"tune.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

PAGE = DOCS / "optimization.md"
NAMES = ("tuning_archive.png", "tuning_phototaxis.png")  # pictures that --keep draws


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SCENES)}; without: all")
    parser.add_argument("--quick", action="store_true", help="fewer searches and evaluations")
    parser.add_argument("--keep", action="store_true", help="keep pictures and numbers in docs/")
    options = parser.parse_args(arguments)
    if unknown := sorted(set(options.names) - set(SCENES)):
        parser.error(f"no scene is called {', '.join(unknown)}; there are {', '.join(SCENES)}")
    if options.quick and options.keep:
        parser.error("--keep needs whole searches, not --quick")
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
        if options.keep:
            quote(PAGE, name, outcome.quoted)
            if outcome.figure is not None:
                keep(from_figure(outcome.figure, 110, *outcome.tables), DOCS / f"tuning_{name}.png")
        wrong += sum(not claim.is_true for claim in outcome.claims)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
