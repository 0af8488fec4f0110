"""Proximity graphs: functions for scripts, see `pogosim.compat`.

`python -m pogosim.network` is `pogosim analyze network`.
"""

from pogosim.compat import attributes, command

__getattr__ = attributes("network")
main = command("network")

if __name__ == "__main__":
    raise SystemExit(main())
