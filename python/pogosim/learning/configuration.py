"""The configuration of an environment, which may be a file or a map."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pogosim.simulation.errors import given
from pogosim.simulation.forked import finalize_here


class ConfigurationFile:
    """A file with a configuration: that of a path, or a temporary one with a map in it.

    Attributes:
        path: The file. Relative names in a map are searched as those in a file of the working folder.
        close: Removes a temporary file, as the end of this object does; only in the process that wrote it.
    """

    def __init__(self, configuration: Any) -> None:
        """Write the map, if it is one.

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
        ignores_errors = True
        self.close = finalize_here(self, shutil.rmtree, folder, ignores_errors)
        self.path = folder / "configuration.yaml"
        self.path.write_text(text, encoding="utf-8")
