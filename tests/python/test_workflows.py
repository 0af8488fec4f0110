"""Workflows of both forges are valid, run the same scripts of ours, and name nothing that does not exist."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import pogosim
import pytest
import yaml
from pogosim.system_packages import PACKAGES
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


def jobs(file: Path) -> dict[str, dict[str, Any]]:
    """Return the jobs of a file of either forge, by name; those of GitLab have what they extend."""
    content = yaml.safe_load(file.read_text())
    if "jobs" in content:
        return dict(content["jobs"])

    def extended(name: str) -> dict[str, Any]:
        job: dict[str, Any] = content[name]
        return (extended(job["extends"]) if "extends" in job else {}) | job

    found = {name: extended(name) for name, value in content.items() if isinstance(value, dict) and name[0] != "."}
    return {name: job for name, job in found.items() if "script" in job}


def test_wheels_are_tried_on_the_same_machines_on_both_forges() -> None:
    on_github = jobs(GITHUB / "workflows" / "wheels.yml")["try"]["strategy"]["matrix"]["include"]
    on_gitlab = {name: job for name, job in jobs(GITLAB).items() if name.startswith("try_")}
    assert len(on_github) == len(on_gitlab) > 3
    (old,) = [row for row in on_github if "image" in row]
    same = [job for job in on_gitlab.values() if job.get("image") == old["image"]]
    assert [job["variables"]["PYTHON"] for job in same] == [old["python"]]
    assert old["python"] in same[0]["before_script"][0]


def installed(text: str) -> list[tuple[str, set[str]]]:
    """Return what lines of a text install, each with the command that does."""
    found = re.findall(r"(apt-get|dnf) install((?: -\S+)*)((?: [\w.+-]+)+)", text)
    return [(manager, set(names.split())) for manager, _, names in found]


def test_machines_on_which_wheels_are_tried_have_what_the_first_steps_need() -> None:
    needed = ("gcc", "g++", "make")
    # Debian's gcc only recommends the C library's headers; the image of AlmaLinux is without find.
    of_debian = {*needed, "libc6-dev", "python3-venv"}
    of_red_hat = {PACKAGES[name]["dnf install"] for name in needed} | {"findutils", "python3.12"}
    on_github = installed("\n".join(texts(jobs(GITHUB / "workflows" / "wheels.yml")["try"])))
    assert on_github == [("dnf", of_red_hat)]  # GitHub's own machines have all
    for name, job in jobs(GITLAB).items():
        if name.startswith("try_linux"):
            assert installed("\n".join(job["before_script"])) == [("apt-get", of_debian)], name
    assert installed("\n".join(jobs(GITLAB)["try_old_linux"]["before_script"])) == on_github
    (bare,) = re.findall(r"--include=(\S+)", (ROOT / "tests" / "wheel" / "bare_machine.sh").read_text())
    assert set(bare.split(",")) == of_debian | {"python3"}
    for recipe in ("Containerfile", "pogosim.def"):
        words = (ROOT / "containers" / recipe).read_text().split()
        assert of_debian - {"python3-venv"} <= set(words), recipe


def test_changes_of_what_a_wheel_is_made_of_make_and_try_wheels() -> None:
    # The schema of YAML 1.1 reads the key "on" as a truth value.
    patterns = yaml.safe_load((GITHUB / "workflows" / "wheels.yml").read_text())[True]["pull_request"]["paths"]
    copied = re.findall(r"PROJECT_SOURCE_DIR}/([\w/.]+)", (ROOT / "cmake" / "install.cmake").read_text())
    steps = re.findall(r"\.\./(\w+\.sh)", (ROOT / "tests" / "wheel" / "first_steps.sh").read_text())
    scripts = [command[0] for command in commands(GITHUB / "workflows" / "wheels.yml") if command[0][0] != "."]
    assert len(copied) > 6
    assert len(scripts) > 1
    for place in [*copied, *(f"tests/{step}" for step in steps), *scripts, "python/pogosim", "pyproject.toml"]:
        assert any(fnmatch(f"{place}/" if (ROOT / place).is_dir() else place, name) for name in patterns), place


def test_wheels_are_published_only_after_all_tries() -> None:
    assert jobs(GITHUB / "workflows" / "wheels.yml")["publish"]["needs"] == "try"
    of_gitlab = jobs(GITLAB)
    needs = [need if isinstance(need, dict) else {"job": need} for need in of_gitlab["publish"]["needs"]]
    assert {need["job"] for need in needs} == {"wheel", *(name for name in of_gitlab if name.startswith("try_"))}
    # A job whose machine not every project has is missing there; a need of it would be an error.
    optional = {need["job"] for need in needs if need.get("optional")}
    assert optional == {need["job"] for need in needs if "_RUNNER" in str(of_gitlab[need["job"]]["rules"])}


def test_wheels_of_tags_are_made_without_caches() -> None:
    prepare = [
        step["with"]["cache"]
        for step in jobs(GITHUB / "workflows" / "wheels.yml")["make"]["steps"]
        if step.get("uses") == "./.github/actions/prepare"
    ]
    assert prepare == ["${{ github.ref_type != 'tag' && format('wheel-{0}', matrix.target) || '' }}"]
    wheel = jobs(GITLAB)["wheel"]
    assert wheel["rules"][0] == {"if": "$CI_COMMIT_TAG", "variables": {"WHEEL_CACHE": "push"}}  # written, not read
    assert wheel["cache"]["policy"] == "$WHEEL_CACHE"


def test_each_job_has_a_cache_of_its_own() -> None:
    names = []
    for workflow in WORKFLOWS:
        for job in jobs(workflow).values():
            for step in job["steps"]:
                if name := step.get("with", {}).get("cache"):
                    names.append(name)
                    assert ("matrix" in job.get("strategy", {})) == ("matrix." in name), name
    assert len(set(names)) == len(names) > 4


# ---- What is published


def git(folder: Path, *words: str) -> None:
    """Run git in a folder, with a name of its own for commits."""
    identity = ["-c", "user.name=Tester", "-c", "user.email=tester@example.org"]
    subprocess.run(["git", "-C", str(folder), *identity, *words], check=True)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Return a checkout that has the script and the version; its tag is on origin/main."""
    for name in (".ci/publish", "python/pogosim/__init__.py"):
        (tmp_path / name).parent.mkdir(parents=True)
        shutil.copy(ROOT / name, tmp_path / name)
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "add", "--all")
    git(tmp_path, "commit", "--quiet", "--message", "first")
    git(tmp_path, "update-ref", "refs/remotes/origin/main", "HEAD")
    git(tmp_path, "tag", f"v{pogosim.__version__}")
    (tmp_path / "dist").mkdir()
    put_wheel(tmp_path, f"v{pogosim.__version__}")
    return tmp_path


