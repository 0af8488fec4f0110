"""The colours of pictures: those of the simulator's window, too."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.colors import rgb_to_hsv, to_rgb

from pogosim.shapes import Floats

PALETTE: dict[str, Any] = json.loads((Path(__file__).parents[1] / "palette.json").read_text(encoding="utf-8"))
PAPER: str = PALETTE["paper"]
FLOOR: str = PALETTE["floor"]
WALL: str = PALETTE["wall"]
EDGE: str = PALETTE["edge"]
INK: str = PALETTE["ink"]
DARK_LED = to_rgb(PALETTE["dark_led"])  # of a robot whose LED is off
NO_LED = to_rgb(PALETTE["no_led"])  # of what has none
DARK_WALL = to_rgb(PALETTE["dark_wall"])  # of a wall with a program whose LED is off
LAMPLIGHT = to_rgb(PALETTE["lamplight"])
MAX_LAMPLIGHT: float = PALETTE["brightest_lamplight"]  # opacity over the floor where it is brightest
LEDS = (PALETTE["dimmest_led"], PALETTE["brightest_led"])  # values between which brightness differs
LEDS_ON_SCREEN = (PALETTE["dimmest_led_on_screen"], PALETTE["brightest_led_on_screen"])  # 0 to 255
LINK: str = PALETTE["link_by_all_emitters"]


def led_brightness(led: npt.ArrayLike) -> Floats:
    """Brightness on the screen, 0 to 1, of LED values 0 to 255; any shape.

    The LEDs of the robots are bright at low values already: 0 is dark, 1 to 25 go linearly from
    100/255 to 210/255, and more does not look brighter.
    """
    values = np.asarray(led, dtype=float)
    lit = np.interp(values, LEDS, LEDS_ON_SCREEN) / 255.0
    return np.where(values > 0, lit, 0.0)


def palette_of(view: Mapping[str, Any]) -> dict[str, Any]:
    """Return the palette in the theme of a section `view` of a configuration."""
    return {**PALETTE, **(PALETTE["light"] if view.get("theme") == "light" else {})}


def in_distinct_hues(colours: Floats) -> Floats:
    """Lights of the same brightness in hues that are distinct with any colour vision. Shapes (n, 3), 0 to 1."""
    hue, saturation, most = rgb_to_hsv(colours).T
    hues = np.array([to_rgb(colour) for colour in PALETTE["color_blind"]["led_by_hue"]])
    place = hue * len(hues)
    distinct = np.stack([np.interp(place, range(len(hues) + 1), [*channel, channel[0]]) for channel in hues.T], axis=-1)
    brightness = np.minimum(most * 255.0 / PALETTE["brightest_led_on_screen"], 1.0)
    grey = most[:, None]
    return np.asarray(grey + saturation[:, None] * (brightness[:, None] * distinct - grey))


def tension_colours(load: npt.ArrayLike, palette: Mapping[str, Any] = PALETTE) -> Floats:
    """Colours of links between bodies, shape (n, 3), 0 to 1, by their load: -1 (pushed) to 1 (pulled), shape (n,)."""
    values = np.asarray(load, dtype=float)
    colours = np.array([to_rgb(palette[name]) for name in ("link_pushed", "link_at_rest", "link_pulled")])
    return np.stack([np.interp(values, (-1.0, 0.0, 1.0), channel) for channel in colours.T], axis=-1)


def led_colours(led_rgb: npt.ArrayLike, view: Mapping[str, Any] | None = None) -> Floats:
    """Colours on the screen of LED values 0xRRGGBB of shape (n,), in a section `view`. Shape (n, 3), 0 to 1."""
    view = view or {}
    packed = np.asarray(led_rgb, dtype=np.int64)
    channels = np.stack([(packed >> shift) & 0xFF for shift in (16, 8, 0)], axis=-1)
    colours = led_brightness(channels)
    if view.get("palette") == "color_blind":
        colours = in_distinct_hues(colours)
    colours[packed == 0] = to_rgb(palette_of(view)["dark_led"])
    return colours
