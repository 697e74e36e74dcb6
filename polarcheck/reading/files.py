"""Which files are NC programs, and writing a file whole or not at all."""

from __future__ import annotations

import contextlib
import os
import re
import stat
import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from pathlib import Path

from polarcheck.errors import OutputError, SourceError
from polarcheck.reading.names import spelled

STANDARD_INPUT = "-"
EXTENSIONS = (
    *(".nc", ".ncc", ".cnc", ".tap", ".eia", ".min", ".mpf", ".spf", ".ngc", ".prg"),
    *(".ptp", ".dnc", ".fnc", ".iso", ".din", ".pim", ".gcode", ".gco", ".g"),
)
_SKIPPED_FOLDERS = frozenset(("node_modules", "__pycache__"))
#: O1234, O0001(SB12 RG FRONT), O1234.bak: as controls and transfer programs name what they punch out.
_O_NAME = r"(?i)O\d{2,8}(?:\([^)]*\))?(?:\.[^.]*)?"
_SNIFFED = frozenset(("", ".txt"))
_SNIFFED_BYTES = 4096
_HEAD = r"%(?!PDF|!|%)|[O:]\s?\d{1,8}\b"
_BLOCK = r"(?i)/?\d?\s*(?:N\s?\d+\s*)?(?:[A-Z]\s?[-+]?(?:\d+(?:\.\d*)?|\.\d+)\s*)+(?:\([^)]*\)\s*)*;?"
_BLOCKS_NEEDED, _LINES_LOOKED_AT = 2, 10


def extensions(names: Iterable[str]) -> list[str]:
    """Extensions as they are compared: lower case, with the point."""
    return [f".{name.strip().lower().lstrip('.')}" for name in names if name.strip(" .")]


def walk(folder: str, wanted: Collection[str], failed: Callable[[str], None]) -> Iterator[str]:
    """
    The programs below a folder, in order of their names, as paths that begin with the folder as it is given.

    Hidden files and folders are passed over; a folder that links lead to twice is entered once. failed is told, in one
    line, of folders that cannot be read.
    """
    wanted = frozenset(wanted)
    seen: set[tuple[int, int]] = set()
    # Folders can be nested deeper than functions: the innermost one stands at the end.
    left = [iter(_entries(folder, seen, failed))]
    while left:
        entry = next(left[-1], None)
        if entry is None:
            left.pop()
            continue
        if entry.name.startswith(".") or entry.name in _SKIPPED_FOLDERS:
            continue
        path = entry.path if folder != "." else entry.path.removeprefix(f".{os.sep}")
        if _is_folder(entry):
            left.append(iter(_entries(path, seen, failed)))
        elif is_program(path, wanted):
            yield path if path != STANDARD_INPUT else entry.path


def _entries(folder: str, seen: set[tuple[int, int]], failed: Callable[[str], None]) -> list[os.DirEntry[str]]:
    """What lies in a folder, by name; nothing where it has been seen or cannot be read."""
    try:
        status = Path(folder).stat()
        identity = (status.st_dev, status.st_ino)
        if identity in seen:
            return []
        seen.add(identity)
        with os.scandir(folder) as found:
            return sorted(found, key=lambda entry: entry.name)
    except OSError as error:
        failed(f"{shown(folder)}: {error.strerror}")
        return []


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False


def is_program(path: str, wanted: Collection[str]) -> bool:
    """Whether a file of a folder is an NC program, by its extension, its name, or its first lines."""
    if has_name_of_program(path, wanted):
        return not _is_special(path)
    return _suffix(path) in _SNIFFED and not _is_special(path) and _looks_like_program(path)


def has_name_of_program(path: str, wanted: Collection[str]) -> bool:
    """Whether the name alone is that of an NC program: one of these extensions, or an O-number."""
    return _suffix(path) in wanted or re.fullmatch(_O_NAME, Path(path).name) is not None


def _suffix(path: str) -> str:
    return os.path.splitext(path)[1].lower()  # noqa: PTH122  Path.suffix differs for names that end in a point


def _is_special(path: str) -> bool:
    """A pipe or device, which would be read for ever. A broken link is not: that it cannot be read must be said."""
    try:
        return not stat.S_ISREG(Path(path).stat().st_mode)
    except OSError:
        return False


def _looks_like_program(path: str) -> bool:
    try:
        with Path(path).open("rb") as file:
            data = file.read(_SNIFFED_BYTES)
    except OSError:
        return False
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    text = data.decode("utf-16" if wide else "latin-1", "replace").lstrip("\ufeff\xef\xbb\xbf\0\x11\x12\x13\x14 \t\r\n")
    if re.match(_HEAD, text):
        return True
    lines = [line.strip("\0\r \t") for line in text.split("\n")[:_LINES_LOOKED_AT]]
    return sum(re.fullmatch(_BLOCK, line) is not None for line in lines) >= _BLOCKS_NEEDED


def read(path: str) -> bytes:
    """
    All bytes of a file, or of standard input for `-`.

    Raises SourceError where it cannot be read.
    """
    try:
        return sys.stdin.buffer.read() if path == STANDARD_INPUT else Path(path).read_bytes()
    except OSError as error:
        raise SourceError(f"{shown(path)}: {error.strerror or error}") from None


def shown(path: str) -> str:
    """
    A path as reports hold it: with slashes, and with the bytes spelled out that are no characters.

    No two paths are shown as one.
    """
    return spelled(path.replace(os.sep, "/"))


def write(path: Path, text: str) -> None:
    """
    Write a file whole or not at all, whoever reads it at that moment.

    Raises OutputError where it cannot be written.
    """
    data = text.encode("utf-8")
    try:
        target = Path(os.path.realpath(path))
        if target.exists() and not target.is_file():
            _send(target, data)
        else:
            _replace(target, data)
    except (OSError, ValueError) as error:
        said = getattr(error, "strerror", None) or error
        raise OutputError(f"{shown(str(path))}: {said}") from None


def _send(target: Path, data: bytes) -> None:
    """To a device, or to a pipe that somebody reads: one that nobody reads would be waited for without end."""
    handle = os.open(target, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0))
    if hasattr(os, "set_blocking"):
        os.set_blocking(handle, True)
    with os.fdopen(handle, "wb") as file:
        file.write(data)


def _replace(target: Path, data: bytes) -> None:
    import tempfile

    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".new")
    beside = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            # Else a machine that goes down could leave an empty file in the place of the old one.
            os.fsync(file.fileno())
        beside.chmod(_mode(target))
        beside.replace(target)
    except BaseException:
        with contextlib.suppress(OSError):
            beside.unlink()
        raise


def _mode(target: Path) -> int:
    """The permissions that the file has, or that a new one gets."""
    if target.exists():
        return stat.S_IMODE(target.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
