"""Ctrl-C that comes while an object is collected.

Python only prints an exception of a finaliser, and the program would go on.
"""

from __future__ import annotations

import _thread
import threading
import time

DELAY_S = 0.05  # in which the finaliser returns


def interrupt_soon() -> None:
    """Interrupt the main thread, as Ctrl-C does, after the finaliser that calls this."""

    def interrupt() -> None:
        time.sleep(DELAY_S)
        _thread.interrupt_main()

    threading.Thread(target=interrupt, name="pogosim-interrupt", daemon=True).start()
