"""Searches find what they must: the scenes of docs/optimization.md with fewer evaluations, and what judges them."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import tune
from all import differences
from pictures import from_figure
from quotes import Quote, quoted
from running import ROOT, compile_program, pkg_config
from studies import outcome_print
from tuning import SCENES
from tuning.archive import CELLS, LARGEST_RAD, LONGEST_MM, arcs, bounds, chord, least_times
from tuning.searches import Claim, Outcome

PAGE = ROOT / "docs" / "optimization.md"


@pytest.mark.parametrize("scene", [name for name in SCENES if name != "throughput"])
def test_searches_find_what_they_must_and_the_page_quotes_it(scene: str, tmp_path: Path) -> None:
    outcome = SCENES[scene](tmp_path / "searches", True)
    assert outcome.claims
    assert [claim.line for claim in outcome.claims if not claim.is_true] == []
    if outcome.figure is not None:
        assert from_figure(outcome.figure, 50, *outcome.tables).image.startswith(b"\x89PNG")
        assert (PAGE.parent / f"tuning_{scene}.png").is_file()
    short = Quote((), data=outcome_print(outcome.quoted, outcome.tables))
    assert differences({f"optimization.md: {scene}": short}) == [], "to renew: .venv/bin/python docs/figures/all.py"


@pytest.mark.parametrize("scene", SCENES)
def test_page_says_that_every_search_found_it(scene: str) -> None:
    lines = quoted(PAGE, scene)
    assert [line for line in lines if line.endswith(": NO")] == []
    assert [line for line in lines if line.endswith(": yes")] != []


def test_page_names_every_scene() -> None:
    assert set(re.findall(r"<!-- (\w+) -->", PAGE.read_text())) == {"first_search", *SCENES}


def test_chord_is_what_short_steps_along_the_arc_add_up_to() -> None:
    heading = np.linspace(-LARGEST_RAD, LARGEST_RAD, 7)
    steps = (np.arange(1000) + 0.5) / 1000
    summed = np.abs(np.mean(np.exp(1j * np.outer(steps, heading)), axis=0))
    assert chord(np.full(7, 300.0), heading) == pytest.approx(300.0 * summed, rel=1e-5)


def test_arcs_end_in_the_cells_that_can_be_reached_and_take_no_less_than_the_least_time() -> None:
    displacement, heading, time_s = arcs(200_000, seed=1)
    low, high = bounds(heading)
    assert (displacement > low - 0.1).all()
    assert (displacement < high + 0.1).all()

    place = (
        np.minimum((displacement / LONGEST_MM * CELLS).astype(int), CELLS - 1),
        np.minimum(((heading + LARGEST_RAD) / (2 * LARGEST_RAD) * CELLS).astype(int), CELLS - 1),
    )
    fastest = np.full((CELLS, CELLS), np.inf)
    np.minimum.at(fastest, place, time_s)
    least = least_times()
    found, reachable = np.isfinite(fastest), np.isfinite(least)
    assert not (found & ~reachable).any()
    assert (found & reachable).sum() >= 0.95 * reachable.sum()
    assert (fastest - least)[found].min() > -0.01
    assert np.median((fastest - least)[found]) < 0.1


def test_program_shares_no_variable_by_mistake_and_compiles_without_a_warning(tmp_path: Path) -> None:
    source = ROOT / "docs" / "tuning" / "dash.c"
    program = compile_program(tmp_path / "dash", source, flags=["-g", "-Wall", "-Wextra", "-Werror"])
    (tool,) = pkg_config("--variable=shared_state")
    done = subprocess.run([tool, str(program)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


def test_script_prints_what_was_not_found_and_says_so_in_its_exit_code(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for is_true, code, line in ((True, 0, "above 900: yes"), (False, 1, "above 900: NO")):
        outcome = Outcome(("10 searches",), (Claim("above 900", is_true),))
        monkeypatch.setattr(tune, "SCENES", {"scene": lambda _folder, _quick, made=outcome: made})
        assert tune.main([]) == code
        assert capsys.readouterr().out.splitlines()[1:] == ["10 searches", line]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [(["ants"], "no scene is called ants; there are "), (["--keep"], "unrecognized arguments: --keep")],
)
def test_mistakes_on_the_command_line_get_one_line(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        tune.main(arguments)
    assert ended.value.code == 2
    assert message in capsys.readouterr().err.splitlines()[-1]


def test_search_that_fails_is_shown_with_its_message(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(_folder: Path, _quick: bool) -> Outcome:
        raise subprocess.CalledProcessError(2, "pogosim", stderr=b"no such file")

    monkeypatch.setattr(tune, "SCENES", {"scene": fails})
    assert tune.main([]) == 2
    assert "no such file" in capsys.readouterr().err
