"""Lines on a baseline file: what in it has no effect, and what of it no longer occurs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from polarcheck.files.baselines.baseline import Baseline, Leftover
from polarcheck.files.baselines.baseline_file import Contents
from polarcheck.foundation.errors import counted, first_of, suggestion
from polarcheck.program.reading.files import display_path
from polarcheck.rules.rule import load_all

#: The most entries in a line, and the most lines on unknown rules.
_NAMED = 5


def unknown_rules(contents: Contents) -> Iterator[tuple[int, str]]:
    """Yield the line and the rule of each entry whose rule there is not."""
    rules = load_all()
    for line, entry in zip(contents.lines, contents.entries, strict=False):
        if entry.rule not in rules:
            yield line, entry.rule


def of_contents(path: Path, contents: Contents) -> Iterator[str]:
    """Yield lines on entries of unknown rules, and of the first schema."""
    name = display_path(path)
    unknown: dict[str, list[int]] = {}
    for line, rule in unknown_rules(contents):
        unknown.setdefault(rule, []).append(line)
    for rule, lines in [*unknown.items()][:_NAMED]:
        more = f" and {len(lines) - 1} more" if len(lines) > 1 else ""
        near = suggestion(rule, load_all()) or "; `polarcheck baseline prune` drops it"
        yield f"{name}: line {lines[0]}{more}: unknown rule {rule!r}, which silences nothing{near}"
    if len(unknown) > _NAMED:
        yield f"{name}: {len(unknown) - _NAMED} more unknown rules; `polarcheck baseline prune` drops them"
    old = sum(not entry.places for entry in contents.entries)
    if old:
        yield (
            f"{name}: {counted(old, 'line')} of an earlier version of polarcheck, where a finding that is worse now "
            f"stays silent; `polarcheck baseline update` upgrades {_them(old)}"
        )


def of_leftovers(path: Path, baseline: Baseline) -> Iterator[str]:
    """Yield lines on moved files and on known findings that no longer occur."""
    name = display_path(path)
    moved = sorted((old, new) for new, old in baseline.moved.items() if old)
    if moved:
        were = f"{counted(len(moved), 'file')} {'was' if len(moved) == 1 else 'were'}"
        named = first_of([f"{old} is {new}" for old, new in moved], _NAMED)
        yield f"{name}: {were} moved: {named}; `polarcheck baseline update` takes the new paths"
    # Unknown rules have a line of their own.
    leftovers = [leftover for leftover in baseline.leftovers() if leftover.entry.rule in load_all()]
    if leftovers:
        count = sum(leftover.missing for leftover in leftovers)
        occur = "occurs" if count == 1 else "occur"
        yield (
            f"{name}: {counted(count, 'known finding')} no longer {occur}: {first_of(_places(leftovers), _NAMED)}; "
            f"`polarcheck baseline prune` drops {_them(count)}"
        )


def _places(leftovers: Iterable[Leftover]) -> list[str]:
    """Return entries such as `rapid-in-polar in a.nc (2)`, and the files that no longer exist."""
    counts: Counter[str] = Counter()
    for leftover in leftovers:
        entry = leftover.entry
        counts[f"{entry.file}, which is gone" if leftover.is_gone else f"{entry.rule} in {entry.file}"] += (
            leftover.missing
        )
    return [f"{location} ({count})" if count > 1 else location for location, count in counts.items()]


def _them(count: int) -> str:
    return "it" if count == 1 else "them"
