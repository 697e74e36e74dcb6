"""Reading a file whose size and kind nobody vouches for: at most so many bytes, and never from what has no end."""

from __future__ import annotations

import codecs
import contextlib
import errno
import os
import stat
from collections.abc import Callable, Iterator, Sequence
from contextvars import ContextVar
from pathlib import Path
from typing import BinaryIO

#: Read at once, where the size is not known [bytes].
_CHUNK = 1 << 20
_UNITS = ((10**9, "GB"), (10**6, "MB"), (10**3, "kB"))
#: How long a pipe may be open with nobody at its other end [ms].
_PATIENCE = 1000
# Not blocking: a pipe without a writer would keep open() for ever.
_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_BINARY", "O_NOCTTY", "O_NONBLOCK"))

#: The folders, without links to their names, that files are read from; None for all, as the command line does.
_FOLDERS: ContextVar[Sequence[Path] | None] = ContextVar("folders", default=None)


@contextlib.contextmanager
def only_below(folders: Sequence[Path]) -> Iterator[None]:
    """What is done inside reads files from these folders, which have no links to their names, and from nowhere else."""
    token = _FOLDERS.set(folders)
    try:
        yield
    finally:
        _FOLDERS.reset(token)


def may_read(path: str | os.PathLike[str]) -> bool:
    """Whether a file, or what lies in a folder, may be read here, wherever links lead."""
    return _FOLDERS.get() is None or _folder_around(path) is not None


def _folder_around(path: str | os.PathLike[str]) -> Path | None:
    real = Path(os.path.realpath(path))
    return next((folder for folder in _FOLDERS.get() or () if real.is_relative_to(folder)), None)


def read(
    path: str | os.PathLike[str],
    most: int,
    remark: str,
    *,
    pipes: bool = False,
    below: str | os.PathLike[str] | None = None,
) -> bytes:
    """
    All bytes of a file, which has at most so many.

    remark: what is said of a larger file behind `larger than 1 MB; `. pipes: whether a pipe is read, too, as a shell
    hands over `<(...)`; devices and folders never are, nor a pipe that nobody writes to. below: a folder without links
    to its name, which the path begins in and no link of it leads out of.

    Raises OSError, whose strerror says in plain words what is wrong: also for a name that no file can have, and for a
    file that is written to meanwhile. One that is replaced is the old one or the new one.
    """
    try:
        if below is None and _FOLDERS.get() is not None:
            below = _folder_around(path)
            if below is None:
                raise OSError(errno.EACCES, "lies outside the folders that are open")
            path = Path(os.path.realpath(path)).relative_to(below)
        descriptor = _opened(path, pipes) if below is None else _opened_below(below, Path(path).parts)
    except ValueError:
        raise OSError(errno.EINVAL, "no file can have this name") from None
    try:
        status = os.fstat(descriptor)
        _refuse(status.st_mode, pipes)
        if status.st_size > most:
            raise _too_large(most, remark)
        head = _head_of_pipe(descriptor) if stat.S_ISFIFO(status.st_mode) else b""
        data = _whole(lambda count: os.read(descriptor, count), status.st_size + 1, most, remark, head)
        if stat.S_ISREG(status.st_mode) and _version(os.fstat(descriptor)) != _version(status):
            raise OSError(errno.EAGAIN, "was changed while it was read")
        return data
    finally:
        os.close(descriptor)


def read_stream(stream: BinaryIO, most: int, remark: str) -> bytes:
    """
    All bytes of what is open already, such as standard input, likewise.

    Raises OSError as read does.
    """
    import select

    def some(count: int) -> bytes:
        while (found := stream.read(count)) is None:  # nothing yet: whoever opened it does not want to wait
            select.select([stream], [], [])
        return found

    return _whole(some, _CHUNK, most, remark)


