"""`pogosim fit-comm` and `pogosim best-psend`, as users call them."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pandas as pd
import pytest
from in_process import called, pogosim, refusal
from pogosim import compute_optimal_psend
from pogosim.communication.measurements import ROBOTS_OWN
from pogosim.yaml_1_2 import parse_yaml
from project import CLEAN
from running import Run, example, ran, run

FAST = ("--restarts", "0", "--law", "power")
PICTURES = {
    f"model_{name}.{suffix}"
    for name in ("predicted_vs_measured", "mae_heat_map", "qq_plot", "surfaces")
    for suffix in ("png", "pdf")
}
OTHERS = {"model_final_results.json", "model_residuals.csv"}


def module(folder: Path, *arguments: str) -> Run:
    """Run `python -m` in a folder."""
    return ran(folder, sys.executable, "-m", *arguments, env=CLEAN, timeout=300)


def block_of(output: str) -> dict[str, object]:
    """Return the entry msg_success_rate that is printed."""
    lines = output[output.index("msg_success_rate:") :].split("\n\n")[0]
    entry: dict[str, object] = parse_yaml(lines)["msg_success_rate"]
    return entry


@pytest.fixture(scope="module")
def fitted(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A fit of the measurements on real robots, written to the folder `out`."""
    return pogosim(tmp_path_factory.mktemp("fit"), "fit-comm", "-o", "out", *FAST)


def test_fit_says_how_good_it_is_and_writes_results_and_pictures(fitted: Run) -> None:
    assert (fitted.code, fitted.errors) == (0, "")
    out = fitted.folder / "out"
    assert {path.name for path in out.iterdir()} == PICTURES | OTHERS
    results = json.loads((out / "model_final_results.json").read_text())
    residuals = pd.read_csv(out / "model_residuals.csv")
    assert len(residuals) == results["measurements"] == 45
    spread = ((residuals.success_probability - residuals.success_probability.mean()) ** 2).sum()
    r2 = 1.0 - (residuals.residual**2).sum() / spread
    assert r2 == pytest.approx(results["quality"]["r2"], abs=1e-7)
    assert f"R2: {r2:.6f}\n" in fitted.output
    assert f"MAE: {residuals.residual.abs().mean():.6f}\n" in fitted.output
    for name, value in block_of(fitted.output).items():
        if name != "type":
            assert results["parameters"][name] == pytest.approx(value, rel=1e-8)
    starts = {path.name: path.read_bytes()[:4] for path in out.iterdir() if path.name in PICTURES}
    assert {starts[name] for name in starts if name.endswith("png")} == {b"\x89PNG"}
    assert {starts[name] for name in starts if name.endswith("pdf")} == {b"%PDF"}


def test_fit_writes_the_same_bytes_again(fitted: Run, tmp_path: Path) -> None:
    again = pogosim(tmp_path, "fit-comm", str(ROBOTS_OWN), "-o", "out", *FAST)
    assert again.output == fitted.output
    written = {path.name: path.read_bytes() for path in (fitted.folder / "out").iterdir()}
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()} == written


def test_default_fit_is_that_of_the_article(tmp_path: Path) -> None:
    result = pogosim(tmp_path, "fit-comm", "--example")
    assert result.code == 0
    assert "theta = 0.001 is at its lower bound" in result.errors
    assert "R2: 0.914975\n" in result.output
    assert re.search(r"^MAE: 0\.06628[45]$", result.output, re.MULTILINE)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("law", ["dynamic", "power"])
def test_simulator_accepts_the_printed_configuration(law: str, tmp_path: Path) -> None:
    result = pogosim(tmp_path, "fit-comm", "--law", law, "--restarts", "0")
    entry = block_of(result.output)
    settings = {"objects.robots.msg_success_rate": entry, "simulation_time": 0.2}
    ran = run(example("helloworld"), tmp_path / "run", settings, ["--strict", "-q"])
    assert (ran.code, ran.errors) == (0, "")


def test_options_of_the_fit_hold(tmp_path: Path) -> None:
    options = ["--fix", "delta=2", "--bounds", "gamma=3:3.5", "--objective", "huber", "--huber-delta", "0.05"]
    result = pogosim(tmp_path, "fit-comm", *FAST, *options, "--seed", "7")
    entry = block_of(result.output)
    assert entry["delta"] == 2.0
    assert isinstance(entry["gamma"], float)
    assert 3.0 <= entry["gamma"] <= 3.5


