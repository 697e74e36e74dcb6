"""Reading a file whose size and kind nobody vouches for: at most so many bytes, and never from what has no end."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

#: Read at once, where the size is not known [bytes].
_CHUNK = 1 << 20
#: How long a pipe may be open with nobody at its other end [ms].
_PATIENCE = 1000
# Not blocking: a pipe without a writer would keep open() for ever.
_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_BINARY", "O_NOCTTY", "O_NONBLOCK"))


def read(path: str | os.PathLike[str], most: int, remark: str, *, pipes: bool = False) -> bytes:
    """
    All bytes of a file, which has at most so many.

    remark: what is said of a larger file behind `larger than 1 MB; `. pipes: whether a pipe is read, too, as a shell
    hands over `<(...)`; devices and folders never are, nor a pipe that nobody writes to.

    Raises OSError, whose strerror says in plain words what is wrong: also for a name that no file can have.
    """
    try:
        _refuse(Path(path).stat().st_mode, pipes)  # some devices act as soon as they are opened
        descriptor = os.open(path, _FLAGS)
    except ValueError:
        raise OSError(errno.EINVAL, "no file can have this name") from None
    try:
        status = os.fstat(descriptor)
        _refuse(status.st_mode, pipes)
        if status.st_size > most:
            raise _too_large(most, remark)
        head = _head_of_pipe(descriptor) if stat.S_ISFIFO(status.st_mode) else b""
        return _whole(lambda count: os.read(descriptor, count), status.st_size + 1, most, remark, head)
    finally:
        os.close(descriptor)


def read_stream(stream: BinaryIO, most: int, remark: str) -> bytes:
    """
    All bytes of what is open already, such as standard input, likewise.

    Raises OSError as read does.
    """
    return _whole(stream.read, _CHUNK, most, remark)


def megabytes(size: int) -> str:
    """A limit as messages name it: `16 MB`."""
    return f"{size / 1e6:g} MB"


def _refuse(mode: int, pipes: bool) -> None:
    if stat.S_ISREG(mode) or (pipes and stat.S_ISFIFO(mode)):
        return
    if stat.S_ISDIR(mode):
        raise OSError(errno.EISDIR, "is a folder, not a file")
    raise OSError(errno.EINVAL, f"is a {'pipe' if stat.S_ISFIFO(mode) else 'device'}, not a file")


def _head_of_pipe(descriptor: int) -> bytes:
    """What comes out first, where that must be taken to see whether anybody writes; then reading waits for more."""
    import select

    waiting = select.poll()
    waiting.register(descriptor, select.POLLIN)
    head = b""
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
