"""The unified diff of a program before and after fixes, for people."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from polarcheck.program.reading import source
from polarcheck.program.reading.excerpt import visible

_CONTEXT = 3
_SAME, _OLD, _NEW = " -+"

#: A sign (space, - or +) and a line.
_Marked = tuple[str, str]


def difference(path: str, old: bytes, new: bytes, origin: Sequence[int], encoding: str | None) -> list[str]:
    """
    Return the lines of a unified diff, without line ends; empty if nothing differs.

    origin: for each line of the new text its line in the old text (from 1), ascending. The diff is for people, not for
    `patch`: control characters are spelled out, and line ends are left out.
    """
    if old == new:
        return []
    was, now = (_lines(data, path, encoding) for data in (old, new))
    marked = list(_marked(was, now, origin))
    changed = [number for number, (sign, _) in enumerate(marked) if sign != _SAME]
    name = visible(path)
    lines = [f"--- {name}", f"+++ {name}"]
    before = {_OLD: 0, _NEW: 0}
    done = 0
    for first, end in _hunks(changed, len(marked)):
        for sign, opposite in ((_OLD, _NEW), (_NEW, _OLD)):
            before[sign] += sum(mark != opposite for mark, _ in marked[done:first])
        hunk = marked[first:end]
        counts = {sign: sum(mark in (sign, _SAME) for mark, _ in hunk) for sign in (_OLD, _NEW)}
        lines.append("@@ -{} +{} @@".format(*(_span(before[sign], counts[sign]) for sign in (_OLD, _NEW))))
        lines += [visible(sign + line) for sign, line in _in_order(hunk)]
        done = first
    return lines


def _marked(old: list[str], new: list[str], origin: Sequence[int]) -> Iterator[_Marked]:
    """Yield the lines of both texts, each with its sign."""
    from_line = defaultdict[int, list[str]](list)
    for line, of_old in zip(new, origin, strict=True):
        from_line[int(of_old)].append(line)
    for number, line in enumerate(old, 1):
        now = from_line[number]
        if line in now:
            index = now.index(line)
            yield from ((_NEW, added) for added in now[:index])
            yield _SAME, line
            yield from ((_NEW, added) for added in now[index + 1 :])
        else:
            yield _OLD, line
            yield from ((_NEW, added) for added in now)


def _hunks(changed: list[int], count: int) -> Iterator[tuple[int, int]]:
    """Yield (first, end) of each hunk: lines that differ, and the context around them."""
    first = changed[0]
    for number, following in zip(changed, [*changed[1:], None], strict=True):
        if following is None or following - number > 2 * _CONTEXT + 1:
            yield max(first - _CONTEXT, 0), min(number + _CONTEXT + 1, count)
            first = following if following is not None else first


def _in_order(hunk: list[_Marked]) -> Iterator[_Marked]:
    """Yield the lines of a hunk; in each group of adjacent changes the old lines come first."""
    new: list[_Marked] = []
    for marked in hunk:
        if marked[0] == _NEW:
            new.append(marked)
            continue
        if marked[0] == _SAME:
            yield from new
            new = []
        yield marked
    yield from new


def _span(before: int, count: int) -> str:
    """Return a span as in a unified diff: the first line and the count; an empty span names the line before it."""
    return f"{before + 1}" if count == 1 else f"{before + 1 if count else before},{count}"


def _lines(data: bytes, path: str, encoding: str | None) -> list[str]:
    text = source.read_source(data, path, encoding)
    return [text.line_text(line).lstrip("\r") for line in range(1, len(text.line_starts) + 1)]
