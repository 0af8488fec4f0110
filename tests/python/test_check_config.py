"""--check-config finds all mistakes of a configuration at once, and writes nothing but the picture it is asked for."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from firmwares import without_program
from flash_files import EMPTY
from PIL import Image
from running import ROOT, Run, Settings, compile_text, example, run, run_command, write_scene

CHECK = ["-c", "scene.yaml", "--check-config"]

LEAVES_TRACES = """#define _GNU_SOURCE
#include "pogobase.h"
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
float speed = 1.0f;
static void leave(char const* name) {
    FILE* file = fopen(name, "w");
    if (file != NULL) { fprintf(file, "trace"); fclose(file); }
    mkdir("folder_of_robots", 0755);
    rename("kept.txt", "moved.txt");
    remove("kept.txt");
    truncate("kept.txt", 0);
    int descriptor = open("kept.txt", O_RDWR | O_TRUNC);
    if (descriptor >= 0) { close(descriptor); }
    if (system("echo trace > shell.txt") != 0) { printf("no shell\\n"); }
    FILE* read = fopen("kept.txt", "r");
    if (read == NULL) { exit(1); }  // reading is allowed
    fclose(read);
}
static void setup(void) { leave("setup.txt"); init_from_configuration(speed); check_parameter(speed, 0.5, 2.0); }
static void user_init(void) { leave("init.txt"); printf("I am here\\n"); pogobot_led_setColor(0, 25, 0); }
static void user_step(void) { leave("step.txt"); exit(1); }
int main(void) {
    leave("main.txt");
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, setup);
    return 0;
}
"""


def contents(folder: Path) -> dict[str, tuple[str, int]]:
    """Return the hash and the time of change of every file and folder below a folder."""
    return {
        str(path.relative_to(folder)): (
            hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "",
            path.stat().st_mtime_ns,
        )
        for path in sorted([folder, *folder.rglob("*")])
    }


def check(program: Path, folder: Path, settings: Settings | None = None, *arguments: str) -> Run:
    """Check a scene, in a folder in which nothing changes."""
    write_scene(folder, settings or {})
    before = contents(folder)
    result = run_command(program, folder, [*CHECK, *arguments])
    assert contents(folder) == before
    return result


def program_with(init: str) -> str:
    """Return a program that does this in user_init."""
    return f"""#include "pogobase.h"
