"""A block of a language with names while it is read: what has been found of it so far, and its statement."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping
from typing import ClassVar, Final

from msgspec.structs import replace

from polarcheck.foundation.states import Distance
from polarcheck.program.execution.expression import Expression, constant
from polarcheck.program.execution.language_tokens import Language, Token, Tokens
from polarcheck.program.execution.statement import Kind, Number, Statement, Unread, Word, whole
from polarcheck.program.execution.variable_names import Names
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.excerpt import shortened

#: Bound of the tokens of a block, and of the steps of an expression.
_SIZE: Final = 5_000
#: Of what a message names [characters].
_SHOWN: Final = 40
#: X=AC(10), C=DC(90), X=IC(2). How the rotary axis comes to its position makes no difference.
_DISTANCES: Final = {
    "AC": Distance.ABSOLUTE,
    "DC": Distance.ABSOLUTE,
    "ACP": Distance.ABSOLUTE,
    "ACN": Distance.ABSOLUTE,
    "IC": Distance.INCREMENTAL,
}


class SpokenBlock(Tokens):
    """
    The tokens of one block, and the parts of its statement so far.

    nothing: the kind of a block in which no part was found.
    words: NC words. before, after: what is done before and behind the move of the words. unread: what is not simulated.
    """

    nothing: ClassVar[Kind] = Kind.OUTPUT

    def __init__(self, block: str, language: Language, machine: Machine, names: Names, levels: int = _SIZE) -> None:
        super().__init__(block, language, names, levels, _SIZE)
        self.block, self.machine = block, machine
        self.words: list[Word] = []
        self.before: list[Statement] = []
        self.after: list[Statement] = []
        self.unread: list[Unread] = []
        self.skips: list[Number] = []
        self.sequence_number: Number | None = None
        self.first = self.token
        if len(self.tokens) > _SIZE:
            self.wrong("too-long", self.tokens[0], self.tokens[-1])

    # ---- the head ----

    def take_skip(self) -> bool:
        """Pass over a block skip, with its level, if it comes next."""
        token, following = self.token, self.token_ahead(1)
        if not self.is_sign("/"):
            return False
        has_level = following.text.isdigit() and following.start == token.end
        self.at += 1 + has_level
        self.skips.append(Number(int(following.text[:9]) if has_level else 1, token.start, self.last_end))
        return True

    def take_sequence_number(self, letters: str) -> bool:
        """Pass over a sequence number with one of the letters if it comes next."""
        token, following = self.token, self.token_ahead(1)
        if not token.text or token.text not in letters or not following.text.isdigit() or self.is_sign("=", 2):
            return False
        self.sequence_number = Number(whole(following.text), token.start, following.end)
        self.at += 2
        return True

    # ---- what is found ----

    def statement(self) -> Statement:
        """All that was found, as one statement with others behind it."""
        span = self.first.start, max(self.tokens[-1].end, self.first.start + 1)
        self.note_unknown()
        parts = list(self.before)
        is_faulty_move = self.fault is not None and not (self.before or self.after)
        if self.words or is_faulty_move or any(unread.moves for unread in self.unread):
            calls = self.machine.macro.flow_codes
            call = next((word.code for word in self.words if word.code in calls), "")
            parts.append(Statement(Kind.CALL if call else Kind.NC, *span, words=tuple(self.words), call=call))
        parts += self.after
        main, *more = parts or [Statement(self.nothing, *span)]
        return replace(
            main,
            sequence_number=self.sequence_number,
            skips=tuple(self.skips),
            fault=self.fault,
            more=tuple(more),
            unread=tuple(self.unread),
        )

    def add(self, part: Statement) -> None:
        """A statement that is no word: done before the words of the block where it stands before them."""
        (self.after if self.words else self.before).append(part)

    def leave_unread(
        self, name: str, first: Token, effect: str = "path", last: Token | None = None, *, matters: bool = True
    ) -> None:
        """Name what is not simulated, by its effect (macro.statements); nothing is said of what has none."""
        if effect != "none":
            text = shortened(name, _SHOWN)
            moves, is_cycle = effect in ("words", "moves", "cycle"), effect == "cycle"
            self.unread.append(Unread(text, first.start, (last or first).end, moves, matters, is_cycle))

    def leave_rest(self, first: Token) -> None:
        """Name all from a token on as not simulated."""
        last = self.tokens[-1]
        self.leave_unread(" ".join(self.block[first.start : last.end].split()), first, "moves", last)
        self.at = len(self.tokens) - 1

    def note_unknown(self) -> None:
        """Name the variables without a known value that expressions have read."""
        for token in self.unknown:
            self.leave_unread(token.text, token)
        self.unknown.clear()

    # ---- what tokens say ----

    def effect(self, name: str) -> str | None:
        """Return the effect of a statement on the path of the tool, by macro.statements; None if it is not listed."""
        effects = self.names.effects
        if name not in effects:
            listed: Mapping[str, str] = self.machine.macro.statements
            effect = listed[name] if name in listed else _by_pattern(_patterns(tuple(listed.items())), name)
            effects[name] = "none" if effect == "speeds" else effect
        return effects[name]

    def arguments(self) -> str:
        """Pass over ( ) and [ ], where they follow; what stands in the last of them."""
        written = ""
        while self.is_sign("(") or self.is_sign("["):
            first = self.token
            last = self.skip_brackets()
            written = self.block[first.end : last.start].strip()
        return written

    def value(self) -> tuple[Expression | None, str | None, Distance | None]:
        """Read the value behind =: its expression, its number if it is one, and absolute or incremental."""
        token = self.token
        if token.kind == "name" and self.is_sign("(", 1) and token.text in _DISTANCES:
            self.at += 2
            value, written = self._number_or_more()
            if value is not None and not self.take_sign(")"):
                self.wrong("missing-close-bracket", token, self.token)
            return value, written, _DISTANCES[token.text]
        return (*self._number_or_more(), None)

    def pass_over_value(self) -> None:
        """The value behind the = of what is not simulated, be it a list: OSCTRL[Z]=(1+2,4), OSCILL[Z]=(X)."""
        depth, index = 0, self.at
        while is_list := self.tokens[index].kind != "end":
            depth += (self.tokens[index].text in "([") - (self.tokens[index].text in ")]")
            if depth <= 0 or (depth == 1 and self.tokens[index].text == ","):
                break
            index += 1
        if self.is_sign("(") and ((is_list and depth == 1) or self.names_axis(1)):
            self.skip_brackets()
        else:
            self.value()

    def names_axis(self, ahead: int) -> bool:
        """True where the token at this distance behind the next one is an axis in parentheses, and no value."""
        token, following = self.token_ahead(ahead), self.token_ahead(ahead + 1)
        has_number = token.kind == "letter" and following.kind == "number"
        if token.kind not in ("letter", "name") or (token.text == "R" and has_number):
            return False
        return self.is_sign(")", ahead + 1 + has_number) and not self.names.is_declared(token.text)

    def _number_or_more(self) -> tuple[Expression | None, str | None]:
        first = self.at
        value = self.expression()
        taken = self.tokens[first : self.at]
        is_number = value is not None and taken[-1].kind == "number" and taken[-1].text.replace(".", "").isdigit()
        if is_number and (len(taken) == 1 or (len(taken) == 2 and taken[0].text in "+-")):
            return value, "".join(token.text for token in taken)
        return value, None

    def add_word(self, address: str, first: Token) -> None:
        """A word whose value follows its =."""
        value, written, distance = self.value()
        if value is not None:
            last = self.tokens[self.at - 1]
            self.words.append(Word(address, value, written, first.start, last.end, distance))

    def add_number(self, address: str, number: str, first: Token, last: Token) -> None:
        """A word with a number that stands in the program, or for which a name stands."""
        value = float(number.replace("EX", "E"))
        expression = constant(value, first.start, last.end)
        written = None if "EX" in number else number
        self.words.append(Word(address, expression, written, first.start, last.end))

    def assign(self, target: Expression | None, first: Token, value: Expression | None = None) -> None:
        """A variable takes a value: that behind its = where none is given."""
        if value is None:
            value = self.expression()
        self.add(Statement(Kind.ASSIGN, first.start, self.tokens[self.at - 1].end, target=target, value=value))

    def variable(self, token: Token) -> Expression:
        """The number of the variable of a name, as the target of an assignment."""
        number = float(self.names.variable(token.text))
        return constant(number, token.start, token.end)


@functools.cache
def _patterns(listed: tuple[tuple[str, str], ...]) -> tuple[tuple[re.Pattern[str], str], ...]:
    return tuple((_pattern(name), effect) for name, effect in listed if "*" in name)


def _pattern(listed: str) -> re.Pattern[str]:
    """What stands between two stars is taken at its first place, so that many stars cost no more than one."""
    first, *between, last = map(re.escape, listed.split("*"))
    return re.compile(first + "".join(f"(?>.*?{part})" for part in between) + f".*{last}")


def _by_pattern(patterns: tuple[tuple[re.Pattern[str], str], ...], name: str) -> str | None:
    return next((effect for pattern, effect in patterns if pattern.fullmatch(name)), None)
