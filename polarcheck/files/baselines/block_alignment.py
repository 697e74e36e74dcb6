"""Aligns the blocks of two versions of a program: which block of the one is which of the other."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Iterator, Sequence

#: Stretches with more blocks taken away and added are parted at blocks that occur once in both.
_MOST_EDITS = 256

_Pair = tuple[int, int]


def aligned(old: Sequence[int], new: Sequence[int]) -> dict[int, int]:
    """
    Return for the indices of equal blocks in `old` those in `new`, in increasing order of both.

    Few changes are found exactly: as many blocks as possible are aligned. Else blocks that occur once in both are
    aligned first (patience diff), then the stretches between them.
    """
    pairs: dict[int, int] = {}
    stretches = [(0, len(old), 0, len(new))]
    while stretches:
        start, end, new_start, new_end = stretches.pop()
        while start < end and new_start < new_end and old[start] == new[new_start]:
            pairs[start] = new_start
            start, new_start = start + 1, new_start + 1
        while start < end and new_start < new_end and old[end - 1] == new[new_end - 1]:
            end, new_end = end - 1, new_end - 1
            pairs[end] = new_end
        if start == end or new_start == new_end:
            continue
        pairs_here = [*_compared(old[start:end], new[new_start:new_end])]
        pairs.update((start + position, new_start + new_at) for position, new_at in pairs_here)
        anchors = [] if pairs_here else _anchors(old, new, (start, end, new_start, new_end))
        if anchors:
            for (position, new_at), (following, new_following) in zip(
                [(start - 1, new_start - 1), *anchors], [*anchors, (end, new_end)], strict=True
            ):
                stretches.append((position + 1, following, new_at + 1, new_following))
            pairs.update(anchors)
    return dict(sorted(pairs.items()))


def _anchors(old: Sequence[int], new: Sequence[int], stretch: tuple[int, int, int, int]) -> list[_Pair]:
    """Return the longest chain of blocks that occur once in both stretches and have the same order in both."""
    start, end, new_start, new_end = stretch
    counts, new_counts = Counter(old[start:end]), Counter(new[new_start:new_end])
    new_at = {
        value: position for position, value in enumerate(new[new_start:new_end], new_start) if new_counts[value] == 1
    }
    once = [
        (position, new_at[value])
        for position, value in enumerate(old[start:end], start)
        if counts[value] == 1 and value in new_at
    ]
    # The longest increasing subsequence of the positions in `new`.
    ends: list[int] = []
    numbers: list[int] = []
    before: list[int] = []
    for number, (_, position) in enumerate(once):
        length = bisect_left(ends, position)
        before.append(numbers[length - 1] if length else -1)
        ends[length : length + 1] = [position]
        numbers[length : length + 1] = [number]
    chain: list[_Pair] = []
    number = numbers[-1] if numbers else -1
    while number >= 0:
        chain.append(once[number])
        number = before[number]
    return chain[::-1]


def _compared(old: Sequence[int], new: Sequence[int]) -> Iterator[_Pair]:
    """
    Yield the pairs of a longest common subsequence, the last first (Myers, An O(ND) Difference Algorithm).

    None where more than _MOST_EDITS blocks have been taken away and added.
    """
    furthest = {1: 0}
    steps: list[dict[int, int]] = []
    for edits in range(min(len(old) + len(new), _MOST_EDITS) + 1):
        steps.append(furthest.copy())
        for diagonal in range(-edits, edits + 1, 2):
            position, _ = _begin(furthest, diagonal, edits)
            while position < len(old) and position - diagonal < len(new) and old[position] == new[position - diagonal]:
                position += 1
            furthest[diagonal] = position
            if position >= len(old) and position - diagonal >= len(new):
                yield from _traced(steps, len(old), len(new))
                return


def _begin(furthest: dict[int, int], diagonal: int, edits: int) -> tuple[int, bool]:
    """Return where a path enters a diagonal, in `old`, from the neighbour that came further; whether one is added."""
    is_added = diagonal == -edits or (diagonal != edits and furthest[diagonal - 1] < furthest[diagonal + 1])
    return furthest[diagonal + 1] if is_added else furthest[diagonal - 1] + 1, is_added


def _traced(steps: Sequence[dict[int, int]], position: int, new_at: int) -> Iterator[_Pair]:
    for edits, furthest in zip(range(len(steps) - 1, -1, -1), reversed(steps), strict=True):
        diagonal = position - new_at
        begin, is_added = _begin(furthest, diagonal, edits)
        while position > begin and new_at > 0:
            position, new_at = position - 1, new_at - 1
            yield position, new_at
        position, new_at = (begin, new_at - 1) if is_added else (begin - 1, new_at)
