"""The text of a file as one table of words, whatever the bytes. Bad text is marked, never raised."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, Table, first_in_run, is_among, mask_at, side_by_side, stretch
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.reading.characters import KINDS, Character
from polarcheck.program.reading.language_blocks import extract_statements
from polarcheck.program.reading.letters import read_as_digits
from polarcheck.program.reading.numbers import NumberFault, faulty_numbers, read_numbers
from polarcheck.program.reading.prose import find_prose
from polarcheck.program.reading.source import CTRL_Z, LF, Bytes, Positions, Source
from polarcheck.program.reading.surroundings import BLANKS, Ranges, foreign, narrow, read_surroundings, united

__all__ = ["Blocks", "NumberFault", "Spans", "Text", "Words", "read_words"]


_COMMA, _COLON, _SLASH, _STAR, _POINT = b",:/*."
_UPPER = np.arange(256, dtype=np.uint8)
_UPPER[97:123] -= 32
_UPPER[_COLON] = ord("O")
#: Macro statements that need neither bracket nor variable, by whether a number follows; at the head of a block.
_STATEMENTS = {b"GOTO": False, b"GO": True, b"DO": True, b"END": True, b"EN": True, b"WHILE": False} | dict.fromkeys(
    (b"POPEN", b"PCLOS"), False
)
_BEGINS_STATEMENT = is_among(np.arange(256), [letters[0] for letters in _STATEMENTS])


class Words(Table, frozen=True, dict=True):
    """
    The words of a file in order, one element each.

    address: uint8, the upper case letter; lower case where a comma stands before it (,R); 0 for a number without one.
    value, decimals, digits, has_point, fault: see numbers.Numbers.
    block: index into Blocks.
    start, end: character positions, end exclusive.
    """

    address: NDArray[np.uint8]
    value: Floats
    decimals: NDArray[np.int32]
    digits: NDArray[np.int32]
    has_point: Mask
    fault: NDArray[np.uint8]
    block: Positions
    start: Positions
    end: Positions

    @cached_property
    def is_unreadable(self) -> Mask:
        """The control cannot read the number; of adjacent words without digits, as in prose, only the first counts."""
        bad = (self.fault != NumberFault.NONE) & (self.fault != NumberFault.WRONG_DASH)
        empty = self.fault == NumberFault.NO_DIGITS
        follows = np.append(False, empty[:-1] & empty[1:] & (self.block[1:] == self.block[:-1]))[: len(self)]
        return np.asarray(bad & ~follows)

    @property
    def has_wrong_dash(self) -> Mask:
        """A typographic dash is written for a minus sign."""
        return np.asarray(self.fault == NumberFault.WRONG_DASH)


class Blocks(Table, frozen=True):
    """
    The blocks of a file in order, empty ones included; a block ends at a line end or `;`.

    start, end: character positions, end exclusive.
    line: from 1.
    is_macro: it has macro statements or expressions, so that its words are not in the table.
    """

    start: Positions
    end: Positions
    line: Positions
    is_macro: Mask


class Spans(Table, frozen=True):
    """
    Spans of text.

    start, end: character positions, end exclusive.
    block: index into Blocks of each.
    """

    start: Positions
    end: Positions
    block: Positions


class Text(msgspec.Struct, frozen=True):
    """
    The result of reading one file.

    source: the file.
    words: the words of blocks without macro.
    blocks: all blocks.
    comments: in parentheses, or up to the end of the line.
    unclosed, nested: per comment, True where it lacks its end or contains another opening parenthesis.
    names: of programs, <...>.
    strays: characters that are part of no word.
    foreign: runs of characters outside the ISO set, also in comments.
    prose: text outside of parentheses, read as a comment.
    dots: lines of points, which stand for omitted blocks.
    outside: text before and after the programs.
    tape_marks: positions of % at the head or end of a line.
    letters: positions of letters O and I that are read as the digits 0 and 1.
    labels: names at the heads of blocks, for jumps (NEND).
    """

    source: Source
    words: Words
    blocks: Blocks
    comments: Spans
    unclosed: Mask
    nested: Mask
    names: Spans
    strays: Spans
    foreign: Spans
    prose: Spans
    dots: Spans
    outside: Spans
    tape_marks: Positions
    letters: Positions
    labels: Spans

    def written(self, table: Words | Blocks | Spans, index: int) -> str:
        """Return the characters of an element of one of its tables."""
        return self.source.excerpt(int(table.start[index]), int(table.end[index]))

    def written_blocks(self) -> list[str]:
        """Return the characters of each block: quicker than one by one."""
        text = self.source.text
        return [text[start:end] for start, end in side_by_side(self.blocks.start, self.blocks.end)]

    def without_comments(self, block: int, further: Sequence[tuple[int, int]] = ()) -> str:
        """Return a block with blanks in the places of its comments, and of further spans of the file."""
        offset, rows = int(self.blocks.start[block]), slice(*stretch(self.comments.block, block, block + 1))
        characters = list(self.written(self.blocks, block))
        for start, end in (*side_by_side(self.comments.start[rows], self.comments.end[rows]), *further):
            characters[start - offset : end - offset] = " " * (end - start)
        return "".join(characters)


def read_words(
    source: Source,
    line_comments: str = "",
    channel_mark: str = "",
    wait_mark: str = "",
    language: str = "custom-macro",
    *,
    blanks_in_numbers: bool = True,
) -> Text:
    """
    Read a file, or a channel of it.

    line_comments, channel_mark, wait_mark: as in read_surroundings. language: of its statements, see language_blocks.
    blanks_in_numbers: the control ignores a blank inside a number; where not, the word has a fault.
    """
    data = source.code.tobytes()
    end_of_data = data.find(CTRL_Z)  # ends a file of old DOS transfers
    if end_of_data < 0:
        end_of_data = len(data)
    stored = data[:end_of_data]
    lines_end_at_cr = data.find(b"\n") < 0
    code = np.frombuffer(bytearray(stored.replace(b"\r", b"\n") if lines_end_at_cr else stored), np.uint8)
    extracted = extract_statements(code, language)
    around = read_surroundings(code, line_comments, channel_mark, wait_mark)
    letters = read_as_digits(code)
    prose = find_prose(source, code)
    if len(prose):
        letters = np.union1d(letters, read_as_digits(code))
    prose = united(prose, around.tags)
    table = _read_pieces(code.tobytes())
    _mark_alignment(table.words, code)
    if not blanks_in_numbers:
        _mark_blanks(table.words, code)
    breaks = table.breaks[:-1]
    starts = np.append(breaks[:0], 0)
    starts = np.append(starts, breaks + 1).astype(breaks.dtype)
    line = np.cumsum(np.append(True, code[breaks] == LF), dtype=breaks.dtype)
    if extracted.is_joined:
        line = np.searchsorted(source.line_starts, starts, side="right").astype(breaks.dtype)
    is_macro = mask_at(len(starts), _block_of(table.macro, starts))
    is_macro[_block_of(extracted.statements, starts)] = True
    is_macro[table.words.block[_begins_statement(table.words)]] = True
    words = _only(table.words, ~is_macro[table.words.block])
    blocks = Blocks(
        starts, np.append(breaks, breaks.dtype.type(len(code))), np.minimum(line, len(source.line_starts)), is_macro
    )

    def spans(ranges: Ranges) -> Spans:
        return Spans(ranges.start, ranges.end, _block_of(ranges.start, starts))

    strays = table.strays[_is_reported(table, code, is_macro, starts)]
    strays = np.sort(
        np.concatenate((strays, _outside_prose(around.strays, prose, starts), extracted.commas, extracted.quotes))
    )
    outside = around.outside
    names = united(united(around.names, extracted.heads), extracted.programs)
    if data[end_of_data + 1 :].translate(None, BLANKS + b"\n"):
        outside = Ranges(np.append(outside.start, end_of_data), np.append(outside.end, len(data)))
    return Text(
        source=source,
        words=_with_names(words, names.start),
        blocks=blocks,
        comments=spans(around.comments),
        unclosed=around.unclosed,
        nested=around.nested,
        names=spans(names),
        strays=spans(Ranges(strays, strays + 1)),
        foreign=spans(foreign(stored)),
        prose=spans(prose),
        dots=spans(table.dots),
        outside=spans(outside),
        tape_marks=around.tape_marks,
        letters=letters,
        labels=spans(extracted.labels),
    )


def _block_of(positions: Positions, starts: Positions) -> Positions:
    """The block in which each position lies."""
    return starts.searchsorted(positions, side="right") - 1


def _outside_prose(strays: Positions, prose: Ranges, starts: Positions) -> Positions:
    """The % signs outside of blocks with prose, as 50% OF THE SPEED."""
    return strays[~is_among(_block_of(strays, starts), _block_of(prose.start, starts))]


def _is_reported(table: _Piece, code: Bytes, is_macro: Mask, starts: Positions) -> Mask:
    """
    True for stray characters outside of macro statements, or at the end of one, where * may be an operator; and for
    decimal commas in statements, but not between the arguments in brackets.
    """
    block = _block_of(table.strays, starts)
    in_statement, is_star = is_macro[block], code[table.strays] == _STAR
    reported = ~in_statement | (table.is_last_stray & (~is_star | np.any(is_star & ~in_statement)))
    for index in np.flatnonzero(in_statement & (code[table.strays] == _COMMA)).tolist():
        stray = int(table.strays[index])
        before = code[int(starts[block[index]]) : stray].tobytes()
        is_argument = before.count(b"[") > before.count(b"]")
        reported[index] |= (
            not is_argument and _DECIMAL_COMMA.match(code[stray - 1 : stray + 2].tobytes(), 1) is not None
        )
    return np.asarray(reported)


_DECIMAL_COMMA = lazy_pattern(rb"(?<=[0-9]),(?=[0-9])")
#: Size of the pieces of a text that are read at once [characters]: they fit into the cache, which is faster.
_PIECE = 1 << 18
#: Where a longer line may be cut: before a word, but not before a corner word (,C ,R ,A).
_CUT = lazy_pattern(rb"[\nBD-QS-Zbd-qs-z]|(?<=[A-Za-z0-9.])[ACRacr]")


class _Piece(msgspec.Struct, frozen=True):
    """
    The result of reading a text, or a piece of it.

    words: its words.
    breaks: positions of the ends of its blocks.
    dots: lines of points.
    strays: positions of characters that are part of no word.
    is_last_stray: per stray, True at the end of a block.
    macro: positions of signs of macro statements.
    """

    words: Words
    breaks: Positions
    dots: Ranges
    strays: Positions
    is_last_stray: Mask
    macro: Positions


def _read_pieces(text: bytes) -> _Piece:
    """The words and blocks of a text without comments; the end of the text is the last break."""
    size = narrow(len(text))
    pieces: list[_Piece] = []
    begin = blocks = 0
    while begin <= len(text):
        end = text.find(b"\n", begin + _PIECE, begin + 2 * _PIECE)
        if end < 0:
            cut = _CUT.search(text, begin + _PIECE)
            end = cut.start() if cut else len(text)
        piece = _read_piece(text[begin:end], size(begin), size(blocks))
        in_line = end < len(text) and text[end] != LF
        pieces.append(msgspec.structs.replace(piece, breaks=piece.breaks[:-1]) if in_line else piece)
        blocks += len(pieces[-1].breaks)
        begin = end if in_line else end + 1
    return _Piece(
        Words.concatenated([piece.words for piece in pieces]),
        np.concatenate([piece.breaks for piece in pieces]),
        Ranges.concatenated([piece.dots for piece in pieces]),
        np.concatenate([piece.strays for piece in pieces]),
        np.concatenate([piece.is_last_stray for piece in pieces]),
        np.concatenate([piece.macro for piece in pieces]),
    )


def _read_piece(text: bytes, offset: np.signedinteger[Any], blocks: np.signedinteger[Any]) -> _Piece:
    """Read one piece. Blanks are removed first; an additional break at its head saves many special cases."""
    text = b"\n" + text + b"\n"
    positions = np.flatnonzero(np.frombuffer(text.translate(KINDS), np.uint8) != Character.BLANK).astype(type(offset))
    positions += offset - type(offset)(1)
    text = text.translate(None, BLANKS)
    marks = _Marks(
        np.frombuffer(text, np.uint8),
        np.frombuffer(text.translate(KINDS), np.uint8),
        positions,
        positions,
        positions[:0],
    )
    strays = macro = positions[:0]
    is_last_stray = np.zeros(0, bool)
    if marks.kind.max() > Character.COMMA:
        marks, strays, is_last_stray, macro = _without_others(marks)
    breaks = np.flatnonzero(marks.kind == Character.BREAK)
    words, dots = _words(marks, breaks)
    words.block.__iadd__(blocks)
    return _Piece(words, marks.at[breaks[1:]], dots, strays, is_last_stray, macro)


class _Marks(msgspec.Struct, frozen=True):
    """
    The characters of words and the ends of blocks, without blanks.

    code, kind: of each character.
    at: its position in the text.
    start: as `at`, but for the letter of a corner word the position of the comma before it.
    corners: indices of these letters.
    """

    code: Bytes
    kind: Bytes
    at: Positions
    start: Positions
    corners: Positions


def _without_others(marks: _Marks) -> tuple[_Marks, Positions, Mask, Positions]:
    """
    Remove characters that are part of no word: strays, and signs of macro statements.

    A comma between two digits is a stray that is read as the decimal point for which it stands. So is one at the end of
    a number, where there are fewer points.
    """
    code, kind, start = marks.code, marks.kind.copy(), marks.start.copy()
    index = np.flatnonzero(kind > Character.COMMA)
    before, follower = kind[index - 1], code[index + 1]
    kind[index[(code[index] == _COLON) & (before == Character.BREAK)]] = Character.LETTER  # stands for O
    kind[index[(code[index] == _STAR) & (kind[index + 1] == Character.BREAK)]] = Character.STRAY
    behind_digit = (code[index] == _COMMA) & (before == Character.DIGIT)
    is_decimal = behind_digit & (kind[index + 1] == Character.DIGIT)
    is_corner = (code[index] == _COMMA) & is_among(follower, list(b"CRAcra"))
    if np.count_nonzero(behind_digit & ~is_corner) > np.count_nonzero(kind == Character.POINT):
        is_decimal = behind_digit
    commas = index[is_corner & ~is_decimal]
    kind[commas] = Character.COMMA
    start[commas + 1] = marks.at[commas]
    strays = np.flatnonzero(kind == Character.STRAY)
    is_last = kind[strays + 1] == Character.BREAK
    points = index[is_decimal]
    if len(points):
        code = code.copy()
        code[points], kind[points] = _POINT, Character.POINT
    in_words = kind < Character.COMMA
    corners = np.cumsum(in_words)[commas + 1] - 1
    return (
        _Marks(code[in_words], kind[in_words], marks.at[in_words], start[in_words], corners),
        marks.at[strays],
        is_last,
        marks.at[kind == Character.MACRO],
    )


def _words(marks: _Marks, breaks: Positions) -> tuple[Words, Ranges]:
    """The words and the lines of points. A word is a letter and the number behind it."""
    kind = marks.kind
    in_number = (kind >= Character.DIGIT) & (kind <= Character.SIGN)
    edges = np.flatnonzero(in_number[1:] != in_number[:-1]) + 1
    begins, ends = edges[::2], edges[1::2]
    letters = np.flatnonzero(kind == Character.LETTER)
    after_letter = kind[begins - 1] == Character.LETTER
    after = letters + 1
    end = after.copy()
    end[in_number[after]] = ends[after_letter]
    numbers = read_numbers(marks.code, after, end)

    address = _UPPER[marks.code[letters]]
    bare = np.flatnonzero(numbers.digits == 0)
    numbers.fault[bare[(address[bare] == _SLASH) & (end[bare] == after[bare])]] = NumberFault.NONE
    address[np.searchsorted(letters, marks.corners)] += 32
    counts = np.diff(np.searchsorted(letters, breaks))
    block = np.repeat(np.arange(len(counts), dtype=marks.at.dtype), counts)
    words = Words(*(address, *msgspec.structs.astuple(numbers), block, marks.start[letters], marks.at[end - 1] + 1))
    if after_letter.all():
        return words, Ranges(edges[:0], edges[:0])
    return _with_loose(words, marks, breaks, begins[~after_letter], ends[~after_letter])


def _with_loose(
    words: Words, marks: _Marks, breaks: Positions, begins: Positions, ends: Positions
) -> tuple[Words, Ranges]:
    """
    Insert numbers at the head of a block as faulty words with address 0.

    Lines of three points or more are no numbers: in manuals they stand for omitted blocks.
    """
    points = np.append(0, np.cumsum(marks.kind == Character.POINT))
    length = ends - begins
    is_dots = (length > 2) & (points[ends] - points[begins] == length) & (marks.kind[ends] == Character.BREAK)
    start, end = marks.at[begins], marks.at[ends - 1] + 1
    dots = Ranges(start[is_dots], end[is_dots])
    loose = ~is_dots
    count = int(np.count_nonzero(loose))
    numbers = faulty_numbers(count, NumberFault.NO_ADDRESS)
    block = (np.searchsorted(breaks, begins[loose]) - 1).astype(marks.at.dtype)
    extra = Words(*(np.zeros(count, np.uint8), *msgspec.structs.astuple(numbers), block, start[loose], end[loose]))
    index = np.searchsorted(words.start, extra.start)
    columns = zip(msgspec.structs.astuple(words), msgspec.structs.astuple(extra), strict=True)
    return Words(*(np.insert(column, index, more) for column, more in columns)), dots


def _only(words: Words, chosen: Mask) -> Words:
    if chosen.all():
        return words
    return words[chosen]


def _begins_statement(words: Words) -> Mask:
    """True for letters that begin a macro statement such as GOTO 10."""
    begins = np.zeros(len(words), bool)
    has_no_digits = words.fault == int(NumberFault.NO_DIGITS)
    bare = np.flatnonzero(has_no_digits & _BEGINS_STATEMENT[words.address])
    if not len(bare):
        return begins
    is_head = first_in_run(words.block)
    is_head[1:] |= is_among(words.address[:-1], list(b"N/"))
    bare = bare[is_head[bare]]
    for letters, has_number in _STATEMENTS.items():
        last = bare + len(letters) - 1
        first, last = bare[last < len(words)], last[last < len(words)]
        spelled = (words.block[first] == words.block[last]) & ((words.digits[last] > 0) | (not has_number))
        for offset, letter in enumerate(letters):
            index = first + offset
            spelled &= (words.address[index] == letter) & (has_no_digits[index] | (index == last))
        begins[first[spelled]] = True
    return begins


def _mark_alignment(words: Words, code: Bytes) -> None:
    """Make `:` with other words behind it a sequence number: it marks an alignment block (ISO 6983)."""
    heads = np.flatnonzero(words.address == ord("O"))
    heads = heads[code[words.start[heads]] == _COLON]
    heads = heads[heads + 1 < len(words)]
    words.address[heads[words.block[heads + 1] == words.block[heads]]] = ord("N")


_BLANK_INSIDE = lazy_pattern(rb"(?<=[0-9.])[ \t]++(?=[0-9.])")


def _mark_blanks(words: Words, code: Bytes) -> None:
    """Set the fault of words with a blank between two digits, or beside their decimal point: X-10 10."""
    blanks = np.array([match.start() for match in _BLANK_INSIDE.finditer(code.tobytes())], np.int64)
    first = np.searchsorted(blanks, words.start)
    inside = np.searchsorted(blanks, words.end) > first
    words.fault[inside & (words.fault == NumberFault.NONE)] = NumberFault.BLANK_INSIDE


def _with_names(words: Words, names: Positions) -> Words:
    """Clear the fault of an O before a program name <...>, which needs no number."""
    if len(names):
        bare = np.flatnonzero((words.fault == NumberFault.NO_DIGITS) & (words.address == ord("O")))
        words.fault[bare[is_among(words.end[bare], names)]] = NumberFault.NONE
    return words
