"""How a command of batches ends: its messages, its exit code, and what it prints as JSON."""

from __future__ import annotations

import contextlib
import itertools
import json
import logging
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from pogosim.batch.errors import BatchError, NothingSelectedError, reason
from pogosim.batch.run_options import DONE, INTERRUPTED, NO_SUCH_OUTPUT, RUNS_FAILED, WRONG
from pogosim.interrupting import interrupt
from pogosim.lines import LineFormatter, say_parts

log = logging.getLogger("pogobatch")

Report = dict[
    str, Any
]  # what a command prints as JSON; values may be iterables whose items are made as they are printed

ITEMS = 1000  # printed at a time


class RunsFailedError(Exception):
    """Runs failed.

    Attributes:
        report: What the command prints as JSON.
        is_said: Whether the message has been said already.
    """

    def __init__(self, message: str, report: Report, is_said: bool = True) -> None:
        super().__init__(message)
        self.report = report
        self.is_said = is_said


def catch_signals() -> None:
    """Let the signals with which batch systems and terminals end a program end it in good order.

    And let the system tell how simulators have ended: a process may have been started with SIGCHLD ignored.
    """
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, interrupt)


def start_logging(verbose: bool, style: str, *others: str) -> None:
    """Print messages on standard error.

    Args:
        verbose: Also those for debugging.
        style: What a line looks like, with the fields of `logging.Formatter`.
        others: Names of more loggers whose messages are printed.
    """
    handler = logging.StreamHandler()
    handler.setFormatter(LineFormatter(style, datefmt="%H:%M:%S"))
    for own in (log, *map(logging.getLogger, others)):
        own.handlers = [handler]
        own.propagate = False
        own.setLevel(logging.DEBUG if verbose else logging.INFO)


def ended(
    operation: str,
    command: Callable[[], Report],
    as_json: bool,
    kept: str | None,
    counted: Callable[[], str] = lambda: "",
) -> int:
    """Run a command to its end; returns its exit code.

    Args:
        operation: Its name.
        command: Returns what it has done.
        as_json: Print that as JSON, with `operation`, `ok` and perhaps `error`.
        kept: Folder of finished runs, which stay if it is interrupted; None: there are none.
        counted: Returns how many those are, and how many states of others.
    """
    report: Report = {}
    with contextlib.redirect_stdout(sys.stderr) if as_json else contextlib.nullcontext():
        code, error = called(command, report, kept, counted)
    if as_json:
        problem = {"error": error} if error else {}
        try:
            say_parts(json_parts({"operation": operation, "ok": code == DONE, **report, **problem}))
        except OSError:
            pass  # the reader has gone
        except KeyboardInterrupt:
            log.error("interrupted")
            return INTERRUPTED
    return code


def json_parts(report: Report) -> Iterator[str]:
    """Yield the text of a report as json.dumps() returns it, without making all of its items first."""
    start = "{"
    for key, value in report.items():
        yield f"{start}{json.dumps(key)}: "
        start = ", "
        if isinstance(value, (str, list, tuple, dict)) or not isinstance(value, Iterable):
            yield json.dumps(value)
            continue
        items, before = iter(value), "["
        while some := list(itertools.islice(items, ITEMS)):
            yield before + json.dumps(some)[1:-1]
            before = ", "
        yield "]" if before != "[" else "[]"
    yield "}"


def called(
    command: Callable[[], Report], report: Report, kept: str | None, counted: Callable[[], str]
) -> tuple[int, str]:
    """Call a command, and say what keeps it from ending well; returns the exit code, and the message."""
    code = WRONG
    try:
        report.update(command())
        return DONE, ""
    except RunsFailedError as error:
        report.update(error.report)
        if not error.is_said:
            log.error("%s", error)
        return RUNS_FAILED, str(error)
    except NothingSelectedError as error:
        code, message = NO_SUCH_OUTPUT, str(error)
    except BatchError as error:
        message = str(error)
    except OSError as error:
        message = f"{error.filename or kept or 'the files'}: {reason(error)}"
    except RuntimeError as error:
        if "start new thread" not in str(error):
            raise
        message = "no thread can be started: the limit of memory or of processes (ulimit -v, ulimit -u) is too low"
    except MemoryError:
        message = "not enough memory for this many combinations and runs; make several batches"
    except KeyboardInterrupt:
        code, message = INTERRUPTED, f"interrupted{advice_after_interruption(kept, counted)}"
    log.error("%s", message)
    return code, message


def advice_after_interruption(kept: str | None, counted: Callable[[], str]) -> str:
    """Return what is said of an interrupted command beside that: what it has left, and how it goes on."""
    if not kept:
        return ""
    with contextlib.suppress(OSError):
        if there := counted():
            return f": {kept} has {there}; the same command continues"
    return f"; finished runs are kept in {kept}: the same command continues"
