"""Wildcards and ~ on the command line of Windows, whose shells hand them over as they are typed."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable

_MARKS = "*?["


def expanded(arguments: Iterable[str]) -> list[str]:
    """
    The arguments with the files that they name by `*`, `?`, `[...]` and `**`, in order of their names.

    A file that has just this name, as `part[1].nc`, is itself, and so is what no file matches; an option is no file.
    """
    found: list[str] = []
    for argument in arguments:
        own = os.path.expanduser(argument) if argument.startswith("~") else argument  # noqa: PTH111
        is_pattern = any(mark in own for mark in _MARKS) and not own.startswith("-")
        if is_pattern and not os.path.lexists(own):
            found += sorted(glob.glob(own, recursive=True)) or [own]  # noqa: PTH207  Path.glob takes no drive
        else:
            found.append(own)
    return found
