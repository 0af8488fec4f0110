"""Observations of a run, from which the ranges of a policy's inputs are taken."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.errors import DamagedFileError
from pogosim.policy.content import check_file
from pogosim.policy.errors import PolicyError
from pogosim.policy.network import MOST_FLOAT, Network
from pogosim.policy.npz_file import WRONG_FILE, read_arrays

FEWEST_WHOLE = 16  # whole numbers in the range of an input that may have fractions
OBSERVATIONS = "observations"  # the array of a .npz file that has several
WANTED = (
    "expected an .npz or .npy file with an array of shape (..., inputs), or a data file with a column for each input"
)


def read_observations(file: Path, network: Network) -> npt.NDArray[np.float64]:
    """Read observations for a policy. Shape (observations, inputs), in the units of the inputs.

    Args:
        file: An .npz file with an array of shape (..., inputs) by the name observations, or one array alone; an .npy
            file; or a data file of a run, with a column for each input, by its name. Rows that lack one are left out.
        network: The policy.

    Raises:
        PolicyError: The file is none of these, has too few inputs, or numbers that are not finite.
        OSError: It cannot be read.
    """
    check_file(file)
    if file.suffix == ".npz":
        arrays = read_arrays(file)
        if OBSERVATIONS not in arrays and len(arrays) != 1:
            raise PolicyError(f"{file} has no array '{OBSERVATIONS}', but {', '.join(arrays) or 'nothing'}; {WANTED}")
        found: npt.NDArray[Any] = arrays.get(OBSERVATIONS, next(iter(arrays.values())))
    elif file.suffix == ".npy":
        try:
            found = np.load(file, allow_pickle=False)
        except WRONG_FILE as error:
            raise PolicyError(f"{file} is damaged, or no .npy file of NumPy: {' '.join(str(error).split())}") from None
    else:
        found = columns_of(file, network)
    return checked_observations(found, network, str(file))


def columns_of(file: Path, network: Network) -> npt.NDArray[Any]:
    """Return the columns of a data file that are named as the inputs are, of the rows that have all of them."""
    from pogosim.utils import load_dataframe

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # of a table without the metadata of a run
            rows = load_dataframe(file)[0]
    except DamagedFileError as error:
        raise PolicyError(f"{error}; {WANTED}") from None
    if lacking := [name for name in network.input_names if name not in rows.columns]:
        raise PolicyError(f"{file} has no column '{lacking[0]}', the name of an input of the policy; {WANTED}")
    return np.asarray(rows[list(network.input_names)].dropna().to_numpy())


def checked_observations(values: npt.ArrayLike, network: Network, place: str) -> npt.NDArray[np.float64]:
    """Return observations as rows. Shape (observations, inputs).

    Raises:
        PolicyError: There are none, they are for another number of inputs, or they are not finite numbers.
    """
    found = np.asarray(values)
    if found.dtype.kind not in "fiub":
        raise PolicyError(f"{place}: expected numbers, found an array of {found.dtype}")
    if found.ndim == 0 or found.shape[-1] != network.inputs:
        what = f"an array of shape {found.shape}"
        raise PolicyError(f"{place}: expected observations of shape (..., {network.inputs}), found {what}")
    rows = found.reshape(-1, network.inputs).astype(np.float64)
    if not len(rows):
        raise PolicyError(f"{place} has no observations; expected those of a run")
    is_float = np.abs(rows) <= MOST_FLOAT
    if not is_float.all():
        row, index = (int(one) for one in np.argwhere(~is_float)[0])
        what = f"input {network.input_names[index]} is {rows[row, index]}"
        raise PolicyError(f"{place}: {what} in observation {row}; expected finite numbers of 32 bits")
    return rows


def with_ranges(network: Network, observations: npt.NDArray[np.float64]) -> Network:
    """Return a policy whose inputs without a range have that of observations, shape (observations, inputs).

    Raises:
        PolicyError: The observations of an input without a range are all the same.
    """
    made = network.input_range.copy()
    for index, name in enumerate(network.input_names):
        if not np.isnan(made[index, 0]):
            continue
        own = observations[:, index]
        made[index] = own.min(), own.max()
        if made[index, 0] == made[index, 1]:
            raise PolicyError(
                f"the input {name} is {own[0]:g} in all {len(own)} observations, so its range is unknown; expected "
                "observations in which it changes, or input_low and input_high in the policy"
            )
    return replace(network, input_range=made)


def check_whole(network: Network, observations: npt.NDArray[np.float64] | None) -> None:
    """Check that inputs can be rounded: that there are many whole numbers in their ranges, or a run has no others.

    Args:
        network: The policy.
        observations: Those of a run, shape (observations, inputs); None: there is none.

    Raises:
        PolicyError: An input cannot.
    """
    for index, (name, (least, most)) in enumerate(zip(network.input_names, network.input_range, strict=True)):
        own = None if observations is None else observations[:, index]
        if np.ceil(most) - np.floor(least) < FEWEST_WHOLE and (own is None or (own != np.rint(own)).any()):
            what = "with fractions" if own is not None else "which has few whole numbers"
            other = "" if own is not None else "; or if it has no fractions, show observations of a run (--calibration)"
            raise PolicyError(
                f"the input {name} ranges from {least:g} to {most:g}, {what}; a policy in whole numbers takes whole "
                "inputs: give it in a smaller unit, such as counts of the sensor, and scale it by input_offset and "
                f"input_scale{other}"
            )
