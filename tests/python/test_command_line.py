"""The command line of every program, and what it prints."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import Compile
from running import Run, example, run, run_command, write_scene

DATED = re.compile(r"\[\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3}\] \[(debug|info|warning|error)\] ")
GREETING = "[ROBOT #0] [PRINTF] HELLO WORLD! I am robot 0. Time: 0 ms, stopwatch: 0 us, ticks: 0"


def hello(folder: Path, *arguments: str, **settings: object) -> Run:
    return run(example("helloworld"), folder, settings, arguments)


def command(folder: Path, *arguments: str) -> Run:
    write_scene(folder, {})
    return run_command(example("helloworld"), folder, arguments)


def assert_wrong_usage(result: Run, what: str) -> None:
    assert result.code == 2
    assert result.output == ""
    message, usage = result.errors.splitlines()
    assert message.startswith("Error: ")
    assert what in message
    assert usage == "Usage: helloworld -c FILE [options]; -h lists them"


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        ([], "--config is required"),
        (["-g"], "--config is required"),
        (["-c"], "--config needs a value"),
        (["-c", "scene.yaml", "-s"], "--seed needs a value"),
        (["-c", "scene.yaml", "-c", "scene.yaml"], "--config can be given only once"),
        (["-c", "scene.yaml", "-s", "1", "-s", "2"], "--seed can be given only once"),
        (["-c", "scene.yaml", "--set"], "--set needs a value"),
        (["-c", "scene.yaml", "--set", "seed=1", "--set", "threads=1", "--hash"], "--hash needs a value"),
        (["-x"], "unknown argument '-x'"),
        (["-c", "scene.yaml", "-x"], "unknown argument '-x'"),
        (["-c", "scene.yaml", "--sead", "3"], "unknown argument '--sead'; did you mean '--seed'?"),
        (["-c", "scene.yaml", "--noGUI"], "did you mean '--no-GUI'?"),
        (["-c", "scene.yaml", "more"], "unknown argument 'more'"),
        (["-c", "scene.yaml", "-c", "scene.yaml"], "--config"),
    ],
)
def test_wrong_usage_ends_with_2_one_message_and_a_line_of_usage(
    tmp_path: Path, arguments: list[str], what: str
) -> None:
    assert_wrong_usage(command(tmp_path, *arguments), what)


@pytest.mark.parametrize("seed", ["-1", "4294967296", "99999999999999999999", "1e3", "0x10", "3.0", "abc", ""])
def test_seed_that_is_no_number_of_32_bits_is_refused(tmp_path: Path, seed: str) -> None:
    what = f"--seed: expected a whole number from 0 to 4294967295, found '{seed}'"
    assert_wrong_usage(command(tmp_path, "-c", "scene.yaml", "-s", seed), what)


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["-c", "none.yaml"], "cannot read the configuration 'none.yaml': No such file or directory"),
        (["-c", "."], "a folder"),
        (["-c", "scene.yaml", "--set", "objects"], "expected key.path=value"),
        (["-c", "scene.yaml", "--set", "objects.robots.nb=many"], "objects.robots.nb: expected an integer"),
        (["-c", "scene.yaml", "--set", "simulation_time=-1"], "simulation_time"),
        (["-c", "scene.yaml", "--set", "arena_file=none.csv"], "none.csv"),
        (["-c", "scene.yaml", "--set", "log_format=purple"], "log_format"),
        (["-c", "scene.yaml", "--set", "data_filename="], "data_filename"),
    ],
)
def test_wrong_configuration_ends_with_2_and_one_line(tmp_path: Path, arguments: list[str], what: str) -> None:
    result = command(tmp_path, *arguments)
    assert result.code == 2
    assert result.output == ""
    assert result.errors.startswith("Error: ")
    assert result.errors.count("\n") == 1
    assert what in result.errors


@pytest.mark.parametrize("flag", ["-h", "--help"])
def test_help_names_every_option_and_exit_code(tmp_path: Path, flag: str) -> None:
    result = command(tmp_path, flag)
    assert (result.code, result.errors) == (0, "")
    options = (
        "-c,--config -g,--no-GUI -v,--verbose -q,--quiet -nr --do-not-show-robot-msg -s,--seed -P,--progress "
        "-V,--version -h,--help --set --strict"
    )
    for option in options.split():
        assert option in result.output
    assert "0 success, 2 usage, configuration or file error, 3 the program failed, 130 interrupted" in result.output


@pytest.mark.parametrize("flag", ["-V", "--version"])
def test_version_is_that_of_the_data_file(tmp_path: Path, flag: str) -> None:
    version = command(tmp_path, flag)
    assert (version.code, version.errors) == (0, "")
    first, *built = version.output.splitlines()
    saved = hello(tmp_path).table().schema.metadata
    assert first == f"pogosim {saved[b'program_version'].decode()}"
    assert [line.split(": ")[0] for line in built] == ["commit", "compiler", "engines", "Arrow"]
    assert built[0] == f"commit: {saved[b'program_commit'].decode()}"


@pytest.mark.parametrize("more", ["extra", "--json"])
def test_version_with_what_it_does_not_know_is_refused(tmp_path: Path, more: str) -> None:
    result = command(tmp_path, "--version", more)
    assert (result.code, result.output) == (2, "")
    assert result.errors.startswith(f"Error: unknown argument '{more}'")


@pytest.mark.parametrize(
    ("short", "long"),
    [
        (["-c", "scene.yaml", "-g"], ["--config", "scene.yaml", "--no-GUI"]),
        (["-c", "scene.yaml", "-g", "-v"], ["--config=scene.yaml", "--no-GUI", "--verbose"]),
        (["-c", "scene.yaml", "-g", "-q"], ["--config", "scene.yaml", "--no-GUI", "--quiet"]),
        (["-g", "-q", "-c", "scene.yaml"], ["--quiet", "--no-GUI", "--config", "scene.yaml"]),
        (["-c", "scene.yaml", "-g", "-nr"], ["--config", "scene.yaml", "--no-GUI", "--do-not-show-robot-msg"]),
        (["-c", "scene.yaml", "-g", "-s", "7"], ["--config", "scene.yaml", "--no-GUI", "--seed", "7"]),
    ],
)
def test_short_and_long_options_do_the_same(tmp_path: Path, short: list[str], long: list[str]) -> None:
    results = [command(tmp_path / "short", *short), command(tmp_path / "long", *long)]
    assert [result.code for result in results] == [0, 0]
    assert DATED.sub("", results[0].text) == DATED.sub("", results[1].text)
    assert (tmp_path / "short/data.feather").read_bytes() == (tmp_path / "long/data.feather").read_bytes()


@pytest.mark.parametrize("flag", ["-P", "--progress"])
def test_progress_bar_reaches_100_percent_on_the_error_output(tmp_path: Path, flag: str) -> None:
    result = hello(tmp_path, flag, "-q")
    assert (result.code, result.output) == (0, "")
    bars = result.errors.splitlines()
    assert 2 <= len(bars) <= 12
    assert re.fullmatch(r"\[#{40}\] 100 %  2\.0 s simulated in .*", bars[-1])


def test_without_the_flag_there_is_no_progress_bar(tmp_path: Path) -> None:
    assert "#]" not in hello(tmp_path).text


def test_run_says_in_one_line_what_it_did(tmp_path: Path) -> None:
    result = hello(tmp_path)
    assert (result.code, result.errors) == (0, "")
    said = r"2 s of 3 robots simulated in \d+\.\d\d s, \S+ x real time; 63 rows in 'data\.feather'"
    assert re.fullmatch(said, result.summary)
    assert "simulated in" not in result.output
    assert hello(tmp_path, "-P").summary
    for quiet in ([], ["-P"]):
        assert hello(tmp_path, "-q", *quiet).summary == ""
    without = hello(tmp_path, "--set", "enable_data_logging=false", "--set", "objects.robots.nb=1")
    assert re.fullmatch(
        r"2 s of 1 robot simulated in .* x real time; no data file \(enable_data_logging: false\)", without.summary
    )


@pytest.mark.parametrize("seed", ["0", "4294967295"])
def test_seed_of_the_command_line_wins_and_is_saved(tmp_path: Path, seed: str) -> None:
    assert hello(tmp_path, "-s", seed).code == 0
    configuration = (tmp_path / "scene.yaml").read_text()
    assert "seed: 1" in configuration
    saved = Run(0, "", "", tmp_path).table().schema.metadata[b"configuration"].decode()
    assert f"\nseed: {seed}\n" in f"\n{saved}"


def test_run_without_a_seed_draws_one_that_repeats_the_run(tmp_path: Path) -> None:
    first = hello(tmp_path / "a", seed=None)
    second = hello(tmp_path / "b", seed=None)
    assert not np.array_equal(first.frame()["x"], second.frame()["x"])
    (seed,) = re.findall(r"^seed: (\d+)$", first.table().schema.metadata[b"configuration"].decode(), re.MULTILINE)
    again = hello(tmp_path / "c", "-s", seed, seed=None)
    assert again.frame().equals(first.frame())


def test_set_reaches_any_depth_and_the_last_one_wins(tmp_path: Path) -> None:
    result = hello(
        tmp_path, "--set", "objects.robots.nb=9", "--set", "objects.robots.nb=5", "--set", "save_data_period=0.5"
    )
    assert result.code == 0
    assert len(result.frame()) == 5 * 5


def test_unknown_key_warns_once_and_strict_refuses_it(tmp_path: Path) -> None:
    result = hello(tmp_path, simulation_tine=3)
    assert result.code == 0
    warnings = result.errors.splitlines()
    assert len(warnings) == 1
    assert re.search(r"scene\.yaml:\d+: unknown key 'simulation_tine'.*did you mean 'simulation_time'\?", warnings[0])
    strict = hello(tmp_path, "--strict", simulation_tine=3)
    assert strict.code == 2
    assert re.search(r"scene\.yaml:\d+: unknown key 'simulation_tine'", strict.errors)


# ---- What is printed ----


def test_lines_have_a_date_and_a_level(tmp_path: Path) -> None:
    (line,) = hello(tmp_path).output.splitlines()
    assert DATED.match(line)
    assert DATED.sub("", line) == GREETING


def test_minimal_format_prints_the_text_alone(tmp_path: Path) -> None:
    result = hello(tmp_path, log_format="minimal", enable_console_logging=True)
    assert result.output == GREETING + "\n"
    file = (tmp_path / "console.txt").read_text()
    assert DATED.match(file)
    assert file.endswith(GREETING + "\n")


@pytest.mark.parametrize("flags", [[], ["-nr"], ["-q"], ["-q", "-nr"], ["-q", "-v"]])
def test_console_file_has_the_robots_lines_whatever_the_console_shows(tmp_path: Path, flags: list[str]) -> None:
    console = tmp_path / "new" / "console.txt"
    result = hello(tmp_path, *flags, enable_console_logging=True, console_filename=str(console))
    assert result.code == 0
    assert (GREETING in result.text) == (flags == [])
    assert GREETING in console.read_text()


def test_console_file_starts_anew_with_each_run(tmp_path: Path) -> None:
    for _ in range(2):
        hello(tmp_path, enable_console_logging=True)
    assert (tmp_path / "console.txt").read_text().count(GREETING) == 1


def test_console_file_that_cannot_be_written_is_an_error_that_names_it(tmp_path: Path) -> None:
    for path in ("/dev/null/console.txt", "."):
        result = hello(tmp_path, enable_console_logging=True, console_filename=path)
        assert result.code == 2
        assert f"cannot open the console file '{path}' (console_filename)" in result.errors


def test_console_file_with_the_name_of_a_folder_leaves_none(tmp_path: Path) -> None:
    result = hello(tmp_path, enable_console_logging=True, console_filename="new/console/")
    assert result.code == 2
    assert "(console_filename): this is the name of a folder, not of a file" in result.errors
    assert not (tmp_path / "new").exists()


def test_console_file_on_a_full_disk_is_an_error_and_the_data_file_complete(tmp_path: Path) -> None:
    result = hello(tmp_path, "-q", enable_console_logging=True, console_filename="/dev/full")
    assert result.code == 2
    assert result.errors.startswith("Error: cannot write the console file (console_filename): ")
    assert "/dev/full: No space left on device" in result.errors
    assert result.errors.count("\n") == 1
    assert result.frame()["time"].max() == 2


def test_only_verbose_shows_debug_messages_and_quiet_wins(tmp_path: Path) -> None:
    for flags, expected in (([], False), (["-v"], True), (["-v", "-q"], False)):
        result = hello(tmp_path, *flags)
        assert ("[debug] seed 1, 3 robots" in result.text) == expected


def test_quiet_run_prints_nothing(tmp_path: Path) -> None:
    assert hello(tmp_path, "-q").text == ""


def test_quiet_run_still_shows_warnings(tmp_path: Path) -> None:
    result = hello(tmp_path, "-q", arena_colour="red")
    assert "unknown key 'arena_colour'" in result.errors


def lines_of(result: Run, robot: int) -> list[str]:
    prefix = f"[ROBOT #{robot}] [PRINTF] "
    return [line[len(prefix) :] for line in result.robot_lines if line.startswith(prefix)]


def test_partial_lines_of_different_robots_do_not_mix(program: Compile, tmp_path: Path) -> None:
    result = run(program("console.c"), tmp_path, {"objects.robots.nb": 4})
    assert result.code == 0
    for robot in range(4):
        expected = [f"robot {robot} has a line", "a", "", "b", "kept until now"]
        assert lines_of(result, robot)[: len(expected)] == expected


def test_printf_writes_numbers_as_on_the_robot_where_long_has_32_bits(program: Compile, tmp_path: Path) -> None:
    result = run(program("console.c"), tmp_path, {"objects.robots.nb": 1})
    assert lines_of(result, 0)[5:] == [
        "4000000000 7",
        "-5 -2147483648",
        "[   42|-42  |+42|0000beef|BEEF]",
        "1 -2 -3 4 -5 -6000000000 7000000000",
        "1.50 -0.25 1.000000e+03 text c % %lu",
        "    -1|2   |3.1",
        "x" * 1999 + "1",
        " Pogolib Version : v2.7",
        "the last words, without end of line",
    ]
