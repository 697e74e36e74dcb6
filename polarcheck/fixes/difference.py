"""What fixes change in a program, as a unified diff for people."""

from __future__ import annotations

import difflib
from collections.abc import Iterator

from polarcheck.reading import source
from polarcheck.reading.excerpt import visible

_CONTEXT = 3


def difference(path: str, old: bytes, new: bytes, encoding: str | None) -> list[str]:
    """
    The lines of a unified diff, without line ends; empty where nothing differs.

    What would act on a terminal is spelled out, and line ends are left away: it is there to be read.
    """
    if old == new:
        return []
    was, now = (_lines(data, path, encoding) for data in (old, new))
    # Most of a long program is the same: to look for that, line by line, takes long.
    head = _alike(was, now)
    tail = _alike(was[head:][::-1], now[head:][::-1])
    head, tail = max(head - _CONTEXT, 0), max(tail - _CONTEXT, 0)
    pieces = (was[head : len(was) - tail], now[head : len(now) - tail])
    groups = difflib.SequenceMatcher(None, *pieces).get_grouped_opcodes(_CONTEXT)
    name = visible(path)
    found = [f"--- {name}", f"+++ {name}"]
    for group in groups:
        first, last = group[0], group[-1]
        spans = ((first[1] + head, last[2] + head), (first[3] + head, last[4] + head))
        found.append("@@ -{} +{} @@".format(*(_span(*span) for span in spans)))
        for tag, begin, end, new_begin, new_end in group:
            if tag == "equal":
                found += [f" {line}" for line in pieces[0][begin:end]]
                continue
            found += [f"-{line}" for line in pieces[0][begin:end]]
            found += [f"+{line}" for line in pieces[1][new_begin:new_end]]
    return found


def _alike(one: list[str], other: list[str]) -> int:
    """How many lines at the head are the same."""
    pairs = zip(one, other, strict=False)
    return next(
        (number for number, (line, of_other) in enumerate(pairs) if line != of_other), min(len(one), len(other))
    )


def _span(begin: int, end: int) -> str:
    """As in a unified diff: the first line and how many; an empty one stands behind a line."""
    count = end - begin
    return f"{begin + 1}" if count == 1 else f"{begin + 1 if count else begin},{count}"


def _lines(data: bytes, path: str, encoding: str | None) -> list[str]:
    return [visible(line) for line in _texts(source.read(data, path, encoding))]


def _texts(text: source.Source) -> Iterator[str]:
    for line in range(1, len(text.line_starts) + 1):
        yield text.line_text(line).lstrip("\r")
