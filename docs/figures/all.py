"""Draws the pictures of docs/, or tells which of them are out of date.

    .venv/bin/python docs/figures/all.py            # draws all
    .venv/bin/python docs/figures/all.py gallery    # draws those of docs/figures/gallery.py
    .venv/bin/python docs/figures/all.py --check    # draws none; exit code 1 if any shows what no longer is so

Needs the examples (./build.sh). What a run does, to the last bit, depends on the compiler and the C library: the
pictures are those of Debian 12 on x86-64. Those of docs/optimization.md take much longer, so docs/figures/tune.py draws
them.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path
from types import ModuleType

try:
    import analysis_tour
    import first_program
    import formations
    import gallery
    import lamps
    import messages
    import parameter_study
    import reception
    import replay
    import swarm
    import validation
    import window
    from pictures import DOCS, difference, keep
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"all.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

SCRIPTS: dict[str, ModuleType] = {
    script.__name__: script
    for script in (
        analysis_tour,
        first_program,
        formations,
        gallery,
        lamps,
        messages,
        parameter_study,
        reception,
        replay,
        swarm,
        validation,
        window,
    )
}


def main() -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SCRIPTS)}; without: all")
    parser.add_argument("--check", action="store_true", help="compare with the pictures that are there; draw none")
    options = parser.parse_args()
    if unknown := sorted(set(options.names) - set(SCRIPTS)):
        parser.error(f"no script draws {', '.join(unknown)}; there are {', '.join(SCRIPTS)}")
    found = 0
    for name in options.names or SCRIPTS:
        with tempfile.TemporaryDirectory() as folder:
            for file, picture in SCRIPTS[name].draw(Path(folder)).items():
                if not options.check:
                    keep(picture, DOCS / file)
                elif text := difference(DOCS / file, picture):
                    print(text)
                    found += 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
