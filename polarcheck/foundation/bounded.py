"""Reads a file of unknown size and kind: up to a limit of bytes, and never from an endless source."""

from __future__ import annotations

import codecs
import contextlib
import errno
import os
import stat
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextvars import ContextVar
from pathlib import Path
from typing import BinaryIO

from polarcheck.foundation import record

#: Size of one read where the size of the file is unknown [bytes].
_CHUNK = 1 << 20
_UNITS = ((10**9, "GB"), (10**6, "MB"), (10**3, "kB"))
#: How long a pipe may be open without a writer [ms].
_PATIENCE = 1000
# Non-blocking: open() of a pipe without a writer would never return.
_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_BINARY", "O_NOCTTY", "O_NONBLOCK"))

#: The folders that files may be read from, with all links resolved; None for no restriction, as on the command line.
_FOLDERS: ContextVar[Sequence[Path] | None] = ContextVar("folders", default=None)
_OPEN: ContextVar[Mapping[str, Callable[[], bytes]] | None] = ContextVar("open", default=None)


@contextlib.contextmanager
def open_in_editor(texts: Mapping[str, Callable[[], bytes]]) -> Iterator[None]:
    """Let the code inside read these texts in place of files. texts: functions by paths with all links resolved."""
    token = _OPEN.set(texts)
    try:
        yield
    finally:
        _OPEN.reset(token)


def opened_in(folder: Path) -> list[Path]:
    """Return the files of a folder that are open in the editor, saved or not; its links are resolved."""
    return [path for path in map(Path, _OPEN.get() or ()) if path.parent == folder]


@contextlib.contextmanager
def only_below(folders: Sequence[Path]) -> Iterator[None]:
    """Let the code inside read files from these folders only; their paths have all links resolved."""
    token = _FOLDERS.set(folders)
    try:
        yield
    finally:
        _FOLDERS.reset(token)


def may_read(path: str | os.PathLike[str]) -> bool:
    """Return True if a file, or the content of a folder, may be read, after links are followed."""
    return _FOLDERS.get() is None or _folder_around(path) is not None


def _folder_around(path: str | os.PathLike[str]) -> Path | None:
    real = Path(os.path.realpath(path))
    return next((folder for folder in _FOLDERS.get() or () if real.is_relative_to(folder)), None)


def read_file(
    path: str | os.PathLike[str],
    limit: int,
    remark: str,
    *,
    pipes: bool = False,
    below: str | os.PathLike[str] | None = None,
) -> bytes:
    """
    Return all bytes of a file.

    limit: the largest size [bytes].
    remark: the end of the message for a larger file, after `larger than 1 MB; `.
    pipes: read a pipe, too, such as `<(...)` of a shell. Devices, folders and pipes without a writer are never read.
    below: a folder with all links resolved. The path is relative to it, and no link may lead out of it.

    Raises OSError, whose strerror says in plain words what is wrong: also for an invalid file name, and for a file that
    is written to during the read. A file that is replaced during the read gives the old or the new content.
    """
    file = path if below is None else Path(below, path)
    record.note(file)
    texts = _OPEN.get()
    text = texts.get(os.path.realpath(file)) if texts else None
    if text is not None and (below is not None or may_read(file)):
        if len(data := text()) > limit:
            raise _too_large(limit, remark)
        return data
    data = _read_opened(path, limit, remark, pipes, below)
    record.note_content(file, data)
    return data


def _read_opened(
    path: str | os.PathLike[str], limit: int, remark: str, pipes: bool, below: str | os.PathLike[str] | None
) -> bytes:
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
        if status.st_size > limit:
            raise _too_large(limit, remark)
        head = _head_of_pipe(descriptor) if stat.S_ISFIFO(status.st_mode) else b""
        data = _read_all(lambda count: os.read(descriptor, count), status.st_size + 1, limit, remark, head)
        if stat.S_ISREG(status.st_mode) and _version(os.fstat(descriptor)) != _version(status):
            raise OSError(errno.EAGAIN, "was changed while it was read")
        return data
    finally:
        os.close(descriptor)


