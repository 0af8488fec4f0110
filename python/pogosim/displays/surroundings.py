"""The machine and the session that a window would open in: WSL, ssh, containers, batch jobs, variables."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pogosim.system_packages import how_to_install

CONTAINER_FILES = {".dockerenv": "Docker", "run/.containerenv": "Podman"}
CONTAINER_VARIABLES = {"APPTAINER_CONTAINER": "Apptainer", "SINGULARITY_CONTAINER": "Apptainer"}
DISPLAY_VARIABLES = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
SOCKETS = Path("tmp", ".X11-unix")  # where X servers listen


@dataclass(frozen=True)
class Surroundings:
    """What files and variables tell.

    Attributes:
        environment: The variables.
        root: Folder that stands for /.
        user: Number of the user.
        system: Name of the operating system, as platform.system() has it.
    """

    environment: Mapping[str, str] = field(default_factory=lambda: dict(os.environ))
    root: Path = Path("/")
    user: int = field(default_factory=os.getuid)
    system: str = field(default_factory=platform.system)

    def value(self, name: str) -> str:
        """Return a variable; "" if it is not set."""
        return self.environment.get(name, "")

    @property
    def is_display_named(self) -> bool:
        """Whether a run tries to open a window: a variable says where, or it is macOS, which needs none."""
        return self.system == "Darwin" or any(self.value(name) for name in DISPLAY_VARIABLES)

    @property
    def wsl(self) -> int:
        """Version of the Windows Subsystem for Linux, 1 or 2; 0 elsewhere."""
        kernel = read(self.root / "proc" / "version").lower()
        if "microsoft" in kernel:
            return 2 if "wsl2" in kernel or "microsoft-standard" in kernel else 1
        return 2 if self.value("WSL_DISTRO_NAME") else 0  # only WSL 2 takes a kernel of one's own

    @property
    def has_wslg(self) -> bool:
        """Whether the displays of WSL 2 are there."""
        return self.wsl == 2 and (self.root / "mnt" / "wslg").is_dir()

    @property
    def is_over_ssh(self) -> bool:
        """Whether someone has logged in from another machine."""
        return bool(self.value("SSH_CONNECTION"))

    @property
    def is_display_forwarded(self) -> bool:
        """Whether DISPLAY leads through ssh to that machine."""
        host, _, _ = self.value("DISPLAY").rpartition(":")
        return self.is_over_ssh and host in ("localhost", "127.0.0.1")

    @property
    def container(self) -> str:
        """Kind of container; "" outside of one."""
        names = [CONTAINER_VARIABLES[name] for name in CONTAINER_VARIABLES if self.value(name)]
        names += [CONTAINER_FILES[file] for file in CONTAINER_FILES if (self.root / file).exists()]
        return names[0] if names else ""

    @property
    def is_batch_job(self) -> bool:
        """Whether a batch system has started this."""
        return any(self.value(name) for name in ("SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID"))

    def x_socket(self, number: int) -> Path:
        """Return where the X server of a display of this machine listens."""
        return self.root / SOCKETS / f"X{number}"

    def how_to_install(self, *things: str) -> str:
        """Return what installs some of the packages of the system, see system_packages.how_to_install()."""
        return how_to_install(*things, root=self.root, system=self.system)

    def described(self) -> str:
        """Return it in a few words, such as "WSL 2 with WSLg, over ssh"; "" where nothing is special."""
        wsl = f"WSL {self.wsl}" + (f" with{'' if self.has_wslg else 'out'} WSLg" if self.wsl == 2 else "")
        parts = {
            wsl: self.wsl > 0,
            f"in a container of {self.container}": bool(self.container),
            "over ssh": self.is_over_ssh,
            "in a batch job": self.is_batch_job,
        }
        return ", ".join(part for part, is_so in parts.items() if is_so)


def read(file: Path) -> str:
    """Return the text of a file; "" if it cannot be read."""
    try:
        return file.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
