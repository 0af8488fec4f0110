"""Neighbours of robots: functions for scripts, see `pogosim.compat`.

`python -m pogosim.neighbors` is `pogosim analyze neighbors`.
"""

from pogosim.compat import attributes, command

__getattr__ = attributes("neighbors")
main = command("neighbors")

if __name__ == "__main__":
    raise SystemExit(main())
