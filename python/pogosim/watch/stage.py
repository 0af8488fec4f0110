"""What a viewer needs to know of a run before it shows anything: the arena, the kinds of objects, the light."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.object_facts import entries_of
from pogosim.picture import layers
from pogosim.picture.body_links import LEAST_TENSION_N, N_PER_MM
from pogosim.picture.figure import counted
from pogosim.picture.palette import PALETTE
from pogosim.scene import Kind, bounds, floor_outline, kinds_in, lamps_in, read_periodic
from pogosim.several_files import configuration_of
from pogosim.simulation import Simulation
from pogosim.simulation.library import library
from pogosim.simulation.objects import object_state
from pogosim.utils import parsed
from pogosim.varied import leaves
from pogosim.view.beginning import view_of
from pogosim.view.kinds import category_data, lamp_places
from pogosim.watch.looking import owners_of_parts

MARGIN = 0.1  # of the arena's box on each side, in which poses are told, too
LIGHT_CELLS = 144  # along either side of the arena


class Stage:
    """The arena and the objects of a run, which stay the same until it is reset.

    Attributes:
        low, high: Corners of the box in which poses are told, mm. Shape (2,).
        parameters: Numbers and truth values under `parameters` of the configuration, by name.
    """

    def __init__(self, simulation: Simulation) -> None:
        self.run = simulation._run
        metadata = parsed(json.loads(library().pogosim_run_metadata(self.run.pointer)))
        self._configuration = configuration_of(metadata)
        self._polygons = [np.asarray(polygon, dtype=float) for polygon in metadata["arena_polygons"]]
        low, high = bounds(self._polygons)
        self.low, self.high = low - MARGIN * (high - low), high + MARGIN * (high - low)
        self._box = low, high
        self._states = [object_state(self.run, index) for index in range(int(self.run.number("object_count")))]
        self.robots = np.array([-1 if own.robot == 2**32 - 1 else own.robot for own in self._states], dtype=np.int64)
        self._names = simulation.categories
        self._kinds = self._kinds_of_categories(kinds_in(entries_of(metadata)))
        self._lamps = lamps_in(entries_of(metadata))
        share = (np.arange(LIGHT_CELLS) + 0.5) / LIGHT_CELLS
        self._cell = share
        x, y = np.meshgrid(*(low[:, None] + (high - low)[:, None] * share))
        self._is_floor = floor_outline(self._polygons).contains_points(np.column_stack([x.ravel(), y.ravel()]))
        self.parameters = {
            name: value
            for name, value in leaves(self._configuration.get("parameters") or {})
            if isinstance(value, (bool, int, float))
        }

    def _kinds_of_categories(self, kinds: Sequence[Kind]) -> list[Kind]:
        """Return the kind of each category of the run: entries of one name follow each other in both."""
        left: dict[str, list[Kind]] = {}
        for kind in kinds:
            left.setdefault(kind.category, []).append(kind)
        return [left[name].pop(0) if len(left[name]) > 1 else left[name][0] for name in self._names]

    def head(self, columns: Sequence[str]) -> dict[str, Any]:
        """Return what the program of the view takes; `columns`: names of values that can be asked for."""
        low, high = self._box
        owners = owners_of_parts(self.run)
        return {
            "title": self._title(),
            "notes": "",
            "polygons": [np.round(polygon, 3).tolist() for polygon in self._polygons],
            "low": low.tolist(),
            "high": high.tolist(),
            "poseBox": [self.low.tolist(), self.high.tolist()],
            "periodic": read_periodic(self._configuration),
            "categories": [category_data(name, kind) for name, kind in zip(self._names, self._kinds, strict=True)],
            "objects": [[int(own.category), int(own.id)] for own in self._states],
            "columnNames": list(columns),
            "lightCells": LIGHT_CELLS,
            "walls": self._walls(),
            "lamps": lamp_places(self._lamps),
            "membranes": self._membranes(owners),
            "bodyLinks": None,
            "palette": PALETTE,
            "view": view_of(self._configuration),
        }

    def _title(self) -> str:
        counts: dict[str, int] = {}
        for own in self._states:
            name = self._names[own.category]
            counts[name] = counts.get(name, 0) + 1
        return ", ".join(f"{count}\u00a0{counted(name, count)}" for name, count in sorted(counts.items()))

    def _walls(self) -> list[dict[str, Any]]:
        """Return the lines of walls with a program, and the object that each is."""
        return [
            {
                "object": index,
                "lines": [
                    np.round(line, 3).tolist() for line in layers.wall_lines(self._kinds[own.category], self._polygons)
                ],
            }
            for index, own in enumerate(self._states)
            if self._kinds[own.category].is_wall
        ]

    def _membranes(self, owners: npt.NDArray[np.uint32]) -> dict[str, Any] | None:
        """Return which parts belong to which membrane; None: there are none."""
        if not len(owners):
            return None
        groups = []
        for owner in np.unique(owners):
            parts = np.flatnonzero(owners == owner)
            kind = self._kinds[self._states[owner].category]
            groups.append(
                {
                    "object": int(owner),
                    "first": int(parts[0]),
                    "count": len(parts),
                    "half_thickness": kind.half_thickness_mm,
                    "segments": kind.segments,
                }
            )
        return {"dots": len(owners), "groups": groups}

    def light(self, levels: npt.NDArray[np.int16]) -> npt.NDArray[np.uint8]:
        """Return how bright each cell of the floor is drawn, 0 to 255, from levels of shape (rows, columns).

        Shape (LIGHT_CELLS * LIGHT_CELLS,), row by row from the top left. All 0 if the light is even.
        """
        rows, columns = ((self._cell * size).astype(int) for size in levels.shape)
        seen = levels[np.ix_(rows, columns)].ravel().astype(float)
        return np.round(255.0 * layers.opacity_of(seen, self._is_floor)).astype(np.uint8)


def link_data(links: npt.NDArray[Any]) -> dict[str, Any] | None:
    """Return links between bodies that hold, as `Simulation.links` gives them; None if there are none."""
    held = links[~links["is_cut"]]
    if not len(held):
        return None
    count = len(held)
    finite = np.isfinite(held["breaking_n"])
    return {
        "a": held["a"].tolist(),
        "b": held["b"].tolist(),
        "kind": [str(one) for one in held["kind"]],
        "endA": np.round(held["end_a_mm"], 3).tolist(),
        "endB": np.round(held["end_b_mm"], 3).tolist(),
        "rest": np.round(np.nan_to_num(held["rest_mm"]), 3).tolist(),
        "stiffness": (N_PER_MM * np.nan_to_num(held["stiffness_n_m"])).tolist(),  # N per mm
        "breaking": [float(one) if known else None for one, known in zip(held["breaking_n"], finite, strict=True)],
        "made": [-1.0] * count,
        "cut": [1e30] * count,
        "leastTension": LEAST_TENSION_N,
    }


def lamp_data(simulation: Simulation) -> list[dict[str, Any]]:
    """Return the lamps of a run: name, place (mm), whether they shine, and their intensity."""
    return [
        {"name": own.category, "place": list(own.position), "on": own.is_on, "intensity": own.intensity}
        for own in simulation.lamps
    ]


def plain_numbers(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values as JSON has them: numbers that are not finite as texts."""
    return {
        name: value if not isinstance(value, float) or np.isfinite(value) else str(value)
        for name, value in values.items()
    }
