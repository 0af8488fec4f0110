"""What the commands that draw a data file share: options, reading the file, and saying what went wrong."""

from __future__ import annotations

import argparse
import contextlib
import math
import warnings
from collections.abc import Callable, Iterator

import numpy as np

from pogosim.command.parser import complain, warn, warnings_told
from pogosim.outputs import OutputError
from pogosim.periodic import AmbiguousStepsWarning
from pogosim.picture.errors import PictureError
from pogosim.picture.swarm import Recording, read_recording

MAX_PANELS = 100


def positive(text: str) -> float:
    """Return a number above 0 from the command line."""
    value = float(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a number above 0")
    return value


def moment(text: str) -> float:
    """Return a time in s from the command line."""
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text} is not a time in seconds")
    return value


def add_what_to_draw(parser: argparse.ArgumentParser) -> None:
    """Add the options of all commands that draw a data file."""
    parser.add_argument("--color-by", metavar="COLUMN", help="colours show the values of this column (LEDs)")
    parser.add_argument("--links", action="store_true", help="join robots near enough to hear each other")
    parser.add_argument("--run", type=int, metavar="N", help="of several runs, the one with this number (the first)")
    parser.add_argument(
        "--combination", type=int, metavar="N", help="of a batch with several combinations of options, this one (0)"
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="do not say what was written")


def load(options: argparse.Namespace, prog: str) -> Recording:
    """Read the data file that the options name; what is incomplete or left out is a line on standard error."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RuntimeWarning)
        recording = read_recording(options.data, options.run, options.color_by, options.combination)
    for warning in caught:
        if issubclass(warning.category, AmbiguousStepsWarning):
            warnings.warn(warning.message, stacklevel=2)  # which may come again: see report()
        else:
            warn(prog, warning.message)
    if recording.left_out:
        warn(prog, f"{options.data} holds {recording.left_out}")
    return recording


@contextlib.contextmanager
def sayings(data: str) -> Iterator[None]:
    """Turn what keeps a data file from being drawn into a PictureError that names the file."""
    try:
        yield
    except PictureError as error:
        raise PictureError(f"cannot draw {data}: {error}") from error
    except (TypeError, KeyError, IndexError, AttributeError, OverflowError, np.linalg.LinAlgError) as error:
        raise PictureError(f"cannot draw {data}: its columns or metadata are not those of a run: {error}") from error
    except MemoryError as error:
        raise PictureError(f"cannot draw {data}: there is not enough memory") from error
    except ValueError as error:
        named = str(data) in str(error)
        raise PictureError(str(error) if named else f"cannot draw {data}: {error}") from error


def report(prog: str, data: str, output: str, make: Callable[[], None]) -> int:
    """Make an output; returns the exit code: 0, or 2 after a line that says why it could not be made."""
    try:
        with warnings_told(prog, AmbiguousStepsWarning):
            make()
    except (PictureError, OutputError) as error:
        return complain(prog, error)
    except OSError as error:
        is_data = str(error.filename) == data
        task = f"read '{data}'" if is_data else f"write '{output}'"
        is_missing = is_data and isinstance(error, FileNotFoundError)
        reason = "no such file" if is_missing else (error.strerror or str(error)).lower()
        return complain(prog, f"cannot {task}: {reason}")
    return 0
