"""One file has the colours of swarm_picture, the window and the frames."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
from pogosim import swarm_picture

PROJECT = Path(__file__).resolve().parents[2]
PALETTE = PROJECT / "python" / "pogosim" / "palette.json"
COLOURS: dict[str, Any] = json.loads(PALETTE.read_text(encoding="utf-8"))


def header_of(palette: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run what makes the header out of a palette, as CMake does; the header is folder/palette.hpp."""
    script = folder / "make_header.cmake"
    script.write_text(
        f'set(PROJECT_SOURCE_DIR "{PROJECT}")\ninclude("{PROJECT}/cmake/palette.cmake")\n'
        f'pogosim_palette("{palette}" "{folder}/palette.hpp")\n',
        encoding="utf-8",
    )
    return subprocess.run(["cmake", "-P", str(script)], capture_output=True, text=True, check=False)


def test_header_has_every_colour_of_the_palette(tmp_path: Path) -> None:
    assert header_of(PALETTE, tmp_path).returncode == 0
    header = (tmp_path / "palette.hpp").read_text(encoding="utf-8")
    own = re.sub(r"^namespace \w+ \{$.*?^\}$", "", header, flags=re.MULTILINE | re.DOTALL)
    check_constants(own, {name: value for name, value in COLOURS.items() if not isinstance(value, dict)})
    for theme, colours in COLOURS.items():
        if isinstance(colours, dict):
            inner = re.search(rf"^namespace {theme} \{{$(.*?)^\}}$", header, re.MULTILINE | re.DOTALL)
            assert inner, theme
            check_constants(inner.group(1), colours)


def check_constants(header: str, colours: dict[str, Any]) -> None:
    """Check that a header, or a namespace in it, has these colours."""
    for name, value in colours.items():
        constant = "k" + "".join(word.capitalize() for word in name.split("_"))
        line = re.search(rf"^.* {constant}\b.*;$", header, re.MULTILINE)
        assert line, name
        for part in value if isinstance(value, list) else [value]:
            assert str(part).replace("#", "0xFF") in line.group(), name


@pytest.mark.parametrize("value", ['"red"', '"#12345"', '"#1234567"', '["#ffffff", "#zzzzzz"]'])
def test_what_is_no_colour_is_an_error_that_shows_it(tmp_path: Path, value: str) -> None:
    palette = tmp_path / "palette.json"
    palette.write_text(f'{{"paper": {value}}}', encoding="utf-8")
    result = header_of(palette, tmp_path)
    assert result.returncode != 0
    assert "#rrggbb" in result.stderr
    assert re.findall(r"[\w#]+", value)[-1] in result.stderr


def test_swarm_picture_uses_it() -> None:
    colours = json.loads(PALETTE.read_text(encoding="utf-8"))
    assert colours["floor"] == swarm_picture.FLOOR
    assert colours["paper"] == swarm_picture.PAPER
    assert tuple(swarm_picture.led_colours([0])[0]) == pytest.approx(swarm_picture.DARK_LED)
