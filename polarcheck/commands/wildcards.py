"""Expands wildcards and ~ on Windows, whose shells pass them unexpanded."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable

_MARKS = "*?["


def expanded(arguments: Iterable[str]) -> list[str]:
    """
    Return the arguments with `*`, `?`, `[...]` and `**` expanded, sorted by name.

    An existing file, such as `part[1].nc`, is not expanded; nor is an option, or a pattern without a match.
    """
    names: list[str] = []
    for argument in arguments:
        pattern = os.path.expanduser(argument) if argument.startswith("~") else argument  # noqa: PTH111
        is_pattern = any(mark in pattern for mark in _MARKS) and not pattern.startswith("-")
        if is_pattern and not os.path.lexists(pattern):
            names += sorted(glob.glob(pattern, recursive=True)) or [pattern]  # noqa: PTH207  Path.glob takes no drive
        else:
            names.append(pattern)
    return names
