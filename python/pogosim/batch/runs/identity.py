"""What makes two runs the same run: configuration, seed, program and library."""

from __future__ import annotations

import hashlib
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pogosim.batch.configurations.names import COLUMNS, FORMAT
from pogosim.batch.configurations.option_words import CHOICES
from pogosim.batch.errors import BatchError, cannot
from pogosim.batch.runs.named_files import entries_in, may_be_a_name, texts_at
from pogosim.batch.runs.run_files import without_outputs
from pogosim.firmware import is_firmware
from pogosim.installation import find_installation
from pogosim.machine_code import ELF, MACH_O, UNIVERSAL, of_another_machine
from pogosim.yaml_1_2 import dump_yaml

# Keys that say, beside the names of outputs, where results go, not what they are.
NOT_IN_THE_WORLD = (FORMAT, COLUMNS, "optimization", CHOICES)
LIBRARY = re.compile(r"^\s*(?:\S+ => )?(/\S*libpogosim[^/\s]*)", re.MULTILINE)

MODULES = "libpogosim_tables*"  # that the library loads when it writes rows

PYTHON = ".py"  # how the names of files end that Python runs
SHARED_OBJECTS = (".so", ".dylib")  # with which pogosim.Simulation runs a program in the process of Python

# Every program of the simulator mentions its library, or contains it.
MARK = b"pogosim"
EXECUTABLES = (ELF, MACH_O, UNIVERSAL)


def find_program(name: str) -> Path:
    """Return the absolute path of a simulator: a file, or else a command on the PATH.

    Raises:
        BatchError: There is none, or it is not a program of the simulator.
    """
    path = Path(name)
    if not path.exists() and "/" not in name and (found := shutil.which(name)):
        path = Path(found)
    expected = "expected a program compiled for Pogosim, such as ./examples/hanabi/hanabi"
    try:
        if not path.is_file():
            what = "is a folder" if path.is_dir() else "does not exist"
            raise BatchError(f"the simulator {name} {what}; {expected}")
        if elsewhere := of_another_machine(path):
            raise BatchError(elsewhere)
        with path.open("rb") as file:
            content = file.read()
    except OSError as error:
        raise cannot("read the simulator", name, error) from None
    if is_firmware(path):
        return path.absolute()
    is_script = content.startswith(b"#!") or path.suffix == PYTHON
    if not is_script and not is_of_simulator(content):
        raise BatchError(f"{name} is not a simulator; {expected}")
    if not is_script and path.suffix in SHARED_OBJECTS:
        program = Path(name).with_suffix("")
        beside = f"give the program beside it, {program}" if program.is_file() else expected
        raise BatchError(f"{name} is a shared object, for Python; {beside}")
    if path.suffix != PYTHON and shutil.which(str(path.absolute())) is None:
        raise BatchError(f"the simulator {name} is not executable; chmod +x {name}")
    return path.absolute()


def is_of_simulator(content: bytes) -> bool:
    """Tell whether this is the content of an executable that is a program of the simulator."""
    return content.startswith(EXECUTABLES) and MARK in content


def is_executable_program(path: Path) -> bool:
    """Tell whether a file is an executable that is a program of the simulator, no script that starts one."""
    try:
        return is_of_simulator(path.read_bytes())
    except OSError:
        return False


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file."""
    with path.open("rb") as file:
        digest = hashlib.sha256()
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def program_digest(program: Path) -> str:
    """Return a digest of a program, or of what runs a firmware, and of the simulator's library that it loads.

    Raises:
        BatchError: A file cannot be read.
        InstallationError: A firmware is to run, and there is no simulator.
    """
    if is_firmware(program):
        return f"{file_digest(program)} {program_digest(find_installation().without_program)}"
    lister = ["otool", "-L"] if sys.platform == "darwin" else ["ldd"]
    libraries: list[Path] = []
    if shutil.which(lister[0]):
        listed = subprocess.run([*lister, str(program)], capture_output=True, text=True, check=False, errors="replace")
        libraries = [Path(found) for found in LIBRARY.findall(listed.stdout)]
    modules = [module for library in libraries for module in sorted(library.parent.glob(MODULES))]
    try:
        return " ".join(digest_of(path) for path in [program, *libraries, *modules] if path.is_file())
    except OSError as error:
        raise cannot("read", error.filename or program, error) from None


def file_digest(path: Path) -> str:
    """Return the digest of a file that a configuration names; empty if it cannot be read."""
    try:
        return digest_of(path) if path.is_file() else ""
    except OSError:
        return ""


def world_digest(entries: dict[str, Any], folders: tuple[Path, ...], digests: dict[Path, str]) -> str:
    """Return a digest of the configuration of a run, and of the files that it names (arenas, robot models).

    So are the files that those in YAML name, such as the script of a robot model.

    Args:
        entries: The configuration.
        folders: Where relative names are searched, in this order.
        digests: Digests of files, to read each once in a batch; found ones are added.
    """
    world = {key: value for key, value in without_outputs(entries).items() if key not in NOT_IN_THE_WORLD}
    digest = hashlib.sha256(dump_yaml(world).encode(errors="surrogatepass"))
    for text in named_digests(world, folders, digests):
        digest.update(text.encode())
    return digest.hexdigest()


def named_digests(node: Any, folders: tuple[Path, ...], digests: dict[Path, str]) -> Iterator[str]:
    """Yield the digests of files that a configuration, or a file in YAML, names; see `world_digest`."""
    for _, text in texts_at(node):
        if may_be_a_name(text):
            for path in [folder / text for folder in folders]:
                if path not in digests:
                    digests[path] = ""  # for files that name each other
                    digests[path] = digest_with_named(path, folders, digests)
                if digests[path]:
                    yield digests[path]
                    break


def digest_with_named(path: Path, folders: tuple[Path, ...], digests: dict[Path, str]) -> str:
    """Return the digest of a file, and those of the files that it names; empty if it cannot be read."""
    own = file_digest(path)
    return own and " ".join([own, *named_digests(entries_in(path), (*folders, path.parent), digests)])


def config_hash(entries: dict[str, Any]) -> str:
    """Return the SHA-256 of a configuration in YAML, with sorted keys, without the names of outputs of a run."""
    kept = {key: value for key, value in without_outputs(entries).items() if key != CHOICES}
    return hashlib.sha256(dump_yaml(in_order(kept)).encode(errors="surrogatepass")).hexdigest()


def in_order(value: Any) -> Any:
    """Return a value whose maps have their keys sorted."""
    if isinstance(value, Mapping):
        return {key: in_order(value[key]) for key in sorted(value, key=str)}
    return [in_order(item) for item in value] if isinstance(value, list) else value


def run_key(world: str, program: str, seed: int) -> str:
    """Return the name of a run: the same for the same configuration, program, library and seed."""
    return hashlib.sha256(f"{world} {program} {seed}".encode()).hexdigest()[:32]


def seed_of(configured: int, run: int) -> int:
    """Return a seed derived from the seed of a configuration and the number of a run.

    Both 0 to 2^32-1, and so is the result. Runs of one configuration all have different seeds; configurations with
    neighbouring seeds do not share them.
    """
    start = int.from_bytes(hashlib.sha256(str(configured).encode()).digest()[:4], "little")
    return (start + run) % 2**32
