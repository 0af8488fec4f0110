"""All evaluations of a search, written down one by one, so that a search that was killed can go on where it was.

Each line of the file is a JSON map: first what the search is, then one evaluation each, in the order in which they
ended. A last line that is not complete belongs to an evaluation that does not count.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, Any

from pogosim.batch.errors import cannot
from pogosim.errors import OptimizeError
from pogosim.lines import counted
from pogosim.optimize.objective import Judgement
from pogosim.outputs import lock

JOURNAL = "search.jsonl"
VERSION = 1
PATIENCE_S = 3.0  # with the lock of a search
END = "end"  # key of the last line of a search that is finished
DIGEST = " digest"  # behind the names of what is compared by its digest
CHANGEABLE = ("max_evals", "final_runs")  # a search may be continued for longer, or for less long


@dataclass(frozen=True)
class Evaluation:
    """A candidate that was evaluated.

    Attributes:
        number: From 1 on, in the order in which candidates were asked for.
        generation: From 1 on.
        point: Where in the unit cube.
        values: Values of the variables in use, by name.
        fitness: None: it has failed.
        features: By name.
        problem: Why it has failed, or empty.
        timestamp: When it ended: "2025-01-31T12:00:00".
        base_seeds: Seeds of its runs.
        effective_seeds: Those that they have had in the end, after failures; empty: it is not known.
        replacement: The greatest number of a replacement of a seed among its runs; 0: all have their own.
    """

    number: int
    generation: int
    point: list[float]
    values: dict[str, Any]
    fitness: float | None
    features: Mapping[str, float]
    problem: str
    timestamp: str
    base_seeds: Sequence[int] = ()
    effective_seeds: Sequence[int] = ()
    replacement: int = 0

    def check(self) -> None:
        """Raise ValueError if it is not what a search wrote."""
        are_right = (
            isinstance(self.number, int),
            isinstance(self.point, list) and all(isinstance(x, float) for x in self.point),
            isinstance(self.values, dict),
            self.fitness is None or isinstance(self.fitness, float),
            isinstance(self.features, dict) and all(isinstance(value, float) for value in self.features.values()),
            isinstance(self.problem, str),
            isinstance(self.timestamp, str),
            all(isinstance(seed, int) for seed in (*self.base_seeds, *self.effective_seeds, self.replacement)),
        )
        if not all(are_right):
            raise ValueError

    @property
    def judgement(self) -> Judgement:
        """What came out."""
        seeds = tuple(self.effective_seeds)
        return Judgement(self.fitness, dict(self.features), self.problem, seeds, self.replacement)


class Journal:
    """The file with the evaluations of a search.

    Attributes:
        known: Evaluations of an earlier part of the search, by number.
        replaces: An earlier search is there, which is finished; its place is taken by this one.
    """

    def __init__(self, path: Path, description: Mapping[str, Any], resume: bool) -> None:
        """Open the journal of a new search, or that of one to continue.

        Args:
            path: The file. It is left as it is until there is an evaluation.
            description: What the search is; one that is continued must be the same.
            resume: Continue the search that is there, if there is one.

        Raises:
            OptimizeError: A search is there that is not finished, or another one; or it is running.
            BatchError: The file cannot be read or written.
        """
        self.path = path
        self.description = {"version": VERSION, **description}
        self.known: dict[int, Evaluation] = {}
        self.is_finished = False
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self.file: IO[bytes] = path.open("a+b")
        except OSError as error:
            raise cannot("write", path, error) from None
        self.replaces = False
        self.end: int | None = 0  # of the lines to keep, in bytes; None: only they are there
        try:
            if not lock(self.file, PATIENCE_S):
                raise OptimizeError(
                    f"another search is writing to {path.parent}; wait for it, or choose another folder with -o"
                )
            self.end = self.read(resume)
            if not resume:
                self.refuse_unfinished()
        except OSError as error:
            self.close()
            raise cannot("read", path, error) from None
        except BaseException:
            self.close()
            raise

    def refuse_unfinished(self) -> None:
        """Forget the search that is there.

        Raises:
            OptimizeError: It is not finished.
        """
        if self.known and not self.is_finished:
            raise OptimizeError(
                f"{self.path.parent} has a search that is not finished, with {counted(len(self.known), 'evaluation')}: "
                f"--resume continues it; for another one, choose another folder with -o, or remove {self.path}"
            )
        self.replaces = bool(self.known)
        self.known, self.end = {}, 0

    def read(self, resume: bool) -> int:
        """Read what is there; returns where its last complete line ends, in bytes."""
        self.file.seek(0)
        end = 0
        for number, line in enumerate(self.file):
            if not line.endswith(b"\n"):
                break
            try:
                self.take(json.loads(line), is_first=number == 0, resume=resume)
            except (ValueError, TypeError, AttributeError, KeyError, RecursionError):
                raise OptimizeError(
                    f"{self.path}:{number + 1}: not a line of a search; remove it and those after it to continue "
                    "what is before, or choose another folder with -o"
                ) from None
            end += len(line)
        return end

    def take(self, entry: Any, is_first: bool, resume: bool) -> None:
        """Take a line."""
        if is_first:
            if entry["version"] != VERSION:
                raise ValueError
            if resume:
                self.compare(entry)
        elif END in entry:
            self.is_finished = True
        else:
            self.is_finished = False
            evaluation = Evaluation(**entry)
            evaluation.check()
            self.known[evaluation.number] = evaluation

    def compare(self, there: Mapping[str, Any]) -> None:
        """Check that the search that is there is this one.

        Raises:
            OptimizeError: It is another one; says what differs.
        """
        own = json.loads(json.dumps(self.description))
        for key in dict.fromkeys([*own, *there]):
            name, is_digest = key.removesuffix(DIGEST), key.endswith(DIGEST)
            # What imports another module now has changed itself.
            is_known = not is_digest or (key in own and key in there)
            if key not in CHANGEABLE and is_known and there.get(key) != own.get(key):
                values = f"{name} was {there.get(key)}, and is {own.get(key)} now"
                what = f"the {name} has changed" if is_digest else values
                raise OptimizeError(
                    f"--resume: {self.path.parent} has another search: {what}; choose another folder with -o, or give "
                    "the command as it was"
                )

    def add(self, evaluation: Evaluation) -> None:
        """Write down an evaluation, so that it stays even if the machine stops."""
        self.write(asdict(evaluation))

    def finish(self, evaluations: int) -> None:
        """Write down that the search has come to its end."""
        self.write({END: evaluations})

    def write(self, entry: Mapping[str, Any]) -> None:
        """Append a line; before the first one, remove what is not part of the search.

        Raises:
            BatchError: It cannot be written.
        """
        try:
            if self.end is not None:
                self.file.truncate(self.end)
                if not self.end:
                    self.file.write(line_of(self.description))
                self.end = None
            self.file.write(line_of(entry))
            self.file.flush()
            os.fsync(self.file.fileno())
        except OSError as error:
            raise cannot("write", self.path, error) from None

    def close(self) -> None:
        """Let others write. An empty file goes away."""
        with contextlib.suppress(OSError):  # what could not be written has been told
            if self.path.exists() and self.path.stat().st_size == 0:
                self.path.unlink()
            self.file.close()


def line_of(entry: Mapping[str, Any]) -> bytes:
    """Return a line of JSON."""
    return json.dumps(entry, default=str).encode() + b"\n"
