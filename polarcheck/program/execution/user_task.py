"""
Statements of user tasks: VC1=5, X=VC1, CALL O1234 DIA=20, IF [VC1 EQ 1] NEND.

A block is assignments, words and one statement of the flow, carried out in this order wherever they stand.
Sources: public notes on the manuals of OSP-P200L, 5238-E, and OSP-P300L (source 71138944758): IF and GOTO
with a sequence name or number, CALL with variables, RTS, MODIN; VC1 from the OSP-E100M.
"""

from __future__ import annotations

import re
from typing import Final

from msgspec.structs import replace

from polarcheck.program.execution.expression import Expression, Fault, Step, constant
from polarcheck.program.execution.language_tokens import Token
from polarcheck.program.execution.spoken_block import SpokenBlock
from polarcheck.program.execution.statement import Kind, Statement, Unread, Word
from polarcheck.program.execution.task_tokens import (
    FLOW,
    SEQUENCE_NAME,
    SYSTEM,
    USER_TASK,
    common_variable,
    named_variable,
)
from polarcheck.program.execution.variable_names import FIRST_VARIABLE, Names
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.excerpt import shortened

#: What shifts or offsets an axis of the polar plane: zero offset, zero shift and tool offset but those of Z, and the
#: nose radius. Other values of the control, as those of the load monitor or of outputs, move nothing there.
_OF_POSITION: Final = re.compile(r"V(?:(?:ZOF|ZSH|TOF)(?!Z\b)|ETF|NSR)[A-Z0-9]*+")
#: Input and output of data, and what a schedule program has.
_NO_MOVE: Final = frozenset(("GET", "PUT", "READ", "WRITE", "PSELECT", "LPRINT"))
#: How much of what is not simulated a message names [characters].
_NAMED: Final = 60


def read_user_task(block: str, machine: Machine, names: Names) -> Statement:
    """
    Read a block and its statements.

    machine: has the codes and axes. names: the names of variables and tools so far.
    """
    return _Block(block, machine, names).read_block()


