"""Runs of a batch that one process does, one after the other: each is what it is in a process of its own."""

from __future__ import annotations

import contextlib
import re
import shutil
import signal
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from batches import batch, results, start_batch, wait_for_simulators, wait_until_gone, write_options
from pogosim.batch.execution import Execution
from pogosim.batch.runs import run_server
from pogosim.batch.runs.run import RunSettings, Task
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.run_server import NotServedError, RunServer, RunServers, ServerLostError
from pogosim.batch.runs.simulators import Simulators
from pogosim.batch.runs.temporary import TemporaryFolder
from running import Run, compile_text, example, write_scene

IN_PLACE = "a process does many runs, one after the other"
COPIES = "each run is a copy of a process: "
ALONE = "each run is a process of its own: "

# What a run may leave behind: variables of all kinds, the random stream, what the main loop is told.
PROGRAM = """
#include "pogobase.h"
{includes}
typedef struct {{ int steps; }} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
static int starts;
int set = 7;
static void step(void) {{
    static int calls;
    mydata->steps += ++calls;
    if (pogobot_ticks == 3) {{
        set += rand() % 100;
        main_loop_hz = 50;
    }}
    {step}
}}
static void init(void) {{
    ++starts;
    {init}
}}
static void export_schema(void) {{
    data_add_column_int32("starts");
    data_add_column_int32("set");
    data_add_column_int32("steps");
    data_add_column_int32("random");
}}
static void export_data(void) {{
    data_set_value_int32("starts", starts);
    data_set_value_int32("set", set);
    data_set_value_int32("steps", mydata->steps);
    data_set_value_int32("random", rand());
}}
int main(void) {{
    pogobot_init();
    set += 1;
    SET_CALLBACK(callback_create_data_schema, export_schema);
    SET_CALLBACK(callback_export_data, export_data);
    pogobot_start(init, step);
    return 0;
}}
"""


def program(folder: Path, includes: str = "", step: str = "", init: str = "", name: str = "main.c") -> Path:
    """Compile a program whose rows show what robots share."""
    return compile_text(folder, PROGRAM.format(includes=includes, step=step, init=init), name)


def both_ways(folder: Path, runs: Path, *more: str) -> tuple[Run, Run]:
    """Do a batch of five runs of two configurations with and without processes of their own, side by side."""
    done = []
    for name, options in (("shared", ()), ("isolated", ("--isolated",))):
        write_options(folder / name)
        done.append(batch(folder / name, "-r", "5", "-j", "2", "-R", "0", *options, *more, program=runs))
    return done[0], done[1]


def check_same(folder: Path, shared: Run, isolated: Run) -> None:
    """Check that two ways have written and said the same."""
    assert (shared.code, shared.output, without_folder(shared)) == (
        isolated.code,
        isolated.output,
        without_folder(isolated),
    )
    assert results(folder / "shared") == results(folder / "isolated")


def without_folder(result: Run) -> str:
    """Return what a batch has said of its runs: not how they were done, nor in which temporary folder."""
    lines = re.sub(r"\[20[^\]]*\] ", "", result.errors.replace("isolated", "shared")).splitlines()
    return "\n".join(sorted(line for line in lines if "/tmp/sim_" not in line))  # warnings come as runs end


def said_how(folder: Path, runs: Path, *more: str) -> str:
    """Return what a batch says of how it does its runs."""
    write_options(folder)
    result = batch(folder, "-r", "2", "-v", *more, program=runs)
    assert result.code == 0, result.errors
    (line,) = (line for line in result.errors.splitlines() if IN_PLACE in line or COPIES in line or ALONE in line)
    return line.partition(": ")[2]


@pytest.mark.parametrize(
    ("parts", "how"),
    [
        ({}, IN_PLACE),
        (
            {"includes": "#include <string.h>", "step": 'char t[] = "a b"; strtok(t, " ");'},
            f"{COPIES}the program uses 'strtok', which",
        ),
        ({"includes": "#include <stdlib.h>", "init": "mydata->steps = malloc(99) != 0;"}, f"{COPIES}the program alloc"),
        (
            {"includes": "#include <vector>\nstatic std::vector<int> all(3);", "name": "main.cpp"},
            f"{COPIES}the program",
        ),
    ],
    ids=["plain", "strtok", "malloc", "c++"],
)
def test_runs_of_one_process_are_those_of_processes_of_their_own(
    parts: dict[str, str], how: str, tmp_path: Path
) -> None:
    runs = program(tmp_path, **parts)
    check_same(tmp_path, *both_ways(tmp_path, runs))
    assert said_how(tmp_path / "how", runs).startswith(how)


