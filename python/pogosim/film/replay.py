"""A run as one page for the browser: its data, and the program that shows them, without any network."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from pogosim.errors import PictureError
from pogosim.film.first_picture import first_picture
from pogosim.film.packing import MISSING, Packer, encode_column, hex_colour, quantised
from pogosim.film.shown import DENSITY, asked_for, check_follow, check_keys, value_of_heat_map
from pogosim.film.timeline import Timeline, timeline_of
from pogosim.lines import counted
from pogosim.outputs import partial_output
from pogosim.picture import layers
from pogosim.picture.body_links import ARENA, LEAST_TENSION_N, N_PER_MM, PlacedLinks, placed_links
from pogosim.picture.figure import notes, title
from pogosim.picture.links import box_of
from pogosim.picture.palette import PALETTE, led_colours, palette_of
from pogosim.picture.speed import with_speed
from pogosim.picture.swarm import KIND, OBJECT, RGB, Recording, coloured
from pogosim.view import assets
from pogosim.view.beginning import view_of
from pogosim.view.kinds import category_data, lamp_places

FOLDER = Path(__file__).parent
OWN = {"time", "x", "y", "angle", "robot_category", "robot_id", "subpart_id", OBJECT, KIND, "led_rgb", *RGB}
LIGHT_CELLS = 144
MAX_LIGHTS = 100  # pictures of lamps that move
DEFAULT_TAIL_S = 5.0
KEYS = {"\u2190 \u2192": "previous and next record; with shift: ten"}
WITHOUT = "This is the first picture. To replay the run, allow JavaScript for this page."


def write_replay(
    recording: Recording, path: Path, span_s: tuple[float, float], data: str, options: argparse.Namespace
) -> tuple[str, list[str]]:
    """Write the page of a run.

    Args:
        recording: The run.
        path: As real_output() returns it.
        span_s: First and last time, s.
        data: The file of the run, for the title.
        options: Options of the command: color_by, links, speed, tail, view.

    Returns:
        What is said of the page, and warnings.

    Raises:
        PictureError: The run is too large.
        OSError: The page cannot be written.
    """
    text, head, warnings = replay_page(recording, span_s, options, Path(data).name)
    page = text.encode("utf-8")
    with partial_output(path) as partial:
        partial.write_bytes(page)
    count, times = len(head["objects"]), head["times"]
    return f"{counted(count, 'object')} from {times[0]:.9g} s to {times[-1]:.9g} s, {len(page) / 1e6:.2f} MB", warnings


def replay_page(
    recording: Recording, span_s: tuple[float, float], options: argparse.Namespace, name: str
) -> tuple[str, dict[str, Any], list[str]]:
    """Return the page of a run, what it knows of the run, and warnings; `name`: that of the file, for its title.

    Args and errors as of write_replay().
    """
    asked = asked_for(options)
    if options.view:
        check_keys(recording.last, asked)
    if options.color_by is not None:
        asked["color_by"] = options.color_by if options.color_by != "led_rgb" else ""
    head, data, picture, warnings = replay_data(recording, span_s, asked)
    head["start"] = {"speed": options.speed, "tail_s": options.tail or DEFAULT_TAIL_S}
    return page_of(head, data, picture, name), head, warnings


def page_of(head: dict[str, Any], data: str, picture: str, name: str) -> str:
    """Join elements, style, first picture, program and data."""
    text = json.dumps(head, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    body = [
        assets.elements(assets.Parts(KEYS, head["title"], f"{head['times'][0]:.2f} s", picture, WITHOUT)),
        f'<script type="application/json" id="head">{text}</script>',
        f'<script type="text/plain" id="data">{data}</script>',
        f"<script>\n{replay_program()}\n</script>",
    ]
    return assets.page(f"{name} \u2013 Pogosim", assets.text_of("view.css"), "\n".join(body))


def replay_program() -> str:
    """Return the program that shows a run in its page."""
    return assets.program(assets.text_of("recorded_run.js"), (FOLDER / "replay.js").read_text(encoding="utf-8"))


def replay_data(
    recording: Recording, span_s: tuple[float, float], asked: Mapping[str, Any] | None = None
) -> tuple[dict[str, Any], str, str, list[str]]:
    """Return what the page knows of the run: description, tables, first picture, and what had to be left out.

    Args:
        recording: The run.
        span_s: First and last time, s.
        asked: Keys of the section `view` that prevail over those of the configuration.
    """
    swarm = recording.last
    swarm.check_steps()
    bodies = timeline_of(recording, swarm.rows, [OBJECT], *span_s)
    packer = Packer()
    base, codes = base_colours(bodies, recording)
    columns, warnings = column_tables(packer, bodies, recording, {**base, "table": packer.add(codes)})
    head: dict[str, Any] = {
        "title": title(swarm, 1000.0).rsplit(" after ", 1)[0],
        "notes": notes(swarm),
        "times": [float(f"{time:.12g}") for time in bodies.times_s],
        "polygons": [np.round(polygon, 3).tolist() for polygon in swarm.polygons],
        "low": bodies.low_mm.tolist(),
        "high": bodies.high_mm.tolist(),
        "periodic": swarm.is_periodic,
        "categories": [category_data(name, swarm.kinds[kind]) for name, kind in kinds_in(bodies.objects)],
        "objects": object_list(bodies.objects),
        "poses": pose_tables(packer, bodies),
        "columns": columns,
        "lightCells": LIGHT_CELLS,
        "walls": wall_data(recording, bodies),
        "lamps": lamp_places(recording.last.lamps),
        "lights": light_tables(packer, recording, bodies),
        "membranes": membrane_tables(packer, recording, bodies, span_s),
        "bodyLinks": body_link_data(recording, bodies),
        "palette": PALETTE,
        "view": view_of_page(recording, asked or {}),
    }
    poses = first_poses(bodies)
    picture = first_picture(head, poses, first_colours(head, base, codes[0]), first_links(recording, bodies, poses))
    return head, packer.packed(), picture, warnings


def view_of_page(recording: Recording, asked: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the page shows first, as keys of the section `view`.

    Raises:
        PictureError: A robot or value that is asked for is not there.
    """
    of_run = view_of(recording.configuration)
    check_follow(recording.last, asked)
    view = {**of_run, **asked}
    if view.get("heat_map", DENSITY) != DENSITY:
        view["heat_map"] = value_of_heat_map(recording.last, of_run, asked) or ""
    return view


