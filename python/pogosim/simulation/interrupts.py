"""Ctrl-C that comes while an object is collected.

Python only prints an exception of a finaliser, and the program would go on.
"""

from __future__ import annotations

import signal
import threading
import time

DELAY_S = 0.05  # in which the finaliser returns


def interrupt_soon() -> None:
    """Interrupt the main thread, as Ctrl-C does, after the finaliser that calls this."""

    def interrupt() -> None:
        time.sleep(DELAY_S)
        main = threading.main_thread().ident
        if main is not None and callable(signal.getsignal(signal.SIGINT)):  # else the signal would end the process
            signal.pthread_kill(main, signal.SIGINT)  # ends its sleep, too

    threading.Thread(target=interrupt, name="pogosim-interrupt", daemon=True).start()
