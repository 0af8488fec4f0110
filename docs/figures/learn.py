"""The figure and the numbers of docs/learning.md: learns as the page says, and draws the learning curves.

    .venv/bin/python docs/figures/learn.py           # a minute on two cores
    .venv/bin/python docs/figures/learn.py --keep    # also draws, and writes the numbers into the page

What CMA-ES finds depends on the last bits of the linear algebra, which differ between processors, so no test compares
the picture.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

try:
    import pandas as pd
    from pictures import DOCS, ROOT, from_figure, keep
    from quotes import quote
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"learn.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

sys.path.append(str(ROOT / "examples" / "learning"))

NAMES = ("learning.png",)  # pictures that --keep draws


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--keep", action="store_true", help="keep picture and numbers in docs/")
    options = parser.parse_args(arguments)
    try:
        import train  # needs the extra 'learning'
    except ImportError as missing:
        print(f"learn.py: {missing}", file=sys.stderr)
        return 2

    results = {name: train.learnt(name) for name in train.TASKS}
    lines = [line for name, learnt in results.items() for line in train.summary(name, learnt)]
    print(*lines, sep="\n")
    if options.keep:
        tables = [pd.DataFrame(learnt.curve).add_prefix("test_") for learnt in results.values()]
        keep(from_figure(train.figure_of(results), 80, *tables), DOCS / NAMES[0])
        quote(DOCS / "learning.md", "returns", lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