@pytest.mark.parametrize(
    "constructor",
    [
        '#include <unistd.h>\n__attribute__((constructor)) static void say(void) { write(2, "hello\\n", 6); }',
        '__attribute__((constructor)) static void say(void) { printf("hello"); }',
        '#include <fcntl.h>\n__attribute__((constructor)) static void take(void) { open("/dev/null", O_RDONLY); }',
        "#include <pthread.h>\n#include <unistd.h>\nstatic void* wait(void* p) { pause(); return p; }\n"
        "__attribute__((constructor)) static void begin(void) { pthread_t t; pthread_create(&t, 0, wait, 0); }",
    ],
    ids=["prints", "prints without a line's end", "opens", "thread"],
)
def test_program_that_does_something_before_main_has_a_process_for_each_run(constructor: str, tmp_path: Path) -> None:
    runs = program(tmp_path, includes=constructor)
    assert said_how(tmp_path / "how", runs) == f"{ALONE}{runs} cannot do several"
    check_same(tmp_path, *both_ways(tmp_path, runs))


@pytest.mark.parametrize("options", [["--isolated"], ["--save-states"], ["--keep-temp"], ["--isolated", "--keep-temp"]])
def test_options_that_ask_for_a_process_for_each_run_are_said(options: list[str], tmp_path: Path) -> None:
    assert said_how(tmp_path, example("helloworld"), *options) == f"{ALONE}{', '.join(options)}"


AT_END = {
    "atexit": ("#include <stdlib.h>\nstatic void end(void) {{ {} }}", "atexit(end);"),
    "destructor": ("#include <stdlib.h>\n__attribute__((destructor)) static void end(void) {{ {} }}", ""),
}


@pytest.mark.parametrize("end", ["", "abort();"])
@pytest.mark.parametrize("kind", sorted(AT_END))
def test_code_at_the_end_of_the_process_runs_for_each_run(kind: str, end: str, tmp_path: Path) -> None:
    text, init = AT_END[kind]
    runs = program(tmp_path, includes=text.format(end), init=init)
    shared, isolated = both_ways(tmp_path, runs)
    check_same(tmp_path, shared, isolated)
    assert shared.code == (3 if end else 0)


def test_static_object_in_a_function_is_destroyed_after_each_run(tmp_path: Path) -> None:
    text = "#include <cstdlib>\nstruct Log {{ int steps = rand(); ~Log() {{ abort(); }} }};"
    step = "static Log one; mydata->steps += one.steps % 10;"
    shared, isolated = both_ways(tmp_path, program(tmp_path, text.format(), step, name="main.cpp"))
    check_same(tmp_path, shared, isolated)
    assert shared.code == 3


@pytest.mark.parametrize(
    "text",
    [
        "#include <random>\nstatic unsigned seed = std::random_device{}();",
        "#include <ctime>\nstatic unsigned seed = time(nullptr);",
        "#include <unistd.h>\nstatic unsigned seed = getpid();",
        '#include <fstream>\nstatic unsigned seed = [] { std::ofstream("/dev/null"); return 1; }();',
    ],
    ids=["random device", "time", "process", "file"],
)
def test_program_that_asks_the_machine_before_main_has_a_process_for_each_run(text: str, tmp_path: Path) -> None:
    runs = program(tmp_path, text, "mydata->steps += seed != 0;", name="main.cpp")
    assert said_how(tmp_path / "how", runs) == f"{ALONE}{runs} cannot do several"


def test_streams_of_cpp_may_be_prepared_before_main(tmp_path: Path) -> None:
    runs = program(
        tmp_path, "#include <iostream>", 'if (mydata->steps < 0) std::cout << "never" << std::endl;', name="main.cpp"
    )
    assert said_how(tmp_path / "how", runs).startswith(COPIES)
    check_same(tmp_path, *both_ways(tmp_path, runs))


