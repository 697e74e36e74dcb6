"""
The connections of a server of pages: those that have not shown its token are few, and do not last.

So whoever opens connections and sends little or nothing cannot keep a browser away.
"""

from __future__ import annotations

import contextlib
import socket
import sys
import threading
import time
from collections.abc import Callable
from http.server import ThreadingHTTPServer
from typing import Any

#: The most connections at a time that have shown the token, and the most that have not.
MOST = 64
#: The time from the begin of a connection to its token [s].
LONGEST = 10.0


class Connections(ThreadingHTTPServer):
    """Answers each connection in a thread of its own."""

    daemon_threads = True
    request_queue_size = MOST
    # On Windows two programs could listen on one port.
    allow_reuse_address = not hasattr(socket, "SO_EXCLUSIVEADDRUSE")

    def __init__(self, address: tuple[str, int], handler: type, failed: Callable[[Exception], None]) -> None:
        """
        Listen on an address.

        handler: answers a request; it calls `admit` once the token has been shown.
        failed: takes an internal error of a request.
        """
        self._failed = failed
        self._lock = threading.Lock()
        #: When each connection without the token was accepted, the oldest first.
        self._strangers: dict[socket.socket, float] = {}
        self._guests: set[socket.socket] = set()
        super().__init__(address, handler)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Begin to answer a connection, for which the oldest without the token makes room."""
        with self._lock:
            # A browser sends its request at once, so that the oldest are those that only hold a connection.
            if len(self._strangers) >= MOST:
                self._drop(next(iter(self._strangers)))
            self._strangers[request] = time.monotonic()
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Answer a connection."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            with self._lock:
                self._strangers.pop(request, None)
                self._guests.discard(request)

    def service_actions(self) -> None:
        """Drop connections that have not shown the token in time."""
        earliest = time.monotonic() - LONGEST
        with self._lock:
            for request in [request for request, begun in self._strangers.items() if begun < earliest]:
                self._drop(request)

    def admit(self, request: socket.socket) -> bool:
        """Return True if a connection that has shown the token is answered."""
        with self._lock:
            if self._strangers.pop(request, None) is None or len(self._guests) >= MOST:
                return False
            self._guests.add(request)
            return True

    def _drop(self, request: socket.socket) -> None:
        """End a connection without the token: its thread reads nothing more, and closes it."""
        del self._strangers[request]
        with contextlib.suppress(OSError):
            request.shutdown(socket.SHUT_RDWR)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say what went wrong inside."""
        error = sys.exc_info()[1]
        # A browser that has gone, or that asks for nothing, is no error.
        if isinstance(error, Exception) and not isinstance(error, OSError):
            self._failed(error)
