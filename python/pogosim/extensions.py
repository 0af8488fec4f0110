"""Tables of what has a name: Pogosim's own, and what other packages add by entry points (docs/extending.md).

What is in a table is imported when it is asked for. Other packages are looked for only then, too, or when all names are
listed, since reading what all installed packages offer takes longer than many commands.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from importlib.machinery import PathFinder
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

from pogosim.errors import ToolError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint
    from pathlib import Path  # takes a while, and few commands need it here

MODELS_VARIABLE = "POGOSIM_PATH"  # folders that the simulator searches for models of robots
MODELS = ("*.yaml", "*.yml")
METADATA_OF_PACKAGES = (".dist-info", "egg-info", ".egg")  # ends of names

Warn = Callable[[str], None]


class ExtensionError(ToolError):
    """What was asked for cannot be had; says of which package it is, and what to do."""


class PackageFailedError(ToolError):
    """Code of another package has failed; says which package, how, and where."""

    exit_code = 3  # as of a run whose program has failed


class Own(NamedTuple):
    """An entry of this package.

    Attributes:
        place: Where it is, "module:name", as entry points say it.
        summary: What it is for, a line of the list; empty: that of the entry itself, which is then imported for it.
    """

    place: str
    summary: str = ""


class Table(NamedTuple):
    """What can be asked for by name.

    Attributes:
        group: Group of the entry points of other packages.
        kind: What one of its entries is called, such as "optimizer".
        expected: What an entry point must name.
        fits: Tells whether something is that.
        own: Entries of this package, by name.
        is_shared: True: a name of this package is looked up in others, too, which takes a while, and one that they have
            is an error. False: this package's entry is taken, and listing all names warns of others.
    """

    group: str
    kind: str
    expected: str
    fits: Callable[[Any], bool]
    own: Mapping[str, Own]
    is_shared: bool = True

    def find(self, name: str) -> Own | EntryPoint | None:
        """Return where an entry is, without importing it; None: there is none of that name.

        Raises:
            ExtensionError: Several packages have the name.
        """
        own = self.own.get(name)
        if own is not None and not self.is_shared:
            return own
        points = self.others().get(name, [])
        if len(points) + (own is not None) > 1:
            raise ExtensionError(self.taken(name, points))
        return own or (points[0] if points else None)

    def load(self, name: str) -> Any:
        """Return an entry.

        Raises:
            KeyError: There is none of that name.
            ExtensionError: It is of no use, or several packages have the name.
        """
        found = self.find(name)
        if found is None:
            raise KeyError(name)
        return located(found.place) if isinstance(found, Own) else self.loaded(found)

    def names(self) -> list[str]:
        """Return all names: own ones first, then those of other packages, sorted."""
        return [*self.own, *sorted(set(self.others()) - set(self.own))]

    def listed(self, warn: Warn) -> dict[str, str]:
        """Return what each entry is for, by name; warns of those that are of no use, and leaves them out."""
        found = {name: own.summary or summary_of(located(own.place)) for name, own in self.own.items()}
        return found | {name: summary_of(entry) for name, entry in self.loaded_others(warn).items()}

    def loaded_others(self, warn: Warn) -> dict[str, Any]:
        """Return the entries of other packages, by name; warns of those that are of no use, and leaves them out."""
        found = {}
        try:
            others = self.others()
        except ExtensionError as error:
            warn(str(error))
            others = {}
        for name, points in sorted(others.items()):
            try:
                if len(points) + (name in self.own) > 1:
                    raise ExtensionError(self.taken(name, points))
                found[name] = self.loaded(points[0])
            except ExtensionError as error:
                warn(str(error))
        return found

    def others(self) -> dict[str, list[EntryPoint]]:
        """Return the entry points of other packages, by name.

        Raises:
            ExtensionError: What is installed cannot be read.
        """
        return entry_points_of(self.group)

    def loaded(self, point: EntryPoint) -> Any:
        """Import what an entry point names.

        Raises:
            ExtensionError: It cannot be imported, or is something else.
        """
        try:
            found = located(point.value)
        except (Exception, SystemExit) as error:  # whatever a module does when it is imported
            raise ExtensionError(
                f"{self.of(point)} cannot be imported: {said(error)}; update or uninstall the package"
            ) from None
        if not self.fits(found):
            raise ExtensionError(
                f"{self.of(point)}: expected {self.expected}, found {described(found)}; update or uninstall the package"
            )
        return found

    @contextlib.contextmanager
    def calling(self, name: str, may_exit: bool = False) -> Iterator[None]:
        """Call what an entry names. What code of another package raises becomes an error that says whose it is.

        Errors that are meant for users pass: ToolError, and those of the system.

        Args:
            name: That of the entry.
            may_exit: SystemExit passes, too.

        Raises:
            PackageFailedError: Something else was raised.
        """
        try:
            yield
        except (ToolError, OSError):
            raise
        except (Exception, SystemExit) as error:  # whatever a package does
            point = self.find(name)
            if point is None or isinstance(point, Own) or (may_exit and isinstance(error, SystemExit)):
                raise
            if sys.flags.dev_mode:
                import traceback  # takes a while

                traceback.print_exception(error)
            told = f"{self.of(point)} {raised(error, point)}; PYTHONDEVMODE=1 shows the traceback"
            raise PackageFailedError(told) from None

    def of(self, point: EntryPoint) -> str:
        """Return how messages call an entry of another package."""
        return f"{self.kind} '{point.name}' of the package {package_of(point)} ({self.group}: {point.value})"

    def taken(self, name: str, points: list[EntryPoint]) -> str:
        """Return what is said of a name that several packages have."""
        packages = " and ".join([*(["Pogosim"] if name in self.own else []), *map(package_of, points)])
        values = ", ".join(point.value for point in points)
        return (
            f"{self.kind} '{name}': {packages} all have one of this name ({self.group}: {values}); expected one: "
            "uninstall a package, or rename its entry point"
        )


def may_be_offered(group: str) -> bool:
    """Tell whether an installed package may have entry points of a group; False: none has, or could.

    For most groups, reading a few files tells it, in a tenth of the time that importlib.metadata takes to be imported
    and to search.
    """
    from pathlib import Path

    if any(hasattr(finder, "find_distributions") for finder in sys.meta_path if finder is not PathFinder):
        return True  # a way of installing packages that only importlib.metadata knows
    return any(may_be_offered_in(Path(folder), f"[{group}]".encode()) for folder in sys.path)


def may_be_offered_in(folder: Path, named: bytes) -> bool:
    """Tell the same of the packages in a folder. `named`: the head of a section, without blanks."""
    try:
        places = [place for place in folder.iterdir() if place.name.lower().endswith(METADATA_OF_PACKAGES)]
    except FileNotFoundError:
        return False
    except OSError:  # an archive, say
        return True
    for place in places:
        try:
            if named in b"".join((place / "entry_points.txt").read_bytes().split()):
                return True
        except (FileNotFoundError, NotADirectoryError):
            if place.suffix == ".egg":
                return True
        except OSError:
            return True
    return False


@functools.cache
def entry_points_of(group: str) -> dict[str, list[EntryPoint]]:
    """Return the entry points of a group, by name.

    Raises:
        ExtensionError: What is installed cannot be read.
    """
    if not may_be_offered(group):
        return {}
    from importlib.metadata import entry_points  # takes a while

    found: dict[str, list[EntryPoint]] = {}
    try:
        for point in entry_points(group=group):
            found.setdefault(point.name, []).append(point)
    except Exception as error:  # of a package whose metadata are damaged
        raise ExtensionError(
            f"the entry points {group} of installed packages cannot be read: {said(error)}; pip check may name the "
            "package to install again"
        ) from None
    return found


def located(place: str) -> Any:
    """Return what an entry point names: "module", or "module:name"."""
    module, colon, name = place.partition(":")
    found = importlib.import_module(module.strip())
    for part in name.strip().split(".") if colon else ():
        found = getattr(found, part)
    return found


def package_of(point: EntryPoint) -> str:
    """Return the name and the version of the package that an entry point is of."""
    package = point.dist
    return f"{package.metadata['Name']} {package.version}" if package is not None else "without a name"


def said(error: BaseException) -> str:
    """Return an exception in a line."""
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__


def raised(error: BaseException, point: EntryPoint) -> str:
    """Return what a package did, with the last line of its own: "raised KeyError: 'age' (/home/me/lab/count.py:12)"."""
    import traceback  # takes a while

    package = point.value.partition(":")[0].strip().partition(".")[0]
    places = [
        f" ({frame.f_code.co_filename}:{line})"
        for frame, line in traceback.walk_tb(error.__traceback__)
        if str(frame.f_globals.get("__name__")).partition(".")[0] == package
    ]
    name = type(error).__name__
    return f"raised {name if said(error) == name else f'{name}: {said(error)}'}{places[-1] if places else ''}"


def described(found: Any) -> str:
    """Return what something is, for messages."""
    if isinstance(found, ModuleType):
        return f"the module {found.__name__}"
    name = getattr(found, "__qualname__", None)
    return f"{name}, a value of type {type(found).__name__}" if name else f"a value of type {type(found).__name__}"


def summary_of(entry: Any) -> str:
    """Return what an entry is for: its `summary`, or the first line of its docstring, as a list has it."""
    summary = getattr(entry, "summary", None)
    if summary is not None:
        return str(summary)
    line = str(entry.__doc__ or "").strip().partition("\n")[0].removesuffix(".")
    return line[:1].lower() + line[1:]


def takes(function: Any, *arguments: Any) -> bool:
    """Tell whether something can be called with this number of arguments."""
    import inspect  # takes a while

    try:
        inspect.signature(function).bind(*arguments)
    except (TypeError, ValueError):
        return False
    return callable(function)


# ---- Models of robots: folders of YAML files ----


def folders_of(entry: Any) -> list[Path]:
    """Return the folders with models that an entry names."""
    from pathlib import Path

    if isinstance(entry, ModuleType):
        own = [str(Path(entry.__file__).parent)] if entry.__file__ else []
        places = list(getattr(entry, "__path__", own))
    elif isinstance(entry, (str, os.PathLike)):
        places = [os.fspath(entry)]
    else:
        places = []
    return [folder for folder in dict.fromkeys(map(Path, places)) if has_models(folder)]


def has_models(folder: Path) -> bool:
    """Tell whether there is a YAML file in a folder that a path of folders can name."""
    return os.pathsep not in str(folder) and any(any(folder.glob(pattern)) for pattern in MODELS)


ROBOT_MODELS = Table(
    "pogosim.robot_models",
    "robot models",
    "a package, or the path of a folder, with YAML files in it",
    lambda entry: bool(folders_of(entry)),
    {},
)


def model_folders(warn: Warn) -> list[Path]:
    """Return the folders of models of installed packages; warns of those that are of no use.

    A file hides those of the same name in folders after its own, which is warned of, too.
    """
    found = [(name, folder) for name, entry in ROBOT_MODELS.loaded_others(warn).items() for folder in folders_of(entry)]
    first: dict[str, str] = {}
    for name, folder in found:
        for file in sorted(path.name for pattern in MODELS for path in folder.glob(pattern)):
            if first.setdefault(file, name) != name:
                warn(f"robot models '{name}': {folder / file} is hidden by the file of this name in '{first[file]}'")
    return [folder.absolute() for _, folder in found]


def models_path(warn: Warn) -> str:
    """Return where the simulator looks for models: folders of POGOSIM_PATH, then those of installed packages."""
    known = [folder for folder in os.environ.get(MODELS_VARIABLE, "").split(os.pathsep) if folder]
    return os.pathsep.join(dict.fromkeys([*known, *map(str, model_folders(warn))]))


def let_find_models(warn: Warn) -> None:
    """Let simulators of this process, and programs that take its place, find the models of installed packages."""
    if path := models_path(warn):
        os.environ[MODELS_VARIABLE] = path
