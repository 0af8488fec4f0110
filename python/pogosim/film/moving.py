"""What moves in a film: trails, links, membranes and bodies, drawn as in pictures (layers.py), but faster.

All that can be known before is prepared once as arrays; a frame looks up rows, and draws with a Brush.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.colors import to_rgb
from matplotlib.path import Path as Outline

from pogosim.film.brush import Brush, Disks, outline_of
from pogosim.film.timeline import Rows, timeline_of
from pogosim.picture import layers
from pogosim.picture.body_links import BodyLinks, placed_links
from pogosim.picture.images import lines_between, seen_places
from pogosim.picture.layers import GLOWS, HINGE_PT, LINK_EDGE_PT, LINK_PT, PIN_PT
from pogosim.picture.links import box_of, link_segments, proximity_pairs
from pogosim.picture.palette import DARK_LED, EDGE, LINK, PAPER, tension_colours
from pogosim.picture.swarm import KIND, OBJECT, RGB, Recording
from pogosim.scene import Kind
from pogosim.shapes import Floats

Numbers = npt.NDArray[np.int64]

# Steps of a trail, and pieces that each have one colour, of few robots; of many, together so many.
TRAIL_STEPS, TRAIL_STEPS_OF_ALL, MIN_TRAIL_STEPS = 60, 24_000, 24
TRAIL_PIECES, TRAIL_PIECES_OF_ALL, MIN_TRAIL_PIECES = 24, 12_000, 12
MAX_TRAIL_COLOURS = 64  # of more, similar ones are one

LOADS = 32  # shades of links between bodies, pulled or pushed

EDGE_PT = 0.8
TICK_PT = 1.6


def by_colour(colours: Floats) -> tuple[Floats, Numbers]:
    """Different colours of n, shape (k, 3), and the number of each of the n."""
    packed = np.round(255.0 * colours).astype(np.int64) @ np.array([65536, 256, 1])
    different, number = np.unique(packed, return_inverse=True)
    return np.stack([(different >> shift) & 0xFF for shift in (16, 8, 0)], axis=-1) / 255.0, number.ravel()


class Moving:
    """Draws the objects of a run at any time."""

    def __init__(self, recording: Recording, tail_s: float | None, links: bool) -> None:
        """Prepare.

        Args:
            recording: The run.
            tail_s: Length of the trails, s. None: there are none.
            links: Whether lines join robots near enough to hear each other.
        """
        swarm = recording.last
        swarm.check_steps()
        self.tail_s = tail_s
        self.has_links = links
        self.swarm = swarm
        self.glows = swarm.colouring is None
        self.bodies = timeline_of(recording, swarm.rows, [OBJECT])
        self.extent_mm = layers.extent_of(swarm)
        self.box = box_of(swarm)
        self.is_cut = swarm.is_periodic  # at the border, where things come back on the other side

        # Colour and kind of each row.
        rows = self.bodies.rows
        self.objects = rows[OBJECT].to_numpy(dtype=np.int64)
        self.colours = rows[RGB].to_numpy(dtype=float)
        numbers, self.kind = np.unique(rows[KIND].to_numpy(), return_inverse=True)
        self.kinds = [swarm.kinds[number] for number in numbers]
        of_each = {
            "talks": [own.talks for own in self.kinds],
            "range": [own.communication_radius_mm for own in self.kinds],
            "radius": [own.shape.bounding_radius_mm for own in self.kinds],
            "membrane": [own.is_membrane for own in self.kinds],
        }
        self.of_kind = {name: np.array(values) for name, values in of_each.items()}
        if tail_s:
            self.prepare_trails(tail_s)

    def prepare_trails(self, tail_s: float) -> None:
        """Choose how finely trails are drawn."""
        line = self.bodies
        count = max(line.known.shape[1], 1)
        period_s = float(np.median(np.diff(line.times_s))) if len(line.times_s) > 1 else tail_s
        steps = int(np.clip(TRAIL_STEPS_OF_ALL // count, MIN_TRAIL_STEPS, TRAIL_STEPS))
        pieces = int(np.clip(TRAIL_PIECES_OF_ALL // count, MIN_TRAIL_PIECES, TRAIL_PIECES))
        self.stride = max(round(tail_s / period_s / steps), 1)  # records in a step
        shown = min(steps, max(round(tail_s / period_s), 1))
        self.steps_in_piece = max(int(np.ceil(shown / pieces)), 1)
        shades, number = by_colour(self.colours)
        if len(shades) > MAX_TRAIL_COLOURS:
            shades, number = by_colour((np.round(255.0 * self.colours) // 32 * 32 + 16) / 255.0)
        self.trail_shades, self.trail_shade = shades, number

    def draw(self, brush: Brush, axes: Any, time_s: float, dots: Any) -> None:
        """Draw over the background, from below to above.

        Args:
            brush: Brush of the picture.
            axes: That show the arena.
            time_s: In s.
            dots: Draws membranes, if there are any.
        """
        now, place, angle = self.bodies.poses_at(time_s)
        matrix = axes.transData.get_matrix()
        self.scale, self.origin = matrix[[0, 1], [0, 1]], matrix[:2, 2]  # pixels per mm; y runs downwards
        if self.tail_s:
            self.draw_trails(brush, time_s, now, place)
        if self.has_links:
            self.draw_links(brush, now, place)
        which, place = seen_places(place, GLOWS[0][0] * self.of_kind["radius"][self.kind[now]], self.box)
        now, angle = now[which], angle[which]
        kinds = [(own, np.flatnonzero(self.kind[now] == i)) for i, own in enumerate(self.kinds)]
        shown = [(own, which) for own, which in kinds if len(which) and not own.is_membrane]
        if self.glows:
            for own, which in shown:
                if own.runs_program:
                    self.draw_glows(brush, own, place[which], angle[which], self.colours[now[which]])
        if dots is not None:
            brush.finish()
            dots()
        for own, which in shown:
            self.draw_alike(brush, own, place[which], angle[which], self.colours[now[which]])
        if self.swarm.links is not None:
            self.draw_body_links(brush, self.swarm.links, time_s)
        for own, which in shown:
            self.draw_ticks(brush, own, place[which], angle[which], self.colours[now[which]])
        brush.finish()

    def pixels(self, places_mm: Floats) -> Floats:
        """Places in the picture of places in the arena, shape (..., 2)."""
        return np.asarray(places_mm * self.scale + self.origin)

    def draw_trails(self, brush: Brush, time_s: float, now: Rows, place: Floats) -> None:
        """Draw the way of each object that led to a time, in pieces; those of the same age and colour at once."""
        line, tail_s = self.bodies, self.tail_s
        assert tail_s is not None
        start_s = time_s - tail_s
        first, last = int(np.searchsorted(line.times_s, start_s)), line.index_at(time_s)
        stride = max(self.stride, (last - first) // (2 * TRAIL_STEPS))
        records = np.arange(-(-first // stride) * stride, last + 1, stride)
        is_faint = records < (first + last) / 2  # there, every other place is enough
        records = records[~is_faint | (records // stride % 2 == 0)]
        if not len(records):
            return
        known = line.known[records][:, line.known[last] >= 0]  # shape (records, objects)
        way = np.concatenate([line.position[known], place[None]])  # shape (records + 1, objects, 2)
        step = np.abs(np.diff(way, axis=0))
        is_step = (known >= 0) & ~self.of_kind["membrane"][self.kind[now]]  # the pose of those is their first dot's
        is_near = (step <= self.extent_mm / 2.0).all(axis=-1)
        is_way = is_step & is_near
        is_crossing = is_step & ~is_near & self.is_cut
        shade = np.concatenate([self.trail_shade[known], self.trail_shade[now][None]])
        times_s = np.append(line.times_s[records], time_s)
        piece = (records // stride) // self.steps_in_piece  # that each step belongs to
        begins = np.flatnonzero(np.diff(piece, prepend=piece[0] - 1))
        for begin, end in zip(begins, [*begins[1:], len(piece)], strict=True):
            middle_s = 0.5 * (times_s[begin] + times_s[end])
            freshness = float(np.clip((middle_s - start_s) / tail_s, 0.0, 1.0))
            for number in np.unique(shade[end]):
                mine = (shade[end] == number) & (is_way | is_crossing)[begin:end].any(axis=0)
                if not mine.any():
                    continue
                starts = np.ones((int(mine.sum()), end - begin + 1), dtype=bool)
                starts[:, 1:] = ~is_way[begin:end, mine].T
                path = outline_of(self.pixels(way[begin : end + 1, mine]).transpose(1, 0, 2), False, starts)
                crossing = np.nonzero(is_crossing[begin:end] & mine)
                crosses = len(crossing[0]) > 0
                if crosses:
                    from_mm, to_mm = way[begin:end][crossing], way[begin + 1 : end + 1][crossing]
                    lines = outline_of(self.pixels(lines_between(from_mm, to_mm, self.box)[0]), False)
                    path = Outline.make_compound_path(path, lines)
                    path.should_simplify = False
                colour = (*self.trail_shades[number], 0.04 + 0.7 * freshness**3)
                brush.draw(path, line=colour, width_pt=0.5 + 0.9 * freshness, cap="round", on_floor=crosses)

    def draw_links(self, brush: Brush, now: Rows, place: Floats) -> None:
        """Draw lines between objects near enough to hear each other; they end at the walls."""
        kind = self.kind[now]
        talks = self.of_kind["talks"][kind]
        kind, place = kind[talks], place[talks]
        pairs = proximity_pairs(place, self.of_kind["range"][kind], self.of_kind["radius"][kind], self.box)
        if len(pairs):
            lines = outline_of(self.pixels(link_segments(place, pairs, self.box)), False)
            brush.draw(lines, line=(*to_rgb(LINK), 0.5), width_pt=0.8, on_floor=True)

    def draw_body_links(self, brush: Brush, links: BodyLinks, time_s: float) -> None:
        """Draw links between bodies as pictures do."""
        now, place, angle = self.bodies.poses_at(time_s)
        found = placed_links(links, self.objects[now], place, angle, time_s, self.box)
        shades, shade = by_colour(tension_colours(np.round(LOADS * found.load) / LOADS))
        for kind, width in LINK_PT:
            segments, which = lines_between(found.start, found.end, self.box)
            is_kind = (found.kind == kind)[which]
            segments, own = self.pixels(segments[is_kind]), shade[which[is_kind]]
            if len(segments):
                edge = outline_of(segments, False)
                width_pt = width + 2.0 * LINK_EDGE_PT
                brush.draw(edge, line=(*to_rgb(EDGE), 1.0), width_pt=width_pt, cap="round", on_floor=self.is_cut)
            for number in np.unique(own):
                path = outline_of(segments[own == number], False)
                brush.draw(path, line=(*shades[number], 1.0), width_pt=width, cap="round", on_floor=self.is_cut)
        is_hinge = found.kind == "hinge"
        dots = ((is_hinge, found.start, HINGE_PT), (found.is_pinned & ~is_hinge, found.end, PIN_PT))
        for chosen, points, size_pt in dots:
            unit = brush.renderer.dpi / 72.0
            which, places = seen_places(points[chosen], HINGE_PT * unit / self.scale[0], self.box)
            if len(places):
                disks = Disks(self.pixels(places), on_floor=self.is_cut)
                disks.add((0.5 * size_pt + LINK_EDGE_PT) * unit, np.array(to_rgb(EDGE)))
                brush.stamp_disks(disks.add(0.5 * size_pt * unit, shades[shade[chosen]][which]))

    def draw_glows(self, brush: Brush, own: Kind, place: Floats, angle: Floats, colours: Floats) -> None:
        """Draw how lit LEDs light up the floor around."""
        lit = (colours != DARK_LED).any(axis=1)
        place, angle, colours = place[lit], angle[lit], colours[lit]
        if is_disk(own):
            radius = own.shape.bounding_radius_mm * self.scale[0]
            brush.stamp_disks(Disks(self.pixels(place), on_floor=True).add(radius, colours, GLOWS))
            return
        for share, opacity in GLOWS:
            self.draw_outlines(brush, own, place, angle, colours, share, opacity)

    def draw_alike(self, brush: Brush, own: Kind, place: Floats, angle: Floats, colours: Floats) -> None:
        """Draw the bodies of one category."""
        if not is_disk(own):
            self.draw_outlines(brush, own, place, angle, colours)
            return
        places, radius = self.pixels(place), own.shape.bounding_radius_mm * self.scale[0]
        half_edge = 0.5 * EDGE_PT * brush.renderer.dpi / 72.0
        disks = (
            Disks(places, on_floor=self.is_cut)
            .add(radius + half_edge, np.array(to_rgb(EDGE)))
            .add(max(radius - half_edge, 0.5 * radius), colours)
        )
        brush.stamp_disks(disks)

    def draw_outlines(
        self,
        brush: Brush,
        own: Kind,
        place: Floats,
        angle: Floats,
        colours: Floats,
        share: float = 1.0,
        opacity: float | None = None,
    ) -> None:
        """Draw bodies with corners; glows, which have an opacity, without an edge and only over the floor."""
        corners = self.pixels(layers.placed(share * own.shape.outline(), place, angle))
        shades, shade = by_colour(colours)
        edge = (*to_rgb(EDGE), 1.0)
        for number, colour in enumerate(shades):
            path = outline_of(corners[shade == number], True)
            if opacity is None:
                brush.draw(path, line=edge, width_pt=EDGE_PT, fill=(*colour, 1.0), on_floor=self.is_cut)
            else:
                brush.draw(path, fill=(*colour, opacity), on_floor=True)

    def draw_ticks(self, brush: Brush, own: Kind, place: Floats, angle: Floats, colours: Floats) -> None:
        """Draw where bodies head, in what stands out from their colour."""
        heading = np.column_stack([np.cos(angle), np.sin(angle)])
        ticks = self.pixels(np.stack([place + heading * own.shape.reach_mm * part for part in (0.25, 0.95)], axis=1))
        is_bright = colours @ [0.299, 0.587, 0.114] > 0.25
        for colour, which in ((EDGE, is_bright), (PAPER, ~is_bright)):
            mine = which & np.isfinite(angle)
            if mine.any():
                path = outline_of(ticks[mine], False)
                brush.draw(path, line=(*to_rgb(colour), 1.0), width_pt=TICK_PT, on_floor=self.is_cut)


def is_disk(own: Kind) -> bool:
    """Tell whether the objects of a category are round."""
    return own.shape.is_round
