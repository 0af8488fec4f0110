"""A run as pictures need it: the rows of its data file, and what the configuration says of objects, arena and light."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.arguments import Arguments
from pogosim.defaults import COMMUNICATION_RADIUS_MM, POGOBOT_RADIUS_MM
from pogosim.deferred import pandas as pd
from pogosim.errors import MissingColumnWarning, PictureError
from pogosim.far_away import is_near
from pogosim.object_categories import UnknownCategoriesError, kinds_of, last_kinds, with_categories
from pogosim.object_facts import entries_of
from pogosim.outputs import PathLike
from pogosim.picture.body_links import BodyLinks, read_body_links
from pogosim.picture.colouring import Colouring, checked_column, colouring_of, legend_of_categories
from pogosim.picture.palette import NO_LED, led_colours
from pogosim.picture.selection import checked, numbers_runs, one_run
from pogosim.picture.speed import OBJECT as OBJECT_COLUMN
from pogosim.picture.speed import SPEED, object_steps, with_speed
from pogosim.scene import (
    Kind,
    Lamp,
    bounds,
    kinds_in,
    lamps_in,
    read_periodic,
    top_speed,
    unseen_light,
)
from pogosim.several_files import configuration_of
from pogosim.shapes import Floats, Shape
from pogosim.times import slack_s, with_exact_times
from pogosim.utils import load_dataframe
from pogosim.view.beginning import view_of

# Robots of the real swarm, where a file does not say.
UNKNOWN = Kind("robots", Shape(radius_mm=POGOBOT_RADIUS_MM), communication_radius_mm=COMMUNICATION_RADIUS_MM)

# Columns that are added to those of the file. No program's column has such a name: it would end at its first character.
OBJECT = OBJECT_COLUMN
KIND = "\0kind"  # place in Swarm.kinds
RGB = ["\0rgb_0", "\0rgb_1", "\0rgb_2"]


@dataclass
class Swarm:
    """One run up to a time, ready to be drawn. Lengths in mm, y downwards; times in s."""

    rows: pd.DataFrame  # finite poses of objects, ordered by time; columns OBJECT, KIND, RGB (0 to 1) added
    dots: pd.DataFrame  # the same of the parts of membranes, at the end; columns subpart_id, too
    wall_colours: dict[int, Floats]  # of pogowalls at the end, by their place in kinds
    polygons: list[Floats]  # each of shape (vertices, 2), at least one; the outer wall first
    kinds: list[Kind]  # of the entries of the configuration; the last one is UNKNOWN
    lamps: list[Lamp]
    unseen_light: list[str]  # what is not drawn of lamps, "beams of tower"
    end_s: float
    is_periodic: bool = False
    top_speed_mm_s: float | None = None  # of the robots that drive; None: the file does not say
    links: BodyLinks | None = None  # between bodies
    colouring: Colouring | None = None  # what colours mean; None: LEDs, or the only category of a file without

    @property
    def period_mm(self) -> Floats | None:
        """Width and height after which a periodic arena repeats; None if it has walls."""
        low, high = bounds(self.polygons)
        return high - low if self.is_periodic else None

    def check_steps(self) -> None:
        """Warn (AmbiguousStepsWarning) if objects need not have gone the shortest way between their records."""
        if self.is_periodic:
            object_steps(self.rows, self.period_mm, self.top_speed_mm_s)


@dataclass
class Recording:
    """One whole run. Lengths in mm, y downwards; times in s."""

    last: Swarm  # at its end; with the dots of membranes at all times
    walls: pd.DataFrame  # rows of pogowalls at all times
    left_out: str = ""  # what the file holds besides this run; empty: nothing
    configuration: dict[str, Any] = field(default_factory=dict)  # of the run; empty: the file does not say

    @property
    def times_s(self) -> npt.NDArray[np.float64]:
        """Times of the file, each once, ascending."""
        return np.unique(self.last.rows["time"].to_numpy(dtype=float))

    def until(self, time_s: float | None = None) -> Swarm:
        """Return the run up to a time: the last state of the file at or before it.

        Args:
            time_s: In s. None: the end.

        Raises:
            PictureError: The run has not begun by then, or is over.
        """
        rows, dots = self.last.rows, self.last.dots
        end_s = self.last.end_s
        if time_s is not None:
            known_s = self.times_s
            slack = slack_s(time_s)
            if not known_s[0] - slack <= time_s <= known_s[-1] + slack:
                raise PictureError(
                    f"it has rows from {known_s[0]:.9g} s to {known_s[-1]:.9g} s, none at {time_s:.9g} s"
                )
            end_s = float(known_s[np.searchsorted(known_s, time_s + slack, side="right") - 1])
            rows = rows[rows["time"] <= end_s]
        return replace(
            self.last,
            rows=rows,
            dots=dots[dots["time"] == end_s],
            wall_colours=self.wall_colours(end_s),
            end_s=end_s,
        )

    def wall_colours(self, time_s: float) -> dict[int, Floats]:
        """Colours of pogowalls at a time, by their place in kinds."""
        if self.walls.empty:
            return {}
        walls = self.walls[self.walls["time"] <= time_s].groupby(KIND).tail(1)
        return dict(zip(walls[KIND].to_list(), walls[RGB].to_numpy(), strict=True))


given = Arguments(PictureError)


def read_swarm(path: PathLike) -> Swarm:
    """Read the file of a run (of several runs: the first), up to its end.

    Raises:
        PictureError: The file has no poses.
        OSError, ValueError: It cannot be read.
    """
    return read_recording(path).until()


def read_recording(
    path: PathLike, run: int | None = None, color_by: str | None = None, combination: int | None = None
) -> Recording:
    """Read the file of a run, or one run of a file of several.

    Args:
        path: Feather file, of a run or of a batch of runs.
        run: Number in its column run. None: the first.
        color_by: Column whose values colour the objects, or "speed" (mm/s); "led_rgb" or "": their LEDs. None: what
            view.color_by of its configuration says.
        combination: Combination of the options of a batch, from 0 on. None: the first.

    Raises:
        PictureError: The file has no poses, no such run, or no such column.
        OSError, ValueError: It cannot be read.
    """
    run = None if run is None else given.integer("run", run)
    combination = None if combination is None else given.integer("combination", combination)
    color_by = None if color_by is None else given.text("color_by", color_by)
    rows, metadata = load_dataframe(path)
    missing = {"time", "x", "y"} - set(rows.columns)
    if missing:
        raise PictureError(f"it has no column {', '.join(sorted(missing))} (see data_logger_fields)")
    rows = checked(with_exact_times(rows))
    several = numbers_runs(rows, metadata)  # whose links the file does not tell apart
    rows, polygons, left_out = one_run(rows, metadata, run, combination)
    rows = rows[is_near(rows)]
    configuration = configuration_of(metadata)
    if color_by is None:
        color_by = colours_of_view(configuration, rows)
    if color_by not in ("", SPEED, "led_rgb"):
        checked_column(rows, color_by)
    entries = entries_of(metadata)
    kinds = kinds_in(entries)
    rows = with_categories(rows, metadata)
    rows = completed(with_defaults(rows.assign(**{KIND: kind_numbers(rows, metadata, kinds)})))
    kinds.append(UNKNOWN)
    is_periodic = read_periodic(configuration)
    top_speed_mm_s = top_speed(entries)
    if color_by == SPEED:
        rows = with_speed(rows, np.ptp(polygons[0], axis=0) if is_periodic and polygons else None, top_speed_mm_s)
    rows, colouring = coloured(rows, kinds, color_by)

    # In files of earlier versions, walls have no pose.
    is_wall = rows_of_kinds(rows, [kind.is_wall for kind in kinds])
    has_pose = np.isfinite(rows["time"]) & np.isfinite(rows["x"]) & np.isfinite(rows["y"]) & ~is_wall
    is_part = rows["subpart_id"] >= 0
    objects = rows[has_pose & ~is_part].reset_index(drop=True)
    if objects.empty:
        raise PictureError("it holds no object with a position")
    last = Swarm(
        rows=objects,
        dots=rows[has_pose & is_part],
        wall_colours={},
        polygons=polygons or [box_around(rows[has_pose], kinds)],
        kinds=kinds,
        lamps=lamps_in(entries),
        unseen_light=unseen_light(entries),
        end_s=float(objects["time"].iloc[-1]),
        is_periodic=is_periodic,
        top_speed_mm_s=top_speed_mm_s,
        links=None if several else read_body_links(metadata, object_numbers(objects)),
        colouring=colouring,
    )
    return Recording(last, rows[is_wall], left_out, configuration)


def colours_of_view(configuration: Mapping[str, Any], rows: pd.DataFrame) -> str:
    """Return the column that colours objects by the section `view` of a configuration; "": LEDs."""
    name = str(view_of(configuration).get("color_by", ""))
    if name in ("", SPEED) or list(rows.columns).count(name) == 1:
        return name
    warnings.warn(f"view.color_by: the data file has no column {name}", MissingColumnWarning, stacklevel=3)
    return ""


def object_numbers(rows: pd.DataFrame) -> dict[tuple[str, int], int]:
    """Return the numbers of objects, by category and id."""
    first = rows.drop_duplicates(OBJECT)
    keys = zip(first["robot_category"], first["robot_id"], first[OBJECT], strict=True)
    return {(str(category), int(own)): int(number) for category, own, number in keys if pd.notna(own)}


def with_defaults(rows: pd.DataFrame) -> pd.DataFrame:
    """Add columns of the simulator that are not there."""
    defaults: tuple[tuple[str, Any], ...]
    defaults = (("robot_id", 0), ("angle", np.nan), ("subpart_id", -1))
    return rows.assign(**{name: default for name, default in defaults if name not in rows})


def completed(rows: pd.DataFrame) -> pd.DataFrame:
    """Order rows by time, and number the objects."""
    rows = rows.sort_values("time", kind="stable").reset_index(drop=True)
    return rows.assign(**{OBJECT: rows.groupby(["robot_category", "robot_id"], sort=True).ngroup()})


def kind_numbers(rows: pd.DataFrame, metadata: dict[str, Any], kinds: list[Kind]) -> npt.NDArray[np.int64]:
    """Return the place in Swarm.kinds of each row; of an entry of its category where nothing says of which."""
    try:
        return kinds_of(rows, metadata, kinds)
    except UnknownCategoriesError:
        objects = configuration_of(metadata)["objects"]
        lists = sorted({kind.category for kind in kinds if isinstance(objects[kind.category], list)})
        warnings.warn(
            f"nothing says which objects of {', '.join(lists)} are of which entry of the list (nb, robot_id), so all "
            "are drawn as those of the last one",
            RuntimeWarning,
            stacklevel=3,
        )
        return last_kinds(rows, kinds)


def rows_of_kinds(rows: pd.DataFrame, is_wanted: Sequence[bool]) -> npt.NDArray[np.bool_]:
    """Tell which rows are those of objects of some kinds, shape (rows,), from whether each kind is wanted."""
    return np.asarray(np.array(is_wanted, dtype=bool)[rows[KIND].to_numpy()])


def coloured(rows: pd.DataFrame, kinds: list[Kind], color_by: str = "") -> tuple[pd.DataFrame, Colouring | None]:
    """Add the colours of a column, by default LEDs, or of categories if the file does not have those."""
    colouring: Colouring | None = None
    if color_by not in ("", "led_rgb"):
        colouring = colouring_of(rows, color_by)
        colours = colouring.colours(rows[color_by])
    elif "led_rgb" in rows:
        colours = led_colours(rows["led_rgb"].to_numpy())
        colours[~rows_of_kinds(rows, [kind.runs_program for kind in kinds])] = NO_LED
    elif color_by == "led_rgb":
        raise PictureError("it has no column led_rgb of integers (data_logger_led: true writes it)")
    else:
        legend = legend_of_categories(rows["robot_category"])
        colours = legend.colours(rows["robot_category"])
        colouring = legend if len(legend.labels) > 1 else None
    return rows.assign(**dict(zip(RGB, colours.T, strict=True))), colouring


def box_around(rows: pd.DataFrame, kinds: list[Kind]) -> Floats:
    """Return the box in which all objects ever were, as a polygon of shape (4, 2)."""
    margin = max(kinds[number].shape.bounding_radius_mm for number in rows[KIND].unique())
    left, top = rows[["x", "y"]].to_numpy(dtype=float).min(axis=0) - margin
    right, bottom = rows[["x", "y"]].to_numpy(dtype=float).max(axis=0) + margin
    return np.array([[left, top], [right, top], [right, bottom], [left, bottom]])
