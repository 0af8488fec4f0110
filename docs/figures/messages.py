"""What docs/message_log.md says of conf/demo.yaml: how many messages get through, and what the law says.

.venv/bin/python docs/figures/all.py messages
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pandas as pd
from pictures import ROOT, Picture, from_figure
from pogosim.reports.command import analyze
from pogosim.reports.messages import drawn
from pogosim.utils import load_dataframe
from quotes import Quote, paragraph

DURATION_S = 30
NAMES = ("messages.png", "message_log.md: size", "message_log.md: table", "message_log.md: caption")
SETTINGS = (f"simulation_time={DURATION_S}", "objects.robots.msg_success_rate={type: dynamic}")


def size(log: Path, rows: pd.DataFrame) -> Quote:
    """Say how large a log is."""
    robots, count, kilobytes = rows["sender"].nunique(), len(rows) / DURATION_S, log.stat().st_size / 1000 / DURATION_S
    return paragraph(
        f"A crowd makes many rows: the {robots} robots of the demonstration, `conf/demo.yaml`, write "
        f"{round(count, -2):.0f} rows ({round(kilobytes, -1):.0f} kB) per simulated second."
    )


def caption(rows: pd.DataFrame) -> Quote:
    """Say what the figure shows."""
    p, m = rows["send_probability"].unique(), rows["message_bytes"].unique()
    return paragraph(
        "*Dots: shares with their 95 % confidence intervals ([Wilson "
        "1927](https://doi.org/10.1080/01621459.1927.10502953)). Lines: the law, here the article's equation with "
        f"p = {', '.join(f'{value:g}' for value in p)} and m = {', '.join(map(str, m))}. It does not depend on the "
        "distance: the remaining dependence arises because distant robots have somewhat larger clusters around "
        "their senders.*"
    )


def draw(folder: Path) -> dict[str, Picture | Quote]:
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
    rows = load_dataframe(log)[0]
    return {
        "messages.png": from_figure(drawn(distance, cluster, ["sender_category"]), 80, *shown),
        "message_log.md: size": size(log, rows),
        "message_log.md: table": Quote(tuple((folder / "out" / "messages.csv").read_text().splitlines())),
        "message_log.md: caption": caption(rows),
    }
