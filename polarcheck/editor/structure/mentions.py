"""All places of a text that name something: N numbers, labels, variables, programs; and what names them by a value."""

from __future__ import annotations

import bisect
import itertools
import operator
import re
from collections.abc import Iterator

import numpy as np

from polarcheck.editor.structure.document import Document
from polarcheck.editor.structure.lexing import Token, tokens
from polarcheck.editor.structure.mention import Computed, Into, Kind, Mention, Role
from polarcheck.foundation.arrays import cached_property, side_by_side
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.macro import VariableKind, Variables
from polarcheck.program.execution.macro_tokens import in_capitals
from polarcheck.program.execution.programs import (
    Program,
    ProgramName,
    block_text,
    label_in,
    name_at_head,
    sequence_number_in,
)
from polarcheck.program.execution.run import begins_program, is_code
from polarcheck.program.execution.statement import Kind as StatementKind
from polarcheck.program.execution.statement import Statement, Word
from polarcheck.program.machines.macro_keys import Macro
from polarcheck.program.reading.language_blocks import SEQUENCE_NAME

_NUMBER_LIMIT = 1e15
_DIGITS = re.compile(r"\d+")
_SEQUENCE_NAME = re.compile(SEQUENCE_NAME, re.IGNORECASE)
#: Programs of so many repeats: the last digits of P are the number.
_REPEATED = 10_000


#: Where a mention stands.
_PLACE = operator.itemgetter(Mention._fields.index("start"), Mention._fields.index("end"))
#: With more blocks at which the flow can turn, a search first drops those without a word for it.
_MANY = 500


