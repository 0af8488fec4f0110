"""`Policy`: steps a policy in Python, by arrays of whole swarms and runs, as the exported C steps it on a robot."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.policy import float_arithmetic
from pogosim.policy.calibration import check_whole, checked_observations, with_ranges
from pogosim.policy.choices import NUMBERS
from pogosim.policy.errors import PolicyError
from pogosim.policy.fixed_arithmetic import FixedNetwork, fixed_step
from pogosim.policy.network import Network
from pogosim.policy.npz_file import read_npz, write_npz
from pogosim.policy.quantization import quantized


class Policy:
    """A policy that gives outputs for arrays of observations, and remembers what its recurrent layers need.

    In floats, outputs are those of the exported C, bit for bit, unless its compiler contracts operations
    (-ffp-contract). In whole numbers, they always are.

    Attributes:
        network: Its layers and scaling, with the ranges of the inputs.
        fixed: The same in whole numbers; None: in floats.
        state: What recurrent layers remember. Shape (..., values), as the observations of the last step; None before.
    """

    def __init__(self, network: Network, *, numbers: str = "float", calibration: npt.ArrayLike | None = None) -> None:
        """Make a policy.

        Args:
            network: Its layers and scaling.
            numbers: float; int16 or int8: whole numbers, with weights of 16 or 8 bits.
            calibration: Observations of a run, shape (..., inputs), for the ranges of inputs that the network does not
                give. Whole numbers need all ranges; floats do not cut inputs without one.

        Raises:
            PolicyError: There is no such kind of numbers, the observations are for another policy, or the policy cannot
                be in whole numbers.
        """
        self.network = network
        self.state: npt.NDArray[Any] | None = None
        self.fixed: FixedNetwork | None = None
        if numbers not in NUMBERS:
            raise PolicyError(f"numbers: expected one of {', '.join(NUMBERS)}, found {numbers!r}")
        rows = None if calibration is None else checked_observations(calibration, network, "calibration")
        if rows is not None:
            self.network = with_ranges(network, rows)
        if numbers != "float":
            check_whole(self.network, rows)
            self.fixed = quantized(self.network, int(numbers.removeprefix("int")))

    @classmethod
    def load(cls, file: str | Path, *, numbers: str = "float", calibration: npt.ArrayLike | None = None) -> Policy:
        """Read a policy from an .npz file; see the other arguments above.

        Raises:
            PolicyError: The file is damaged, or holds no policy; or as above.
            OSError: It cannot be read.
        """
        return cls(read_npz(Path(file)), numbers=numbers, calibration=calibration)

    def save(self, file: str | Path) -> None:
        """Write the policy, in floats, into an .npz file.

        Raises:
            OSError: It cannot be written.
        """
        write_npz(file, self.network)

    @property
    def dtype(self) -> type[np.generic]:
        """Type of outputs and state: float32 or int32."""
        return np.float32 if self.fixed is None else np.int32

    def step(self, observation: npt.ArrayLike) -> npt.NDArray[Any]:
        """Return the outputs. Shape (..., outputs): floats of 32 bits, or integers of 32 bits.

        Args:
            observation: Shape (..., inputs), in the units of the inputs; rounded for a policy in whole numbers. All
                steps of a recurrent policy have the same shape; see reset().

        Raises:
            PolicyError: The observations are for another number of inputs, are not finite, or have another shape than
                those of the last step.
        """
        found = np.asarray(observation)
        if found.dtype.kind not in "fiub" or found.ndim == 0 or found.shape[-1] != self.network.inputs:
            what = f"an array of {found.dtype} of shape {found.shape}"
            names = ", ".join(self.network.input_names)
            raise PolicyError(
                f"observation: expected numbers of shape (..., {self.network.inputs}): {names}; found {what}"
            )
        if found.dtype.kind == "f" and not np.isfinite(found).all():
            index = tuple(int(one) for one in np.argwhere(~np.isfinite(found))[0])
            raise PolicyError(f"observation{list(index)}: expected a finite number, found {found[index]}")
        shape = (*found.shape[:-1], self.network.state_units)
        if self.state is None:
            self.state = np.zeros(shape, self.dtype)
        elif self.network.is_recurrent and self.state.shape != shape:
            expected = f"(..., {self.network.inputs}) with {self.state.shape[:-1]} in front, as in the last step"
            raise PolicyError(f"observation: expected the shape {expected}, found {found.shape}; reset() begins anew")
        outputs: npt.NDArray[Any]
        if self.fixed is None:
            with np.errstate(over="ignore", invalid="ignore"):  # as on the robot
                outputs, self.state = float_arithmetic.step(self.network, found.astype(np.float32), self.state)
        else:
            whole = np.clip(np.rint(found), self.fixed.input_low, self.fixed.input_high).astype(np.int64)
            integers, state = fixed_step(self.fixed, whole, self.state.astype(np.int64))
            outputs, self.state = integers.astype(np.int32), state.astype(np.int32)
        return outputs

    def reset(self, which: Any = None) -> None:
        """Set what recurrent layers remember to 0, as in the beginning.

        Args:
            which: Index of the arrays in front of the state, such as a number of a run, or an array of booleans of
                shape (runs,) or (runs, robots); None: everything, and the next observations may have another shape.

        Raises:
            IndexError: There is no such run or robot, or the array has another shape.
        """
        if which is None or self.state is None:
            self.state = None
        else:
            self.state[which] = 0
