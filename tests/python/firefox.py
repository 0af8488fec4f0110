"""Firefox without a window, driven by WebDriver BiDi (w3c.github.io/webdriver-bidi), which it speaks itself."""

from __future__ import annotations

import base64
import contextlib
import itertools
import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

FIREFOX = shutil.which("firefox-esr") or shutil.which("firefox")
LIMIT_S = 60.0


class Firefox:
    """A tab of a Firefox that runs."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._numbers = itertools.count(1)
        self.call("session.new", capabilities={})
        self._tab = self.call("browsingContext.create", type="tab")["context"]

    def call(self, method: str, **parameters: Any) -> Any:
        """Give a command; returns its result."""
        number = next(self._numbers)
        self._connection.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._connection.recv(timeout=LIMIT_S))
            if answer.get("id") == number:
                assert answer["type"] == "success", answer
                return answer["result"]

    def open(self, address: str, width: int = 1000, height: int = 740) -> None:
        """Show a page."""
        self.call("browsingContext.setViewport", context=self._tab, viewport={"width": width, "height": height})
        self.call("browsingContext.navigate", context=self._tab, url=address, wait="complete")

    def value(self, expression: str) -> Any:
        """Return what an expression of JavaScript is, as JSON has it."""
        target = {"context": self._tab}
        found = self.call(
            "script.evaluate",
            expression=f"Promise.resolve({expression}).then((own) => JSON.stringify(own ?? null))",
            target=target,
            awaitPromise=True,
        )
        assert found["type"] == "success", found
        return json.loads(found["result"]["value"])

    def picture(self) -> bytes:
        """Return what the page shows, PNG."""
        return base64.b64decode(self.call("browsingContext.captureScreenshot", context=self._tab)["data"])

    def click(self, x: float, y: float) -> None:
        """Click at a place of the page, pixels."""
        moves = [
            {"type": "pointerMove", "x": round(x), "y": round(y)},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerUp", "button": 0},
        ]
        actions = [{"type": "pointer", "id": "mouse", "actions": moves}]
        self.call("input.performActions", context=self._tab, actions=actions)


@contextlib.contextmanager
def firefox(folder: Path) -> Iterator[Firefox]:
    """Start one with a profile of its own in a folder, until the end of the block."""
    assert FIREFOX is not None
    command = [FIREFOX, "--headless", "--no-remote", "--profile", str(folder), "--remote-debugging-port", "0"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stderr is not None
        address = next(
            found[1] for line in process.stderr if (found := re.search(r"WebDriver BiDi listening on (ws://\S+)", line))
        )
        with connect(f"{address}/session", max_size=None, compression=None) as connection:
            yield Firefox(connection)
    finally:
        process.terminate()
        process.communicate(timeout=30)
