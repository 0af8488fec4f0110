"""Cards of a film: writing before its first frame, and behind its last one."""

from __future__ import annotations

import textwrap

from pogosim.film.frames import DPI, new_figure, pixels_of
from pogosim.film.painter import Picture
from pogosim.fonts import literal
from pogosim.picture.palette import INK

CARD_S = 2.0  # how long a card is shown
TITLE, TEXT = 0.06, 0.032  # heights of letters, as shares of the shorter side
WIDTH_OF_LETTER = 0.6  # of its height, on average
FILLED = 0.86  # share of the width that lines may have


def card(size: tuple[int, int], title: str = "", text: str = "") -> Picture:
    """Draw a card. Shape (height, width, 3).

    Args:
        size: Width and height, pixels.
        title: Large, above the text; any characters.
        text: Lines.
    """
    figure = new_figure(size)
    middle = 0.5 if not (title and text) else 0.54
    for words, share, y, side in ((title, TITLE, middle, "bottom"), (text, TEXT, middle - 0.03, "top")):
        height_px = share * min(size)
        letters = max(int(FILLED * size[0] / (WIDTH_OF_LETTER * height_px)), 8)
        lines = [textwrap.fill(literal(line), letters) for line in words.splitlines()]
        is_alone = not (title and text)
        figure.text(
            0.5,
            0.5 if is_alone else y,
            "\n".join(lines),
            fontsize=72.0 * height_px / DPI,
            color=INK,
            ha="center",
            va="center" if is_alone else side,
            linespacing=1.4,
        )
    return pixels_of(figure)
