"""No test waits without a limit."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from running import ROOT

ENDLESS = """
import ctypes

def test_that_never_ends():
    ctypes.CDLL(None).sleep(600)  # C code: no exception of Python ends it
"""


def test_each_test_has_a_limit(request: pytest.FixtureRequest) -> None:
    assert 0 < float(request.config.getini("timeout")) <= 1800


def test_that_does_not_end_fails_and_is_named(tmp_path: Path) -> None:
    (tmp_path / "test_endless.py").write_text(ENDLESS)
    settings = ["-c", str(ROOT / "pyproject.toml"), "--rootdir", str(tmp_path), "-o", "timeout=2"]
    command = [sys.executable, "-m", "pytest", "-q", *settings, "test_endless.py"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode != 0
    assert "Timeout" in done.stdout + done.stderr
    assert "test_that_never_ends" in done.stdout + done.stderr
