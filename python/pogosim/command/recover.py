"""`pogosim recover`, which is also `pogosim-recover`: makes a complete data file of a run that was killed."""

from __future__ import annotations

import os
from collections.abc import Sequence

from pogosim.command.parser import Parser, complain, say_of_complete
from pogosim.errors import ToolError
from pogosim.outputs import check_readable


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim-recover") -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be done, or nothing be said of it."""
    parser = Parser(prog=prog, description="Makes a complete file of a data file whose run was killed.")
    parser.add_argument("file", help="data file of the run")
    parser.add_argument("-o", "--output", help="file to write; without it, the data file is replaced")
    options = parser.parse_args(arguments)
    import pyarrow  # takes a while

    from pogosim.recover import recover

    try:
        check_readable([options.file])
        unfinished = recover(options.file, options.output)
    except ToolError as error:
        return complain(prog, error)
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else error
        return complain(prog, f"{error.filename or options.output or options.file}: {reason}")
    except (pyarrow.ArrowException, MemoryError) as error:
        reason = "there is not enough memory for its rows" if isinstance(error, MemoryError) else error
        return complain(prog, f"{options.file} cannot be recovered: {reason}")
    target = options.output or options.file
    return say_of_complete(prog, target, f"{target}: {unfinished.up_to}")
