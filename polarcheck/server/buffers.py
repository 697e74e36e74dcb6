"""The open documents of the editor; each is checked after a change, once nobody has typed for a moment."""

from __future__ import annotations

import asyncio
import contextlib
import os
import threading
import time
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from polarcheck.errors import StoppedError
from polarcheck.machines.job import FILE_NAME, PROJECT
from polarcheck.reading.files import State, state
from polarcheck.server.open_text import OpenText
from polarcheck.server.worker import Worker

if TYPE_CHECKING:
    from polarcheck.server.judged import Judged, SettingsOf

#: The least and the most pause after the last key before a check begins; in between, the time of the last check [s].
_PAUSE, _LONGEST_PAUSE = 0.25, 2.0

Signature = tuple[State, ...]


class Buffer:
    """
    An open document.

    judged: the result of its last check; None while its text is newer.
    pause: how long to wait after a change [s].
    is_open: the editor has not closed it.
    stopped: set to cancel the present check.
    hurry: set to check at once.
    task: the present check.
    seen: the state of the files that the last result depends on.
    """

    def __init__(self, uri: str, path: Path, text: OpenText, version: int | None) -> None:
        self.uri = uri
        self.path = path
        self.text = text
        self.version = version
        self.judged: Judged | None = None
        self.pause = _PAUSE
        self.is_open = True
        self.stopped = threading.Event()
        self.hurry = asyncio.Event()
        self.task: asyncio.Task[None] | None = None
        self.seen: Signature = ()

    def stop(self) -> None:
        """Cancel the running or pending check."""
        self.stopped.set()
        if self.task is not None:
            self.task.cancel()


class Buffers:
    """
    All open documents.

    open: the documents by URI.
    settings_of: returns the settings of a program.
    folders_of: returns the folders from which files may be opened for a program.
    publish: takes the result of each check.
    bug: takes each internal error, with the path of the program.
    """

    def __init__(
        self,
        settings_of: SettingsOf,
        folders_of: Callable[[Path], Sequence[Path]],
        publish: Callable[[Buffer, Judged], Awaitable[None]],
        bug: Callable[[Exception, str], None],
    ) -> None:
        self.worker = Worker()
        self.open: dict[str, Buffer] = {}
        self._settings_of, self._folders_of = settings_of, folders_of
        self._publish, self._bug = publish, bug

    def put(self, buffer: Buffer) -> None:
        """Add a document that has been opened."""
        self.drop(buffer.uri)
        self.open[buffer.uri] = buffer
        self.touch(buffer, 0.0)

    def drop(self, uri: str) -> Buffer | None:
        """Remove a document that has been closed."""
        buffer = self.open.pop(uri, None)
        if buffer is not None:
            buffer.is_open = False
            buffer.stop()
        return buffer

    def change(self, buffer: Buffer, text: OpenText, version: int | None) -> None:
        """Replace the text of a document."""
        buffer.text, buffer.version = text, version
        self.touch(buffer, buffer.pause)

    def touch(self, buffer: Buffer, delay: float) -> None:
        """Cancel the check of a document, and check it again after a delay [s] without a change."""
        buffer.stop()
        buffer.stopped, buffer.hurry, buffer.judged = threading.Event(), asyncio.Event(), None
        buffer.task = asyncio.create_task(self._check(buffer, delay))

    async def _check(self, buffer: Buffer, delay: float) -> None:
        if delay:
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(buffer.hurry.wait(), delay)
        text, begun = buffer.text, time.monotonic()
        judged = await self.worker.do(self._judge, text, buffer.path, buffer.stopped.is_set)
        if judged is None:
            return
        buffer.pause = min(max(_PAUSE, time.monotonic() - begun), _LONGEST_PAUSE)
        buffer.judged = judged
        try:
            buffer.seen = await self.worker.do(signature, self._watched(judged))
            await self._publish(buffer, judged)
        except Exception as error:
            self._bug(error, str(buffer.path))

    def _judge(self, text: OpenText, path: Path, is_stopped: Callable[[], bool]) -> Judged | None:
        """Check a text, in the worker thread; None if the check is cancelled."""
        from polarcheck.server.judged import Judged, judge

        try:
            return judge(text, path, self._settings_of, self._folders_of(path), is_stopped)
        except StoppedError:
            return None
        except Exception as error:
            self._bug(error, str(path))
            return Judged(text, path, f"internal error of polarcheck: {type(error).__name__}: {error}")

    async def judged(self, uri: str, *, soon: bool = False) -> Judged | None:
        """
        Return the result of the check of a document's present text, once it is there; None if it is not open.

        soon: check at once, without the pause for typing.
        """
        buffer = self.open.get(uri)
        while buffer is not None and buffer.is_open and buffer.judged is None and buffer.task is not None:
            if soon:
                buffer.hurry.set()
            # asyncio.wait returns when the task is cancelled for a newer one, and does not cancel it itself.
            await asyncio.wait([buffer.task])
            if buffer.task.done() and not buffer.task.cancelled() and buffer.judged is None:
                return None
        return buffer.judged if buffer is not None and buffer.is_open else None

    def _watched(self, judged: Judged) -> list[Path]:
        """Return the files that a result depends on: those read, and the job files that could be created."""
        paths = judged.files_read
        roots = self._folders_of(judged.path)
        for folder in Path(os.path.realpath(judged.path)).parents:
            if not any(folder.is_relative_to(root) for root in roots):
                break
            paths += [folder / FILE_NAME, folder / PROJECT]
        return paths

    async def check_stale(self) -> None:
        """Check each document again whose settings or called programs have changed."""
        for buffer in list(self.open.values()):
            judged = buffer.judged
            if judged is None:
                continue
            seen = await self.worker.do(signature, self._watched(judged))
            if buffer.is_open and buffer.judged is judged and seen != buffer.seen:
                self.touch(buffer, 0.0)


def signature(paths: Sequence[Path]) -> Signature:
    """Return a value that differs once one of these files is changed, created or removed."""
    return tuple(map(state, paths))