def first_poses(bodies: Timeline) -> npt.NDArray[np.float64]:
    """x, y and angle of each object at the first time, NaN where there is none yet. Shape (n, 3)."""
    rows = bodies.known[0]
    poses = np.column_stack([bodies.position, bodies.angle])[np.maximum(rows, 0)]
    return np.where((rows >= 0)[:, None], poses, np.nan)


def first_links(recording: Recording, bodies: Timeline, poses: npt.NDArray[np.float64]) -> PlacedLinks | None:
    """Links between bodies at the first time."""
    swarm = recording.last
    if swarm.links is None:
        return None
    there = np.isfinite(poses[:, 0])
    numbers = bodies.objects[OBJECT].to_numpy(dtype=np.int64)[there]
    position, angle = poses[there, :2], poses[there, 2]
    return placed_links(swarm.links, numbers, position, angle, float(bodies.times_s[0]), box_of(swarm))


def first_colours(head: dict[str, Any], base: dict[str, Any], codes: npt.NDArray[np.uint16]) -> list[str]:
    """Colour of each object at the first time, as the page has it."""
    shown = base["colours"]
    if base["led"]:
        packed = [int(label[1:], 16) for label in base["labels"]]
        shown = [hex_colour(colour) for colour in led_colours(packed, head["view"])]
    colours = []
    for (category, _), code in zip(head["objects"], codes, strict=True):
        has_none = code == MISSING or (base["led"] and head["categories"][category]["passive"])
        colours.append(str(palette_of(head["view"])["no_led"] if has_none else shown[code]))
    return colours


