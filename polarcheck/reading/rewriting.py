"""A program that takes the place of the one that was read, in the same file: the old one or the new one, never both."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

from polarcheck.errors import OutputError, SourceError
from polarcheck.reading import files

#: Behind the name of a file that is kept as it was.
ORIGINAL = ".orig"


def rewrite(path: str, old: bytes, new: bytes, *, keep: bool = False) -> None:
    """
    Write a program in the place of the one that was read.

    A link stays, and what it leads to is written; owner, group and mode of the file stay. keep: the old one stays as
    FILE.orig. Raises OutputError for a file that must not be written (read-only, with a second name that would keep
    the old program, changed since it was read, of an owner that the new one cannot have) or cannot, and where
    FILE.orig holds something else.
    """
    name = files.shown(path)
    try:
        target = Path(os.path.realpath(path))
        _refuse(target, name, old)
        status = target.stat()
        if keep:
            _keep(Path(path), name, old, status)

        def finish(written: Path) -> None:
            _hand_over(written, status, name)
            _refuse(target, name, old)

        files.write(target, new, finish)
    except (OSError, ValueError) as error:
        raise OutputError(f"{name}: not fixed: {getattr(error, 'strerror', None) or error}") from None


def _refuse(target: Path, name: str, old: bytes) -> None:
    status = target.stat()
    if not stat.S_ISREG(status.st_mode):
        raise OutputError(f"{name}: not fixed: it is no file that could be written anew")
    if not status.st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH) or not os.access(target, os.W_OK):
        raise OutputError(f"{name}: not fixed: it is read-only")
    if status.st_nlink > 1:
        raise OutputError(f"{name}: not fixed: it has another name (hard link), which would keep the old program")
    try:
        is_same = files.read(str(target), len(old) + 1) == old
    except SourceError:
        is_same = False
    if not is_same:
        raise OutputError(f"{name}: not fixed: it was changed since it was read")


def _keep(path: Path, name: str, old: bytes, status: os.stat_result) -> None:
    """The old program beside the new one, under a name that nothing else has."""
    kept = path.with_name(path.name + ORIGINAL)
    if kept.exists() and kept.is_file() and kept.read_bytes() == old:
        return
    if os.path.lexists(kept):
        raise OutputError(f"{name}: not fixed: {files.shown(str(kept))} is there already, and differs; move it away")
    files.write(kept, old, lambda written: _hand_over(written, status, name))


def _hand_over(written: Path, status: os.stat_result, name: str) -> None:
    """Give a new file the owner, the group and the mode of the program."""
    belongs = written.stat()
    if (belongs.st_uid, belongs.st_gid) != (status.st_uid, status.st_gid) and sys.platform != "win32":
        try:
            os.chown(written, status.st_uid, status.st_gid)
        except OSError:
            owner = f"user {status.st_uid}, group {status.st_gid}"
            raise OutputError(
                f"{name}: not fixed: it belongs to {owner}, to whom you cannot give the new file"
            ) from None
    written.chmod(stat.S_IMODE(status.st_mode))
