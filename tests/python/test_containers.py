"""Containers and modules are made for this version, from the same packages, and as their page says."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pogosim
import pytest
from packaging.requirements import Requirement
from running import ROOT, ran

CONTAINERFILE = ROOT / "containers" / "Containerfile"
DEFINITION = ROOT / "containers" / "pogosim.def"
MODULES = ROOT / "modules"
PAGE = ROOT / "docs" / "clusters.md"


def text(file: Path) -> str:
    """Return what a file says, with lines that go on joined."""
    return re.sub(r"\\\n\s*", "", file.read_text(encoding="utf-8"))


def instructions() -> list[tuple[str, str]]:
    """Return the instructions of the Containerfile, each with its words."""
    lines = [line for line in text(CONTAINERFILE).splitlines() if line and not line.startswith("#")]
    return [(line.partition(" ")[0], line.partition(" ")[2]) for line in lines]


def arguments() -> dict[str, dict[str, str]]:
    """Return the arguments that builds take, with their defaults, by file."""
    of_the_image: dict[str, str] = {}
    for name, words in instructions():
        if name == "ARG":
            of_the_image.setdefault(words.partition("=")[0], words.partition("=")[2])  # later stages only name them
    (section,) = re.findall(r"^%arguments\n((?:    .*\n)+)", DEFINITION.read_text(), re.MULTILINE)
    return {"image": of_the_image, "definition": dict(re.findall(r"^    (\w+)=(.*)$", section, re.MULTILINE))}


def optional_packages() -> set[str]:
    """Return the names of the project's optional packages."""
    section = (ROOT / "pyproject.toml").read_text().partition("[project.optional-dependencies]")[2].partition("\n[")[0]
    return set(re.findall(r"^(\w+) = \[", section, re.MULTILINE))


def apt_packages(file: Path) -> set[str]:
    """Return what is installed of the distribution."""
    found = re.findall(r"apt-get install -y --no-install-recommends ([^&\n]*)", text(file))
    return {word for words in found for word in words.split()}


def removed(line: str) -> set[str]:
    """Return the files below the folder of packages that a line of a shell script removes."""
    return {word.removeprefix('"$packages"/') for word in line.split() if word.startswith('"$packages"/')}


def expanded(word: str) -> set[str]:
    """Return what a word with one {list,of,words} stands for."""
    start, words, end = re.fullmatch(r"(.*)\{(.*)\}(.*)", word).groups()  # type: ignore[union-attr]
    return {f"{start}{middle}{end}" for middle in words.split(",")}


def test_both_are_made_for_this_version() -> None:
    versions = [words for name, words in instructions() if name == "ARG" and words.startswith("VERSION")]
    assert versions == [f"VERSION={pogosim.__version__}"] * 2  # one for each stage
    assert arguments()["definition"]["VERSION"] == pogosim.__version__


def test_module_of_easybuild_is_of_this_version() -> None:
    (recipe,) = MODULES.glob("*.eb")
    values = dict(re.findall(r"^(\w+) = '(.*)'", recipe.read_text(), re.MULTILINE))
    toolchain = re.search(r"^toolchain = \{'name': '(.*)', 'version': '(.*)'\}", recipe.read_text(), re.MULTILINE)
    assert toolchain
    assert recipe.name == f"{values['name']}-{values['version']}-{toolchain[1]}-{toolchain[2]}.eb"
    assert values["version"] == pogosim.__version__
    assert f"/pogosim/{pogosim.__version__}" in (MODULES / "pogosim.tcl").read_text()


def test_module_of_easybuild_has_the_arrow_that_wheels_are_built_with() -> None:
    sys.path.insert(0, str(ROOT / "scripts"))
    from cross.dependencies import PYARROW

    (recipe,) = MODULES.glob("*.eb")
    (version,) = re.findall(r"^    \('pyarrow', '([\d.]+)', \{$", recipe.read_text(), re.MULTILINE)
    required = Requirement(PYARROW)
    assert required.name == "pyarrow"
    assert version in required.specifier
    assert set(re.findall(r"'pyarrow-([\d.]+)-", recipe.read_text())) == {version}


def test_wheel_is_the_one_that_the_project_makes() -> None:
    (name,) = re.findall(r'^name = "([\w-]+)"', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)
    for file in (CONTAINERFILE, DEFINITION, *MODULES.iterdir()):
        assert set(re.findall(r"\b(pogo\w+)-.*\.whl", file.read_text())) == {name.replace("-", "_")}, file


