"""The folder for temporary files: finished runs of an unfinished batch, and what its runs leave."""

from __future__ import annotations

import contextlib
import hashlib
import shutil
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from pogosim.batch.errors import BatchError, cannot
from pogosim.outputs import lock

STATE = ".state"  # ending of the saved state of a run


def batch_name(paths: Sequence[str]) -> str:
    """Return the name of a batch in names of temporary files: the same whenever the same command is given.

    Args:
        paths: Its configuration, folder of results and program.
    """
    absolute = [Path(path).absolute() for path in paths]
    return hashlib.sha256("\n".join(map(str, absolute)).encode()).hexdigest()[:8]


@dataclass(frozen=True)
class TemporaryFolder:
    """The folder for temporary files, as one batch sees it.

    Other batches may use it, too: what belongs to this one has its name.
    """

    path: Path  # absolute
    batch: str  # see batch_name
    is_kept: bool  # all files stay

    @classmethod
    def of_batch(
        cls, temp_base: str, configuration: str, output_dir: str, program: str, is_kept: bool
    ) -> TemporaryFolder:
        """Return the folder of a batch, of which the others say what tells it apart in there."""
        return cls(Path(temp_base).absolute(), batch_name([configuration, output_dir, program]), is_kept)

    @property
    def done(self) -> Path:
        """The folder of finished runs."""
        return self.path / f"done_{self.batch}"

    @property
    def unfinished(self) -> Path:
        """The folder of unfinished runs that go on from their states."""
        return self.path / f"sim_saved_{self.batch}"

    def states(self) -> list[Path]:
        """Return the states from which runs go on; a run that was killed early has left an empty file."""
        return [path for path in self.unfinished.glob(f"*/*{STATE}") if path.stat().st_size > 0]

    def kept(self) -> str:
        """Return what an ended batch has left: "2 finished runs and the state of 1 unfinished run"; empty: nothing."""
        finished = sum(1 for _ in self.done.glob("*.feather"))
        states = len(self.states())
        runs = f"{finished} finished run{'' if finished == 1 else 's'}" if finished else ""
        states_of = "the state of 1 unfinished run" if states == 1 else f"the states of {states} unfinished runs"
        return " and ".join(text for text in (runs, states_of if states else "") if text)

    @contextlib.contextmanager
    def locked(self) -> Iterator[None]:
        """Keep other batches from using the same folder of finished runs meanwhile.

        Raises:
            BatchError: Another one does.
        """
        try:
            self.done.mkdir(parents=True, exist_ok=True)
            with (self.done / "lock").open("a") as file:
                if not lock(file):
                    raise BatchError(
                        f"the same batch is running already, with its files in {self.done}; wait for it, or choose "
                        "another folder with --temp-base"
                    )
                yield
        except OSError as error:
            raise cannot("use", error.filename or self.path, error) from None

    def remove_leftovers(self) -> None:
        """Remove what runs of an interrupted batch have left, unless folders are kept."""
        if not self.is_kept:
            for folder in self.path.glob(f"sim_*_try*_{self.batch}_*"):
                shutil.rmtree(folder, ignore_errors=True)

    def forget_finished_runs(self) -> None:
        """Remove the data files of single runs, unless folders are kept."""
        if not self.is_kept:
            shutil.rmtree(self.done, ignore_errors=True)
            shutil.rmtree(self.unfinished, ignore_errors=True)

    def tidy(self, configurations: Iterable[str]) -> None:
        """Remove what no later batch needs: configurations of combinations, and folders without a finished run."""
        if self.is_kept:
            return
        for path in configurations:
            Path(path).unlink(missing_ok=True)
        if self.done.exists() and not any(self.done.glob("*.feather")):
            shutil.rmtree(self.done, ignore_errors=True)
        with contextlib.suppress(OSError):
            self.path.rmdir()  # if nothing else is in it
