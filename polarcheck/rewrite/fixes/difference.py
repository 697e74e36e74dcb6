"""The unified diff of a program before and after fixes, for people."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import Match, SequenceMatcher

from polarcheck.program.reading import source
from polarcheck.program.reading.excerpt import visible

_CONTEXT = 3


def difference(path: str, old: bytes, new: bytes, origin: Sequence[int], encoding: str | None) -> list[str]:
    """
    Return the lines of a unified diff, without line ends; empty if nothing differs.

    origin: for each line of the new text its line in the old text (from 1), ascending. The diff is for people, not for
    `patch`: control characters are spelled out, and line ends are left out.
    """
    if old == new:
        return []
    was, now = (_lines(data, path, encoding) for data in (old, new))
    name = visible(path)
    lines = [f"--- {name}", f"+++ {name}"]
    for hunk in _Aligned(was, now, origin).get_grouped_opcodes(_CONTEXT):
        (_, first, _, new_first, _), (_, _, end, _, new_end) = hunk[0], hunk[-1]
        lines.append(f"@@ -{_span(first, end)} +{_span(new_first, new_end)} @@")
        for kind, low, high, new_low, new_high in hunk:
            same = kind == "equal"
            lines += [visible(f"{' ' if same else '-'}{line}") for line in was[low:high]]
            lines += [visible(f"+{line}") for line in now[new_low:new_high] if not same]
    return lines


class _Aligned(SequenceMatcher[str]):
    """Two texts whose lines belong together by their origin, so that nothing has to be searched for."""

    def __init__(self, was: list[str], now: list[str], origin: Sequence[int]) -> None:
        super().__init__()
        self._end = Match(len(was), len(now), 0)
        self._same = [Match(0, 0, 0)]
        for number, (line, origin_line) in enumerate(zip(now, origin, strict=True)):
            first, new_first, size = self._same[-1]
            before = int(origin_line) - 1
            if before < first + size or was[before] != line:
                continue
            if (before, number) == (first + size, new_first + size):
                self._same[-1] = Match(first, new_first, size + 1)
            else:
                self._same.append(Match(before, number, 1))

    def get_matching_blocks(self) -> list[Match]:
        """Return the runs of lines that both have, and the empty one at the end."""
        return [*self._same, self._end]


def _span(first: int, end: int) -> str:
    """Return a span as in a unified diff: the first line and the count; an empty span names the line before it."""
    return f"{end}" if end - first == 1 else f"{first + (end > first)},{end - first}"


def _lines(data: bytes, path: str, encoding: str | None) -> list[str]:
    text = source.read_source(data, path, encoding)
    return [text.line_text(line).lstrip("\r") for line in range(1, len(text.line_starts) + 1)]
