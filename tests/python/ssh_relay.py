"""Passes connections of a TCP port on to an X server, as ssh -X does. It is started under the name `ssh`."""

from __future__ import annotations

import contextlib
import socket
import sys
import threading


def pass_on(source: socket.socket, target: socket.socket) -> None:
    """Copy bytes until one of the two ends."""
    with contextlib.suppress(OSError):
        while data := source.recv(65536):
            target.sendall(data)
        target.shutdown(socket.SHUT_WR)


def serve(number: str) -> None:
    """Print a port, and pass its connections on to a display of this machine."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        print(listening.getsockname()[1], flush=True)
        while True:
            client, _ = listening.accept()
            server = socket.socket(socket.AF_UNIX)
            server.connect(f"/tmp/.X11-unix/X{number}")
            for ends in ((client, server), (server, client)):
                threading.Thread(target=pass_on, args=ends, daemon=True).start()


if __name__ == "__main__":
    serve(sys.argv[1])
