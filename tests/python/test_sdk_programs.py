"""Programs written for the robots' SDK alone run as they are: pogobot.h, an endless main(), globals."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from debugger import PRINTERS, debug, needs_gdb
from pogosim import Simulation
from project import made, write
from running import PROGRAMS, Run, build_folder, compile_program, compile_text, compiler, pkg_config, run, write_scene
from test_template import project

__all__ = ["project"]

NEAR: dict[str, Any] = {"objects.robots.communication_radius": 3000, "objects.robots.nb": 8}


def compiled(folder: Path, text: str, name: str = "main.c", **options: Any) -> Path:
    """Compile the text of a program for the robots alone."""
    return compile_text(folder, text, name, package="pogosim-sdk", **options)


@pytest.fixture(scope="module")
def endless(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compile_program(
        tmp_path_factory.mktemp("endless") / "endless", PROGRAMS / "endless.c", package="pogosim-sdk"
    )


def check(result: Run) -> None:
    assert (result.code, result.errors) == (0, ""), result.text
    assert "another robot" not in result.text
    moves = re.findall(r"\[ROBOT #(\d+)\] \[PRINTF\] (\d+) moves after (\d+) ms", result.text)
    assert [robot for robot, _, _ in moves] == [number for _, number, _ in moves] == [str(i) for i in range(8)]
    assert {int(ms) for _, _, ms in moves} == {1000}
    rows = result.frame()
    last = rows[rows.time == rows.time.max()]
    assert (last.ticks.sub(2.0 * 50).abs() <= 1).all()
    assert (last.calls == last.ticks + 2).all()
    assert set(rows[rows.time < 0.95].state) == {"waiting"}
    assert set(last.state) == {"moving"}
    assert last.sent.nunique() > 1
    assert (last.heard <= 4 * (last.sent.sum() - last.sent)).all()  # one message may come to several receivers
    assert (last.heard > 0).all()
    assert not last.heard_of_itself.any()
    assert (last.gain == 9).all()


@pytest.mark.parametrize("build", ["gcc -O2", "gcc -O0", "clang -O2", "gcc -fsanitize=address,undefined"])
def test_program_for_robots_runs_as_it_is(build: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name, *flags = build.split()
    if compiler(name) is None:
        pytest.skip(f"{name} is not installed")
    monkeypatch.setenv("ASAN_OPTIONS", "detect_leaks=0")
    program = compile_program(
        tmp_path / "endless", PROGRAMS / "endless.c", compiler=name, flags=["-Wall", *flags], package="pogosim-sdk"
    )
    check(run(program, tmp_path / "run", {**NEAR, "parameters.gain": 9}))


def test_runs_are_the_same_each_time(endless: Path, tmp_path: Path) -> None:
    data = set()
    for name, threads in {"one": 1, "again": 1, "two": 2}.items():
        result = run(endless, tmp_path / name, {**NEAR, "threads": threads, "objects.robots.nb": 100})
        assert result.code == 0, result.text
        data.add((result.folder / "data.feather").read_bytes())
    assert len(data) == 1


def test_state_hash_has_the_memory_of_robots(endless: Path, tmp_path: Path) -> None:
    def hashes(name: str, gain: int) -> list[str]:
        result = run(endless, tmp_path / name, {**NEAR, "parameters.gain": gain}, ["--hash", "50"])
        return re.findall(r"state after step \d+: (\w+)", result.text)

    assert len(hashes("first", 9)) == 4
    assert hashes("again", 9) == hashes("first_again", 9)
    assert hashes("other", 8) != hashes("third", 9)


def test_state_hash_is_the_same_where_numpy_has_cut_the_heap_into_pieces(tmp_path: Path) -> None:
    text = """#include "pogobot.h"
#include <stdlib.h>
char* text;
int main(void) { text = malloc(9); for (;;) msleep(9); }
"""
    flags = ["-g", "-fPIC", "-shared"]
    library = compiled(tmp_path, text, flags=flags)
    script = tmp_path / "hash.py"
    script.write_text(
        "import sys\nimport numpy\nfrom pogosim import Simulation\n"
        "for _ in range(20): numpy.ones(3_000_000)\n"  # from then on, malloc takes large arrays from the heap
        "kept = [numpy.ones(2_000_000) for _ in range(int(sys.argv[1]))]\n"
        "with Simulation(sys.argv[2], sys.argv[3]) as run:\n    run.step(10)\n    print(run.state_hash)\n"
    )
    configuration = write_scene(tmp_path, {})
    hashes = {
        subprocess.run(
            [sys.executable, str(script), arrays, str(library), str(configuration)], capture_output=True, check=True
        ).stdout
        for arrays in ("0", "4", "4")
    }
    assert len(hashes) == 1


def test_python_runs_them(tmp_path: Path) -> None:
    flags = ["-g", "-fPIC", "-shared"]
    library = compile_program(tmp_path / "endless.so", PROGRAMS / "endless.c", flags=flags, package="pogosim-sdk")
    configuration = write_scene(tmp_path, {**NEAR, "parameters.gain": 9})
    with Simulation(library, configuration) as simulation:
        simulation.step(150)
        assert len(set(simulation.to_dataframe().query("time > 1.2").state)) == 1
        simulation.parameters["gain"] = 11
        before = simulation.state_hash
        simulation.step(50)
        assert simulation.state_hash != before
        assert set(simulation.to_dataframe().query("time > 1.9").gain) == {11}
        simulation.reset()
        simulation.step(10)


def test_main_that_returns_leaves_the_robot_as_it_is(tmp_path: Path) -> None:
    program = compiled(
        tmp_path,
        """#include "pogobot.h"
