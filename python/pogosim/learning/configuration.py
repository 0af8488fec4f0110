"""The configuration of an environment, which may be a file or a map."""

from __future__ import annotations

import os
import shutil
import tempfile
import weakref
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pogosim.simulation.errors import given


def remove_folder(folder: Path, process: int) -> None:
    """Remove a folder, unless this process is a copy (fork) of the one that made it and may still need it."""
    if os.getpid() == process:
        shutil.rmtree(folder, ignore_errors=True)


class ConfigurationFile:
    """A file with a configuration: that of a path, or a temporary one with a map in it.

    Attributes:
        path: It. Relative names in a map are searched as those in a file of the working folder.
        close: Removes a temporary file, as the end of this object does; only in the process that wrote it.
    """

    def __init__(self, configuration: Any) -> None:
        """Write it if need be.

        Raises:
            ConfigurationError: It is neither a path nor a map of values that YAML can represent.
        """
        self.close: Callable[[], object] = lambda: None
        if not isinstance(configuration, Mapping):
            self.path = given.path("configuration", configuration)
            return
        from pogosim.yaml_1_2 import dump_yaml  # loads PyYAML

        text = dump_yaml(given.value("configuration", configuration))
        folder = Path(tempfile.mkdtemp(prefix="pogosim-"))
        self.close = weakref.finalize(self, remove_folder, folder, os.getpid())
        self.path = folder / "configuration.yaml"
        self.path.write_text(text, encoding="utf-8")
