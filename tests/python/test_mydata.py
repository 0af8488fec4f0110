"""`mydata` in every way in which programs declare it: macros in any order, by hand, in several files and languages."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from running import compile_program, compiler, pkg_config, run

COMPILERS = [
    (name, suffix)
    for name, suffix in [
        (compiler("gcc"), ".c"),
        (compiler("clang", "clang-14"), ".c"),
        (compiler("g++"), ".cpp"),
        (compiler("clang++", "clang++-14"), ".cpp"),
    ]
    if name
]
STRUCT = '#include "pogobase.h"\ntypedef struct { int count; char rest[100]; } USERDATA;\n'
DECLARE = "DECLARE_USERDATA(USERDATA);\n"
REGISTER = "REGISTER_USERDATA(USERDATA);\n"
EXTERN = "extern USERDATA *mydata;\n"
FIRST = {
    "declared and registered": DECLARE + REGISTER,
    "declared twice": DECLARE + "DECLARE_USERDATA(USERDATA)\n" + REGISTER,
    "registered": REGISTER,
    "registered without a semicolon": "REGISTER_USERDATA(USERDATA)\n",
    "by hand, then registered": EXTERN + REGISTER,
    "registered, then by hand": REGISTER + EXTERN,
    "registered, then declared": REGISTER + DECLARE,
}
SECOND = {"declared": DECLARE, "by hand": EXTERN}
MAIN = """void count_once(void);
static void user_step(void) {
    count_once();
    mydata->count++;
    if (pogobot_ticks == 9 + (uint32_t)pogobot_helper_getid()) {
        printf("%d of %d\\n", mydata->count, (int)(sizeof(*mydata) / sizeof(USERDATA)));
    }
}
int main(void) {
    pogobot_init();
    pogobot_start(NULL, user_step);
    return 0;
}
"""
COUNT = "void count_once(void);\nvoid count_once(void) { mydata->count += 10; }\n"


@pytest.mark.parametrize(("name", "suffix"), COMPILERS)
@pytest.mark.parametrize("first", sorted(FIRST))
@pytest.mark.parametrize("second", sorted(SECOND))
def test_each_robot_has_its_own_data_however_mydata_is_declared(
    name: str, suffix: str, first: str, second: str, tmp_path: Path
) -> None:
    main, count = tmp_path / f"main{suffix}", tmp_path / f"count{suffix}"
    main.write_text(STRUCT + FIRST[first] + MAIN)
    count.write_text(STRUCT + SECOND[second] + COUNT)
    flags = ["-std=c++20" if suffix == ".cpp" else "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    result = run(compile_program(tmp_path / "prog", main, count, compiler=name, flags=flags), tmp_path)
    assert result.robot_lines == [f"[ROBOT #{id_}] [PRINTF] {11 * (10 + id_)} of 1" for id_ in range(3)]


def test_header_with_extern_serves_files_of_c_and_cpp(tmp_path: Path) -> None:
    (tmp_path / "data.h").write_text(STRUCT + EXTERN)
    (tmp_path / "count.c").write_text('#include "data.h"\n' + COUNT)
    text = MAIN.replace("void count_once(void);", 'extern "C" void count_once(void);').replace("NULL", "nullptr")
    (tmp_path / "main.cpp").write_text('#include "data.h"\n' + REGISTER + text)
    command = ["cc", "-Wall", "-Werror", "-c", "count.c", "-o", "count.o", *pkg_config("--cflags")]
    subprocess.run(command, cwd=tmp_path, check=True)
    result = run(compile_program(tmp_path / "prog", tmp_path / "main.cpp", tmp_path / "count.o"), tmp_path)
    assert result.robot_lines[-1] == "[ROBOT #2] [PRINTF] 132 of 1"


def test_program_with_plain_mydata_runs_in_one_thread_and_says_why(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    source.write_text(STRUCT + REGISTER + MAIN.replace("count_once();", "").replace("void count_once(void);", ""))
    program = compile_program(tmp_path / "prog", source)
    result = run(program, tmp_path, {"threads": 2, "objects.robots.nb": 300}, ["-v"])
    assert result.code == 0
    assert "'mydata' as one for all threads" in result.text
    assert "DECLARE_USERDATA" in result.text


def test_plain_mydata_works_with_own_memory_and_is_no_shared_variable(tmp_path: Path) -> None:
    source = tmp_path / "main.c"
    text = MAIN.replace("count_once();", "extra++; mydata->count += extra - extra + 10;")
    source.write_text(STRUCT + REGISTER + "static int extra;\n" + text.replace("void count_once(void);", ""))
    result = run(compile_program(tmp_path / "prog", source), tmp_path, {"robot_memory": "own"})
    assert result.robot_lines[-1] == "[ROBOT #2] [PRINTF] 132 of 1"
    assert "mydata" not in result.errors
