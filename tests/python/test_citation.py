"""CITATION.cff is what forges and reference managers read, and says what the project says of itself."""

from __future__ import annotations

import re
from pathlib import Path

import pogosim
import pytest
import yaml
from running import ROOT
from schemas import mistakes

CITATION = ROOT / "CITATION.cff"
SCHEMA = "vendor.citation-file-format"


def test_citation_file_is_valid() -> None:
    assert mistakes(CITATION, SCHEMA) == ""


@pytest.mark.parametrize("line", ["title: Pogosim\n", "license: MIT\n"])
def test_check_of_the_citation_file_finds_mistakes(line: str, tmp_path: Path) -> None:
    (tmp_path / "CITATION.cff").write_text(CITATION.read_text().replace(line, line.replace(": ", "s: ")))
    assert mistakes(tmp_path / "CITATION.cff", SCHEMA)


def test_citation_names_version_licence_and_authors_of_the_project() -> None:
    citation = yaml.safe_load(CITATION.read_text())
    project = (ROOT / "pyproject.toml").read_text()
    assert citation["version"] == pogosim.__version__
    assert f'license = "{citation["license"]}"' in project
    (keywords,) = re.findall(r"^keywords = (\[.*?\])$", project, re.MULTILINE | re.DOTALL)
    assert yaml.safe_load(keywords) == citation["keywords"]
    assert f'authors = [{{ name = "{citation["authors"][0]["name"]}" }}]' in project


def test_citation_refers_to_the_article_as_the_readme_does() -> None:
    article = yaml.safe_load(CITATION.read_text())["preferred-citation"]
    readme = (ROOT / "README.md").read_text()
    assert article["title"] in readme
    assert all(author["family-names"] in readme for author in article["authors"])
