"""What the walks through folders did not read, counted by ending and in words."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Sequence

from polarcheck.foundation.finding import NotRead
from polarcheck.program.reading.files import RealPaths, display_path
from polarcheck.program.reading.walking import Skipped

#: The most endings in a line.
_NAMED = 8


def once(skipped: Iterable[Skipped], read: Container[str], real: RealPaths) -> list[Skipped]:
    """Return each file and folder once, without those that are read after all. read: real paths."""
    entries: dict[str, Skipped] = {}
    for entry in skipped:
        path = real.of(entry.path)
        if path not in read:
            entries.setdefault(path, entry)
    return list(entries.values())


def never_called(skipped: Sequence[Skipped], called_files: Collection[str], real: RealPaths) -> list[Skipped]:
    """Return the entries without the subprograms that a checked program calls: these were executed there."""
    read = {real.of(path) for path in called_files} if skipped else set()
    return [entry for entry in skipped if entry.reason != "ending" or real.of(entry.path) not in read]


def by_ending(skipped: Iterable[Skipped]) -> list[NotRead]:
    """Return how many files of each ending may be programs and were not read, the most frequent first."""
    files: dict[str, list[str]] = {}
    for entry in skipped:
        if entry.reason in ("ending", "device"):
            files.setdefault(entry.ending.lower(), []).append(entry.path)
    counts = [NotRead(ending, len(paths), display_path(paths[0])) for ending, paths in files.items()]
    return sorted(counts, key=lambda entry: (-entry.files, entry.ending))


def excluded(skipped: Iterable[Skipped]) -> int:
    """Return how many programs are excluded."""
    return sum(entry.programs for entry in skipped if entry.reason == "excluded")


def none_in_folder(skipped: Sequence[Skipped]) -> str:
    """Return why a walk found no program, and what would find one."""
    names = [f"{entry.files} {entry.ending or 'without ending'}" for entry in by_ending(skipped)[:_NAMED]]
    if names:
        return f"no NC programs in this folder, but {', '.join(names)}; --extensions names other endings"
    if excluded(skipped):
        return "all NC programs in this folder are excluded"
    return "no NC programs in this folder; --extensions names other endings"
