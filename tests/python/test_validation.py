"""The simulator gives what theory says: the scenes of docs/validation.md with fewer runs, and what judges them."""

from __future__ import annotations

import re
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import validate
import validation
from all import differences
from matplotlib.figure import Figure
from quotes import Quote, quote, quoted
from running import ROOT, compile_program, pkg_config, run_command
from studies import outcome_print
from validation.agreement import FALSE_ALARM, Comparison, absolute, relative, two_samples
from validation.experiment import Outcome, batch, changed
from validation.kuramoto_order import theory
from validation.lamp_density import grid_radius_mm, shares, speed
from validation.vicsek_order import model_order
from validation.voter_consensus import UPDATE_PROBABILITY, chain, chain_consensus, theory_time
from validation.walks import SPEED_MM_S, theory_msd

PAGE = ROOT / "docs" / "validation.md"
PROGRAMS = sorted((ROOT / "docs" / "validation").glob("*.c"))
CONFIGURATIONS = sorted((ROOT / "docs" / "validation").glob("*.yaml"))


@pytest.mark.parametrize("scene", validation.SCENES)
def test_robots_do_what_theory_says_and_the_page_quotes_it(scene: str, tmp_path: Path) -> None:
    outcome = validation.SCENES[scene](tmp_path, True)
    assert [comparison.line for comparison in outcome.comparisons if not comparison.agrees] == []
    assert validation.picture_of(outcome).image.startswith(b"\x89PNG")

    short = Quote((), data=outcome_print(outcome.lines, outcome.tables))
    assert differences({f"validation.md: {scene}": short}) == [], "to renew: .venv/bin/python docs/figures/all.py"

    lines = quoted(PAGE, scene)[1:]
    assert [line for line in lines if not line.endswith("% of the tolerance: agrees")] == []
    assert {line.name for line in outcome.comparisons} <= {line.partition(":")[0] for line in lines}


