"""The files that a profiled run reads, or that its configuration names: no output may take the place of one."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from pogosim.batch.runs.named_files import NamedFile, any_entries_in, may_be_a_name, named_files
from pogosim.batch.runs.run_files import OUTPUTS, value_at
from pogosim.extensions import MODELS_VARIABLE
from pogosim.firmware.profile.sources import folders_of
from pogosim.installation import Installation
from pogosim.outputs import OutputError, leads_to
from pogosim.table_formats import BESIDE
from pogosim.yaml_1_2 import WRONG_VALUES, parse_yaml

OF_SOURCES = {".c", ".cpp", ".h", ".hpp", ".mk"}
INCLUDED = re.compile(r'^\s*#\s*(?:include|embed)\s*"([^"\n]+)"', re.MULTILINE)


def check_outputs(outputs: Mapping[str, Path], inputs: Iterator[NamedFile]) -> None:
    """Check that no output, by the name of its option, leads to an input; inputs are not looked at in vain.

    Costs of functions may be measured again: they do not count where firmware runs.

    Raises:
        OutputError: One does.
    """
    there = {name: path for name, path in outputs.items() if path.exists()}
    if not there:
        return
    for found in inputs:
        for name, path in there.items():
            is_measured_again = name == "costs" and found.key == "function_costs"
            if leads_to(path, found.path) and not is_measured_again:
                raise OutputError(f"--{name} would take the place of {found.path}, {found.what}; name another output")


def inputs_of(program: Path, options: Sequence[str], pogosim: Installation) -> Iterator[NamedFile]:
    """Yield the files of a run that are there, also those that it writes.

    Args:
        program: A firmware, the folder of a project, or a source file.
        options: Options of the simulator.
        pogosim: The simulator.
    """
    configuration, others = split_options(options)
    # As the simulator searches; its own folder has the template beside arenas and models.
    listed = os.environ.get(MODELS_VARIABLE, "").split(os.pathsep)
    folders = [Path(), configuration.parent, *map(Path, filter(None, listed)), pogosim.template.parent]
    seen: set[Path] = set()
    entries = any_entries_in(configuration)
    if not isinstance(entries, dict):
        entries = {}
    defaults = {key: name for key, name in OUTPUTS.items() if value_at(entries, key) is None}
    yield NamedFile(configuration, "the configuration")
    for node, of in ((entries, str(configuration)), (settings_in(others), "the command line"), (defaults, "the run")):
        for found in named_files(node, folders, of, seen):
            yield found
            yield NamedFile(Path(f"{found.path}{BESIDE}"), f"the metadata of {found.path}")
    yield from (NamedFile(Path(word), "which the command line names") for word in others if may_be_a_name(word))
    yield from sources_in(source_folders(program))


def split_options(options: Sequence[str]) -> tuple[Path, list[str]]:
    """Return the configuration that options of the simulator name, and the other words."""
    name, others, words = "", [], iter(options)
    for word in words:
        if word in ("-c", "--config"):
            name = next(words, "")
        elif word.startswith("--config="):
            name = word.partition("=")[2]
        elif word.startswith("-c"):
            name = word[2:]
        else:
            others.append(word)
    return Path(name), others


def settings_in(words: Sequence[str]) -> dict[str, object]:
    """Return what words of a command line set, as --set does, by key; what is no YAML is text."""
    values: dict[str, object] = {}
    for key, sign, text in (word.removeprefix("--set=").partition("=") for word in words):
        if sign:
            try:
                values[key] = parse_yaml(text)
            except WRONG_VALUES:
                values[key] = text
    return values


def source_folders(program: Path) -> Sequence[Path]:
    """Return the folders in which the sources of a program are."""
    if program.is_dir():
        return [program]
    return [program.parent] if program.suffix in OF_SOURCES else folders_of(program)


def sources_in(folders: Sequence[Path]) -> Iterator[NamedFile]:
    """Yield the source files and headers in some folders, and what they include from elsewhere."""
    files = (path for folder in folders for path in files_of(folder))
    waiting = [path for path in files if path.suffix in OF_SOURCES or path.name == "Makefile"]
    seen: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        yield NamedFile(path, "a source file of the program")
        waiting += (found for found in included_by(path, folders) if found.is_file())


def files_of(folder: Path) -> list[Path]:
    """Return the files in a folder; none if it cannot be looked at."""
    try:
        return [path for path in folder.iterdir() if path.is_file()]
    except OSError:
        return []


def included_by(source: Path, folders: Sequence[Path]) -> list[Path]:
    """Return the files that a source file may include."""
    try:
        names = INCLUDED.findall(source.read_text(errors="replace"))
    except OSError:
        return []
    return [folder / name for name in names for folder in (source.parent, *folders)]
