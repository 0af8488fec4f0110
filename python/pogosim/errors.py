"""What keeps a tool from doing what it is asked for, and what it warns of; light, so that command lines can name it."""

from __future__ import annotations


class ToolError(Exception):
    """A tool cannot do what it is asked for. The message says where, what, what was expected, what to do; in a line.

    That of a command of another package may have more lines.

    Attributes:
        exit_code: That of a command which ends so.
    """

    exit_code = 2


class AnalysisError(ToolError, ValueError):
    """Data do not have what an analysis needs; says what, and what to do."""


class MissingColumnWarning(RuntimeWarning):
    """A data file does not have what pictures of its run were to show."""


class AmbiguousStepsWarning(RuntimeWarning):
    """Rows are so far apart in time that robots may have gone another way than the shortest."""


class DamagedFileError(ToolError, ValueError):
    """A data file is damaged, or none; says which, what is wrong, and what to do."""


class CalibrationError(ToolError):
    """Robots cannot be calibrated so; says what, where, and what to do."""


class OptimizeError(ToolError):
    """The search cannot be done. The message is one line: where, what, what was expected, what to do."""


class PictureError(ToolError):
    """The file holds nothing that can be drawn, or the picture cannot be made; says why."""
