"""Each file has a licence, and a wheel names those of its libraries and brings their texts."""

from __future__ import annotations

import os
import subprocess
import sys
from email.parser import Parser
from pathlib import Path

import pytest
from packaging.licenses import canonicalize_license_expression
from running import ROOT
from tracked import tracked

sys.path.insert(0, str(ROOT / "scripts"))

from wheel_licences import LIBRARIES, NOTICE, add_licences, expression_for, libraries_for, licences_for


@pytest.fixture
def sources(tmp_path: Path) -> Path:
    """Return a folder like that of the sources of all libraries."""
    folder = tmp_path / "sources"
    for name, library in LIBRARIES.items():
        (folder / name / "debian").mkdir(parents=True)
        (folder / name / "debian" / "changelog").write_text(f"lib{name} (1:2.{len(name)}-3) unstable; urgency=low\n")
        for file in library.texts:
            (folder / name / file).write_text(f"{file} of {name}\n")
    return folder


def test_every_file_has_a_licence() -> None:
    """REUSE.toml says which; the text of each is in LICENSES, where that of ours is a link to LICENSE."""
    files = [path for path in tracked() if not path.is_symlink()]
    done = subprocess.run(
        [sys.executable, "-m", "reuse", "lint-file", "--lines", *files],
        cwd=ROOT,
        env=os.environ | {"REUSE_ENCODING_MODULE": "charset_normalizer"},  # needs no library of the system
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert len(files) > 1000
    assert (ROOT / "LICENSES" / "MIT.txt").read_text() == (ROOT / "LICENSE").read_text()


def test_file_of_others_without_the_text_of_its_licence_is_found(tmp_path: Path) -> None:
    for name in ("LICENSES", "REUSE.toml", "LICENSE"):
        (tmp_path / name).symlink_to(ROOT / name)
    tag = "-".join(["SPDX", "License", "Identifier"])  # apart, as it would count for this file
    copied = tmp_path / "copied.c"
    copied.write_text(f"// {tag}: GPL-2.0-only\n")
    command = [
        sys.executable,
        "-m",
        "reuse",
        "--root",
        str(tmp_path),
        "lint-file",
        "--lines",
        str(copied),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "GPL-2.0-only" in done.stdout


def test_licences_are_standard_names() -> None:
    for library in LIBRARIES.values():
        assert canonicalize_license_expression(library.licence) == library.licence
    for libraries in ([], ["fmt"], ["zlib", "stb", "elfutils"], list(LIBRARIES)):
        expression = expression_for(libraries)
        assert canonicalize_license_expression(expression) == expression
    assert expression_for(["fmt", "stb", "zlib", "spdlog"]) == "MIT AND (MIT OR Unlicense) AND Zlib"


def test_all_libraries_that_are_fetched_have_a_known_licence() -> None:
    sys.path.insert(0, str(ROOT / "scripts"))
    from cross.dependencies import SOURCES

    assert set(SOURCES) - {"sdl"} == set(LIBRARIES)  # SDL's own package brings its licence


def test_wheels_for_macos_are_without_elfutils() -> None:
    assert libraries_for("linux-aarch64") == set(LIBRARIES)
    assert libraries_for("macos-arm64") == set(LIBRARIES) - {"elfutils"}
    assert "LGPL" not in expression_for(libraries_for("macos-arm64"))


def test_notice_names_versions_and_where_the_source_of_elfutils_is(sources: Path) -> None:
    notice = licences_for(["fmt", "elfutils"], sources)[NOTICE]
    assert "fmt 1:2.3-3: MIT\n" in notice
    assert "    elfutils: https://snapshot.debian.org/package/libelfutils/2.8-3/\n" in notice
    assert "zlib" not in notice
    assert "snapshot" not in licences_for(["fmt", "zlib"], sources)[NOTICE]


def test_metadata_and_texts_of_a_wheel(sources: Path, tmp_path: Path) -> None:
    information = tmp_path / "unpacked" / "pogosim-1.dist-info"
    (information / "licenses").mkdir(parents=True)
    (information / "METADATA").write_text(
        "Metadata-Version: 2.4\nName: x\nLicense-Expression: MIT\nLicense-File: LICENSE\n\nA text.\n\nMore of it.\n"
    )
    add_licences(tmp_path / "unpacked", LIBRARIES, sources)
    metadata = Parser().parsestr((information / "METADATA").read_text())
    assert metadata["License-Expression"] == expression_for(LIBRARIES)
    assert metadata.get_payload() == "A text.\n\nMore of it.\n"
    listed = metadata.get_all("License-File") or []
    assert listed[0] == "LICENSE"
    texts = [path for path in (information / "licenses").rglob("*") if path.is_file()]
    found = {str(path.relative_to(information / "licenses")) for path in texts}
    assert set(listed[1:]) == found
    assert len(found) == len(listed) - 1 > len(LIBRARIES)
    assert (information / "licenses" / "libraries" / "zlib" / "LICENSE").read_text() == "LICENSE of zlib\n"


@pytest.mark.parametrize(
    ("libraries", "broken", "message"),
    [
        (["fmt", "lua"], "", "the licence of lua is not known"),
        (["fmt"], "fmt/LICENSE.rst", "the licence of fmt, is missing"),
        (["zlib"], "zlib/debian/changelog", "does not begin with a package and its version"),
    ],
)
def test_licence_that_is_unknown_or_missing_is_told_in_a_line(
    libraries: list[str], broken: str, message: str, sources: Path
) -> None:
    if broken:
        (sources / broken).unlink()
    with pytest.raises(SystemExit, match=message) as told:
        licences_for(libraries, sources)
    assert "\n" not in str(told.value)
