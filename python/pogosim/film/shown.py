"""What pictures of a recorded run show: what its configuration says, and what the command line says instead."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from pogosim.errors import MissingColumnWarning, PictureError
from pogosim.film.painter import Painter, Stage
from pogosim.picture.colouring import checked_column, holds_numbers
from pogosim.picture.speed import SPEED
from pogosim.picture.swarm import Swarm, rows_of_kinds

DENSITY = "density"  # the heat map of where robots are


def asked_for(options: argparse.Namespace) -> dict[str, Any]:
    """Return what options of `pogosim film` say of what pictures show, as keys of the section `view`."""
    keys: dict[str, Any] = {"links": "below"} if options.links else {}
    if options.tail is not None:
        keys["trails"] = True
    return {**keys, **dict(options.view)}


def check_keys(swarm: Swarm, asked: Mapping[str, Any]) -> None:
    """Check keys of the section `view` for a page, by the simulator's own reader of them.

    Raises:
        PictureError: There is no such key, or it takes other values; or the library is missing.
    """
    none = np.zeros(0, np.uint32)
    description = {
        "view": {},
        "options": dict(asked),
        "periodic": swarm.is_periodic,
        "leds": True,
        "light_map": {"columns": 1, "rows": 1},
        "kinds": [],
        "lamps": [],
    }
    Painter(Stage(description, swarm.polygons, none, none, none))


def check_follow(swarm: Swarm, asked: Mapping[str, Any]) -> None:
    """Raise a PictureError if the robot to follow is not there."""
    robots = swarm.rows["robot_id"][rows_of_kinds(swarm.rows, [kind.runs_program for kind in swarm.kinds])]
    follow = asked.get("follow")
    if isinstance(follow, int) and follow not in robots.to_numpy():
        raise PictureError(f"it has no robot {follow} to follow")


def value_of_heat_map(swarm: Swarm, view: Mapping[str, Any], asked: Mapping[str, Any]) -> str | None:
    """Return the value that the heat map shows: a column of the file, or "speed".

    Args:
        swarm: The run.
        view: The section `view` of its configuration.
        asked: Keys that prevail over these.

    Returns:
        None if there is no heat map, if it is that of the density, or if the file does not have what the configuration
        names (MissingColumnWarning).

    Raises:
        PictureError: What is asked for is not there, or no number.
    """
    name = str(asked.get("heat_map", view.get("heat_map", "")))
    if name in ("", DENSITY):
        return None
    if name == SPEED:
        return name
    if "heat_map" in asked and not holds_numbers(checked_column(swarm.rows, name)):
        raise PictureError(f"its column {name} holds no numbers (heat_map)")
    if name not in swarm.rows or not holds_numbers(swarm.rows[name]):
        warnings.warn(f"view.heat_map: the data file has no numbers {name}", MissingColumnWarning, stacklevel=3)
        return None
    return name
