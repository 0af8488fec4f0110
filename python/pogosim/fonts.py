"""Names in pictures, of any characters."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator


@contextlib.contextmanager
def any_characters() -> Iterator[None]:
    """Draw boxes in place of characters that the font lacks, without two lines of a warning for each of them."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph ", category=UserWarning)
        yield