def put_wheel(checkout: Path, made_of: str | None, platform: str = "manylinux_2_28_x86_64") -> None:
    """Put a wheel into dist that says of which commit it is made, or does not."""
    name = f"pogobot_simulator-{pogosim.__version__}-py3-none-{platform}.whl"
    with zipfile.ZipFile(checkout / "dist" / name, "w") as wheel:
        wheel.writestr("pogosim/__init__.py", "")
        if made_of:
            wheel.writestr("pogosim/simulator/lib/libpogosim.commit", f"{made_of}\n")


def published(checkout: Path, tag: str = f"v{pogosim.__version__}") -> tuple[int, str]:
    """Check the wheels in dist as before they are published; returns exit code and message."""
    command = [str(checkout / ".ci" / "publish"), "--check", tag, str(checkout / "dist")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stderr.count("\n") == (done.returncode != 0)
    return done.returncode, done.stderr


def test_only_wheels_of_the_tagged_version_are_published(checkout: Path) -> None:
    assert published(checkout) == (0, "")
    code, message = published(checkout, "v0.0.1")
    assert code == 2
    assert f"tag v{pogosim.__version__}" in message
    (checkout / "dist" / "pogobot_simulator-0.0.1-py3-none-any.whl").touch()
    code, message = published(checkout)
    assert code == 2
    assert "is not of version" in message
    for wheel in (checkout / "dist").iterdir():
        wheel.unlink()
    code, message = published(checkout)
    assert code == 2
    assert "no wheels" in message


def test_only_tags_on_main_are_published(checkout: Path) -> None:
    tag = f"v{pogosim.__version__}"
    git(checkout, "commit", "--quiet", "--allow-empty", "--message", "of a branch")
    assert published(checkout) == (0, "")  # the tag counts, not what is checked out
    git(checkout, "tag", "--force", tag)
    code, message = published(checkout)
    assert code == 2
    assert f"the tag {tag} is not on origin/main" in message
    git(checkout, "tag", "--delete", tag)
    code, message = published(checkout)
    assert code == 2
    assert f"there is no tag {tag}" in message


def described(checkout: Path) -> str:
    """Return what the build records of a checkout (cmake/commit.cmake)."""
    command = ["git", "-C", str(checkout), "describe", "--always", "--tags", "--dirty"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def test_only_wheels_of_the_commit_of_the_tag_are_published(checkout: Path) -> None:
    tag = f"v{pogosim.__version__}"
    assert described(checkout) == tag
    git(checkout, "tag", "--delete", tag)
    first = described(checkout)  # made before the tag: its hash
    git(checkout, "commit", "--quiet", "--allow-empty", "--message", "second")
    second = described(checkout)
    git(checkout, "tag", tag, first)
    third = described(checkout)
    assert third == f"{tag}-1-g{second}"
    put_wheel(checkout, first, "manylinux_2_28_aarch64")
    assert published(checkout) == (0, "")
    for made_of in (second, third, f"{first}-dirty", f"{tag}-dirty", "unknown", None):
        put_wheel(checkout, made_of, "manylinux_2_28_aarch64")
        code, message = published(checkout)
        assert code == 2
        assert f"aarch64.whl is made of the commit {made_of or 'unknown'}, expected that of {tag}: " in message


def test_file_that_is_no_wheel_is_not_published(checkout: Path) -> None:
    (wheel,) = (checkout / "dist").iterdir()
    wheel.write_text("a page of errors")
    code, message = published(checkout)
    assert code == 2
    assert "the commit unknown" in message


def test_tools_that_publish_are_pinned() -> None:
    requirements = (ROOT / ".ci" / "publish_requirements.txt").read_text().replace("\\\n", "")
    lines = [line for line in requirements.splitlines() if line and not line.startswith("#")]
    assert [line for line in lines if not re.match(r"[\w-]+==[\w.]+ .*--hash=sha256:[0-9a-f]{64}", line)] == []
    assert any(line.startswith("twine==") for line in lines)
    assert "--require-hashes" in (ROOT / ".ci" / "publish").read_text()
    tools = re.findall(r"\b(auditwheel|ziglang)(\S*)", (ROOT / "scripts" / "bootstrap.sh").read_text())
    assert {name for name, version in tools if re.fullmatch(r"==[\d.]+", version)} == {"auditwheel", "ziglang"}
