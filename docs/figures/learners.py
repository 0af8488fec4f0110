"""Draws how learners do the four tasks: the picture of docs/learners.md, from the rows of the benchmark."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure
from pogosim.learning.tasks import TASKS

COLOURS = {"cma_es": "tab:blue", "ppo": "tab:orange", "embodied": "tab:green", "map_elites": "tab:purple"}
LINES = {"by hand": "--", "random": ":"}


def figure_of(rows: pd.DataFrame) -> Figure:
    """Draw the score of each policy by episodes, mean and range over the seeds; a diagram for each task.

    Args:
        rows: As `-o` of the benchmark writes them.
    """
    figure = Figure(figsize=(8.6, 6.0), layout="constrained")
    for axes, (name, task) in zip(figure.subplots(2, 2, sharex=True).flat, TASKS.items(), strict=True):
        of_task = rows[rows["task"] == name]
        for policy, line in LINES.items():
            score = of_task.loc[of_task["policy"] == policy, "score"].mean()
            axes.axhline(score, color="0.3", linestyle=line, label=policy)
        for policy, colour in COLOURS.items():
            tests = of_task[of_task["policy"] == policy].groupby("episodes")["score"].agg(["mean", "min", "max"])
            axes.plot(tests.index, tests["mean"], color=colour, marker=".", label=policy)
            axes.fill_between(tests.index, tests["min"], tests["max"], color=colour, alpha=0.15, linewidth=0)
        axes.set_title(f"{name}: {task.title}", fontsize=10)
    for axes in figure.axes[2:]:
        axes.set_xlabel("episodes")
    for axes in figure.axes[::2]:
        axes.set_ylabel("score")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)
    return figure
