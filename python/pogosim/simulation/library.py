"""The simulator's library, by its interface for hosts (include/pogosim/host.h).

ctypes releases the global interpreter lock during each call, so runs in several threads go on at the same time. One
package serves every version of Python, which a compiled module would not.
"""

from __future__ import annotations

import ctypes
import functools
import logging
import os
import re
import signal
import sys
import threading
import time
from collections.abc import Callable
from ctypes import (
    POINTER,
    byref,
    c_char,
    c_char_p,
    c_double,
    c_int,
    c_int32,
    c_int64,
    c_size_t,
    c_uint32,
    c_uint64,
    c_void_p,
)
from pathlib import Path
from typing import Any, NamedTuple

from pogosim import __version__
from pogosim.extensions import let_find_models
from pogosim.installation import InstallationError, find_installation
from pogosim.lines import printable_lines
from pogosim.simulation.errors import ConfigurationError, ProgramFailedError, SimulationError

FAILED_BEFORE = b"the run has failed: reset it"  # as the library says it
DELAY_S = 0.05  # in which the finaliser returns


def interrupt_soon() -> None:
    """Interrupt the main thread, as Ctrl-C does, after the finaliser that calls this."""

    def interrupt() -> None:
        time.sleep(DELAY_S)
        main = threading.main_thread().ident
        if main is not None and callable(signal.getsignal(signal.SIGINT)):  # else the signal would end the process
            signal.pthread_kill(main, signal.SIGINT)  # ends its sleep, too

    threading.Thread(target=interrupt, name="pogosim-interrupt", daemon=True).start()


OK, OVER, USAGE, PROGRAM_FAILED = range(4)


class RunOptions(ctypes.Structure):
    """`struct pogosim_run_options`."""

    _fields_ = (
        ("program", c_char_p),
        ("configuration", c_char_p),
        ("settings", POINTER(c_char_p)),
        ("setting_count", c_size_t),
        ("seed", c_int64),
        ("strict", c_int),
        ("strict_settings", c_int),
    )


class ArrayPlace(ctypes.Structure):
    """`struct pogosim_array`."""

    _fields_ = (
        ("data", c_void_p),
        ("type", c_char * 8),
        ("dimensions", c_int),
        ("shape", c_int64 * 3),
        ("stride_bytes", c_int64 * 3),
    )


class ObjectState(ctypes.Structure):
    """`struct pogosim_object`."""

    _fields_ = (
        ("id", c_uint32),
        ("category", c_uint32),
        ("robot", c_uint32),
        ("is_alive", c_int32),
        ("x_mm", c_double),
        ("y_mm", c_double),
        ("heading_rad", c_double),
        ("light", c_double),
    )


class LampState(ctypes.Structure):
    """`struct pogosim_lamp`."""

    _fields_ = (
        ("category", c_char_p),
        ("is_on", c_int32),
        ("intensity", c_double),
        ("x_mm", c_double),
        ("y_mm", c_double),
    )


class LinkState(ctypes.Structure):
    """`struct pogosim_run_link`."""

    _fields_ = (
        ("kind", c_int32),
        ("a", c_int32),
        ("b", c_int32),
        ("robot_a", c_int32),
        ("robot_b", c_int32),
        ("is_cut", c_int32),
        ("end_a_mm", c_double * 2),
        ("end_b_mm", c_double * 2),
        ("rest_mm", c_double),
        ("stiffness_n_m", c_double),
        ("damping_n_s_m", c_double),
        ("breaking_n", c_double),
        ("least_rad", c_double),
        ("most_rad", c_double),
        ("length_mm", c_double),
        ("tension_n", c_double),
    )


class Turn(ctypes.Structure):
    """`struct pogosim_turn`."""

    _fields_ = (("left", c_int64), ("status", c_int32), ("has_messages", c_int32))


class Exchange(ctypes.Structure):
    """`struct pogosim_exchange`."""

    _fields_ = (
        ("category", c_char_p),
        ("name", c_char_p),
        ("place", c_void_p),
        ("bytes_each", c_size_t),
        ("gives", c_int32),
        ("takes", c_int32),
    )


