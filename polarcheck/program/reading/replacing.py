"""Replaces a program in its file, whole or not at all."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

from polarcheck.foundation.errors import OutputError, SourceError, why
from polarcheck.program.reading import files

#: Suffix of the copy of the old program.
ORIGINAL = ".orig"


def rewrite(path: str, old: bytes, new: bytes, *, keep: bool = False) -> None:
    """
    Replace the old program of a file by a new one.

    A link stays a link, and its target is written; owner, group and mode of the file do not change. keep: a copy of the
    old program is written to FILE.orig. Raises OutputError for a file that cannot or must not be written (read-only,
    with a second name that would have the old program, changed since it was read, of another owner), or where FILE.orig
    contains something else.
    """
    name = files.display_path(path)
    try:
        target = Path(os.path.realpath(path))
        _refuse(target, name, old)
        status = target.stat()
        if keep:
            _keep(Path(path), name, old, status)

        def finish(written: Path) -> None:
            _hand_over(written, status, name)
            _refuse(target, name, old)

        files.write(target, new, finish, rewrites=True)
    except (OSError, ValueError) as error:
        raise OutputError(f"{name}: not written: {why(error)}") from None


def _refuse(target: Path, name: str, old: bytes) -> None:
    status = target.stat()
    if not stat.S_ISREG(status.st_mode):
        raise OutputError(f"{name}: not written: it is no file that could be written anew")
    if not status.st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH) or not os.access(target, os.W_OK):
        raise OutputError(f"{name}: not written: it is read-only")
    if status.st_nlink > 1:
        raise OutputError(f"{name}: not written: it has another name (hard link), which would keep the old program")
    try:
        is_same = files.read_program(str(target), len(old) + 1) == old
    except SourceError:
        is_same = False
    if not is_same:
        raise OutputError(f"{name}: not written: it was changed since it was read")


def _keep(path: Path, name: str, old: bytes, status: os.stat_result) -> None:
    """Write a copy of the old program, unless another file has its name."""
    copy = path.with_name(path.name + ORIGINAL)
    if copy.exists() and copy.is_file() and copy.read_bytes() == old:
        return
    if os.path.lexists(copy):
        raise OutputError(
            f"{name}: not written: {files.display_path(copy)} is there already, and differs; move it away"
        )
    files.write(copy, old, lambda written: _hand_over(written, status, name))


def _hand_over(written: Path, status: os.stat_result, name: str) -> None:
    """Give a new file the owner, the group and the mode of the program."""
    present = written.stat()
    if (present.st_uid, present.st_gid) != (status.st_uid, status.st_gid) and sys.platform != "win32":
        try:
            os.chown(written, status.st_uid, status.st_gid)
        except OSError:
            owner = f"user {status.st_uid}, group {status.st_gid}"
            raise OutputError(
                f"{name}: not written: it belongs to {owner}, to whom you cannot give the new file"
            ) from None
    written.chmod(stat.S_IMODE(status.st_mode))
