"""The calls of the first ticks as a trace, which chrome://tracing and https://ui.perfetto.dev show.

The format: "Trace Event Format", https://docs.google.com/document/d/1CvAClvFfyA5R-PhYUmn5OOQtYMH4h6I0nSsKchNAySU.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pogosim.firmware.profile.costs import functions_of_library
from pogosim.firmware.profile.raw import Profile, ProfileError


def trace_of(profile: Profile) -> dict[str, Any]:
    """Return the trace: a process for each robot, named "robots #0", whose calls are complete events, in us.

    Raises:
        ProfileError: The profile has no calls.
    """
    if not profile.spans:
        raise ProfileError("the profile has no calls of the first ticks ('spans' is empty), so there is no trace")
    of_library = functions_of_library(profile)
    names = [
        {
            "ph": "M",
            "name": "process_name",
            "pid": robot.identifier,
            "tid": 0,
            "args": {"name": f"{robot.category} #{robot.identifier}"},
        }
        for robot in profile.robots
    ]
    calls = [
        {
            "ph": "X",
            "name": profile.functions[span.function],
            "cat": "library" if span.function in of_library else "program",
            "ts": span.begin_us,
            "dur": span.duration_us,
            "pid": span.robot,
            "tid": 0,
        }
        for span in profile.spans
    ]
    return {"traceEvents": [*names, *calls], "displayTimeUnit": "ns", "otherData": {"firmware": profile.firmware}}


def write_trace(profile: Profile, file: Path) -> None:
    """Write the trace.

    Raises:
        ProfileError: The profile has no calls.
        OSError: It cannot be written.
    """
    file.write_text(json.dumps(trace_of(profile)), encoding="utf-8")
