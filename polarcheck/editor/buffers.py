"""The open documents of the editor; each is checked after a change, once nobody has typed for a moment."""

from __future__ import annotations

import asyncio
import contextlib
import os
import threading
import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from polarcheck.editor.open_text import OpenText
from polarcheck.editor.worker import Worker
from polarcheck.foundation import bounded, record
from polarcheck.foundation.errors import StoppedError
from polarcheck.foundation.record import Seen

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings
    from polarcheck.editor.analysis import Analysis, SettingsOf

#: The least and the most pause after the last key before a check begins; in between, the time of the last check [s]:
#: checks of a program that is typed take half of a processor at most.
_PAUSE, _LONGEST_PAUSE = 0.03, 2.0

Result = TypeVar("Result")


class Buffer:
    """
    An open document.

    judged: the result of its last check; None while its text is newer.
    pause: how long to wait after a change [s].
    is_open: the editor has not closed it.
    stopped: set to cancel the present check.
    hurry: set to check at once.
    task: the present check.
    read: what the last result depends on, by absolute path.
    settings: the last settings that could be used.
    real: the path, with all links resolved.
    """

    def __init__(self, uri: str, path: Path, text: OpenText, version: int | None) -> None:
        self.uri = uri
        self.path = path
        self.text = text
        self.version = version
        self.judged: Analysis | None = None
        self.pause = _PAUSE
        self.is_open = True
        self.stopped = threading.Event()
        self.hurry = asyncio.Event()
        self.task: asyncio.Task[None] | None = None
        self.read: dict[str, Seen] = {}
        self.settings: Settings | None = None
        self.real = os.path.realpath(path)

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
        publish: Callable[[Buffer, Analysis], Awaitable[None]],
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
        self._touch_callers(buffer)

    def drop(self, uri: str) -> Buffer | None:
        """Remove a document that has been closed."""
        buffer = self.open.pop(uri, None)
        if buffer is not None:
            buffer.is_open = False
            buffer.stop()
            self._touch_callers(buffer)
        return buffer

    def change(self, buffer: Buffer, text: OpenText, version: int | None) -> None:
        """Replace the text of a document."""
        buffer.text, buffer.version = text, version
        self.touch(buffer, buffer.pause)
        self._touch_callers(buffer)

    def _touch_callers(self, called: Buffer) -> None:
        """Check the programs again that call a document: its text in the editor counts, saved or not."""
        folder = os.path.dirname(called.real)  # noqa: PTH120
        is_new = called.is_open and record.version(called.real) is None
        for buffer in self.open.values():
            if buffer is not called and (called.real in buffer.read or (is_new and folder in buffer.read)):
                self.touch(buffer, buffer.pause)

    def texts(self) -> dict[str, OpenText]:
        """Return the texts of all documents, by the paths of their files with all links resolved."""
        return {buffer.real: buffer.text for buffer in self.open.values()}

    async def ask(self, function: Callable[[Analysis], Result], analysis: Analysis) -> Result:
        """Apply a function to a result, in the worker thread; it reads files as a check does."""
        return await self.worker.do(_apply, function, analysis, self._folders_of(analysis.path), self.texts())

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
        texts = self.texts()
        analysis = await self.worker.do(self._judge, text, buffer, texts, buffer.stopped.is_set)
        if analysis is None:
            return
        now = self.texts()
        if any(texts.get(path) is not now.get(path) for path in analysis.read):
            self.touch(buffer, buffer.pause)
            return
        buffer.pause = min(max(_PAUSE, time.monotonic() - begun), _LONGEST_PAUSE)
        buffer.judged, buffer.read = analysis, dict(analysis.read)
        if not analysis.error:
            buffer.settings = analysis.settings
        try:
            await self._publish(buffer, analysis)
        except Exception as error:
            self._bug(error, str(buffer.path))

    def _judge(
        self, text: OpenText, buffer: Buffer, texts: Mapping[str, OpenText], is_stopped: Callable[[], bool]
    ) -> Analysis | None:
        """Check a text, in the worker thread; None if the check is cancelled."""
        from polarcheck.editor.analysis import Analysis, judge

        path = buffer.path
        try:
            with bounded.open_in_editor(_data(texts)):
                return judge(text, path, self._settings_of, self._folders_of(path), is_stopped, buffer.settings)
        except StoppedError:
            return None
        except Exception as error:
            self._bug(error, str(path))
            return Analysis(text, path, f"internal error of polarcheck: {type(error).__name__}: {error}")

    async def judged(self, uri: str, *, soon: bool = False) -> Analysis | None:
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

    async def check_stale(self) -> None:
        """Check each document again if a file has changed that its last result depends on."""
        for buffer in list(self.open.values()):
            analysis = buffer.judged
            if analysis is None:
                continue
            now = await self.worker.do(_unchanged, buffer.read)
            if not buffer.is_open or buffer.judged is not analysis:
                continue
            if now is None:
                self.touch(buffer, 0.0)
            else:
                buffer.read = now


def _data(texts: Mapping[str, OpenText]) -> dict[str, Callable[[], bytes]]:
    return {path: partial(getattr, text, "data") for path, text in texts.items()}


def _apply(
    function: Callable[[Analysis], Result], analysis: Analysis, folders: Sequence[Path], texts: Mapping[str, OpenText]
) -> Result:
    with bounded.only_below(folders), bounded.open_in_editor(_data(texts)):
        return function(analysis)


def _unchanged(read: Mapping[str, Seen]) -> dict[str, Seen] | None:
    """Return how files are to be seen from now on; None if one of them has changed."""
    now = {}
    for path, before in read.items():
        seen = record.unchanged(path, before)
        if seen is None:
            return None
        now[path] = seen
    return now