def kinds_in(objects: pd.DataFrame) -> list[tuple[str, int]]:
    """Categories of objects, in alphabetical order, each with a kind; a category may have several."""
    return sorted({(str(name), int(kind)) for name, kind in zip(objects["robot_category"], objects[KIND], strict=True)})


def object_list(objects: pd.DataFrame) -> list[list[Any]]:
    """Number of the category and robot_id of each object."""
    kinds = kinds_in(objects)
    ids = pd.to_numeric(objects["robot_id"], errors="coerce")
    return [
        [kinds.index((str(name), int(kind))), int(own) if pd.notna(own) and math.isfinite(own) else None]
        for name, kind, own in zip(objects["robot_category"], objects[KIND], ids, strict=True)
    ]


def pose_tables(packer: Packer, timeline: Timeline) -> dict[str, Any]:
    """Add positions and angles, and return which tables those are, and their limits."""
    poses: dict[str, Any] = {}
    for name in ("x", "y", "angle"):
        values, there = timeline.column(name)
        values = np.where(there, values.astype(float), np.nan)
        known = values[np.isfinite(values)]
        low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)
        if name == "angle":
            low, high = min(low, -math.pi), max(high, math.pi)
        poses[name] = {"table": packer.add(quantised(values, low, high)), "low": low, "high": high}
    return poses


def column_tables(
    packer: Packer, bodies: Timeline, recording: Recording, base: dict[str, Any]
) -> tuple[list[dict[str, Any]], list[str]]:
    """Add all columns that can be shown, colours of LEDs first; returns what they are, and what cannot be shown."""
    rows = with_speed(bodies.rows, recording.last.period_mm, recording.last.top_speed_mm_s)
    columns = [base]
    warnings = []
    for name in rows.columns:
        if name in OWN:
            continue
        try:
            codes, meaning = encode_column(rows[name], str(name))
        except PictureError as error:
            warnings.append(f"{error}; the page is without it")
            continue
        columns.append({**meaning, "table": packer.add(spread(codes, bodies))})
    return columns, warnings


def base_colours(bodies: Timeline, recording: Recording) -> tuple[dict[str, Any], npt.NDArray[np.uint16]]:
    """Return what the colours of LEDs are, or of categories if the file does not have those, and their codes (t, n)."""
    rows = bodies.rows
    has_leds = "led_rgb" in rows
    if has_leds:
        packed = rows["led_rgb"].to_numpy().astype(np.int64) & 0xFFFFFF
    else:
        colours = coloured(rows, recording.last.kinds)[0][RGB].to_numpy()
        packed = np.round(colours * 255.0).astype(np.int64) @ np.array([65536, 256, 1])
    if len(np.unique(packed)) >= MISSING:  # the page has codes of 16 bits
        packed &= 0xF8F8F8
    codes, different = pd.factorize(packed, sort=True)
    labels = [f"#{colour:06x}" for colour in different]
    name = "LED" if has_leds else "category"
    name += " of the simulator" if name in rows else ""  # a column of the program has its name for itself
    meaning = {"name": name, "led": has_leds, "base": True, "labels": labels, "colours": None if has_leds else labels}
    return meaning, spread(codes.astype(np.uint16), bodies)


def spread(codes: np.ndarray, timeline: Timeline) -> np.ndarray:
    """Codes of rows at all times, shape (t, n); 65535 where there is no row yet."""
    return np.where(timeline.known >= 0, codes[np.maximum(timeline.known, 0)], MISSING).astype(np.uint16)


