"""`pogosim profile`: where the cycles of a tick go, by a run of the robots' firmware on emulated processors."""

from __future__ import annotations

import argparse
import contextlib
import functools
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from pogosim.command.parser import Parser, complain, guarded, warn, whole
from pogosim.command.run import configured, has_configuration
from pogosim.extensions import let_find_models
from pogosim.firmware.profile.flame import write_flame
from pogosim.firmware.profile.function_costs import write_function_costs
from pogosim.firmware.profile.inputs import check_outputs, inputs_of, sources_in
from pogosim.firmware.profile.raw import Profile, ProfileError, read_profile
from pogosim.firmware.profile.report import report_of
from pogosim.firmware.profile.sources import Sources, folders_of
from pogosim.firmware.profile.table import write_table
from pogosim.firmware.profile.trace import write_trace
from pogosim.installation import find_installation
from pogosim.lines import say
from pogosim.outputs import OutputError, checked_output, leads_to, partial_output

EPILOG = """PROGRAM is a firmware (.elf), the folder of a project or a .c or .cpp file, whose firmware is made first
(make emu), or a profile that was kept (--raw), to report it again. Without an output, the report is printed.

All other options are the simulator's: -c CONFIG, -s SEED, --set KEY=VALUE and others. Without -c, a project is run with
its conf/test.yaml. The run has no window, and writes no data file."""

# The outputs, by option: how their names end, and what writes them.
WRITERS: dict[str, tuple[str, Callable[[Profile, Path], None]]] = {
    "csv": ("csv", write_table),
    "flame": ("svg", write_flame),
    "trace": ("json", write_trace),
    "costs": ("yaml", write_function_costs),
}


class FailedError(Exception):
    """The simulator has ended with an exit code other than 0, and has said why."""

    def __init__(self, code: int) -> None:
        """Keep the exit code."""
        super().__init__(code)
        self.code = code


@dataclass(frozen=True)
class Measured:
    """A profile, its file, and the folders in which the source files of its program may be."""

    profile: Profile
    file: Path
    folders: tuple[Path, ...]


def parser(prog: str) -> Parser:
    """Return the command line, without PROGRAM and the options of the simulator."""
    made = Parser(
        prog=prog,
        usage=f"{prog} PROGRAM -c CONFIG [OPTIONS] [OPTIONS OF THE SIMULATOR]",
        description="Runs the firmware of robots, and tells where the cycles of a tick go: functions, lines, memory, "
        "and what could be faster.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        add_help=False,
        allow_abbrev=False,
    )
    made.add_argument(
        "--robots",
        metavar="N",
        type=whole(1),
        default=1,
        help="robots to profile, the first ones (default: %(default)s)",
    )
    made.add_argument("--text", action="store_true", help="print the report, also if files are written")
    made.add_argument("--csv", metavar="FILE.csv", help="write functions and lines as one table")
    made.add_argument("--flame", metavar="FILE.svg", help="write a flame graph")
    made.add_argument("--trace", metavar="FILE.json", help="write the first ticks for Perfetto or chrome://tracing")
    made.add_argument(
        "--costs", metavar="FILE.yaml", help="write what functions take, for programs in C (function_costs)"
    )
    made.add_argument("--raw", metavar="FILE.json", help="keep the profile as the simulator writes it")
    return made


def outputs_of(options: argparse.Namespace, program: Path) -> dict[str, Path]:
    """Return where to write, by option, in the order of WRITERS.

    Raises:
        OutputError: A file cannot be written there, two are the same, or one would take the place of the program.
        OSError: A place cannot be looked at.
    """
    endings = {name: ending for name, (ending, _) in WRITERS.items()} | {"raw": "json"}
    outputs: dict[str, Path] = {}
    for name, ending in endings.items():
        if (given := getattr(options, name)) is None:
            continue
        output = checked_output(given, str(program), [ending])
        if twin := next((other for other, path in outputs.items() if leads_to(path, output)), None):
            raise OutputError(f"--{twin} and --{name} name the same file, {given}")
        outputs[name] = output
    return outputs


@contextlib.contextmanager
def measured(program: Path, robots: int, options: Sequence[str], outputs: dict[str, Path]) -> Iterator[Measured]:
    """Run a program and read its profile, or read that of an earlier run; its file is there until the end of the block.

    Raises:
        ToolError: There is no such program, or no profile of it; or an output would take the place of an input.
        FailedError: The run has failed.
        OSError: A file cannot be read.
    """
    if program.suffix == ".json":
        if options:
            raise ProfileError(f"{program} is the profile of a run that is over: expected no options of the simulator")
        profile = read_profile(program)
        folders = (*folders_of(Path(profile.firmware)), program.absolute().parent)
        check_outputs(outputs, sources_in(folders))
        yield Measured(profile, program, folders)
        return
    from pogosim.firmware.making import firmware_of
    from pogosim.firmware.profile.running import profile_run

    chosen = configured(program, options)
    if not has_configuration(chosen):
        raise ProfileError("expected a configuration: -c CONFIG")
    pogosim = find_installation()
    check_outputs(outputs, inputs_of(program, chosen, pogosim))
    with tempfile.TemporaryDirectory(prefix="pogosim-profile-") as folder, firmware_of(program, pogosim) as made:
        raw = Path(folder, "profile.json")
        code = profile_run(made.firmware, raw, robots, chosen, pogosim)
        if code != 0:
            raise FailedError(code)
        yield Measured(read_profile(raw, "the profile of this run"), raw, made.folders)


def write(measurement: Measured, outputs: dict[str, Path]) -> None:
    """Write files, by option.

    Raises:
        ProfileError: The profile lacks what one of them shows.
        OSError: One cannot be written.
    """
    for name, output in outputs.items():
        with partial_output(output) as partial:
            if name == "raw":
                shutil.copyfile(measurement.file, partial)
            else:
                WRITERS[name][1](measurement.profile, partial)


def run(program: Path, options: argparse.Namespace, of_simulator: Sequence[str]) -> int:
    """Profile a program, and write what is asked for: without an output, the report. Returns the exit code.

    Raises:
        ToolError: It cannot be done.
        OSError: A file cannot be read or written.
    """
    outputs = outputs_of(options, program)
    try:
        with measured(program, options.robots, of_simulator, outputs) as measurement:
            write(measurement, outputs)
            if options.text or not outputs:
                say(*report_of(measurement.profile, Sources(measurement.folders)))
    except FailedError as failed:
        return failed.code
    return 0


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim profile") -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be done, others are the simulator's."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    commands = parser(prog)
    if any(option in ("-h", "--help") for option in given):
        commands.print_help()
        return 0
    if not given or given[0].startswith("-"):
        return complain(
            prog,
            "expected a firmware (.elf), the folder of a project, a .c file or a profile (.json) as the first word",
        )
    program = Path(given.pop(0))
    options, of_simulator = commands.parse_known_args(given)
    let_find_models(functools.partial(warn, prog))
    return guarded(prog, lambda: run(program, options, of_simulator), program)
