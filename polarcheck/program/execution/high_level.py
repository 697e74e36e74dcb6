"""Statements of a high-level language: X=R1, STOPRE, IF R1==5 GOTOF NAME, calls by name."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from polarcheck.program.execution.expression import Expression, constant
from polarcheck.program.execution.flow_keywords import KEYWORDS, call_by_name
from polarcheck.program.execution.high_level_tokens import HIGH_LEVEL
from polarcheck.program.execution.language_tokens import Token
from polarcheck.program.execution.spoken_block import SpokenBlock
from polarcheck.program.execution.statement import Statement, Word
from polarcheck.program.execution.variable_names import Names
from polarcheck.program.machines.machine import Machine

#: What only custom macro writes: it may stand beside the statements of this language. END1: and GOTOF END1 are labels.
_CUSTOM_MACRO: Final = re.compile(
    r"#|(?<![A-Z_])(?:(?:IF|WHILE)\s*\[|GOTO\s*[0-9]|[BD]PRNT\s*\[|POPEN|PCLOS)"
    r"|\A[\s/]*+(?:N\s*+[0-9]++\s*+)?(?:DO|END)\s*+[0-9]++\s*+\Z",
    re.IGNORECASE,
)
_STRING: Final = re.compile('"[^"]*+"?')
#: Addresses of functions: with a number before their = they are those of another spindle, and no axis.
_FUNCTIONS: Final = "DFHMST"


def read_high_level(block: str, machine: Machine, names: Names, read_macro: Callable[[str], Statement]) -> Statement:
    """
    Read a block and its statements.

    machine: has the codes and axes. names: the names of variables and tools so far. read_macro: reads custom macro.
    """
    if is_custom_macro(block):
        return read_macro(block)
    return _Reader(block, HIGH_LEVEL, machine, names).read_block()


def is_custom_macro(block: str) -> bool:
    """Return True for a block that is written in custom macro."""
    has_signs = "#" in block or "[" in block or "=" not in block
    return has_signs and _CUSTOM_MACRO.search(_STRING.sub("", block)) is not None


class _Reader(SpokenBlock):
    """Reads one block from its head to its end."""

    def read_block(self) -> Statement:
        self.head()
        self.first = self.token
        while self.token.kind != "end":
            token = self.take_token()
            if token.kind == "letter":
                self.letter(token)
            elif token.kind == "name":
                self.name(token)
            elif token.kind == "number" and self.is_second_number() and not self.machine.control.blanks_in_numbers:
                self.wrong("format", self.tokens[self.at - 2], token)
            else:
                self.leave_rest(token)
        return self.statement()

    def is_second_number(self) -> bool:
        """Return True if the token just passed over stands right behind a number."""
        return self.at > 1 and self.tokens[self.at - 2].kind == "number"

    def head(self) -> None:
        """Block skip, sequence number and label."""
        while self.take_skip() or self.take_sequence_number("N:") or self.take_label():
            pass

    def take_label(self) -> bool:
        """Pass over a label if it comes next."""
        is_label = self.token.kind == "name" and self.is_sign(":", 1)
        self.at += 2 * is_label
        return is_label

    # ---- an address of one letter ----

    def letter(self, first: Token) -> None:
        """A word, be it with a number or behind =, or a parameter that takes a value."""
        token = self.token
        if first.text == "R" and ((token.kind == "number" and self.is_sign("=", 1)) or self.is_sign("[")):
            self.parameter(first)
        elif token.kind == "number":
            self.at += 1
            if self.take_sign("="):
                self.extended(first, token)
            else:
                self.number(first, token.text, token)
        elif token.text in ("+", "-") and self.tokens[self.at + 1].kind == "number":
            number = self.tokens[self.at + 1]
            self.at += 2
            self.number(first, token.text + number.text, number)
        elif self.is_sign("=") and self.names.is_declared(first.text):
            self.at += 1
            self.assign(self.variable(first), first)
        elif self.take_sign("="):
            self.behind_equal(first.text, first)
        elif self.is_sign("(") and not self.words:
            call_by_name(self, first.text, first)
        else:
            self.leave_rest(first)

    def number(self, first: Token, number: str, last: Token) -> None:
        """A word with a number."""
        if first.text == "L" and not self.words and self.token.text in ("P", "") and not self.after:
            call_by_name(self, f"L{number}", first)
            return
        self.add_number(first.text, number, first, last)
        if f"{first.text}{number.lstrip('0')}" == self.machine.macro.other_language:
            self.leave_unread(f"{self.machine.macro.other_language} (another language)", first)

    def parameter(self, first: Token) -> None:
        """R1=5, R[R2]=5."""
        self.at -= 1
        target = self.expression()
        if target is not None and target.steps[-1].name == "#" and self.take_sign("="):
            steps = target.steps[:-1]
            self.assign(Expression(steps, target.start, target.end), first)
        else:
            self.leave_rest(first)

    def extended(self, first: Token, number: Token) -> None:
        """C2=90, M2=70, S3=2000: an axis of a name, or a function of another spindle; its = is passed over."""
        name = first.text + number.text
        native = self.machine.control.native_words.get(f"{name}=")
        if native is not None:
            self.add_word(native, first)
        elif (effect := self.effect(f"{name}=")) is not None or first.text in _FUNCTIONS:
            effect = effect or self.effect(f"{first.text}n=") or "path"
            if effect == "none":
                self.add_word(f"{name}=", first)
                return
            self.pass_over_value()
            self.leave_unread(f"{name}=", first, effect, number)
        else:
            self.add_word(name, first)

    def behind_equal(self, address: str, first: Token) -> None:
        """A word whose value follows; T may call a tool by its name."""
        token = self.token
        if address == "T" and token.kind == "string":
            self.at += 1
            number = float(self.names.tool(token.text))
            value = constant(number, token.start, token.end)
            self.words.append(Word("T", value, f"{number:.0f}", first.start, token.end))
        elif (effect := self.effect(f"{address}=")) is not None:
            self.pass_over_value()
            self.leave_unread(f"{address}=", first, effect)
        else:
            self.add_word(address, first)

    # ---- a name ----

    def name(self, first: Token) -> None:
        """A keyword, a word that stands for a code, an assignment, a statement of the profile, or a call."""
        native = self.machine.control.native_words
        if first.text in KEYWORDS:
            KEYWORDS[first.text](self, first)
        elif first.text == self.machine.macro.master_spindle_word:
            self.master_spindle(first)
        elif first.text in native:
            self.native(native[first.text], first)
        elif self.takes_value():
            self.assignment(first)
        elif (effect := self.effect(first.text)) is not None:
            given = self.arguments()
            if effect == "words" or (effect in ("moves", "cycle", "calls") and self.token.kind == "name"):
                self.at = len(self.tokens) - 1
            elif effect == "calls" and not given:  # MCALL alone takes back what was called
                return
            self.leave_unread(first.text, first, "cycle" if effect == "calls" else effect)
        else:
            call_by_name(self, first.text, first)

    def master_spindle(self, first: Token) -> None:
        """SETMS(3): the spindle that M3, M4, M5 and S are for from here on; without a number, spindle 1."""
        value: Expression | None = constant(1.0, first.start, first.end)
        if self.take_sign("(") and not self.take_sign(")"):
            value = self.expression()
            self.take_sign(")")
        if value is not None:
            self.words.append(Word("@", value, None, first.start, self.last_end))

    def native(self, code: str, first: Token) -> None:
        """A word that stands for a code; what stands in its parentheses may choose another set of data."""
        given = self.arguments()
        if code:
            self.add_number(code[0], code[1:], first, first)
        if given not in ("", "1"):
            self.leave_unread(f"{first.text}({given})", first)

    def takes_value(self) -> bool:
        """Return True if = follows, or [ ] and then =."""
        if not self.is_sign("["):
            return self.is_sign("=")
        start = self.at
        self.arguments()
        is_taken = self.is_sign("=")
        self.at = start
        return is_taken

    def assignment(self, first: Token) -> None:
        """NAME=5: a word of several letters, an axis, a variable, or what the profile says of it."""
        index = self.arguments()
        self.at += 1
        control, name = self.machine.control, first.text
        written = f"{name}[{index}]" if index else name
        native = control.native_words.get(f"{written}=")
        effect = self.effect(f"{written}=") or self.effect(f"{name}=")
        if native is not None:
            self.add_word(native, first)
        elif name in control.named_axes and index in ("", "1"):
            self.add_word(name, first)
        elif effect is not None:
            self.pass_over_value()
            self.leave_unread(f"{written}=", first, effect)
        elif index or name[0] == "$":
            self.pass_over_value()
            self.leave_unread(f"{written}=", first, matters=name[0] == "$")
        else:
            if not self.names.is_declared(name):
                self.leave_unread(f"{name}=", first, matters=False)
                self.names.declare(name)
            self.assign(self.variable(first), first)
