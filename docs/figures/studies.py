"""Numbers that take minutes, and the short run of each that tells whether they are out of date."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import tuning
import validation
from pictures import ROOT, Picture, fingerprint, from_figure
from quotes import Quote, paragraph

sys.path += [str(ROOT / "examples" / "learning"), str(ROOT / "bench")]

ENGINES = ("box2d", "disk")
ROBOTS = 300  # of the comparison of engines
SEEDS = 6
TIMELESS = 4  # of its columns, the last one is a time


@dataclass(frozen=True)
class Study:
    """What a page says of many runs.

    Attributes:
        quote: Page and name of its numbers.
        pictures: Names of its pictures in docs/.
        short: Runs a little of it in a folder, and returns a fingerprint of what came out.
        whole: Runs all of it in a folder, and returns the numbers and pictures by their names.
    """

    quote: str
    pictures: tuple[str, ...]
    short: Callable[[Path], str]
    whole: Callable[[Path], dict[str, Picture | Quote]]

    def renewed(self, folder: Path, data: str) -> dict[str, Picture | Quote]:
        """Run all of it; the numbers remember the fingerprint of the short run."""
        made = self.whole(folder)
        numbers = made[self.quote]
        assert isinstance(numbers, Quote)
        return made | {self.quote: replace(numbers, data=data)}


def outcome_print(lines: Sequence[str], tables: Sequence[pd.DataFrame]) -> str:
    """Return the fingerprint of what a scene gave."""
    return fingerprint(pd.DataFrame({"line": list(lines)}), *tables)


def tune_a_little(scene: str, folder: Path) -> str:
    """Search with few evaluations."""
    outcome = tuning.SCENES[scene](folder, True)
    return outcome_print(outcome.quoted, outcome.tables)


def tune(scene: str, folder: Path) -> dict[str, Picture | Quote]:
    """Search as the page says."""
    outcome = tuning.SCENES[scene](folder, False)
    made: dict[str, Picture | Quote] = {f"optimization.md: {scene}": Quote(tuple(outcome.quoted))}
    if outcome.figure is not None:
        made[f"tuning_{scene}.png"] = from_figure(outcome.figure, 110, *outcome.tables)
    return made


def validate_a_little(scene: str, folder: Path) -> str:
    """Compare few runs with theory."""
    outcome = validation.SCENES[scene](folder, True)
    return outcome_print(outcome.lines, outcome.tables)


def validate(scene: str, folder: Path) -> dict[str, Picture | Quote]:
    """Compare as the page says."""
    outcome = validation.SCENES[scene](folder, False)
    return {
        f"validation.md: {scene}": Quote(tuple(outcome.lines)),
        f"validation_{scene}.png": validation.picture_of(outcome),
    }


def learn_a_little(_folder: Path) -> str:
    """Learn for two generations of short episodes."""
    import train  # needs the extra 'learning'

    curves = []
    for task in train.TASKS.values():
        with train.Trainer(task, episode_steps=20) as trainer:
            curves.append(pd.DataFrame(train.learn(trainer, generations=2, candidates=4).curve).add_prefix("test_"))
    return fingerprint(*curves)


def learn(_folder: Path) -> dict[str, Picture | Quote]:
    """Learn as the page says."""
    import train

    results = {name: train.learnt(name) for name in train.TASKS}
    tables = [pd.DataFrame(learnt.curve).add_prefix("test_") for learnt in results.values()]
    gained = [learnt.curve[-1].mean() / learnt.by_hand.mean() for learnt in results.values()]
    caption = (
        "*Returns of ten episodes that no candidate is chosen by, mean and standard deviation, in one search each. "
        "Policies written by hand turn to the brighter side (left), or to the side with more neighbours (right), where "
        "robots know of each other by messages alone. In the end, the learnt policies return "
        f"{gained[0]:.2f} and {gained[1]:.2f} times what these do.*"
    )
    return {
        "learning.md: caption": paragraph(caption),
        "learning.md: returns": Quote(
            tuple(line for name, learnt in results.items() for line in train.summary(name, learnt))
        ),
        "learning.png": from_figure(train.figure_of(results), 80, *tables),
    }


def engine_table(title: str, arenas: Sequence[str], seeds: int, time_step_s: float, columns: int) -> Quote:
    """Compare how swarms move with both engines: means and standard deviations between seeds, in Markdown."""
    import compare_engines

    lines = [f"| arena | engine | {' | '.join(compare_engines.COLUMNS[:columns])} |", "|---" * (columns + 2) + "|"]
    for arena in arenas:
        for engine in ("box2d", "disk"):
            runs = np.array(
                [compare_engines.figures(engine, arena, seed, ROBOTS, time_step_s) for seed in range(1, seeds + 1)]
            )
            cells = map(compare_engines.with_spread, runs.mean(0)[:columns], runs.std(0)[:columns])
            lines.append(f"| {arena}{title} | {engine} | {' | '.join(cells)} |")
    return Quote(tuple(lines))


def compared(first: str, columns: Sequence[str], rows: Mapping[tuple[str, str], Callable[[int], list[float]]]) -> Quote:
    """Compare runs: means and standard deviations between SEEDS seeds, in Markdown.

    Args:
        first: Title of the first column.
        columns: Titles of the columns behind the engine's.
        rows: What stands in the first column, and the engine; the figures of a run with a seed.
    """
    from compare_engines import with_spread

    lines = [f"| {first} | engine | {' | '.join(columns)} |", "|---" * (len(columns) + 2) + "|"]
    for (name, engine), figures in rows.items():
        runs = np.array([figures(seed)[: len(columns)] for seed in range(1, SEEDS + 1)])
        lines.append(f"| {name} | {engine} | {' | '.join(map(with_spread, runs.mean(0), runs.std(0)))} |")
    return Quote(tuple(lines))


def compare_engines_a_little(_folder: Path) -> str:
    """Run few robots with both engines."""
    import compare_engines

    engines = ("box2d", "disk")
    rows = [compare_engines.figures(engine, "disk", 1, ROBOTS // 10, 0.01)[:TIMELESS] for engine in engines]
    return fingerprint(pd.DataFrame(np.round(rows, 9)).rename(columns=str))


def compare_both_engines(_folder: Path) -> dict[str, Picture | Quote]:
    """Compare the engines as the page says."""
    return {
        "physics.md: engines": engine_table("", ("disk", "annulus", "H"), 6, 0.01, TIMELESS),
        "physics.md: small_steps": engine_table(", steps of 1 ms", ("disk",), 6, 0.001, TIMELESS - 1),
    }


def compare_shapes_a_little(_folder: Path) -> str:
    """Push boxes and others for a few seconds with both engines."""
    import compare_shapes

    rows = [compare_shapes.figures(engine, 1, 0.01, duration_s=4.0)[:-1] for engine in ENGINES]
    return fingerprint(pd.DataFrame(np.round(rows, 9)).rename(columns=str))


def compare_shapes_in_both(_folder: Path) -> dict[str, Picture | Quote]:
    """Push boxes and others as the page says."""
    import compare_shapes

    rows = {
        (str(ms), engine): partial(compare_shapes.figures, engine, time_step_s=ms / 1000)
        for ms in (1, 10)
        for engine in ENGINES
    }
    return {"physics.md: boxes": compared("step, ms", compare_shapes.COLUMNS[:-1], rows)}


STUDIES = {
    "engines": Study("physics.md: engines", (), compare_engines_a_little, compare_both_engines),
    "boxes": Study("physics.md: boxes", (), compare_shapes_a_little, compare_shapes_in_both),
    "learning": Study("learning.md: returns", ("learning.png",), learn_a_little, learn),
    **{
        f"tuning_{scene}": Study(
            f"optimization.md: {scene}",
            (f"tuning_{scene}.png",) if scene in tuning.DRAWN else (),
            partial(tune_a_little, scene),
            partial(tune, scene),
        )
        for scene in tuning.SCENES
        if scene not in tuning.TIMES
    },
    **{
        f"validation_{scene}": Study(
            f"validation.md: {scene}",
            (f"validation_{scene}.png",),
            partial(validate_a_little, scene),
            partial(validate, scene),
        )
        for scene in validation.SCENES
    },
}