@pytest.mark.parametrize("more", [(), ("--isolated",)])
@pytest.mark.parametrize("includes", ["", "#include <stdlib.h>\n#include <string.h>"])
def test_failures_are_seen_where_the_system_was_to_forget_children(
    more: tuple[str, ...], includes: str, tmp_path: Path
) -> None:
    step = 'char t[] = "a"; strtok(t, "b"); __builtin_trap();' if includes else "__builtin_trap();"
    write_options(tmp_path)
    before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    try:
        result = batch(tmp_path, "-r", "1", "-R", "0", *more, program=program(tmp_path, includes, step))
    finally:
        signal.signal(signal.SIGCHLD, before)
    assert result.code == 3


def test_folder_that_is_gone_is_made_again(tmp_path: Path) -> None:
    runs = example("helloworld")
    servers, settings = RunServers(), settings_in(tmp_path, runs)
    first = servers.taken([str(runs)], settings, list)
    assert first is not None
    servers.give_back(first)
    shutil.rmtree(first.folder)  # as the end of a batch does
    second = servers.taken([str(runs)], settings, list)
    assert second is not None
    assert second.outputs.is_dir()
    assert first.process.poll() == 0
    servers.give_back(second)
    servers.close()


HANG = "__attribute__((constructor)) static void hang(void) { for (volatile int i = 0;; ++i) {} }"


def test_server_that_hangs_before_main_can_be_ended(tmp_path: Path) -> None:
    runs = program(tmp_path, HANG)
    started = []

    @contextlib.contextmanager
    def killed(process: subprocess.Popen[bytes], log: Path) -> Iterator[None]:  # noqa: ARG001
        started.append(process)
        process.kill()  # as the end of a batch does
        yield

    with pytest.raises(NotServedError):
        RunServer([str(runs)], settings_in(tmp_path, runs), [], killed)
    assert [process.returncode for process in started] == [-signal.SIGKILL]


def test_batch_of_a_program_that_hangs_before_main_can_be_interrupted(tmp_path: Path) -> None:
    write_options(tmp_path)
    process = start_batch(tmp_path, "-r", "2", "-R", "0", program=program(tmp_path, HANG))
    assert wait_for_simulators(tmp_path, process)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 130
    wait_until_gone(tmp_path)


@pytest.mark.parametrize(
    "step",
    [
        "if (rand() % 200 == 0) *(volatile int*)0 = 1;",
        "if (rand() % 200 == 0) __builtin_trap();",
        "if (rand() % 200 == 0) exit(5);",
        "if (rand() % 200 == 0) exit(0);",
    ],
    ids=["writes at 0", "traps", "exits with 5", "ends its run"],
)
def test_runs_that_fail_fail_alone_and_with_the_same_message(step: str, tmp_path: Path) -> None:
    shared, isolated = both_ways(tmp_path, program(tmp_path, includes="#include <stdlib.h>", step=step))
    check_same(tmp_path, shared, isolated)
    assert shared.code == (0 if "exit(0)" in step else 3)


def test_warnings_of_runs_are_the_same(tmp_path: Path) -> None:
    runs = program(tmp_path)
    done = []
    for name, options in (("shared", ()), ("isolated", ("--isolated",))):
        write_options(tmp_path / name, {"arena_surfaces": 3})
        done.append(batch(tmp_path / name, "-r", "3", *options, program=runs))
    check_same(tmp_path, *done)
    assert "arena_surfaces" in done[0].errors


@pytest.mark.parametrize("name", ["hanabi", "run_and_tumble", "vicsek", "push_sum", "ssr", "walls", "question"])
def test_examples_do_the_same(name: str, tmp_path: Path) -> None:
    check_same(tmp_path, *both_ways(tmp_path, example(name)))


def servers_made(patched: pytest.MonkeyPatch) -> list[RunServer]:
    """Return what will have the processes for many runs that are begun from now on."""
    made: list[RunServer] = []
    begin = RunServer.__init__

    def counted(self: RunServer, *arguments: Any) -> None:
        made.append(self)
        begin(self, *arguments)

    patched.setattr(RunServer, "__init__", counted)
    return made


