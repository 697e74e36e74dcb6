"""
Serves pages to browsers on this machine, and tells them of new ones.

Only 127.0.0.1 is listened on, only pages that were put here are served, and only below a token that nobody can guess:
other users of the machine cannot read them, nor pages of other sites (the name of the host is verified, so that none
leads here by a name of its own). They cannot keep a browser away either: connections that have not shown the token make
room for newer ones, and are closed after a time.
"""

from __future__ import annotations

import contextlib
import json
import secrets
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, NamedTuple
from urllib.parse import SplitResult, urlsplit

from polarcheck.foundation.errors import OutputError, why

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


#: The only address.
ADDRESS = "127.0.0.1"
#: The names by which a browser on this machine, or behind a tunnel, may ask.
_HOSTS = (ADDRESS, "localhost")
#: The address below the token that tells of new versions of a page: `events/NAME`.
EVENTS = "events/"
#: The time for a browser to send some of a request, or to take some of an answer [s].
_TIMEOUT = 10.0
#: A browser that has gone is noticed after this time [s].
_BEAT = 5.0
_HEADERS = (
    ("Cache-Control", "no-store"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
    ("Referrer-Policy", "no-referrer"),
    ("X-Content-Type-Options", "nosniff"),
    ("X-Frame-Options", "SAMEORIGIN"),
)


class Served(NamedTuple):
    """
    A page, or a file that pages share.

    read: returns its bytes.
    kind: its media type.
    version: changes with its content.
    notice: why it is not up to date; empty if it is.
    """

    read: Callable[[], bytes]
    kind: str
    version: str
    notice: str = ""


class Site:
    """The pages by their names; threads of the server read them while the main thread puts new ones."""

    def __init__(self) -> None:
        self._pages: dict[str, Served] = {}
        self._changed = threading.Condition()
        self._is_open = True

    def put(self, name: str, page: Served) -> None:
        """Add or replace a page; its notice is gone."""
        with self._changed:
            self._pages[name] = page
            self._changed.notify_all()

    def notice(self, name: str, text: str) -> None:
        """Say on a page why it is not up to date; a page that is not there has no notice."""
        with self._changed:
            if name in self._pages and self._pages[name].notice != text:
                self._pages[name] = self._pages[name]._replace(notice=text)
                self._changed.notify_all()

    def get(self, name: str) -> Served | None:
        """Return a page; None if there is none of this name."""
        with self._changed:
            return self._pages.get(name)

    def names(self) -> list[str]:
        """Return the names of all pages."""
        with self._changed:
            return list(self._pages)

    def close(self) -> None:
        """End all events."""
        with self._changed:
            self._is_open = False
            self._changed.notify_all()

    def events(self, name: str) -> Iterator[tuple[str, str] | None]:
        """Yield version and notice of a page, at first and after each change; None after a time without a change."""
        before: tuple[str, str] | None = None
        while True:
            with self._changed:
                if self._is_open and self._event(name) == before:
                    self._changed.wait(_BEAT)
                if not self._is_open:
                    return
                now = self._event(name)
            yield None if now == before else now
            before = now

    def _event(self, name: str) -> tuple[str, str]:
        page = self._pages.get(name)
        return ("", "") if page is None else (page.version, page.notice)


class Server:
    """
    The server of a site.

    address: where its first page is.
    answers: it has been started.
    """

    def __init__(self, site: Site, port: int, failed: Callable[[Exception], None]) -> None:
        """
        Listen on a port; 0 takes a free one.

        failed: takes an internal error of a request. Raises OutputError if the port is taken.
        """
        token = secrets.token_urlsafe(16)
        handler = type("Handler", (_Handler,), {"site": site, "root": f"/{token}/", "timeout": _TIMEOUT})
        self._site = site
        try:
            self._server = Connections((ADDRESS, port), handler, failed)
        except (OSError, OverflowError) as error:
            raise OutputError(f"--port {port}: {why(error)}") from None
        self.answers = False
        self.address = f"http://{ADDRESS}:{self._server.server_address[1]}/{token}/"
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.1,), daemon=True)

    def __enter__(self) -> Server:
        """Return the server, which does not answer yet."""
        return self

    def __exit__(self, *error: object) -> None:
        """Answer no more."""
        self._site.close()
        if self.answers:
            self._server.shutdown()
        self._server.server_close()

    def start(self) -> None:
        """Begin to answer."""
        self.answers = True
        self._thread.start()


class _Handler(BaseHTTPRequestHandler):
    """Answers one request."""

    site: Site
    root: str
    server: Connections
    url: SplitResult
    server_version, sys_version = "polarcheck", ""

    def parse_request(self) -> bool:
        """Return True for a request; answer anything else."""
        try:
            if not super().parse_request():
                return False
            self.url = urlsplit(self.path)
        except ValueError:  # also of http.client, for some types of content
            self._refuse(HTTPStatus.BAD_REQUEST)
            return False
        return True

    def do_GET(self) -> None:
        """Answer with a page, or with events until the browser goes."""
        self._answer(with_content=True)

    def do_HEAD(self) -> None:
        """Answer without the content."""
        self._answer(with_content=False)

    def _answer(self, *, with_content: bool) -> None:
        if not self._is_from_here():
            self._refuse(HTTPStatus.MISDIRECTED_REQUEST)
            return
        path = self.url.path
        if not secrets.compare_digest(path[: len(self.root)].encode(), self.root.encode()):
            self._refuse(HTTPStatus.NOT_FOUND)
            return
        if not self.server.admit(self.connection):
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE)
            return
        name = path[len(self.root) :]
        if name.startswith(EVENTS) and self.site.get(name.removeprefix(EVENTS)) is not None:
            self._begin("text/event-stream", None)
            if with_content:
                self._tell(name.removeprefix(EVENTS))
            return
        page = self.site.get(name)
        if page is None:
            self._refuse(HTTPStatus.NOT_FOUND)
            return
        data = page.read()
        self._begin(page.kind, len(data))
        if with_content:
            self.wfile.write(data)

    def _is_from_here(self) -> bool:
        """Return True if the browser asked for this machine by its address, not by a name that leads here."""
        host = self.url.netloc or self.headers.get("Host", "")
        return host.rpartition(":")[0] in _HOSTS if ":" in host else host in _HOSTS

    def _begin(self, kind: str, length: int | None) -> None:
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", kind)
        if length is not None:
            self.send_header("Content-Length", str(length))
        for header, value in _HEADERS:
            self.send_header(header, value)
        self.end_headers()

    def _refuse(self, status: HTTPStatus) -> None:
        self.send_error(status, explain=" ")

    def _tell(self, name: str) -> None:
        """Send events until the browser goes or the server ends."""
        with contextlib.suppress(OSError):
            for event in self.site.events(name):
                data = (
                    b":\n\n"
                    if event is None
                    else f"data: {json.dumps(dict(zip(_FIELDS, event, strict=True)))}\n\n".encode()
                )
                self.wfile.write(data)
                self.wfile.flush()

    def log_message(self, *words: object) -> None:
        """Write no log."""


_FIELDS = ("version", "notice")
