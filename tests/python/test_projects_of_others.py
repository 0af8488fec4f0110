"""Projects written for the original simulator build with their own Makefiles, and libraries beside programs."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from project import copy_template, made, make, write
from running import ROOT, build_folder, run

# In the manner of such projects: variables, compilers and rules by these names, which their Makefiles have.
MAKEFILE = """
NAME := $(notdir $(CURDIR))
POGOSIM_INCLUDE_DIR ?= ./pogosim/src/
POGOSIM_SRC_DIR = $(POGOSIM_INCLUDE_DIR)/pogosim/
SIM_CFLAGS = -Wall -Werror -MMD -O1 -std=c11 -I$(POGOSIM_INCLUDE_DIR) -I/usr/local/include
SIM_CXXFLAGS = -Wall -Werror -MMD -O1 -std=c++20 -pthread -I$(POGOSIM_INCLUDE_DIR) -I/usr/local/include
SIM_LDFLAGS = -lbox2d -Wl,--whole-archive -lpogosim -Wl,--no-whole-archive -lSDL2_gfx -larrow -L/usr/local/lib
OBJECTS = $(patsubst %.c,build/sim/%.o,$(wildcard *.c)) $(patsubst %.cpp,build/sim/%.o,$(wildcard *.cpp))
all: sim
build/sim:
\tmkdir -p $@
build/sim/%.o: %.cpp | build/sim
\tc++ $(SIM_CXXFLAGS) -c $< -o $@
build/sim/%.o: %.c | build/sim
\tcc $(SIM_CFLAGS) -c $< -o $@
sim: $(OBJECTS)
\tc++ $(SIM_CXXFLAGS) -o $(NAME) $(OBJECTS) $(SIM_LDFLAGS)
layer:
\t@echo $(notdir $(wildcard $(POGOSIM_SRC_DIR)/*.c))
"""
PROGRAM = """#include "pogobase.h"
typedef struct { int count; } USERDATA;
REGISTER_USERDATA(USERDATA)
static void user_step(void) {
    if (++mydata->count == 5) {
        printf("five\\n");
    }
}
int main(void) {
    pogobot_init();
    pogobot_start(NULL, user_step);
    return 0;
}
"""
CPP = (
    'extern "C" {\n'
    + PROGRAM.split("\n", 1)[0]
    + "\n}\n"
    + PROGRAM.split("\n", 1)[1].replace("int main", 'extern "C" int main')
)


def project(folder: Path, name: str = "main.c") -> Path:
    """Make such a project, with a link to this checkout."""
    folder.mkdir()
    (folder / "Makefile").write_text(MAKEFILE)
    (folder / name).write_text(PROGRAM if name.endswith(".c") else CPP)
    (folder / "pogosim").symlink_to(ROOT)
    return folder


def original() -> str:
    """What `pogosim path --original` prints for the build under test."""
    code = "import sys; from pogosim.command.path import main; sys.exit(main(['--original']))"
    command = [sys.executable, "-c", code]
    environment = {**os.environ, "POGOSIM_DIR": str(build_folder())}
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.strip()


def check_runs(folder: Path) -> None:
    """Run the program of a project."""
    result = run(folder / folder.name, folder)
    assert result.robot_lines == [f"[ROBOT #{robot}] [PRINTF] five" for robot in range(3)]


@pytest.mark.parametrize("name", ["main.c", "main.cpp"])
def test_makefile_for_the_original_builds_with_one_variable_in_the_environment(name: str, tmp_path: Path) -> None:
    folder = project(tmp_path / "theirs", name)
    made(folder, "sim", environment={"MAKEFILES": original()})
    check_runs(folder)


def test_link_to_the_checkout_is_not_needed_with_it(tmp_path: Path) -> None:
    folder = project(tmp_path / "theirs")
    (folder / "pogosim").unlink()
    made(folder, "sim", environment={"MAKEFILES": original(), "POGOSIM_INCLUDE_DIR": "/nowhere"})
    check_runs(folder)


def test_makefile_for_the_original_builds_with_libraries_on_the_command_line(tmp_path: Path) -> None:
    folder = project(tmp_path / "theirs")
    environment = {**os.environ, "PKG_CONFIG_PATH": str(build_folder())}
    command = ["pkg-config", "--libs", "pogosim"]
    libraries = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.strip()
    made(folder, "sim", f"SIM_LDFLAGS={libraries}")
    check_runs(folder)


def test_its_firmware_would_be_built_with_the_interface_layer(tmp_path: Path) -> None:
    folder = project(tmp_path / "theirs")
    assert sorted(made(folder, "-s", "layer").output.split()) == ["colormaps.c", "main_loop.c"]
    for name in ("colormaps.c", "main_loop.c"):
        assert (ROOT / "include" / "pogosim" / name).resolve() == ROOT / "src" / "interface" / name


def test_our_own_makefile_does_not_mind_the_variable(tmp_path: Path) -> None:
    folder = copy_template(tmp_path / "ours")
    write(folder, {"main.c": PROGRAM})
    made(folder, "sim", f"POGOSIM_DIR={build_folder()}", environment={"MAKEFILES": original()})
    check_runs(folder)


LIBRARY = {
    "util/sums.h": "int sum_of(int a, int b);\n",
    "util/sums.c": '#include "sums.h"\n#include "pogobase.h"\nint sum_of(int a, int b) { int unused; return a + b; }\n',
    "util/unused.c": "int missing(void);\nint not_used(void);\nint not_used(void) { return missing(); }\n",
}
USER = PROGRAM.replace('printf("five\\n")', 'printf("%s\\n", sum_of(2, 3) == 5 ? "five" : "wrong")').replace(
    "typedef", '#include "util/sums.h"\ntypedef', 1
)


@pytest.mark.parametrize(("headers", "sources"), [("src", "src"), ("include", "src"), ("src/util", "src/util")])
def test_library_of_pogoutils_include_dir_is_compiled_and_linked(headers: str, sources: str, tmp_path: Path) -> None:
    library = tmp_path / "pogo-utils"
    flat = headers.endswith("util")
    for name, text in LIBRARY.items():
        place = headers if name.endswith(".h") else sources
        path = library / place / (Path(name).name if flat else name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text if headers == sources else text.replace('"sums.h"', '"util/sums.h"'))
    folder = copy_template(tmp_path / "ours")
    write(folder, {"main.c": USER.replace("util/sums.h", "sums.h") if flat else USER})
    arguments = ("sim", f"POGOSIM_DIR={build_folder()}", f"POGOUTILS_INCLUDE_DIR=../pogo-utils/{headers}")
    first = made(folder, *arguments)
    assert "warning" not in first.text
    check_runs(folder)
    # A change of the library reaches the program.
    changed = library / sources / ("sums.c" if flat else "util/sums.c")
    changed.write_text(changed.read_text().replace("a + b", "a + b + 1"))
    os.utime(changed, (2**31, 2**31))
    made(folder, *arguments)
    assert "wrong" in run(folder / "ours", folder).output
    made(folder, "clean")
    assert not (folder / "build").exists()


def test_library_of_the_original_builds_by_itself_and_need_not_be_installed(tmp_path: Path) -> None:
    library = tmp_path / "pogo-utils"
    for name in ("sums.h", "sums.c"):
        path = library / "src" / "util" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(LIBRARY[f"util/{name}"])
    # As cmake writes it: the library knows nothing of the simulator, whose headers are installed in the system.
    commands = ["mkdir -p build", "cc -c $< -o build/sums.o", "ar rcs $@ build/sums.o"]
    (library / "Makefile").write_text("\n\t".join(["build/libpogo-utils.a: src/util/sums.c", *commands]) + "\n")
    (library / "examples").mkdir()
    folder = project(library / "examples" / "theirs")
    (folder / "Makefile").write_text("POGOUTILS_INCLUDE_DIR = ../../src\n" + MAKEFILE)
    (folder / "main.c").write_text(USER)
    environment = {"MAKEFILES": original()}
    too_early = make(folder, "sim", environment=environment)
    assert too_early.code == 2
    assert (
        "there is no libpogo-utils.a in ../../src/../build; if its functions are missing, build it: "
        in too_early.errors
    )
    made(library, environment=environment)
    assert "no libpogo-utils.a" not in made(folder, "sim", environment=environment).text
    check_runs(folder)


def test_headers_that_compilers_are_to_find_stay_found(tmp_path: Path) -> None:
    (tmp_path / "headers").mkdir()
    (tmp_path / "headers" / "five.h").write_text("#define FIVE 5\n")
    folder = project(tmp_path / "theirs")
    (folder / "main.c").write_text(
        PROGRAM.replace("== 5", "== FIVE").replace("typedef", '#include "five.h"\ntypedef', 1)
    )
    made(folder, "sim", environment={"MAKEFILES": original(), "CPATH": str(tmp_path / "headers")})
    check_runs(folder)


def test_library_may_be_far_away_and_may_have_no_c_files(tmp_path: Path) -> None:
    (tmp_path / "headers").mkdir()
    (tmp_path / "headers" / "five.h").write_text("#define FIVE 5\n")
    folder = copy_template(tmp_path / "ours")
    write(folder, {"main.c": PROGRAM.replace("== 5", "== FIVE").replace("typedef", '#include "five.h"\ntypedef', 1)})
    made(folder, "sim", f"POGOSIM_DIR={build_folder()}", f"POGOUTILS_INCLUDE_DIR={tmp_path / 'headers'}")
    check_runs(folder)