static void user_init(void) {{ {init} }}
static void user_step(void) {{}}
int main(void) {{ pogobot_init(); pogobot_start(user_init, user_step); return 0; }}
"""


def mistakes(result: Run) -> list[str]:
    assert result.code == 2, result.text
    assert result.output == ""
    return [line.removeprefix("Error: ") for line in result.errors.splitlines() if line.startswith("Error: ")]


def places(result: Run) -> list[str]:
    """Return "objects.robots.nb" of each mistake, all of which say file and line."""
    found = [re.match(r"scene\.yaml:\d+: ([\w.]+): ", mistake) for mistake in mistakes(result)]
    assert None not in found, result.text
    return [match[1] for match in found if match]


# ---- What is right ----


def test_right_configuration_is_one_line_and_exit_code_0(tmp_path: Path) -> None:
    settings = {
        "objects.box": {"type": "passive_object", "geometry": "disk", "radius": 30, "nb": 2},
        "objects.lamp": {"type": "static_light", "geometry": "global", "value": 100},
    }
    result = check(example("helloworld"), tmp_path, settings)
    assert (result.code, result.errors) == (0, "")
    assert result.output == "scene.yaml: no mistakes found: 3 robots, 2 other objects, 1 lamp\n"


def test_walls_and_membranes_with_a_program_are_not_counted_as_robots(tmp_path: Path) -> None:
    settings = {
        "objects.walls": {"type": "pogowall", "geometry": "arena", "nb": 1},
        "objects.membrane": {"type": "membrane", "geometry": "disk", "radius": 60, "num_dots": 20, "nb": 1},
        "objects.heavy": {"type": "pogobject", "geometry": "disk", "radius": 50, "nb": 1},
        "simulation_time": 0.1,
    }
    assert check(example("helloworld"), tmp_path, settings).output.endswith(": 4 robots, 2 other objects\n")
    assert "0.1 s of 4 robots simulated" in run(example("helloworld"), tmp_path, settings).summary


@pytest.mark.parametrize("name", ["run_and_tumble", "hanabi", "phototaxis", "walls", "vicsek", "heartbeat_sdk"])
def test_shipped_configurations_are_right(name: str, tmp_path: Path) -> None:
    configuration = ROOT / "conf" / f"{name}.yaml"
    if not configuration.exists():
        configuration = ROOT / "conf" / "simple.yaml"
    result = run_command(example(name), tmp_path, ["-c", str(configuration), "--check-config", "-g"])
    assert result.code == 0, result.text
    assert result.output.startswith(f"{configuration}: no mistakes found: ")
    assert list(tmp_path.iterdir()) == []


def test_warnings_do_not_fail_the_check(tmp_path: Path) -> None:
    result = check(example("helloworld"), tmp_path, {"arena_surfce": 3, "parameters.unread": 1})
    assert result.code == 0
    assert "unknown key 'arena_surfce' is ignored; did you mean 'arena_surface'?" in result.errors
    assert "parameters that the program does not read before its first step: unread (scene.yaml:" in result.errors


def test_check_needs_no_display_and_no_ending_of_the_run(tmp_path: Path) -> None:
    result = check(example("helloworld"), tmp_path, {"GUI": True, "simulation_time": 1e9})
    assert (result.code, result.errors) == (0, "")


# ---- What is wrong ----


def test_a_brain_that_cannot_be_read_asks_for_no_program(tmp_path: Path) -> None:
    brain = {"script": [{"time_s": 0, "motors": {"left": 3}}]}
    found = mistakes(check(without_program(), tmp_path, {"objects.robots.brain": brain}))
    assert len(found) == 1
    assert "script.0.motors: expected a list of three powers" in found[0]


def test_all_mistakes_are_told_at_once_each_with_its_line(tmp_path: Path) -> None:
    settings = {
        "arena_file": "nowhere.csv",
        "time_step": 0,
        "seed": -1,
        "window_width": 0,
        "boundary_condition": "soft",
        "data_filename": "data.xlsx",
        "objects.robots.nb": -3,
        "objects.robots.body_density": -1,
        "objects.robots.msg_success_rate": {"type": "static", "rate": 2},
        "objects.thing": {"type": "cube"},
        "parameters.speed": 7,
    }
    program = compile_text(tmp_path, LEAVES_TRACES)
    (tmp_path / "kept.txt").write_text("kept")
    assert sorted(places(check(program, tmp_path, settings))) == [
        "arena_file",
        "boundary_condition",
        "data_filename",
        "objects.robots.body_density",
        "objects.robots.msg_success_rate.rate",
        "objects.robots.nb",
        "objects.thing.type",
        "parameters.speed",
        "seed",
        "time_step",
        "window_width",
    ]


@pytest.mark.parametrize(
    ("settings", "place"),
    [
        ({"arena_file": "gone.csv"}, "arena_file"),
        ({"objects.robots.nb": 1000, "initial_formation": "random"}, "initial_formation"),
        ({"initial_formation": "chessboard", "objects.robots.nb": 5000}, "initial_formation"),
        ({"initial_formation": "imported", "formation_filename": "gone.csv"}, "formation_filename"),
        ({"objects.robots.x": 5000, "objects.robots.y": 0}, "objects.robots.x"),
        ({"data_filename": "scene.yaml"}, "data_filename"),
        ({"data_filename": "prog/data.feather"}, "data_filename"),
        ({"enable_console_logging": True, "console_filename": "."}, "console_filename"),
        ({"message_log": "log.txt"}, "message_log"),
        ({"save_video_period": 1, "frames_name": "f.png"}, "frames_name"),
        ({"save_video_period": 1, "frames_name": "f{:.0f}.jpg"}, "frames_name"),
        (
            {
                "physics_engine": "box2d",
                "boundary_condition": "periodic",
                "links": {"chain": {"between": "robots", "topology": "chain"}},
            },
            "physics_engine",
        ),
        ({"chessboard_distance_between_neighbors": 0}, "chessboard_distance_between_neighbors"),
        ({"GUI_speed_up": -1}, "GUI_speed_up"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_each_part_of_a_run_is_checked(settings: Settings, place: str, tmp_path: Path) -> None:
    (tmp_path / "prog").write_text("a file, no folder")
    found = places(check(example("helloworld"), tmp_path, settings))
    assert set(found) == {place}


def test_arena_file_is_checked_beside_other_mistakes(tmp_path: Path) -> None:
    (tmp_path / "bow.csv").write_text("0,0\n1,1\n1,0\n0,1\n")
    result = check(example("helloworld"), tmp_path, {"arena_file": "bow.csv", "objects.robots.nb": "many"})
    assert sorted(mistake.split(": ")[0].split(":")[0] for mistake in mistakes(result)) == ["bow.csv", "scene.yaml"]


@pytest.mark.parametrize(
    ("key", "value"),
    [("arena_temperature", -500), ("light_map_nb_bin_x", 0), ("physics_engine", "bogus"), ("magnetometer.timing", 1)],
)
def test_objects_that_do_not_fit_are_told_beside_what_makes_no_other_world(
    key: str, value: object, tmp_path: Path
) -> None:
    settings = {key: value, "objects.robots.nb": 3000, "initial_formation": "random"}
    assert sorted(places(check(example("helloworld"), tmp_path, settings))) == sorted([key, "initial_formation"])


def test_table_of_a_magnetometer_is_checked_beside_the_rest(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("angle,mag_x,mag_y,mag_z\n1,2,3,4\nx,2,3,4\n")
    table = {"magnetometer": {"source": "csv", "csv": {"file": "table.csv"}}}
    no_curve = "'table.csv' has 1 valid row at 1 "
    crowd = {"objects.robots.nb": 3000, "initial_formation": "random"}
    for other, place in ((crowd, "initial_formation"), ({"arena_file": "gone.csv"}, "arena_file")):
        result = check(example("helloworld"), tmp_path, {**table, **other})
        assert len(mistakes(result)) == 2
        assert no_curve in result.errors
        assert place in result.errors
        assert result.errors.count("this row is skipped") == 1


def test_names_of_frames_that_cannot_be_written_are_one_mistake(tmp_path: Path) -> None:
    result = check(example("helloworld"), tmp_path, {"save_video_period": 1, "frames_name": "{}{}.png"})
    assert places(result) == ["frames_name"]


def test_own_memory_is_that_of_the_check_when_the_world_is_wrong_too(tmp_path: Path) -> None:
    program = compile_text(
        tmp_path,
        """#include "pogobase.h"
