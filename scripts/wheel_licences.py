"""Licences of the libraries that a wheel contains: what its metadata say, and the texts that it must bring.

`LIBRARIES` is the list; docs/licences.md explains it. scripts/cross/dependencies.py fetches the libraries' sources, in
which the texts are.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

OWN = "MIT"
FOLDER = "libraries"  # in the folder of licences of a wheel
NOTICE = f"{FOLDER}/NOTICE.txt"


class Library(NamedTuple):
    """A library that is linked into the simulator."""

    licence: str  # SPDX expression
    texts: tuple[str, ...]  # files of its sources
    offers_source: bool = False  # users of a program in which it is linked must get its source


# By the names of their folders of sources.
LIBRARIES = {
    "boost": Library("BSL-1.0", ("LICENSE_1_0.txt",)),
    "box2d": Library("MIT", ("LICENSE",)),
    "cli11": Library("BSD-3-Clause", ("LICENSE",)),
    "elfutils": Library(
        "LGPL-3.0-or-later OR GPL-2.0-or-later", ("COPYING", "COPYING-GPLV2", "COPYING-LGPLV3"), offers_source=True
    ),
    "fmt": Library("MIT", ("LICENSE.rst",)),
    "imgui": Library("MIT", ("LICENSE.txt",)),
    "libpng": Library("libpng-2.0", ("LICENSE",)),
    "spdlog": Library("MIT", ("LICENSE",)),
    "stb": Library("MIT OR Unlicense", ("LICENSE",)),
    "yaml-cpp": Library("MIT", ("LICENSE",)),
    "zlib": Library("Zlib", ("LICENSE",)),
}


def libraries_for(target: str) -> set[str]:
    """Return the libraries in a wheel that scripts/make_wheel.py makes for a target, such as "macos-arm64"."""
    return set(LIBRARIES) - ({"elfutils"} if target.startswith("macos") else set())


def expression_for(libraries: Iterable[str]) -> str:
    """Return the SPDX expression of a wheel with these libraries: our licence and each of theirs, once."""
    licences = {LIBRARIES[name].licence for name in libraries} - {OWN}
    return " AND ".join([OWN, *(f"({licence})" if " OR " in licence else licence for licence in sorted(licences))])


def debian_version(source: Path) -> tuple[str, str]:
    """Return the name and the version of the Debian package from whose sources a folder comes."""
    log = source / "debian" / "changelog"
    found = re.match(r"(\S+) \((\S+)\)", log.read_text(encoding="utf-8")) if log.exists() else None
    if found is None:
        raise SystemExit(f"wheel_licences.py: {log} does not begin with a package and its version. Remove {source}")
    return found[1], found[2]


def notice_for(libraries: Iterable[str], sources: Path) -> str:
    """Return a text that names the libraries, their versions and licences, and says where the sources are."""
    lines = ["Pogosim is linked with these libraries. Their licences are in the folders beside this file.", ""]
    offered = []
    for name in sorted(libraries):
        package, version = debian_version(sources / name)
        lines.append(f"{name} {version}: {LIBRARIES[name].licence}")
        if LIBRARIES[name].offers_source:
            offered.append(
                f"    {name}: https://snapshot.debian.org/package/{package}/{version.partition(':')[2] or version}/"
            )
    if offered:
        lines += [
            "",
            "You may change the following libraries and link the simulator with them anew. Their sources, as they are",
            "used here, unchanged:",
            *offered,
            "The sources of Pogosim, with all scripts that link it, are open (MIT). Its scripts/make_wheel.sh keeps",
            "the libraries' sources in build/cross/sources: change them there, remove build/cross/TARGET, and run it",
            "again.",
        ]
    return "\n".join([*lines, ""])


def licences_for(libraries: Iterable[str], sources: Path) -> dict[str, str]:
    """Return the texts that a wheel with these libraries must bring, by their paths in its folder of licences.

    Args:
        libraries: Keys of `LIBRARIES`.
        sources: Folder with a folder of Debian's sources for each.
    """
    chosen = sorted(set(libraries))
    if unknown := [name for name in chosen if name not in LIBRARIES]:
        raise SystemExit(
            f"wheel_licences.py: the licence of {', '.join(unknown)} is not known. Read it, and add a line to LIBRARIES"
        )
    texts = {NOTICE: notice_for(chosen, sources)}
    for name in chosen:
        for file in LIBRARIES[name].texts:
            if not (sources / name / file).is_file():
                raise SystemExit(f"wheel_licences.py: {sources / name / file}, the licence of {name}, is missing")
            texts[f"{FOLDER}/{name}/{file}"] = (sources / name / file).read_text(encoding="utf-8")
    return texts


def add_licences(unpacked: Path, libraries: Iterable[str], sources: Path) -> None:
    """Put the licences of these libraries into the metadata of an unpacked wheel, which has its own already."""
    libraries = set(libraries)
    texts = licences_for(libraries, sources)
    (metadata,) = unpacked.glob("*.dist-info/METADATA")
    head, blank, body = metadata.read_text(encoding="utf-8").partition("\n\n")
    own = f"License-Expression: {OWN}\n"
    if own not in f"{head}\n":
        raise SystemExit(f"wheel_licences.py: {metadata} has no line {own.strip()!r}: is it of this project?")
    head = f"{head}\n".replace(own, f"License-Expression: {expression_for(libraries)}\n").rstrip("\n")
    lines = [f"License-File: {name}" for name in texts]
    metadata.write_text("\n".join([head, *lines]) + blank + body, encoding="utf-8")
    for name, text in texts.items():
        path = metadata.parent / "licenses" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
