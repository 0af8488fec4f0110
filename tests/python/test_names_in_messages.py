"""Names of files and keys may hold any bytes: a message that quotes them stays one line and steers no terminal."""

from __future__ import annotations

from pathlib import Path

import pytest
from running import Run, example, run, run_command

NAME = "two\nlines\x1b[2J\tand\x7fmore"
SHOWN = r"two\nlines\x1b[2J\tand\x7fmore"


def control_characters(result: Run) -> set[str]:
    return {c for c in result.text if (ord(c) < 0x20 and c != "\n") or ord(c) == 0x7F}


def helloworld(folder: Path, settings: dict[str, object]) -> Run:
    return run(example("helloworld"), folder, {"simulation_time": 0.1, **settings})


@pytest.mark.parametrize(
    "settings",
    [
        {"arena_file": NAME + ".csv"},
        {"data_filename": f"/proc/{NAME}/data.feather"},
        {"data_filename": f"/dev/null/{NAME}"},
        {"console_filename": f"/proc/{NAME}/console.txt", "enable_console_logging": True},
        {"initial_formation": "imported", "formation_filename": NAME + ".csv"},
        {"initial_formation": "imported", "formation_filename": NAME + ".feather"},
        {"boundary_condition": NAME},
        {"objects.robots.type": NAME},
        {"objects.robots.nb": NAME},
    ],
    ids=lambda settings: " ".join(settings),
)
def test_error_that_quotes_a_name_is_one_line(tmp_path: Path, settings: dict[str, object]) -> None:
    result = helloworld(tmp_path, settings)
    assert result.code == 2
    assert SHOWN in result.errors
    assert len(result.errors.splitlines()) == 1
    assert not control_characters(result)


@pytest.mark.parametrize("arguments", [["-c", NAME], ["-c", "scene.yaml", NAME], ["-c", "scene.yaml", "-s", NAME]])
def test_command_line_that_quotes_a_name_says_it_in_one_line(tmp_path: Path, arguments: list[str]) -> None:
    helloworld(tmp_path, {})
    result = run_command(example("helloworld"), tmp_path, arguments)
    assert result.code == 2
    assert SHOWN in result.errors.splitlines()[0]
    assert not control_characters(result)


def test_warning_that_quotes_a_key_is_one_line(tmp_path: Path) -> None:
    result = helloworld(tmp_path, {NAME: 1})
    assert result.code == 0
    assert SHOWN in result.errors
    assert len(result.errors.splitlines()) == 1
    assert not control_characters(result)


@pytest.mark.parametrize(
    "content", [b"", b"ARROW1", b"not a Feather file at all", b"ARROW1\0\0" + 64 * b"x" + b"ARROW1"]
)
def test_formation_that_is_no_feather_file_is_said_to_be_none(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "poses.feather").write_bytes(content)
    result = helloworld(tmp_path, {"initial_formation": "imported", "formation_filename": "poses.feather"})
    assert result.code == 2
    assert "it is not a complete Feather file (version 2, Arrow IPC)" in result.errors
