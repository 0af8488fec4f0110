"""What can go wrong with a run. The messages are those of the command line."""

from pogosim.arguments import Arguments


class SimulationError(Exception):
    """A run cannot be made, or has failed."""


class ConfigurationError(SimulationError, ValueError):
    """Wrong arguments or configuration, or a file that cannot be read or written."""


class NoVariableError(SimulationError):
    """A program or firmware has no variable of this name, or no USERDATA."""


class ProgramFailedError(SimulationError):
    """The robots' program crashed, or did not return. The run is over; its rows up to then can be read."""


given = Arguments(ConfigurationError)
