"""Robots write and read their flash memory, and forget to erase it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import Compile
from flash_files import mark
from running import Run, Settings, compile_text, run


def flash(program: Compile, folder: Path, kind: str, settings: Settings | None = None, *arguments: str) -> Run:
    return run(program("flash.c"), folder, {"parameters.kind": kind, **(settings or {})}, arguments)


def printed(result: Run) -> list[str]:
    """Return what robots printed, without their numbers."""
    assert result.code == 0, result.text
    return [line.partition("[PRINTF] ")[2] for line in result.robot_lines]


def line_of(page: int, data: bytes) -> str:
    return f"page {page}: {data[0]} {data[1]} {data[2]} {data[3]} ..., sum {sum(data)}"


def test_robots_start_with_erased_pages_and_motors_of_the_factory(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "read", {"objects.robots.nb": 1})
    blank = [line_of(page, b"\xff" * 256) for page in (0, 1, 5887)]
    assert printed(result) == ["motors: 0 1 0, 512 512 0", *blank]
    assert result.errors == ""


def test_macros_are_constants_of_the_preprocessor_and_of_the_language(tmp_path: Path) -> None:
    text = """
    #include "pogobase.h"
    typedef struct { int unused; } USERDATA;
    DECLARE_USERDATA(USERDATA)
    REGISTER_USERDATA(USERDATA)
    #if POGOBOT_USER_FLASH_PAGE_COUNT != 5888 || POGOBOT_USER_FLASH_START_OFFSET != 0x90000
    #error "not as on the robot"
    #endif
    _Static_assert(POGOBOT_USER_FLASH_PAGE_SIZE == 256u, "bytes of a page");
    static uint8_t page[POGOBOT_USER_FLASH_PAGE_SIZE];
    int main(void) { return page[0]; }
    """
    for flags in (["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"], ["-std=gnu11"]):
        compile_text(tmp_path, text, flags=flags)


def test_pages_are_not_in_the_memory_of_the_robot(tmp_path: Path) -> None:
    text = """
    #include "pogobase.h"
    typedef struct { int unused; } USERDATA;
    REGISTER_USERDATA(USERDATA)
    static void user_init(void) {
        uint8_t page[POGOBOT_USER_FLASH_PAGE_SIZE] = {0};
        for (uint16_t i = 0; i < POGOBOT_USER_FLASH_PAGE_COUNT; ++i) {
            write_page_flash(i, page);
        }
    }
    static void user_step(void) {}
    int main(void) { pogobot_init(); pogobot_start(user_init, user_step); return 0; }
    """
    result = run(compile_text(tmp_path, text), tmp_path)
    assert (result.code, result.errors) == (0, "")


# ---- flash: nor ----


def test_write_replaces_a_page_by_default(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "forgetful")
    assert printed(result) == [line_of(7, bytes([0xF0, 4]).ljust(256, b"\0"))] * 3
    assert result.errors == ""


@pytest.mark.parametrize("key", ["flash", "objects.robots.flash"])
def test_write_only_clears_bits_as_on_the_robot_if_that_is_asked_for(
    program: Compile, tmp_path: Path, key: str
) -> None:
    result = flash(program, tmp_path, "forgetful", {key: "nor"})
    for robot, line in enumerate(printed(result)):
        first = mark(robot, 7)
        data = bytes([first[0] & 0xF0, first[1] & 0 & 1, *(byte & 0 for byte in first[2:])])
        assert line == line_of(7, data)


def test_forgotten_erase_is_said_once_and_counted(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "forgetful", {"flash": "nor"})
    first, last = (line.partition("[warning] ")[2] for line in result.errors.splitlines())
    assert first == (
        "robot #0 of category 'robots', tick 0, t = 0.0000 s: write_page_flash(): page 7 was not erased before, and a "
        "write only clears bits (flash: nor), so the page does not contain what was written; call "
        "erase_write_section_flash() first, which erases all pages"
    )
    counted = re.fullmatch(
        r"3 robots of category 'robots' wrote pages of flash that were not erased, (\d+) writes in all \(flash: nor\)",
        last,
    )
    assert counted
    assert int(counted[1]) == 3 * 5


def test_each_category_is_told_of_its_own(program: Compile, tmp_path: Path) -> None:
    walls = {"type": "pogowall", "geometry": "arena", "nb": 1}
    result = flash(program, tmp_path, "forgetful", {"flash": "nor", "objects.walls": walls})
    assert result.errors.count("was not erased before") == 2
    assert "robot #65535 of category 'walls', tick 0" in result.errors
    assert "1 robot of category 'walls' wrote pages of flash that were not erased, 4 writes in all" in result.errors


def test_category_says_otherwise_than_the_top_level(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "forgetful", {"flash": "nor", "objects.robots.flash": "overwrite"})
    assert result.errors == ""
    result = flash(program, tmp_path, "emulated_erase", {"objects.robots.flash": "nor"})
    assert "page 7 was not erased before" in result.errors


def test_robot_that_erases_first_hears_nothing(program: Compile, tmp_path: Path) -> None:
    result = flash(program, tmp_path, "careful", {"flash": "nor"})
    assert printed(result) == [line_of(7, mark(robot, 7)) for robot in range(3)]
    assert result.errors == ""


def test_page_of_ff_erases_where_writes_replace(program: Compile, tmp_path: Path) -> None:
    assert printed(flash(program, tmp_path, "emulated_erase")) == [line_of(7, b"\xff" * 256)] * 3


@pytest.mark.parametrize(("value", "found"), [("NOR", "'NOR'"), (3, "3"), ([], "a list")])
def test_wrong_kind_of_write_is_refused(program: Compile, tmp_path: Path, value: object, found: str) -> None:
    result = flash(program, tmp_path, "read", {"flash": value})
    assert result.code == 2
    assert f": flash: expected overwrite or nor, found {found}" in result.errors


def test_data_file_mentions_flash_only_if_the_configuration_does(program: Compile, tmp_path: Path) -> None:
    without = flash(program, tmp_path / "without", "read").table().schema.metadata
    assert not any(b"flash" in value for value in without.values())
    nor = flash(program, tmp_path / "nor", "read", {"flash": "nor"}).table().schema.metadata
    assert b"flash: nor" in nor[b"resolved_configuration"]


def test_threads_make_no_difference(program: Compile, tmp_path: Path) -> None:
    settings: Settings = {"objects.robots.nb": 40, "flash": "nor"}
    hashes = []
    for threads in (1, 2):
        result = flash(program, tmp_path, "forgetful", {**settings, "threads": threads}, "--hash", "50")
        assert result.code == 0
        hashes.append(re.findall(r"state after step .*", result.output))
    assert hashes[0]
    assert hashes[0] == hashes[1]
