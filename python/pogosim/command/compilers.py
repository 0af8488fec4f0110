"""How programs of one file are compiled: the compiler, its flags and the standard, by language."""

from __future__ import annotations

import os
import shlex
from typing import NamedTuple

from pogosim.errors import ToolError


class CompilerError(ToolError):
    """What the environment says of a compiler cannot be understood."""


class Compiler(NamedTuple):
    """A language's compiler, as make knows it."""

    variable: str  # environment variable that names another one
    usual: str
    flags: str  # environment variable with more flags
    standard: str

    def command(self) -> list[str]:
        """Return the compiler and the standard.

        Raises:
            CompilerError: A quotation mark is open in the environment variable.
        """
        return [*(words_of(self.variable) or [self.usual]), f"-std={self.standard}"]


COMPILERS = {
    ".c": Compiler("CC", "cc", "CFLAGS", "gnu11"),
    ".cpp": Compiler("CXX", "c++", "CXXFLAGS", "gnu++20"),
}


def words_of(variable: str) -> list[str]:
    """Return the words of an environment variable, as a shell would split it.

    Raises:
        CompilerError: A quotation mark is open.
    """
    try:
        return shlex.split(os.environ.get(variable, ""))
    except ValueError as error:
        raise CompilerError(f"the environment variable {variable} cannot be understood: {error}") from None
