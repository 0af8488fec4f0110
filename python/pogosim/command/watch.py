"""`pogosim watch`: runs a program, and shows it live in browsers."""

from __future__ import annotations

import argparse
import functools
import ipaddress
import math
import socket
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pogosim.command.parser import Parser, complain, guarded, positive, setting, warn, whole
from pogosim.command.run import (
    COMPILERS,
    RunError,
    compile_shared_object,
    configured,
    make_project,
)
from pogosim.errors import ToolError
from pogosim.extensions import let_find_models
from pogosim.extras import installing
from pogosim.firmware import is_firmware
from pogosim.installation import Installation, find_installation
from pogosim.lines import printable
from pogosim.simulation.errors import ProgramFailedError, SimulationError

if TYPE_CHECKING:
    from pogosim.simulation import Simulation
    from pogosim.watch.live import LiveRun
    from pogosim.watch.server import WatchServer
    from pogosim.watch.terminal import Signals

EPILOG = """PROGRAM is the folder of a project, a .c or .cpp file, a program or its shared object (.so), or a firmware
(.elf); without it, the configuration says what drives the robots. The page at the first address may steer the run, one
viewer at a time; the second address is for looking on. On a remote machine, run there

  pogosim watch PROGRAM -c CONFIG --port 8642

and here ssh -L 8642:127.0.0.1:8642 MACHINE, then open the address that was printed. Ctrl-C ends the run; its data file
is complete then."""
FIRST_PORT = 8642
MOST_PORTS = 50  # that are tried
MOST_SEED = 2**32 - 1
MOST_SPEED = 1e6
LOOK_S = 0.1  # from one look at whether it ends to the next
PROGRAM_FAILED = 3  # as a run of the program says it


class WatchError(ToolError):
    """The run cannot be shown; says why."""


def speed(text: str) -> float:
    """Return a speed: a positive number, or "max"."""
    if text == "max":
        return math.inf
    if (value := positive(text)) > MOST_SPEED:
        raise argparse.ArgumentTypeError(f"{text} is above {MOST_SPEED:g}; max goes as fast as it can")
    return value


