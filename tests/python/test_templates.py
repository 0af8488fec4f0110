"""Both forges ask for the same in issues and changes, and in words that lead somewhere."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from running import ROOT
from schemas import mistakes

ISSUES = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.md"))
OTHER_ISSUES = ROOT / ".gitlab" / "issue_templates"
CHANGES = (ROOT / ".github" / "pull_request_template.md", ROOT / ".gitlab" / "merge_request_templates" / "Default.md")


def parts(template: Path) -> tuple[dict[str, str], str]:
    """Return what GitHub shows of a template in its list, and its text."""
    _, head, text = template.read_text().split("---\n", 2)
    return yaml.safe_load(head), text.lstrip("\n")


def test_there_is_a_template_for_each_kind_of_issue() -> None:
    assert [path.name for path in ISSUES] == ["bug.md", "feature.md", "robot.md"]
    assert sorted(path.name for path in OTHER_ISSUES.iterdir()) == [path.name for path in ISSUES]


@pytest.mark.parametrize("template", ISSUES, ids=lambda path: path.stem)
def test_issue_has_the_same_template_on_both_forges(template: Path) -> None:
    shown, text = parts(template)
    assert set(shown) == {"name", "about", "labels"}
    assert (OTHER_ISSUES / template.name).read_text() == text
    assert len(text.splitlines()) < 20


def test_change_has_the_same_template_on_both_forges() -> None:
    of_github, of_gitlab = (path.read_text() for path in CHANGES)
    assert of_github == of_gitlab


@pytest.mark.parametrize("template", [*ISSUES, CHANGES[0]], ids=lambda path: path.stem)
def test_what_templates_name_exists(template: Path) -> None:
    text = template.read_text()
    files = re.findall(r"(?<![\w/])(?:docs/)?\w+\.md\b", text)
    assert [file for file in files if not (ROOT / file).exists()] == []
    for word in re.findall(r"`pogosim ([a-z-]+)`", text):
        words = [word] if word.startswith("-") else [word, "--help"]
        done = subprocess.run([sys.executable, "-m", "pogosim", *words], capture_output=True, check=False)
        assert done.returncode == 0, words


def test_settings_of_issues_are_valid() -> None:
    assert mistakes(ROOT / ".github" / "ISSUE_TEMPLATE" / "config.yml", "vendor.github-issue-config") == ""
