"""
Macro statements: the text of one block becomes a Statement that knows the place of each of its parts.

Reading never fails: a statement with a fault holds whatever could still be read. A block without any macro reads as NC
words, so that a call (`M98 P1000`) or a block with some `#` in it may hold any of them.

Source: FANUC B-62754EN/01, chapter 16; the short forms and external output from knowledge of the same manual.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import Final

from msgspec.structs import replace

from polarcheck.program.execution.arithmetic import UNKNOWN
from polarcheck.program.execution.expression import Expression, Fault, constant
from polarcheck.program.execution.expression_reader import read_expression
from polarcheck.program.execution.kinds import FaultKind
from polarcheck.program.execution.macro_tokens import GRAMMAR, NUMBER, Characters, MacroLexer
from polarcheck.program.execution.statement import Kind, Number, Place, Statement, Unread, Word, whole
from polarcheck.program.machines.axis_table import AXIS_LETTERS
from polarcheck.program.reading.excerpt import shortened

_OUTPUTS: Final = ("BPRNT", "DPRNT", "POPEN", "PCLOS", "SETVN")
_SHORT: Final = {"WH": "WHILE", "GO": "GOTO", "EN": "END", "TH": "THEN"} | {name[:2]: name for name in _OUTPUTS[:4]}
#: The words of macro statements, also in their short forms.
KEYWORD: Final = re.compile("|".join(["IF", "WHILE", "DO", "END", "GOTO", "THEN", *_OUTPUTS, *_SHORT]))
_HEAD: Final = re.compile(r"/([1-9]?)|N([0-9]+)|[O:][0-9]")
_DIGITS: Final = re.compile("[0-9]+")
_SKIP: Final = re.compile("/([1-9]?)")
_ADDRESS: Final = re.compile(",?[A-Z]|:")
_WRITTEN: Final = re.compile(rf"[-+]?+(?:{NUMBER})(?![-+.0-9])")
_CALCULATED: Final = re.compile(r"[-+]*+(?:[#\[]|[A-Z]{2,5}\[)")
#: A name with a number before =, be it that the machine has no such axis; N and O take no names, and G is a code.
_NAMED: Final = re.compile(r"([A-FH-MP-Z][0-9]{1,2})=")
#: What a number or an expression begins with.
_VALUE: Final = re.compile(r"[-+]*+[.0-9#\[]")
_NO_VALUE: Final = re.compile("[-+.0-9]*")
#: What a word that gives no number is called by: all its letters, and behind = a number or one letter, as in E=C.
_LOST: Final = re.compile(r",?[A-Z:]+(?:[0-9]{0,2}=(?:[A-Z](?![-+.0-9#\[=])|[-+.0-9]*)|[-+.0-9]*)")
#: Characters of its name that are shown.
_SHOWN: Final = 24
_JOINS: Final = re.compile("AN|OR|XO")
# After X#1: X#1+#2 lacks its brackets. X#1/2 does too, but in X#1/2Y5. the / skips the rest.
_BEYOND: Final = re.compile(r"[-+*]|/[0-9]*+(?:$|[#\[])|AND|OR|XOR|MOD")

#: Signs that mean something elsewhere, where a word should begin.
_ALONE: Final[dict[str, FaultKind]] = {"[": "format", "]": "missing-open-bracket"}


class _Reader:
    """Reads one block. at: index of the next character; fault: the first so far."""

    def __init__(
        self,
        block: str,
        calls: frozenset[str],
        loops: int,
        levels: int,
        size: int,
        names: Collection[str],
    ) -> None:
        self.block, self.characters = block, Characters.of_block(block)
        self.text, self.at = self.characters.text, 0
        self.calls, self.loops, self.levels, self.size = calls, loops, levels, size
        self.names, self.has_equal = sorted(names, key=len, reverse=True), "=" in self.text
        self.skips: list[Number] = []
        self.lost: list[Unread] = []
        self.fault: Fault | None = None

    def blame(self, fault: Fault | None) -> None:
        """Keep the first fault, but brackets too deep, which can be calculated, give way to any other."""
        if fault and (self.fault is None or (self.fault.kind == "bracket-levels" and fault.kind != "bracket-levels")):
            self.fault = fault

    def wrong(self, kind: FaultKind, start: int, end: int = 0) -> None:
        self.blame(self.characters.fault(kind, start, end))

    def wrong_rest(self, kind: FaultKind, start: int) -> None:
        self.wrong(kind, start, len(self.text))
        self.at = len(self.text)

    def number(self, digits: str, start: int) -> Number:
        return Number(whole(digits), *self.characters.span(start, self.at))

    def keyword(self) -> str:
        """The macro word that stands here, spelled out; "" where there is none."""
        match = KEYWORD.match(self.text, self.at)
        return _SHORT.get(match[0], match[0]) if match else ""

    def take_keyword(self) -> str:
        match = KEYWORD.match(self.text, self.at)
        self.at = match.end() if match else self.at
        return _SHORT.get(match[0], match[0]) if match else ""

    def expression(self, *, whole: bool, condition: bool = False, kind: FaultKind = "format") -> Expression | None:
        """Read what gives a number, or a condition; where that fails, the rest of the block is lost."""
        lexer = MacroLexer(self.characters, self.at)
        expression, fault = read_expression(lexer, GRAMMAR, whole=whole, levels=self.levels, size=self.size)
        self.blame(fault)
        self.at = lexer.at if expression else len(self.text)
        if expression and expression.condition != condition:
            self.blame(Fault(kind, expression.start, expression.end))
            return None
        return expression

    def block_statement(self) -> Statement:
        """Block skip, O and N, then the statement."""
        sequence_number: Number | None = None
        head: list[Word] = []
        while (match := _HEAD.match(self.text, self.at)) and len(self.skips) < self.size:
            start, self.at = self.at, match.end()
            if match[1] is not None:
                self.skips.append(self.number(match[1] or "1", start))
            elif match[2] and sequence_number is None:
                sequence_number = self.number(match[2], start)
            else:
                self.at = start
                if match[2] or head:
                    break
                head = self.word()
        statement = self.statement()
        return replace(
            statement,
            sequence_number=sequence_number,
            skips=tuple(self.skips),
            words=(*head, *statement.words),
            fault=self.fault,
            unread=tuple(self.lost),
        )

    def statement(self) -> Statement:
        start, span = self.at, self.characters.span(self.at, len(self.text))
        if self.text.startswith(("#", "[#_"), start):
            return self.assignment(span)
        match self.take_keyword():
            case "IF":
                return self.after_if(span, self.condition("if-format"))
            case "WHILE":
                return self.after_while(span, self.condition("while-format"))
            case "DO" | "END" as name:
                return Statement(Kind[name], *span, loop=self.loop(start))
            case "GOTO":
                return Statement(Kind.GOTO, *span, jump=self.jump())
            case "THEN":
                self.wrong_rest("if-format", start)
                return Statement(Kind.NC, *span)
            case "":
                return self.nc_words(span)
        return Statement(Kind.OUTPUT, *span)

    def nothing_more(self) -> None:
        """The block must end here: no NC words nor a second statement can follow."""
        rest = self.text[self.at : self.at + 1]
        if rest.isalpha() and not self.keyword():
            self.wrong("nc-and-macro", self.at, len(self.text))
        elif rest:
            self.wrong("missing-open-bracket" if rest == "]" else "statement-format", self.at, len(self.text))

    def assignment(self, span: Place) -> Statement:
        start = self.at
        target = self.expression(whole=False)
        if target is None:
            return Statement(Kind.ASSIGN, *span)
        target = replace(target, steps=target.steps[:-1]) if target.steps[-1].name == "#" else None
        if not self.text.startswith("=", self.at):
            self.wrong_rest("missing-equal", start)
            return Statement(Kind.ASSIGN, *span, target=target)
        self.at += 1
        value = self.expression(whole=True)
        self.nothing_more()
        return Statement(Kind.ASSIGN, *span, target=target, value=value)

    def condition(self, kind: FaultKind) -> Expression | None:
        """The condition of IF or WHILE. `[..] AND [..]` lacks the bracket around both, but what is meant is clear."""
        start = self.at
        if not self.text.startswith("[", start):
            self.wrong("missing-open-bracket", start)
            return self.expression(whole=True, condition=True, kind=kind)
        condition = self.expression(whole=False, condition=True, kind=kind)
        if _JOINS.match(self.text, self.at):
            self.at = start
            condition = self.expression(whole=True, condition=True, kind=kind)
            self.wrong("missing-open-bracket", start, self.at)
        return condition

    def jump(self) -> Expression | None:
        jump = self.expression(whole=True, kind="statement-format")
        self.nothing_more()
        return jump

    def loop(self, start: int) -> Number | None:
        """The number after DO or END, which stands at start."""
        match = _DIGITS.match(self.text, self.at)
        if match is None:
            self.wrong_rest("statement-format", start)
            return None
        self.at = match.end()
        loop = self.number(match[0], start)
        if not 1 <= loop.value <= self.loops:
            self.wrong("loop-number", start, self.at)
        self.nothing_more()
        return loop

    def after_while(self, span: Place, condition: Expression | None) -> Statement:
        start = self.at
        if self.take_keyword() == "DO":
            return Statement(Kind.WHILE_DO, *span, condition=condition, loop=self.loop(start))
        self.wrong_rest("while-format", start)
        return Statement(Kind.WHILE_DO, *span, condition=condition)

    def after_if(self, span: Place, condition: Expression | None) -> Statement:
        start = self.at
        if self.keyword() == "THEN":
            self.take_keyword()
        elif self.keyword() != "GOTO":
            self.wrong("if-format", start, len(self.text))
        if self.keyword() == "GOTO":
            self.take_keyword()
            return Statement(Kind.IF_GOTO, *span, condition=condition, jump=self.jump())
        if self.at >= len(self.text) or self.keyword() not in ("", *_OUTPUTS):
            self.wrong_rest("if-format", start)
            return Statement(Kind.IF_THEN, *span, condition=condition)
        start = self.at
        then = self.statement()
        if then.kind is Kind.NC or then.call.startswith("M"):
            self.wrong("nc-and-macro", start, len(self.text))
        return Statement(Kind.IF_THEN, *span, condition=condition, then=replace(then, fault=self.fault))

    def nc_words(self, span: Place) -> Statement:
        words: list[Word] = []
        while self.at < len(self.text):
            start, sign = self.at, self.text[self.at]
            if len(words) + len(self.skips) >= self.size:
                self.wrong_rest("too-long", start)
            elif sign == "#" or self.keyword():
                self.wrong_rest("nc-and-macro", start)
            elif skip := _SKIP.match(self.text, start):
                self.at = skip.end()
                self.skips.append(self.number(skip[1] or "1", start))
            elif sign == "<":
                words += self.name()
            elif _ADDRESS.match(self.text, start):
                words += self.word()
            else:
                self.wrong(_ALONE.get(sign, "stray-character"), start)
                self.at += 1
        call = next((word.code for word in words if word.code in self.calls), "")
        return Statement(Kind.CALL if call else Kind.NC, *span, words=tuple(words), call=call)

    def name(self) -> list[Word]:
        """A program's name in < >, which keeps its letters as written."""
        start, end = self.at, self.text.find(">", self.at)
        if end < 0:
            self.wrong_rest("stray-character", start)
            return []
        self.at = end + 1
        span = self.characters.span(start, self.at)
        written = self.block[span[0] + 1 : span[1] - 1].strip() if self.block else self.text[start + 1 : end]
        return [Word("<", Expression((), *span), written, *span)]

    def word(self) -> list[Word]:
        """One word, or none where its value cannot be read; then what may be its number is passed over."""
        start = self.at
        if name := self.axis_name():
            return self.named(name)
        address = "," * (self.text[start] == ",") + self.text[start + (self.text[start] == ",")]
        self.at = begin = start + len(address)
        if number := _WRITTEN.match(self.text, begin):
            self.at = number.end()
            span = self.characters.span(begin, self.at)
            value = constant(float(number[0]), *span)
            return [Word(address.replace(":", "O"), value, number[0], *self.characters.span(start, self.at))]
        if address in "O:" and self.text.startswith("<", begin):
            return []
        if _CALCULATED.match(self.text, begin):
            calculated = self.calculated(begin)
            if address in "NO:":
                self.wrong("format", start, self.at)
            return [Word(address, calculated, None, *self.characters.span(start, self.at))] if calculated else []
        number = _NO_VALUE.match(self.text, begin)
        self.at = number.end() if number else begin
        self.wrong("word-format", start, self.at)
        self.lose(start, address)
        return []

    def lose(self, start: int, address: str) -> None:
        """Keep the name of a word that gives no number: what the control makes of it is not known."""
        span = self.characters.span(start, self.at)
        if self.lost and span[0] < self.lost[-1].end:
            return
        match = _LOST.match(self.text, start)
        text = match[0] if match else address
        end = self.characters.span(start, start + len(text))[1]
        self.lost.append(Unread(shortened(text, _SHOWN), span[0], end, address in AXIS_LETTERS))

    def axis_name(self) -> str:
        """The name of an axis with its = that stands here; "" where there is none, or where it is the end of a word."""
        if not self.has_equal or (self.at and self.text[self.at - 1].isalpha()):
            return ""
        match = _NAMED.match(self.text, self.at)
        return match[1] if match else next((n for n in self.names if self.text.startswith(f"{n}=", self.at)), "")

    def named(self, name: str) -> list[Word]:
        """A word with =: a number, or an expression, which needs no brackets there."""
        start = self.at
        self.at = begin = start + len(name) + 1
        if self.at >= len(self.text):
            self.wrong("word-format", start, self.at)
            self.lose(start, name[0])
            return []
        if name[0] not in AXIS_LETTERS and not _VALUE.match(self.text, begin):
            # A word of another language, as R1=R2*2: it is told by its name, and nothing here is wrong.
            span = self.characters.span(begin, len(self.text))
            self.at = len(self.text)
            unknown = constant(UNKNOWN, *span)
            return [Word(name, unknown, None, *self.characters.span(start, self.at))]
        match = _WRITTEN.match(self.text, begin)
        value = self.expression(whole=True)
        written = match[0] if match and match.end() == self.at else None
        return [Word(name, value, written, *self.characters.span(start, self.at))] if value else []

    def calculated(self, begin: int) -> Expression | None:
        """The value of a word: a variable or an expression in brackets; without brackets it is a fault, but is read."""
        function = self.text[begin : begin + 2].lstrip("+-")[:1].isalpha()
        value = self.expression(whole=False)
        if value and (function or _BEYOND.match(self.text, self.at)):
            self.at = begin
            value = self.expression(whole=True)
            self.wrong("missing-open-bracket", begin, self.at)
        return value


def read_statement(
    block: str,
    *,
    calls: frozenset[str],
    loops: int,
    levels: int,
    size: int = 20_000,
    names: Collection[str] = (),
) -> Statement:
    """
    Read one block, given without comments; blanks and small letters are allowed anywhere.

    calls: the codes that call a program or return from one, in the spelling of `Word.code`. loops: the highest number
    of DO and END. levels: of brackets, in each expression. size: bound of words, and of the steps of an expression.
    names: of axes that are written with =, beside those of a letter and a number.
    """
    return _Reader(block, calls, loops, levels, size, names).block_statement()
