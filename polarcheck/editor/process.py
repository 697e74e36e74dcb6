"""The server as a process: standard input and output carry the protocol, and nothing else."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import sys
import threading
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple, SupportsIndex, cast

from polarcheck.editor.messages import NoEditorError, handle_all
from polarcheck.foundation.errors import UsageError

if TYPE_CHECKING:
    from polarcheck.editor.protocol import Protocol
    from polarcheck.editor.server_session import Server

_CHUNK = 1 << 16
#: The longest line of a header [bytes].
_LONGEST_HEADER = 1 << 16


class Streams(NamedTuple):
    """The file descriptors that messages are read from and written to."""

    source: int
    sink: int


def take_streams() -> Streams:
    """
    Reserve standard input and output for the protocol; anything printed afterwards goes to standard error.

    Raises OSError if one of them is closed.
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
    except OSError:  # standard error is closed, too
        os.dup2(nothing, 1)
    return streams


class _Sink:
    """Writes messages; calls `ended` once they can no longer be written."""

    def __init__(self, sink: int, ended: Callable[[], None]) -> None:
        self._sink, self._ended = sink, ended

    def write(self, data: bytes) -> None:
        remaining = memoryview(data)
        try:
            while remaining:
                remaining = remaining[os.write(self._sink, remaining) :]
        except OSError:
            self._ended()

    def close(self) -> None:
        with contextlib.suppress(OSError):
            os.close(self._sink)


class _Input(asyncio.StreamReader):
    """Holds what the editor has sent; drops what comes after the end."""

    _is_ended = False

    def feed_eof(self) -> None:
        self._is_ended = True
        super().feed_eof()

    def feed_data(self, data: Iterable[SupportsIndex]) -> None:
        if not self._is_ended:
            super().feed_data(data)


def serve(server: Server, streams: Streams) -> int:
    """
    Serve the editor until it says `exit` or is gone; return the exit code, 1 if it did not say `shutdown` before.

    Raises KeyboardInterrupt if the process is interrupted or terminated, UsageError if nobody speaks the protocol.
    """
    # What goes wrong is answered or logged at the editor.
    logging.getLogger("pygls").addHandler(logging.NullHandler())
    logging.getLogger("pygls").propagate = False
    try:
        asyncio.run(_serve(server, streams))
    except SystemExit as end:  # of the message `exit`
        return int(end.code or 0)
    return 1


async def _serve(server: Server, streams: Streams) -> None:
    loop = asyncio.get_running_loop()
    loop.set_exception_handler(_log)
    reader = _Input(_LONGEST_HEADER)
    server.protocol.set_writer(_Sink(streams.sink, reader.feed_eof))
    threading.Thread(target=_feed, args=(streams.source, loop, reader), name="input", daemon=True).start()
    try:
        # An incomplete message ends the session, too.
        with contextlib.suppress(asyncio.IncompleteReadError):
            await handle_all(reader, cast("Protocol", server.protocol))
    except NoEditorError as error:
        raise UsageError(f"standard input: {error}: an editor starts the server") from None
    finally:
        server.end()


def _log(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """Log what went wrong in a callback; that a request is cancelled as the session ends is no fault."""
    if not isinstance(context.get("exception"), asyncio.CancelledError):
        loop.default_exception_handler(context)


def _feed(source: int, loop: asyncio.AbstractEventLoop, reader: asyncio.StreamReader) -> None:
    """Read standard input in a thread, and close it: on some systems asyncio can wait for sockets only."""

    def call(function: Callable[..., None], *arguments: bytes) -> bool:
        try:
            loop.call_soon_threadsafe(function, *arguments)
        except RuntimeError:  # the session has ended
            return False
        return True

    while True:
        try:
            data = os.read(source, _CHUNK)
        except OSError:
            data = b""
        if not data:
            call(reader.feed_eof)
            break
        if not call(reader.feed_data, data):
            break
    with contextlib.suppress(OSError):
        os.close(source)
