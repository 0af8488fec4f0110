"""Expressions of values of robots, such as "speed < 1 and heard > 10", for all robots of all runs.

The simulator reads and evaluates them: they are those of the window's breakpoints (src/sim/condition.hpp). Truth values
are 1 and 0; a comparison with a value that is not there (NaN) is false.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from ctypes import byref, c_void_p
from typing import Any

import numpy as np
import numpy.typing as npt

from pogosim.simulation.errors import ConfigurationError
from pogosim.simulation.forked import finalize_here
from pogosim.simulation.library import check, library

Array = npt.NDArray[np.float32]
Read = Callable[[str], npt.NDArray[Any]]  # a value of all robots by its name


class Expression:
    """A text that stands for a number of each robot.

    Attributes:
        text: What was written.
        names: The values in it, each once.
    """

    def __init__(self, what: str, text: str, known: Sequence[str]) -> None:
        """Read a text.

        Args:
            what: The argument that it is from, for messages.
            text: At most 1000 characters, without zero bytes.
            known: Names of values.

        Raises:
            ConfigurationError: It cannot be read, or names a value that does not exist; says where.
        """
        self.text = text
        self._handle = c_void_p()
        try:
            check(library().pogosim_expression_open(text.encode(), "\n".join(known).encode(), byref(self._handle)))
        except ConfigurationError as error:
            raise ConfigurationError(f"{what}: {error}") from None
        finalize_here(self, library().pogosim_expression_close, self._handle)
        names = library().pogosim_expression_names(self._handle).decode()
        self.names = tuple(names.split("\n")) if names else ()

    def numbers(self, read: Read) -> Array:
        """Return its value for all robots, of the shape that `read` gives (one number if it names no value).

        Raises:
            ValueError: Values have shapes that NumPy does not broadcast.
        """
        values = [np.ascontiguousarray(read(name), np.float32) for name in self.names]
        if len({value.shape for value in values}) > 1:
            values = [np.ascontiguousarray(value) for value in np.broadcast_arrays(*values)]
        numbers = np.empty(values[0].shape if values else (), np.float32)
        places = (c_void_p * len(values))(*(value.ctypes.data for value in values))
        library().pogosim_expression_numbers(self._handle, places, numbers.size, numbers.ctypes.data)
        return numbers

    def __reduce__(self) -> Any:
        raise TypeError("expressions cannot be copied or pickled: read the text again")

    def is_true(self, read: Read) -> npt.NDArray[np.bool_]:
        """Return where it is true: neither 0 nor NaN."""
        numbers = self.numbers(read)
        return np.asarray((numbers != 0) & ~np.isnan(numbers))
