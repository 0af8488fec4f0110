"""Pictures as bytes, and the names in them, of any characters."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Iterator

import matplotlib as mpl
from matplotlib.figure import Figure

HIDES = "_"  # at the beginning, a label that legends leave out
NOTHING = "\u200b"  # of no width


def literal(text: object) -> str:
    """Return a name so that matplotlib draws it as it is: nothing in it is a formula, and legends have it."""
    shown = str(text).replace("$", r"\$")
    return NOTHING + shown if shown.startswith(HIDES) else shown


@contextlib.contextmanager
def any_characters() -> Iterator[None]:
    """Draw boxes in place of characters that the font lacks, without two lines of a warning for each of them."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph ", category=UserWarning)
        yield


@contextlib.contextmanager
def without_tex() -> Iterator[None]:
    """Draw texts without TeX, whatever the user's matplotlibrc says: it may be missing, and names are no TeX."""
    with mpl.rc_context({"text.usetex": False}):
        yield


@without_tex()
def rendered(figure: Figure, suffix: str, dpi: float = 150.0) -> bytes:
    """Return the bytes of a picture (pdf, png or svg), without the time at which it was made."""
    metadata = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(suffix, {})
    content = io.BytesIO()
    figure.savefig(content, format=suffix, dpi=dpi, metadata=metadata)
    return content.getvalue()