int32_t small = 0, robots = 0;
static void user_init(void) { if (++robots > 1) { init_from_configuration(small); check_parameter(small, 5, 9); } }
int main(void) {
    pogobot_init();
    pogobot_start(user_init, NULL);
    pogobot_start(user_init, NULL, "others");
    return 0;
}
""",
    )
    wrong = {"objects.others": {"type": "pogobot", "nb": 1}, "objects.robots.radius": -1, "parameters.small": 1}
    shared = check(program, tmp_path, {**wrong, "robot_memory": "shared"})
    assert "parameters.small" in places(shared)
    assert "parameters.small" not in places(check(program, tmp_path, {**wrong, "robot_memory": "own"}))


def test_yaml_that_cannot_be_read_is_one_mistake(tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text("objects: {robots: [\n")
    assert len(mistakes(run_command(example("helloworld"), tmp_path, CHECK))) == 1
    assert len(mistakes(run_command(example("helloworld"), tmp_path, ["-c", "none.yaml", "--check-config"]))) == 1


def test_ordinary_run_tells_all_mistakes_of_the_file_too(tmp_path: Path) -> None:
    result = run(example("helloworld"), tmp_path, {"time_step": 0, "objects.robots.nb": "many"})
    assert places(result) == ["time_step", "objects.robots.nb"]
    assert list(tmp_path.iterdir()) == [tmp_path / "scene.yaml"]


# ---- Parameters, which only the program knows ----


def test_program_is_started_without_leaving_a_trace(tmp_path: Path) -> None:
    program = compile_text(tmp_path, LEAVES_TRACES)
    (tmp_path / "kept.txt").write_text("kept")
    (tmp_path / "data.feather").write_text("of an earlier run")
    (tmp_path / "frames").mkdir()
    (tmp_path / "frames" / "old.png").write_text("old")
    settings = {"delete_old_files": True, "save_video_period": 1, "enable_console_logging": True}
    result = check(program, tmp_path, settings)
    assert (result.code, result.errors) == (0, "")
    assert result.output == "scene.yaml: no mistakes found: 3 robots\n"


def test_archive_of_flash_memory_is_neither_made_nor_replaced(tmp_path: Path) -> None:
    files = {"flash_state": {"input_file": "in.flash", "output_file": "in.flash"}}
    result = check(example("helloworld"), tmp_path, files)
    assert (result.code, result.errors) == (0, "")
    files["flash_state"]["output_file"] = "new/out.flash"
    blank = "flash_state.input_file: 'in.flash' has no records, so the flash memory of all robots is blank at the start"
    result = check(example("helloworld"), tmp_path, files)
    assert (result.code, len(result.errors.splitlines()), result.errors.count(blank)) == (0, 1, 1)
    (tmp_path / "in.flash").write_bytes(EMPTY)
    again = check(example("helloworld"), tmp_path, files)
    assert again.errors.partition("[warning]")[2] == result.errors.partition("[warning]")[2] != ""
    (tmp_path / "in.flash").unlink()
    (tmp_path / "broken.flash").write_text("no archive")
    assert places(check(example("helloworld"), tmp_path, {"flash_state": {"input_file": "broken.flash"}})) == [
        "flash_state.input_file"
    ]
    (tmp_path / "file").write_text("no folder")
    assert places(check(example("helloworld"), tmp_path, {"flash_state": {"output_file": "file/out.flash"}})) == [
        "flash_state.output_file"
    ]


@pytest.mark.parametrize("archive", [{"input_file": "broken.flash"}, {"input_file": "no", "create_if_missing": False}])
def test_archive_of_flash_memory_is_looked_at_when_the_world_is_wrong(
    tmp_path: Path, archive: dict[str, object]
) -> None:
    (tmp_path / "broken.flash").write_text("no archive")
    wrong = {"arena_file": "nowhere.csv", "flash_state": archive}
    assert places(check(example("helloworld"), tmp_path, wrong)) == ["arena_file", "flash_state.input_file"]


def test_world_that_cannot_be_built_has_no_warnings_of_the_one_in_its_place(tmp_path: Path) -> None:
    program = compile_text(
        tmp_path,
        """#include "pogobase.h"