class _Block(SpokenBlock):
    """One block while it is read. Assignments are done before its words, the flow behind them."""

    nothing = Kind.NC

    def __init__(self, block: str, machine: Machine, names: Names) -> None:
        super().__init__(block, USER_TASK, machine, names, machine.macro.bracket_levels)
        larger = machine.arcs.larger_arc_word
        self.is_larger_arc = bool(larger) and any(token.text == larger for token in self.tokens)

    def read_block(self) -> Statement:
        self.head()
        self.first = self.token
        while self.token.kind != "end":
            self.part()
        return self.statement()

    def head(self) -> None:
        """Block skip, and a sequence number or name; NOEX only keeps the block from being stopped at."""
        while self.take_skip() or self.take_sequence_number("N") or self.is_named_head():
            pass

    def is_named_head(self) -> bool:
        """Pass over a sequence name or NOEX if it is the next token."""
        token = self.token
        is_head = token.text == "NOEX" or (token.kind == "name" and bool(SEQUENCE_NAME.fullmatch(token.text)))
        self.at += is_head
        return is_head

    def leave(self, first: Token, *, moves: bool, matters: bool = True) -> None:
        """Name the tokens from the first to the next one as not simulated."""
        end = max(self.last_end, first.end)
        shown = shortened(" ".join(self.block[first.start : end].split()), _NAMED)
        self.unread.append(Unread(shown, first.start, end, moves, matters))

    def leave_rest(self, first: Token) -> None:
        """Name all from a token on as not simulated."""
        self.at = len(self.tokens) - 1
        self.leave(first, moves=True)

    def part(self) -> None:
        """One assignment, one word, or one statement of the flow."""
        first = self.take_token()
        if first.kind == "letter":
            self.letter(first)
        elif first.kind != "name":
            self.leave(first, moves=True)
        elif first.text in FLOW and first.text != "NOEX" and not self.after:
            self.flow(first)
        elif first.text == self.machine.arcs.larger_arc_word:
            pass
        elif first.text in _NO_MOVE:
            self.at = len(self.tokens) - 1
            self.leave(first, moves=False)
        elif self.effect(first.text) == "none":
            self.at = len(self.tokens) - 1
        elif SYSTEM.fullmatch(first.text):
            self.system_variable(first)
        elif self.take_sign("="):
            self.named(first)
        # Behind G85 and its like a name is that of the contour, which is passed over as other turning is.
        elif not SEQUENCE_NAME.fullmatch(first.text):
            self.leave(first, moves=True)

    # ---- words and assignments ----

    def task_expression(self, *, condition: bool = False) -> Expression | None:
        """Read an expression; None where none begins, which is no fault, or where it cannot be calculated."""
        begin = self.at
        value = self.expression() if self.begins_value() else None
        if value is None or value.condition == condition:
            return value
        is_single = self.at == begin + 1 + (self.tokens[begin].kind == "letter")
        if condition and is_single:  # the variable has a value
            place = value.start, value.end
            steps = (*value.steps, Step("number", 0.0, *place), Step("#", 0.0, *place), Step("NE", 0.0, *place))
            return replace(value, steps=steps, condition=True)
        self.fault = self.fault or Fault("if-format" if condition else "format", value.start, value.end)
        return None

    def letter(self, first: Token) -> None:
        """X10., X=VC1+2, X[VC1], or V1=5."""
        is_signed = self.token.text in ("-", "+")
        number = self.token_ahead(is_signed)
        if first.text == "V" and self.token.kind == "number" and self.is_sign("=", 1):
            self.at += 2
            self.assign_task(common_variable(number.text), first, number)
        elif self.is_sign("[") or self.take_sign("="):
            self.computed(first.text, first)
        elif number.kind == "number":
            sign = self.token.text if is_signed else ""
            self.at += 1 + is_signed
            if self.is_larger_arc and first.text == self.machine.arcs.radius_word:
                sign = "-"
            self.add_number(first.text, sign + number.text, first, number)
        else:
            self.leave(first, moves=True)

    def computed(self, address: str, first: Token) -> None:
        """A word whose value is an expression, which comes next; address: with = where nothing of it is checked."""
        if not self.begins_value():
            self.leave(first, moves=address[-1] != "=")
            return
        value = self.task_expression()
        if value is not None:
            if self.is_larger_arc and address == self.machine.arcs.radius_word:
                value = replace(value, steps=(*value.steps, Step("NEGATE", 0.0, value.start, value.end)))
            self.words.append(Word(address, value, None, first.start, value.end))

    def named(self, first: Token) -> None:
        """SB=2000, a word of two letters, or DIA=20, a local variable; behind the =."""
        words = self.machine.macro.named_words
        if first.text in words:
            self.computed(words[first.text] or f"{first.text}=", first)
        else:
            self.assign_task(named_variable(first.text, self.names), first, first)

    def assign_task(self, number: int | None, first: Token, last: Token) -> None:
        """An assignment, whose value comes next, to the variable of a number."""
        begins, value = self.begins_value(), self.task_expression()
        if number is None or not begins:
            self.leave(first, moves=False)
            return
        target = constant(float(number), first.start, last.end)
        self.before.append(Statement(Kind.ASSIGN, first.start, self.last_end, target=target, value=value))

    def system_variable(self, first: Token) -> None:
        """VZOFX=10.: a value of the control, as an origin or an offset, set by the program; or VC[VC1]=5."""
        index: Expression | None = None
        if first.text == "VC" and self.is_sign("["):
            index = self.expression()
        elif self.is_sign("["):
            self.skip_brackets()
        if self.take_sign("="):
            value = self.task_expression()
            if index is not None:
                self.before.append(Statement(Kind.ASSIGN, first.start, self.last_end, target=index, value=value))
        if index is None:
            is_of_position = _OF_POSITION.fullmatch(first.text) is not None
            self.leave(first, moves=is_of_position, matters=is_of_position)

    # ---- the flow ----

    def flow(self, first: Token) -> None:
        macro = self.machine.macro
        match first.text:
            case "IF":
                self.after_if(first)
            case "GOTO":
                self.jump(Kind.GOTO, first, None)
            case "CALL":
                self.call(macro.subprogram_calls[0], first)
            case "MODIN":
                self.call(macro.modal_macro_calls[0], first)
            case "MODOUT":
                self.add_call(macro.modal_macro_cancel[0], first)
            case _:
                self.add_call(macro.program_returns[0], first)

    def after_if(self, first: Token) -> None:
        """IF [VC1 EQ 1] NEND, IF [..] GOTO N10, or IF ABC NEND: the variable has a value."""
        if not self.begins_value():
            self.leave_rest(first)
            return
        condition = self.task_expression(condition=True)
        if self.token.kind == "end" and self.fault is not None:
            self.after.append(Statement(Kind.IF_THEN, first.start, self.last_end))
            return
        self.at += self.token.text == "GOTO"
        self.jump(Kind.IF_GOTO, first, condition)

    def jump(self, kind: Kind, first: Token, condition: Expression | None) -> None:
        """The sequence number or name to go to, which comes next."""
        self.at += self.token.text == "N"
        target = self.take_token()
        statement = Statement(kind, first.start, target.end, condition=condition)
        if target.kind == "number":
            jump = constant(float(target.text), target.start, target.end)
            self.after.append(replace(statement, jump=jump))
        elif target.kind == "name" and target.text[0] == "N":
            self.after.append(replace(statement, label=target.text))
        else:
            self.leave_rest(first)

    def call(self, code: str, first: Token) -> None:
        """CALL O1234 Q3 DIA=20, MODIN O1234: the program, how often, and the local variables that it is given."""
        token, number = self.token, self.token_ahead(1)
        if token.text == "O" and number.kind == "number":
            value = constant(float(number.text), number.start, number.end)
            program = Word("P", value, number.text, token.start, number.end)
            self.at += 2
        elif token.kind == "name" and token.text[0] == "O":
            program = Word("<", Expression((), token.start, token.end), token.text, token.start, token.end)
            self.at += 1
        else:
            self.leave_rest(first)
            return
        words = [program]
        letter, number = self.token, self.token_ahead(1)
        if letter.text == "Q" and number.kind == "number":
            value = constant(float(number.text), number.start, number.end)
            words.append(Word("L", value, number.text, letter.start, number.end))
            self.at += 2
        before = len(self.before)
        while self.is_assignment():
            self.part()
        targets = [part.target.steps[0].number for part in self.before[before:] if part.target is not None]
        assigned = tuple(int(number) for number in targets if number >= FIRST_VARIABLE)
        self.add_call(code, first, *words, assigned=assigned)

    def is_assignment(self) -> bool:
        """True where V1= or a name with its = comes next."""
        token = self.token
        if token.kind == "letter":
            return token.text == "V" and self.token_ahead(1).kind == "number" and self.is_sign("=", 2)
        return token.kind == "name" and self.is_sign("=", 1)

    def add_call(self, code: str, first: Token, *words: Word, assigned: tuple[int, ...] = ()) -> None:
        """What calls, returns or ends a modal call, as the code of the profile for it."""
        value = constant(float(code[1:]), first.start, first.end)
        calling = Word(code[0], value, code[1:], first.start, first.end)
        end = words[-1].end if words else first.end
        call = Statement(Kind.CALL, first.start, end, words=(calling, *words), call=code, assigned=assigned)
        self.after.append(call)
