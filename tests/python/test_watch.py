"""`pogosim watch`: the page, which viewers are let in, what hostile clients get, and the data file."""

from __future__ import annotations

import contextlib
import functools
import http.client
import json
import os
import random
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from in_process import pogosim, refusal
from live_client import Client, wait_for
from pogosim.simulation import Simulation
from pogosim.utils import load_dataframe
from pogosim.watch.server import MOST_CONNECTIONS, Tokens
from pogosim.watch.serving import LivePage
from running import ROOT, write_scene
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

COMMAND = (sys.executable, "-m", "pogosim", "watch")


@dataclass
class Served:
    """A `pogosim watch` that runs."""

    process: subprocess.Popen[str]
    port: int
    steer: str  # token
    look: str
    folder: Path
    viewers: list[Viewer] = field(default_factory=list)

    def view(self, token: str | None = None, port: int | None = None) -> Viewer:
        """Let a viewer look, until the test ends."""
        self.viewers.append(Viewer(self.address(token).replace(f":{self.port}/", f":{port or self.port}/")))
        return self.viewers[-1]

    def address(self, token: str | None = None) -> str:
        return f"ws://127.0.0.1:{self.port}/live?token={token or self.steer}"

    def get(self, path: str, **headers: str) -> tuple[int, str, dict[str, str]]:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        found = answer.status, answer.read().decode(), {key.lower(): value for key, value in answer.getheaders()}
        connection.close()
        return found

    def end(self, number: int = signal.SIGINT) -> str:
        """End it; returns what it has said since."""
        self.process.send_signal(number)
        said, _ = self.process.communicate(timeout=30)
        assert self.process.returncode == 0, said
        return said


def started(folder: Path, *arguments: str) -> Served:
    environment = {**os.environ, "POGOSIM_DIR": str(ROOT), "PYTHONUNBUFFERED": "1"}
    process = subprocess.Popen(
        [*COMMAND, *arguments], cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    assert process.stdout is not None
    addresses: list[str] = []
    said = []
    for line in process.stdout:
        said.append(line)
        addresses += re.findall(r"http://\S+", line)
        if len(addresses) == 2:
            break
    assert len(addresses) == 2, "".join(said)
    found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)", addresses[0])
    assert found is not None
    port, steer = found.groups()
    return Served(process, int(port), steer, addresses[1].split("token=")[1], folder)


@contextlib.contextmanager
def serving(folder: Path, *arguments: str) -> Iterator[Served]:
    served = started(folder, *arguments)
    try:
        yield served
    finally:
        served.process.kill()
        served.process.communicate(timeout=30)
        for viewer in served.viewers:
            viewer.close()


SETTINGS = {
    "simulation_time": 30.0,
    "objects.robots.nb": 20,
    "objects.lamp": {"type": "static_light", "geometry": "global", "value": 100},
    "parameters": {"gain": 2.0},
}


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return write_scene(tmp_path, SETTINGS)


@pytest.fixture
def served(hosted: Path, scene: Path, tmp_path: Path) -> Iterator[Served]:
    with serving(tmp_path, str(hosted), "-c", str(scene), "--port", "0", "--pause") as own:
        yield own


def opened(address: str, **options: Any) -> ClientConnection:
    """Open a websocket, which its user closes."""
    connection: ClientConnection = connect(address, max_size=None, **options).__enter__()
    return connection


