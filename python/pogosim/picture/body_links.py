"""Links between bodies: springs, rods and hinges, as the metadata of a data file tell them."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.deferred import pandas as pd
from pogosim.errors import PictureError
from pogosim.periodic import minimum_image
from pogosim.picture.images import Box
from pogosim.shapes import Floats
from pogosim.times import slack_s

Indices = npt.NDArray[np.int64]

ARENA = -1  # in place of an object
UNKNOWN = -2  # an object without rows
LEAST_TENSION_N = 1e-6  # that is shown: rounding is not
N_PER_MM = 1e-3  # of a stiffness of 1 N/m


@dataclass(frozen=True)
class BodyLinks:
    """The n links of a run that are drawn. Lengths in mm, times in s, forces in N."""

    a: Indices  # shape (n,): numbers of objects
    b: Indices  # shape (n,): the same, or ARENA
    kind: npt.NDArray[np.str_]  # shape (n,): spring, rod or hinge
    end_a: Floats  # shape (n, 2), in the frame of the object
    end_b: Floats  # shape (n, 2), the same; of ARENA a place
    rest: Floats  # shape (n,)
    stiffness: Floats  # shape (n,), N/m
    breaking: Floats  # shape (n,), may be infinite
    made: Floats  # shape (n,)
    cut: Floats  # shape (n,), infinite: it is not

    def chosen(self, which: npt.NDArray[Any]) -> BodyLinks:
        """Return some of the links, by their numbers or by truth values."""
        return BodyLinks(*(getattr(self, one.name)[which] for one in fields(self)))

    def at(self, time_s: float) -> BodyLinks:
        """Return the links that hold at a time."""
        late = time_s + slack_s(time_s)
        return self.chosen((self.made <= late) & (self.cut > late))

    def __len__(self) -> int:
        return len(self.a)


@dataclass(frozen=True)
class PlacedLinks:
    """Links where they are at a time."""

    start: Floats  # shape (k, 2), mm
    end: Floats  # shape (k, 2): in a periodic arena the image next to the start
    kind: npt.NDArray[np.str_]  # shape (k,)
    load: Floats  # shape (k,), -1 (pushed) to 1 (pulled): tension by the breaking force, or by the largest tension
    is_pinned: npt.NDArray[np.bool_]  # shape (k,): ends at a place in the arena


def read_body_links(metadata: dict[str, Any], numbers: dict[tuple[str, int], int]) -> BodyLinks | None:
    """Read the links of a run.

    Args:
        metadata: Those of its file.
        numbers: Numbers of objects, by category and id.

    Returns:
        Links that are drawn, whose objects have rows; None if there are none.

    Raises:
        PictureError: The metadata are not those that the simulator writes.
    """
    try:
        changes = json.loads(metadata.get("link_changes", "{}"))
        tables = [json.loads(text) for text in (metadata.get("links"),) if text]
        initial = sum(len(table["a"]) for table in tables)
        tables += [changes["made"]] if changes else []
        found = [table_of(table, numbers) for table in tables]
        if not found:
            return None
        links = BodyLinks(*(np.concatenate([getattr(one, name.name) for one in found]) for name in fields(BodyLinks)))
        if changes:
            links.made[initial:] = changes["made"]["time_s"]
            links.cut[changes["cut"]["link"]] = changes["cut"]["time_s"]
        drawn = np.concatenate([is_drawn(table) for table in tables])
        links = links.chosen(drawn & (links.a >= 0) & (links.b != UNKNOWN))
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise PictureError(f"its metadata 'links' or 'link_changes' are not those of the simulator: {error}") from error
    return links if len(links) else None


def is_drawn(table: dict[str, Any]) -> npt.NDArray[np.bool_]:
    """Tell which links are of a category that is drawn."""
    drawn = np.array([bool(category["drawn"]) for category in table["categories"]], dtype=bool)
    return drawn[np.array(table["category"], dtype=np.int64)]


def table_of(table: dict[str, Any], numbers: dict[tuple[str, int], int]) -> BodyLinks:
    """Return links as the metadata have them, from the start of the run on."""
    own = [numbers.get((str(category), int(own_id)), UNKNOWN) for category, own_id in table["objects"]]
    object_of = np.array([*own, ARENA], dtype=np.int64)  # -1 is the last one
    count = len(table["a"])

    def column(name: str, missing: float) -> Floats:
        return np.array([missing if value is None else float(value) for value in table[name]], dtype=float)

    return BodyLinks(
        a=object_of[np.array(table["a"], dtype=np.int64)],
        b=object_of[np.array(table["b"], dtype=np.int64)],
        kind=np.array(table["kind"], dtype="U6"),
        end_a=np.array(table["end_a_mm"], dtype=float).reshape(count, 2),
        end_b=np.array(table["end_b_mm"], dtype=float).reshape(count, 2),
        rest=column("rest_mm", 0.0),
        stiffness=column("stiffness_n_m", 0.0),
        breaking=column("breaking_n", np.inf),
        made=np.zeros(count),
        cut=np.full(count, np.inf),
    )


def placed_links(
    links: BodyLinks, objects: Indices, position: Floats, angle: Floats, time_s: float, box: Box | None
) -> PlacedLinks:
    """Return where the links are that hold at a time.

    The load of springs is that of their stretch; what pulls at rods and hinges is not in the file, and their load is 0.

    Args:
        links: Those of the run.
        objects: Numbers of the m objects that there are, ascending.
        position: Theirs, shape (m, 2).
        angle: Theirs, shape (m,), rad.
        time_s: The time.
        box: The box of a periodic arena; None: walls are solid.
    """
    links = links.at(time_s)
    links = links.chosen(np.isin(links.a, objects) & ((links.b == ARENA) | np.isin(links.b, objects)))
    is_pinned = links.b == ARENA
    angle = np.nan_to_num(angle)

    def ends(number: Indices, end: Floats) -> Floats:
        row = np.minimum(np.searchsorted(objects, number), max(len(objects) - 1, 0))
        cos, sin = np.cos(angle[row]), np.sin(angle[row])
        x, y = end.T
        return np.asarray(position[row] + np.column_stack([x * cos - y * sin, x * sin + y * cos]))

    start = ends(links.a, links.end_a)
    end = np.where(is_pinned[:, None], links.end_b, ends(links.b, links.end_b))
    end = start + minimum_image(end - start, None if box is None else box[1] - box[0])
    is_spring = links.kind == "spring"
    stretch = np.hypot(*(end - start).T) - links.rest
    tension = np.where(is_spring, N_PER_MM * links.stiffness * stretch, 0.0)
    breaks = np.isfinite(links.breaking)
    largest = max(float(np.abs(tension[~breaks]).max(initial=0.0)), LEAST_TENSION_N)
    load = np.clip(tension / np.where(breaks, links.breaking, largest), -1.0, 1.0)
    return PlacedLinks(start, end, links.kind, load, is_pinned)


def placed_at(links: BodyLinks, rows: pd.DataFrame, column: str, time_s: float, box: Box | None) -> PlacedLinks:
    """Return what placed_links() does for rows, one of each object.

    Args:
        links: Those of the run.
        rows: With x, y and angle.
        column: Where they have the number of the object.
        time_s: The time.
        box: As there.
    """
    ordered = rows.sort_values(column)
    position = ordered[["x", "y"]].to_numpy(dtype=float)
    numbers = ordered[column].to_numpy(dtype=np.int64)
    return placed_links(links, numbers, position, ordered["angle"].to_numpy(dtype=float), time_s, box)
