"""YAML of simple values, without PyYAML, whose import takes longer than a short run."""

from __future__ import annotations

import math
import re
from typing import Any

# Texts that need no quotation marks, whatever version of YAML reads them: they begin as no number does.
PLAIN = re.compile(r"[A-Za-z/_][A-Za-z0-9/_.+-]*", re.ASCII)
WORDS = frozenset({"y", "n", "yes", "no", "on", "off", "true", "false", "null"})
MOST_CHARACTERS = 1000


def simple_yaml(value: Any) -> str | None:
    """Return what `pogosim.yaml_1_2.dump_yaml` writes for a value, without the end of the line.

    Returns:
        The text; None if the value is none of those whose text is known here.
    """
    kind = type(value)
    if value is None:
        return "null"
    if kind is bool:
        return "true" if value else "false"
    if kind is int:
        return str(value) if abs(value) < 2**63 else None
    if kind is float:
        text = repr(value)
        return text if math.isfinite(value) and "e" not in text else None
    if kind is str and len(value) <= MOST_CHARACTERS and PLAIN.fullmatch(value) and value.lower() not in WORDS:
        return str(value)
    return None
