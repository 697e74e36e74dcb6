"""The documents that are open in the editor: each is checked when it has changed and nobody has typed for a moment."""

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

#: How long nobody must have typed before a check begins, at least and at most [s]; in between as long as the last took.
_CALM, _LONGEST_CALM = 0.25, 2.0

Signature = tuple[State, ...]


class Buffer:
    """
    A document that is open.

    judged: what was found in the last of its states that a check has come to the end of.
    """

    def __init__(self, uri: str, path: Path, text: OpenText, version: int | None) -> None:
        self.uri = uri
        self.path = path
        self.text = text
        self.version = version
        self.judged: Judged | None = None
        self.calm = _CALM
        self.is_open = True
        self.stopped = threading.Event()
        self.hurry = asyncio.Event()
        self.task: asyncio.Task[None] | None = None
        self.seen: Signature = ()

    def stop(self) -> None:
        """End the check that runs, or is to run: nobody waits for it any more."""
        self.stopped.set()
        if self.task is not None:
            self.task.cancel()


class Buffers:
    """
    All of them, by their names in the protocol.

    folders_of: the folders from which files may be opened for a program. publish: is handed what was found. bug: is
    told of what polarcheck itself does wrong; the check of that state then has no outcome.
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
        """A document has been opened."""
        self.drop(buffer.uri)
        self.open[buffer.uri] = buffer
        self.touch(buffer, 0.0)

    def drop(self, uri: str) -> Buffer | None:
        """A document has been closed."""
        buffer = self.open.pop(uri, None)
        if buffer is not None:
            buffer.is_open = False
            buffer.stop()
        return buffer

    def change(self, buffer: Buffer, text: OpenText, version: int | None) -> None:
        """A document has another text."""
        buffer.text, buffer.version = text, version
        self.touch(buffer, buffer.calm)

    def touch(self, buffer: Buffer, delay: float) -> None:
        """Check a document when nothing has happened to it for so long [s]; what ran for it before is stale."""
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
        buffer.calm = min(max(_CALM, time.monotonic() - begun), _LONGEST_CALM)
        buffer.judged = judged
        try:
            buffer.seen = await self.worker.do(signature, self._watched(judged))
            await self._publish(buffer, judged)
        except Exception as error:
            self._bug(error, str(buffer.path))

    def _judge(self, text: OpenText, path: Path, is_stopped: Callable[[], bool]) -> Judged | None:
        """In the thread: what a check finds, None where nobody waits for it."""
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
        What is found in the present text of a document, once its check has ended; None for one that is not open.

        soon: somebody waits for it: whether they still type does not count.
        """
        buffer = self.open.get(uri)
        while buffer is not None and buffer.is_open and buffer.judged is None and buffer.task is not None:
            if soon:
                buffer.hurry.set()
            # Waiting for a task ends when it is cancelled for a newer one, and does not end it.
            await asyncio.wait([buffer.task])
            if buffer.task.done() and not buffer.task.cancelled() and buffer.judged is None:
                return None
        return buffer.judged if buffer is not None and buffer.is_open else None

    def _watched(self, judged: Judged) -> list[Path]:
        """The files on which an outcome hangs: those read, and the job files that could be there."""
        found = [*judged.read]
        roots = self._folders_of(judged.path)
        for folder in Path(os.path.realpath(judged.path)).parents:
            if not any(folder.is_relative_to(root) for root in roots):
                break
            found += [folder / FILE_NAME, folder / PROJECT]
        return found

    async def look_around(self) -> None:
        """Check each document anew on whose settings or called programs something has changed."""
        for buffer in list(self.open.values()):
            judged = buffer.judged
            if judged is None:
                continue
            seen = await self.worker.do(signature, self._watched(judged))
            if buffer.is_open and buffer.judged is judged and seen != buffer.seen:
                self.touch(buffer, 0.0)


def signature(paths: Sequence[Path]) -> Signature:
    """What tells whether one of some files has changed, come or gone."""
    return tuple(map(state, paths))