static void user_init(void) { pogobot_photosensors_read(0); }
static void user_step(void) {}
int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
""",
    )
    assert "there is no lamp in this world" in check(program, tmp_path, {}).errors
    result = check(program, tmp_path, {"objects.robots.radius": -1})
    assert places(result) == ["objects.robots.radius"]
    assert "lamp" not in result.text


def test_parameter_that_the_program_refuses_is_a_mistake(tmp_path: Path) -> None:
    program = compile_text(tmp_path, LEAVES_TRACES)
    (tmp_path / "kept.txt").write_text("kept")
    (mistake,) = mistakes(check(program, tmp_path, {"parameters.speed": 7}))
    assert re.fullmatch(r"scene\.yaml:\d+: parameters\.speed: expected a number from 0.5 to 2, found 7", mistake)


PARAMETERS = """#include "pogobase.h"
uint8_t small; int16_t middle; bool flag; float list[2];
static void setup(void) {
    init_from_configuration(small); init_from_configuration(middle); init_from_configuration(flag);
    init_array_from_configuration(list);
}
int main(void) {
    pogobot_init(); pogobot_start(NULL, NULL); SET_CALLBACK(callback_global_setup, setup); return 0;
}
"""


def test_all_parameters_are_checked_at_once(tmp_path: Path) -> None:
    program = compile_text(tmp_path, PARAMETERS)
    wrong = {"small": 300, "middle": -40000, "flag": 1, "list": [1]}
    assert places(check(program, tmp_path, {"parameters": wrong})) == [
        "parameters.small",
        "parameters.middle",
        "parameters.list",
    ]


@pytest.mark.parametrize("option", ["--strict", "--strict-config"])
def test_types_of_parameters_are_checked_at_once_when_strict(option: str, tmp_path: Path) -> None:
    program = compile_text(tmp_path, PARAMETERS)
    wrong = {"small": "sign", "middle": [1], "flag": "maybe", "list": "none"}
    lenient = check(program, tmp_path, {"parameters": wrong})
    assert lenient.code == 0
    assert lenient.errors.count("the program keeps its own value") == 4
    assert places(check(program, tmp_path, {"parameters": wrong}, option)) == [
        "parameters.small",
        "parameters.middle",
        "parameters.flag",
        "parameters.list",
    ]


def test_robots_that_do_not_fit_do_not_hide_a_wrong_parameter(tmp_path: Path) -> None:
    program = compile_text(tmp_path, PARAMETERS)
    settings = {"objects.robots.nb": 1000, "initial_formation": "random", "parameters.small": 300}
    assert places(check(program, tmp_path, settings)) == ["initial_formation", "parameters.small"]


def test_program_that_fails_at_its_start_is_said_and_not_blamed_on_the_configuration(tmp_path: Path) -> None:
    program = compile_text(
        tmp_path,
        '#include "pogobase.h"\n#include <stdlib.h>\nstatic void user_init(void) { abort(); }\n'
        "int main(void) { pogobot_init(); pogobot_start(user_init, NULL); return 0; }\n",
    )
    result = check(program, tmp_path)
    assert result.code == 0
    assert "the program could not be checked to the end of user_init" in result.errors


def test_program_of_the_sdk_is_started_up_to_its_first_wait(tmp_path: Path) -> None:
    result = check(example("heartbeat_sdk"), tmp_path)
    assert result.code == 0, result.text


FORBIDDEN = {
    "fchmodat2": "syscall(452, AT_FDCWD, file, 0600, 0)",
    "chmod": "chmod(file, 0600)",
    "fchmod": "fchmod(descriptor, 0600)",
    "setxattr": 'setxattr(file, "user.a", "b", 1, 0)',
    "lsetxattr": 'lsetxattr(file, "user.a", "b", 1, 0)',
    "fsetxattr": 'fsetxattr(descriptor, "user.a", "b", 1, 0)',
    "removexattr": 'removexattr(file, "user.kept")',
    "lremovexattr": 'lremovexattr(file, "user.kept")',
    "fremovexattr": 'fremovexattr(descriptor, "user.kept")',
    "setxattrat": "syscall(463, AT_FDCWD, file, 0, 0, 0, 0)",
    "file_setattr": "syscall(469, AT_FDCWD, file, 0, 0, 0)",
    "flags of a file": "ioctl(descriptor, FS_IOC_SETFLAGS, &flags)",
    "utimensat": "utimensat(AT_FDCWD, file, 0, 0)",
    "futimens": "futimens(descriptor, 0)",
    "link": 'link(file, "linked.txt")',
    "open": "open(file, O_WRONLY)",
    "openat2": "syscall(SYS_openat2, AT_FDCWD, file, how, sizeof how)",
    "temporary file": 'open(".", O_TMPFILE | O_RDWR, 0600)',
    "prlimit of the parent": "prlimit(getppid(), RLIMIT_NOFILE, 0, &limit)",
    "tgkill of the parent": "syscall(SYS_tgkill, getppid(), getppid(), 0)",
    "kill of the parent": "kill(getppid(), 0)",
    "signal with a value": "sigqueue(getppid(), 0, value)",
    "pidfd": "syscall(SYS_pidfd_open, getppid(), 0)",
    "priority of the parent": "setpriority(PRIO_PROCESS, getppid(), 19)",
    "processors of the parent": "sched_setaffinity(getppid(), sizeof processors, &processors)",
    "owner of a signal": "fcntl(descriptor, F_SETOWN, getppid())",
    "socket": "socket(AF_UNIX, SOCK_DGRAM, 0)",
    "shared memory": "shmget(IPC_PRIVATE, 4096, 0600)",
    "key": 'syscall(SYS_add_key, "user", "a", "b", 1, -3)',
    "vfork": "syscall(SYS_clone, CLONE_VM | CLONE_VFORK | SIGCHLD, 0, 0, 0, 0)",
    "execve": 'execl("/bin/true", "true", (char*)0)',
    "shell": 'system("exit 0") == 0 ? 0 : -1',
}

INCLUDES = """#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/fs.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/ipc.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>
"""

TRY = """
    char const* const file = "kept.txt"; int const descriptor = open(file, O_RDONLY);
    int flags = 0; long how[3] = {O_RDWR};
    struct rlimit limit; union sigval value = {0}; cpu_set_t processors; CPU_ZERO(&processors); CPU_SET(0, &processors);
    (void)file; (void)flags; (void)how; (void)limit; (void)value;