int main(void) {
    pogobot_init();
    pogobot_motor_set(motorL, 512);
    pogobot_motor_set(motorR, 512);
    msleep(300);
    pogobot_led_setColor(1, 2, 3);
    return 0;
}
""",
    )
    result = run(program, tmp_path / "run", {"save_data_period": 0.1})
    assert (result.code, result.errors) == (0, ""), result.text
    rows = result.frame()
    last = rows[rows.time == rows.time.max()]
    halfway = rows[rows.time.sub(1.0).abs() < 0.01]
    assert (last.x.to_numpy() != halfway.x.to_numpy()).all(), "its motors still run"
    assert "led_rgb" not in rows or set(last.led_rgb) == {0x010203}


@pytest.mark.parametrize(
    ("name", "head"),
    [
        ("main.c", "void main(void)"),
        ("main.c", "int main()"),
        ("main.c", "int main(int argc, char** argv)"),
        ("main.cpp", "int main()"),
        ("main.cpp", 'extern "C" int main(void)'),
    ],
)
def test_any_main(tmp_path: Path, name: str, head: str) -> None:
    uses = "(void)argc; (void)argv;" if "argc" in head else ""
    text = f'#include "pogobot.h"\n{head} {{ {uses} for (int i = 0;; i++) {{ printf("%d\\n", i); msleep(500); }} }}\n'
    flags = ["-Wall", "-Wextra"] if "()" in head or "void main" in head else ["-Wall", "-Wextra", "-Werror"]
    result = run(compiled(tmp_path, text, name, flags=flags), tmp_path / "run", {"objects.robots.nb": 2})
    assert result.code == 0, result.text
    assert re.findall(r"PRINTF\] (\d+)", result.text) == ["0", "0", "1", "1", "2", "2", "3", "3"]


def test_loops_that_only_do_things_let_time_pass(tmp_path: Path) -> None:
    for number, body in enumerate(
        [
            "pogobot_led_setColor(1, 2, 3);",
            "pogobot_motor_set(motorL, 100);",
            "pogobot_infrared_sendShortMessage_omni(payload, 2);",
            "pogobot_infrared_update();",
            "x += pogobot_photosensors_read(0);",
            "pogobot_imu_read(a, a);",
        ]
    ):
        folder = tmp_path / str(number)
        folder.mkdir()
        text = f"""#include "pogobot.h"
volatile int x;
float a[3];
uint8_t payload[2];
int main(void) {{ pogobot_init(); for (;;) {{ {body} }} }}
"""
        result = run(compiled(folder, text), folder / "run", {"simulation_time": 0.2})
        assert result.code == 0, (body, result.text)


def test_loop_that_does_nothing_is_named(tmp_path: Path) -> None:
    program = compiled(tmp_path, '#include "pogobot.h"\nint main(void) { pogobot_init(); for (;;) { } }\n')
    result = run(program, tmp_path / "run", {"user_code_timeout": 0.3})
    assert result.code == 3
    assert "main of robot #0 of category 'robots'" in result.errors
    assert "did not return within 0.3 s of processor time (user_code_timeout); while it runs, time" in result.errors


def test_walls_and_membranes_do_not_run_the_program(endless: Path, tmp_path: Path) -> None:
    walls = {
        "objects.walls": {"type": "pogowall", "geometry": "arena"},
        "objects.ring": {"type": "membrane", "geometry": "disk", "radius": 90, "x": 500, "y": 500},
    }
    result = run(endless, tmp_path, {**NEAR, **walls, "parameters.gain": 9})
    assert result.code == 0, result.text
    assert set(re.findall(r"\[ROBOT #(\d+)\]", result.text)) == {str(i) for i in range(8)}
    assert result.errors == ""
    assert "[ROBOT #65535]" not in result.text


@pytest.mark.parametrize("crash", ["*(volatile int*)8 = 1", "exit(7)", "abort()"])
def test_crash_after_waits_names_the_robot(tmp_path: Path, crash: str) -> None:
    program = compiled(
        tmp_path,
        f"""#include "pogobot.h"
