"""Workflows of both forges are valid, run the same scripts of ours, and name nothing that does not exist."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from running import ROOT
from schemas import mistakes

GITHUB = ROOT / ".github"
GITLAB = ROOT / ".gitlab-ci.yml"
WORKFLOWS = sorted((GITHUB / "workflows").glob("*.yml"))
ACTIONS = sorted((GITHUB / "actions").glob("*/action.yml"))
SCHEMAS = [
    *(
        (path, schema)
        for path in WORKFLOWS
        for schema in ("vendor.github-workflows", "custom.github-workflows-require-timeout")
    ),
    *((path, "vendor.github-actions") for path in ACTIONS),
    (GITHUB / "dependabot.yml", "vendor.dependabot"),
    (GITLAB, "vendor.gitlab-ci"),
]
SCRIPT = re.compile(r"(?<![\w./-])(?:\./|\.ci/|scripts/|tests/)[\w./-]+")
TABLE = ROOT / "tests" / "distributions" / "table.txt"


def zizmor(folder: Path) -> subprocess.CompletedProcess[str]:
    """Look for what makes workflows unsafe: rights, versions of actions, texts of others that become commands."""
    program = shutil.which("zizmor", path=os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]]))
    assert program, "./test.sh installs zizmor"
    return subprocess.run([program, "--offline", "--quiet", str(folder)], capture_output=True, text=True, check=False)


@pytest.mark.parametrize(("file", "schema"), SCHEMAS, ids=lambda value: getattr(value, "name", value))
def test_file_is_valid(file: Path, schema: str) -> None:
    assert mistakes(file, schema) == ""


def test_workflows_are_safe() -> None:
    done = zizmor(GITHUB)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize(
    ("line", "other"),
    [
        ("runs-on: ubuntu-24.04", "run-on: ubuntu-24.04"),
        ("timeout-minutes: 180", "timeout-minutes: long"),
        ("pull_request:", "pull_requests:"),
    ],
)
def test_schema_finds_mistakes_of_workflows(line: str, other: str, tmp_path: Path) -> None:
    text = (GITHUB / "workflows" / "tests.yml").read_text()
    assert line in text
    (tmp_path / "tests.yml").write_text(text.replace(line, other, 1))
    assert mistakes(tmp_path / "tests.yml", "vendor.github-workflows")


def test_schema_finds_mistakes_of_gitlab_jobs(tmp_path: Path) -> None:
    (tmp_path / "jobs.yml").write_text(
        GITLAB.read_text().replace("    script: ./test.sh\n", "    scripts: ./test.sh\n", 1)
    )
    assert mistakes(tmp_path / "jobs.yml", "vendor.gitlab-ci")


@pytest.mark.parametrize(
    ("line", "other"),
    [
        ("contents: read", "contents: write"),
        ("actions/checkout@v6", "others/checkout@v6"),
        ("run: ./test.sh --quick", "run: echo ${{ github.head_ref }}"),
    ],
)
def test_what_makes_workflows_unsafe_is_found(line: str, other: str, tmp_path: Path) -> None:
    shutil.copytree(GITHUB, tmp_path / ".github")
    workflow = tmp_path / ".github" / "workflows" / "tests.yml"
    assert line in workflow.read_text()
    workflow.write_text(workflow.read_text().replace(line, other))
    assert zizmor(tmp_path / ".github").returncode != 0


def test_actionlint_of_the_weekly_job_is_that_of_contributors() -> None:
    named = [
        re.findall(r"go run (\S+actionlint@v[\d.]+)", path.read_text())
        for path in (GITHUB / "workflows" / "weekly.yml", ROOT / "CONTRIBUTING.md")
    ]
    assert named[0] == named[1] != []


def texts(node: Any) -> Iterator[str]:
    """Yield all texts of a YAML file."""
    if isinstance(node, dict):
        for value in node.values():
            yield from texts(value)
    elif isinstance(node, list):
        for value in node:
            yield from texts(value)
    elif isinstance(node, str):
        yield node


def commands(*files: Path) -> set[tuple[str, ...]]:
    """Return our scripts that files run, each with its options; values of options and arguments are left out."""
    found = set()
    for file in files:
        for text in texts(yaml.safe_load(file.read_text())):
            for line in text.splitlines():
                for match in SCRIPT.finditer(line):
                    if "*" in line[match.end() : match.end() + 1] or line[match.end() - 1] == "/":
                        continue  # names of files that change
                    words = shlex.split(re.split(r"&&|;|\|", line[match.start() :])[0], comments=True)
                    found.add((words[0], *(word for word in words[1:] if word.startswith("-"))))
    return {command for command in found if command[0] != "./.github/actions/prepare"}


def test_both_forges_run_the_same_scripts() -> None:
    of_github = commands(*WORKFLOWS)
    assert of_github == commands(GITLAB)
    assert len(of_github) > 8


@pytest.mark.parametrize("command", sorted(commands(*WORKFLOWS, GITLAB)), ids=" ".join)
def test_script_exists_and_has_the_options(command: tuple[str, ...]) -> None:
    script = ROOT / command[0]
    assert script.is_file(), f"{command[0]} does not exist"
    if script.suffix == ".ps1":
        return
    assert os.access(script, os.X_OK), f"{command[0]} is not executable"
    if options := command[1:]:
        done = subprocess.run([str(script), "--help"], capture_output=True, text=True, check=False)
        assert done.returncode == 0
        assert [option for option in options if not re.search(rf"(?<![\w-]){option}(?![\w-])", done.stdout)] == []


def matrix(file: Path, key: str) -> list[str]:
    """Return the values that a list of this name has in a file."""

    def lists(node: Any) -> Iterator[list[str]]:
        if isinstance(node, dict):
            for name, value in node.items():
                if name == key and isinstance(value, list):
                    yield value
                yield from lists(value)
        elif isinstance(node, list):
            for value in node:
                yield from lists(value)

    first, *others = lists(yaml.safe_load(file.read_text()))
    assert all(other == first for other in others)
    return first


def test_weekly_machines_are_those_of_the_table() -> None:
    names = re.findall(r"^([a-z]\S+) ", TABLE.read_text(), re.MULTILINE)
    assert len(names) > 3
    assert matrix(GITHUB / "workflows" / "weekly.yml", "name") == names
    assert matrix(GITLAB, "NAME") == names


def test_images_are_distributions_of_the_table() -> None:
    images = matrix(GITHUB / "workflows" / "tests.yml", "image")
    assert images == matrix(GITLAB, "IMAGE")
    assert set(images) <= {name.replace("-", ":", 1) for name in matrix(GITLAB, "NAME")}


def test_wheels_are_for_the_same_machines_on_both_forges() -> None:
    sys.path.insert(0, str(ROOT / "scripts"))
    from cross.dependencies import TARGETS

    targets = matrix(GITHUB / "workflows" / "wheels.yml", "target")
    assert targets == matrix(GITLAB, "TARGET")
    assert set(targets) <= set(TARGETS)


def published(folder: Path, tag: str, *wheels: str) -> tuple[int, str]:
    """Check wheels as before they are published; returns exit code and message."""
    for wheel in wheels:
        (folder / wheel).touch()
    command = [str(ROOT / ".ci" / "publish"), "--check", tag, str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


def test_only_wheels_of_the_tagged_version_are_published(tmp_path: Path) -> None:
    import pogosim

    version = pogosim.__version__
    wheel = f"pogobot_simulator-{version}-py3-none-manylinux_2_28_x86_64.whl"
    code, message = published(tmp_path, f"v{version}")
    assert code == 2
    assert "no wheels" in message
    assert published(tmp_path, f"v{version}", wheel) == (0, "")
    code, message = published(tmp_path, "v0.0.1")
    assert (code, message.count("\n")) == (2, 1)
    assert f"tag v{version}" in message
    code, message = published(tmp_path, f"v{version}", "pogobot_simulator-0.0.1-py3-none-any.whl")
    assert (code, message.count("\n")) == (2, 1)
    assert "is not of version" in message
