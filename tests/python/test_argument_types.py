"""Arguments of every type: scalars of NumPy, paths and tuples work, all else is one clear line."""

from __future__ import annotations

import decimal
import enum
import fractions
import functools
import itertools
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pogosim
import pytest
from pogosim.analysis.neighbourhood import degrees, nearest_distances
from pogosim.analysis.trajectories import trajectories_of
from pogosim.confidence import mean_over_runs
from pogosim.errors import PictureError
from pogosim.picture.swarm import read_recording
from pogosim.pogobatch import BatchError, PogobotBatchRunner
from pogosim.utils import load_dataframe
from running import ROOT, write_scene
from swarms import brownian_walk, metadata_of, rows_of, write_rows


class Colour(enum.Enum):
    """An enum of texts."""

    RED = "red"


class Count(enum.IntEnum):
    """An enum of integers."""

    THREE = 3


class Unshowable:
    """Its repr() fails."""

    def __repr__(self) -> str:
        raise RuntimeError


def itself() -> list[Any]:
    """A list that contains itself."""
    loop: list[Any] = []
    loop.append(loop)
    return loop


# By a name for the test; none of them is a number, a text, a path, a list, a map or None.
STRANGE: dict[str, Any] = {
    "bytes": b"abc",
    "set": {1, 2},
    "complex": 1 + 2j,
    "object": object(),
    "function": len,
    "type": int,
    "unshowable": Unshowable(),
    "generator": (number for number in (1, 2)),
    "itself": itself(),
    "date": np.datetime64("2026-01-01"),
    "deep": [[[]]] * 2 + [[0] * 3, np.zeros((2, 2), dtype=complex)],
    "decimal": decimal.Decimal("1.5"),
    "no text": "a\0b",
    "surrogate": "\ud800",
}
NOT_NUMBERS: dict[str, Any] = STRANGE | {
    "None": None,
    "text": "3",
    "path": Path("3"),
    "list": [3.0],
    "array": np.array([3.0, 4.0]),
    "map": {"a": 3},
    "bool": True,
    "bool of NumPy": np.True_,
    "huge": 10**400,
}


