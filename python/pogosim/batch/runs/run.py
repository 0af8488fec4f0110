"""A run of a batch: what there is to do, and what became of it."""

from __future__ import annotations

import contextlib
import logging
import os
from dataclasses import dataclass, field
from pathlib import Path

from pogosim.batch.errors import BatchError
from pogosim.batch.runs.identity import PYTHON
from pogosim.batch.runs.run_data import RunFile, read_run
from pogosim.batch.runs.run_policy import RunPolicy
from pogosim.batch.runs.temporary import TemporaryFolder
from pogosim.extensions import MODELS_VARIABLE, models_path

FRAMES = "frames"  # folder of the outputs of a run, in its own

log = logging.getLogger("pogobatch")


@dataclass(frozen=True)
class RunSettings:
    """What all runs of a batch have in common. All paths are absolute."""

    program: Path
    program_digest: str
    configuration_folder: Path  # where files that configurations name are searched, too
    temporary: TemporaryFolder
    policy: RunPolicy
    working_folder: Path = field(default_factory=Path.cwd)
    models_path: str = field(default_factory=lambda: models_path(log.warning))  # folders, as in POGOSIM_PATH

    @property
    def folders(self) -> tuple[Path, ...]:
        """Folders in which files that a configuration names are searched, in this order."""
        models = map(Path, filter(None, self.models_path.split(os.pathsep)))
        return (self.working_folder, self.configuration_folder, *models)

    @property
    def search_path(self) -> str:
        """POGOSIM_PATH of the simulator: where it finds what single runs find beside the configuration, and models."""
        beside = str(self.configuration_folder)
        return os.pathsep.join(filter(None, ["" if os.pathsep in beside else beside, self.models_path]))

    @property
    def environment(self) -> dict[str, str]:
        """Variables of the environment that a simulator gets in addition."""
        return {MODELS_VARIABLE: self.search_path} if self.search_path else {}

    @property
    def may_share_process(self) -> bool:
        """Whether several runs may be done by one process."""
        return not self.why_alone

    @property
    def why_alone(self) -> str:
        """Why each run is a process of its own, whatever the program does; empty: nothing asks for it."""
        reasons = {
            "its program is a Python file": self.program.suffix == PYTHON,
            "--isolated": self.policy.is_isolated,
            "--save-states": self.saves_states,
            "--keep-temp": self.temporary.is_kept,
            "--gui": self.policy.gui,
        }
        return ", ".join(reason for reason, applies in reasons.items() if applies)

    @property
    def saves_states(self) -> bool:
        """Whether a run that is ended goes on later from its state; a Python file has its own command line."""
        return self.policy.save_every_s is not None and self.program.suffix != PYTHON


@dataclass(frozen=True)
class Task:
    """A run to do."""

    key: str
    run: int
    seed: int
    text: str  # configuration, without the names of its outputs, or with `place_of` them
    outputs: tuple[tuple[str, str], ...]  # keys of the configuration, and the basenames of the files
    settings: RunSettings
    replacements: tuple[int, ...] = ()  # seeds of its second, third, ... attempt; empty: its own seed

    @property
    def retries(self) -> int:
        """How many times the run is repeated if it fails: there may be too few seeds for as many as are asked for."""
        policy = self.settings.policy
        return len(self.replacements) if policy.retry_new_seed else policy.retries

    @property
    def data(self) -> str:
        """Basename of the data file."""
        return dict(self.outputs)["data_filename"]

    def seed_of(self, attempt: int) -> int:
        """Return the seed of an attempt, from 0 on."""
        return self.replacements[attempt - 1] if attempt and self.replacements else self.seed

    def result_of(self, replacement: int) -> Path:
        """Return where the data file is when the run is done, with its own seed (0) or a replacement (1, ...)."""
        suffix = f"_{replacement}_{self.seed_of(replacement)}" if replacement else ""
        return self.settings.temporary.done / f"{self.key}{suffix}.feather"

    def replacement_in(self, attempt: int) -> int:
        """Return which replacement of its seed an attempt has: 0 if it is its own seed again."""
        return attempt if self.replacements else 0

    def read(self, data: Path, replacement: int) -> RunFile | None:
        """Return a data file of the run, with its own seed (0) or a replacement; None: it is damaged."""
        with contextlib.suppress(BatchError, OSError):
            return read_run(data, self.run, self.seed_of(replacement), replacement)
        return None

    def finished(self) -> RunFile | None:
        """Return the data file of the run if it is done already, with its own seed or a replacement."""
        for replacement in range(len(self.replacements) + 1):
            result = self.result_of(replacement)
            if result.is_file() and (file := self.read(result, replacement)) is not None:
                return file
        return None


@dataclass(frozen=True)
class Outcome:
    """What became of a run."""

    key: str
    problem: str = ""  # empty: it is done
    is_fatal: bool = False  # other runs would end in the same way
    is_certain: bool = False  # the same run would end in the same way: its configuration is refused
    attempts: int = 1
    file: RunFile | None = None  # None: it has failed
    first_problem: str = ""  # of an attempt before, with the last line of its log; empty: there was none
    command: str = ""
    log: str = ""  # its last lines; of a run that is done, its warnings
    folder: str = ""  # what a failure leaves
    simulator_s: float = 0.0  # wall-clock time of its simulators
    code: int = 0  # with which its simulator has ended, or minus the signal