class Mentions:
    """The mentions of a listing, in order; computed: those whose name is not known."""

    def __init__(self, listing: Listing) -> None:
        self.listing = listing
        self.computed: list[Computed] = []
        mentions = [
            *self._numbers(),
            *self._labels(),
            *self._heads(),
            *self._flow(),
            *self._cycles(),
            *self._variables(),
        ]
        mentions.sort(key=_PLACE)
        self.all = [
            following for following, before in zip(mentions, [None, *mentions], strict=False) if following != before
        ]
        self._blocks = [mention.block for mention in self.all]

    def of_program(self, program: Program) -> list[Mention]:
        """Return the mentions in a program."""
        low, high = (bisect.bisect_left(self._blocks, block) for block in (program.first, program.end))
        return self.all[low:high]

    def at(self, character: int) -> Mention | None:
        """Return the mention at a character, also at its end; the innermost one."""
        hits = [mention for mention in self.all if mention.begin <= character <= mention.end]
        return max(hits, key=lambda mention: mention.begin, default=None)

    def variable_kind(self, mention: Mention) -> VariableKind:
        """Return the kind of a variable of custom macro; LOCAL or COMMON by the language for those of a name."""
        if isinstance(mention.name, int):
            return self._variables_of_control.kind(mention.name)
        language = self.listing.macro.language
        if mention.name.startswith("#_"):
            return VariableKind.SYSTEM
        if language == "high-level":
            is_parameter = mention.name[1:].isdigit() and len(mention.name) > 1
            return VariableKind.RETAINED if is_parameter else VariableKind.LOCAL
        return VariableKind.COMMON if re.fullmatch(r"VC?\d+", mention.name) else VariableKind.LOCAL

    @cached_property
    def _variables_of_control(self) -> Variables:
        return Variables(self.listing.macro)

    # ---- where they stand ----

    def _mention(
        self, kind: Kind, role: Role, key: int | str, span: tuple[int, int], block: int, begin: int
    ) -> Mention:
        written = self.listing.text.source.excerpt(*span)
        return Mention(kind, role, (key,), written, block, *span, begin)

    def _numbers(self) -> Iterator[Mention]:
        """N numbers at blocks."""
        text = self.listing.text
        words = text.words
        index = np.flatnonzero((words.address == ord("N")) & (words.value < _NUMBER_LIMIT) & (words.value >= 0))
        columns = (words.start[index].tolist(), words.end[index].tolist(), words.block[index].tolist())
        cycles = self._cycle_blocks if self.listing.macro.language == "user-task" else frozenset()
        content = text.source.text
        for start, end, block in zip(*columns, strict=True):
            # Without a search in most words: a program may have a number at each block.
            first, last, written = start + 1, end, content[start + 1 : end]
            if not written.isdecimal():
                digits = _DIGITS.search(written)
                if digits is None:
                    continue
                first, last, written = first + digits.start(), first + digits.end(), digits[0]
            is_named = block in cycles and start > self._first_word(block)
            role = Role.REFERS if is_named else Role.DEFINES
            yield Mention(Kind.SEQUENCE, role, (int(written[:18]),), written, block, first, last, start)
        for block, start, written in self._macro_blocks:
            match = sequence_number_in(written)
            if match and len(match[1]) < 10:
                span = start + match.start(1), start + match.end(1)
                begin = start + written.upper().rindex("N", 0, match.start(1))
                yield self._mention(Kind.SEQUENCE, Role.DEFINES, int(match[1]), span, block, begin)

    def _first_word(self, block: int) -> int:
        words = self.listing.text.words
        return int(words.start[np.searchsorted(words.block, block)])

    @cached_property
    def _macro_blocks(self) -> list[tuple[int, int, str]]:
        """The blocks with statements: number, first character, text."""
        text = self.listing.text
        blocks = np.flatnonzero(text.blocks.is_macro).tolist()
        return [(block, int(text.blocks.start[block]), block_text(text, block)) for block in blocks]

    def _labels(self) -> Iterator[Mention]:
        names = self.listing.text.labels
        for start, end, block in side_by_side(names.start, names.end, names.block):
            name = self.listing.text.source.excerpt(start, end).upper()
            yield self._mention(Kind.LABEL, Role.DEFINES, name, (start, end), block, start)
        for block, start, written in self._macro_blocks:
            match = label_in(written)
            group = 1 if match and match[1] else 2
            if match and self.listing.macro.language != "custom-macro":
                span = start + match.start(group), start + match.end(group)
                yield self._mention(Kind.LABEL, Role.DEFINES, match[group].upper(), span, block, span[0])

    def _heads(self) -> Iterator[Mention]:
        """The heads of programs."""
        text = self.listing.text
        words = text.words
        by_block = {program.first: program for program in self.listing.programs.programs if program.has_head}
        heads = np.flatnonzero(begins_program(words))
        for start, end, block in side_by_side(words.start[heads], words.end[heads], words.block[heads]):
            program = by_block.get(block)
            digits = _DIGITS.search(text.source.excerpt(start, end))
            if program is not None and digits and program.number is not None:
                span = start + digits.start(), start + digits.end()
                yield self._mention(Kind.PROGRAM, Role.DEFINES, program.number, span, block, start)
        for start, end, block in side_by_side(text.names.start, text.names.end, text.names.block):
            program = by_block.get(block)
            written = text.source.excerpt(start, end)
            name = name_at_head(written).strip("<>").strip()
            if program is not None and program.name == name:
                first = start + written.index(name)
                mention = self._mention(
                    Kind.PROGRAM, Role.DEFINES, name.upper(), (first, first + len(name)), block, start
                )
                yield mention._replace(keys=ProgramName(None, name).keys)

    # ---- jumps and calls ----

    def _flow(self) -> Iterator[Mention]:
        for block in self._flow_blocks():
            statement = self.listing.statement(block)
            written, start = block_text(self.listing.text, block), int(self.listing.text.blocks.start[block])
            parts = (statement, *([statement.then] if statement.then is not None else []), *statement.more)
            labels: set[str] = set()
            for part in parts:
                labels |= {name.upper() for name in (part.label, part.until) if name}
                yield from self._jump(part, block, start, written)
                if part.call:
                    yield from self._call(part, block, start, written)
            if labels:
                yield from self._label_uses(labels, block)

    def _flow_blocks(self) -> list[int]:
        """Return the blocks that may jump or call: those with a code, keyword or name for it; others are not read."""
        macro, text = self.listing.macro, self.listing.text
        if len(self.listing.stops) <= _MANY:
            return self.listing.stops
        pattern = _flow_pattern(macro)
        hits = [match.start() for match in pattern.finditer(text.source.code.tobytes())]
        blocks = np.unique(np.searchsorted(text.blocks.start, hits, side="right") - 1)
        return sorted(set(blocks.tolist()) & set(self.listing.stops))

    def _jump(self, part: Statement, block: int, start: int, written: str) -> Iterator[Mention]:
        if part.jump is None or part.label or part.kind not in (StatementKind.GOTO, StatementKind.IF_GOTO):
            return
        digits = _DIGITS.search(written, part.jump.start, part.jump.end)
        if len(part.jump.steps) > 1 or digits is None:
            self.computed.append(Computed(Kind.SEQUENCE, block))
            return
        span = start + digits.start(), start + digits.end()
        yield self._mention(Kind.SEQUENCE, Role.REFERS, int(digits[0][:18]), span, block, start + part.start)

    def _label_uses(self, labels: set[str], block: int) -> Iterator[Mention]:
        for token in tokens(self.listing, block):
            if token.kind in ("target", "name") and token.text in labels:
                span = token.start, token.end
                yield self._mention(Kind.LABEL, Role.REFERS, token.text, span, block, token.start)

    def _call(self, part: Statement, block: int, start: int, written: str) -> Iterator[Mention]:
        macro = self.listing.macro
        words = {word.address: word for word in reversed(part.words)}
        if part.call in macro.program_returns:
            yield from self._number_of(words.get("P"), Into.CALLER, None, block, start, written)
            return
        if part.call not in macro.call_codes:
            return
        called = self.listing.called_in(block)
        is_subprogram = part.call in (*macro.subprogram_calls, *macro.local_calls)
        of_begin = "P" if part.call in macro.local_calls else macro.sequence_word if is_subprogram else ""
        if of_begin and of_begin in words:
            is_own = "P" not in words and "<" not in words
            into = Into.OWN if of_begin == "P" or is_own else Into.CALLED
            yield from self._number_of(words[of_begin], into, called, block, start, written)
        if called is None or called == (None, None):
            if part.call not in macro.local_calls and "P" in words and words["P"].written is None:
                self.computed.append(Computed(Kind.PROGRAM, block))
            return
        word = words.get("<") if called.name is not None else words.get("P")
        if word is None:
            return
        name_span = _place_of_name(written, word, called)
        if name_span is not None:
            first, end = name_span
            digits = written[first:end]
            repeats = macro.repeats_in_p and is_subprogram and called.number is not None and len(digits) > 4
            has_repeats = repeats and int(digits) > _REPEATED - 1
            span = start + (end - 4 if has_repeats else first), start + end
            mention = self._mention(Kind.PROGRAM, Role.REFERS, "", span, block, start + word.start)
            yield mention._replace(keys=called.keys, code=part.call, has_repeats=bool(has_repeats))

    def _number_of(
        self, word: Word | None, into: Into, called: ProgramName | None, block: int, start: int, written: str
    ) -> Iterator[Mention]:
        """Yield the N number that a word of a call or return names."""
        if word is None:
            return
        digits = _DIGITS.search(written, word.start, word.end)
        if word.written is None or digits is None:
            self.computed.append(Computed(Kind.SEQUENCE, block, into))
            return
        span = start + digits.start(), start + digits.end()
        mention = self._mention(Kind.SEQUENCE, Role.REFERS, int(digits[0][:18]), span, block, start + word.start)
        yield mention._replace(into=into, called=called)

    # ---- cycles that name the blocks of their contour ----

    @cached_property
    def _cycle_blocks(self) -> frozenset[int]:
        words = self.listing.text.words
        codes = self.listing.machine.codes("repetitive_cycle")
        return frozenset(words.block[is_code(words, codes)].tolist())

    def _cycles(self) -> Iterator[Mention]:
        """
        The first and last block of a contour: G71 P10 Q20, G85 NLAP1.

        P and Q of other cycles are depths: axis words stand beside them, or no
        block has these numbers.
        """
        text = self.listing.text
        words = text.words
        for block in sorted(self._cycle_blocks):
            low, high = np.searchsorted(words.block, (block, block + 1)).tolist()
            indices = {chr(words.address[index]): index for index in reversed(range(low, high))}
            if self.listing.macro.language == "user-task":
                yield from self._cycle_names(block)
            if not {"P", "Q"} <= indices.keys() or {"X", "Z"} & indices.keys():
                continue
            targets = self.listing.programs.targets(self.listing.programs.around(block))
            pair = [indices["P"], indices["Q"]]
            numbers = [int(words.value[index]) if _is_whole(float(words.value[index])) else -1 for index in pair]
            if any(words.has_point[index] for index in pair) or not all(number in targets for number in numbers):
                continue
            for index, number in zip(pair, numbers, strict=True):
                start, end = int(words.start[index]), int(words.end[index])
                digits = _DIGITS.search(text.source.excerpt(start, end))
                if digits:
                    span = start + digits.start(), start + digits.end()
                    yield self._mention(Kind.SEQUENCE, Role.REFERS, number, span, block, start)

    def _cycle_names(self, block: int) -> Iterator[Mention]:
        text = self.listing.text
        start = int(text.blocks.start[block])
        for match in _SEQUENCE_NAME.finditer(block_text(text, block)):
            span = start + match.start(), start + match.end()
            yield self._mention(Kind.LABEL, Role.REFERS, match[0].upper(), span, block, span[0])

    # ---- variables ----

    def _variables(self) -> Iterator[Mention]:
        for block, _, written in self._macro_blocks:
            lexed = tokens(self.listing, block, written)
            for token, following in itertools.zip_longest(lexed, lexed[1:]):
                if token.kind == "computed":
                    self.computed.append(Computed(Kind.VARIABLE, block))
                elif token.kind == "variable" or token.text.startswith("#_"):
                    is_assigned = following is not None and following.kind == "operator" and following.text == "="
                    role = Role.ASSIGNS if is_assigned else Role.REFERS
                    span = token.start, token.end
                    yield self._mention(Kind.VARIABLE, role, variable_name(token), span, block, token.start)