def test_both_take_the_same_arguments_with_the_same_defaults() -> None:
    image, definition = arguments().values()
    assert definition.keys() - image.keys() == {"BOOTSTRAP", "WHEELS"}
    assert image["BASE"] == f"docker.io/library/{definition['BASE']}"
    assert image["EXTRAS"] == definition["EXTRAS"]
    assert (image["PIP_NO_INDEX"], definition["PIP_NO_INDEX"]) == ("", "0")


def test_both_hold_the_same_packages() -> None:
    assert apt_packages(CONTAINERFILE) == apt_packages(DEFINITION)
    assert {"gcc", "g++", "make", "libc6-dev", "python3"} <= apt_packages(CONTAINERFILE)


def test_both_leave_out_what_a_checkout_leaves_out() -> None:
    trimmed = re.search(r"^trim_venv\(\) \{\n.*?^\}", text(ROOT / "scripts" / "bootstrap.sh"), re.MULTILINE | re.DOTALL)
    assert trimmed
    expected = {name for word in removed(trimmed[0]) for name in expanded(word)}
    assert "pandas/tests" in expected
    for file in (CONTAINERFILE, DEFINITION):
        assert {name for line in text(file).splitlines() for name in removed(line)} == expected, file


@pytest.mark.parametrize("file", [CONTAINERFILE, DEFINITION, PAGE], ids=lambda file: file.name)
def test_optional_packages_that_are_named_exist(file: Path) -> None:
    named = re.findall(r"^ *(?:ARG )?EXTRAS=([\w,]+)|EXTRAS=([\w,]+)`", file.read_text(), re.MULTILINE)
    listed = re.findall(
        r"installing\.md(?:#optional-packages\))?: (.*?)\. ?(?:Default|$)", file.read_text(), re.MULTILINE
    )
    words = {word for pair in named for extra in pair for word in extra.split(",") if extra}
    words |= set(re.findall(r"\w+", " ".join(listed)))
    assert len(words) > 1
    assert words <= optional_packages()


def test_image_runs_as_a_user_who_is_not_root() -> None:
    assert [words for name, words in instructions() if name == "USER"] == ["1000"]
    assert "useradd" in text(CONTAINERFILE).partition("USER 1000")[0]


def test_lists_of_packages_do_not_stay_in_the_layers_that_fetched_them() -> None:
    fetching = [words for name, words in instructions() if name == "RUN" and "apt-get update" in words]
    assert len(fetching) == 2
    assert all("rm -rf /var/lib/apt/lists/*" in words for words in fetching)


def test_labels_are_those_of_the_specification_and_the_same_in_both() -> None:
    known = {"title", "description", "version", "licenses"}
    same = known - {"version"}
    pattern = r"org\.opencontainers\.image\.([\w.]+)[= ]\"?([^\"\n]*)\"?"
    (label,) = (words for name, words in instructions() if name == "LABEL")
    image = dict(re.findall(r'org\.opencontainers\.image\.([\w.]+)="([^"]*)"', label))
    definition = dict(re.findall(pattern, DEFINITION.read_text()))
    assert image.keys() == known | {"base.name"}
    assert definition.keys() == known
    assert [image[name] for name in same] == [definition[name] for name in same]


def test_options_of_batches_in_jobs_exist() -> None:
    batches = re.findall(r"(?:pogosim\.sif|exec) pogobatch( run| merge|) (-.*|jobs .*)", text(PAGE))
    assert {subcommand for subcommand, _ in batches} == {"", " run", " merge"}
    for subcommand, words in batches:
        help_text = ran(ROOT, sys.executable, "-m", "pogosim", "batch", *subcommand.split(), "--help").output
        used = re.findall(r"(?<!\S)--?[A-Za-z][\w-]*", words)
        assert used
        assert [option for option in used if not re.search(rf"(?<!\S){option}\b", help_text)] == [], subcommand


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "run.sh: expected one argument, the wheel, found 0"),
        (["a.whl", "b.whl"], "run.sh: expected one argument, the wheel, found 2"),
        (["missing.whl"], "run.sh: there is no file missing.whl"),
        (["pyproject.toml"], "run.sh: pyproject.toml is no wheel of Pogosim for this machine, by its name; expected "),
    ],
)
def test_wrong_words_are_refused_before_anything_is_made(words: list[str], message: str) -> None:
    command = [str(ROOT / "tests" / "containers" / "run.sh"), *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=60)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(message)


def test_help_is_printed() -> None:
    help_text = ran(ROOT, ROOT / "tests" / "containers" / "run.sh", "--help").output
    assert help_text.startswith("Usage, as root")
