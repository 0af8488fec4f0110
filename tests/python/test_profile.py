"""`pogosim profile` tells where the cycles of a tick go: sums, shares, pictures, and what to change."""

from __future__ import annotations

import csv
import itertools
import json
import math
import re
import shutil
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pogosim.command import profile as command
from pogosim.command.main import main
from pogosim.firmware.profile.advice import advice_of, power_of_two_in
from pogosim.firmware.profile.costs import function_costs, hottest_lines, total_cycles
from pogosim.firmware.profile.flame import LEAST, MARGIN, WIDTH, flame_of
from pogosim.firmware.profile.load import load_of, percentile
from pogosim.firmware.profile.numbers import bytes_shown, percent, plain
from pogosim.firmware.profile.raw import Profile, read_profile
from pogosim.firmware.profile.report import report_of
from pogosim.firmware.profile.routines import FAMILIES, family_of, name_in_source
from pogosim.firmware.profile.sources import Sources
from pogosim.firmware.profile.table import COLUMNS
from pogosim.installation import Installation
from pogosim.system_packages import FOR_ROBOTS, how_to_install
from profiles import (
    BUDGET_CYCLES,
    CLOCK_HZ,
    SWARM_SOURCE,
    SWARM_STACKS,
    raw_profile,
    swarm_profile,
    write_profile,
)
from project import TEMPLATE, copy_template
from robot_sdk import TRIPLE, need
from running import ROOT

SVG = "{http://www.w3.org/2000/svg}"
LIBRARY_CYCLES = 1e-6 * CLOCK_HZ  # of a microsecond

Read = Callable[[dict[str, Any]], Profile]


@pytest.fixture(autouse=True)
def _in_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("POGOSIM_DIR", raising=False)


@pytest.fixture
def read(tmp_path: Path) -> Read:
    """Return a function that writes a profile, and reads it."""
    return lambda values: read_profile(write_profile(tmp_path / "read.json", values))


def profile(*arguments: str) -> int:
    try:
        return main(["profile", *arguments])
    except SystemExit as error:
        assert isinstance(error.code, int)
        return error.code


