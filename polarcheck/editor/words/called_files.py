"""The programs in the folders of called programs, by their file names."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable

_NAME = re.compile(r"O?0*+(\d{1,8})(?:\.[A-Za-z]{1,4})?", re.IGNORECASE | re.ASCII)
#: Files of a folder that are looked at.
_MOST = 2_000


def numbers(folders: Iterable[str]) -> list[tuple[int, str]]:
    """Return number and file name of the programs in some folders; folders that cannot be listed hold none."""
    found = []
    for folder in folders:
        try:
            with os.scandir(folder) as entries:
                names = sorted(entry.name for entry, _ in zip(entries, range(_MOST), strict=False))
        except OSError:
            continue
        found += [(int(match[1]), name) for name in names if (match := _NAME.fullmatch(name))]
    return found
