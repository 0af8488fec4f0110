"""How to install what comes with the operating system, in the words of this machine's package manager."""

from __future__ import annotations

import platform
import shlex
from pathlib import Path

# By the manager's command: the distributions that have it, by ID and ID_LIKE of os-release, then its names of what may
# be missing. What is not listed, a distribution does not have under that name.
COMMANDS = {
    "apt install": ("debian", "ubuntu"),
    "dnf install": ("fedora", "rhel", "centos"),
    "pacman -S": ("arch",),
}
MACOS = "brew install"
XCODE = "xcode-select --install"
OF_XCODE = {"gcc", "g++", "make"}  # on macOS
FOR_ROBOTS = "the robots' compiler"
PACKAGES: dict[str, dict[str, str]] = {
    "gcc": {"apt install": "gcc", "dnf install": "gcc", "pacman -S": "gcc"},
    "g++": {"apt install": "g++", "dnf install": "gcc-c++", "pacman -S": "gcc"},
    "make": {"apt install": "make", "dnf install": "make", "pacman -S": "make"},
    "ffmpeg": {"apt install": "ffmpeg", "dnf install": "ffmpeg-free", "pacman -S": "ffmpeg", MACOS: "ffmpeg"},
    "libdw": {"apt install": "libdw1", "dnf install": "elfutils-libs", "pacman -S": "libelf"},
    "libdw's headers": {"apt install": "libdw-dev", "dnf install": "elfutils-devel", "pacman -S": "libelf"},
    "SDL 2": {"apt install": "libsdl2-2.0-0", "dnf install": "SDL2", "pacman -S": "sdl2", MACOS: "sdl2"},
    "OpenGL": {
        "apt install": "libgl1-mesa-dri libegl1",
        "dnf install": "mesa-dri-drivers mesa-libEGL",
        "pacman -S": "mesa",
    },
    FOR_ROBOTS: {"apt install": "gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf"},
    # Libraries of X, by the names that the loader knows.
    "libX11.so.6": {"apt install": "libx11-6", "dnf install": "libX11", "pacman -S": "libx11"},
    "libXext.so.6": {"apt install": "libxext6", "dnf install": "libXext", "pacman -S": "libxext"},
    "libXcursor.so.1": {"apt install": "libxcursor1", "dnf install": "libXcursor", "pacman -S": "libxcursor"},
    "libXi.so.6": {"apt install": "libxi6", "dnf install": "libXi", "pacman -S": "libxi"},
    "libXfixes.so.3": {"apt install": "libxfixes3", "dnf install": "libXfixes", "pacman -S": "libxfixes"},
    "libXrandr.so.2": {"apt install": "libxrandr2", "dnf install": "libXrandr", "pacman -S": "libxrandr"},
    "libXss.so.1": {"apt install": "libxss1", "dnf install": "libXScrnSaver", "pacman -S": "libxss"},
}


def os_release(root: Path) -> dict[str, str]:
    """Return what a system says of its distribution, by name; empty if it says nothing."""
    for place in ("etc/os-release", "usr/lib/os-release"):
        try:
            text = (root / place).read_text(encoding="utf-8", errors="replace")
        except OSError:
            continue
        pairs = (line.partition("=") for line in text.splitlines() if "=" in line and not line.startswith("#"))
        return {name.strip(): value.strip().strip("\"'") for name, _, value in pairs}
    return {}


def manager(root: Path = Path("/"), system: str | None = None) -> str | None:
    """Return the command of this machine that installs packages; None if it is not known.

    Args:
        root: Folder that stands for /.
        system: Name of the operating system, as platform.system() has it, which is the default.
    """
    if (system or platform.system()) == "Darwin":
        return MACOS
    release = os_release(root)
    names = [release.get("ID", ""), *release.get("ID_LIKE", "").split()]
    return next((command for name in names for command, has_it in COMMANDS.items() if name in has_it), None)


def how_to_install(*things: str, root: Path = Path("/"), system: str | None = None) -> str:
    """Return what installs some of PACKAGES here, such as "apt install gcc make".

    Where the machine's package manager is not known, or does not have one of them, that is said with Debian's names.
    """
    command = manager(root, system)
    if command == MACOS and OF_XCODE.issuperset(things):
        return XCODE
    if command and all(command in PACKAGES[thing] for thing in things):
        return f"{command} {' '.join(dict.fromkeys(PACKAGES[thing][command] for thing in things))}"
    debian = shlex.join(" ".join(PACKAGES[thing]["apt install"] for thing in things).split())
    return f"install what Debian calls {debian}"
