"""clang-format keeps what people have laid out by hand, in lines that fit."""

from __future__ import annotations

import subprocess
import sysconfig

from running import ROOT

# What clang-format would break: a line that is too long for it.
SENTENCE = "It reaches another robot when that robot's border is within range of the emitter, 100 mm by default. " * 2
LAID_OUT = f"""// front (0)   {SENTENCE.strip()}
//    ^
//  left (3) >
char const* text =
    "{SENTENCE}";
"""
OF_OTHERS = ROOT / "tests" / "programs" / "sdk"  # programs written by others
FOLDERS = ["bench", "docs", "examples", "include", "src", "template_prj", "tests", "tools"]


def test_drawings_and_sentences_are_not_torn() -> None:
    clang_format = f"{sysconfig.get_path('scripts')}/clang-format"
    command = [clang_format, "--style=file", "--assume-filename=src/base/drawing.cpp"]
    formatted = subprocess.run(command, input=LAID_OUT, cwd=ROOT, capture_output=True, text=True, check=True)
    assert formatted.stdout == LAID_OUT


def test_lines_of_code_have_at_most_120_columns() -> None:
    all_files = [
        path for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.suffix in {".c", ".h", ".cpp", ".hpp"}
    ]
    files = [path for path in all_files if not path.is_relative_to(OF_OTHERS)]
    assert len(files) > 100
    lines = [(path, i, line) for path in files for i, line in enumerate(path.read_text().splitlines(), 1)]
    assert [f"{path}:{i}" for path, i, line in lines if len(line) > 120] == []
