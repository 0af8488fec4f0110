"""What is wrong with a batch is said in one line, with the place and what to do."""

from __future__ import annotations

import os
import pty
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from batches import COMMAND, ENVIRONMENT, arguments, batch, batch_apart, ended, results, run_main, script, write_options
from pogosim.batch import reports
from pogosim.batch.command_line import parser
from pogosim.batch.runs.identity import seed_of
from pogosim.extras import installing
from running import ROOT, example


def one_line(folder: Path, *more: str, program: Path | None = None, code: int = 2) -> str:
    """Run a batch that cannot be done; returns the line."""
    result = batch(folder, *more, program=program)
    assert result.code == code, result.text
    assert result.errors.count("\n") == 1, result.errors
    assert "Batch run completed" not in result.output
    return result.errors


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"result_filename_format": "{objects.robot.nb}.feather"}, ":13: result_filename_format: there is no key"),
        ({"result_filename_format": "{objects.robots.nb:x.y}"}, "not a format of Python"),
        (
            {"result_new_columns": ["objects.robots.number"]},
            ": result_new_columns: there is no key 'objects.robots.number'",
        ),
        ({"result_new_columns": 5}, "result_new_columns: expected a list of keys"),
        ({"objects.robots.nb": {"batch_options": 5}}, ":13: objects.robots.nb: batch_options: expected a list"),
        ({"objects.robots.nb": {"batch_options_range": {"start": 1, "stop": 9}}}, "'step' is missing"),
        ({"enable_data_logging": False}, "enable_data_logging: is false, so runs write no data"),
    ],
)
def test_wrong_configuration_is_one_line_with_its_place(changes: dict[str, object], what: str, tmp_path: Path) -> None:
    write_options(tmp_path, changes)
    line = one_line(tmp_path)
    assert what.replace(":13:", ":") in line
    place = re.match(r"pogobatch: many\.yaml:(\d+): ([\w.]+)", line)
    assert place
    there = (tmp_path / "many.yaml").read_text().splitlines()[int(place.group(1)) - 1]
    assert there.strip().startswith(f"{place.group(2).split('.')[-1]}:"), line


def test_missing_empty_and_foreign_configurations_are_refused(tmp_path: Path) -> None:
    assert "cannot read the configuration many.yaml: No such file" in one_line(tmp_path)
    (tmp_path / "many.yaml").touch()
    assert "many.yaml is empty" in one_line(tmp_path)
    (tmp_path / "many.yaml").write_bytes(example("helloworld").read_bytes()[:1000])
    assert "many.yaml" in one_line(tmp_path)
    (tmp_path / "many.yaml").unlink()
    (tmp_path / "many.yaml").mkdir()
    assert "Is a directory" in one_line(tmp_path)


def test_program_that_is_no_simulator_is_refused_before_anything_is_touched(tmp_path: Path) -> None:
    write_options(tmp_path)
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "result.feather").write_bytes(b"")
    text = tmp_path / "text"
    text.write_text("hello\n")
    locked = script(tmp_path / "locked", "")
    locked.chmod(0o644)
    of_a_mac = tmp_path / "of_a_mac"
    of_a_mac.write_bytes(b"\xcf\xfa\xed\xfe\x0c\x00\x00\x01" + bytes(64) + b"pogosim")
    for program, what in (
        (Path("/bin/ls"), "/bin/ls is not a simulator; expected a program compiled for Pogosim"),
        (text, "is not a simulator"),
        (tmp_path, "is a folder"),
        (tmp_path / "nothing", "does not exist"),
        (locked, "is not executable; chmod +x"),
        (of_a_mac, "is for macOS on ARM64, and this is "),
    ):
        assert what in one_line(tmp_path, program=program)
        assert list(results(tmp_path)) == ["result.feather"]


def test_shared_object_is_refused_with_the_program_beside_it(tmp_path: Path) -> None:
    write_options(tmp_path)
    program = example("helloworld")
    library = program.with_name("helloworld.so")
    line = one_line(tmp_path, program=library)
    assert f"{library} is a shared object, for Python; give the program beside it, {program}" in line
    alone = Path(shutil.copy(library, tmp_path / "alone.so"))
    line = one_line(tmp_path, program=alone)
    assert f"{alone} is a shared object, for Python; expected a program compiled for Pogosim" in line


def test_program_that_writes_no_data_ends_the_batch_at_once(tmp_path: Path) -> None:
    write_options(tmp_path)
    line = one_line(tmp_path, "-r", "3", program=script(tmp_path / "silent", "exit 0"))
    assert "it ended without writing its data file: is " in line