def refusal(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Return the one line that says what is wrong."""
    assert profile(*arguments) == 2
    found = capsys.readouterr()
    assert found.out == ""
    (line,) = found.err.splitlines()
    assert line.startswith("pogosim profile: ")
    return line.removeprefix("pogosim profile: ")


# ---- Load


def test_load_is_that_of_code_and_library(read: Read) -> None:
    ticks = [(1000.0 * number, 10.0) for number in range(100)]
    load = load_of(read(raw_profile({("main",): (0, 0, 0)}, ticks=ticks)))
    assert load.mean == pytest.approx(49_500 + 210)
    assert load.percentile == pytest.approx(94_000 + 210)
    assert load.worst == pytest.approx(99_000 + 210)
    assert load.worst_tick.number == 99
    assert load.share_of_calls == pytest.approx(210 / 49_710)
    assert load.share_over_budget == 0


def test_first_of_equally_bad_ticks_is_named(read: Read) -> None:
    load = load_of(read(raw_profile({("main",): (0, 0, 0)}, ticks=[(1, 0), (5, 0), (5, 0), (2, 0)])))
    assert load.worst_tick.number == 1


@pytest.mark.parametrize(
    ("count", "percent_", "rank"), [(1, 95, 1), (20, 95, 19), (21, 95, 20), (100, 95, 95), (4, 50, 2), (4, 100, 4)]
)
def test_percentile_is_the_nearest_rank(count: int, percent_: float, rank: int) -> None:
    assert percentile([float(value) for value in range(count, 0, -1)], percent_) == rank


@given(st.lists(st.floats(0, 1e6), min_size=1), st.floats(1, 100))
def test_percentile_is_the_least_value_that_so_many_do_not_exceed(values: list[float], percent_: float) -> None:
    found = percentile(values, percent_)
    wanted = math.ceil(len(values) * percent_ / 100)
    assert sum(value <= found for value in values) >= wanted
    assert sum(value < found for value in values) < wanted


def test_cycle_factor_multiplies_cycles_and_not_the_time_of_the_library(read: Read) -> None:
    profiles = [read(swarm_profile(cycle_factor=factor)) for factor in (1.0, 2.5)]
    of_library = 1000 * LIBRARY_CYCLES
    before, after = (total_cycles(one) for one in profiles)
    assert before == pytest.approx(1e6 + of_library)
    assert after == pytest.approx(2.5e6 + of_library)
    assert 10 * load_of(profiles[1]).mean == pytest.approx(after)
    assert hottest_lines(profiles[1])[0].cycles == 750_000
    assert hottest_lines(profiles[1])[0].instructions == 60_000


# ---- Functions and lines


def test_functions_have_own_and_total_cycles_and_callers(read: Read) -> None:
    found = read(swarm_profile())
    costs = {cost.name: cost for cost in function_costs(found)}
    assert next(iter(costs)) == "user_step"
    assert (costs["sqrt"].own, costs["sqrt"].total, costs["sqrt"].calls) == (300_000, 350_000, 100)
    assert costs["pogobot_led_setColor"].own == pytest.approx(10_000 + 1000 * LIBRARY_CYCLES)
    assert costs["main"].total == pytest.approx(total_cycles(found))
    assert costs["user_step"].file == "main.c"
    names = {found.functions[caller]: calls for caller, calls in costs["__adddf3"].callers.items()}
    assert names == {"sqrt": 100}


def test_recursion_counts_once(read: Read) -> None:
    stacks = {("f",): (10, 0, 1), ("f", "f"): (20, 0, 3), ("f", "f", "g", "f"): (30, 0, 5), ("f", "g"): (4, 0, 7)}
    costs = {cost.name: cost for cost in function_costs(read(raw_profile(stacks)))}
    assert (costs["f"].own, costs["f"].total, costs["f"].calls) == (60, 64, 9)
    assert (costs["g"].own, costs["g"].total, costs["g"].calls) == (4, 34, 7)


PATHS = st.lists(st.sampled_from("abcde"), min_size=1, max_size=6).map(tuple)
COSTS = st.tuples(st.integers(0, 10**6), st.integers(0, 100), st.integers(0, 9))


@given(stacks=st.dictionaries(PATHS, COSTS, min_size=1, max_size=30))
def test_own_cycles_add_up_to_all_and_totals_are_sums_over_stacks(
    stacks: dict[tuple[str, ...], tuple[float, float, float]], tmp_path_factory: pytest.TempPathFactory
) -> None:
    file = write_profile(tmp_path_factory.getbasetemp() / "any.json", raw_profile(stacks))
    found = read_profile(file)
    costs = function_costs(found)
    assert sum(cost.own for cost in costs) == pytest.approx(total_cycles(found))
    assert sum(cost.calls for cost in costs) == sum(calls for _, _, calls in stacks.values())
    for cost in costs:
        own = sum(cycles + us * LIBRARY_CYCLES for path, (cycles, us, _) in stacks.items() if path[-1] == cost.name)
        total = sum(cycles + us * LIBRARY_CYCLES for path, (cycles, us, _) in stacks.items() if cost.name in path)
        assert cost.own == pytest.approx(own)
        assert cost.total == pytest.approx(total)
    if total_cycles(found) > 0:
        check_flame(found)


# ---- Routines


@pytest.mark.parametrize(
    ("title", "names"),
    [
        ("double", "__adddf3 __subdf3 __muldf3 __divdf3 __fixdfsi __fixunsdfsi __floatsidf __floatunsidf __ledf2"),
        ("double", "__extendsfdf2 __truncdfsf2 sin cos sqrt pow exp atan2 _sin __ieee754_pow floor modf"),
        ("float", "__addsf3 __mulsf3 __divsf3 __fixsfsi __floatsisf __gesf2 sinf sqrtf powf _powf fmodf"),
        ("64-bit division", "__udivdi3 __divdi3 __umoddi3 __moddi3 __udivmoddi4"),
        ("32-bit division", "__udivsi3 __divsi3 __umodsi3 __modsi3"),
        ("printing", "printf vfprintf __d_vfprintf snprintf puts sprintf __i_vfprintf"),
    ],
)
def test_routines_are_known_by_name(title: str, names: str) -> None:
    for name in names.split():
        found = [family for family in FAMILIES if family.has(name)]
        assert [family.title for family in found] == [title], name


@pytest.mark.parametrize("name", ["main", "user_step", "sine", "my_printf", "pogobot_led_setColor", "msleep", "memcpy"])
def test_functions_of_programs_are_no_routines(name: str) -> None:
    assert family_of(name) is None


def test_names_are_those_of_the_source() -> None:
    names = ("_sin", "__ieee754_pow", "__kernel_cosf", "__d_vfprintf", "__muldf3", "sqrtf")
    assert [name_in_source(name) for name in names] == ["sin", "pow", "cosf", "vfprintf", "__muldf3", "sqrtf"]


# ---- Advice


def project_with(folder: Path, text: str) -> Sources:
    folder.mkdir(exist_ok=True)
    (folder / "main.c").write_text(text)
    return Sources([folder])


@pytest.mark.parametrize(
    ("routine", "source", "said"),
    [
        (
            "sqrt",
            "x = sqrt(y);",
            "`sqrt` in `step` (main.c:1): 40 % of the tick; `sqrtf` (float) takes about a seventh",
        ),
        ("_sin", "x = sin(y);", "`sin` in `step` (main.c:1): 40 % of the tick; `sinf` (float) takes about half"),
        ("sqrtf", "x = sqrtf(y);", "compare squares instead of roots"),
        ("cosf", "x = cosf (y);", "(main.c:1): 40 % of the tick; a table of values"),
        ("__muldf3", "x = y * 0.5;", "(main.c:1): 40 % of the tick; computing with float takes about half"),
        ("__divsf3", "x = y / 3.0f;", "(main.c:1): 40 % of the tick; computing with integers, or in fixed point"),
        ("printf", 'printf("%d", x);', "(main.c:1): 40 % of the tick; print less often"),
        ("__udivdi3", "x = y / z;", "(main.c:1): 40 % of the tick; a division of 32 bits"),
        ("__umodsi3", "x = y % z;", "(main.c:1): 40 % of the tick; multiply, or divide by a power of two"),
    ],
)
def test_routines_bring_advice(routine: str, source: str, said: str, read: Read, tmp_path: Path) -> None:
    stacks = {
        ("step",): (60.0, 0.0, 1.0),
        ("step", routine): (30.0, 0.0, 9.0),
        ("step", routine, "inner"): (10.0, 0.0, 9.0),
    }
    found = read(raw_profile(stacks, [("step", "main.c", 1, 60, 30)]))
    (advice,) = advice_of(found, project_with(tmp_path / "project", source))
    assert said in advice.text
    assert advice.share == pytest.approx(0.4)
    (without_source,) = advice_of(found, Sources([]))
    assert " in `step`: 40 % of the tick" in without_source.text


def test_code_that_does_not_fit_into_the_cache_brings_advice(read: Read) -> None:
    values = raw_profile({("step",): (1000.0, 0.0, 1.0)})
    assert advice_of(read(values), Sources([])) == []  # a profile of before says nothing of misses
    values["ticks"][0]["miss_cycles"] = 190
    assert advice_of(read(values), Sources([])) == []
    values["ticks"][0]["miss_cycles"] = 360
    (advice,) = advice_of(read(values), Sources([]))
    assert advice.text.startswith("waiting for code that is not in the instruction cache: 36 % of the tick; the code")


@pytest.mark.parametrize(("cycles", "count"), [(49, 0), (50, 1)])
def test_advice_is_for_large_shares(cycles: float, count: int, read: Read) -> None:
    stacks = {("step",): (1000 - cycles, 0.0, 1.0), ("step", "sqrt"): (cycles, 0.0, 9.0)}
    assert len(advice_of(read(raw_profile(stacks)), Sources([]))) == count


def test_what_a_routine_calls_is_its_own_and_counts_once(read: Read) -> None:
    stacks = {
        ("step", "printf"): (100.0, 0.0, 1.0),
        ("step", "printf", "vfprintf", "__muldf3"): (500.0, 0.0, 9.0),
        ("step", "sin", "__adddf3"): (400.0, 0.0, 9.0),
    }
    found = advice_of(read(raw_profile(stacks)), Sources([]))
    assert [advice.text.split(":")[0] for advice in found] == ["`printf` in `step`", "`sin` in `step`"]
    assert sum(advice.share for advice in found) == pytest.approx(1)


def test_routines_of_one_kind_in_one_function_are_one_advice(read: Read) -> None:
    routines = {"__adddf3": 30.0, "__muldf3": 40.0, "__divdf3": 20.0, "__ledf2": 10.0}
    (advice,) = advice_of(
        read(raw_profile({("f", name): (cost, 0.0, 1.0) for name, cost in routines.items()})), Sources([])
    )
    assert advice.text.startswith("`__muldf3`, `__adddf3`, `__divdf3` and others in `f`: 100 % of the tick")


@pytest.mark.parametrize(
    ("code", "divisor"),
    [
        ("x = y / 8;", 8),
        ("x = y % 16u + z;", 16),
        ("x /= 4;", None),
        ("x = y / 8.0f;", None),
        ("x = y / 10;", None),
        ("x = y / 1;", None),
        ("x = y / (z / 64UL);", 64),
        ("x = y / 0x10;", None),
        ("x = y / 8e3;", None),
    ],
)
def test_division_by_a_power_of_two_is_seen(code: str, divisor: int | None) -> None:
    assert power_of_two_in(code) == divisor


@pytest.mark.parametrize(("instructions", "count"), [(2, 1), (30, 0)])
def test_slow_division_by_a_power_of_two_brings_advice(
    instructions: int, count: int, read: Read, tmp_path: Path
) -> None:
    found = read(raw_profile({("step",): (100.0, 0.0, 1.0)}, [("step", "main.c", 1, 70, instructions)]))
    advice = advice_of(found, project_with(tmp_path / "project", "x = y / 8; // not / 16"))
    assert len(advice) == count
    for one in advice:
        assert "the division by 8 in `step` (main.c:1): 70 % of the tick" in one.text
        assert "a shift (>> 3) for /, and a mask (& 7) for %" in one.text


def test_tick_over_its_budget_comes_first(read: Read) -> None:
    ticks = [(0.5 * BUDGET_CYCLES, 0.0), (1.3 * BUDGET_CYCLES, 0.0), (0.2 * BUDGET_CYCLES, 0.0), (0.0, 0.0)]
    found = read(raw_profile({("step", "sqrt"): (1000.0, 0.0, 1.0)}, ticks=ticks))
    first, second = advice_of(found, Sources([]))
    assert "tick 1 of robot 0 takes 130 % of its budget, and 25 % of the ticks are over it" in first.text
    assert "lower main_loop_hz (60 ticks per second)" in first.text
    assert second.text.startswith("`sqrt`")


# ---- The report


def test_report_has_everything(capsys: pytest.CaptureFixture[str]) -> None:
    Path("main.c").write_text(SWARM_SOURCE)
    write_profile(Path("p.json"), swarm_profile())
    assert profile("p.json") == 0
    out = capsys.readouterr().out
    one_line = " ".join(out.split())
    assert "firmware.elf: 10 ticks of 1 robot, 60 ticks per second: a budget of 350000 cycles for each." in one_line
    assert "A tick takes 29 % of it on average (102100 cycles)" in one_line
    assert "Functions of the robots' library take 2.1 % of this time, and waiting for code that is not in" in one_line
    assert "in the instruction cache 0 %." in one_line
    rows = {line.split()[0]: line.split() for line in out.splitlines() if line.startswith("  ")}
    assert rows["sqrt"] == ["sqrt", "double", "10", "3500", "user_step"]  # the last table that names it
    assert rows["user_step"] == ["user_step", "38000", "37", "%", "100100", "98", "%", "1"]
    assert rows["main.c:2"][:6] == ["main.c:2", "30000", "29", "%", "6000", "user_step"]
    assert "sqrt(x * x + y * y)" in out
    assert "  function   source\n" in out
    used = (13040 + 64 + 712) / 1024
    assert f"Memory: {used:.1f} KiB of 128.0 KiB (11 %): program 12.7 KiB, variables 64 bytes" in one_line
    assert "- `sqrt` in `user_step` (main.c:2): 34 % of the tick" in one_line
    assert max(map(len, out.splitlines())) <= 120


def test_report_without_a_main_loop_has_no_budget(read: Read) -> None:
    text = " ".join(report_of(read(swarm_profile(loop_hz=0)), Sources([])))
    assert "no main loop, and so no budget. A tick takes 102100 cycles on average" in text
    assert "  function  source" not in text  # no source file is found


def test_report_says_if_stacks_and_ticks_differ(read: Read) -> None:
    values = swarm_profile()
    assert "The tables hold" not in " ".join(report_of(read(values), Sources([])))
    values["ticks"][0]["cycles"] += 50_000
    assert "The tables hold 1021000 cycles, and the ticks 1071000." in " ".join(report_of(read(values), Sources([])))


def test_long_tables_are_cut(read: Read) -> None:
    lines = report_of(read(raw_profile({(f"f{i}",): (i, 0, 1) for i in range(40)})), Sources([]))
    assert "  ... and 25 more; --csv FILE has all" in lines


def test_profile_without_cycles_has_a_report(read: Read) -> None:
    assert report_of(read(raw_profile({}, ticks=[(0, 0)])), Sources([]))


def test_numbers_are_short() -> None:
    assert [percent(share) for share in (0, 0.0001, 0.031, 0.314, 1.3)] == ["0 %", "< 0.1 %", "3.1 %", "31 %", "130 %"]
    assert [plain(value) for value in (0, 0.5, 1 / 3, 12.34, 99.96, 12345.6)] == [
        "0",
        "0.5",
        "0.33",
        "12.3",
        "100",
        "12346",
    ]
    assert [bytes_shown(count) for count in (1, 712, 13040)] == ["1 byte", "712 bytes", "12.7 KiB"]


def test_sources_are_found_by_their_paths_and_beside_the_project(tmp_path: Path) -> None:
    project = tmp_path / "project"
    (project / "lib").mkdir(parents=True)
    (project / "lib" / "a.c").write_text("one\n  two\n")
    (project / "b.c").write_text("three")
    sources = Sources([tmp_path / "elsewhere", project])
    places = [("lib/a.c", 2), (str(project / "lib" / "a.c"), 1), ("/gone/b.c", 1), ("b.c", 2), ("c.c", 1), ("b.c", 0)]
    assert [sources.text(*place) for place in places] == ["two", "one", "three", "", "", ""]


# ---- Files


def test_table_is_tidy(capsys: pytest.CaptureFixture[str]) -> None:
    write_profile(Path("p.json"), swarm_profile())
    assert profile("p.json", "--csv", "t.csv") == 0
    assert capsys.readouterr().out == ""
    with Path("t.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS
    functions = [row for row in rows if row["kind"] == "function"]
    assert sum(float(row["share"]) for row in functions) == pytest.approx(1)
    assert sum(float(row["self_cycles_per_tick"]) for row in functions) == pytest.approx(102_100)
    (line,) = (row for row in rows if row["line"] == "2")
    assert (line["function"], line["file"], float(line["self_cycles_per_tick"])) == ("user_step", "main.c", 30_000)
    assert (line["total_cycles_per_tick"], line["calls_per_tick"]) == ("", "")


def check_flame(found: Profile) -> list[ET.Element]:
    """Check that the boxes of a flame graph are as wide as their shares; returns its groups."""
    root = ET.fromstring(flame_of(found))
    assert root.tag == f"{SVG}svg"
    groups = root.findall(f"{SVG}g")
    boxes = [box for group in groups if (box := group.find(f"{SVG}rect")) is not None]
    by_row: dict[str, list[tuple[float, float]]] = {}
    for box in boxes:
        by_row.setdefault(box.attrib["y"], []).append((float(box.attrib["x"]), float(box.attrib["width"])))
    rows = [sorted(by_row[y]) for y in sorted(by_row, key=float, reverse=True)]
    assert rows[0] == [(MARGIN, WIDTH - 2 * MARGIN)]
    for below, row in itertools.pairwise(rows):
        for x, width in row:
            assert any(left - 0.01 <= x and x + width <= left + wide + 0.01 for left, wide in below)
        assert all(x + width <= after + 0.01 for (x, width), (after, _) in itertools.pairwise(row))
    return groups


def test_flame_graph_has_a_box_for_each_path_as_wide_as_its_cycles(read: Read) -> None:
    found = read(swarm_profile())
    boxes: dict[str, float] = {}
    for group in check_flame(found):
        title, box = group.find(f"{SVG}title"), group.find(f"{SVG}rect")
        assert title is not None
        assert title.text is not None
        assert box is not None
        boxes[title.text] = float(box.attrib["width"])
    width = WIDTH - 2 * MARGIN
    assert len(boxes) == 1 + len(SWARM_STACKS)
    assert boxes["sqrt: 35000 cycles per tick, 34 %; 30000 of its own; calls per tick: 10"] == pytest.approx(
        width * 350_000 / 1_021_000, abs=0.01
    )
    assert boxes[
        "pogobot_led_setColor: 3100 cycles per tick, 3.0 %; 3100 of its own; calls per tick: 1"
    ] == pytest.approx(width * 31_000 / 1_021_000, abs=0.01)


def test_flame_graph_escapes_names_and_has_no_scripts(read: Read) -> None:
    text = flame_of(read(raw_profile({('operator<<(A&, "b")',): (10, 0, 1)})))
    assert "operator&lt;&lt;(A&amp;" in text
    assert not re.search("<script|onload|href", text)
    ET.fromstring(text)


def test_flame_graph_leaves_out_what_cannot_be_seen(read: Read) -> None:
    total = 2 * WIDTH / LEAST
    groups = check_flame(read(raw_profile({("f",): (total, 0, 1), ("f", "g"): (1, 0, 1)})))
    assert len(groups) == 2


def test_flame_graph_of_a_deep_recursion(read: Read) -> None:
    groups = check_flame(read(raw_profile({("f",) * 3000: (10, 0, 1)})))
    assert len(groups) == 3001


def test_trace_has_the_calls_of_each_robot() -> None:
    spans = [
        {"robot": 0, "name": 2, "begin_us": 10.0, "duration_us": 12.5, "depth": 0},
        {"robot": 3, "name": 6, "begin_us": 11.0, "duration_us": 2.5, "depth": 1},
    ]
    robots = [{"id": 0, "category": "robots"}, {"id": 3, "category": "ants"}]
    write_profile(Path("p.json"), swarm_profile(spans=spans, robots=robots))
    assert profile("p.json", "--trace", "t.json") == 0
    trace = json.loads(Path("t.json").read_text())
    names = {event["pid"]: event["args"]["name"] for event in trace["traceEvents"] if event["ph"] == "M"}
    assert names == {0: "robots #0", 3: "ants #3"}
    calls = [event for event in trace["traceEvents"] if event["ph"] == "X"]
    assert [(call["name"], call["ts"], call["dur"], call["pid"]) for call in calls] == [
        ("user_step", 10.0, 12.5, 0),
        ("pogobot_led_setColor", 11.0, 2.5, 3),
    ]
    assert [call["cat"] for call in calls] == ["program", "library"]


def test_kept_profile_is_the_same_and_the_report_may_come_with_files(capsys: pytest.CaptureFixture[str]) -> None:
    write_profile(Path("p.json"), swarm_profile())
    assert profile("p.json", "--raw", "q.json", "--flame", "f.svg", "--text") == 0
    assert Path("q.json").read_bytes() == Path("p.json").read_bytes()
    first = capsys.readouterr().out
    assert "Functions, by their own cycles" in first
    assert profile("q.json") == 0
    assert capsys.readouterr().out == first


# ---- What is no profile


def changed(path: str, value: object) -> dict[str, Any]:
    """Return a profile with another value at a place, such as "ticks.0.cycles"."""
    values: Any = swarm_profile()
    *parents, last = [int(part) if part.isdigit() else part for part in path.split(".")]
    node = values
    for parent in parents:
        node = node[parent]
    node[last] = value
    assert isinstance(values, dict)
    return values


@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        ("version", 2, "p.json: its version is 2, expected 1; make the profile again"),
        ("clock_hz", 0, "p.json, 'clock_hz': expected a number above 0, found 0"),
        ("cycle_factor", None, "p.json, 'cycle_factor': expected a number above 0, found null"),
        ("ticks", {}, "p.json, 'ticks': expected a list of objects, found {}"),
        ("ticks.3.cycles", "x", "p.json: ticks[3], 'cycles': expected a number of 0 or more, found \"x\""),
        ("ticks.3.tick", 1.5, "p.json: ticks[3], 'tick': expected a whole number of 0 or more, found 1.5"),
        ("ticks.3.call_us", -1, "p.json: ticks[3], 'call_us': expected a number of 0 or more, found -1"),
        ("functions", ["a", 1], "p.json, 'functions': expected a list of texts, found [\"a\", 1]"),
        (
            "stacks.0.frames",
            [],
            "p.json: stacks[0], 'frames': expected a list of places in 'functions', of which there",
        ),
        ("stacks.1.frames", [0, 99], "of which there are 9, found [0, 99]"),
        ("stacks.1.frames", [True], "of which there are 9, found [true]"),
        ("lines.0.function", -1, "p.json: lines[0], 'function': expected a place in 'functions', of which there are 9"),
        ("lines.0.file", None, "p.json: lines[0], 'file': expected a text, found null"),
        ("ticks", [], "p.json: no tick ended, so there is nothing to report: the run was shorter than a tick"),
        ("ticks.0.cycles", float("nan"), "p.json: ticks[0], 'cycles': expected a number of 0 or more, found NaN"),
    ],
)
def test_wrong_values_are_named(path: str, value: object, reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    write_profile(Path("p.json"), changed(path, value))
    assert reason in refusal(capsys, "p.json")


def test_missing_values_are_named(capsys: pytest.CaptureFixture[str]) -> None:
    values = swarm_profile()
    del values["stacks"][2]["calls"]
    write_profile(Path("p.json"), values)
    assert "p.json: stacks[2] has no 'calls', a number of 0 or more" in refusal(capsys, "p.json")


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "p.json:1: it is not JSON (Expecting value); expected a profile (JSON)"),
        (b'{\n"version": 1,\n}', "p.json:3: it is not JSON"),
        (b"\xff\xfe{", "p.json is not text in UTF-8"),
        (b"[1, 2]", "p.json is JSON, but no profile: it has no 'version' and 'stacks'"),
        (b'{"version": 1}', "p.json is JSON, but no profile"),
        (b"[" * 100_000, "p.json is not JSON that can be read"),
    ],
)
def test_other_files_are_refused(data: bytes, reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("p.json").write_bytes(data)
    assert reason in refusal(capsys, "p.json")


def test_missing_files_and_wrong_words_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert refusal(capsys, "p.json") == "p.json: no such file or directory"
    assert "expected a firmware (.elf), the folder of a project" in refusal(capsys)
    assert "as the first word" in refusal(capsys, "-c", "conf.yaml", "fw.elf")
    write_profile(Path("p.json"), swarm_profile())
    assert "expected no options of the simulator" in refusal(capsys, "p.json", "-c", "conf.yaml")
    assert "'0' is not a whole number of 1 or more" in refusal(capsys, "p.json", "--robots", "0")


def test_outputs_are_checked_before_the_run(capsys: pytest.CaptureFixture[str]) -> None:
    write_profile(Path("p.json"), swarm_profile())
    before = Path("p.json").read_bytes()
    assert "would take the place of p.json" in refusal(capsys, "p.json", "--raw", "p.json")
    assert refusal(capsys, "p.json", "--flame", "f.png") == "f.png does not end in .svg"
    assert "there is no folder" in refusal(capsys, "p.json", "--csv", "no/t.csv")
    assert "--trace and --raw name the same file" in refusal(capsys, "p.json", "--trace", "x.json", "--raw", "x.json")
    assert "has no calls of the first ticks" in refusal(capsys, "p.json", "--trace", "x.json")
    assert Path("p.json").read_bytes() == before
    assert [path.name for path in Path().iterdir()] == ["p.json"]


# ---- Runs


SIMULATOR = """#!/bin/sh
echo "$@" >{folder}/called.txt
while [ $# -gt 0 ]; do
    case $1 in
        --firmware) cp "$2" {folder}/firmware.elf;;
        --profile) raw=$2;;
    esac
    shift
