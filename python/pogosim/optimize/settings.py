"""How to search: from the command line, from the section `optimization` of the configuration, or by default."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from pogosim.batch.configurations.option_words import shown
from pogosim.errors import OptimizeError
from pogosim.nearest_name import advice, nearest_name
from pogosim.yaml_1_2 import plain

SECTION = "optimization"
OBJECTIVE = "objective"
STREAM = 0x504F474F  # which random numbers the first seed of blocks is drawn from
COMMON = "common"
FRESH = "fresh"
BLOCKS = "blocks"
POLICIES = (COMMON, FRESH, BLOCKS)
LAST_SEED = 2**32 - 1

# The names that are tried for the function of an objective, in this order: those of a file, and those of a map
# {path, func} without `func`.
OBJECTIVE_NAMES = ("objective_fn", "compute_objective")
NAMES_OF_MAP = ("compute_objective", "objective_fn")


@dataclass(frozen=True)
class Settings:
    """How to search.

    Attributes:
        optimizer: Name of the optimiser.
        max_evals: Evaluations, at least 1.
        runs: Runs of each candidate, per combination of the options that remain.
        seed: Seed of the optimiser, 0 to 2^32-1.
        seeds: "common": all candidates have the runs 0, 1, ... with these seeds. "fresh": each has its own. "blocks":
            each has a block of its own, with room for replacements; where they begin, the seed of the optimiser says.
        retry_new_seed: Repeat a failed run with another seed; otherwise, with the same one.
        final_runs: Runs of the best candidate at the end, with seeds that the search has not seen; 0: none.
        sigma0: Standard deviation with which CMA-ES starts, in the unit cube.
        popsize: Candidates per generation; None: as usual for the optimiser.
        qd_shape: Cells of the archive along each feature.
        qd_ranges: Least and greatest value of each feature; empty: see `feature_ranges`.
        qd_features_domain: The same, and a candidate with features outside has failed; empty: none.
        qd_init_samples: Random candidates at the beginning.
        qd_batch: Candidates per generation afterwards.
        qd_mut_pb: Probability that a mutation changes a variable.
        qd_eta: Crowding degree of polynomial mutation.
        retries: How many times a failed run is repeated.
        backend: See `pogosim.batch.workers.backends.Workers`.
        output_dir: Folder of the results.
        temp_base: Folder for files of single runs.
        keep_temp: Keep them.
        candidate_jobs: Candidates that are evaluated at the same time, if `batch_jobs` is not 0.
        batch_jobs: Runs of each at the same time; 0: one run per processor in all.
        objective: File with the objective; empty: the default one.
        objective_func: Name of the objective; None: the first of `objective_names` that there is.
        objective_names: See there.
        features_func: Name of the feature function; None: the usual one.
        own: What the configuration says under the name of the optimiser, for those of other packages.
        places: Where settings stand that the configuration says, by name; see `place_of`.
    """

    optimizer: str = "cmaes"
    max_evals: int = 50
    runs: int = 1
    seed: int = 42
    seeds: str = COMMON
    retry_new_seed: bool = False
    final_runs: int = 10
    sigma0: float = 0.3
    popsize: int | None = None
    qd_shape: tuple[int, ...] = (48, 48)
    qd_ranges: tuple[tuple[float, float], ...] = ()
    qd_features_domain: tuple[tuple[float, float], ...] = ()
    qd_init_samples: int = 64
    qd_batch: int = 32
    qd_mut_pb: float = 0.2
    qd_eta: float = 20.0
    retries: int = 5
    backend: str = "multiprocessing"
    output_dir: str = "opt_out"
    temp_base: str = "tmp_opt"
    keep_temp: bool = False
    candidate_jobs: int = 1
    batch_jobs: int = 0
    objective: str = ""
    objective_func: str | None = None
    objective_names: tuple[str, ...] = OBJECTIVE_NAMES
    features_func: str | None = None
    own: Mapping[str, Any] = field(default_factory=dict)
    places: Mapping[str, str] = field(default_factory=dict, compare=False)

    def place_of(self, name: str) -> str:
        """Return how a message calls a setting: where it stands in the configuration, or its option."""
        return self.places.get(name) or option_of(name)

    @property
    def block(self) -> int:
        """Seeds that belong to a candidate: those of its runs, and of their replacements."""
        has_room = self.retry_new_seed or self.seeds == BLOCKS
        return self.runs * (self.retries + 1 if has_room else 1)

    @property
    def first_seed(self) -> int:
        """The first seed of all: 0, or one below 2^31 that follows from the seed of the optimiser."""
        if self.seeds != BLOCKS:
            return 0
        from numpy.random import SeedSequence  # takes a while

        return int(SeedSequence([self.seed, STREAM]).generate_state(1)[0]) >> 1

    def seeds_of(self, candidate: int) -> list[int]:
        """Return the seeds of the runs of a candidate; candidates are numbered from 1 on."""
        first = self.first_seed + (0 if self.seeds == COMMON else (candidate - 1) * self.block)
        return list(range(first, first + self.runs))

    @property
    def fresh_seeds(self) -> list[int]:
        """Seeds that no candidate has."""
        first = self.first_seed + self.block * (1 if self.seeds == COMMON else self.max_evals)
        return list(range(first, first + self.final_runs))

    @property
    def seed_count(self) -> int:
        """Seeds from the first one of all to the last that may be needed, whatever the policy."""
        of_final = self.final_runs * (self.retries + 1 if self.retry_new_seed else 1)
        return self.first_seed + self.max_evals * self.block + of_final


def option_of(name: str) -> str:
    """Return the option of a setting on the command line."""
    return f"--{name.replace('_', '-')}"


def whole(least: int, most: int) -> Callable[[Any], int]:
    """Return a check for whole numbers in a range, which includes both ends."""

    def check(value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
            raise ValueError(f"expected a whole number from {least} to {most}")
        return value

    return check


def real(least: float, most: float) -> Callable[[Any], float]:
    """Return a check for numbers in a range, which includes its upper end only, or both if the lower one is 0."""

    def check(value: Any) -> float:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not is_number or not least <= value <= most:
            raise ValueError(f"expected a number from {least:g} to {most:g}")
        return float(value)

    return check


def flag(value: Any) -> bool:
    """Check true or false."""
    if not isinstance(plain(value), bool):
        raise ValueError("expected true or false")
    return bool(plain(value))


def text(value: Any) -> str:
    """Check a text."""
    if not isinstance(value, str) or not value:
        raise ValueError("expected a text")
    return value


def shape(value: Any) -> tuple[int, ...]:
    """Check numbers of cells: "48,48" or [48, 48]."""
    items = value.split(",") if isinstance(value, str) else value if isinstance(value, list) else [value]
    try:
        cells = tuple(int(item) for item in items if not isinstance(item, (bool, float)))
    except (TypeError, ValueError):
        cells = ()
    if not cells or len(cells) != len(items) or min(cells) < 1 or math.prod(cells) > 1_000_000:
        raise ValueError("expected the number of cells along each feature, such as 48,48, a million cells at most")
    return cells


def ranges(value: Any) -> tuple[tuple[float, float], ...]:
    """Check ranges of features: "0:1,0:500" or [[0, 1], [0, 500]]."""
    items = [item.split(":") for item in value.split(",")] if isinstance(value, str) else value
    try:
        pairs = tuple((float(low), float(high)) for low, high in items)
        if not pairs or not all(math.isfinite(high - low) and low < high for low, high in pairs):
            raise ValueError
    except (TypeError, ValueError):
        raise ValueError("expected the least and the greatest value of each feature, such as 0:1,0:500") from None
    return pairs


SEED = whole(0, 2**32 - 1)
COUNT = whole(1, 10_000_000)

# Keys of the section in the configuration, with the names that others' tools know; and how they are checked.
KEYS: dict[tuple[str, ...], tuple[str, Callable[[Any], Any]]] = {
    ("algorithm",): ("optimizer", text),
    ("budget",): ("max_evals", COUNT),
    ("seed",): ("seed", SEED),
    ("seeds",): ("seeds", text),
    ("runs",): ("runs", COUNT),
    ("final_runs",): ("final_runs", whole(0, 10_000_000)),
    ("retries",): ("retries", whole(0, 1000)),
    ("backend",): ("backend", text),
    ("output_dir",): ("output_dir", text),
    ("temp_base",): ("temp_base", text),
    ("keep_temp",): ("keep_temp", flag),
    ("retry_new_seed",): ("retry_new_seed", flag),
    ("parallelism", "candidate_jobs"): ("candidate_jobs", whole(1, 100_000)),
    ("parallelism", "batch_jobs"): ("batch_jobs", whole(0, 100_000)),
    ("objective",): ("objective", text),
    ("objective", "path"): ("objective", text),
    ("objective", "func"): ("objective_func", text),
    ("objective_func",): ("objective_func", text),
    ("features_func",): ("features_func", text),
    ("cmaes", "sigma0"): ("sigma0", real(1e-6, 10.0)),
    ("cmaes", "popsize"): ("popsize", whole(2, 100_000)),
    ("popsize",): ("popsize", whole(2, 100_000)),
    ("qd", "shape"): ("qd_shape", shape),
    ("qd", "ranges"): ("qd_ranges", ranges),
    ("qd", "features_domain"): ("qd_features_domain", ranges),
    ("qd", "init_samples"): ("qd_init_samples", COUNT),
    ("qd", "batch"): ("qd_batch", COUNT),
    ("qd", "mut_pb"): ("qd_mut_pb", real(0.0, 1.0)),
    ("qd", "eta"): ("qd_eta", real(0.0, 1000.0)),
}
CHECKS = dict(KEYS.values())
MAPS = {path[0] for path in KEYS if len(path) > 1}
# Options by the name that they have on the command line.
KEYS.update({(name,): (name, check) for name, check in CHECKS.items() if (name,) not in KEYS})
# Settings of the optimiser in other tools, without a meaning in ours.
UNUSED = (("qd", "parallel"), ("qd", "sel_pb"), ("qd", "init_pb"), ("qd", "algo_kwargs"))


def flattened(section: Mapping[str, Any]) -> dict[tuple[str, ...], Any]:
    """Return the entries of the section by their path; maps below it are opened once."""
    flat: dict[tuple[str, ...], Any] = {}
    for key, value in section.items():
        if isinstance(value, dict) and key in MAPS:
            flat.update({(str(key), str(name)): entry for name, entry in value.items()})
        else:
            flat[(str(key),)] = value
    return flat


def say_unknown(path: tuple[str, ...], place: str, warn: Callable[[str], None]) -> None:
    """Refuse a key that is a slip, and warn of any other: it may be for another version of the program.

    Raises:
        OptimizeError: It is near to a known key, stands in another map than that one, or is in the map `objective`,
            where it would choose what is maximised.
    """
    *maps, name = path
    beside = [key for key in KEYS if list(key[:-1]) == maps]
    near = nearest_name(name, [key[-1] for key in beside])
    meant = [key for key in beside if key[-1] == near] or [key for key in KEYS if key[-1] == name]
    if meant:
        raise OptimizeError(f"{place}: unknown key; did you mean '{'.'.join(meant[0])}'?")
    if maps == [OBJECTIVE]:
        raise OptimizeError(f"{place}: unknown key; expected {' and '.join(key[-1] for key in beside)}")
    names = [".".join(key) for key in KEYS]
    warn(f"{place}: unknown key, which has no effect{advice('.'.join(path), names)}")


def settings_from(
    section: Any, options: Mapping[str, Any], where: Callable[[tuple[str, ...]], str], warn: Callable[[str], None]
) -> Settings:
    """Return the settings: those of the command line, then those of the configuration, then the usual ones.

    Args:
        section: The entry `optimization` of the configuration; None: there is none.
        options: Settings of the command line, by name; None: not given.
        where: Returns the place of an entry in the configuration, for messages.
        warn: Called with a warning.

    Raises:
        OptimizeError: One of them is wrong.
    """
    if section is not None and not isinstance(section, dict):
        raise OptimizeError(f"{where((SECTION,))}: expected a map of settings, found {shown(section)}")
    chosen: dict[str, Any] = {}
    places: dict[str, str] = {}
    section = dict(section or {})
    name = options.get("optimizer") or section.get("algorithm")
    if isinstance(name, str) and name not in MAPS and isinstance(section.get(name), dict):
        chosen["own"], places["own"] = section.pop(name), where((SECTION, name))
    for path, value in flattened(section).items():
        if path in UNUSED:
            warn(f"{where((SECTION, *path))}: has no effect here")
        elif path not in KEYS:
            say_unknown(path, where((SECTION, *path)), warn)
        elif value is not None:
            name, check = KEYS[path]
            places[name] = where((SECTION, *path))
            chosen[name] = checked(check, value, places[name])
    for name in (own.name for own in fields(Settings)):
        value = options.get(name)
        if value is not None:
            places.pop(name, None)
            chosen[name] = checked(CHECKS[name], value, option_of(name))
    if isinstance(section.get(OBJECTIVE), dict):
        chosen["objective_names"] = NAMES_OF_MAP
    settings = Settings(**chosen, places=places)
    if settings.seeds not in POLICIES:
        known = f"{', '.join(POLICIES[:-1])} or {BLOCKS}"
        raise OptimizeError(f"{settings.place_of('seeds')}: expected {known}, found '{settings.seeds}'")
    if settings.qd_ranges and settings.qd_features_domain:
        both = " and ".join(map(settings.place_of, ("qd_ranges", "qd_features_domain")))
        raise OptimizeError(f"{both} both say the range of features; remove one of them")
    if settings.seed_count > LAST_SEED:
        raise OptimizeError(
            f"{settings.place_of('max_evals')}: {settings.max_evals} times {settings.runs} runs need more seeds than "
            "there are"
        )
    return settings


def checked(check: Callable[[Any], Any], value: Any, name: str) -> Any:
    """Return a setting.

    Raises:
        OptimizeError: It is wrong.
    """
    try:
        return check(value)
    except ValueError as error:
        raise OptimizeError(f"{name}: {error}, found {shown(value)}") from None