def test_full_disk_ends_the_batch_with_one_line(tmp_path: Path) -> None:
    write_options(tmp_path)
    full = script(tmp_path / "full", "echo 'Error: cannot write: No space left on device'; exit 2")
    line = one_line(tmp_path, "-r", "3", program=full)
    assert f"the disk of {tmp_path}/tmp is full; free space, then give the same command again" in line


@pytest.mark.parametrize(
    ("flags", "what"),
    [
        (["--backend", "slurm"], "--backend: expected one of multiprocessing, sequential, dask; found 'slurm'"),
        (["-r", "0"], "--runs: expected a whole number of at least 1; found 0"),
        (["-R", "-1"], "--retries: expected a whole number of at least 0; found -1"),
        (["-j", "0"], "--workers: expected a whole number of at least 1; found 0"),
        (["--seed-from", "time"], "--seed-from: expected run or config; found 'time'"),
        (["--seed-from", "config"], "--seed-from config needs a whole number"),
        (["--backend", "sequential", "--scheduler", "tcp://127.0.0.1:1"], "--scheduler goes with --backend dask"),
        (["-o", "many.yaml"], "cannot write many.yaml/result.feather"),
        (["-t", "many.yaml"], "many.yaml"),
    ],
)
def test_wrong_flag_is_one_line(flags: list[str], what: str, tmp_path: Path) -> None:
    write_options(tmp_path, {"seed": None})
    assert what in one_line(tmp_path, *flags)


def test_scheduler_that_does_not_answer_is_one_line_and_old_results_stay(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert batch(tmp_path).code == 0
    before = results(tmp_path)
    result = batch_apart(tmp_path, "--scheduler", "tcp://127.0.0.1:1")
    assert result.code == 2
    assert result.errors.count("\n") == 1
    assert "no Dask scheduler answers at tcp://127.0.0.1:1" in result.errors
    assert results(tmp_path) == before


def test_dask_that_is_not_installed_is_one_line(tmp_path: Path) -> None:
    write_options(tmp_path)
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    (hidden / "distributed.py").write_text("raise ImportError('not installed')\n")
    command = ["env", f"PYTHONPATH={hidden}", *arguments(example("helloworld"), "--backend", "dask")]
    result = ended(command, tmp_path)
    assert (result.code, result.errors) == (
        2,
        f"pogobatch: --backend dask needs the Python package 'distributed'; install it: {installing('dask')}\n",
    )


def test_result_that_is_no_data_file_is_not_overwritten(tmp_path: Path) -> None:
    write_options(tmp_path)
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "result.feather").write_text("my notes\n")
    assert "is no data file of the simulator; it will not be overwritten" in one_line(tmp_path)
    assert (tmp_path / "results" / "result.feather").read_text() == "my notes\n"


def test_missing_options_are_exit_code_1_and_unknown_ones_2(tmp_path: Path) -> None:
    path = write_options(tmp_path)
    for options in (["-c", str(path)], ["-S", "x"], []):
        result = run_main(tmp_path, options)
        assert (result.code, result.output) == (1, "")
        assert "Usage: pogobatch -c CONFIG -S PROGRAM" in result.errors
    assert run_main(tmp_path, ["-c", str(path), "-S", "x", "--run"]).code == 2
    assert run_main(tmp_path, ["-V"]).code == 0


def test_bar_with_the_time_left_is_shown_on_a_terminal_only(tmp_path: Path) -> None:
    write_options(tmp_path)
    assert batch(tmp_path, "-r", "2").errors == ""
    leader, follower = pty.openpty()
    command = arguments(example("helloworld"), "-r", "2")
    process = subprocess.Popen(command, cwd=tmp_path, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=follower)
    os.close(follower)
    shown = b""
    try:
        while block := os.read(leader, 1000):
            shown += block
    except OSError:
        pass  # the other side has closed the terminal
    os.close(leader)
    assert process.wait() == 0
    assert b"4/4 [" in shown
    assert b"<" in shown


def test_output_that_is_not_read_does_not_end_a_batch(tmp_path: Path) -> None:
    write_options(tmp_path)
    command = " ".join([*COMMAND, "-c many.yaml -S", str(example("helloworld")), "-t tmp -o results"])
    result = ended(["bash", "-c", f"{command} | true; exit ${{PIPESTATUS[0]}}"], tmp_path)
    assert (result.code, result.errors) == (0, "")
    assert list(results(tmp_path)) == ["result.feather"]


