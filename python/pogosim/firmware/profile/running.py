"""A run of a firmware that is profiled."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from pogosim.firmware.profile.raw import ProfileError
from pogosim.installation import Installation

# No window, no lines of robots; and the data file of another run of the configuration stays as it is.
QUIET = ("-g", "-q", "-nr", "--set", "enable_data_logging=false")


def profile_run(firmware: Path, raw: Path, robots: int, options: Sequence[str], pogosim: Installation) -> int:
    """Run a firmware, and let the simulator write a profile; what it says goes to the standard error.

    Args:
        firmware: The firmware.
        raw: The profile to write.
        robots: How many robots are profiled, the first ones; 1 or more.
        options: Options of the simulator, with a configuration.
        pogosim: The simulator.

    Returns:
        Its exit code, 0 if the run is complete; 128 more than the number of the signal that ended it.

    Raises:
        ProfileError: It cannot be run, or has written no profile.
    """
    command = [
        *(str(pogosim.without_program), *QUIET),
        *("--firmware", str(firmware), "--profile", str(raw), "--profile-robots", str(robots)),
        *options,
    ]
    sys.stdout.flush()
    try:
        code = subprocess.run(command, check=False, stdout=sys.stderr).returncode
    except OSError as error:
        raise ProfileError(f"cannot run {command[0]}: {error.strerror}") from None
    if code == 0 and not (raw.is_file() and raw.stat().st_size > 0):
        raise ProfileError(f"{command[0]} has written no profile: is it of another version?")
    return code if code >= 0 else 128 - code