@pytest.fixture(scope="module")
def server(hosted: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder = tmp_path_factory.mktemp("shared")
    scene = write_scene(folder, SETTINGS)
    with serving(folder, str(hosted), "-c", str(scene), "--port", "0", "--pause") as own:
        yield own


@pytest.fixture
def shared(server: Served) -> Iterator[Served]:
    """One that tests share which leave it as it is."""
    yield server
    for viewer in server.viewers:
        viewer.close()
    server.viewers.clear()


class Viewer(Client):
    """A viewer by a websocket, which answers at once."""

    def __init__(self, address: str, **options: Any) -> None:
        super().__init__()
        self.socket = opened(address, **options)
        self.thread = threading.Thread(target=self._read, daemon=True)
        self.thread.start()
        wait_for(lambda: self.pictures)

    def _read(self) -> None:
        with contextlib.suppress(ConnectionClosed):
            for message in self.socket:
                self.take(message if isinstance(message, bytes) else json.loads(message))
                if isinstance(message, bytes) and message[0] == 1:
                    self.do("shown", frame=self.last.number)

    def do(self, name: str, /, **values: Any) -> None:
        self.socket.send(json.dumps({"do": name, **values}))

    def close(self) -> None:
        self.socket.close()
        self.thread.join(10)


def test_page_is_served_to_those_with_a_token(shared: Served) -> None:
    for token in (shared.steer, shared.look):
        status, page, headers = shared.get(f"/?token={token}")
        assert status == 200
        assert headers["content-type"] == "text/html; charset=utf-8"
        assert page.startswith("<!DOCTYPE html>")
        assert "swarmView" in page
        assert not re.search(r"(src|href)=\"http", page)
    assert headers["x-frame-options"] == "DENY"
    assert headers["referrer-policy"] == "no-referrer"


WRONG_PATHS = (
    "/",
    "/?token=",
    "/?token=wrong",
    "/?token=a&token=b",
    "/live",
    "/?",
    "/?TOKEN={steer}",
    "/?token={steer}x",
)


@pytest.mark.parametrize("path", WRONG_PATHS)
def test_nothing_is_served_without_the_token(shared: Served, path: str) -> None:
    status, text, _ = shared.get(path.format(steer=shared.steer))
    assert (status, text) == (403, "The address lacks the token that pogosim watch has printed.\n")


def test_there_is_nothing_else(shared: Served) -> None:
    for path in (f"/etc/passwd?token={shared.steer}", f"/../page?token={shared.steer}", "/favicon.ico"):
        assert shared.get(path)[0] == 404


def test_sockets_need_a_token_and_a_page_of_this_server(shared: Served) -> None:
    own, through_tunnel = f"127.0.0.1:{shared.port}", "localhost:9000"
    good: list[dict[str, str]] = [{}, {"Origin": f"http://{own}"}]
    bad = [{"Origin": "http://evil.example"}, {"Origin": "null"}, {"Origin": f"http://{own}.evil.example"}]
    for headers in good:
        opened(shared.address(), additional_headers=headers).close()
    for headers in bad:
        with pytest.raises(InvalidStatus) as refused:
            opened(shared.address(), additional_headers=headers)
        assert refused.value.response.status_code == 403
    for token in ("wrong", shared.steer[:-1], shared.look + shared.steer):
        with pytest.raises(InvalidStatus):
            opened(shared.address(token))
    request = (
        f"GET /live?token={shared.steer} HTTP/1.1\r\nHost: {through_tunnel}\r\nOrigin: http://{through_tunnel}\r\n"
        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
    with socket.create_connection(("127.0.0.1", shared.port), timeout=20) as raw:
        raw.sendall(request.encode())
        assert raw.recv(4096).startswith(b"HTTP/1.1 101")


def test_tokens_differ_and_give_their_rights() -> None:
    one, other = Tokens(), Tokens()
    assert len({one.steer, one.look, other.steer, other.look}) == 4
    assert (one.rights(one.steer), one.rights(one.look)) == (True, False)
    for token in ("", other.steer, "\udcff", "é", one.steer + "\0"):
        assert one.rights(token) is None


def test_viewers_steer_one_at_a_time_and_look_on(served: Served) -> None:
    first, second, reader = served.view(), served.view(), served.view(served.look)
    wait_for(lambda: reader.status["viewers"] == 3)
    assert [own.status["steers"] for own in (first, second, reader)] == [True, False, False]
    first.do("step", steps=25)
    viewers = (first, second, reader)
    wait_for(lambda: all(own.last.time_s == 0.25 for own in viewers))
    for viewer in viewers:
        np.testing.assert_array_equal(viewer.last.poses, first.last.poses)
    reader.do("step", steps=1)
    assert "looks on" in wait_for(lambda: reader.of_kind("refused"))[0]["message"]
    first.close()
    wait_for(lambda: second.status["steers"])
    second.do("set", name="gain", value=3.5)
    second.do("select", object=0)
    second.do("step", steps=5)
    wait_for(lambda: second.of_kind("robot") and second.of_kind("robot")[-1]["values"]["gain"] == 3.5)
    assert "is complete" in served.end()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_data_file_has_the_bytes_of_a_run_without_viewers(
    number: int, hosted: Path, scene: Path, tmp_path: Path
) -> None:
    arguments = (
        str(hosted),
        "-c",
        str(scene),
        "--port",
        "0",
        "--speed",
        "max",
        "--set",
        "simulation_time=3",
        "-s",
        "5",
    )
    file = tmp_path / "data.feather"
    alone = subprocess.run(
        [*COMMAND, *arguments, "--close"],
        cwd=tmp_path,
        env={**os.environ, "POGOSIM_DIR": str(ROOT)},
        timeout=60,
        check=True,
    )
    assert alone.returncode == 0
    expected = file.read_bytes()
    file.unlink()
    with serving(tmp_path, *arguments, "--pause") as served:
        viewers = [served.view(), served.view(served.look)]
        viewers[0].do("select", object=1)
        viewers[1].do("columns", color_by="age", heat_map=None)
        viewers[0].do("play")
        wait_for(lambda: viewers[1].status["over"])
        assert "data.feather is complete" in served.end(number)
    assert file.read_bytes() == expected


def test_fuzzed_clients_leave_the_server_and_the_run_alone(served: Served) -> None:
    """Clients that know the token and send nonsense, and clients that do not even speak HTTP."""
    chance = random.Random(7)
    good = ['{"do": "step", "steps": 1}', '{"do": "select", "object": 1}', '{"do": "shown", "frame": 1}']
    closed = 0
    for _ in range(40):
        own = opened(served.address(served.look))
        try:
            for _ in range(chance.randrange(1, 15)):
                own.send(nonsense(chance, chance.choice(good)))
        except ConnectionClosed:
            closed += 1
        with contextlib.suppress(Exception):
            own.close()
    for _ in range(60):
        with socket.create_connection(("127.0.0.1", served.port), timeout=20) as raw, contextlib.suppress(OSError):
            raw.sendall(
                chance.choice((b"GET / HTTP/1.1\r\n", b"", b"\x16\x03\x01")) + chance.randbytes(chance.randrange(300))
            )
            if chance.random() < 0.5:
                raw.shutdown(socket.SHUT_WR)
    viewer = served.view()
    assert viewer.last.time_s == 0.0  # none of them may steer
    viewer.do("step", steps=2)
    wait_for(lambda: viewer.last.time_s == 0.02)
    said = served.end()
    assert "Traceback" not in said
    assert "data.feather is complete" in said


def nonsense(chance: random.Random, text: str) -> str | bytes:
    kind = chance.randrange(5)
    if kind == 0:
        return chance.randbytes(chance.randrange(2000))
    if kind == 1:
        return "x" * chance.choice((0, 1, 1999, 7000, 100_000))
    if kind == 2:
        return "[" * chance.randrange(7000)
    letters = list(text)
    for _ in range(chance.randrange(1, 4)):
        letters[chance.randrange(len(letters))] = chance.choice('{}[]":,0x\u00e9\x00e9')
    return "".join(letters)


def test_message_that_is_too_long_ends_its_connection_only(shared: Served) -> None:
    own, other = opened(shared.address()), shared.view(shared.look)
    with contextlib.closing(own), pytest.raises(ConnectionClosed) as ended:
        own.send("x" * 1_000_000)
        while True:
            own.recv()
    assert ended.value.rcvd is not None
    assert ended.value.rcvd.code == 1009
    wait_for(lambda: other.status["viewers"] == 1)
    other.close()


def test_addresses_that_are_none_are_refused_without_a_word(served: Served) -> None:
    for path in ("//[", "http://[::1/", "//[/live"):
        with socket.create_connection(("127.0.0.1", served.port), timeout=20) as raw:
            raw.sendall(f"GET {path} HTTP/1.1\r\nHost: x\r\n\r\n".encode())
            assert raw.recv(4096).split()[1] in (b"403", b"404")
    with pytest.raises(InvalidStatus) as refused:
        opened(served.address(), additional_headers={"Origin": "http://["})
    assert refused.value.response.status_code == 403
    assert "Traceback" not in served.end()


def test_connections_that_say_nothing_leave_room_for_others(served: Served) -> None:
    idle = []
    for _ in range(2 * MOST_CONNECTIONS):
        idle.append(socket.create_connection(("127.0.0.1", served.port), timeout=20))
        with contextlib.suppress(OSError):
            idle[-1].sendall(b"GET / HTTP/1.1\r\n")
    files = Path(f"/proc/{served.process.pid}/fd")
    if files.is_dir():
        wait_for(lambda: len(list(files.iterdir())) < MOST_CONNECTIONS + 60)
    for own in idle:
        own.close()
    served.view().do("step", steps=1)
    assert "Traceback" not in served.end()


def test_reset_that_fails_is_said_at_the_end(served: Served) -> None:
    viewer = served.view()
    file = served.folder / "data.feather"
    file.rename(served.folder / "moved")
    file.mkdir()
    viewer.do("reset")
    wait_for(lambda: viewer.status["problem"])
    served.process.send_signal(signal.SIGTERM)
    said, _ = served.process.communicate(timeout=30)
    assert served.process.returncode == 2
    assert "is complete" not in said
    assert "data.feather" in said.splitlines()[-1]


def shows(viewer: Viewer, time_s: float) -> bool:
    return abs(viewer.last.time_s - time_s) < 1e-6


def rows_until(file: Path) -> float:
    return float(pd.read_feather(file)["time"].max())


def test_files_of_earlier_runs_are_kept(hosted: Path, scene: Path, tmp_path: Path) -> None:
    arguments = (str(hosted), "-c", str(scene), "--port", "0", "--pause", "--set", "save_data_period=0.01")
    file = tmp_path / "data.feather"
    for steps in (100, 200):
        with serving(tmp_path, *arguments) as served:
            viewer = served.view()
            viewer.do("step", steps=steps)
            wait_for(functools.partial(shows, viewer, 0.01 * steps))
            served.end()
    assert rows_until(file) == pytest.approx(2.0)
    assert rows_until(tmp_path / "data.1.feather") == pytest.approx(1.0)
    with serving(tmp_path, *arguments) as served:  # and on a reset
        viewer = served.view()
        viewer.do("step", steps=50)
        viewer.do("reset")
        viewer.do("step", steps=20)
        wait_for(lambda: viewer.last.time_s == pytest.approx(0.2))
        said = served.end()
    assert "data.feather of an earlier run is data.3.feather now." in said
    ends = [rows_until(tmp_path / f"data.{name}feather") for name in ("", "1.", "2.", "3.")]
    assert ends == pytest.approx([0.2, 1.0, 2.0, 0.5])


def test_file_that_the_run_does_not_write_has_its_name(hosted: Path, scene: Path, tmp_path: Path) -> None:
    file = tmp_path / "data.feather"
    file.write_bytes(b"of something else")
    arguments = (str(hosted), "-c", str(scene), "--port", "0")
    wrong = pogosim(tmp_path, "watch", *arguments, "--set", "objects.robots.nb=-3")
    assert "objects.robots.nb" in refusal(wrong)
    assert [own.name for own in tmp_path.glob("data*")] == ["data.feather"]
    with serving(tmp_path, *arguments, "--pause", "--set", "enable_data_logging=false") as served:
        viewer = served.view()
        viewer.do("reset")
        viewer.do("step", steps=1)
        wait_for(lambda: viewer.last.time_s > 0)
        assert "is complete" not in served.end()
    assert file.read_bytes() == b"of something else"


def test_reader_of_lines_that_goes_away_does_not_end_the_run(hosted: Path, scene: Path, tmp_path: Path) -> None:
    command = [*COMMAND, str(hosted), "-c", str(scene), "--port", "0", "--close", "--speed", "max"]
    done = subprocess.run(
        [
            "bash",
            "-c",
            'set -o pipefail; "$@" 2>errors | head -1 >/dev/null',
            "bash",
            *command,
            "--set",
            "simulation_time=1",
        ],
        cwd=tmp_path,
        env={**os.environ, "POGOSIM_DIR": str(ROOT)},
        timeout=60,
        check=False,
    )
    errors = (tmp_path / "errors").read_text()
    assert "Traceback" not in errors
    assert done.returncode in (0, 2)
    if done.returncode:
        assert "cannot write to the standard output: Broken pipe" in errors
    load_dataframe(tmp_path / "data.feather")


def test_second_signal_ends_a_program_that_does_not_return(hosted: Path, scene: Path, tmp_path: Path) -> None:
    hanging = (
        "--set",
        "parameters.fail_at_tick=3",
        "--set",
        "parameters.failure=loop",
        "--set",
        "user_code_timeout=600",
    )
    with serving(tmp_path, str(hosted), "-c", str(scene), "--port", "0", *hanging) as served:
        time.sleep(1.0)
        served.process.send_signal(signal.SIGINT)
        assert served.process.stdout is not None
        told = next(line for line in served.process.stdout if "waiting for the robots' program" in line)
        assert "Ctrl-C ends it at once" in told
        served.process.send_signal(signal.SIGINT)
        said, _ = served.process.communicate(timeout=30)
        assert served.process.returncode == 130
        assert "pogosim recover" in said


def test_flood_of_messages_is_served_in_turn(served: Served) -> None:
    own, other = served.view(), served.view(served.look)
    for number in range(3000):
        own.do("select", object=number % 20)
    own.do("step", steps=4)
    wait_for(lambda: other.last.time_s == 0.04)
    own.close()
    other.close()


def test_so_many_viewers_and_no_more(hosted: Path, scene: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    most = 5
    monkeypatch.setattr("pogosim.watch.server.MOST_VIEWERS", most)
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))
    with Simulation(hosted, scene) as simulation, LivePage(simulation) as page:
        address = page.address.replace("http:", "ws:").replace("/?", "/live?")
        own = [opened(address) for _ in range(most)]
        with pytest.raises(InvalidStatus) as refused:
            opened(address)
        assert refused.value.response.status_code == 503
        own.pop().close()

        def let_in() -> bool:
            with contextlib.suppress(InvalidStatus):
                own.append(opened(address))
            return len(own) == most

        wait_for(let_in)
        for viewer in own:
            viewer.close()


class Throttle(threading.Thread):
    """Passes bytes on from the server at so many a second, as an ssh tunnel does over a slow line."""

    def __init__(self, port: int, bytes_per_s: float) -> None:
        super().__init__(daemon=True)
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        self.target, self.bytes_per_s, self.passed = port, bytes_per_s, 0

    def run(self) -> None:
        client, _ = self.server.accept()
        self.server.close()
        with client, socket.create_connection(("127.0.0.1", self.target)) as target, contextlib.suppress(OSError):
            back = threading.Thread(target=self._back, args=(client, target), daemon=True)
            back.start()
            while content := target.recv(8192):
                time.sleep(len(content) / self.bytes_per_s)
                client.sendall(content)
                self.passed += len(content)

    def _back(self, client: socket.socket, target: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while content := client.recv(4096):
                target.sendall(content)


def test_slow_line_gets_fewer_pictures_and_they_are_not_old(hosted: Path, tmp_path: Path) -> None:
    """300 robots over a line of 30 kB/s: what is shown is at most a second behind what the run does."""
    scene = write_scene(
        tmp_path, {**SETTINGS, "objects.robots.nb": 300, "arena_surface": 5.0e6, "simulation_time": 600}
    )
    with serving(tmp_path, str(hosted), "-c", str(scene), "--port", "0", "--pause") as served:
        line = Throttle(served.port, 30e3)
        line.start()
        slow = served.view(port=line.port)
        fast = served.view(served.look)
        slow.do("play")
        wait_for(lambda: slow.last.time_s > 3.0, 60.0)
        late_s = fast.last.time_s - slow.last.time_s
        assert late_s < 1.5
        assert len(slow.pictures) < len(fast.pictures)
        slow.do("pause")
        wait_for(lambda: not fast.status["playing"] and slow.last.time_s == fast.last.time_s, 60.0)
        np.testing.assert_array_equal(slow.last.poses, fast.last.poses)


def test_lines_of_robots_and_warnings_are_printed_and_told(served: Served) -> None:
    viewer = served.view()
    told = [line for message in wait_for(lambda: viewer.of_kind("said")) for line in message["lines"]]
    assert "hello from 3" in "\n".join(told)
    assert any(line.startswith("warning: ") for line in told)


def test_run_ends_by_itself_with_close(hosted: Path, scene: Path, tmp_path: Path) -> None:
    arguments = [
        str(hosted),
        "-c",
        str(scene),
        "--close",
        "--speed",
        "max",
        "--set",
        "simulation_time=1",
        "--port",
        "0",
    ]
    done = subprocess.run([*COMMAND, *arguments], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert "data.feather is complete" in done.stdout
    failing = [*arguments, "--set", "parameters.fail_at_tick=3"]
    failed = subprocess.run([*COMMAND, *failing], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert failed.returncode == 3
    assert "robot #1" in failed.stderr


REFUSED = (
    (["nothing.c", "-c", "{scene}"], "there is no project, source file or program nothing.c"),
    (["{hosted}"], "no configuration: name one with -c FILE"),
    (["{hosted}", "-c", "nothing.yaml"], "nothing.yaml"),
    (["{hosted}", "-c", "{scene}", "--address", "somewhere"], "'somewhere' is no IP address"),
    (["{hosted}", "-c", "{scene}", "--address", "192.0.2.1"], "cannot listen on ports 8642 to 8691 of 192.0.2.1"),
    (["{hosted}", "-c", "{scene}", "--port", "70000"], "'70000' is not a whole number from 0 to 65535"),
    (["{hosted}", "-c", "{scene}", "--speed", "-1"], "-1 is not above 0"),
    (["{hosted}", "-c", "{scene}", "--speed", "1e308"], "1e308 is above 1e+06"),
    (["{hosted}", "-c", "{scene}", "--set", "nothing"], "expected KEY=VALUE"),
    (["{hosted}", "-c", "{scene}", "--set", "objects.robots.nb=-3"], "objects.robots.nb"),
    (["{scene}", "-c", "{scene}"], "has no shared object scene.yaml.so beside it"),
)


@pytest.mark.parametrize(("arguments", "told"), REFUSED, ids=[" ".join(own) for own, _ in REFUSED])
def test_what_cannot_be_shown_is_said_in_a_line(
    arguments: list[str], told: str, hosted: Path, scene: Path, tmp_path: Path
) -> None:
    filled = [word.format(scene=scene, hosted=hosted) for word in arguments]
    line = refusal(pogosim(tmp_path, "watch", *filled))
    assert line.startswith("pogosim watch: ")
    assert told in line


def test_port_that_is_taken_is_said(hosted: Path, scene: Path, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        line = refusal(pogosim(tmp_path, "watch", str(hosted), "-c", str(scene), "--port", str(port)))
    assert f"cannot listen on port {port} of 127.0.0.1: Address already in use" in line


def test_listens_nowhere_else(shared: Served) -> None:
    """Other addresses of this machine are not answered, which all of 127.0.0.0/8 are on Linux."""
    with pytest.raises(OSError):
        socket.create_connection(("127.0.0.2", shared.port), timeout=5)
