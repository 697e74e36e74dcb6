"""The outline: programs, their tools, polar sections, labels and the N blocks that mean something, with comments."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from lsprotocol import types

from polarcheck.editor.section_lenses import sections_by_line, summary
from polarcheck.editor.structure import block_ranges
from polarcheck.editor.structure.document import Document, is_written
from polarcheck.editor.structure.mention import Kind, Role
from polarcheck.editor.structure.mentions import mentions_of
from polarcheck.foundation.finding import PolarSection
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import Program
from polarcheck.program.reading.excerpt import shortened, visible
from polarcheck.program.reading.words import Spans

#: The most N blocks and labels of a program; and the longest name [characters].
_MOST, _LONGEST = 2_000, 80
#: Where more of the blocks than one in so many have numbers, and more than a few, a number alone means nothing.
_SPARSE, _FEW = 4, 20


def symbols(document: Document, sections: Sequence[PolarSection] = ()) -> list[types.DocumentSymbol]:
    """Return the programs with all that stands in them; sections: of the last report, for their details."""
    return [
        _of_program(document, listing, program, sections)
        for listing in document.listings
        for program in listing.programs.programs
        if np.any(is_written(listing)[program.first : program.end])
    ]


def _of_program(
    document: Document, listing: Listing, program: Program, sections: Sequence[PolarSection]
) -> types.DocumentSymbol:
    text = listing.text
    name = f"O{program.number:04d}" if program.number is not None else _name_of(program, document)
    channel = f"{text.source.channel}: " if text.source.channel else ""
    last = block_ranges.last_written(listing, program)
    comment = _comment(listing, program.first) if program.has_head else ""
    kind = types.SymbolKind.Function
    symbol = _symbol(document, listing, program.first, last, channel + name, kind, comment)
    inside = [*_tools(document, listing, program), *_sections(document, listing, program, sections)]
    symbol.children = _nested([*inside, *_numbered(document, listing, program)])
    return symbol


def _name_of(program: Program, document: Document) -> str:
    return f"<{program.name}>" if program.name else document.path.name


def _symbol(
    document: Document, listing: Listing, first: int, last: int, name: str, kind: types.SymbolKind, detail: str
) -> types.DocumentSymbol:
    blocks = listing.text.blocks
    begin, end = int(blocks.start[first]), int(blocks.end[last])
    whole = document.range(begin, end)
    head = document.range(begin, min(int(blocks.end[first]), end))
    return types.DocumentSymbol(
        name=shortened(visible(name.strip()), _LONGEST) or "-",
        detail=visible(detail) or None,
        kind=kind,
        range=whole,
        selection_range=head,
        children=[],
    )


def _tools(document: Document, listing: Listing, program: Program) -> Iterator[types.DocumentSymbol]:
    for stretch in block_ranges.tools(listing, program):
        name = " ".join(listing.text.without_comments(stretch.first).split())
        comment = _comment(listing, stretch.first) or _comment_above(listing, stretch.first, program)
        yield _symbol(document, listing, *stretch, name, types.SymbolKind.Class, comment)


def _sections(
    document: Document, listing: Listing, program: Program, sections: Sequence[PolarSection]
) -> Iterator[types.DocumentSymbol]:
    of_channel = [section for section in sections if (section.channel or "") == listing.text.source.channel]
    by_line = sections_by_line(of_channel)
    for stretch in block_ranges.polar_sections(listing, program):
        line = int(listing.text.blocks.line[stretch.first])
        detail = summary(*by_line[line]) if line in by_line else ""
        name = " ".join(listing.text.without_comments(stretch.first).split())
        yield _symbol(document, listing, *stretch, name, types.SymbolKind.Namespace, detail)


def _numbered(document: Document, listing: Listing, program: Program) -> Iterator[types.DocumentSymbol]:
    """Yield the N blocks with a comment, those that something leads to, and all of them where they are few; labels."""
    mentions = next(named for named in mentions_of(document) if named.listing is listing)
    heads = [named for named in mentions.of_program(program) if named.role is Role.DEFINES]
    numbers = [named for named in heads if named.kind is Kind.SEQUENCE]
    led_to = {
        named.name
        for named in mentions.of_program(program)
        if named.role is Role.REFERS and named.kind is Kind.SEQUENCE
    }
    commented = set(listing.text.comments.block.tolist())
    is_sparse = len(numbers) <= max((program.end - program.first) // _SPARSE, _FEW)
    listed = [named for named in numbers if is_sparse or named.block in commented or named.name in led_to]
    listed += [named for named in heads if named.kind is Kind.LABEL]
    for named in sorted(listed, key=lambda mention: mention.start)[:_MOST]:
        name = f"N{named.written}" if named.kind is Kind.SEQUENCE else named.written
        comment = _comment(listing, named.block)
        yield _symbol(document, listing, named.block, named.block, name, types.SymbolKind.Key, comment)


def _nested(symbols: Sequence[types.DocumentSymbol]) -> list[types.DocumentSymbol]:
    """Put each symbol into the innermost one around it; a tool whose section goes on behind it stands beside it."""
    order = {types.SymbolKind.Class: 0, types.SymbolKind.Namespace: 1}
    roots: list[types.DocumentSymbol] = []
    outer: list[types.DocumentSymbol] = []
    for symbol in sorted(symbols, key=lambda nested: (_begin(nested), order.get(nested.kind, 2))):
        while outer and _end(outer[-1]) < _end(symbol):
            outer.pop()
        children = outer[-1].children if outer else roots
        assert isinstance(children, list)
        children.append(symbol)
        if symbol.kind in order:
            outer.append(symbol)
    return roots


def _begin(symbol: types.DocumentSymbol) -> tuple[int, int]:
    return symbol.range.start.line, symbol.range.start.character


def _end(symbol: types.DocumentSymbol) -> tuple[int, int]:
    return symbol.range.end.line, symbol.range.end.character


def _comment(listing: Listing, block: int) -> str:
    """Return the first comment of a block, without what encloses it."""
    return next(_comments(listing, listing.text.comments, block), "")


def _comments(listing: Listing, spans: Spans, block: int) -> Iterator[str]:
    low, high = np.searchsorted(spans.block, (block, block + 1)).tolist()
    for index in range(low, high):
        written = listing.text.written(spans, index)
        yield shortened(written.lstrip("(;").rstrip().removesuffix(")").strip(), _LONGEST)


def _comment_above(listing: Listing, block: int, program: Program) -> str:
    """Return the comment on the line before a block, if nothing else stands there."""
    if block - 1 <= program.first:
        return ""
    text = listing.text
    has_words = bool(text.blocks.is_macro[block - 1]) or bool(np.any(text.words.block == block - 1))
    return "" if has_words else _comment(listing, block - 1)
