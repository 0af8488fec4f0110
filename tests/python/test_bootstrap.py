"""scripts/bootstrap.sh makes the project's environment of what the project uses, and of little else."""

from __future__ import annotations

import importlib
import subprocess
import sysconfig
from pathlib import Path

import pytest
from running import ROOT

PACKAGES = Path(sysconfig.get_path("platlib"))


def test_environment_holds_neither_tests_of_packages_nor_clients_for_remote_data() -> None:
    assert (PACKAGES / "pandas").is_dir()  # it is the environment of bootstrap.sh
    tests = [path for name in ("matplotlib", "pandas", "pyarrow", "scipy/*") for path in PACKAGES.glob(f"{name}/tests")]
    clients = [*PACKAGES.glob("pyarrow/*flight.*"), *PACKAGES.glob("pyarrow/libarrow_s3.*")]
    assert [path.name for path in tests + clients if path.suffix not in {".py", ".pyx", ".pxd", ".h"}] == []


def test_tables_can_be_read_and_written_without_those_clients() -> None:
    for module in ("pyarrow.fs", "pyarrow.parquet", "pyarrow.dataset", "pyarrow.feather"):
        importlib.import_module(module)


def test_environment_of_another_folder_that_is_linked_is_left_alone(tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.mkdir()
    (other / "kept").write_text("kept")
    clone = tmp_path / "clone"
    (clone / "scripts").mkdir(parents=True)
    for name in ("scripts/bootstrap.sh", "pyproject.toml"):
        (clone / name).write_text((ROOT / name).read_text())
    (clone / ".venv").symlink_to(other)
    command = ["bash", "-c", ". scripts/bootstrap.sh; make_venv build"]
    done = subprocess.run(command, cwd=clone, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    assert f".venv is a link to {other}, which was made for another folder. Remove the link" in done.stderr
    assert [path.name for path in other.iterdir()] == ["kept"]


@pytest.mark.parametrize("offered", [True, False], ids=["Debian", "Ubuntu"])
def test_browsers_are_installed_where_apt_offers_them(offered: bool, tmp_path: Path) -> None:
    candidate = "1.0" if offered else "(none)"
    stubs = {
        "apt-cache": f"echo '  Candidate: {candidate}'",
        "apt-get": f'echo "$*" >>{tmp_path}/asked',
        "dpkg-query": ":",  # nothing is installed
        "id": "echo 0",
        "env": 'shift; "$@"',  # after DEBIAN_FRONTEND
    }
    for name, text in stubs.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / name).chmod(0o755)
    command = ["bash", "-euc", f'. scripts/bootstrap.sh; PATH="{tmp_path}:$PATH"; install_packages test']
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    asked = (tmp_path / "asked").read_text().split()
    assert {"cmake", "doxygen"} <= set(asked)
    assert ("chromium" in asked, "firefox-esr" in asked) == (offered, offered)
