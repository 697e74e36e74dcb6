"""The patterns that decide what walks read, `exclude` and `extensions`, and which of them had no effect."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from polarcheck.files.settings.job_files import JobFile
from polarcheck.files.settings.job_layers import Layer
from polarcheck.foundation.errors import UsageError
from polarcheck.program.machines.value_types import display
from polarcheck.program.reading.globs import Globs, is_pattern
from polarcheck.program.reading.walking import extensions


class WalkPatterns:
    """
    Says which pattern excludes an entry of a folder, and records it.

    excluded: the patterns of --exclude, which begin at the working folder.
    spelled: returns an option as its user writes it, for messages.
    """

    def __init__(self, excluded: Sequence[str], spelled: Callable[[str], str] = str) -> None:
        """Raises UsageError for a text that is no pattern."""
        self._spelled = spelled
        for pattern in excluded:
            if not is_pattern(pattern):
                raise UsageError(
                    f"{spelled('--exclude')}: expected a pattern such as O12*.nc or lathe7/**, found {display(pattern)}"
                )
        self._excluded = list(excluded)
        self._globs = Globs(os.path.realpath(os.curdir), excluded) if excluded else None
        self._used: set[int] = set()
        self._used_of: dict[Path, set[int]] = {}

    def of_folder(self, file: JobFile, folder: str) -> Callable[[str, bool], str] | None:
        """
        Return a function for the pattern that excludes a name in a folder and where it stands; None without patterns.

        folder: a real path.
        """
        globs, layer = file.exclude, file.excluding
        if self._globs is None and not globs:
            return None
        used = self._used_of.setdefault(layer.written.path, set()) if layer is not None else set()

        def excluded_by(name: str, is_folder: bool) -> str:
            if self._globs is not None and (numbers := self._globs.itself(folder, name, is_folder=is_folder)):
                self._used |= numbers
                return f"{self._spelled('--exclude')} {display(self._excluded[min(numbers)])}"
            if globs and layer and (numbers := globs.itself(folder, name, is_folder=is_folder)):
                used.update(numbers)
                return f"{layer.at('exclude')}: {display(layer.excluded[min(numbers)])}"
            return ""

        return excluded_by

    def is_within(self, file: JobFile, folder: str, name: str, *, is_folder: bool) -> bool:
        """Return True if a file or folder is excluded, or a folder around it. name: empty for the folder itself."""
        return any(
            globs and (globs.of_folder(folder) or (name and globs.itself(folder, name, is_folder=is_folder)))
            for globs in (self._globs, file.exclude)
        )

    def unused_options(self, names: Sequence[str], programs: Iterable[str]) -> list[str]:
        """Return a line for each --exclude that excludes nothing, and each --extensions that no program has."""
        unused = [pattern for number, pattern in enumerate(self._excluded) if number not in self._used]
        without_file = _unused_extensions(names, programs) if names else []
        return [
            *(f"{self._spelled('--exclude')} {display(pattern)} excludes nothing" for pattern in unused),
            *(f"{self._spelled('--extensions')}: no file ends in {display(name)}" for name in without_file),
        ]

    def unused_in(self, file: JobFile) -> list[str]:
        """Return a line for each pattern of `exclude` that excludes nothing."""
        layer = file.excluding
        used = self._used_of.get(layer.written.path) if layer is not None else None
        if layer is None or used is None:
            return []
        return [
            f"{layer.at('exclude')}: exclude: {display(pattern)} excludes nothing"
            for number, pattern in enumerate(layer.excluded)
            if number not in used
        ]


def unused_extensions(layer: Layer, programs: Iterable[str]) -> list[str]:
    """Return a line for each ending that a job file lists and none of its programs has."""
    return [
        f"{layer.at('extensions')}: extensions: no file of this folder ends in {display(name)}"
        for name in _unused_extensions(layer.extensions, programs)
    ]


def _unused_extensions(names: Sequence[str], programs: Iterable[str]) -> list[str]:
    used = {os.path.splitext(program)[1].lower() for program in programs}  # noqa: PTH122
    return [name for name in names if not used.issuperset(extensions([name]))]