def parser(prog: str) -> Parser:
    """Return the command line."""
    made = Parser(
        prog=prog,
        usage=f"{prog} [PROGRAM] -c CONFIG [OPTIONS]",
        description="Runs a program, and shows it live in browsers: play and pause, speed, parameters, lamps, robots.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument("program", metavar="PROGRAM", type=Path, nargs="?", help="see below")
    made.add_argument("-c", "--config", metavar="FILE", type=Path, help="configuration; default: conf/test.yaml in it")
    made.add_argument(
        "-s", "--seed", metavar="N", type=whole(0, MOST_SEED), help="random seed; default: that of the configuration"
    )
    made.add_argument(
        "--set",
        metavar="KEY=VALUE",
        type=setting,
        action="append",
        default=[],
        dest="settings",
        help="value of a key of the configuration, such as objects.robots.nb=50; may be repeated",
    )
    made.add_argument("--pause", action="store_true", help="begin paused")
    made.add_argument(
        "--speed", metavar="X", type=speed, default=1.0, help="times real time, or max (default: %(default)s)"
    )
    made.add_argument("--close", action="store_true", help="end when the simulated time is over")
    made.add_argument(
        "--port", metavar="N", type=whole(0, 65535), help=f"default: the first free one from {FIRST_PORT}; 0: any"
    )
    made.add_argument(
        "--address",
        metavar="IP",
        default="127.0.0.1",
        help="address to listen on; others than the default let other machines in (default: %(default)s)",
    )
    made.add_argument("--open", action="store_true", help="open the page in a browser")
    return made


def listening(address: str, port: int | None) -> socket.socket:
    """Return a socket that listens; port None: the first free one.

    Raises:
        WatchError: The address is none of this machine, or the port is taken.
    """
    from pogosim.watch import serving

    ports = range(FIRST_PORT, FIRST_PORT + MOST_PORTS) if port is None else [port]
    try:
        return serving.listening(address, ports)
    except ValueError:
        raise WatchError(f"--address: '{printable(address)}' is no IP address, such as 127.0.0.1") from None
    except OSError as error:
        which = f"ports {ports[0]} to {ports[-1]} of" if port is None else f"port {port} of"
        raise WatchError(f"cannot listen on {which} {address}: {error.strerror}") from None


def program_for(what: Path | None, pogosim: Installation) -> Path | None:
    """Return what `Simulation` takes as its program; None: the configuration says what drives the robots.

    Raises:
        ToolError: There is no program, or it cannot be built.
    """
    if what is None:
        return make_project(Path(), pogosim) if Path("Makefile").is_file() else None
    if what.is_dir():
        return make_project(what, pogosim)
    if not what.exists():
        raise RunError(f"there is no project, source file or program {what}")
    if what.suffix in COMPILERS:
        return compile_shared_object(what, pogosim)
    if what.suffix != ".so" and not is_firmware(what) and not what.with_name(f"{what.name}.so").is_file():
        raise RunError(
            f"{what} has no shared object {what.name}.so beside it, which is what runs in a browser: make sim"
        )
    return what


def configuration_for(options: argparse.Namespace) -> Path:
    """Return the configuration.

    Raises:
        WatchError: There is none.
    """
    if options.config is not None:
        return Path(options.config)
    what = options.program or Path()
    found = configured(what, [])
    if not found:
        raise WatchError("no configuration: name one with -c FILE")
    return Path(found[1])


def data_file_in(configuration: Path, settings: dict[str, Any]) -> tuple[str, bool]:
    """Return the data file that a configuration names, and whether a run of the program writes it."""
    from pogosim.yaml_1_2 import WRONG_VALUES, parse_yaml  # takes a while

    try:
        values = parse_yaml(configuration.read_text(encoding="utf-8"))
    except (*WRONG_VALUES, OSError):
        values = {}  # the simulator says what is wrong
    values = {**(values if isinstance(values, dict) else {}), **settings}
    return str(values.get("data_filename", "data.feather")), values.get("enable_data_logging", True) is not False


def watch(options: argparse.Namespace, prog: str) -> int:
    """Run the program and serve its page, until Ctrl-C."""
    try:
        from pogosim.watch.server import WatchServer
    except ModuleNotFoundError as error:
        if error.name != "websockets":
            raise
        raise WatchError(f"this needs the Python package 'websockets'; install it: {installing('watch')}") from None
    import asyncio  # takes a while

    from pogosim.simulation import Simulation
    from pogosim.watch.kept_files import keep_for_reset, kept_for_run
    from pogosim.watch.live import LiveRun
    from pogosim.watch.page import watch_page
    from pogosim.watch.terminal import Signals, told

    configuration = configuration_for(options)
    program = program_for(options.program, find_installation())
    let_find_models(functools.partial(warn, prog))
    settings = dict(options.settings)
    signals = Signals(prog)
    try:
        with listening(options.address, options.port) as own, told() as handler:
            data_file, is_written = data_file_in(configuration, settings)
            try:
                with kept_for_run(Path(data_file), is_written):
                    simulation = Simulation(
                        program, configuration, seed=options.seed, set=settings, data_file=data_file
                    )
            except SimulationError as error:
                raise WatchError(str(error)) from None
            if is_written:
                simulation._current.when_ended = functools.partial(keep_for_reset, simulation.data_file)
            live = LiveRun(simulation, one_steers=True)
            try:
                handler.tell(live)
                server = WatchServer(live, watch_page(f"{simulation.configuration.name} \u2013 Pogosim"))
                asyncio.run(serve(options, simulation, live, server, own, signals))
            finally:
                with signals.ending():
                    live.end()
                    is_open = simulation._current.run is not None
                    closed(simulation)
        return ended(simulation, live, prog, is_open and is_written)
    finally:
        signals.restore()


def closed(simulation: Simulation) -> None:
    """Complete the data file.

    Raises:
        WatchError: It cannot be written.
    """
    try:
        simulation.close()
    except SimulationError as error:
        raise WatchError(str(error)) from None


def ended(simulation: Simulation, live: LiveRun, prog: str, has_file: bool) -> int:
    """Say how it has ended; `has_file`: it has written a data file, and no reset has failed. Returns the exit code."""
    from pogosim.watch.terminal import print_out

    is_whole = live.failure is None or isinstance(live.failure, ProgramFailedError)
    if has_file and is_whole and simulation.data_file.is_file():
        print_out(f"{simulation.data_file} is complete.")
    if live.failure is None:
        return 0
    complain(prog, live.status.problem)
    return PROGRAM_FAILED if isinstance(live.failure, ProgramFailedError) else WatchError.exit_code


async def serve(
    options: argparse.Namespace,
    simulation: Simulation,
    live: LiveRun,
    server: WatchServer,
    own: socket.socket,
    signals: Signals,
) -> None:
    """Serve until a signal, or the end of the run if that is wanted."""
    import asyncio

    from pogosim.watch.serving import address_of
    from pogosim.watch.terminal import print_out

    async with server.serving(own):
        steering = address_of(own, server.tokens.steer)
        print_out(f"To steer:   {steering}", f"To look on: {address_of(own, server.tokens.look)}")
        if not ipaddress.ip_address(own.getsockname()[0]).is_loopback:
            print_out("Other machines can connect. What is sent is not encrypted: an ssh tunnel does that.")
        if options.open:
            webbrowser.open(steering)
        live.set_speed(options.speed)
        if not options.pause:
            live.play()
        while not signals.is_wanted and live.is_alive:
            await asyncio.sleep(LOOK_S)
            if options.close and (simulation.is_over or live.failure is not None):
                break


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim watch") -> int:
    """Run the command; returns 0, 3 if the program failed, or 2 if nothing could be shown."""
    options = parser(prog).parse_args(arguments)
    return guarded(prog, lambda: watch(options, prog), options.config or options.program or ".")