def _flow_pattern(macro: Macro) -> re.Pattern[bytes]:
    """Return a pattern of the codes, keywords and names without which no block jumps or calls."""
    codes = [(flow_code[:1].encode(), re.escape(flow_code[1:].encode())) for flow_code in sorted(macro.flow_codes)]
    parts = [rb"GO", *(rb"%s[ \t]{0,3}0{0,3}%s(?![0-9])" % code for code in codes)]
    if macro.language == "high-level":
        parts += [rb"[A-Z_]{2}", rb"L[0-9]"]
    elif macro.language == "user-task":
        parts.append(rb"(?!VC[0-9])[A-Z]{2}")
    return re.compile(b"|".join(parts), re.IGNORECASE)


def variable_name(token: Token) -> int | str:
    """Return the name of a variable: 100 of #0100, R5 of R05, WIDTH."""
    match = re.fullmatch(r"(#|R|V|VC)(\d+)", token.text)
    if match is None:
        return token.text
    number = int(match[2][:18])
    return number if match[1] == "#" else f"{match[1]}{number}"


def _is_whole(value: float) -> bool:
    return 0 <= value < _NUMBER_LIMIT and value == int(value)


def _place_of_name(written: str, word: Word, called: ProgramName) -> tuple[int, int] | None:
    """Return the characters of the number or name of a call within its block."""
    if called.number is not None:
        digits = _DIGITS.search(written, word.start, word.end)
        return digits.span() if digits else None
    name = called.name or ""
    capitals, pattern = in_capitals(written), in_capitals(name)
    start = capitals.find(pattern, word.start) if pattern else -1
    while start >= 0:
        end = start + len(pattern)
        after = capitals[end : end + 1]
        is_whole = not (after.isalnum() or after == "_") or capitals[end : end + 4] in ("_SPF", "_MPF")
        if is_whole and not capitals[start - 1 : start].isalnum():
            return start, end
        start = capitals.find(pattern, start + 1)
    return None


def mentions_of(document: Document) -> list[Mentions]:
    """Return the mentions of each channel of a document; found once for each state of its text."""
    return document.cached("mentions", lambda: [Mentions(listing) for listing in document.listings])
