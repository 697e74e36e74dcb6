"""
A crew behind an executor: of a cluster, or any other that has the interface of concurrent.futures.

It may share no file with this machine. So the bytes of the programs are read here and sent, and with the settings, once
for each of those who check, the programs that may be called.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import pickle
import shutil
import tempfile
import threading
import zlib
from collections import OrderedDict, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError, Executor, Future, wait
from pathlib import Path
from typing import TypeVar

import msgspec

from polarcheck import __version__
from polarcheck.checking import crews
from polarcheck.checking.batch import Outcome, Task, forget, outcome
from polarcheck.checking.crews import Lost, Result, Sent, Work
from polarcheck.checking.settings import Settings
from polarcheck.errors import CrewError, SourceError
from polarcheck.execution import library
from polarcheck.reading import files

#: Sent at once: it takes some milliseconds to have something done on a cluster [files, bytes].
_MOST, _MOST_BYTES = 100, 5_000_000
#: Settings that those who check remember.
_REMEMBERED = 64
#: Programs that may be called, of one job [bytes].
_MOST_CALLED = 200_000_000
#: After this time without a result the executor is asked whether it is still there [s].
_QUIET = 5.0
#: How long it may take to take its work back [s].
_TO_CANCEL = 5.0
Value = TypeVar("Value")


class Batch(msgspec.Struct, frozen=True):
    """
    What is sent: number, path, key of the settings and bytes of each file.

    settings: those that may not be known there yet, by key, as pack makes them. version: of polarcheck.
    """

    version: str
    items: list[tuple[int, str, str, bytes]]
    settings: dict[str, bytes]


class Answer(msgspec.Struct, frozen=True):
    """What comes back: what came of each file, or the settings that are not known there. version: of polarcheck."""

    version: str
    found: list[tuple[int, Sent]] = []
    unknown: list[str] = []


class OnExecutor:
    """
    A crew behind an executor, with room for so many files at once. whose: how messages name it. ask: raises OSError,
    RuntimeError or CancelledError where nobody answers there any more.

    Raises CrewError where programs that may be called are too many to be sent.
    """

    most, most_bytes, is_here = _MOST, _MOST_BYTES, False

    def __init__(
        self,
        tasks: Sequence[Task],
        executor: Executor,
        jobs: int,
        most: int,
        whose: str,
        ask: Callable[[], None] = lambda: None,
    ) -> None:
        self.jobs, self._ask = jobs, ask
        self._tasks, self._executor, self._most, self._whose = tasks, executor, most, whose
        self._given: dict[Future[Answer], list[tuple[int, str, str, bytes]]] = {}
        self._unread: deque[Result] = deque()
        self._packed: dict[int, tuple[str, bytes]] = {}
        self._first: dict[str, int] = {}

    def has_room(self, alone: bool) -> bool:
        """Whether somebody may soon have nothing to do."""
        return len(self._given) < 2 * self.jobs

    def give(self, work: Work) -> None:
        """Read the files and send them."""
        items = []
        for number in work.numbers:
            task = self._tasks[number]
            try:
                data = files.read(task.path, self._most)
            except SourceError as error:
                self._unread.append((number, Outcome(failure=str(error))))
            else:
                items.append((number, task.path, self._key(task.settings), data))
        if items:
            self._send(items, self._not_yet_known({key for _, _, key, _ in items}))

    def _key(self, settings: Settings) -> str:
        if id(settings) not in self._packed:
            packed = pack(settings)
            self._packed[id(settings)] = hashlib.sha256(packed).hexdigest(), packed
        return self._packed[id(settings)][0]

    def _not_yet_known(self, keys: set[str]) -> set[str]:
        """Those that hardly anybody has seen yet; who does not know others says so, and gets them."""
        for key in keys:
            self._first[key] = self._first.get(key, 0) + 1
        return {key for key in keys if self._first[key] <= self.jobs}

    def _send(self, items: list[tuple[int, str, str, bytes]], keys: Iterable[str]) -> None:
        known = dict(self._packed.values())
        batch = Batch(__version__, items, {key: known[key] for key in keys})
        try:
            self._given[self._executor.submit(check_batch, batch)] = items
        except Exception as error:  # of any executor, which is shut down or broken
            raise CrewError(f"{self._whose} takes no more files: {error or type(error).__name__}") from error

    def results(self) -> Iterable[Result]:
        """What has come back; what went wrong on the way is given back to be sent again."""
        if not self._unread and self._given:
            while not wait(self._given, _QUIET, "FIRST_COMPLETED").done:
                try:
                    self._ask()
                except (OSError, RuntimeError, CancelledError):
                    self._given.clear()  # to cancel them it would be asked again
                    raise CrewError(f"{self._whose} does not answer any more") from None
        yield from self.finished()

    def finished(self) -> Iterable[Result]:
        """What has come back, without waiting."""
        while self._unread:
            yield self._unread.popleft()
        for future in [one for one in self._given if one.done()]:
            yield from self._answered(future, self._given.pop(future))

    def _answered(self, future: Future[Answer], items: list[tuple[int, str, str, bytes]]) -> Iterator[Result]:
        try:
            answer = future.result()
        except CancelledError:
            raise CrewError(f"{self._whose} is gone") from None
        except ImportError as error:
            raise CrewError(f"{self._whose}: polarcheck {__version__} is wanted on all workers: {error}") from None
        except Exception:  # somebody has ended; by which of the files nobody knows
            yield from ((number, Lost.ENDED) for number, _, _, _ in items)
            return
        if answer.version != __version__:
            raise CrewError(f"{self._whose}: a worker has polarcheck {answer.version}, this is {__version__}")
        if answer.unknown:
            self._send(items, answer.unknown)
        for number, found in answer.found:
            yield number, found.unpacked()

    def close(self) -> None:
        """Nothing more is wanted."""
        given = list(self._given)
        self._given.clear()
        if given:
            with contextlib.suppress(TimeoutError):  # the client of a cluster waits for the answer
                in_time(lambda: [future.cancel() for future in given], _TO_CANCEL)


def in_time(function: Callable[[], Value], seconds: float) -> Value:
    """
    What a function gives or raises within this time; else TimeoutError, and its thread is left behind.

    For calls of a library that have no limit of their own.
    """
    future: Future[Value] = Future()

    def run() -> None:
        try:
            future.set_result(function())
        except Exception as error:
            future.set_exception(error)
        except BaseException:  # that of asyncio where a loop ends, which would pass all handlers of the caller
            future.set_exception(CancelledError())

    threading.Thread(target=run, daemon=True).start()
    return future.result(seconds)


def pack(settings: Settings) -> bytes:
    """
    Settings, and all programs in the folders of subprograms, which the programs may call.

    Raises CrewError where these are too many.
    """
    folders = [library.contents(folder) for folder in settings.job.run.subprograms]
    size = sum(len(data) for folder in folders for data in folder.values())
    if size > _MOST_CALLED:
        named = ", ".join(files.shown(folder) for folder in settings.job.run.subprograms)
        raise CrewError(f"{named}: {size / 1e6:.0f} MB of subprograms are too much to be sent; name folders with less")
    return zlib.compress(pickle.dumps((settings, folders), pickle.HIGHEST_PROTOCOL), 1)


def check_batch(batch: Batch) -> Answer:
    """What those who check do."""
    if batch.version != __version__:
        return Answer(__version__)
    for key, packed in batch.settings.items():
        _REMEMBER(key, packed)
    keys = {key for _, _, key, _ in batch.items}
    settings = {key: known for key in keys if (known := _REMEMBER(key)) is not None}
    if unknown := sorted(keys - settings.keys()):
        return Answer(__version__, unknown=unknown)
    found = []
    for number, path, key, data in batch.items:
        found.append((number, crews.sent(outcome(Task(path, settings[key]), data=data))))
        forget()
    return Answer(__version__, found)


class _Remembered:
    """The last settings that were sent to this process, and the folders that were made of their subprograms."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, tuple[Settings, Path | None]] = OrderedDict()

    def __call__(self, key: str, packed: bytes | None = None) -> Settings | None:
        """Settings by their key; packed: as they were sent."""
        if key not in self._known and packed is not None:
            self._known[key] = _unpacked(packed)
            while len(self._known) > _REMEMBERED:
                _, (_, folder) = self._known.popitem(last=False)
                _remove(folder)
        if key not in self._known:
            return None
        self._known.move_to_end(key)
        return self._known[key][0]


_REMEMBER = _Remembered()


def _unpacked(packed: bytes) -> tuple[Settings, Path | None]:
    # A cluster runs what it is sent anyway: whoever may send it settings may send it programs of Python.
    settings, folders = pickle.loads(zlib.decompress(packed))  # noqa: S301
    if not folders:
        return settings, None
    import atexit

    made = Path(tempfile.mkdtemp(prefix="polarcheck-"))
    atexit.register(functools.partial(_remove, made))
    paths = []
    for number, contents in enumerate(folders):
        folder = made / str(number)
        folder.mkdir()
        for name, data in contents.items():
            (folder / name).write_bytes(data)
        paths.append(str(folder))
    run = msgspec.structs.replace(settings.job.run, subprograms=paths)
    job = msgspec.structs.replace(settings.job, run=run)
    return msgspec.structs.replace(settings, job=job), made


def _remove(folder: Path | None) -> None:
    if folder is not None:
        shutil.rmtree(folder, ignore_errors=True)
