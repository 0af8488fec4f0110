"""Comments, docstrings, messages and pages keep to plain English: what CONTRIBUTING.md bans is found here."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest
from running import ROOT
from tracked import tracked

# What a sentence must not have, and what to write instead.
BANS = [
    (re.compile(r"(?:^|[.:;!?]\s+)Of (?!course\b)"), "a sentence begins with 'Of': name the thing first"),
    (
        re.compile(r"\b(?:some|no|any|every)body\b|\bwho(?:m)?ever\b", re.IGNORECASE),
        "name the thing: a robot, a thread",
    ),
    (
        re.compile(r"\bthose of (?:that|this|these|those|it|them|the one|the ones)\b"),
        "name the thing instead of 'those'",
    ),
]
# British spelling; names (in backticks, quotes, links; options, classes, attributes) are as they are.
AMERICAN = re.compile(
    r"(?<![\w./-])(?<!## )(?:colors?|colored|centered|behaviors?|neighbors?|neighborhoods?"
    r"|grays?|(?:milli|kilo)?meters?|modeling|labeled|traveled|canceled|optimizers?"
    r"|(?:normal|random|initial|serial|visual|minim|maxim|recogn|summar|synchron|organ)iz(?:e|es|ed|ing|ation))"
    r"\b(?![\w./(=:]|-by)",
    re.IGNORECASE,
)
NAMES = re.compile(r"`[^`]*`|\"[^\"]*\"|\]\([^)]*\)")
# In code, persons are not what comments are about; in pages, they may be.
PERSONS = (re.compile(r"\b(?:who|whom|he|she|him|his|her)\b", re.IGNORECASE), "'that' or 'which' for things")
PEOPLE = re.compile(
    r"\b(?:users?|people|persons?|researchers?|students?|colleagues?|readers?|those|one|developers?) who\b"
)

QUOTED = re.compile(r'"[^"\n]{0,80}"')  # what robots say, and names

C_LIKE = {".c", ".h", ".cpp", ".hpp"}
# A comment, or a literal: in a text, neither begins another one.
TOKEN = re.compile(
    r"""(?P<line>//[^\n]*)|(?P<block>/\*.*?\*/)|R"\((?P<raw>.*?)\)"|"(?P<text>(?:\\.|[^"\\\n])*)"|'(?:\\.|[^'\\\n])'""",
    re.DOTALL,
)

Passage = tuple[int, str]  # line, and the text of a comment, a docstring, a message or a paragraph


def joined(lines: list[Passage]) -> Iterator[Passage]:
    """Join comments of consecutive lines: sentences run on."""
    for index, (line, text) in enumerate(lines):
        if index > 0 and line == lines[index - 1][0] + 1:
            continue
        parts = [text]
        for other, (next_line, next_text) in enumerate(lines[index + 1 :]):
            if next_line != line + other + 1:
                break
            parts.append(next_text)
        yield line, "\n".join(parts)


def passages_of_c(text: str, literals: bool) -> Iterator[Passage]:
    """Yield comments, and, on request, literals that are sentences."""
    comments: list[Passage] = []
    for token in TOKEN.finditer(text):
        line = text.count("\n", 0, token.start()) + 1
        if token["line"] is not None:
            comments.append((line, token["line"].lstrip("/").strip()))
        elif token["block"] is not None:
            yield line, token["block"]
        elif literals and (literal := token["raw"] or token["text"]) and " " in literal:
            yield line, literal
    yield from joined(comments)


def passages_of_python(text: str, literals: bool) -> Iterator[Passage]:
    """Yield comments, docstrings, and, on request, other literals that are sentences."""
    comments = [
        (token.start[0], token.string.lstrip("#").strip())
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type == tokenize.COMMENT
    ]
    yield from joined(comments)
    tree = ast.parse(text)
    if literals:
        nodes = [node for node in ast.walk(tree) if isinstance(node, ast.Constant)]
    else:
        statements = [node for node in ast.walk(tree) if isinstance(node, ast.Expr)]
        nodes = [node.value for node in statements if isinstance(node.value, ast.Constant)]
    for node in nodes:
        if isinstance(node.value, str) and " " in node.value:
            yield node.lineno, node.value


