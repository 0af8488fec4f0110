"""`pogosim recover`, which is also `pogosim-recover`: makes a complete data file of a run that was killed."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from pogosim.command.parser import Parser
from pogosim.outputs import OutputError, say


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim-recover") -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be done, or nothing be said of it."""
    parser = Parser(prog=prog, description="Makes a complete Feather file of a data file whose run was killed.")
    parser.add_argument("file", help="data file of the run")
    parser.add_argument("-o", "--output", help="file to write; without it, the data file is replaced")
    options = parser.parse_args(arguments)
    import pyarrow  # takes a while

    from pogosim.recover import RecoverError, recover

    try:
        unfinished = recover(options.file, options.output)
    except (RecoverError, OutputError) as error:
        print(f"{prog}: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else error
        print(f"{prog}: {error.filename or options.file}: {reason}", file=sys.stderr)
        return 2
    except (pyarrow.ArrowException, MemoryError) as error:
        reason = "there is not enough memory for its rows" if isinstance(error, MemoryError) else error
        print(f"{prog}: {options.file} cannot be recovered: {reason}", file=sys.stderr)
        return 2
    target = options.output or options.file
    try:
        say(f"{target}: {unfinished.up_to}")
    except OSError as error:
        print(
            f"{prog}: {target} is complete, but the standard output cannot be written: {error.strerror}",
            file=sys.stderr,
        )
        return 2
    return 0
