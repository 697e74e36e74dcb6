"""Reading a program, the names of files, and writing a file whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from polarcheck.foundation import bounded, record
from polarcheck.foundation.errors import OutputError, SourceError, why
from polarcheck.program.reading.file_names import spelled

STANDARD_INPUT = "-"
#: Opened anew, a pipe or terminal there would be judged as one that lies in a folder.
_STANDARD_INPUTS = (STANDARD_INPUT, "/dev/stdin", "/dev/fd/0", "/proc/self/fd/0")
#: A program of more bytes is not read unless that is asked for.
LARGEST = 64_000_000
_NO_NAMES = ("", os.curdir, os.pardir)
#: Linux follows as many links one behind the other.
_MOST_LINKS = 40


def read_program(path: str, most: int = LARGEST) -> bytes:
    """
    All bytes of a program, at most so many: of a file, of a pipe that somebody writes to, of standard input for `-`.

    A file that is replaced meanwhile is the old one or the new one, never some of both. Raises SourceError where it
    cannot be read, is larger, or is a device or a folder.
    """
    remark = "--max-size SIZE raises the limit"
    try:
        if path not in _STANDARD_INPUTS:
            return bounded.read_file(path, most, remark, pipes=True)
        if sys.stdin is None:
            raise OSError(errno.EBADF, "standard input is closed")
        return bounded.read_stream(sys.stdin.buffer, most, remark)
    except OSError as error:
        raise SourceError(f"{display_path(path) or repr(path)}: {error.strerror or error}") from None


def size(path: str) -> int:
    """Return the size of a file [bytes]; 0 if unknown."""
    try:
        return os.stat(path).st_size  # noqa: PTH116  thousands of them, and Path.stat raises for some names
    except (OSError, ValueError):
        return 0


def is_standard_input(path: str) -> bool:
    """Return True if a path means standard input."""
    return path in _STANDARD_INPUTS


def display_path(path: str | os.PathLike[str]) -> str:
    """
    A path as reports hold it: with slashes, and with the bytes spelled out that are no characters.

    No two paths are shown as one.
    """
    return spelled(os.fspath(path).replace(os.sep, "/"))


class RealPaths:
    """Which file a path means, whatever leads to it."""

    def __init__(self) -> None:
        self._folders: dict[str, str] = {}

    def of(self, path: str) -> str:
        """
        One path for all that mean the same file: through links, and with `.` and `..` gone.

        A link that leads nowhere is itself, as is standard input; another name of a file (hard link) is another file.
        """
        if path == STANDARD_INPUT:
            return path
        folder, name = os.path.split(path)
        try:
            if name in _NO_NAMES or (os.path.islink(path) and os.path.exists(path)):  # noqa: PTH110, PTH114  Path raises for some names
                return os.path.normcase(os.path.realpath(path))
            return os.path.normcase(os.path.join(self.folder(folder or os.curdir), name))  # noqa: PTH118
        except (OSError, ValueError):
            return path  # the working folder is gone, or no file can have this name

    def folder(self, folder: str) -> str:
        """The real path of a folder; each is looked at once, however deep they are nested."""
        inside: list[str] = []
        while folder not in self._folders:
            outer, name = os.path.split(folder)
            if not outer or name in _NO_NAMES or os.path.islink(folder):  # noqa: PTH114
                self._folders[folder] = os.path.realpath(folder)
                break
            inside.append(folder)
            folder = outer
        for path in reversed(inside):
            outer, name = os.path.split(path)
            self._folders[path] = os.path.join(self._folders[outer], name)  # noqa: PTH118
        return self._folders[inside[0] if inside else folder]


def trail(path: str) -> list[str]:
    """
    Return the paths that lead to a file or folder, which need not be there: each link that is followed, with the links
    before it resolved, and at last the path that is meant.
    """
    links: list[str] = []
    try:
        here = os.path.realpath(os.curdir)
        parts = [*reversed(Path(path).parts)]
        while parts:
            part = parts.pop()
            if part == os.pardir:
                here = os.path.dirname(here)  # noqa: PTH120
                continue
            here = os.path.join(here, part)  # noqa: PTH118  an absolute path begins with its root
            if os.path.islink(here) and len(links) < _MOST_LINKS:  # noqa: PTH114
                links.append(here)
                parts += reversed(Path(os.readlink(here)).parts)  # noqa: PTH115
                here = os.path.dirname(here)  # noqa: PTH120
    except (OSError, ValueError):  # the working folder is gone, or no file can have this name
        return [*links, path]
    return [os.path.normcase(step) for step in (*links, here)]


#: What tells whether a file has changed: when it was written, its size and its number; None where there is none.
State = tuple[int, int, int] | None


def state(path: str | Path, of_folder: Callable[[str, int], State] | None = None) -> State:
    """How a file is now. of_folder: tells it of a folder, by its path and number; else a folder is as any file."""
    try:
        status = os.stat(path)  # noqa: PTH116  thousands of them
        if of_folder is not None and stat.S_ISDIR(status.st_mode):
            return of_folder(os.fspath(path), status.st_ino)
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino


def write(
    path: Path,
    text: str | bytes | Iterable[str],
    last: Callable[[Path], None] | None = None,
    *,
    rewrites: bool = False,
) -> None:
    """
    Write a file whole or not at all, whoever reads it at that moment; a text in UTF-8, which may come in pieces.

    A device, a pipe, and what the shell has opened (`>(...)`, /dev/stdout) are written to as they are.

    last: is called with the new file right before it takes the place of the old one, and may raise. rewrites: the file
    may be one that this run has read. Raises OutputError for any other file that it has read, and where it cannot be
    written.
    """
    if not rewrites and (reason := read_by_this_run(path)):
        raise OutputError(f"{display_path(path)}: {reason}")
    data = [text] if isinstance(text, bytes) else _encoded([text] if isinstance(text, str) else text)
    try:
        descriptor = _descriptor(path)
        if descriptor is not None:
            for stream in (sys.stdout, sys.stderr):  # what was printed before may go to the same place
                with contextlib.suppress(OSError, ValueError, AttributeError):
                    stream.flush()
            _send(os.dup(descriptor), data)
        # Not the real path: that of a pipe without a name is no path, `/proc/7/fd/pipe:[1234]`.
        elif path.exists() and not path.is_file():
            # Without waiting: a pipe that nobody reads would be waited for without end.
            _send(os.open(path, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)), data)
        else:
            _replace(Path(os.path.realpath(path)), data, last)
    except (OSError, ValueError) as error:
        raise OutputError(f"{display_path(path)}: {why(error)}") from None


def read_by_this_run(path: Path) -> str:
    """Return in words that a file is one that this run has read; empty if it is not."""
    source = record.read_as(path)
    if source is None:
        return ""
    is_same = os.path.abspath(source) == os.path.abspath(path)  # noqa: PTH100
    named = "it" if is_same else f"it is {display_path(source)}, which"
    return f"{named} is read by this run; name another file"


def _encoded(pieces: Iterable[str]) -> Iterator[bytes]:
    try:
        for piece in pieces:
            yield piece.encode("utf-8")
    except ValueError as error:  # a bug of ours, and no fault of the file that it would be written to
        raise RuntimeError("a report cannot be made") from error


def _descriptor(path: Path) -> int | None:
    """
    The number of the open file of this process that a path means: /dev/stdout, /dev/fd/63, or a link to one of them.

    Opened by its path, it would be written from its beginning, over what others have written.
    """
    if sys.platform == "win32":
        return None
    folders = {os.path.realpath(folder) for folder in ("/dev/fd", "/proc/self/fd")}
    target = os.fspath(path)
    for _ in range(_MOST_LINKS):
        folder, name = os.path.split(target)
        if re.fullmatch("[0-9]{1,9}", name) and os.path.realpath(folder) in folders:
            return int(name)
        if not os.path.islink(target):  # noqa: PTH114
            return None
        target = os.path.join(folder, os.readlink(target))  # noqa: PTH115, PTH118
    return None


def _send(handle: int, data: Iterable[bytes]) -> None:
    if hasattr(os, "set_blocking"):
        os.set_blocking(handle, True)
    # Whoever stops reading has read enough, as behind standard output.
    with contextlib.suppress(BrokenPipeError), os.fdopen(handle, "wb") as file:
        file.writelines(data)


def _replace(target: Path, data: Iterable[bytes], last: Callable[[Path], None] | None) -> None:
    import tempfile

    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".new")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.writelines(data)
            file.flush()
            # Else a machine that goes down could leave an empty file in the place of the old one.
            os.fsync(file.fileno())
        temporary.chmod(_mode(target))
        if last is not None:
            last(temporary)
        temporary.replace(target)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.chmod(0o600)  # else Windows keeps it where it has the mode of a file that is read only
            temporary.unlink()
        raise


def _mode(target: Path) -> int:
    """The permissions that the file has, or that a new one gets."""
    if target.exists():
        return stat.S_IMODE(target.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