def passages_of_page(text: str, literals: bool) -> Iterator[Passage]:  # noqa: ARG001
    """Yield the lines of a page, without its blocks of code."""
    is_code = False
    for number, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("```"):
            is_code = not is_code
        elif not is_code:
            yield number, re.sub(r"`[^`]*`", "`code`", line)


def found_in(file: Path) -> list[str]:
    """Return what is banned in a file, one line each."""
    text = file.read_text(encoding="utf-8")
    is_page = file.suffix == ".md"
    passages = passages_of_page if is_page else passages_of_python if file.suffix == ".py" else passages_of_c
    is_test = "tests" in file.relative_to(ROOT).parts  # its literals are inputs
    found = []
    for line, passage in passages(text, not is_test):
        without_people = PEOPLE.sub("people", QUOTED.sub('""', passage))
        for ban, remedy in BANS if is_page else [*BANS, PERSONS]:
            for match in ban.finditer(without_people):
                at = line + without_people.count("\n", 0, match.start())
                found.append(f"{file.relative_to(ROOT)}:{at}: {match[0].strip()!r}: {remedy}")
        for match in AMERICAN.finditer(NAMES.sub('""', passage)):
            found.append(f"{file.relative_to(ROOT)}:{line}: {match[0]!r}: British spelling")
    return found


def sources(folder: str) -> list[Path]:
    return [file for file in tracked(*C_LIKE, ".py", ".md") if file.relative_to(ROOT).parts[0] == folder]


FOLDERS = ["src", "include", "python", "docs", "examples", "bench", "tools", "scripts", "cmake", "template_prj"]


@pytest.mark.parametrize("folder", FOLDERS)
def test_english_is_plain(folder: str) -> None:
    found = [line for file in sources(folder) for line in found_in(file)]
    assert not found, "\n".join(found)


def test_english_of_the_first_pages_and_of_the_tests_is_plain() -> None:
    first = [ROOT / name for name in ("README.md", "CONTRIBUTING.md")]
    tests = [
        file for file in sources("tests") if file != Path(__file__) and "sdk" not in file.parts
    ]  # written by others
    found = [line for file in [*first, *tests] for line in found_in(file)]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.cpp", "// Of the bodies.\nint a;\n"),
        ("a.cpp", "int a;  // nobody asks\n"),
        ("a.cpp", "// A body\n// who moves.\n"),
        ("a.cpp", 'warn("somebody moved");\n'),
        ("a.cpp", "/// It ends. Of all bodies.\n"),
        ("a.py", '"""Whoever calls."""\n'),
        ("a.py", "x = 1  # he is first\n"),
        ("a.md", "The seeds and those of that run.\n"),
        ("a.md", "Both optimizers find it.\n"),
        ("a.cpp", "// The color of a lamp.\n"),
    ],
)
def test_what_is_banned_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, text: str) -> None:
    monkeypatch.setitem(globals(), "ROOT", tmp_path)
    (tmp_path / name).write_text(text)
    assert len(found_in(tmp_path / name)) == 1


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.cpp", '// A list of bodies, for each of them.\nchar const* a = "http://x";  // of the bodies\n'),
        ("a.py", "x = 'nobody'  # a name, not a sentence\n"),
        ("a.py", "x = 1  # `color`, --color-by, ax.color and optimizer: are names\n"),
        ("a.md", "Users who know C.\n```c\n// nobody\n```\nOf course `nobody` may.\n"),
    ],
)
def test_other_text_passes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, text: str) -> None:
    monkeypatch.setitem(globals(), "ROOT", tmp_path)
    (tmp_path / name).write_text(text)
    assert found_in(tmp_path / name) == []
