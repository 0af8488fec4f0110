"""A server of live runs in a thread, for programs that do something else meanwhile."""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import socket
import threading
from collections.abc import Iterator, Sequence

from pogosim.simulation import Simulation
from pogosim.watch.page import watch_page
from pogosim.watch.server import WatchServer

LONGEST_START_S = 20.0


def address_of(own: socket.socket, token: str) -> str:
    """Return the address of the page on a socket that listens."""
    host, port = own.getsockname()[:2]
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/?token={token}"


def listening(address: str, ports: Sequence[int]) -> socket.socket:
    """Return a socket that listens on the first free port; port 0: any.

    Raises:
        ValueError: The address is no IP address.
        OSError: It is none of this machine, or all ports are taken.
    """
    family = socket.AF_INET6 if ipaddress.ip_address(address).version == 6 else socket.AF_INET
    for number in ports:
        own = socket.socket(family, socket.SOCK_STREAM)
        try:
            own.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            own.bind((address, number))
            own.listen()
            return own
        except OSError:
            own.close()
            if number == ports[-1]:
                raise
    raise ValueError("no ports")


@contextlib.contextmanager
def served_in_thread(server: WatchServer, own: socket.socket) -> Iterator[None]:
    """Serve on a socket that listens, in a thread, until the end of the block."""
    loop = asyncio.new_event_loop()
    is_ended = asyncio.Event()

    async def serve() -> None:
        async with server.serving(own):
            is_serving.set()
            await is_ended.wait()

    is_serving = threading.Event()
    thread = threading.Thread(target=lambda: loop.run_until_complete(serve()), name="pogosim-watch", daemon=True)
    thread.start()
    is_serving.wait(LONGEST_START_S)
    try:
        yield
    finally:
        loop.call_soon_threadsafe(is_ended.set)
        thread.join()
        loop.close()


class LivePage:
    """A page that shows a simulation of this process, while it goes on here.

        with LivePage(sim) as page:
            webbrowser.open(page.address)
            sim.run()

    Attributes:
        address: The page that steers; it is served on this machine only.
    """

    def __init__(self, simulation: Simulation) -> None:
        """Serve the page from now on."""
        self._open = contextlib.ExitStack()
        server = WatchServer(simulation._live_run, watch_page(f"{simulation.configuration.name} \u2013 Pogosim"))
        own = self._open.enter_context(listening("127.0.0.1", [0]))
        self._open.enter_context(served_in_thread(server, own))
        self.address = address_of(own, server.tokens.steer)

    def close(self) -> None:
        """Serve it no more; the simulation goes on."""
        self._open.close()

    def __enter__(self) -> LivePage:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
