"""How well a live run is seen through a line of some speed: pictures per second, and how old they are.

    .venv/bin/python bench/watching.py [--robots 1000] [--seconds 10]

Robots run and tumble on 22 % of the area, in real time. `pogosim watch` serves them to a viewer behind a line that
passes so many bytes per second on, and each of them after a delay, in both directions, as an ssh tunnel to a distant
machine does. A viewer takes pictures as the page does. `late` is by how much the newest picture that the viewer has is
older than the run, in simulated time, which is real time here.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import sys
import tempfile
import time
from pathlib import Path

try:
    import pogosim
    import yaml
    from pogosim.command.run import compile_shared_object
    from pogosim.command.watch import listening
    from pogosim.installation import find_installation
    from pogosim.watch.frames import FRAME, HEADER
    from pogosim.watch.live import LiveRun
    from pogosim.watch.server import WatchServer
    from pogosim.watch.serving import served_in_thread
    from websockets.asyncio.client import connect
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"watching.py: {missing}; run it with .venv/bin/python, which ./build.sh makes", file=sys.stderr)
    sys.exit(2)

from options import at_least_one, seconds

ROOT = Path(__file__).resolve().parents[1]
AREA_PER_ROBOT_MM2 = 1e4
WARM_UP_S = 2.0
PIECE_BYTES = 4096
# Bytes per second, and ms of delay in each direction; None: no limit.
LINES = ((None, 0), (2e6, 25), (200e3, 25), (50e3, 100))


class Line:
    """Passes bytes on between a viewer and the server, slower and later; counts those for the viewer."""

    def __init__(self, port: int, bytes_per_s: float | None, delay_ms: float) -> None:
        self._port, self._bytes_per_s, self._delay_s = port, bytes_per_s, delay_ms / 1e3
        self._back: set[asyncio.Task[None]] = set()
        self.taken = 0

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Take a connection of a viewer."""
        from_server, to_server = await asyncio.open_connection("127.0.0.1", self._port)
        self._back.add(asyncio.create_task(self._pass_on(reader, to_server, counts=False)))
        await self._pass_on(from_server, writer, counts=True)

    async def _pass_on(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, *, counts: bool) -> None:
        loop = asyncio.get_running_loop()
        while content := await reader.read(PIECE_BYTES):
            self.taken += len(content) if counts else 0
            if self._bytes_per_s is not None:
                await asyncio.sleep(len(content) / self._bytes_per_s)
            loop.call_later(self._delay_s, writer.write, content)
            await writer.drain()
        writer.close()


async def watched(
    simulation: pogosim.Simulation, address: str, port: int, way: tuple[float | None, float], seconds: float
) -> tuple[float, float, float, float]:
    """Look at the run; returns pictures and bytes per second, and the mean and the greatest lateness, s."""
    line = Line(port, *way)
    late_s: list[float] = []
    begin_s = time.perf_counter()
    async with await asyncio.start_server(line.serve, "127.0.0.1", 0) as near:
        own = near.sockets[0].getsockname()[1]
        async with connect(address.replace(f":{port}/", f":{own}/"), max_size=None) as viewer:
            async for message in viewer:
                if isinstance(message, str) or message[0] != FRAME:
                    continue
                _, _, number, time_s = HEADER.unpack_from(message)
                await viewer.send(json.dumps({"do": "shown", "frame": number}))
                now_s = time.perf_counter() - begin_s
                if now_s < WARM_UP_S:
                    line.taken = 0
                    continue
                late_s.append(simulation.time - time_s)
                if now_s > WARM_UP_S + seconds:
                    break
    return len(late_s) / seconds, line.taken / seconds, sum(late_s) / len(late_s), max(late_s)


def program_in(folder: Path) -> Path:
    """Compile the robots' program."""
    source = folder / "main.c"
    source.write_bytes((ROOT / "examples" / "run_and_tumble" / "main.c").read_bytes())
    return compile_shared_object(source, find_installation())


def main() -> None:
    """Measure all lines, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=at_least_one, default=1000)
    parser.add_argument("--seconds", type=seconds, default=10.0, help="of each line (default: %(default)s)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        configuration = Path(folder, "conf.yaml")
        settings = {
            "arena_file": "arenas/disk.csv",
            "arena_surface": options.robots * AREA_PER_ROBOT_MM2,
            "simulation_time": 1e5,
            "enable_data_logging": False,
            "seed": 1,
            "objects": {"robots": {"type": "pogobot", "nb": options.robots}},
        }
        configuration.write_text(yaml.safe_dump(settings))
        with pogosim.Simulation(program_in(Path(folder)), configuration) as simulation:
            live = LiveRun(simulation)
            live.play()
            server = WatchServer(live, "")
            with listening("127.0.0.1", 0) as own, served_in_thread(server, own):
                port = own.getsockname()[1]
                address = f"ws://127.0.0.1:{port}/live?token={server.tokens.look}"
                print("line          delay each way   pictures/s   kB/s   late, mean   late, at most")
                for way in LINES:
                    found = asyncio.run(watched(simulation, address, port, way, options.seconds))
                    print(row(way, *found), flush=True)
            live.end()


def row(way: tuple[float | None, float], pictures: float, taken: float, mean_s: float, most_s: float) -> str:
    """Return a row of the table."""
    bytes_per_s, delay_ms = way
    line = "this machine" if bytes_per_s is None else f"{bytes_per_s / 1e3:g} kB/s"
    numbers = f"{delay_ms:11g} ms {pictures:12.0f} {taken / 1e3:6.0f} {mean_s:10.2f} s {most_s:13.2f} s"
    return f"{line:12} {numbers}"


if __name__ == "__main__":
    main()
