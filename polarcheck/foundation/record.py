"""What a run reads, lists or looks for: one record for outputs, the cache, --watch, --diff-base and the editor."""

from __future__ import annotations

import contextlib
import os
import stat
import time
from collections.abc import Callable, Iterator, Sequence
from contextvars import ContextVar
from itertools import islice
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

from polarcheck.foundation.digest import blake2b

Path_ = str | os.PathLike[str]
Key = TypeVar("Key")
Result = TypeVar("Result")

#: Modification time [ns], size, number and change time [ns] of a file; None if there is none.
Version = tuple[int, int, int, int] | None
#: Some file systems count modification times in steps of two seconds [ns].
_JUST_WRITTEN = 4_000_000_000
#: Bytes of a digest.
_SIZE = 16


class Seen(NamedTuple):
    """
    How a file was before it was read.

    version: its state.
    content: a hash of its content, if it had just been written: a later change need not differ in its state.
    """

    version: Version
    content: int | None = None


class LookUp(NamedTuple):
    """
    A called program that was looked for in the folders of a job; a result depends on those that are missing, too.

    number, name: how the call names it; one of them is None.
    files: path and digest of the files that can hold it; none if there is none.
    """

    number: int | None
    name: str | None
    files: tuple[tuple[str, bytes], ...]


class Record:
    """
    The files and folders that were read, listed or looked for, those that are missing included.

    paths: as they were given, each once, in order.
    seen: how each was before that, by absolute path, as it is written and with all links resolved; None unless asked
    for, since it takes time.
    look_ups: the called programs.
    """

    def __init__(self, *, has_states: bool = False) -> None:
        self.paths: dict[str, None] = {}
        self.seen: dict[str, Seen] | None = {} if has_states else None
        self.look_ups: list[LookUp] = []
        self._names: dict[str, str] = {}
        self._numbers: dict[tuple[int, int], str] = {}
        self._compared = 0

    def add(self, path: str) -> None:
        """Add a file or folder; the first state of a path counts."""
        if path in self.paths:
            return
        self.paths[path] = None
        if self.seen is not None:
            with contextlib.suppress(OSError, ValueError):  # without a working folder, or with a name that no file has
                for name in (os.path.abspath(path), os.path.realpath(path)):  # noqa: PTH100  pathlib is slow
                    self.seen.setdefault(name, Seen(version(path)))

    def include(self, record: Record) -> None:
        """Add the paths of another record, with their states."""
        if self.seen is not None and record.seen is not None:
            for name, state in record.seen.items():
                self.seen.setdefault(name, state)
            self.paths |= dict.fromkeys(record.paths)
        else:
            for path in record.paths:
                self.add(path)

    def same_file(self, path: Path_) -> str | None:
        """Return the path under which a file was recorded, by whatever name; None if it was not, or is missing."""
        if not os.path.lexists(path):
            return None
        for name in islice(self.paths, self._compared, None):
            self._names.setdefault(_real(name), name)
            if (number := _number(name)) is not None:
                self._numbers.setdefault(number, name)
        self._compared = len(self.paths)
        number = _number(path)
        twin = self._numbers.get(number) if number else None
        # A number may be that of a new file meanwhile.
        return self._names.get(_real(path)) or (twin if twin is not None and _number(twin) == number else None)


_RECORD: ContextVar[Record | None] = ContextVar("record", default=None)


@contextlib.contextmanager
def recorded(*, has_states: bool = False) -> Iterator[Record]:
    """Yield the record of what the code inside reads or looks for; it becomes part of the record around it."""
    outer = _RECORD.get()
    record = Record(has_states=has_states or (outer is not None and outer.seen is not None))
    token = _RECORD.set(record)
    try:
        yield record
    finally:
        _RECORD.reset(token)
        if outer is not None:
            outer.include(record)


@contextlib.contextmanager
def unrecorded() -> Iterator[None]:
    """Record nothing of what the code inside reads."""
    token = _RECORD.set(None)
    try:
        yield
    finally:
        _RECORD.reset(token)


def current() -> Record | None:
    """Return the record of the code around the call; None if nothing is recorded."""
    return _RECORD.get()


def note(*paths: Path_) -> None:
    """Record files or folders; call it before they are looked for."""
    record = _RECORD.get()
    if record is not None:
        for path in paths:
            record.add(os.fspath(path))


def note_content(path: Path_, data: bytes) -> None:
    """Record the content of a file that was written a moment ago."""
    record = _RECORD.get()
    seen = None if record is None else record.seen
    for name in {os.path.abspath(path), os.path.realpath(path)} if seen is not None else ():  # noqa: PTH100
        before = seen[name].version if seen is not None and name in seen else None
        if seen is not None and before is not None and time.time_ns() - before[0] < _JUST_WRITTEN:
            seen[name] = Seen(before, hash(data))


def note_look_up(called: tuple[int | None, str | None], files: Sequence[tuple[str, bytes]]) -> None:
    """Record that a called program was looked for. files: path and content of the files that can hold it."""
    record = _RECORD.get()
    if record is not None:
        record.look_ups.append(LookUp(*called, tuple((file, digest(data)) for file, data in files)))


def read_as(path: Path_) -> str | None:
    """Return the path under which this run has read a file, by whatever name; None if it has not."""
    record = _RECORD.get()
    return None if record is None else record.same_file(path)


class Remembered(Generic[Key, Result]):
    """Results by key, each computed once; what it rests on is recorded whenever it is used."""

    def __init__(self) -> None:
        self._results: dict[Key, tuple[Result, Record]] = {}

    def get(self, key: Key, compute: Callable[[], Result]) -> Result:
        """Return the result of a key. compute: returns it the first time."""
        if key in self._results:
            result, record = self._results[key]
            if (outer := _RECORD.get()) is not None:
                outer.include(record)
            return result
        with recorded() as record:
            result = compute()
        self._results[key] = result, record
        return result


def version(path: Path_) -> Version:
    """Return the state of a file, which differs once it is changed, replaced or removed."""
    try:
        status = os.stat(path)  # noqa: PTH116  Path.stat raises for some names
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino, status.st_ctime_ns


def unchanged(path: str, seen: Seen) -> Seen | None:
    """Return how a file is to be seen from now on if it is still as it was; None if it has changed."""
    if version(path) != seen.version:
        return None
    if seen.content is None or seen.version is None:
        return seen
    try:
        is_same = hash(Path(path).read_bytes()) == seen.content
    except OSError:
        return None
    if not is_same:
        return None
    return Seen(seen.version, seen.content if time.time_ns() - seen.version[0] < _JUST_WRITTEN else None)


def digest(data: bytes) -> bytes:
    """Return the digest of the content of a file."""
    return blake2b(data, digest_size=_SIZE).digest()


def _real(path: Path_) -> str:
    """Return the same path for all paths to a file; case is ignored on systems that ignore it."""
    try:
        return os.path.normcase(os.path.realpath(path))
    except (OSError, ValueError):
        return os.fspath(path)


def _number(path: Path_) -> tuple[int, int] | None:
    """Return the identity of a regular file, the same for all its names; None for other files or none."""
    try:
        status = os.stat(path)  # noqa: PTH116  Path.stat raises for some names
    except (OSError, ValueError):
        return None
    # Some network drives of Windows give no file numbers.
    return (status.st_dev, status.st_ino) if stat.S_ISREG(status.st_mode) and status.st_ino else None