def wall_data(recording: Recording, bodies: Timeline) -> list[dict[str, Any]]:
    """Lines of walls with a program, and their colours: pairs of number of the time and colour, None: it is off."""
    swarm = recording.last
    walls = []
    for number, kind in enumerate(swarm.kinds):
        if not kind.is_wall:
            continue
        own = recording.walls[recording.walls[KIND] == number]
        changes: list[list[Any]] = []
        for time, colour in zip(own["time"], own[RGB].to_numpy(), strict=True):
            text = None if layers.is_dark_wall(colour) else hex_colour(colour)
            if not changes or changes[-1][1] != text:
                changes.append([bodies.index_at(float(time)), text])
        lines = [np.round(line, 3).tolist() for line in layers.wall_lines(kind, swarm.polygons)]
        walls.append({"lines": lines, "colours": changes or [[0, None]]})
    return walls


def light_tables(packer: Packer, recording: Recording, bodies: Timeline) -> list[list[int]]:
    """Add pictures of the light; returns pairs of number of the time and table."""
    swarm = recording.last
    moves = any(lamp.orbit_radius_mm and lamp.orbit_speed_rad_s for lamp in swarm.lamps)
    count = len(bodies.times_s)
    chosen = np.unique(np.linspace(0, count - 1, min(count, MAX_LIGHTS)).astype(int)) if moves else range(count)
    lights: list[list[int]] = []
    before: object = None
    for index in chosen:
        time_s = float(bodies.times_s[index])
        key = [(*lamp.centre_at(time_s), lamp.photo_phase(time_s)) for lamp in swarm.lamps]
        if key == before:
            continue
        before = key
        opacity = layers.light_opacity(swarm, time_s, LIGHT_CELLS)
        lights.append([int(index), packer.add(np.round(opacity * 255.0).astype(np.uint16).reshape(1, -1))])
    return lights


def body_link_data(recording: Recording, bodies: Timeline) -> dict[str, Any] | None:
    """Return the links between bodies, by the number of their objects; None if there are none."""
    links = recording.last.links
    if links is None:
        return None
    number = {int(own): i for i, own in enumerate(bodies.objects[OBJECT].to_numpy(dtype=int))}
    last_s = 2.0 * float(bodies.times_s[-1]) + 1.0  # of links that are not cut
    return {
        "a": [number.get(int(one), -2) for one in links.a],
        "b": [number.get(int(one), -2) if one != ARENA else -1 for one in links.b],
        "kind": [str(one) for one in links.kind],
        "endA": np.round(links.end_a, 3).tolist(),
        "endB": np.round(links.end_b, 3).tolist(),
        "rest": np.round(links.rest, 3).tolist(),
        "stiffness": (N_PER_MM * links.stiffness).tolist(),  # N per mm
        "breaking": [float(one) if math.isfinite(one) else None for one in links.breaking],
        "made": links.made.tolist(),
        "cut": np.minimum(links.cut, last_s).tolist(),
        "leastTension": LEAST_TENSION_N,
    }


def membrane_tables(
    packer: Packer, recording: Recording, bodies: Timeline, span_s: tuple[float, float]
) -> dict[str, Any] | None:
    """Add the places of dots of membranes; returns which dots belong together, None if there are none."""
    dots = recording.last.dots
    if dots.empty:
        return None
    timeline = timeline_of(recording, dots, [OBJECT, "subpart_id"], *span_s)
    object_number = {int(own): i for i, own in enumerate(bodies.objects[OBJECT].to_numpy(dtype=int))}
    groups = []
    for _, rows in timeline.objects.reset_index(drop=True).groupby(OBJECT):
        kind = recording.last.kinds[int(rows[KIND].iloc[0])]
        number = int(rows[OBJECT].iloc[0])
        groups.append(
            {
                "object": object_number.get(number),
                "first": int(rows.index[0]),
                "count": len(rows),
                "half_thickness": kind.half_thickness_mm,
                "segments": kind.segments,
            }
        )
    times = [float(f"{time:.12g}") for time in timeline.times_s]
    return {"times": times, "dots": len(timeline.objects), "groups": groups, "poses": pose_tables(packer, timeline)}
