"""Checks files of forges and citations with the schemas that come with check-jsonschema; nothing is fetched."""

from __future__ import annotations

from pathlib import Path

from check_jsonschema import main
from click.testing import CliRunner


def mistakes(file: Path, schema: str) -> str:
    """Return what is wrong with a file, "" if nothing is."""
    options = ["--data-transform", "gitlab-ci"] if schema == "vendor.gitlab-ci" else []
    done = CliRunner().invoke(main, ["--builtin-schema", schema, *options, str(file)])
    assert done.exit_code in (0, 1), done.output
    return done.output if done.exit_code else ""
