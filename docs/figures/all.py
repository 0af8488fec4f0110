"""Renews all pictures, tables and texts of the pages that a program makes, or tells which of them are out of date.

    .venv/bin/python docs/figures/all.py            # renews all that is out of date; then look at the pictures
    .venv/bin/python docs/figures/all.py gallery    # makes those of docs/figures/gallery.py anew
    .venv/bin/python docs/figures/all.py --check    # writes nothing; exit code 1 if any is out of date
    .venv/bin/python docs/figures/all.py --times    # measures all times, on a machine that does nothing else

Needs the examples (./build.sh). What a run does, to the last bit, depends on the compiler and the C library: the
pictures are those of Debian 12 on x86-64. Studies of many runs (docs/optimization.md, validation.md, learning.md,
learners.md) take up to half an hour each, so a short run of each tells whether they are out of date, and only then the
whole is repeated.
Times are never out of date by themselves; pages tell when, where and with which version they were measured.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType

try:
    import analysis_tour
    import blocked
    import compass
    import exported_policy
    import extras
    import first_program
    import formations
    import functions
    import gallery
    import lamps
    import libraries
    import linked
    import live
    import loads
    import magnetometer
    import messages
    import mistakes
    import moving_partition
    import original
    import parameter_study
    import printed
    import reception
    import replay
    import shadows
    import shapes_of_bodies
    import sim_to_real
    import swarm
    import views
    import window
    from pictures import DOCS, Picture, difference, keep
    from quotes import Quote, keep_quote, quote_difference
    from studies import STUDIES
    from times import TIMES

    import models
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"all.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

SCRIPTS: dict[str, ModuleType] = {
    script.__name__: script
    for script in (
        analysis_tour,
        blocked,
        compass,
        exported_policy,
        extras,
        first_program,
        formations,
        functions,
        gallery,
        lamps,
        libraries,
        linked,
        live,
        loads,
        magnetometer,
        messages,
        mistakes,
        models,
        moving_partition,
        original,
        parameter_study,
        printed,
        reception,
        replay,
        shadows,
        shapes_of_bodies,
        sim_to_real,
        swarm,
        views,
        window,
    )
}


def keep_in_docs(made: Mapping[str, Picture | Quote]) -> None:
    """Write pictures, and texts into their pages."""
    for name, thing in made.items():
        if isinstance(thing, Picture):
            keep(thing, DOCS / name)
        else:
            keep_quote(name, DOCS / name.partition(": ")[0], thing)


def differences(made: Mapping[str, Picture | Quote]) -> list[str]:
    """Tell which pictures and texts of the pages are no longer what a program makes."""
    found = [
        difference(DOCS / name, thing)
        if isinstance(thing, Picture)
        else quote_difference(name, DOCS / name.partition(": ")[0], thing)
        for name, thing in made.items()
    ]
    return [text for text in found if text]


def renew(name: str, is_asked_for: bool) -> None:
    """Make anew what a script, a study or a measurement makes; a study only if it is out of date or asked for."""
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as other_folder:
        if name in SCRIPTS:
            keep_in_docs(SCRIPTS[name].draw(Path(folder)))
        elif name in TIMES:
            keep_in_docs(TIMES[name].measured(Path(folder)))
        else:
            study = STUDIES[name]
            short = study.short(Path(folder))
            if is_asked_for or differences({study.quote: Quote((), short)}):
                keep_in_docs(study.renewed(Path(other_folder), short))


def check(name: str) -> list[str]:
    """Tell what of a script or a study is out of date."""
    with tempfile.TemporaryDirectory() as folder:
        if name in SCRIPTS:
            return differences(SCRIPTS[name].draw(Path(folder)))
        study = STUDIES[name]
        return differences({study.quote: Quote((), study.short(Path(folder)))})


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    every = [*SCRIPTS, *STUDIES, *TIMES]
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(every)}; without: all but times")
    parser.add_argument("--check", action="store_true", help="write nothing, and tell what is out of date")
    parser.add_argument("--times", action="store_true", help="measure all times")
    options = parser.parse_args(arguments)
    if unknown := sorted(set(options.names) - set(every)):
        parser.error(f"no script makes {', '.join(unknown)}; there are {', '.join(every)}")
    if options.check and (options.times or set(options.names) & set(TIMES)):
        parser.error("times cannot be checked, only measured")
    names = options.names or (TIMES if options.times else [*SCRIPTS, *STUDIES])
    found = 0
    for name in names:
        print(name, file=sys.stderr, flush=True)
        if options.check:
            for text in check(name):
                print(text)
                found += 1
        else:
            renew(name, bool(options.names))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
