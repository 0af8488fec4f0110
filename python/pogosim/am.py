"""Collective order of swarms: functions for scripts, see `pogosim.compat`.

`python -m pogosim.am` is `pogosim analyze collective`.
"""

from pogosim.compat import attributes, command

__getattr__ = attributes("am")
main = command("am")

if __name__ == "__main__":
    raise SystemExit(main())
