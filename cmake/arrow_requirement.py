"""What the package requires of pyarrow, for scikit-build-core (see pyproject.toml, dynamic-metadata)."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from typing import Any


class ArrowRequirement:
    """The simulator needs the library of Arrow it was built with; Python code alone takes any."""

    def __init__(self) -> None:
        self.has_simulator = False

    def build_state(self, state: str) -> None:
        """Take note of what is built: sdist, wheel, editable, metadata_wheel or metadata_editable."""
        self.has_simulator = state in ("wheel", "metadata_wheel")

    def dynamic_metadata(self, settings: Mapping[str, Any], project: Mapping[str, Any]) -> dict[str, Any]:  # noqa: ARG002
        """Return entries to add to [project]."""
        if not self.has_simulator:
            return {"dependencies": []}
        major, minor, *_ = version("pyarrow").split(".")
        return {"dependencies": [f"pyarrow=={major}.{minor}.*"]}  # libarrow.so.2601 is of 26.1

    def dynamic_wheel(self, settings: Mapping[str, Any]) -> dict[str, bool]:  # noqa: ARG002
        """Return the fields that may differ between source distribution and wheel."""
        return {"dependencies": True}