@pytest.mark.parametrize("source", PROGRAMS, ids=lambda source: source.stem)
def test_program_shares_no_variable_by_mistake_and_compiles_without_a_warning(source: Path, tmp_path: Path) -> None:
    program = compile_program(tmp_path / source.stem, source, flags=["-g", "-Wall", "-Wextra", "-Werror"])
    (tool,) = pkg_config("--variable=shared_state")
    done = subprocess.run([tool, str(program)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


@pytest.mark.parametrize("configuration", CONFIGURATIONS, ids=lambda path: path.stem)
def test_run_of_a_scene_warns_of_nothing(configuration: Path, tmp_path: Path) -> None:
    name = "persistent_walk" if configuration.stem == "lamp" else configuration.stem
    program = compile_program(tmp_path / name, configuration.with_name(f"{name}.c"), flags=["-g"])
    arguments = ["-c", str(configuration), "-g", "--set", "simulation_time=15"]
    result = run_command(program, tmp_path, [*arguments, "--set", f"data_filename={tmp_path / 'data.feather'}"])
    assert (result.code, result.errors) == (0, "")


def test_page_names_every_program_and_scene() -> None:
    page = PAGE.read_text()
    assert set(re.findall(r"<!-- (\w+) -->", page)) == set(validation.SCENES)
    files = {path.name for path in (ROOT / "docs" / "validation").iterdir()}
    assert set(re.findall(r"\(validation/(\S+?)\)", page)) == files


def samples(mean: float, count: int, values: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(mean, 1.0, (count, values))


def test_correct_values_agree_and_wrong_ones_do_not() -> None:
    right = [absolute("x", samples(5.0, 10, 4, seed), np.full(4, 5.0)) for seed in range(2000)]
    wrong = [absolute("x", samples(8.0, 10, 4, seed), np.full(4, 5.0)) for seed in range(200)]
    # Poisson's distribution around 2000 false alarms of one in a thousand: more than 10 once in 100 000 times.
    assert sum(not comparison.agrees for comparison in right) <= 10
    assert sum(comparison.agrees for comparison in wrong) <= 2


def test_false_alarms_are_as_frequent_as_stated(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("validation.agreement.FALSE_ALARM", 0.1)
    one = [absolute("x", samples(0.0, 5, 1, seed), [0.0]) for seed in range(2000)]
    two = [two_samples("x", samples(3.0, 4, 1, seed), samples(3.0, 6, 1, seed + 10**6)) for seed in range(2000)]
    for comparisons in (one, two):
        alarms = sum(not comparison.agrees for comparison in comparisons)
        assert abs(alarms - 200) < 4.0 * np.sqrt(2000 * 0.1 * 0.9)
    assert FALSE_ALARM == 0.001


def test_margin_is_added_to_what_chance_allows() -> None:
    exact = absolute("x", np.full((3, 2), 1.0), [1.0, 1.02], margin=0.03)
    assert exact.agrees
    assert exact.used == pytest.approx(2.0 / 3.0)
    assert exact.line.endswith("67 % of the tolerance: agrees")
    assert not replace(exact, margin=np.full(2, 0.01)).agrees
    assert replace(exact, margin=np.full(2, 0.01)).line.endswith("200 % of the tolerance: DISAGREES")


def test_value_that_is_missing_does_not_agree() -> None:
    missing = relative("x", [[1.0, np.nan], [1.1, np.nan]], [1.0, 1.0])
    assert not missing.agrees
    assert missing.line.endswith("DISAGREES")


def test_walkers_are_ballistic_at_first_and_diffuse_in_the_end() -> None:
    assert theory_msd(np.array([1e-3]), 1.0) == pytest.approx((SPEED_MM_S * 1e-3) ** 2, rel=1e-3)
    assert theory_msd(np.array([1e5]), 0.5) == pytest.approx(4.0 * SPEED_MM_S**2 / (2.0 * 0.5) * 1e5, rel=1e-4)


def test_oscillators_begin_to_agree_at_twice_the_half_width() -> None:
    assert theory(np.array([0.5, 1.0, 4.0 / 3.0])) == pytest.approx([0.0, 0.0, 0.5])


def test_model_of_vicsek_has_its_known_limits() -> None:
    assert model_order(40, 0.0, 1) == pytest.approx(1.0, abs=1e-6)
    # 61 records of nearly independent directions; the standard deviation of one is 0.523 of its mean.
    expected = np.sqrt(np.pi / 160.0)
    assert abs(model_order(40, 2.0 * np.pi, 1) / expected - 1.0) < 4.0 * 0.523 / np.sqrt(61.0)


def test_two_voters_agree_after_one_update() -> None:
    assert theory_time(2) == pytest.approx(0.5)
    assert theory_time(1000) == pytest.approx(1000 * np.log(2.0), rel=0.01)


@pytest.mark.parametrize("robots", [8, 32])
def test_times_of_the_chain_are_those_of_theory_but_for_updates_that_cancel(robots: int) -> None:
    assert chain(robots).sum(axis=1) == pytest.approx(np.ones(robots + 1))
    mean_ticks = (1.0 - chain_consensus(robots, 40_000)).sum()
    assert mean_ticks * UPDATE_PROBABILITY * (1.0 - UPDATE_PROBABILITY / 2.0) == pytest.approx(
        theory_time(robots), rel=0.002
    )


def test_density_below_the_lamp_is_that_of_the_integral() -> None:
    inside = shares(grid_radius_mm(), 1.0 / speed(grid_radius_mm()))
    # 2 pi r / (1 - 0.8 (1 - r / R)), from 0 to R, by hand: 2 pi R^2 (1 / 0.8 - 0.2 / 0.64 ln 5).
    disk = 2.0 * np.pi * 900.0**2 * (1.0 / 0.8 - 0.2 / 0.64 * np.log(5.0))
    outside = 2000.0**2 - np.pi * 900.0**2
    assert inside[:-1].sum() == pytest.approx(disk / (disk + outside), rel=1e-3)


def test_script_prints_what_disagrees_and_says_so_in_its_exit_code(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    one = np.ones(1)
    for expected, code, verdict in ((1.0, 0, "agrees"), (2.0, 1, "DISAGREES")):
        comparison = Comparison("speed", one, expected * one, 0.0 * one, 5, 0.0 * one)
        outcome = Outcome("2 runs", Figure(), (), (comparison,))
        monkeypatch.setattr(validate, "SCENES", {"scene": lambda _folder, _quick, made=outcome: made})
        assert validate.main(["--quick"]) == code
        assert capsys.readouterr().out.splitlines()[1:] == ["2 runs", comparison.line]
        assert comparison.line.endswith(verdict)


def test_numbers_are_written_into_the_page(tmp_path: Path) -> None:
    page = tmp_path / "validation.md"
    page.write_text(PAGE.read_text())
    for lines in (["2 runs", "a: agrees"], ["3 runs", "b \\1: agrees", "c: agrees"]):
        quote(page, "voter", lines)
        assert quoted(page, "voter") == lines
    page.write_text("nothing")
    with pytest.raises(SystemExit, match="expected one place"):
        quote(page, "voter", lines)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [(["flocks"], "no scene is called flocks; there are "), (["--keep"], "unrecognized arguments: --keep")],
)
def test_mistakes_on_the_command_line_get_one_line(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        validate.main(arguments)
    assert ended.value.code == 2
    assert message in capsys.readouterr().err.splitlines()[-1]


def test_library_that_is_not_built_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def needs_more(_folder: Path, _quick: bool) -> Outcome:
        subprocess.run(["false"], check=True)
        raise AssertionError

    monkeypatch.setattr(validate, "SCENES", {"scene": needs_more})
    assert validate.main([]) == 2
    assert "./build.sh" in capsys.readouterr().err


def test_key_that_a_configuration_does_not_have_is_no_change() -> None:
    assert changed({"a": {"b": 1}}, {"a.b": 2}) == {"a": {"b": 2}}
    with pytest.raises(AssertionError, match=r"a\.c"):
        changed({"a": {"b": 1}}, {"a.c": 2})


def test_batch_gives_the_rows_of_all_runs(tmp_path: Path) -> None:
    program = compile_program(tmp_path / "voter", ROOT / "docs" / "validation" / "voter.c")
    rows = batch(program, "voter", 2, {"objects.robots.nb": 4, "parameters.nb_robots": 4})["voter"]
    assert sorted(rows["run"].unique()) == [0, 1]
    assert sorted(rows["robot_id"].unique()) == [0, 1, 2, 3]
    last = rows[rows["time"] == rows.groupby("run")["time"].transform("max")]
    assert last.groupby("run")["opinion"].nunique().eq(1).all()
