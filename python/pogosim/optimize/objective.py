"""What a search maximises, and the features by which quality-diversity searches tell solutions apart."""

from __future__ import annotations

import importlib.util
import logging
import math
import os
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pandas as pd

from pogosim.analysis.displacement import compute_msd_per_agent
from pogosim.batch.errors import one_line
from pogosim.batch.runs.identity import file_digest
from pogosim.errors import OptimizeError
from pogosim.optimize.settings import OBJECTIVE_NAMES

FEATURES_NAME = "fd_fn"
LARGEST = 1e150  # of a fitness and of features: what is computed from their squares is finite

# What a user's file need not import: the article's listing does not.
READY = {"compute_msd_per_agent": compute_msd_per_agent, "np": np, "pd": pd}

log = logging.getLogger("pogosim.optimize")


@dataclass(frozen=True)
class Judgement:
    """What is said of the runs of a candidate.

    Attributes:
        fitness: The objective, to be maximised; None: the candidate has failed.
        features: Its features, by name; empty if there are none.
        problem: Why it has failed, or empty.
        seeds: Seeds that its runs have had in the end; empty: it is not known.
        replacement: The greatest number of a replacement of a seed among its runs; 0: all have their own.
    """

    fitness: float | None
    features: Mapping[str, float]
    problem: str = ""
    seeds: tuple[int, ...] = ()
    replacement: int = 0

    def within(self, domain: Sequence[tuple[float, float]]) -> Judgement:
        """Return what is said of a candidate if features outside a domain are a failure; one that is empty has none."""
        for (name, value), (low, high) in zip(self.features.items(), domain, strict=False):
            if self.fitness is not None and not low <= value <= high:
                problem = f"{name} is {value:.6g}, outside its domain from {low:g} to {high:g}"
                return replace(self, fitness=None, problem=problem)
        return self


class WrongValueError(ValueError):
    """A function of the user returned something else than expected."""


def objective_fn(df: pd.DataFrame) -> float:
    """Return the mean over robots, runs and arenas of the mean squared displacement in mm^2; -inf without any."""
    displacement = compute_msd_per_agent(df)
    return float(displacement["MSD"].mean()) if len(displacement) else -math.inf


def fd_fn(df: pd.DataFrame) -> dict[str, float]:
    """Return the greatest mean squared displacement of a robot, and its standard deviation over robots, in mm^2."""
    displacement = compute_msd_per_agent(df)["MSD"].to_numpy(dtype=float)
    if not len(displacement):
        return {"max MSD (mm^2)": 0.0, "std MSD (mm^2)": 0.0}
    return {"max MSD (mm^2)": float(np.max(displacement)), "std MSD (mm^2)": float(np.std(displacement))}


@dataclass(frozen=True)
class Objective:
    """The functions that judge runs.

    Attributes:
        fitness: From the rows of all runs to a number, or to a number and the features.
        features: From the rows to the features; None if there is no such function.
        path: The file they are in; None: those above.
        name: Name of the first one there.
        others: Names of functions there that would be taken if it were not.
        modules: Files beside it, or in folders there, that it has imported.
    """

    fitness: Callable[[pd.DataFrame], Any] = objective_fn
    features: Callable[[pd.DataFrame], Any] | None = fd_fn
    path: Path | None = None
    name: str = "objective_fn"
    others: tuple[str, ...] = ()
    modules: tuple[Path, ...] = ()

    @property
    def digests(self) -> dict[str, str]:
        """Digests of the file, or of there being none, and of what it has imported."""
        if self.path is None:
            return {"objective": "default"}
        folder = self.path.absolute().parent
        modules = {f"objective's module {file.relative_to(folder)}": file_digest(file) for file in self.modules}
        return {"objective": file_digest(self.path), **modules}

    def judge(self, rows: pd.DataFrame, with_features: bool = False) -> Judgement:
        """Return what the functions say of rows, as of `pogosim.utils.load_dataframe` for a batch.

        Args:
            rows: Rows of all runs of a candidate.
            with_features: Also compute the features.
        """
        name = "the objective"
        here = Path.cwd()
        try:
            returned = self.fitness(rows)
            fitness, features = split(returned)
            if with_features:
                if self.features is not None:
                    name = "the feature function"
                    features = self.features(rows)
                if features is None:
                    raise WrongValueError(
                        f"returned no features; write {FEATURES_NAME}(df), or return (fitness, features)"
                    )
                named = names_of(features)
            else:
                named = {}
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # whatever a user's function raises, it is this candidate that has failed
            return Judgement(None, {}, f"{name} {self.blamed(error)}")
        finally:
            os.chdir(here)  # a relative path is where it was, whatever the function did
        if not abs(fitness) <= LARGEST:
            return Judgement(None, {}, f"the objective returned {fitness}")
        return Judgement(fitness, named)

    def blamed(self, error: BaseException) -> str:
        """Return what a function did: "raised KeyError: 'age' (obj.py:12)"."""
        if isinstance(error, WrongValueError):
            return str(error)
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if self.is_here(frame.filename)]
        place = f" ({self.path}:{lines[-1]})" if lines else ""
        text = one_line(error).encode(errors="backslashreplace").decode()
        return f"raised {type(error).__name__}{f': {text}' if text else ''}{place}"

    def is_here(self, file: str) -> bool:
        """Tell whether a file is that of the functions."""
        return self.path is not None and Path(file) == self.path.absolute()