PROTOTYPES: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "pogosim_host_error": (c_char_p, ()),
    "pogosim_host_version": (c_char_p, ()),
    "pogosim_run_open": (c_int, (POINTER(RunOptions), POINTER(c_void_p))),
    "pogosim_run_step": (c_int, (c_void_p, c_int64, c_double, POINTER(c_int64))),
    "pogosim_run_take_turn": (c_int, (c_void_p, POINTER(Turn), c_double)),
    "pogosim_run_end": (c_int, (c_void_p,)),
    "pogosim_run_close": (None, (c_void_p,)),
    "pogosim_run_number": (c_int, (c_void_p, c_char_p, POINTER(c_double))),
    "pogosim_run_array": (c_int, (c_void_p, c_char_p, POINTER(ArrayPlace))),
    "pogosim_run_brain_array": (c_int, (c_void_p, c_char_p, c_char_p, POINTER(ArrayPlace))),
    "pogosim_run_firmware_bytes": (c_int, (c_void_p, c_char_p, c_uint32, c_uint32, c_void_p, c_void_p)),
    "pogosim_run_clear_received": (c_int, (c_void_p, c_char_p)),
    "pogosim_run_categories": (c_char_p, (c_void_p,)),
    "pogosim_run_metadata": (c_char_p, (c_void_p,)),
    "pogosim_run_look": (c_int, (c_void_p, c_void_p)),
    "pogosim_run_drag_object": (c_int, (c_void_p, c_size_t, c_double, c_double, POINTER(c_int))),
    "pogosim_run_messages": (c_char_p, (c_void_p,)),
    "pogosim_run_draw": (c_int, (c_void_p, c_int32, c_int32, c_void_p)),
    "pogosim_painter_open": (c_int, (c_void_p, POINTER(c_void_p))),
    "pogosim_painter_shows": (c_int, (c_void_p, c_char_p, POINTER(c_int))),
    "pogosim_painter_draw": (c_int, (c_void_p, c_void_p, c_int32, c_int32, c_void_p, c_size_t)),
    "pogosim_painter_close": (None, (c_void_p,)),
    "pogosim_run_set_pose": (c_int, (c_void_p, c_size_t, c_double, c_double, c_double)),
    "pogosim_run_object": (c_int, (c_void_p, c_size_t, POINTER(ObjectState))),
    "pogosim_run_set_object_pose": (c_int, (c_void_p, c_size_t, c_double, c_double, c_double)),
    "pogosim_run_set_alive": (c_int, (c_void_p, c_size_t, c_int)),
    "pogosim_run_lamp": (c_int, (c_void_p, c_size_t, POINTER(LampState))),
    "pogosim_run_set_lamp": (c_int, (c_void_p, c_size_t, POINTER(LampState))),
    "pogosim_run_links": (c_int, (c_void_p, c_void_p, c_size_t, POINTER(c_size_t))),
    "pogosim_run_new_link": (c_int, (c_void_p, c_int32, c_size_t, c_int64, POINTER(LinkState))),
    "pogosim_run_add_link": (c_int, (c_void_p, POINTER(LinkState), POINTER(c_size_t))),
    "pogosim_run_cut_links": (c_int, (c_void_p, c_void_p, c_size_t)),
    "pogosim_run_set_column": (c_int, (c_void_p, c_int64, c_char_p, c_double)),
    "pogosim_run_set_parameter": (c_int, (c_void_p, c_char_p, c_char_p)),
    "pogosim_run_columns": (c_char_p, (c_void_p,)),
    "pogosim_run_light_levels": (None, (c_void_p, c_void_p)),
    "pogosim_run_save": (c_int, (c_void_p,)),
    "pogosim_run_save_state": (c_int, (c_void_p, POINTER(c_void_p))),
    "pogosim_run_restore_state": (c_int, (c_void_p, c_void_p)),
    "pogosim_state_free": (None, (c_void_p,)),
    "pogosim_run_leave_archive": (None, (c_void_p,)),
    "pogosim_run_hash": (c_uint64, (c_void_p,)),
    "pogosim_expression_open": (c_int, (c_char_p, c_char_p, POINTER(c_void_p))),
    "pogosim_expression_names": (c_char_p, (c_void_p,)),
    "pogosim_expression_numbers": (None, (c_void_p, c_void_p, c_size_t, c_void_p)),
    "pogosim_expression_close": (None, (c_void_p,)),
    "pogosim_threads_open": (c_int, (c_int, POINTER(c_void_p))),
    "pogosim_threads_step": (c_int, (c_void_p, c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, c_double)),
    "pogosim_threads_error": (c_char_p, (c_void_p, c_size_t)),
    "pogosim_threads_close": (None, (c_void_p,)),
    "pogosim_runs_read": (c_int, (c_void_p, c_size_t, c_char_p, c_char_p, c_void_p, c_size_t)),
}


