"""The figure of docs/message_log.md: how many messages get through in a run of conf/demo.yaml, and what the law says.

.venv/bin/python docs/figures/all.py messages
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pandas as pd
from pictures import ROOT, Picture, from_figure
from pogosim.reports.command import analyze
from pogosim.reports.messages import drawn

NAMES = ("messages.png",)
SETTINGS = ("simulation_time=30", "objects.robots.msg_success_rate={type: dynamic}")


def draw(folder: Path) -> dict[str, Picture]:
    """Run the demonstration with the article's equation."""
    log = folder / "messages.feather"
    command = ["examples/hanabi/hanabi", "-c", "conf/demo.yaml", "-g", "-q"]
    for setting in (*SETTINGS, f"data_filename={folder / 'data.feather'}", f"message_log={log}"):
        command += ["--set", setting]
    subprocess.run(command, cwd=ROOT, check=True, timeout=120)
    if analyze("messages", ["-i", str(log), "-o", str(folder / "out")], "pogosim analyze messages") != 0:
        raise RuntimeError(f"{log} cannot be analysed")
    distance, cluster = (
        pd.read_csv(folder / "out" / f"reception_by_{name}.csv") for name in ("distance", "cluster_size")
    )
    shown = [table.drop(columns="z").round(9) for table in (distance, cluster)]
    return {"messages.png": from_figure(drawn(distance, cluster, ["sender_category"]), 80, *shown)}
