"""Job files above others: what they set does not apply below, unless the nearer one extends them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from polarcheck.files.settings import job_files
from polarcheck.files.settings.job_files import JobFile, Nearest, Part
from polarcheck.foundation.errors import JobError, enumerated, first_of

#: The most files in a line on them.
_NAMED = 3


#: Keys that are of a lathe: what a job file says of another one is not meant for the programs of this one.
_OF_A_LATHE = frozenset(("limits", "tools", "offsets", "work_offsets", "stock", "program_units"))


class LeftBehind(NamedTuple):
    """
    What a job file leaves behind.

    outer: the job file above it, which it does not extend.
    keys: those that the outer one sets, and that the nearer one and its chain do not.
    """

    outer: Path
    keys: tuple[str, ...]


def left_behind(file: JobFile, nearest: Nearest) -> LeftBehind | None:
    """Return what a job file leaves behind of the next one above it; None if that is nothing, or is meant so."""
    if file.path is None or file.parts[-1].values.is_root:
        return None
    outer = nearest.above(file.path)
    if outer is None or os.path.realpath(outer) in map(os.path.realpath, file.paths):
        return None
    try:
        parts = job_files.load(outer).parts
    except JobError:  # where this file applies, its fault is reported
        return None
    here = {key for part in file.parts for key in part.values.keys}
    if _machine(file.parts) not in (None, _machine(parts)):
        here |= _OF_A_LATHE
    keys = [key for key in dict.fromkeys(key for part in parts for key in part.values.keys) if key not in here]
    return LeftBehind(outer, tuple(keys)) if keys else None


def _machine(parts: Sequence[Part]) -> str | None:
    """Return the lathe that a chain of files names, the nearest last."""
    return next((part.values.machine for part in reversed(parts) if part.values.machine is not None), None)


def warnings(files: Iterable[JobFile], nearest: Nearest) -> list[str]:
    """Return a line for each set of job files that leave the same keys of the same file behind."""
    names: dict[LeftBehind, list[str]] = {}
    for file in files:
        outer = left_behind(file, nearest)
        if outer is not None:
            names.setdefault(outer, []).append(str(file.path))
    return [
        f"{first_of(inner, _NAMED)}: {enumerated(outer.keys)} of {outer.outer} "
        f"{'does' if len(outer.keys) == 1 else 'do'} not apply "
        f'here; extend = ".." takes {"it" if len(outer.keys) == 1 else "them"} over, root = true says that this is '
        "meant"
        for outer, inner in names.items()
    ]