done
{does}
"""
ELF = b"\x7fELF".ljust(18, b"\0") + b"\xf3\0"


@pytest.fixture
def simulator(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Path]:
    """Return a function that puts a simulator in place, given what it does with $raw; returns where its words are."""
    folder = tmp_path / "simulator"
    folder.mkdir()
    write_profile(folder / "made.json", swarm_profile())

    def place(does: str = f"cp {folder}/made.json $raw") -> Path:
        program = folder / "without-program"
        program.write_text(SIMULATOR.format(folder=folder, does=does))
        program.chmod(0o755)
        unused = folder / "unused"
        installed = Installation(ROOT, unused, "0.11.0", unused, TEMPLATE, unused, program, ())
        monkeypatch.setattr(command, "find_installation", lambda: installed)
        return folder / "called.txt"

    return place


def test_firmware_is_run_with_the_options_of_the_simulator(
    simulator: Callable[[], Path], capfd: pytest.CaptureFixture[str]
) -> None:
    called = simulator()
    Path("fw.elf").write_bytes(ELF)
    assert profile("fw.elf", "-c", "c.yaml", "--robots", "3", "--set", "seed=4", "--raw", "kept.json", "-s", "1") == 0
    words = called.read_text().split()
    assert words[:5] == ["-g", "-q", "-nr", "--set", "enable_data_logging=false"]
    assert words[words.index("--firmware") + 1] == "fw.elf"
    assert words[words.index("--profile-robots") + 1] == "3"
    assert words[-6:] == ["-c", "c.yaml", "--set", "seed=4", "-s", "1"]
    assert json.loads(Path("kept.json").read_text()) == swarm_profile()
    assert capfd.readouterr().out == ""
    assert not Path(words[words.index("--profile") + 1]).exists()


@pytest.mark.parametrize(
    ("does", "code"), [("echo 'Error: c.yaml:3: no' >&2; exit 2", 2), ("exit 3", 3), ("kill -9 $$", 137)]
)
def test_failed_run_gives_its_exit_code_and_its_own_message(
    does: str, code: int, simulator: Callable[[str], Path], capfd: pytest.CaptureFixture[str]
) -> None:
    simulator(does)
    Path("fw.elf").write_bytes(ELF)
    assert profile("fw.elf", "-c", "c.yaml", "--csv", "t.csv") == code
    found = capfd.readouterr()
    assert (found.out, found.err) == ("", "Error: c.yaml:3: no\n" if code == 2 else "")
    assert not Path("t.csv").exists()


def test_run_without_a_profile_is_an_error(simulator: Callable[[str], Path], capfd: pytest.CaptureFixture[str]) -> None:
    simulator("true")
    Path("fw.elf").write_bytes(ELF)
    assert "has written no profile: is it of another version?" in refusal(capfd, "fw.elf", "-c", "c.yaml")


def test_profile_of_a_run_just_made_is_not_called_by_its_temporary_name(
    simulator: Callable[[str], Path], capfd: pytest.CaptureFixture[str]
) -> None:
    Path("fw.elf").write_bytes(ELF)
    write_profile(Path("empty.json"), raw_profile({("main",): (0, 0, 0)}, ticks=[]))
    simulator(f"cp {Path('empty.json').absolute()} $raw")
    assert refusal(capfd, "fw.elf", "-c", "c.yaml").startswith("the profile of this run: no tick ended, so there is")
    assert refusal(capfd, "empty.json").startswith("empty.json: no tick ended, so there is")
    simulator("echo 1 >$raw")
    assert refusal(capfd, "fw.elf", "-c", "c.yaml").startswith("the profile of this run is JSON, but no profile: ")


CONFIGURATION = {
    "arena_file": "my.csv",
    "formation_filename": "formation.csv",
    "data_filename": "results/data.csv",
    "magnetometer": {"csv": {"file": "table.csv"}},
    "flash_state": {"input_file": "old.json", "output_file": "new.json"},
    "objects": {"robots": [{"robot_model": "model.yaml"}, {"function_costs": "conf/costs.yaml"}]},
}


@pytest.fixture
def inputs(simulator: Callable[[], Path]) -> None:
    """Write a configuration and all files that it names, a firmware, and links to some of them."""
    simulator()
    for folder in ("conf", "results", "build"):
        Path(folder).mkdir()
    for name in ("my.csv", "conf/formation.csv", "table.csv", "old.json", "new.json", "other.csv", "script.yaml"):
        Path(name).write_text(name)
    for name in ("conf/costs.yaml", "results/data.csv", "results/data.csv.yaml", "data.feather", "build/weights.csv"):
        Path(name).write_text(name)
    Path("fw.elf").write_bytes(ELF)
    Path("conf/c.json").write_text(json.dumps(CONFIGURATION))
    Path("model.yaml").write_text("brain: {script: script.yaml}")
    Path("main.c").write_text('#include "build/weights.csv"\n')
    for name, target in (("a.csv", "my.csv"), ("source.csv", "main.c"), ("data.svg", "data.feather")):
        Path(name).symlink_to(target)
    Path("hard.csv").hardlink_to("my.csv")


@pytest.mark.parametrize(
    ("option", "output", "said"),
    [
        ("raw", "conf/c.json", "conf/c.json, the configuration"),
        ("csv", "my.csv", "my.csv, arena_file of conf/c.json"),
        ("csv", "a.csv", "my.csv, arena_file of conf/c.json"),
        ("csv", "hard.csv", "my.csv, arena_file of conf/c.json"),
        ("csv", "conf/formation.csv", "conf/formation.csv, formation_filename of conf/c.json"),
        ("csv", "table.csv", "table.csv, magnetometer.csv.file of conf/c.json"),
        ("raw", "old.json", "old.json, flash_state.input_file of conf/c.json"),
        ("trace", "new.json", "new.json, flash_state.output_file of conf/c.json"),
        ("costs", "model.yaml", "model.yaml, objects.robots.0.robot_model of conf/c.json"),
        ("costs", "script.yaml", "script.yaml, brain.script of model.yaml"),
        ("csv", "results/data.csv", "results/data.csv, data_filename of conf/c.json"),
        ("costs", "results/data.csv.yaml", "results/data.csv.yaml, the metadata of results/data.csv"),
        ("csv", "other.csv", "other.csv, arena_file of the command line"),
        ("csv", "source.csv", "{folder}/main.c, a source file of the program"),
        ("csv", "build/weights.csv", "{folder}/build/weights.csv, a source file of the program"),
    ],
)
@pytest.mark.usefixtures("inputs")
def test_no_output_takes_the_place_of_a_file_of_the_run(
    option: str, output: str, said: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    arguments = ["fw.elf", "-c", "conf/c.json", "--set", "arena_file=other.csv", f"--{option}", output]
    place = said.format(folder=tmp_path)
    assert refusal(capfd, *arguments) == f"--{option} would take the place of {place}; name another output"


@pytest.mark.usefixtures("inputs")
def test_files_that_are_no_inputs_are_replaced(capfd: pytest.CaptureFixture[str]) -> None:
    assert profile("fw.elf", "-c", "conf/c.json", "--csv", "other.csv") == 0, capfd.readouterr().err
    assert Path("other.csv").read_text().startswith(",".join(COLUMNS))


@pytest.mark.parametrize("words", [["-cconf/c.json"], ["--config=conf/c.json"], ["-s", "1", "--config", "conf/c.json"]])
@pytest.mark.usefixtures("inputs")
def test_configuration_is_an_input_however_it_is_named(words: list[str], capfd: pytest.CaptureFixture[str]) -> None:
    assert refusal(capfd, "fw.elf", *words, "--raw", "conf/c.json").endswith("the configuration; name another output")


@pytest.mark.parametrize("word", ["--set=arena_file=other.csv", "--video=other.csv", "other.csv"])
@pytest.mark.usefixtures("inputs")
def test_files_of_the_command_line_are_inputs(word: str, capfd: pytest.CaptureFixture[str]) -> None:
    said = refusal(capfd, "fw.elf", "-c", "conf/c.json", word, "--csv", "other.csv")
    assert "--csv would take the place of other.csv, " in said
    assert "the command line" in said


@pytest.mark.usefixtures("inputs")
def test_data_file_without_a_name_in_the_configuration_is_an_input(capfd: pytest.CaptureFixture[str]) -> None:
    Path("short.yaml").write_text("arena_file: my.csv\n")
    said = refusal(capfd, "fw.elf", "-c", "short.yaml", "--flame", "data.svg")
    assert said == "--flame would take the place of data.feather, data_filename of the run; name another output"


@pytest.mark.usefixtures("inputs")
def test_reports_of_a_kept_profile_take_no_sources_place(capfd: pytest.CaptureFixture[str]) -> None:
    write_profile(Path("p.json"), swarm_profile())
    assert "main.c, a source file of the program" in refusal(capfd, "p.json", "--csv", "source.csv")
    assert Path("main.c").read_text().startswith("#include")


def test_what_is_no_program_is_refused(simulator: Callable[[], Path], capsys: pytest.CaptureFixture[str]) -> None:
    called = simulator()
    Path("x.bin").write_bytes(b"x")
    Path("fw.elf").write_bytes(ELF)
    Path("folder").mkdir()
    assert "there is no firmware, project, source file or profile y" in refusal(capsys, "y", "-c", "c.yaml")
    assert "x.bin is no firmware of a robot" in refusal(capsys, "x.bin", "-c", "c.yaml")
    assert refusal(capsys, "fw.elf") == "expected a configuration: -c CONFIG"
    assert "folder is not a project: it has no Makefile" in refusal(capsys, "folder", "-c", "c.yaml")
    Path("folder/Makefile").write_text("all:\n")
    assert "folder/Makefile cannot make firmware for emulated robots" in refusal(capsys, "folder", "-c", "c.yaml")
    assert not called.exists()


def test_missing_compiler_is_one_clear_line(
    simulator: Callable[[], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    simulator()
    copy_template(tmp_path / "swarm")
    monkeypatch.setenv("PATH", str(tmp_path))
    advice = f"is not installed ({how_to_install(FOR_ROBOTS)})"
    assert refusal(capsys, "swarm") == f"the compiler for robots, {TRIPLE}-gcc, {advice}"
    shutil.copy(TEMPLATE / "main.c", "one.c")
    assert refusal(capsys, "one.c", "-c", "c.yaml") == f"the compiler for robots, {TRIPLE}-gcc, {advice}"


@pytest.mark.parametrize("what", ["swarm", "files/one.c"])
def test_firmware_of_projects_and_source_files_is_made_first(
    what: str, simulator: Callable[[], Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    need(f"{TRIPLE}-gcc")
    called = simulator()
    copy_template(tmp_path / "swarm")
    Path("files").mkdir()
    text = (TEMPLATE / "main.c").read_text()
    Path("files/one.c").write_text(f'#include "own.h"\n{text}')
    Path("files/own.h").write_text("#pragma once\n")
    arguments = [] if what == "swarm" else ["-c", "c.yaml"]
    assert profile(what, *arguments) == 0, capfd.readouterr().err
    assert "Functions, by their own cycles" in capfd.readouterr().out
    made = called.parent / "firmware.elf"
    assert made.read_bytes().startswith(b"\x7fELF")
    words = called.read_text().split()
    assert words[-2:] == ["-c", "swarm/conf/test.yaml" if what == "swarm" else "c.yaml"]
    assert sorted(path.name for path in Path("files").iterdir()) == ["one.c", "own.h"]


def test_program_that_does_not_compile_is_an_error(
    simulator: Callable[[], Path], capfd: pytest.CaptureFixture[str]
) -> None:
    need(f"{TRIPLE}-gcc")
    simulator()
    Path("one.c").write_text("no C")
    assert profile("one.c", "-c", "c.yaml") == 2
    found = capfd.readouterr()
    assert found.out == ""
    assert found.err.splitlines()[-1] == "pogosim profile: one.c cannot be built; see the messages above"