@pytest.fixture(autouse=True)
def _folders_of_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POGOSIM_DIR", str(ROOT))


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A configuration of three robots, a lamp, and 2 s."""
    robots = {"type": "pogobot", "nb": 3, "geometry": "disk", "radius": 26.5, "communication_radius": 80}
    lamp = {"type": "static_light", "geometry": "disk", "radius": 300, "value": 1000, "light_mode": "static"}
    arena = {"arena_file": str(ROOT / "arenas" / "disk.csv"), "save_data_period": 0.5}
    objects = {"robots": robots, "lamp": {**lamp, "x": 500, "y": 500}}
    return write_scene(tmp_path_factory.mktemp("scene"), {**arena, "objects": objects})


def refusal(call: Callable[[], object]) -> str:
    """Return the one line with which a call is refused."""
    with pytest.raises(pogosim.ConfigurationError) as caught:
        call()
    text = str(caught.value)
    assert text.isprintable(), text
    assert len(text) < 250, text
    return text


NUMBERS: dict[str, Callable[[pogosim.Simulation, Any], object]] = {
    "steps": lambda sim, value: sim.step(value),
    "until_s": lambda sim, value: sim.run(value),
    "robot": lambda sim, value: sim.set_pose(value, 500, 500),
    "x": lambda sim, value: sim.set_pose(0, value, 500),
    "y": lambda sim, value: sim.set_pose(0, 500, value),
    "x of an object": lambda sim, value: sim.objects[0].move(value, 500),
    "index of an object": lambda sim, value: sim.objects[value],
    "index of a lamp": lambda sim, value: sim.lamps[value],
    "intensity": lambda sim, value: setattr(sim.lamps[0], "intensity", value),
    "position": lambda sim, value: setattr(sim.lamps[0], "position", (value, 500)),
    "steps_of_all": lambda sim, value: sim.set_column("steps_of_all", value),
}
# What stands for something else there: the end of the run, a column of booleans.
ACCEPTED = {"steps": ("huge",), "steps_of_all": ("bool", "bool of NumPy")}
OPTIONAL: dict[str, Callable[[pogosim.Simulation, Any], object]] = {
    "seed": lambda sim, value: sim.reset(value),
    "heading": lambda sim, value: sim.set_pose(0, 500, 500, value),
    "obj": lambda sim, value: sim.set_column("steps_of_all", 1, value),
}


@pytest.mark.parametrize("name", [*NUMBERS, *OPTIONAL])
def test_what_is_no_number_is_refused_by_name(name: str, sim: pogosim.Simulation) -> None:
    for kind, value in NOT_NUMBERS.items():
        if kind in ACCEPTED.get(name, ()) or (name in OPTIONAL and value is None):
            continue
        if kind == "huge" and name.startswith("index"):
            with pytest.raises(IndexError):
                sim.objects[value]
            continue
        text = refusal(lambda value=value: (NUMBERS | OPTIONAL)[name](sim, value))  # type: ignore[misc]
        assert text.startswith((name.partition(" of an object")[0], "index of a", "there is no", "seed: expected")), (
            kind
        )
        assert sim.step(1) == 1


@pytest.mark.parametrize(
    "number",
    [np.int8(1), np.uint64(1), np.int64(1), np.array(1), Count.THREE, 1],
    ids=lambda value: type(value).__name__,
)
def test_integers_of_all_types_are_integers(number: Any, sim: Any, scene: Path) -> None:
    assert sim.step(number) == number
    sim.reset(number)
    assert sim.seed == number
    with pogosim.Simulation(sim.program, scene, seed=number, set={"objects.robots.nb": number}) as other:
        assert (other.seed, len(other.positions)) == (number, number)
    sim.set_column("steps_of_all", number, None)
    sim.objects[np.int64(1)].move(np.float32(500.0), np.int16(520), np.float64(0.5))
    assert sim.objects[1].position == (500.0, 520.0)


@pytest.mark.parametrize(
    "number", [np.float16(0.5), np.float32(0.5), np.array(0.5), fractions.Fraction(1, 2), 0.5], ids=lambda v: repr(v)
)
def test_real_numbers_of_all_types_are_numbers(number: Any, sim: Any) -> None:
    assert sim.run(number) == 50
    sim.set_pose(np.int64(0), np.float32(500), np.float64(500), number)
    assert sim.headings[0] == 0.5
    sim.lamps[0].intensity = number
    sim.lamps[0].position = np.array([400.0, 450.0])
    assert (sim.lamps[0].intensity, sim.lamps[0].position) == (0.5, (400.0, 450.0))
    sim.parameters["gain"] = number if not isinstance(number, fractions.Fraction) else float(number)
    assert dict(sim.parameters) == {"gain": 0.5}


def test_values_that_yaml_does_not_have_are_refused_with_their_key(sim: pogosim.Simulation) -> None:
    for kind, value in STRANGE.items():
        key = value if kind not in ("set", "itself", "deep") else Unshowable()  # those cannot be keys
        for name, settings in (
            ("parameters.gain", {"parameters.gain": value}),
            ("objects.robots.nb", {"objects": {"robots": {"nb": value}}}),
            ("parameters.table[1]", {"parameters.table": [1.0, value]}),
            ("a key of parameters", {"parameters": {key: 1}}),
        ):
            text = refusal(lambda settings=settings: like(sim, set=settings))  # type: ignore[misc]
            assert text.startswith(name) or ": maps and lists are nested too deeply" in text, text
        text = refusal(lambda value=value: sim.parameters.update(gain=value))  # type: ignore[misc]
        assert text.startswith("parameters.gain"), text
    assert dict(sim.parameters) == {}


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ((1.0, 2.0), [1.0, 2.0]),
        (np.array([1.0, 2.0], dtype=np.float32), [1.0, 2.0]),
        (pd.Series([1.0, 2.0]), [1.0, 2.0]),
        (range(1, 3), [1, 2]),
        ([np.int8(1), np.array(2)], [1, 2]),
        ([Count.THREE, 1], [3, 1]),
    ],
    ids=str,
)
def test_lists_of_all_types_are_lists(value: Any, expected: list[float], sim: pogosim.Simulation) -> None:
    sim.parameters["table"] = value
    assert dict(sim.parameters) == {"table": expected}
    sim.run(0.5)
    assert sim.to_dataframe()["table_1"].iloc[-1] == expected[1]


def test_paths_and_enums_are_texts(hosted: Path, scene: Path, tmp_path: Path) -> None:
    settings = {"parameters.name": Colour.RED, "arena_file": ROOT / "arenas" / "square.csv"}
    with pogosim.Simulation(str(hosted), str(scene), set=settings, data_file=str(tmp_path / "röws.feather")) as sim:
        assert dict(sim.parameters) == {"name": "red"}
        sim.save_data(str(tmp_path / "copy.feather"))
    assert (tmp_path / "copy.feather").read_bytes() == (tmp_path / "röws.feather").read_bytes()


@pytest.mark.parametrize("name", ["program", "configuration", "file", "data_file"])
def test_what_is_no_path_is_refused(name: str, sim: pogosim.Simulation, scene: Path) -> None:
    calls: dict[str, Callable[[Any], object]] = {
        "program": lambda value: pogosim.Simulation(value, scene),
        "configuration": lambda value: pogosim.Simulation(sim.program, value),
        "file": lambda value: sim.save_data(value),
        "data_file": lambda value: pogosim.Simulation(sim.program, scene, data_file=value),
    }
    for kind, value in {**NOT_NUMBERS, "empty": ""}.items():
        if kind in ("text", "path", "surrogate") or (name in ("program", "data_file") and value is None):
            continue
        text = refusal(lambda value=value: calls[name](value))  # type: ignore[misc]
        assert text.startswith(f"{name}: expected the path of a file"), kind


def like(sim: Any, **options: Any) -> pogosim.Simulation:
    """Begin another run like this one, with options."""
    return pogosim.Simulation(sim.program, sim.configuration, **options)


def many_like(sim: Any, seeds: Any, **options: Any) -> pogosim.VectorSimulation:
    """Begin runs like this one."""
    return pogosim.VectorSimulation(sim.program, sim.configuration, seeds, **options)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda sim: like(sim, set=[1]), "set: expected a map"),
        (lambda sim: like(sim, set="a=1"), "set: expected a map"),
        (lambda sim: like(sim, set={"a=b": 1}), "a key of set: expected"),
        (lambda sim: like(sim, set={1: 1}), "a key of set: expected text"),
        (lambda sim: like(sim, strict="no"), "strict: expected True or False"),
        (lambda sim: like(sim, seed=True), "seed: expected an integer from 0"),
        (lambda sim: like(sim, seed=3.0), "seed: expected an integer from 0"),
        (lambda sim: many_like(sim, 3), "seeds: expected a list"),
        (lambda sim: many_like(sim, "ab"), "seed: expected an integer"),
        (lambda sim: many_like(sim, [1], threads=0), "threads: expected an"),
        (
            lambda sim: many_like(sim, [1], threads="x"),
            "threads: expected an",
        ),
        (lambda sim: setattr(sim.lamps[0], "is_on", 1), "is_on: expected True or False, found 1"),
        (lambda sim: setattr(sim.lamps[0], "position", 5), "position: expected 2 numbers, found 5"),
        (lambda sim: setattr(sim.lamps[0], "position", (1, 2, 3)), "position: expected 2 numbers"),
        (lambda sim: setattr(sim.lamps[0], "intensity", math.nan), "intensity: expected a finite number"),
        (lambda sim: sim.set_column(5, 1), "name: expected text, found 5"),
        (lambda sim: sim.parameters.update({5: 1}), "a parameter: expected text, found 5"),
        (lambda sim: sim.objects.of(5), "no objects have the category 5"),
        (lambda sim: sim.set_column("steps_of_all", 1, -1), "there is no object -1: the run has 3"),
    ],
)
def test_wrong_arguments_are_refused(call: Callable[[Any], object], message: str, sim: pogosim.Simulation) -> None:
    assert refusal(lambda: call(sim)).startswith(message)


def test_vector_of_runs_takes_seeds_of_numpy(hosted: Path, scene: Path) -> None:
    vector: Any = pogosim.VectorSimulation
    with vector(hosted, scene, seeds=np.arange(2), threads=np.int64(2)) as runs:
        runs.step(np.int64(3))
        runs.reset(np.array([5, 6]))
        assert [run.seed for run in runs] == [5, 6]
        assert runs[np.int64(-1)].seed == 6
        with pytest.raises(IndexError, match="there is no run 2: the run has 2"):
            runs[2]
        with pytest.raises(pogosim.ConfigurationError, match="function: expected a function"):
            runs.each(3)


def run_in_a_file(folder: Path) -> Path:
    """A data file of four robots."""
    return write_rows(folder / "rows.feather", rows_of(500.0 + brownian_walk(3, 4, 5.0)), metadata_of())


NO_PATHS = {kind: value for kind, value in NOT_NUMBERS.items() if kind not in ("text", "path", "generator")}


def test_what_is_no_data_file_is_refused(tmp_path: Path) -> None:
    file = run_in_a_file(tmp_path)
    for kind, value in NO_PATHS.items():
        with pytest.raises(ValueError, match=r"^path(\[\d\])?: expected the path of a file"):
            load_dataframe(value if kind != "map" else [value])
        with pytest.raises(ValueError, match=r"^path\[1\]: expected the path of a file"):
            load_dataframe([file, value])
    for files in ((file, str(file)), np.array([str(file)]), {file}, (name for name in [file])):
        assert len(load_dataframe(files)[0]) in (12, 24)  # type: ignore[arg-type]


FUNCTIONS: dict[str, Callable[[Path, Any], object]] = {
    "rows": lambda _, value: trajectories_of(value),
    "reach_mm": lambda file, value: degrees(trajectories_of(load_dataframe(file)[0])[0], value),
    "count": lambda file, value: nearest_distances(trajectories_of(load_dataframe(file)[0])[0], value),
    "level": lambda _, value: mean_over_runs(pd.DataFrame({"a": [1.0]}), value),
    "run": lambda file, value: read_recording(file, run=value),
    "combination": lambda file, value: read_recording(file, combination=value),
    "multi_config_file": lambda _, value: PogobotBatchRunner(value, 1, "p", "tmp", "out"),
    "simulator_binary": lambda _, value: PogobotBatchRunner("c.yaml", 1, value, "tmp", "out"),
    "--runs": lambda _, value: PogobotBatchRunner("c.yaml", value, "p", "tmp", "out"),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_of_the_package_refuse_by_name(name: str, tmp_path: Path) -> None:
    file = run_in_a_file(tmp_path)
    for kind, value in NOT_NUMBERS.items():
        is_path = name in ("multi_config_file", "simulator_binary") and kind in ("text", "path")
        is_large = name in ("run", "combination", "count", "--runs") and kind == "huge"
        if is_path or is_large or (value is None and name in ("reach_mm", "run", "combination")):
            continue
        with pytest.raises((ValueError, PictureError, BatchError)) as caught:
            FUNCTIONS[name](file, value)
        text = str(caught.value)
        assert text.startswith(f"{name}: expected"), (kind, text)
        assert text.isprintable() and len(text) < 250


NO_NAMES: dict[str, Any] = {
    "array": np.arange(3),
    "array of objects": np.array([None, 1], dtype=object),
    "Series": pd.Series([1, 2]),
    "DataFrame": pd.DataFrame({"a": [1]}),
    "NA": pd.NA,
    "list": ["age"],
    "None": None,
    "two lines": "a\nb",
    "long": "x" * 100_000,
    "bytes": b"x" * 100_000,
    "large integer": 10**5000,
}


@pytest.mark.parametrize("kind", NO_NAMES)
def test_what_is_no_name_of_a_column_category_or_parameter_is_told_in_a_short_line(
    kind: str, sim: pogosim.Simulation
) -> None:
    value = NO_NAMES[kind]
    calls: list[Callable[[], object]] = [
        lambda: sim.columns[value],
        lambda: sim.parameters[value],
        lambda: sim.objects.of(value),
    ]
    with many_like(sim, [1, 2]) as runs:
        calls.append(lambda: runs.column(value))
        for call in calls:
            with pytest.raises((KeyError, pogosim.ConfigurationError)) as caught:
                call()
            text = caught.value.args[0]
            assert text.isprintable()
            assert len(text) < 500
    assert value not in sim.columns
    assert value not in sim.objects
    assert value not in sim.lamps


@pytest.mark.parametrize("name", [".", "..", "/", Path(), "two\nlines", "x" * 100_000, "x" * 300])
def test_name_that_no_file_can_have_is_refused_in_a_line(name: str | Path, sim: pogosim.Simulation) -> None:
    calls: list[Callable[[], object]] = [
        lambda: pogosim.Simulation(name, sim.configuration),
        lambda: pogosim.Simulation(sim.program, name),
        lambda: like(sim, set={"arena_file": str(name)}),
    ]
    if len(str(name)) > 255:
        calls += [lambda: like(sim, data_file=name), lambda: sim.save_data(name)]
    for call in calls:
        with pytest.raises(pogosim.ConfigurationError) as caught:
            call()
        assert str(caught.value).isprintable()
        assert len(str(caught.value)) < 11_000


def test_more_values_than_a_configuration_can_have_are_refused_at_once(sim: pogosim.Simulation) -> None:
    doubled: list[Any] = [1]
    for _ in range(60):
        doubled = [doubled, doubled]
    values: list[Any] = [range(10**12), np.broadcast_to(0, 10**12), doubled, [range(10**5)] * 20]
    for value in values:
        settings = {"parameters.z": value}
        assert "expected 1000000 values at most" in refusal(functools.partial(like, sim, set=settings))
    assert "at most 1024 bits" in refusal(lambda: like(sim, set={"parameters.z": 10**5000}))
    assert "seeds: expected 100000 runs at most" in refusal(lambda: many_like(sim, itertools.count()))
    assert "steps: expected an integer" in refusal(lambda: sim.step(np.broadcast_to(0, 10**12)))  # type: ignore[arg-type]
