"""The server as a process: standard input and output hold the protocol, and nothing else."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from pygls.io_ import run_async

if TYPE_CHECKING:
    from polarcheck.server.session import Server

_CHUNK = 1 << 16
#: Of a line of a header; what is longer is none [bytes].
_LONGEST_HEADER = 1 << 16


class Streams(NamedTuple):
    """Where messages come from, and where they go."""

    source: int
    sink: int


def own_streams() -> Streams:
    """
    Take standard input and output for the protocol: what anybody prints from here on goes to standard error.

    Raises OSError where one of them is closed.
    """
    streams = Streams(os.dup(0), os.dup(1))
    if sys.platform == "win32":
        import msvcrt

        for stream in streams:
            msvcrt.setmode(stream, os.O_BINARY)
    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, 0)
    try:
        os.dup2(2, 1)
    except OSError:  # nobody reads errors either
        os.dup2(nothing, 1)
    return streams


class _Sink:
    """Writes messages; once nobody reads them, the session has ended."""

    def __init__(self, sink: int, ended: Callable[[], None]) -> None:
        self._sink, self._ended = sink, ended

    def write(self, data: bytes) -> None:
        left = memoryview(data)
        try:
            while left:
                left = left[os.write(self._sink, left) :]
        except OSError:
            self._ended()

    def close(self) -> None:
        with contextlib.suppress(OSError):
            os.close(self._sink)


def serve(server: Server, streams: Streams) -> int:
    """
    Answer the editor until it says that it ends, or is gone; the exit code, 1 where it did not say so before.

    Raises KeyboardInterrupt where the process is interrupted or terminated.
    """
    try:
        asyncio.run(_serve(server, streams))
    except SystemExit as end:  # of the message `exit`
        return int(end.code or 0)
    return 1


async def _serve(server: Server, streams: Streams) -> None:
    loop = asyncio.get_running_loop()
    reader = asyncio.StreamReader(_LONGEST_HEADER)
    server.protocol.set_writer(_Sink(streams.sink, reader.feed_eof))
    threading.Thread(target=_feed, args=(streams.source, loop, reader), name="input", daemon=True).start()
    try:
        # What breaks off within a message, or begins none, is the end, too.
        with contextlib.suppress(asyncio.IncompleteReadError, ValueError):
            await run_async(threading.Event(), reader, server.protocol, error_handler=server.report_server_error)
    finally:
        server.end()


def _feed(source: int, loop: asyncio.AbstractEventLoop, reader: asyncio.StreamReader) -> None:
    """In a thread: what can be waited for like a socket is a socket alone, on some systems."""

    def tell(function: Callable[..., None], *given: bytes) -> bool:
        try:
            loop.call_soon_threadsafe(function, *given)
        except RuntimeError:  # the session has ended
            return False
        return True

    while True:
        try:
            data = os.read(source, _CHUNK)
        except OSError:
            data = b""
        if not data:
            tell(reader.feed_eof)
            return
        if not tell(reader.feed_data, data):
            return
