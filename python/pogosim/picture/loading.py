"""Reading the data file that a command draws, and saying what is wrong with it."""

from __future__ import annotations

import argparse
import contextlib
import warnings
from collections.abc import Iterator

import numpy as np

from pogosim.command.parser import warn
from pogosim.errors import AmbiguousStepsWarning, DamagedFileError, PictureError
from pogosim.picture.options import cannot_read
from pogosim.picture.swarm import Recording, read_recording


def load(options: argparse.Namespace, prog: str) -> Recording:
    """Read the data file that the options name; what is incomplete or left out is a line on standard error.

    Raises:
        PictureError, ValueError: It cannot be drawn, or be read.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RuntimeWarning)
        try:
            recording = read_recording(options.data, options.run, options.color_by, options.combination)
        except OSError as error:
            raise PictureError(cannot_read(options.data, error)) from error
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
        is_told = str(error).startswith("cannot read ")
        raise PictureError(str(error) if is_told else f"cannot draw {data}: {error}") from error
    except (TypeError, KeyError, IndexError, AttributeError, OverflowError, np.linalg.LinAlgError) as error:
        raise PictureError(f"cannot draw {data}: its columns or metadata are not those of a run: {error}") from error
    except DamagedFileError:
        raise
    except MemoryError as error:
        raise PictureError(f"cannot draw {data}: there is not enough memory") from error
    except ValueError as error:
        named = str(data) in str(error)
        raise PictureError(str(error) if named else f"cannot draw {data}: {error}") from error
