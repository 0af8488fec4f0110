"""A warning about data, apart from what computes, so that command lines can name it at once."""

from __future__ import annotations


class AmbiguousStepsWarning(RuntimeWarning):
    """Rows are so far apart in time that robots may have gone another way than the shortest."""
