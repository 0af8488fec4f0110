"""Whatever a file, a configuration or a command line says, the tools print lines that steer no terminal."""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
import unicodedata
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from pogosim.lines import LONGEST, printable
from running import ROOT, example

PACKAGE = ROOT / "python" / "pogosim"
# Colours, a carriage return, a control character of Latin-1, marks of direction, a line break, and no UTF-8.
NAME = os.fsdecode(b"a\x1b[31m\r\xc2\x9b\xe2\x80\xaeb\xe2\x81\xa6\n\xff")
SHOWN = r"a\x1b[31m\r\x9b\u202eb\u2066\n\udcff"
CLEAR = "\x1b[2J"


def write_files(folder: Path) -> None:
    """Write files with such names in columns, categories, cells and configurations."""
    rows = pd.DataFrame(
        {
            "time": np.repeat([0.0, 1.0, 2.0], 2),
            "robot_category": f"r{CLEAR}\nx",
            "robot_id": [0, 1] * 3,
            "x": [100.0, 200.0] * 3,
            "y": [100.0, 200.0] * 3,
            "angle": [0.0, 1.0] * 3,
        }
    )
    rows.attrs["program_version"] = "v0.11.0"
    rows.to_feather(folder / "data.feather")
    rows.rename(columns={"x": f"x{CLEAR}"}).to_feather(folder / "columns.feather")
    rows.rename(columns={"x": f"x{CLEAR}"}).to_csv(folder / "tracks.csv")
    measured = "payload_size,nb_neighbors,p_send,success_probability"
    (folder / "columns.csv").write_text(f"{measured}{CLEAR}\n1,2,3,4\n")
    (folder / "cells.csv").write_text(f"{measured}\n1,2,{CLEAR}x,4\n")
    (folder / "arena.csv").write_text(f"0,0\n1,{CLEAR}\n")
    robots = "objects: {robots: {type: pogobot, nb: 3}}\narena_file: arenas/disk.csv\n"
    for name, line in {
        "options": r'nb: {batch_options: "\e[2J"}',
        "format": r'result_filename_format: "\e[2J{foo\n}"',
        "columns": r'result_new_columns: ["\e[2J"]',
        "search": r'optimization: {"\e[2J": 3, algorithm: "\e[31m"}',
        "domain": r'nb: {optimization_domain: {type: "\e[2J"}}',
        "arena": r'arena_file: "\e[2J\n.csv"',
    }.items():
        (folder / f"{name}.yaml").write_text(f"{robots}{line}\n".replace("arena_file: arenas/disk.csv\narena", "arena"))


COMMANDS = [
    [NAME],
    ["picture", "data.feather", NAME],
    ["picture", NAME, "out.png"],
    ["picture", "data.feather", "out.png", "--color-by", NAME],
    ["picture", "columns.feather", "out.png"],
    ["picture", "data.feather", f"{NAME}.png", "--color-by", "robot_category"],
    ["film", "data.feather", "-o", f"{NAME}.gif", "--fps", "2", "--color-by", "robot_category"],
    ["film", "data.feather", "-o", f"{NAME}.html"],
    ["film", "data.feather", "-o", NAME],
    ["report", NAME, "-o", "out.html"],
    ["report", "data.feather", "-o", f"{NAME}.html", "--title", NAME],
    ["report", "data.feather", "-o", "out.html", "--category", NAME],
    ["report", "columns.feather", "-o", "out.html"],
    ["compare", NAME, "data.feather"],
    ["compare", "data.feather", "columns.feather"],
    ["compare", "data.feather", "columns.feather", "--json"],
    ["compare", "data.feather", "columns.feather", "--category", NAME],
    ["analyze", NAME],
    ["analyze", "locomotion", "-i", NAME],
    ["analyze", "locomotion", "-i", "data.feather", "--category", NAME],
    ["analyze", "network", "-i", "columns.feather"],
    ["analyze", "arena", "-i", "data.feather", "-c", "arena.yaml"],
    ["fit-comm", "columns.csv"],
    ["fit-comm", "cells.csv"],
    ["fit-comm", "--fix", NAME],
    ["calibrate", "tracks.csv", "-c", "format.yaml"],
    ["calibrate", "data.feather", "-c", "format.yaml"],
    ["calibrate", "--protocol", NAME],
    ["arena", "show", "arena.csv"],
    ["arena", "show", NAME],
    *(["batch", "-S", "PROGRAM", "-c", f"{name}.yaml"] for name in ("options", "format", "columns")),
    ["batch", "-S", "PROGRAM", "-c", NAME],
    ["batch", "-S", NAME, "-c", "format.yaml"],
    ["batch", "-S", "PROGRAM", "-c", "search.yaml", "--only-output", NAME],
    *(["optimize", "-S", "PROGRAM", "-c", f"{name}.yaml"] for name in ("search", "domain")),
    ["optimize", "-S", "PROGRAM", "-c", "domain.yaml", "--optimizer", NAME],
    ["recover", NAME],
    ["new", NAME],
    ["run", NAME],
    ["best-psend", "-c", NAME, "-m", "3"],
]


