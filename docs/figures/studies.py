"""Numbers that take minutes, and the short run of each that tells whether they are out of date."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import learners
import numpy as np
import pandas as pd
import tuning
import validation
from pictures import ROOT, Picture, fingerprint, from_figure
from pogosim.learning import benchmark
from pogosim.learning.tasks import TASKS
from quotes import Quote, paragraph

sys.path += [str(ROOT / "examples" / "learning"), str(ROOT / "bench")]

ENGINES = ("box2d", "disk")
ROBOTS = 300  # of the comparison of engines
SEEDS = 6
LEARNERS_BUDGET, LEARNERS_SEEDS = 240, range(1, 4)


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
    import train

    found = [train.learn(task, generations=2, candidates=4, end=4.0) for task in train.TASKS.values()]
    return fingerprint(*(pd.DataFrame(learnt.curve).add_prefix("test_") for learnt in found))


def learn(_folder: Path) -> dict[str, Picture | Quote]:
    """Learn as the page says."""
    import train

    results = {name: train.learn(task, generations=20) for name, task in train.TASKS.items()}
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


def learners_a_little(_folder: Path) -> str:
    """Do each task with each learner, in one short search."""
    found = benchmark.measure(
        [*TASKS], [*benchmark.LEARNERS], 32, range(1, 2), tell=lambda _line: None, end=1.0, threads=1
    )
    return fingerprint(pd.DataFrame(found))


def pictured_learners(found: Sequence[benchmark.Result]) -> dict[str, Picture | Quote]:
    """Return what the page says of the scores of learners."""
    rows = pd.DataFrame(found)
    made = (
        f"Made with `--budget {LEARNERS_BUDGET} --seeds {len(LEARNERS_SEEDS)}`, which is little: longer searches get "
        "further. Each seed has a search of its own, and 16 test episodes, the same for all policies, from which "
        "nothing is learnt; intervals of the means over seeds are those of Student's t. `random` does anything. "
        "Policies that are learnt are perceptrons with six hidden units."
    )
    return {
        "learners.md: scores": Quote(tuple(benchmark.table(found))),
        "learners.md: made": paragraph(made),
        "learners.png": from_figure(learners.figure_of(rows), 90, rows),
    }


def compare_learners(_folder: Path) -> dict[str, Picture | Quote]:
    """Do each task with each learner as the page says."""
    return pictured_learners(benchmark.measure([*TASKS], [*benchmark.LEARNERS], LEARNERS_BUDGET, LEARNERS_SEEDS))


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

    rows = [compare_engines.step_figures(engine, 0.01, 1, ROBOTS // 10) for engine in ENGINES]
    return fingerprint(pd.DataFrame(np.round(rows, 9)).rename(columns=str))


def compare_both_engines(_folder: Path) -> dict[str, Picture | Quote]:
    """Compare the engines as the page says."""
    import compare_engines

    columns = compare_engines.COLUMNS[:-1]  # without the time
    arenas = {
        (arena, engine): partial(compare_engines.figures, engine, arena, robots=ROBOTS, time_step_s=0.01)
        for arena in ("disk", "annulus", "H")
        for engine in ENGINES
    }
    steps = {
        (str(ms), engine): partial(compare_engines.step_figures, engine, ms / 1000, robots=ROBOTS)
        for ms in (1, 5, 10, 16)
        for engine in ENGINES
    }
    return {
        "physics.md: engines": compared("arena", columns, arenas),
        "physics.md: steps": compared("step, ms", (*columns, *compare_engines.WALL_COLUMNS), steps),
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
    "learners": Study("learners.md: scores", ("learners.png",), learners_a_little, compare_learners),
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