@functools.cache
def library() -> ctypes.CDLL:
    """Load the library of the simulator that `pogosim path` names.

    Raises:
        SimulationError: There is none, or it is of another version than this package.
    """
    try:
        folder = find_installation().library
    except InstallationError as error:
        raise SimulationError(str(error)) from None
    path = folder / ("libpogosim.dylib" if sys.platform == "darwin" else "libpogosim.so")
    try:
        loaded = ctypes.CDLL(str(path))
        for name, (result, arguments) in PROTOTYPES.items():
            function = getattr(loaded, name)
            function.restype = result
            function.argtypes = arguments
    except (OSError, AttributeError) as error:
        raise SimulationError(f"the simulator's library {path} cannot be used: {error}") from None
    let_find_models(logging.getLogger("pogosim").warning)
    version = loaded.pogosim_host_version().decode().removeprefix("v")
    if version != __version__:
        raise SimulationError(f"{path} is of Pogosim {version}, and this package of {__version__}: build it again")
    return loaded


def check(status: int) -> int:
    """Return the status of a call that did not fail.

    Raises:
        ConfigurationError: Arguments, a configuration or a file are wrong.
        ProgramFailedError: The robots' program has failed.
    """
    if status in (OK, OVER):
        return status
    raise error_of(status, library().pogosim_host_error())


def error_of(status: int, message: bytes) -> SimulationError:
    """Return the error that a status of the library stands for."""
    kind = ProgramFailedError if status == PROGRAM_FAILED else ConfigurationError
    return kind(printable_lines(in_words_of_python(message.decode("utf-8", "replace"))))


# Temporary files that hold maps, by which messages name the argument instead.
files_of_maps: set[str] = set()


def in_words_of_python(text: str) -> str:
    """Return a message of the simulator with arguments in place of options, and `configuration` for files of maps.

    A hint at the option -v is left out: Python has none.
    """
    for file in tuple(files_of_maps):
        text = re.sub(rf"{re.escape(file)}(:\d+)?", "configuration", text) if file in text else text
    text = re.sub(r"^--set: ", "set: ", text, flags=re.MULTILINE)
    return (
        text.replace("(--strict)", "(strict)")
        .replace("(--set)", "(set)")
        .replace("(--set;", "(set;")
        .replace(" (-v lists them)", "")
    )


def error_of_step(status: int, message: bytes) -> SimulationError:
    """Return the error that a status of a run's steps stands for."""
    return SimulationError(message.decode()) if message == FAILED_BEFORE else error_of(status, message)


class Strict(NamedTuple):
    """Which unknown keys are errors.

    Attributes:
        keys: All.
        settings: Those of the settings.
    """

    keys: bool = False
    settings: bool = False


class OpenRun:
    """A run of the simulator, which is freed with this object: arrays of it keep it, and so do calls under way.

    Attributes:
        pointer: NULL until it is open.
    """

    _close: Callable[[c_void_p], None] | None = None  # until all that it needs is known

    def __init__(self) -> None:
        self.pointer = c_void_p()
        self._process = os.getpid()
        self._close = library().pogosim_run_close

    def __del__(  # modules may be gone at the end of Python
        self, process_now: Callable[[], int] = os.getpid, interrupt_soon: Callable[[], None] = interrupt_soon
    ) -> None:
        try:
            # In a forked child, the files are those of its parent.
            if self._close is not None and process_now() == self._process:
                self._close(self.pointer)
        except KeyboardInterrupt:
            interrupt_soon()


def open_run(
    run: OpenRun, program: Path | None, configuration: Path, settings: list[str], seed: int | None, strict: Strict
) -> None:
    """Build a run and start its program. The caller keeps `run`: Ctrl-C may come as soon as it is open."""
    texts = (c_char_p * len(settings))(*(text.encode() for text in settings))
    options = RunOptions(
        None if program is None else os.fsencode(program),
        os.fsencode(configuration),
        texts,
        len(settings),
        -1 if seed is None else seed,
        strict.keys,
        strict.settings,
    )
    check(library().pogosim_run_open(byref(options), byref(run.pointer)))