# Runs commands one after another, as many processes would import the same modules again; each says its lines in a file.
ALL = """
import json, os, sys, traceback
from pogosim.command.main import main
for number, words in enumerate(json.loads(sys.stdin.read())):
    with open(f"said{number}", "wb") as said:
        os.dup2(said.fileno(), 1)
        os.dup2(said.fileno(), 2)
    try:
        main(words)
    except SystemExit:
        pass
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
"""


def test_lines_of_all_tools_steer_no_terminal(tmp_path: Path) -> None:
    write_files(tmp_path)
    commands = [[str(example("helloworld")) if word == "PROGRAM" else word for word in words] for words in COMMANDS]
    process = [sys.executable, "-c", ALL]
    subprocess.run(process, input=json.dumps(commands), cwd=tmp_path, text=True, check=True, timeout=600)
    for number, (command, words) in enumerate(zip(COMMANDS, commands, strict=True)):
        said = (tmp_path / f"said{number}").read_bytes().decode()
        assert said.strip() or words[0] == "picture", words
        assert "Warning" not in said, (words, said)
        strange = {c for c in said if c != "\n" and unicodedata.category(c) in ("Cc", "Cf", "Cs", "Zl", "Zp")}
        assert strange == set(), (words, said)
        assert "Traceback" not in said, (words, said)
        is_quoted = NAME in command and command[:2] != ["batch", "-S"]
        assert SHOWN in said or not is_quoted, (words, said)


def test_line_is_printable_and_keeps_what_is_printable() -> None:
    assert printable("caf\u00e9, 5\u00a0mm, \u4e2d\u6587") == "caf\u00e9, 5\u00a0mm, \u4e2d\u6587"
    assert printable(NAME) == SHOWN
    assert printable("\u2028\u200f\ufeff\x7f\t") == r"\u2028\u200f\ufeff\x7f\t"
    assert printable("x" * (LONGEST + 7)) == "x" * LONGEST + "... and 7 more characters"
    assert printable("x" * LONGEST) == "x" * LONGEST


@pytest.mark.parametrize("file", sorted(PACKAGE.rglob("*.py")), ids=lambda file: str(file.relative_to(PACKAGE)))
def test_only_one_file_prints(file: Path) -> None:
    if file == PACKAGE / "lines.py":
        return
    tree = ast.parse(file.read_text())
    calls = [node.func for node in ast.walk(tree) if isinstance(node, ast.Call)]
    assert [call for call in calls if isinstance(call, ast.Name) and call.id == "print"] == []
    names = {call.attr for call in calls if isinstance(call, ast.Attribute)}
    assert not names & {"Formatter", "print_exc"}
    assert not re.search(r"sys\.std(out|err)\.write", file.read_text())
