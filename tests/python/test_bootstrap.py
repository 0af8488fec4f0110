"""scripts/bootstrap.sh makes the project's environment of what the project uses, and of little else."""

from __future__ import annotations

import importlib
import sysconfig
from pathlib import Path

PACKAGES = Path(sysconfig.get_path("platlib"))


def test_environment_holds_neither_tests_of_packages_nor_clients_for_remote_data() -> None:
    assert (PACKAGES / "pandas").is_dir()  # it is the environment of bootstrap.sh
    tests = [path for name in ("matplotlib", "pandas", "pyarrow", "scipy/*") for path in PACKAGES.glob(f"{name}/tests")]
    clients = [*PACKAGES.glob("pyarrow/*flight.*"), *PACKAGES.glob("pyarrow/libarrow_s3.*")]
    assert [path.name for path in tests + clients if path.suffix not in {".py", ".pyx", ".pxd", ".h"}] == []


def test_tables_can_be_read_and_written_without_those_clients() -> None:
    for module in ("pyarrow.fs", "pyarrow.parquet", "pyarrow.dataset", "pyarrow.feather"):
        importlib.import_module(module)