def split(returned: Any) -> tuple[float, Any]:
    """Return the fitness and the features that an objective returned; no features: None."""
    fitness, features = returned if isinstance(returned, tuple) and len(returned) == 2 else (returned, None)
    return number_in(fitness), features


def number_in(value: Any) -> float:
    """Return a number of a function of the user."""
    if isinstance(value, (str, bytes)) or value is None:
        raise WrongValueError(f"returned {type(value).__name__}, not a number")
    try:
        return float(value)
    except (TypeError, ValueError):
        raise WrongValueError(f"returned {type(value).__name__}, not a number") from None


def names_of(features: Any) -> dict[str, float]:
    """Return features by name: those of a dictionary, or "feature 1", "feature 2", ..."""
    if not isinstance(features, Mapping):
        try:
            values = np.atleast_1d(np.asarray(features, dtype=float)).ravel().tolist()
        except (TypeError, ValueError):
            raise WrongValueError(f"returned {type(features).__name__}, not a list of numbers") from None
        features = {f"feature {i + 1}": value for i, value in enumerate(values)}
    named = {str(name): number_in(value) for name, value in features.items()}
    if not named:
        raise WrongValueError("returned no features")
    if wrong := [name for name, value in named.items() if not abs(value) <= LARGEST]:
        raise WrongValueError(f"returned {named[wrong[0]]} for {wrong[0]}")
    return named


def load_objective(
    path: str, objective_name: str | None, features_name: str | None, usual: Sequence[str] = OBJECTIVE_NAMES
) -> Objective:
    """Return the functions in a user's file.

    Args:
        path: A Python file.
        objective_name: Name of the objective; None: the first of `usual` that there is.
        features_name: Name of the feature function; None: `fd_fn`, if there is one.
        usual: Names of objectives.

    Raises:
        OptimizeError: There is no such file or function, or it cannot be imported.
    """
    before = set(sys.modules)
    module = imported(Path(path))
    modules = own_modules(Path(path), set(sys.modules) - before)
    names = usual if objective_name is None else (objective_name,)
    found = [name for name in names if callable(getattr(module, name, None))]
    if not found:
        raise OptimizeError(
            f"--objective: {path} has no function {' or '.join(names)}; write 'def {names[0]}(df): ...', which returns "
            "a number, or give the name of yours with --objective-func"
        )
    features = getattr(module, features_name or FEATURES_NAME, None)
    if features_name is not None and not callable(features):
        raise OptimizeError(f"--features-func: {path} has no function {features_name}")
    name, *others = found
    own_features = features if callable(features) else None
    return Objective(getattr(module, name), own_features, Path(path), name, tuple(others), modules)


def own_modules(path: Path, names: set[str]) -> tuple[Path, ...]:
    """Return the files of those modules that are the user's: in the folder of a file, and of no installed package."""
    files = {Path(getattr(sys.modules[name], "__file__", None) or "/") for name in names if name != module_name(path)}
    folder = path.absolute().parent
    below = {file: file.relative_to(folder).parts for file in files if file.is_relative_to(folder)}
    return tuple(sorted(file for file, parts in below.items() if not {"site-packages", "pogosim"} & set(parts)))


def module_name(path: Path) -> str:
    """Return the name under which the file of the objective is imported."""
    return f"pogoptim_objective_{path.stem}"


def imported(path: Path) -> ModuleType:
    """Import a Python file, with READY and `logger` in it; other modules beside it can be imported from there.

    Raises:
        OptimizeError: It is not there, or raises something.
    """
    if not path.is_file():
        what = "is a folder" if path.is_dir() else "does not exist"
        raise OptimizeError(f"--objective: {path} {what}; expected a Python file with a function objective_fn(df)")
    specification = importlib.util.spec_from_file_location(module_name(path), path.absolute())
    if specification is None or specification.loader is None:
        raise OptimizeError(f"--objective: {path} is not a Python file: its name does not end with .py")
    module = importlib.util.module_from_spec(specification)
    vars(module).update(READY, logger=log)
    sys.modules[module.__name__] = module  # dataclasses look for their module there
    here = Path.cwd()
    sys.path.insert(0, str(path.absolute().parent))
    try:
        specification.loader.exec_module(module)
    except SyntaxError as error:
        where = f":{error.lineno}" if error.lineno and error.filename == str(path.absolute()) else ""
        raise OptimizeError(f"--objective: {path}{where}: {one_line(error.msg)}") from None
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        blame = Objective(path=path).blamed(error)
        raise OptimizeError(f"--objective: {path} cannot be imported: it {blame}") from None
    finally:
        os.chdir(here)
    return module
