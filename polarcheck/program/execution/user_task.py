"""
Statements of user tasks: VC1=5, X=VC1, CALL O1234 DIA=20, IF [VC1 EQ 1] NEND.

Each part of a block is read as what custom macro writes for it: an assignment, words, and one statement of the flow.
Sources: public notes on the manuals of OSP-P200L, 5238-E, and OSP-P300L (source 71138944758): IF and GOTO
with a sequence name or number, CALL with variables, RTS, MODIN; VC1 from the OSP-E100M.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Final

from msgspec.structs import replace

from polarcheck.program.execution.macro_tokens import Characters
from polarcheck.program.execution.statement import Kind, Statement
from polarcheck.program.execution.task_values import FLOW, MOST, SEQUENCE_NAME, SYSTEM, UNKNOWN, Piece, Token, Values
from polarcheck.program.execution.variable_names import Names
from polarcheck.program.machines.machine import Machine

#: Zero offset, zero shift and tool offset of Z: they move nothing on the polar plane.
_OF_Z: Final = re.compile(r"V(?:ZOF|ZSH|TOF)Z")
#: What shifts or offsets an axis: zero offset, zero shift, tool offset, nose radius. Other values of the control, as
#: those of the load monitor or of outputs, move nothing.
_OF_POSITION: Final = re.compile(r"V(?:ZOF|ZSH|TOF|ETF|NSR)[A-Z0-9]*+")
#: Input and output of data, and what a schedule program has.
_NO_MOVE: Final = frozenset(("GET", "PUT", "READ", "WRITE", "PSELECT", "LPRINT"))


def read_user_task(
    block: str, machine: Machine, names: Names, read_macro: Callable[[Characters], Statement]
) -> Statement:
    """
    Read a block and its statements.

    machine: has the codes and axes. names: the names of variables and tools so far. read_macro: reads custom macro.
    """
    return _Block(block, machine, names, read_macro).statement()


class Rewriting:
    """The characters of a block rewritten as custom macro, each with the index of the one that it stands for."""

    def __init__(self) -> None:
        self._text: list[str] = []
        self._places: list[int] = []

    def put(self, text: str, start: int, end: int) -> None:
        """Add text that stands for the characters from start to end of the block."""
        visible = [index for index in range(len(text)) if not text[index].isspace()]
        self._text += [text[index].upper() for index in visible]
        self._places += [min(start + index, max(end - 1, start)) for index in visible]

    def before(self, other: Rewriting) -> Characters:
        """These characters, and those of the other rewriting behind them."""
        return Characters("".join((*self._text, *other._text)), [*self._places, *other._places])


class _Block(Values):
    """One block while it is read."""

    def __init__(
        self, block: str, machine: Machine, names: Names, read_macro: Callable[[Characters], Statement]
    ) -> None:
        super().__init__(block, names)
        self.macro, self.read_macro = machine.macro, read_macro
        self.arcs = machine.arcs
        self.is_larger_arc = any(token.text == self.arcs.larger_arc_word for token in self.tokens)
        self.head = Rewriting()
        self.assignments: list[Statement] = []
        self.words = Rewriting()
        self.has_words = False
        self.flow: Statement | None = None

    # ---- the block ----

    def statement(self) -> Statement:
        """All parts of the block, in the order in which they are carried out."""
        if not self.tokens:
            return Statement(Kind.NC, 0, 0)
        if len(self.tokens) > MOST:
            self.at = len(self.tokens)
            self.leave(0, moves=True)
        self.heads()
        while self.at < len(self.tokens):
            self.part()
        if any(unread.moves for unread in self.unread) or not (self.assignments or self.has_words or self.flow):
            self.has_words = True
        parts = list(self.assignments)
        if self.has_words:
            parts.append(self.read_as(self.words))
        if self.flow is not None:
            parts.append(self.flow)
        return replace(parts[0], more=tuple(parts[1:]), unread=tuple(self.unread))

    def read_as(self, rewriting: Rewriting) -> Statement:
        """What custom macro reads, with block skip and sequence number before it."""
        return self.read_macro(self.head.before(rewriting))

    def heads(self) -> None:
        """Block skip, and a sequence number or name; NOEX only keeps the block from being stopped at."""
        while self.at < len(self.tokens):
            token, following = self.peek(), self.peek(1)
            if self.is_sign("/"):
                self.at += 1
                self.head.put("/", token.start, token.end)
                if following.kind == "number" and following.start == token.end and len(following.text) == 1:
                    self.put_token(self.head, self.take())
            elif token.kind == "letter" and token.text == "N" and following.kind == "number":
                self.at += 2
                self.head.put("N" + following.text, token.start, following.end)
            elif token.text == "NOEX" or (token.kind == "name" and SEQUENCE_NAME.fullmatch(token.text)):
                self.at += 1
            else:
                return

    @staticmethod
    def put_token(rewriting: Rewriting, token: Token) -> None:
        rewriting.put(token.text, token.start, token.end)

    def part(self) -> None:
        """One assignment, one word, or one statement of the flow."""
        first, token = self.at, self.peek()
        if token.kind == "letter":
            self.word_or_variable()
        elif token.kind != "name":
            self.at += 1
            self.leave(first, moves=True)
        elif token.text in FLOW and self.flow is None:
            self.at += 1
            known = {"IF": self.after_if, "GOTO": self.go_to, "CALL": self.call, "MODIN": self.call}
            known.get(token.text, self.returning)(first)
        elif token.text == self.arcs.larger_arc_word:
            self.at += 1
        elif token.text in _NO_MOVE:
            self.at = len(self.tokens)
            self.leave(first, moves=False)
        elif self.macro.statements.get(token.text) == "none":
            self.at = len(self.tokens)
        elif SYSTEM.fullmatch(token.text):
            self.system_assignment()
        elif self.is_sign("=", 1):
            self.named()
        else:
            self.at += 1
            # Behind G85 and its like it names the contour, which is passed over as other turning is.
            if not SEQUENCE_NAME.fullmatch(token.text):
                self.leave(first, moves=True)

    # ---- words and assignments ----

    def word_or_variable(self) -> None:
        """X10., X=VC1+2, X[VC1], or V1=5."""
        first, letter, following = self.at, self.take(), self.peek()
        if letter.text == "V" and following.kind == "number" and self.is_sign("=", 1):
            self.at += 1
            variable = self.variable_number("V", following)
            self.at += 1
            self.assign(variable, first)
            return
        if self.is_sign("="):
            self.at += 1
            self.computed(letter.text, first)
        elif self.is_sign("["):
            self.computed(letter.text, first)
        elif (sign := self.sign_of_number()) is not None:
            number = self.take()
            if self.is_larger_arc and letter.text == self.arcs.radius_word:
                sign = "-"
            self.put_token(self.words, letter)
            self.words.put(sign + number.text, number.start - len(sign), number.end)
            self.has_words = True
        else:
            self.leave(first, moves=True)

    def sign_of_number(self) -> str | None:
        """Take the sign of a number that stands here; None where none does."""
        if self.peek().kind == "number":
            return ""
        if (self.is_sign("-") or self.is_sign("+")) and self.peek(1).kind == "number":
            return self.take().text
        return None

    def computed(self, address: str, first: int) -> None:
        """A word whose value is an expression, which comes next; address: empty where nothing of it is checked."""
        pieces = self.expression()
        if pieces is None:
            self.leave(first, moves=bool(address))
        elif address:
            start = self.tokens[first].start
            is_turned = self.is_larger_arc and address == self.arcs.radius_word
            self.words.put(f"{address}[" + "-[" * is_turned, start, start + 1)
            self.put_pieces(self.words, pieces)
            self.words.put("]" * (1 + is_turned), self.tokens[self.at - 1].end - 1, self.tokens[self.at - 1].end)
            self.has_words = True

    @staticmethod
    def put_pieces(rewriting: Rewriting, pieces: Sequence[Piece]) -> None:
        for piece in pieces:
            rewriting.put(*piece)

    def named(self) -> None:
        """SB=2000, a word of two letters, or DIA=20, a local variable."""
        first, name = self.at, self.take()
        self.at += 1  # =
        if name.text in self.macro.named_words:
            self.computed(self.macro.named_words[name.text], first)
        else:
            number = self.variable_number(name.text) if name.text.startswith("VC") else None
            self.assign(self.names.variable(name.text) if number is None else number, first)

    def assign(self, number: int | None, first: int) -> None:
        """An assignment, whose value comes next, to the variable of a number."""
        pieces = self.expression()
        if pieces is None or number is None:
            self.leave(first, moves=False)
            return
        start = self.tokens[first].start
        rewriting = Rewriting()
        rewriting.put(f"#{number}=", start, pieces[0][1] or start + 1)
        self.put_pieces(rewriting, pieces)
        self.assignments.append(self.read_as(rewriting))

    def system_assignment(self) -> None:
        """VZOFX=10.: a value of the control, as an origin or an offset, set by the program."""
        first, name = self.at, self.take()
        self.index_of()
        if self.is_sign("="):
            self.at += 1
            self.expression()
        of_z = _OF_Z.fullmatch(name.text) is not None
        if _OF_POSITION.fullmatch(name.text):
            self.leave(first, moves=not of_z, matters=not of_z)

    def index_of(self) -> list[Piece]:
        """Take the brackets behind the name of a system variable; what is in them, or nothing."""
        if not self.is_sign("["):
            return []
        return self.expression(one=True) or []

    # ---- the flow ----

    def after_if(self, first: int) -> None:
        """IF [VC1 EQ 1] NEND, IF [..] GOTO N10, or IF ABC NEND: the variable has a value."""
        begin = self.at
        pieces = self.expression()
        if pieces is None:
            self.at = len(self.tokens)
            self.leave(first, moves=True)
            return
        if self.at == begin + 1 or (self.at == begin + 2 and self.tokens[begin].kind == "letter"):
            pieces = [*pieces, ("NE#0", pieces[-1][1], pieces[-1][2])]
        if self.peek().text == "GOTO":
            self.at += 1
        rewriting = Rewriting()
        start, end = self.tokens[first].start, self.tokens[first].end
        rewriting.put("IF", start, end)
        rewriting.put("[", pieces[0][1], pieces[0][2])
        self.put_pieces(rewriting, pieces)
        rewriting.put("]GOTO", pieces[-1][1], pieces[-1][2])
        self.jump(rewriting, first)

    def go_to(self, first: int) -> None:
        rewriting = Rewriting()
        self.put_token(rewriting, self.tokens[first])
        self.jump(rewriting, first)

    def jump(self, rewriting: Rewriting, first: int) -> None:
        """The sequence number or name to go to, behind what has been put."""
        token, following, label = self.peek(), self.peek(1), ""
        if token.kind == "letter" and token.text == "N" and following.kind == "number":
            self.at += 2
            rewriting.put(following.text, following.start, following.end)
        elif token.kind == "number":
            self.put_token(rewriting, self.take())
        elif token.kind == "name" and token.text.startswith("N"):
            label = self.take().text
            rewriting.put("1", token.start, token.end)
        else:
            self.at = len(self.tokens)
            self.leave(first, moves=True)
            return
        statement = self.read_as(rewriting)
        if label:
            statement = replace(statement, label=label, jump=None, end=max(statement.end, token.end))
        self.flow = statement

    def call(self, first: int) -> None:
        """CALL O1234 Q3 DIA=20, MODIN O1234: the program, how often, and the local variables that it is given."""
        token, following = self.peek(), self.peek(1)
        is_modal = self.tokens[first].text == "MODIN"
        code = (self.macro.modal_macro_calls if is_modal else self.macro.subprogram_calls)[0]
        rewriting = Rewriting()
        rewriting.put(code, self.tokens[first].start, self.tokens[first].end)
        if token.kind == "letter" and token.text == "O" and following.kind == "number":
            self.at += 2
            rewriting.put("P" + following.text, token.start, following.end)
        elif token.kind == "name" and token.text.startswith("O"):
            self.at += 1
            rewriting.put(f"<{token.text}>", token.start, token.end)
        else:
            self.at = len(self.tokens)
            self.leave(first, moves=True)
            return
        if self.peek().kind == "letter" and self.peek().text == "Q" and self.peek(1).kind == "number":
            letter, number = self.take(), self.take()
            rewriting.put("L" + number.text, letter.start, number.end)
        before = len(self.assignments)
        while self.at < len(self.tokens) and self.is_assignment():
            self.part()
        targets = [statement.target for statement in self.assignments[before:] if statement.target is not None]
        numbers = [int(target.steps[0].number) for target in targets if target.steps[0].number > UNKNOWN]
        self.flow = replace(self.read_as(rewriting), assigned=tuple(numbers))

    def is_assignment(self) -> bool:
        token = self.peek()
        if token.kind == "letter":
            return token.text == "V" and self.peek(1).kind == "number" and self.is_sign("=", 2)
        return token.kind == "name" and self.is_sign("=", 1)

    def returning(self, first: int) -> None:
        """RTS and MODOUT."""
        is_return = self.tokens[first].text == "RTS"
        rewriting = Rewriting()
        code = (self.macro.program_returns if is_return else self.macro.modal_macro_cancel)[0]
        rewriting.put(code, self.tokens[first].start, self.tokens[first].end)
        self.flow = self.read_as(rewriting)