"""


def test_program_cannot_change_anything_outside_of_its_process(tmp_path: Path) -> None:
    tries = "".join(f'errno = 0; tried("{name}", {call});\n' for name, call in FORBIDDEN.items())
    says = 'static void tried(char const* what, long result) { dprintf(2, "%s: %ld %d\\n", what, result, errno); }\n'
    program = compile_text(tmp_path, INCLUDES + says + program_with(TRY + tries + "close(descriptor);"))
    (tmp_path / "kept.txt").write_text("kept")
    with contextlib.suppress(OSError):  # not on all file systems
        os.setxattr(tmp_path / "kept.txt", "user.kept", b"1")
    result = check(program, tmp_path, {"objects.robots.nb": 1})
    assert result.code == 0, result.text
    found = dict(line.rsplit(": ", 1) for line in result.errors.splitlines())
    assert found == dict.fromkeys(FORBIDDEN, f"-1 {errno.EPERM}")


def test_program_may_compute_read_start_threads_and_fork(tmp_path: Path) -> None:
    ordinary = """
    pthread_t thread; int status = -1; void* end = 0; FILE* read = fopen("kept.txt", "r"); struct rlimit limit;
    int ok = read != 0 && fgetc(read) == 'k' && fclose(read) == 0 && getrlimit(RLIMIT_NOFILE, &limit) == 0 &&
             pthread_create(&thread, 0, in_thread, 0) == 0 && pthread_join(thread, &end) == 0 && end == &ok_thread;
    pid_t const child = fork();
    if (child == 0) { _exit(7); }
    ok = ok && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 7;
    signal(SIGURG, note); raise(SIGURG);
    ok = ok && caught == 1 && kill(getpid(), 0) == 0 && isatty(2) == 0 && chdir("/") == 0 && system("exit 0") != 0;
    dprintf(2, "%s\\n", ok ? "all is well" : "something failed");
    """
    before = """
    static int ok_thread; static volatile sig_atomic_t caught;
    static void* in_thread(void* unused) { (void)unused; return malloc(1 << 10) != 0 ? &ok_thread : 0; }
    static void note(int unused) { (void)unused; caught = caught + 1; }
    """
    program = compile_text(tmp_path, INCLUDES + before + program_with(ordinary))
    (tmp_path / "kept.txt").write_text("kept")
    write_scene(tmp_path, {"objects.robots.nb": 1, "window_width": 100, "window_height": 100})
    result = run_command(program, tmp_path, [*CHECK, "--picture", "start.png"])
    assert (result.code, result.errors) == (0, "all is well\n")
    assert (tmp_path / "start.png").exists()  # the program's chdir() is its own


@pytest.mark.parametrize("call", ["_exit(0)", "_exit(7)", "quick_exit(0)", "syscall(SYS_exit_group, 0)"])
def test_program_that_ends_itself_does_not_end_its_check_silently(call: str, tmp_path: Path) -> None:
    program = compile_text(tmp_path, INCLUDES + program_with(f"{call};"))
    result = check(program, tmp_path)
    status = 7 if "7" in call else 0
    assert result.code == 0
    assert (
        "the program could not be checked to the end of user_init, without writing files: "
        f"called _exit({status})" in result.errors
    )
    assert result.output.startswith("scene.yaml: no mistakes found: ")
    assert places(check(program, tmp_path, {"seed": -1})) == ["seed"]


def test_program_that_ends_itself_in_a_thread_is_said_to(tmp_path: Path) -> None:
    in_thread = "static void* in_thread(void* unused) { (void)unused; _exit(0); }\n"
    init = "pthread_t thread; pthread_create(&thread, 0, in_thread, 0); pthread_join(thread, 0);"
    result = check(compile_text(tmp_path, INCLUDES + in_thread + program_with(init)), tmp_path)
    assert "the program could not be checked to the end of user_init" in result.errors
    assert "called _exit(0)" in result.errors


def test_library_that_ends_the_process_does_not_leave_it_unsaid(tmp_path: Path) -> None:
    """When exit handlers have run, the check cannot go on."""
    program = compile_text(tmp_path, "#include <err.h>\n" + program_with('err(0, "I have had enough");'))
    result = check(program, tmp_path)
    assert (result.code, result.output) == (3, "")
    assert "the program ended itself, before its check was complete" in result.errors


# ---- Interrupted ----


@pytest.mark.parametrize("wrong", [False, True], ids=["right", "wrong"])
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_interrupted_check_does_not_say_that_all_is_right(name: str, wrong: bool, tmp_path: Path) -> None:
    program = compile_text(
        tmp_path,
        "#include <unistd.h>\n" + program_with('(void)!write(2, "begun\\n", 6); for (volatile int i = 0; i < 1;) {}'),
    )
    write_scene(tmp_path, {"user_code_timeout": 2, **({"time_step": 0} if wrong else {})})
    before = contents(tmp_path)
    command = [str(program), *CHECK, "--picture", "start.png"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        assert running.stderr is not None
        assert running.stderr.readline() == "begun\n"
        running.send_signal(signal.Signals[name])
        output, errors = running.communicate(timeout=60)
    assert running.returncode == 130
    assert output == ""
    assert "interrupted: the check is not complete" in errors
    assert ("time_step: " in errors) is wrong
    assert contents(tmp_path) == before


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_program_that_interrupts_its_check_is_not_said_to_be_right(name: str, tmp_path: Path) -> None:
    program = compile_text(tmp_path, "#include <signal.h>\n" + program_with(f"raise({name});"))
    result = check(program, tmp_path)
    assert (result.code, result.output) == (130, "")
    assert "interrupted: the check is not complete" in result.errors


# ---- --strict-config ----


@pytest.mark.parametrize(
    ("settings", "place"),
    [
        ({"objects.robots.nb": 2.5}, "objects.robots.nb"),
        ({"objects.robots.nb": {"batch_options": [1, 2]}}, "objects.robots.nb"),
        (
            {"objects.lamp": {"type": "static_light", "geometry": "global", "light_mode": "bright"}},
            "objects.lamp.light_mode",
        ),
        ({"parameters.small": "sign"}, "parameters.small"),
        ({"parameters.small": 2.5}, "parameters.small"),
    ],
    ids=["fraction", "options", "mode", "type of a parameter", "fraction of a parameter"],
)
def test_strict_values_are_refused_in_a_run_and_in_a_check(settings: Settings, place: str, tmp_path: Path) -> None:
    program = compile_text(tmp_path, PARAMETERS)
    assert run(program, tmp_path, settings).code == 0
    assert check(program, tmp_path, settings).code == 0
    result = run(program, tmp_path, settings, ["--strict-config"])
    assert result.code == 2
    assert re.search(rf"scene\.yaml:\d+: {re.escape(place)}: ", result.errors)
    assert places(check(program, tmp_path, settings, "--strict-config")) == [place]


def test_strict_values_allow_unknown_keys_and_whole_numbers_of_any_form(tmp_path: Path) -> None:
    settings = {"some_key": 1, "objects.robots.nb": "1e1", "arena_stretch": 1, "seed": None}
    result = run(example("helloworld"), tmp_path, {**settings, "objects.robots.radius": 20}, ["--strict-config"])
    assert result.code == 0, result.text


# ---- The picture ----


def test_picture_shows_the_start_and_is_all_that_is_written(tmp_path: Path) -> None:
    program = compile_text(tmp_path, LEAVES_TRACES)
    (tmp_path / "kept.txt").write_text("kept")
    write_scene(tmp_path, {"window_width": 300, "window_height": 200})
    before = set(contents(tmp_path))
    result = run_command(program, tmp_path, [*CHECK, "--picture", "start.png"])
    assert (result.code, result.errors) == (0, "")
    assert set(contents(tmp_path)) - before == {"start.png"}
    with Image.open(tmp_path / "start.png") as picture:
        assert picture.size == (300, 200)
        red, green, blue = np.moveaxis(np.asarray(picture.convert("RGB")).astype(int), 2, 0)
    assert np.any(green > 2 * np.maximum(red, blue))  # the LEDs that user_init has set


def test_picture_is_not_drawn_of_a_wrong_configuration(tmp_path: Path) -> None:
    assert places(check(example("helloworld"), tmp_path, {"seed": -1}, "--picture", "start.png")) == ["seed"]


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--picture", "start.png"], "--picture requires --check-config"),
        (["--check-config", "--picture", "start.jpg"], "expected the name of a picture, .png, found 'start.jpg'"),
        (["--check-config", "--picture", "scene.yaml/start.png"], "'scene.yaml/start.png' cannot be written"),
        (
            ["--check-config", "--picture", "new/start.png"],
            "'new/start.png' cannot be written: there is no folder '",
        ),
        (["--check-config", "--picture"], "--picture needs a value"),
    ],
)
def test_wrong_pictures_are_refused(arguments: list[str], complaint: str, tmp_path: Path) -> None:
    write_scene(tmp_path, {})
    result = run_command(example("helloworld"), tmp_path, ["-c", "scene.yaml", *arguments])
    assert result.code == 2
    assert complaint in result.errors
    assert list(tmp_path.iterdir()) == [tmp_path / "scene.yaml"]


def test_picture_does_not_replace_a_file_of_the_run(tmp_path: Path) -> None:
    link = tmp_path / "link.png"
    link.symlink_to("scene.yaml")
    write_scene(tmp_path, {})
    text = (tmp_path / "scene.yaml").read_text()
    result = run_command(example("helloworld"), tmp_path, [*CHECK, "--picture", "link.png"])
    assert result.code == 2
    assert "is a file that the run reads or writes" in result.errors
    assert (tmp_path / "scene.yaml").read_text() == text


def test_picture_does_not_replace_what_is_no_file(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.png")
    (tmp_path / "folder.png").mkdir()
    (tmp_path / "link.png").symlink_to("pipe.png")
    write_scene(tmp_path, {})
    for name in ("pipe.png", "folder.png", "link.png"):
        result = run_command(example("helloworld"), tmp_path, [*CHECK, "--picture", name])
        assert (result.code, result.output) == (2, "")
        assert result.errors == f"Error: --picture: '{name}' is there, and not a file; choose another name\n"
    assert (tmp_path / "pipe.png").is_fifo()
    assert (tmp_path / "link.png").is_symlink()


@pytest.mark.parametrize("is_there", [False, True])
def test_picture_follows_a_link(is_there: bool, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "link.png").symlink_to("elsewhere/start.png")
    if is_there:
        (tmp_path / "elsewhere" / "start.png").write_text("an older one")
    write_scene(tmp_path, {"window_width": 100, "window_height": 100})
    result = run_command(example("helloworld"), tmp_path, [*CHECK, "--picture", "link.png"])
    assert result.code == 0, result.text
    assert (tmp_path / "link.png").is_symlink()
    assert (tmp_path / "elsewhere" / "start.png").read_bytes().startswith(b"\x89PNG")
    assert [path.name for path in (tmp_path / "elsewhere").iterdir()] == ["start.png"]


# ---- Through `pogosim run` ----


def test_pogosim_run_passes_the_options_on(tmp_path: Path) -> None:
    write_scene(tmp_path, {"seed": -1, "time_step": 0})
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python")}
    command = [sys.executable, "-m", "pogosim", "run", str(example("helloworld")), *CHECK]
    ended = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False, env=environment
    )
    assert places(Run(ended.returncode, ended.stdout, ended.stderr, tmp_path)) == ["time_step", "seed"]
    write_scene(tmp_path, {})
    ended = subprocess.run(
        [*command, "--picture", "start.png"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        env=environment,
    )
    assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "start.png").exists()
