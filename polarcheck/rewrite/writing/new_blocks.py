"""The new blocks that stand in the place of those of the original, put into its bytes."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Collection, Mapping, Sequence
from itertools import chain, pairwise, zip_longest

import msgspec
import numpy as np

from polarcheck.checking.edits import applied, origins
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.foundation.states import STATES, Motion, Side
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading import source
from polarcheck.program.reading.words import Text
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError
from polarcheck.rewrite.writing.style import Style
from polarcheck.rules.editing import (
    Replace,
    blocks_before,
    blocks_behind,
    content_of,
    line_end,
    line_without,
    without_blanks,
)


class NewBlock(msgspec.Struct, frozen=True):
    """
    A block of the new program.

    words: as they are written, in order. comment: its text, without the signs around it.
    """

    words: tuple[str, ...] = ()
    comment: str = ""


#: The index of a block in text.blocks -> what stands in its place: no block takes it out with its line.
NewBlocks = Mapping[int, Sequence[NewBlock]]

_PLANES = {17: "plane_xy", 18: "plane_zx", 19: "plane_yz"}
_BLANK_OR_END = " \t\r\n\0\x7f"
#: Block skip, N word and O word stay at the head of a block that is rewritten.
_HEAD = re.compile(r"(?:[ \t]*(?:/[1-9]?|[NO:][ \t]*[0-9]+))*", re.IGNORECASE)
_SKIP = re.compile(r"/[1-9]?")
_NUMBER = re.compile(r"N[ \t]*([0-9]+)", re.IGNORECASE)
_PLAIN_WORD = re.compile(r"[A-Z][-+.0-9]+", re.IGNORECASE)
_REFERENCE = re.compile(r"[0-9]+")


def comment_text(comment: str, machine: Machine) -> str:
    """A comment with its signs; signs inside that would end it become brackets, control characters blanks."""
    plain = "".join(sign if sign.isprintable() else " " for sign in comment)
    if machine.control.parentheses_are_comments:
        return f"({plain.replace('(', '[').replace(')', ']')})"
    return f"{machine.control.line_comments} {plain}".rstrip()


def decision_comment(text: str) -> str:
    """A comment that says what is to be decided, in characters that every control has."""
    plain = text.upper().translate(str.maketrans("()[];%", "      "))
    return "DECIDE: " + " ".join("".join(sign for sign in plain if " " <= sign <= "~").split())


def block_text(block: NewBlock, style: Style, machine: Machine) -> str:
    """A block as it is written."""
    words = [word.lower() for word in block.words] if style.lower_case else block.words
    if style.blank == " ":
        text = " ".join(words)
    else:
        # Only words of a letter and a number part themselves.
        is_plain = [bool(_PLAIN_WORD.fullmatch(word)) for word in words]
        parts = (style.blank if all(pair) else " " for pair in pairwise(is_plain))
        text = "".join(chain.from_iterable(zip_longest(words, parts, fillvalue="")))
    return " ".join(part for part in (text, comment_text(block.comment, machine) if block.comment else "") if part)


def edits_of(
    original: Original, blocks: NewBlocks, style: Style, machine: Machine, without_skip: Collection[int] = ()
) -> list[Replace]:
    """
    Return the edits that put new blocks in the place of blocks of the original.

    N, O and block skip at the head of a block stay, N with its first new block, block skip with each. The others get N
    words between those of the original where its blocks have them and there is room. Its comments stay, in the signs of
    the machine, behind its first block, and for a machine of another language the name of the block with them. Where
    the machine takes `;` for a comment, blocks that it parts go to lines of their own. style: of the original. machine:
    for which the new program is. without_skip: blocks that lose their block skip.
    """
    text = original.trace.text
    sequence = _Sequence(text, style)
    written, with_more = text.written_blocks(), {*text.comments.block.tolist(), *text.labels.block.tolist()}
    takes_labels = original.trace.machine.macro.language == machine.macro.language
    return [
        _edit(
            text,
            index,
            written[index],
            blocks[index],
            sequence,
            style,
            machine,
            index in without_skip,
            index in with_more,
            takes_labels,
        )
        for index in sorted(blocks)
    ]


def edits_of_ranges(
    original: Original, ranges: Mapping[tuple[int, int], Sequence[NewBlock]], style: Style, machine: Machine
) -> list[Replace]:
    """
    Return the edits that put new blocks in the place of all from a first block to a last one.

    N at the head of the first stays; the others get N words as in `edits_of`. Comments are those of the new blocks.
    """
    text = original.trace.text
    sequence = _Sequence(text, style)
    edits = []
    for first, last in sorted(ranges):
        begin, finish = content_of(text, first)[0], content_of(text, last)[1]
        head = _HEAD.match(text.source.excerpt(begin, finish))
        number = _NUMBER.search(head[0]) if head else None
        written = [block_text(block, style, machine) for block in ranges[first, last]]
        heads = [number[0] if number else "", *sequence.between(first, len(written) - 1, last)]
        lines = [_joined(*pair, style) for pair in zip(heads, written, strict=False)]
        edits.append((begin, finish, _parting(text, first, machine).join(lines)))
    return edits


def comments_of(text: Text, index: int) -> list[str]:
    """The comments of a block without their signs."""
    comments = []
    for number in range(*stretch(text.comments.block, index, index + 1)):
        comment = text.written(text.comments, number)
        is_closed = comment.startswith("(") and comment.endswith(")")
        is_mark = comment[:1] not in "(;%"  # of a channel
        comments.append(comment[1:-1] if is_closed else comment if is_mark else comment[1:].strip())
    return comments


def next_move_in_motion(trace: Trace, row: int) -> int | None:
    """The next row that moves, if it takes over the motion in force behind a row; None without such a row."""
    for following in range(row + 1, len(trace)):
        if trace.modal.sets("motion")[following] or trace.blocks.starts[following]:
            return None
        if trace.axes.moves[following]:
            return following
    return None


def plane_behind(trace: Trace, row: int, last: int, target: Machine) -> str:
    """
    Return the list of the plane in force in a row, where the switches of a section of `target` leave another one and
    an arc, a cycle or compensation takes it over behind a row `last`; empty otherwise. Lathes begin in X and Z.
    """
    writing, planes = target.writing, {code: key for key in STATES["plane"] for code in target.codes(key)}
    switches = (*writing.before, writing.switch, *writing.behind, writing.end, *writing.behind_end)
    after = [planes[word] for block in switches for word in block.split() if word in planes]
    key = _PLANES.get(int(trace.modal.state("plane")[row]) if row >= 0 else 0, "plane_zx")
    if not after or after[-1] == key or key not in planes.values():
        return ""
    ends = (trace.modal.sets("plane") | trace.blocks.starts | trace.mode.enters)[last + 1 :]
    rows = slice(last + 1, last + 1 + int(np.argmax(ends)) if ends.any() else None)
    takes = np.isin(trace.axes.motion[rows], (Motion.CW, Motion.CCW, Motion.CYCLE)) | trace.modal.in_cycle[rows]
    return key if (takes | (trace.compensation.side[rows] != Side.OFF)).any() else ""


def edits_of_signs(original: Original, machine: Machine) -> list[Replace]:
    """Return the edits that part blocks by line ends where the machine takes the `;` between them for a comment."""
    text = original.trace.text
    if machine.control.line_comments != ";":
        return []
    edits, code = [], text.source.code
    for index in np.flatnonzero(code[np.minimum(text.blocks.end, len(code) - 1)] == ord(";")).tolist():
        end = int(text.blocks.end[index])
        if end >= len(code) or index + 1 >= len(text.blocks):
            continue
        begin, finish = content_of(text, index + 1)
        if begin < finish and text.source.line_of(begin) == text.source.line_of(end):
            edits.append((end, begin, line_end(text.source, text.source.line_of(end))))
    return edits


def edit_before(original: Original, index: int, blocks: Sequence[NewBlock], style: Style, machine: Machine) -> Replace:
    """Return the edit that puts new blocks before one that stays, on lines of their own, without N words."""
    return blocks_before(original.trace.text, index, [block_text(block, style, machine) for block in blocks])


def edit_behind(original: Original, index: int, blocks: Sequence[NewBlock], style: Style, machine: Machine) -> Replace:
    """Return the edit that puts new blocks behind one that stays, on lines of their own, without N words."""
    return blocks_behind(original.trace.text, index, [block_text(block, style, machine) for block in blocks])


def with_edits(original: Original, edits: Sequence[Replace]) -> tuple[bytes, list[int]]:
    """
    Return the bytes with the edits, and for each of the new lines its line in the original (from 1).

    Raises RefusedError where the encoding does not give all characters back.
    """
    text, encoding = original.trace.text.source, original.settings.encoding
    data = applied(text, edits)
    if data is None:
        raise RefusedError([Refusal(0, "its encoding does not give all characters back as they are")])
    return data, origins(text, source.read_source(data, original.path, encoding), edits).tolist()


class _Sequence:
    """N words for new blocks, between those of the original; blocks are asked for in their order."""

    def __init__(self, text: Text, style: Style) -> None:
        is_number = (text.words.address == ord("N")) & (text.words.value < 1e9)
        numbers = dict(zip(text.words.block[is_number].tolist(), text.words.value[is_number].tolist(), strict=True))
        for index in np.flatnonzero(text.blocks.is_macro).tolist():
            statement = text.written(text.blocks, index)
            if number := _NUMBER.match(statement.lstrip(_BLANK_OR_END + "/")):
                numbers[index] = float(number[1])
        #: Blocks with an N word in their order, and its value.
        self.blocks = sorted(numbers)
        self.values = [numbers[index] for index in self.blocks]
        #: All N words of the file: they need not ascend.
        self.numbers = set(self.values)
        self.is_on = style.numbered == "all"
        self.letter = "n" if style.lower_case else "N"
        self.step, self.digits = style.number_step, style.number_digits
        #: Those to whose blocks something in the program may lead.
        self.references = jump_numbers(text)

    def between(self, index: int, count: int, until: int | None = None) -> list[str]:
        """
        N words of so many new blocks behind the N word of a block, or before it; empty ones without room.

        until: a later block, in the place of which and of those before it they stand, too.
        """
        first = bisect_right(self.blocks, index) if self.is_on and count > 0 else 0
        if not first:
            return [""] * count
        next_index = bisect_right(self.blocks, index if until is None else until)
        last = int(self.values[first - 1])
        following = int(self.values[next_index]) if next_index < len(self.values) else last + self.step * (count + 1)
        room = (following - last - 1) // count
        steps = (step for step in (self.step, 10, 5, 2, 1) if step <= room)
        step = next(
            (step for step in steps if self.numbers.isdisjoint(last + step * n for n in range(1, count + 1))), 0
        )
        return [f"{self.letter}{last + step * n:0{self.digits}d}" if step else "" for n in range(1, count + 1)]


def jump_numbers(text: Text) -> set[int]:
    """Return the numbers that may be targets of jumps and calls: those beside P and Q, and all in statements."""
    words, blocks = text.words, text.blocks
    is_target = np.isin(words.address, np.frombuffer(b"PQ", np.uint8)) & np.isfinite(words.value)
    numbers = {int(value) for value in words.value[is_target].tolist()}
    for index in np.flatnonzero(blocks.is_macro).tolist():
        statement = text.written(blocks, index)
        numbers.update(int(match) for match in _REFERENCE.findall(statement) if len(match) < 10)
    return numbers


def _edit(
    text: Text,
    index: int,
    content: str,
    blocks: Sequence[NewBlock],
    sequence: _Sequence,
    style: Style,
    machine: Machine,
    is_without_skip: bool,
    has_more: bool,
    takes_labels: bool,
) -> Replace:
    """content: the characters of the block. has_more: it has comments or labels. takes_labels: these stay labels."""
    start = int(text.blocks.start[index])
    begin, finish = without_blanks(content, start)
    lead, plain, comments, labels = begin - start, content, list[str](), list[int]()
    if has_more:
        plain, comments = text.without_comments(index), comments_of(text, index)
        numbers = range(*stretch(text.labels.block, index, index + 1))
        if takes_labels:
            labels = text.labels.end[numbers].tolist()
        else:
            comments = [*(text.written(text.labels, number) for number in numbers), *comments]
    head = _HEAD.match(plain, lead)
    head_end = max([head.end() if head else lead, *(end - start for end in labels)])
    kept = content[lead:head_end].strip()
    if is_without_skip:
        kept = _SKIP.sub("", kept).strip()
    written = [block_text(block, style, machine) for block in blocks]
    remarks = "".join(f" {comment_text(comment, machine)}" for comment in comments)
    if not written and not remarks and not labels:
        number = _NUMBER.search(kept)
        if not number or int(number[1]) not in sequence.references:
            return line_without(text.source, begin, finish)
    lines = [(_joined(kept, written[0] if written else "", style) + remarks).strip()]
    if len(written) > 1:
        skip = _SKIP.search(kept)
        for n_word, line in zip(sequence.between(index, len(written) - 1), written[1:], strict=True):
            lines.append(_joined(_joined(skip[0] if skip else "", n_word, style), line, style))
    return begin, finish, _parting(text, index, machine).join(lines) if len(lines) > 1 else lines[0]


def _joined(head: str, line: str, style: Style) -> str:
    return f"{head}{style.blank}{line}" if head and line else head + line


def _parting(text: Text, index: int, machine: Machine) -> str:
    """What stands between new blocks: a line end, after `;` where one ends the block, or `; ` within a line."""
    code, end = text.source.code, int(text.blocks.end[index])
    line = text.source.line_of(max(end - 1, 0))
    has_sign = end < len(code) and int(code[end]) == ord(";")
    if machine.control.line_comments == ";" or not has_sign:
        return line_end(text.source, line)
    last = int(text.source.line_starts[line]) if line < len(text.source.line_starts) else len(code)
    alone = not text.source.excerpt(end + 1, last).strip(_BLANK_OR_END)
    return ";" + line_end(text.source, line) if alone else "; "
