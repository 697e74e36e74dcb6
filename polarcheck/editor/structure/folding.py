"""Folding: programs, tools, polar sections, loops, runs of comments."""

from __future__ import annotations

from collections.abc import Iterator

from lsprotocol import types

from polarcheck.editor.structure import block_ranges
from polarcheck.editor.structure.block_ranges import Stretch
from polarcheck.editor.structure.document import Document
from polarcheck.program.execution.listing import Listing

#: The most ranges of a document, if the editor does not say.
_MOST = 5_000


def folding_ranges(document: Document, most: int | None = None) -> list[types.FoldingRange]:
    """Return the ranges that can be folded, the outer ones first; most: of them, as the editor says."""
    kinds: dict[tuple[int, int], types.FoldingRangeKind | None] = {}
    for listing in document.listings:
        for stretch, kind in _stretches(listing):
            first, last = _lines(document, listing, stretch)
            if last > first:
                kinds.setdefault((first, last), kind)
    order = sorted(kinds, key=lambda lines: (lines[0], -lines[1]))
    return [
        types.FoldingRange(start_line=first, end_line=last, kind=kinds[first, last])
        for first, last in order[: _MOST if most is None else most]
    ]


def _stretches(listing: Listing) -> Iterator[tuple[Stretch, types.FoldingRangeKind | None]]:
    for program in listing.programs.programs:
        if program.first < program.end:
            yield Stretch(program.first, block_ranges.last_written(listing, program)), types.FoldingRangeKind.Region
            for group in (block_ranges.tools, block_ranges.polar_sections):
                yield from ((stretch, types.FoldingRangeKind.Region) for stretch in group(listing, program))
            yield from ((stretch, None) for stretch in block_ranges.loops(listing, program))
    yield from ((stretch, types.FoldingRangeKind.Comment) for stretch in block_ranges.comments(listing))


def _lines(document: Document, listing: Listing, stretch: Stretch) -> tuple[int, int]:
    """Return the lines of a stretch as the editor counts them, from 0."""
    blocks = listing.text.blocks
    places = int(blocks.start[stretch.first]), int(blocks.end[stretch.last])
    first, last = (document.text.position(document.text.place_of(position)).line for position in places)
    return first, last