#include <stdlib.h>
int count;
int main(void) {{
    for (;;) {{
        if (++count == 5 && pogobot_helper_getid() == 2) {{ {crash}; }}
        msleep(100);
    }}
}}
""",
    )
    result = run(program, tmp_path / "run", {})
    assert result.code == (7 if "exit" in crash else 3)
    assert "main of robot #2 of category 'robots'" in result.errors
    assert "t = 0.4000 s" in result.errors
    assert len(result.frame()) == 3 * 5


def test_old_way_and_new_way_do_not_mix(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text('#include "pogobot.h"\n#include "pogobase.h"\nint main(void) { return 0; }\n')
    command = ["cc", str(source), *pkg_config("--cflags", "--libs", package="pogosim-sdk")]
    ended = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert ended.returncode != 0
    assert "pogobot.h is included before pogobase.h: take one of them" in ended.stderr


def test_file_that_includes_pogobot_h_may_be_part_of_another_program(tmp_path: Path) -> None:
    (tmp_path / "lights.c").write_text('#include "pogobot.h"\nvoid light(void) { pogobot_led_setColor(0, 9, 0); }\n')
    (tmp_path / "main.c").write_text(
        '#include "pogobase.h"\ntypedef struct { int steps; } USERDATA;\nDECLARE_USERDATA(USERDATA)\n'
        "REGISTER_USERDATA(USERDATA)\nvoid light(void);\nstatic void step(void) { light(); mydata->steps++; }\n"
        "int main(void) { pogobot_init(); pogobot_start(light, step); return 0; }\n"
    )
    program = compile_program(tmp_path / "prog", tmp_path / "main.c", tmp_path / "lights.c", package="pogosim-sdk")
    result = run(program, tmp_path / "run", {})
    assert (result.code, result.errors) == (0, ""), result.text


def test_registers_of_the_hardware_do_not_link(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text(
        '#include "pogobot.h"\n#include <generated/csr.h>\n'
        "int main(void) { csr_write_simple(1, 0xf0000000); return (int)csr_read_simple(0xf0000004); }\n"
    )
    command = ["cc", str(source), *pkg_config("--cflags", "--libs", package="pogosim-sdk"), "-o", "prog"]
    ended = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert ended.returncode != 0
    assert "registers of the hardware are not simulated" in ended.stderr
    assert "undefined reference to `the_simulator_has_no_hardware_registers'" in ended.stderr


def test_template_builds_a_program_for_robots_as_it_is(project: Path) -> None:
    write(project, {"main.c": (PROGRAMS / "endless.c").read_text()})
    result = made(project, "sim")
    assert "shared by all simulated robots" not in result.text
    assert "warning" not in result.text
    check(run(project / project.name, project / "run", {**NEAR, "parameters.gain": 9}))


@needs_gdb
def test_gdb_shows_the_variables_of_the_running_robot(tmp_path: Path) -> None:
    program = compile_program(tmp_path / "endless", PROGRAMS / "endless.c", flags=["-g", "-O0"], package="pogosim-sdk")
    write_scene(tmp_path, {**NEAR, "parameters.gain": 9})
    shown = debug(
        [program, "-c", "scene.yaml", "-g"],
        [
            f"source {PRINTERS}",
            "break send",
            "run",
            "condition 1 $robot() == 5",
            "ignore 1 20",
            "continue",
            "print program_pogobot_ticks",
            "backtrace",
            "print $data(5)",
        ],
        tmp_path,
    )
    assert re.search(r"^\$1 = 20$", shown, re.MULTILINE), shown
    assert "The program has no USERDATA. With pogobot.h" in shown
    assert re.search(r"^#0 +send \(\) at .*endless.c", shown, re.MULTILINE)
    assert re.search(r"robot_main \(\) at .*endless.c", shown)


def test_installed_pogosim_has_it_too(tmp_path: Path) -> None:
    prefix = tmp_path / "installed"
    subprocess.run(["cmake", "--install", build_folder(), "--prefix", prefix], check=True, capture_output=True)
    folder = next(prefix.rglob("pogosim-sdk.pc")).parent
    asked = ["pkg-config", "--cflags", "--libs", "pogosim-sdk"]
    flags = subprocess.run(asked, env={"PKG_CONFIG_LIBDIR": str(folder)}, capture_output=True, text=True, check=True)
    program = tmp_path / "endless"
    source = str(PROGRAMS / "endless.c")
    subprocess.run(["cc", source, "-o", str(program), *flags.stdout.split()], check=True)
    check(run(program, tmp_path / "run", {**NEAR, "parameters.gain": 9}))
