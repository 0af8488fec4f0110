"""How robots move: functions for scripts, see `pogosim.compat`.

`python -m pogosim.locomotion` is `pogosim analyze locomotion`.
"""

from pogosim.compat import attributes, command

__getattr__ = attributes("locomotion")
main = command("locomotion", "locomotion")

if __name__ == "__main__":
    raise SystemExit(main())
