"""The server of `pogosim watch`: a page, and a websocket for each viewer.

The library websockets serves both: it is made for little else, bounds messages and queues, compresses, and has no
dependencies. What it does not do is checked here: the token of an address, and from which page a socket comes.
"""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import json
import secrets
import socket
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import Any
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from pogosim.watch.commands import MOST_CHARACTERS, RefusedError, read_command
from pogosim.watch.live import LiveRun
from pogosim.watch.viewer import Viewer

MOST_VIEWERS = 200
MOST_CONNECTIONS = 300  # of viewers, and of what has not said yet what it wants
MOST_UNREAD_BYTES = 8_000_000  # that a connection does not take, answers to its pings among them
OPEN_S = 5.0  # in which a connection says what it wants
MOST_WAITING = 400  # messages for a viewer that does not take them
MOST_BACKLOG = 200  # requests that the run has not done yet, before viewers have to wait
TOKEN_BYTES = 16
END_S = 2.0


def new_token() -> str:
    """Return a token that cannot be guessed."""
    return secrets.token_urlsafe(TOKEN_BYTES)


@dataclass
class Tokens:
    """What lets viewers in."""

    steer: str = field(default_factory=new_token)
    look: str = field(default_factory=new_token)

    def rights(self, token: str) -> bool | None:
        """Return whether a token lets one steer; None: it is none of these."""
        known = token.encode("utf-8", "replace")
        may_steer = hmac.compare_digest(known, self.steer.encode())
        may_look = hmac.compare_digest(known, self.look.encode())
        return may_steer if may_steer or may_look else None


class Bounded(ServerConnection):
    """A connection of a server that has so many at most, and keeps so many bytes for each."""

    open_now = 0  # of all servers of this process

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin, or end at once if there are too many."""
        Bounded.open_now += 1
        super().connection_made(transport)
        if Bounded.open_now > MOST_CONNECTIONS:
            self.transport.abort()

    def data_received(self, data: bytes) -> None:
        """Take bytes; a connection that does not take the answers ends."""
        super().data_received(data)
        if self.transport.get_write_buffer_size() > MOST_UNREAD_BYTES:
            self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """End."""
        Bounded.open_now -= 1
        super().connection_lost(exc)


class WatchServer:
    """Serves a live run on one address.

    Attributes:
        tokens: Those that let viewers in.
    """

    def __init__(self, live: LiveRun, page: str) -> None:
        """Prepare to serve; `page`: HTML."""
        self.tokens = Tokens()
        self._live = live
        self._page = page.encode()
        self._count = 0

    @contextlib.asynccontextmanager
    async def serving(self, sockets: socket.socket) -> AsyncIterator[Server]:
        """Serve on a socket that listens, until the end of the block."""
        async with serve(
            self._view,
            sock=sockets,
            process_request=self._answer,
            create_connection=Bounded,
            open_timeout=OPEN_S,
            max_size=4 * MOST_CHARACTERS,
            max_queue=16,
            compression="deflate",
            ping_interval=20,
            close_timeout=END_S,
            server_header=None,
        ) as server:
            yield server

    # ---- Pages

    def _answer(self, _: ServerConnection, request: Request) -> Response | None:
        """Answer a request for the page; None: a websocket is let in."""
        path, query = parts_of(request.path)
        rights = self.tokens.rights(token_in(query))
        if path not in ("/", "/live"):
            return answer(HTTPStatus.NOT_FOUND, "There is nothing here.")
        if rights is None:
            return answer(HTTPStatus.FORBIDDEN, "The address lacks the token that pogosim watch has printed.")
        if path == "/":
            return answer(HTTPStatus.OK, self._page, "text/html; charset=utf-8")
        if not is_of_same_origin(request.headers):
            return answer(HTTPStatus.FORBIDDEN, "The page is of another server.")
        if self._count >= MOST_VIEWERS:
            return answer(HTTPStatus.SERVICE_UNAVAILABLE, f"{MOST_VIEWERS} viewers look already.")
        return None

    # ---- Viewers

    async def _view(self, connection: ServerConnection) -> None:
        """Serve a viewer until it leaves."""
        loop = asyncio.get_running_loop()
        waiting: asyncio.Queue[dict[str, Any] | bytes] = asyncio.Queue(MOST_WAITING)
        assert connection.request is not None
        may_steer = self.tokens.rights(token_in(parts_of(connection.request.path)[1])) is True

        def put(message: dict[str, Any] | bytes) -> None:
            if waiting.full():
                connection.transport.abort()  # it takes nothing any more
            else:
                waiting.put_nowait(message)

        def send(message: dict[str, Any] | bytes) -> None:
            with contextlib.suppress(RuntimeError):  # the server has ended
                loop.call_soon_threadsafe(put, message)

        viewer = Viewer(send, may_steer=may_steer)
        self._count += 1
        self._live.join(viewer)
        sender = asyncio.create_task(send_all(connection, waiting))
        try:
            async for message in connection:
                await self._take(viewer, message)
        except ConnectionClosed:
            pass
        finally:
            self._count -= 1
            self._live.leave(viewer)
            sender.cancel()
            await asyncio.gather(sender, return_exceptions=True)

    async def _take(self, viewer: Viewer, message: str | bytes) -> None:
        while self._live.backlog > MOST_BACKLOG:
            await asyncio.sleep(0.02)
        try:
            if isinstance(message, bytes):
                raise RefusedError("a message is text")
            self._live.do(viewer, read_command(message))
        except RefusedError as error:
            viewer.tell({"kind": "refused", "message": str(error)})


async def send_all(connection: ServerConnection, waiting: asyncio.Queue[dict[str, Any] | bytes]) -> None:
    """Send messages as they come, as fast as the viewer takes them."""
    with contextlib.suppress(ConnectionClosed):
        while True:
            message = await waiting.get()
            is_bytes = isinstance(message, bytes)
            await connection.send(message if is_bytes else json.dumps(message, allow_nan=False, separators=(",", ":")))


def parts_of(address: str) -> tuple[str, str]:
    """Return the path and the query of an address; empty if it is none."""
    try:
        parts = urlsplit(address)
    except ValueError:
        return "", ""
    return parts.path, parts.query


def token_in(query: str) -> str:
    """Return the token of an address; empty if it has none."""
    found = parse_qs(query).get("token", [""])
    return found[0] if len(found) == 1 else ""


def is_of_same_origin(headers: Headers) -> bool:
    """Tell whether a websocket is opened by a page of this server, or by no page of a browser at all."""
    origins = headers.get_all("Origin")
    hosts = headers.get_all("Host")
    if not origins:
        return True
    if len(origins) != 1 or len(hosts) != 1:
        return False
    try:
        return urlsplit(origins[0]).netloc.lower() == hosts[0].lower()
    except ValueError:
        return False


def answer(status: HTTPStatus, content: str | bytes, kind: str = "text/plain; charset=utf-8") -> Response:
    """Return a page, or why there is none."""
    body = content if isinstance(content, bytes) else f"{content}\n".encode()
    headers = Headers(
        {
            "Content-Type": kind,
            "Content-Length": str(len(body)),
            "Cache-Control": "no-store",
            "Referrer-Policy": "no-referrer",
            "X-Content-Type-Options": "nosniff",
            "X-Frame-Options": "DENY",
            "Connection": "close",
        }
    )
    return Response(status.value, status.phrase, headers, body)