def read_stream(stream: BinaryIO, limit: int, remark: str) -> bytes:
    """
    Return all bytes of an open stream, such as standard input, up to the same limit.

    Raises OSError as read_file does.
    """
    import select

    def read_chunk(count: int) -> bytes:
        while (chunk := stream.read(count)) is None:  # a non-blocking stream without data yet
            select.select([stream], [], [])
        return chunk

    return _read_all(read_chunk, _CHUNK, limit, remark)


def decoded(data: bytes, otherwise: str = "utf-8") -> str:
    """
    Decode a text as editors and shells save it: UTF-16 with a byte order mark, UTF-8 with or without one.

    otherwise: the encoding of a text without a mark. Raises ValueError, whose text is one line.
    """
    marks = {codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
    mark = next((mark for mark in marks if data.startswith(mark)), b"")
    encoding = marks.get(mark, otherwise)
    try:
        return data[len(mark) :].decode(encoding)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        location = f"line {line}" if encoding == otherwise else f"byte {error.start + 1}"
        raise ValueError(f"{location} is not {encoding.upper()}; save the file as UTF-8") from None


def megabytes(size: int) -> str:
    """Return a size as messages name it: `16 MB`, `2 GB`, `100 kB`, `64 bytes`."""
    unit, name = next(((unit, name) for unit, name in _UNITS if size >= unit), (1, "bytes"))
    return f"{size / unit:.15g} {name}"


def _opened(path: str | os.PathLike[str], pipes: bool, folder: int | None = None, flags: int = 0) -> int:
    # Some devices act as soon as they are opened.
    _refuse(os.stat(path, dir_fd=folder).st_mode, pipes)
    return os.open(path, _FLAGS | flags, dir_fd=folder)


def _opened_below(folder: str | os.PathLike[str], parts: tuple[str, ...]) -> int:
    """
    Open a file below a folder, one part of its path after the other, and never through a link.

    A part of the path that is exchanged meanwhile cannot redirect it.
    """
    # On Windows a part with a drive would replace all that stands before it.
    if ".." in parts or not parts or parts[0].startswith(("/", "\\")) or Path(*parts).drive:
        raise OSError(errno.EACCES, "lies outside the folder")
    if os.open not in os.supports_dir_fd:
        target = Path(folder, *parts)
        if not Path(os.path.realpath(target)).is_relative_to(os.path.realpath(folder)):
            raise OSError(errno.EACCES, "lies outside the folder")
        return _opened(target, False)
    links = getattr(os, "O_NOFOLLOW", 0)
    parent = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        for part in parts[:-1]:
            inner = os.open(part, os.O_RDONLY | os.O_DIRECTORY | links, dir_fd=parent)
            os.close(parent)
            parent = inner
        return _opened(parts[-1], False, parent, links)
    finally:
        os.close(parent)


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
    """
    Check that a pipe has a writer, then let reads wait for data.

    Returns the bytes that had to be read for this check.
    """
    import select

    head = b""
    if not hasattr(select, "poll"):  # on Windows, where a pipe without a writer cannot be opened
        return head
    waiting = select.poll()
    waiting.register(descriptor, select.POLLIN)
    if not waiting.poll(_PATIENCE):
        with contextlib.suppress(BlockingIOError):  # raised where there is a writer, and it is slow
            head = os.read(descriptor, _CHUNK)
            if not head:
                raise OSError(errno.EPIPE, "is a pipe that nobody writes to")
    os.set_blocking(descriptor, True)
    return head


def _read_all(read_chunk: Callable[[int], bytes], first: int, limit: int, remark: str, head: bytes = b"") -> bytes:
    """Return head and all chunks up to the first empty one; first: the size of the first read [bytes]."""
    chunks = [head] if head else []
    remaining, size = limit + 1 - len(head), first
    while remaining > 0 and (chunk := read_chunk(min(size, remaining))):
        chunks.append(chunk)
        remaining -= len(chunk)
        size = _CHUNK
    if remaining <= 0:
        raise _too_large(limit, remark)
    return b"".join(chunks)


def _too_large(limit: int, remark: str) -> OSError:
    return OSError(errno.EFBIG, f"larger than {megabytes(limit)}; {remark}")
