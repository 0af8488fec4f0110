"""What pictures of a recorded run show: what its configuration says, and what the command line says instead."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any

import numpy as np

from pogosim.film.painter import Painter, Stage
from pogosim.picture.swarm import Swarm
from pogosim.view.beginning import plain


def shown_by(configuration: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys of a configuration that say what pictures show, but for those that stand for several values."""
    view = configuration.get("view")
    older = {key: value for key, value in configuration.items() if key.startswith("show_")}
    return {**plain(older), "view": plain(view) if isinstance(view, dict) else {}}


def asked_for(options: argparse.Namespace) -> dict[str, Any]:
    """Return what options of `pogosim film` say of what pictures show, as keys of the section `view`."""
    keys: dict[str, Any] = {"links": "below"} if options.links else {}
    if options.tail is not None:
        keys["trails"] = True
    return {**keys, **dict(options.view)}


def check_view(swarm: Swarm, asked: Mapping[str, Any]) -> None:
    """Let the painter of films look at keys of the section `view`, for pages, which have none.

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