def test_few_or_incomplete_measurements_are_fitted_with_a_warning(tmp_path: Path) -> None:
    header = "payload_size,nb_neighbors,p_send,success_probability\n"
    (tmp_path / "one.csv").write_text(f"{header}3,6,0.1,0.9\n3,,0.1,0.9\n")
    result = pogosim(tmp_path, "fit-comm", "one.csv", "-o", "out", *FAST)
    assert result.code == 0
    assert result.errors.splitlines() == [
        "pogosim fit-comm: warning: one.csv: 1 rows without all numbers are left out",
        "pogosim fit-comm: warning: one.csv: 1 measurements do not determine 4 parameters; measure more, or fix some "
        "with --fix",
    ]
    assert "R2: -\n" in result.output
    assert {path.name for path in (tmp_path / "out").iterdir()} == PICTURES | OTHERS


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["missing.csv"], "missing.csv: no such file or directory"),
        (["."], "is not a file"),
        (["empty.csv"], "empty.csv is empty"),
        (["words.csv"], "has no column payload_size"),
        (["words.csv", "--example"], "leave out it or words.csv"),
        (["-o", "words.csv"], "words.csv is not a folder"),
        (["-o", "words.csv/out"], "not a directory"),
        (["-o", "/proc/none"], "/proc/none"),
        (["--fix", "kappa=1"], "no parameter kappa"),
        (["--fix", "theta"], "not of the form NAME="),
        (["--bounds", "alpha=1"], "not of the form NAME=LOW:HIGH"),
        (["--bounds", "alpha=2:1"], "are empty"),
        (["--bounds", "alpha=x:1"], "'x' is not a finite number"),
        (["--seed", "0"], "'0' is not a whole number from 1"),
        (["--huber-delta", "0"], "0 is not above 0"),
    ],
)
def test_what_cannot_be_fitted_is_one_line(arguments: list[str], said: str, tmp_path: Path) -> None:
    (tmp_path / "empty.csv").write_text("")
    (tmp_path / "words.csv").write_text("a,b\n1,2\n")
    line = refusal(pogosim(tmp_path, "fit-comm", *arguments))
    assert line.startswith("pogosim fit-comm: ")
    assert said in line
    assert (tmp_path / "words.csv").read_text() == "a,b\n1,2\n"


def test_measurements_are_not_overwritten_by_results(tmp_path: Path) -> None:
    data = tmp_path / "model_residuals.csv"
    data.write_bytes(ROBOTS_OWN.read_bytes())
    assert "would take the place of the measurements" in refusal(pogosim(tmp_path, "fit-comm", data.name, "-o", "."))
    assert data.read_bytes() == ROBOTS_OWN.read_bytes()
    assert [path.name for path in tmp_path.iterdir()] == [data.name]


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["-c", "7", "-m", "110"], ("0.2507", "0.5696", "0.9998", "29.9932 (at 30 Hz)")),
        (["-c", "3", "-m", "110", "-f", "60"], ("0.3870", "0.5696", "0.6612", "39.6734 (at 60 Hz)")),
        (["-c", "7", "-m", "12"], ("1.0000", "0.9796", "6.8569", "205.7084 (at 30 Hz)")),
        (["-c", "7", "-m", "12", "-u"], ("4.6879", "0.5696", "18.6914", "560.7413 (at 30 Hz)")),
        (
            ["-c", "2", "-m", "10", "-a", "0.1", "-b", "1", "-g", "2", "-d", "1"],
            ("0.7071", "0.5000", "0.7071", "21.2132"),
        ),
    ],
)
def test_best_chance_to_send_is_printed(arguments: list[str], expected: tuple[str, ...], tmp_path: Path) -> None:
    result = pogosim(tmp_path, "best-psend", *arguments)
    assert (result.code, result.errors) == (0, "")
    best, chance, per_step, per_second = expected
    assert f"p* = {best}\n" in result.output
    assert f"probability of reception: {chance}\n" in result.output
    assert f"expected messages per step: {per_step}\n" in result.output
    assert f"expected messages per second: {per_second}" in result.output
    assert called(tmp_path, compute_optimal_psend.main, *arguments).output == result.output


def test_percentage_for_programs_is_never_zero(tmp_path: Path) -> None:
    result = pogosim(tmp_path, "best-psend", "-c", "100", "-m", "380", "--law", "dynamic")
    assert "percent_msgs_sent_per_ticks: 1\n" in result.output


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "required: -c/--cluster/--cluster-size/--cluster_size, -m/--msg-size/--msg_size"),
        (["-c", "0", "-m", "10"], "0 is less than 1; the sender counts, too"),
        (["-c", "7", "-m", "-1"], "-1 is not above 0"),
        (["-c", "nan", "-m", "1"], "'nan' is not a finite number"),
        (["-c", "7", "-m", "10", "--theta", "1"], "the law 'power' has no parameter theta"),
        (["-c", "7", "-m", "10", "-g", "0.5", "-u"], "sending more is always better"),
        (["-c", "7", "-m", "10", "-a", "-1"], "cannot be computed with these parameters"),
        (["-c", "7", "-m", "1e300"], "cannot be computed with these parameters"),
        (["-c", "7", "-m", "10", "-f", "0"], "0 is not above 0"),
    ],
)
def test_what_has_no_best_chance_is_one_line(arguments: list[str], said: str, tmp_path: Path) -> None:
    assert said in refusal(pogosim(tmp_path, "best-psend", *arguments))


def test_other_scripts_find_the_fit_under_its_old_name(tmp_path: Path) -> None:
    result = module(tmp_path, "pogosim.fit_communication_profile", "--restarts", "0")
    assert result.code == 0
    assert "theta = 0.001 is at its lower bound" in result.errors
    assert "R2: 0.914975\n" in result.output
    assert {path.name for path in tmp_path.iterdir()} == PICTURES | OTHERS
