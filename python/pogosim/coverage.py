"""Voronoi cells and coverage: functions for scripts, see `pogosim.compat`.

`python -m pogosim.coverage` is `pogosim analyze coverage`.
"""

from pogosim.compat import attributes, command

__getattr__ = attributes("coverage")
main = command("coverage")

if __name__ == "__main__":
    raise SystemExit(main())