def text(data: bytes, otherwise: str = "utf-8") -> str:
    """
    The text of a file as editors and shells save it: UTF-16 where its mark begins it, UTF-8 with or without a mark.

    otherwise: of a text without a mark. Raises ValueError, which says in one line what it is not.
    """
    marks = {codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
    mark = next((mark for mark in marks if data.startswith(mark)), b"")
    encoding = marks.get(mark, otherwise)
    try:
        return data[len(mark) :].decode(encoding)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        place = f"line {line}" if encoding == otherwise else f"byte {error.start + 1}"
        raise ValueError(f"{place} is not {encoding.upper()}; save the file as UTF-8") from None


def megabytes(size: int) -> str:
    """A limit as messages name it: `16 MB`, `2 GB`, `100 kB`, `64 bytes`."""
    unit, name = next(((unit, name) for unit, name in _UNITS if size >= unit), (1, "bytes"))
    return f"{size / unit:.15g} {name}"


def _opened(path: str | os.PathLike[str], pipes: bool, folder: int | None = None, flags: int = 0) -> int:
    # Some devices act as soon as they are opened.
    _refuse(os.stat(path, dir_fd=folder).st_mode, pipes)
    return os.open(path, _FLAGS | flags, dir_fd=folder)


def _opened_below(folder: str | os.PathLike[str], parts: tuple[str, ...]) -> int:
    """Step by step, each part in the folder before it and none through a link, whoever exchanges them meanwhile."""
    # A drive on Windows would begin a path of its own, whatever stands before it.
    if ".." in parts or not parts or parts[0].startswith(("/", "\\")) or Path(*parts).drive:
        raise OSError(errno.EACCES, "lies outside the folder")
    if os.open not in os.supports_dir_fd:
        target = Path(folder, *parts)
        if not Path(os.path.realpath(target)).is_relative_to(os.path.realpath(folder)):
            raise OSError(errno.EACCES, "lies outside the folder")
        return _opened(target, False)
    links = getattr(os, "O_NOFOLLOW", 0)
    held = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        for part in parts[:-1]:
            inner = os.open(part, os.O_RDONLY | os.O_DIRECTORY | links, dir_fd=held)
            os.close(held)
            held = inner
        return _opened(parts[-1], False, held, links)
    finally:
        os.close(held)


def _refuse(mode: int, pipes: bool) -> None:
    if stat.S_ISREG(mode) or (pipes and stat.S_ISFIFO(mode)):
        return
    if stat.S_ISDIR(mode):
        raise OSError(errno.EISDIR, "is a folder, not a file")
    kind = "pipe" if stat.S_ISFIFO(mode) else "socket" if stat.S_ISSOCK(mode) else "device"
    raise OSError(errno.EINVAL, f"is a {kind}, not a file")


def _version(status: os.stat_result) -> tuple[int, int]:
    return status.st_size, status.st_mtime_ns


def _head_of_pipe(descriptor: int) -> bytes:
    """What comes out first, where that must be taken to see whether anybody writes; then reading waits for more."""
    import select

    head = b""
    if not hasattr(select, "poll"):  # on Windows, where no pipe is opened that nobody holds
        return head
    waiting = select.poll()
    waiting.register(descriptor, select.POLLIN)
    if not waiting.poll(_PATIENCE):
        with contextlib.suppress(BlockingIOError):  # raised where a writer is there, and slow
            head = os.read(descriptor, _CHUNK)
            if not head:
                raise OSError(errno.EPIPE, "is a pipe that nobody writes to")
    os.set_blocking(descriptor, True)
    return head


def _whole(read_some: Callable[[int], bytes], first: int, most: int, remark: str, head: bytes = b"") -> bytes:
    """head, and what read_some gives until it gives nothing; first: bytes to ask for first."""
    chunks = [head] if head else []
    left, wanted = most + 1 - len(head), first
    while left > 0 and (chunk := read_some(min(wanted, left))):
        chunks.append(chunk)
        left -= len(chunk)
        wanted = _CHUNK
    if left <= 0:
        raise _too_large(most, remark)
    return b"".join(chunks)


def _too_large(most: int, remark: str) -> OSError:
    return OSError(errno.EFBIG, f"larger than {megabytes(most)}; {remark}")