def test_derived_seeds_are_in_range_and_those_of_neighbours_do_not_meet() -> None:
    seeds = [seed_of(configured, run) for configured in range(20) for run in range(1000)]
    assert len(set(seeds)) == len(seeds)
    assert all(0 <= seed < 2**32 for seed in seeds)
    assert seed_of(1, 0) == seed_of(1, 2**32)


def test_page_of_batches_has_every_flag() -> None:
    page = (ROOT / "docs" / "batches.md").read_text()
    listed = set(re.findall(r"`(-{1,2}[A-Za-z][\w-]*)", "\n".join(re.findall(r"^\| `-.*", page, re.MULTILINE))))
    known = {flag for action in parser("pogobatch")._actions for flag in action.option_strings}
    assert known - listed <= {"--help", "--verbose", "--version"}
    assert listed <= known


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ("nb: !!bool x", "is not valid YAML"),
        ("nb: !!timestamp x", "is not valid YAML"),
        ('nb: {batch_options: ["\\ud800"]}', "no text in UTF-8"),
        (f"nb: {{batch_options_range: {{start: 0, stop: {'9' * 400}, step: 1}}}}", "stop: expected a number"),
        ("nb: {batch_options_range: {start: 0, stop: 1e299, step: 1}}", "more than"),
    ],
)
def test_values_that_are_none_are_one_line(changes: str, said: str, tmp_path: Path) -> None:
    text = write_options(tmp_path).read_text()
    (tmp_path / "many.yaml").write_text(f"{text}parameters: {{{changes}}}\n")
    result = batch(tmp_path)
    assert (result.code, result.errors.count("\n")) == (2, 1), result.text
    assert said in result.errors
    assert len(result.errors) < 400


def test_aliases_of_aliases_are_refused_before_they_are_followed(tmp_path: Path) -> None:
    lines = ["a0: &a0 [1, 2, 3, 4, 5, 6, 7, 8, 9]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 10)]
    (tmp_path / "many.yaml").write_text("\n".join(lines))
    result = batch(tmp_path, "--list-outputs")
    assert (result.code, result.errors) == (
        2,
        "pogobatch: many.yaml: its aliases stand for more than 1000000 values; use fewer of them\n",
    )


def test_pipe_is_no_configuration(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "many.yaml")
    result = batch(tmp_path)
    assert (result.code, result.errors) == (2, "pogobatch: many.yaml is not a configuration: it is not a file\n")


def test_name_too_long_for_a_file_is_refused(tmp_path: Path) -> None:
    write_options(tmp_path, {"result_filename_format": "{objects.robots.nb:1000000000d}"})
    result = batch(tmp_path, "--list-outputs")
    assert (result.code, result.errors.count("\n")) == (2, 1)
    assert "too long for a file" in result.errors


@pytest.mark.parametrize("flag", ["-c", "-t", "-o", "-S"])
@pytest.mark.parametrize("name", ["a\udcff", "a\nb"])
def test_names_that_are_no_text_are_refused(flag: str, name: str, tmp_path: Path) -> None:
    write_options(tmp_path)
    result = batch(tmp_path, flag, name)
    assert (result.code, result.errors.count("\n")) == (2, 1)
    assert "has a line break or bytes that are not UTF-8" in result.errors


def test_batch_runs_without_standard_error(tmp_path: Path) -> None:
    write_options(tmp_path)
    commands = shlex.join(arguments(example("helloworld"))) + " 2>&-"
    assert subprocess.run(["bash", "-c", commands], cwd=tmp_path, capture_output=True, check=False).returncode == 0
    assert (tmp_path / "results" / "result.feather").exists()


def test_log_without_a_terminal_says_now_and_then_how_many_runs_are_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reports, "LINE_EVERY_S", 0.0)
    write_options(tmp_path)
    result = batch(tmp_path, "-r", "2")
    lines = result.errors.splitlines()
    assert [line.rpartition("; ")[0] for line in lines] == [f"pogobatch: {n} of 4 runs are done" for n in (1, 2, 3)]
    assert all(re.fullmatch(r"\d\d:\d\d left", line.rpartition("; ")[2]) for line in lines)


@pytest.mark.parametrize("runs", ["6000000", "9" * 20])
def test_more_runs_than_memory_holds_are_refused_at_once(runs: str, tmp_path: Path) -> None:
    write_options(tmp_path)
    said = one_line(tmp_path, "-r", runs)
    assert said == f"pogobatch: --runs: {runs} runs of 2 combination(s) are more than 10000000; make several batches\n"
