"""What analyses say when data cannot be analysed."""

from __future__ import annotations


class AnalysisError(ValueError):
    """Data do not have what an analysis needs; says what, and what to do."""
