"""The configuration of an environment, which may be a file or a map."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pogosim.simulation.errors import ConfigurationError, given
from pogosim.simulation.forked import finalize_here
from pogosim.simulation.library import files_of_maps


def remove(folder: Path, file: str) -> None:
    """Remove the folder of a temporary file, which messages name no more."""
    files_of_maps.discard(file)
    shutil.rmtree(folder, ignore_errors=True)


def check_replaced(settings: Mapping[str, Any]) -> None:
    """Check that no map of a setting takes the place of categories that it means to change.

    Raises:
        ConfigurationError: A category in it has no type; says how to write its keys.
    """
    for key, value in settings.items():
        if key != "objects" or not isinstance(value, Mapping):
            continue
        for category, keys in value.items():
            if isinstance(keys, Mapping) and keys and "type" not in keys:
                raise ConfigurationError(
                    f"set: objects: a map replaces all categories: write the keys one by one, such as "
                    f"{f'objects.{category}.{next(iter(keys))}'!r}"
                )


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
        self.path = folder / "configuration.yaml"
        files_of_maps.add(str(self.path))
        self.close = finalize_here(self, remove, folder, str(self.path))
        self.path.write_text(text, encoding="utf-8")
