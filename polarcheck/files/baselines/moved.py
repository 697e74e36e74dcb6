"""Finds the former file of a program that was moved or renamed: most of its blocks must be the same."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from polarcheck.files.baselines.baseline_file import Program
from polarcheck.files.baselines.known_places import SAME, SAME_AS_PART, Versions
from polarcheck.foundation.finding import Outline

#: The share of the blocks of the longer version that must be the same under another name; under the same one SAME.
_SAME_UNDER_OTHER_NAME = SAME_AS_PART
#: Files are compared by so many of their smallest hashes first.
_SMALLEST = 64
#: The most files that are compared block by block with a new one.
_COMPARED = 8


class Similar:
    """Compares files by their smallest hashes, which costs little, and then by their blocks."""

    def __init__(self, programs: Mapping[str, Program]) -> None:
        self._programs = programs
        self._smallest: dict[str, frozenset[int]] = {}

    def among(self, files: Iterable[str], outline: Outline, has_same_name: Callable[[str], bool]) -> dict[str, float]:
        """Return the files whose blocks are mostly those of an outline, with the share of them."""
        smallest = _smallest(outline.hashes)
        ranked = sorted(files, key=lambda file: (-len(smallest & self._of(file)), not has_same_name(file), file))
        shares = {}
        for file in ranked[:_COMPARED]:
            share = Versions(self._programs[file], outline).share
            if share >= (SAME if has_same_name(file) else _SAME_UNDER_OTHER_NAME):
                shares[file] = share
        return shares

    def _of(self, file: str) -> frozenset[int]:
        if file not in self._smallest:
            self._smallest[file] = _smallest(self._programs[file].hashes)
        return self._smallest[file]


def _smallest(hashes: Iterable[int]) -> frozenset[int]:
    return frozenset(sorted(set(hashes))[:_SMALLEST])
