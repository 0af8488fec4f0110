"""`pogosim join`: makes one data file of the parts of a run that went on from saved states."""

from __future__ import annotations

from collections.abc import Sequence

from pogosim.command.parser import Parser, complain, say_of_complete
from pogosim.errors import ToolError
from pogosim.outputs import told


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim join") -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be done, or nothing be said of it."""
    parser = Parser(
        prog=prog,
        description="Makes one data file, or message log, of the parts of a run that went on from saved states, as of "
        "a run that was never interrupted: rows after a state are those of the later part.",
    )
    parser.add_argument("parts", metavar="PART", nargs="+", help="file of a part; their order does not matter")
    parser.add_argument(
        "-o", "--output", metavar="FILE", required=True, help="file to write, in the format of its name"
    )
    options = parser.parse_args(arguments)
    import pyarrow  # takes a while

    from pogosim.join import join

    try:
        joined = join(options.parts, options.output)
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        return complain(prog, told(error, options.output))
    except (pyarrow.ArrowException, MemoryError) as error:
        reason = "there is not enough memory for their rows" if isinstance(error, MemoryError) else error
        return complain(prog, f"the parts cannot be joined: {reason}")
    left_out = (f"{path}: not needed, other parts have its rows" for path in joined.left_out)
    return say_of_complete(prog, options.output, f"{options.output}: {joined.told}", *left_out)