def test_batch_makes_as_many_processes_as_workers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = servers_made(monkeypatch)
    monkeypatch.setattr(Simulators, "run", None)  # what makes a process for a run
    write_options(tmp_path, {"simulation_time": 0.1})
    assert batch(tmp_path, "-r", "30", "-j", "2").code == 0
    assert len(made) == 2
    assert sum(server.served for server in made) == 60


def test_server_is_replaced_before_what_runs_leave_adds_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = servers_made(monkeypatch)
    monkeypatch.setattr(run_server, "MOST_RUNS", 4)
    write_options(tmp_path / "few", {"simulation_time": 0.1})
    assert batch(tmp_path / "few", "-r", "9", "-j", "1").code == 0
    assert [server.served for server in made] == [4, 4, 4, 4, 2]
    monkeypatch.undo()
    write_options(tmp_path / "many", {"simulation_time": 0.1})
    assert batch(tmp_path / "many", "-r", "9", "-j", "1").code == 0
    assert results(tmp_path / "few") == results(tmp_path / "many")


def test_run_that_another_worker_has_done_may_lose_its_server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The result is there; the run is done once more, alone."""
    write_options(tmp_path, {"simulation_time": 0.1})
    assert batch(tmp_path, "-r", "2", "-j", "1").code == 0
    expected = results(tmp_path)
    serve = RunServer.run

    def lose(self: RunServer, arguments: list[str]) -> None:
        serve(self, arguments)
        text = Path(arguments[arguments.index("-c") + 1]).read_text()
        for task in waiting:
            if task.text in text and str(task.seed) in arguments:
                shutil.copy(self.outputs / task.data, task.result_of(0))
        raise ServerLostError

    waiting: list[Task] = []
    find = Execution.waiting

    def noted(self: Execution) -> list[Task]:
        waiting[:] = find(self)
        return waiting

    monkeypatch.setattr(Execution, "waiting", noted)
    monkeypatch.setattr(RunServer, "run", lose)
    again = batch(tmp_path, "-r", "2", "-j", "1")
    assert again.code == 0, again.errors
    assert results(tmp_path) == expected


# ---- One server ----


def settings_in(folder: Path, runs: Path) -> RunSettings:
    """Return what all runs in a folder have in common."""
    return RunSettings(runs, "", folder, TemporaryFolder(folder, "batch", is_kept=False), RunPolicy(retries=0))


def test_server_is_gone_after_a_run_that_fails(tmp_path: Path) -> None:
    runs = example("helloworld")
    server = RunServer([str(runs)], settings_in(tmp_path, runs), [])
    path = write_scene(tmp_path, {"simulation_time": 0.1})
    server.run(["-c", str(path), "-g", "--set", f"data_filename={server.outputs}/data.feather"])
    assert (server.served, sorted(file.name for file in server.outputs.iterdir())) == (1, ["data.feather"])
    server.clear()
    assert list(server.outputs.iterdir()) == []
    for _ in range(2):
        with pytest.raises(ServerLostError):
            server.run(["-c", "missing.yaml", "-g"])
    assert "missing.yaml" in server.log.read_text()
    assert server.process.wait(timeout=10) != 0
    server.close()
    assert not server.folder.exists()


def test_server_ends_with_its_stream(tmp_path: Path) -> None:
    runs = example("helloworld")
    server = RunServer([str(runs)], settings_in(tmp_path, runs), [])
    server.close()
    assert server.process.returncode == 0


def test_servers_are_used_again_and_not_for_others_settings(tmp_path: Path) -> None:
    runs = example("helloworld")
    servers, settings = RunServers(), settings_in(tmp_path, runs)
    first = servers.taken([str(runs)], settings, list)
    assert first is not None
    servers.give_back(first)
    assert servers.taken([str(runs)], settings, list) is first
    servers.give_back(first)
    other = servers.taken([str(runs)], replace(settings, configuration_folder=tmp_path / "else"), list)
    assert other is not None
    assert other is not first
    servers.give_back(other)
    assert servers.taken(["/bin/true"], settings, list) is None
    servers.close()
    assert (first.process.returncode, other.process.returncode) == (0, 0)
