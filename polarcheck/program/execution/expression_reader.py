"""
One reader for the expressions of all languages: `#1*SIN[#2+30]`, `R1+5*SIN(R2)`.

A language is a Grammar (its operators, functions and brackets) and a Lexer (how a block is cut into tokens). The reader
turns infix tokens into the postfix steps of an Expression, without recursion, in linear time.
"""

from __future__ import annotations

from typing import Final, NamedTuple, Protocol

from polarcheck.program.execution.arithmetic import OPERAND_COUNTS
from polarcheck.program.execution.expression import Expression, Fault, Step
from polarcheck.program.execution.grammar import JOIN_OFFSET, Function, Grammar, Operator
from polarcheck.program.execution.kinds import FaultKind

#: Steps of conditions, and the steps that combine two conditions where the operator also combines numbers.
_COMPARISONS: Final = frozenset(("EQ", "NE", "GT", "LT", "GE", "LE"))
_LOGICAL: Final = {"AND": "BOTH", "OR": "EITHER", "XOR": "ONE"}


class Operand(NamedTuple):
    """
    A token where a value is expected.

    kind: "number", "variable" (its number), "prefix", or "open" (a function or bracket with its opening bracket).
    text: the prefix, or the key of the function.
    number: the number, or that of the variable; NaN where it is unknown.
    start, end: its position in the terms of its lexer.
    """

    kind: str
    text: str
    number: float
    start: int
    end: int


class Following(NamedTuple):
    """A token where an operator is expected; text: "" where it can be none; start, end: as in Operand."""

    text: str
    start: int
    end: int


class Unreadable(Exception):  # noqa: N818 - it ends the reading of one expression and never leaves read_expression
    """Reading ends at this fault."""

    def __init__(self, fault: Fault) -> None:
        super().__init__(fault)
        self.fault = fault


class Lexer(Protocol):
    """Cuts the text of a block into the tokens of an expression. Positions are its own; `span` translates them."""

    @property
    def start(self) -> int:
        """The position of the next token."""
        ...

    def operand(self) -> Operand:
        """Pass over the next token where a value is expected; raises Unreadable where none begins."""
        ...

    def following(self) -> Following:
        """The next token where an operator is expected; it is not passed over."""
        ...

    def pass_over(self, token: Following) -> None: ...

    def take(self, text: str) -> int | None:
        """Pass over this text if it comes next; return the position behind it, else None."""
        ...

    def span(self, start: int, end: int) -> tuple[int, int]:
        """The characters within the block, end exclusive."""
        ...

    def unclosed(self, start: int, token: Following) -> Fault:
        """The fault where an open bracket, which starts at `start`, is followed by a token that cannot stand there."""
        ...


class _Bracket:
    """
    An open bracket, or the whole expression.

    function: what the bracket belongs to.
    start: its position.
    outside: count of operators that wait outside of it.
    arguments: count so far.
    families: of the operators in its present argument.
    join: the last AND, OR or XOR between numbers in it; None where there is none.
    """

    __slots__ = ("arguments", "families", "function", "join", "outside", "start")

    def __init__(self, function: Function, start: int, outside: int, arguments: int = 1) -> None:
        self.function, self.start, self.outside, self.arguments, self.families = function, start, outside, arguments, 0
        self.join: Following | None = None


_WHOLE: Final = Function({1: ()}, "")


class _Reader:
    """Values become steps at once; an operator waits for those that bind more tightly; each bracket is separate."""

    def __init__(self, lexer: Lexer, grammar: Grammar, levels: int, size: int) -> None:
        self.lexer, self.grammar, self.levels, self.size = lexer, grammar, levels, size
        self.steps: list[Step] = []
        self.conditions: list[bool] = []  # for each value that is not used yet: it is a condition
        self.waiting: list[tuple[Operator, int, int]] = []
        self.brackets = [_Bracket(_WHOLE, lexer.start, 0)]
        self.end = lexer.start
        self.too_deep: Fault | None = None
        self.mixed: tuple[int, int] | None = None

    def fault(self, kind: FaultKind, start: int, end: int) -> Fault:
        return Fault(kind, *self.lexer.span(start, end))

    def add(self, name: str, number: float, start: int, end: int) -> None:
        """Add a step. Where conditions are checked, AND, OR and XOR take two conditions or two numbers."""
        if self.grammar.checks_conditions:
            count = OPERAND_COUNTS.get(name, 1)
            used = [self.conditions.pop() for _ in range(count)]
            condition = name in _COMPARISONS
            if name in _LOGICAL and all(used):
                name, condition = _LOGICAL[name], True
            elif any(used):
                raise Unreadable(self.fault("format", start, end))
            self.conditions.append(condition)
        if len(self.steps) >= self.size:
            raise Unreadable(self.fault("too-long", self.brackets[0].start, end))
        self.steps.append(Step(name, number, *self.lexer.span(start, end)))

    def add_waiting(self, precedence: int) -> None:
        """Add the operators that wait in this bracket and bind at least as tightly."""
        while len(self.waiting) > self.brackets[-1].outside and self.waiting[-1][0].precedence >= precedence:
            operator, start, end = self.waiting.pop()
            self.add(operator.step, 0.0, start, end)

    def open(self, function: Function, start: int, end: int, arguments: int = 1) -> None:
        if len(self.brackets) > self.levels and self.too_deep is None:
            self.too_deep = self.fault("bracket-levels", start, end)
        if len(self.brackets) > self.size:
            raise Unreadable(self.fault("bracket-levels", start, end))
        self.brackets.append(_Bracket(function, start, len(self.waiting), arguments))

    def close(self, end: int) -> bool:
        """Close a bracket; return True where a value is expected next: ATAN[..]/[..] is not a division."""
        self.add_waiting(0)
        bracket = self.brackets.pop()
        function, self.end = bracket.function, end
        if function.again and bracket.arguments == 1:
            opened = self.lexer.take(function.again)
            if opened is not None:
                self.open(function, bracket.start, opened, arguments=2)
                return True
        steps = function.steps.get(bracket.arguments)
        if steps is None:
            is_missing = bracket.arguments < min(function.steps)
            raise Unreadable(self.fault("missing-comma" if is_missing else "format", bracket.start, end))
        for step in steps:
            if isinstance(step, str):
                self.add(step, 0.0, bracket.start, end)
            else:
                self.add("number", step, bracket.start, end)
        return False

    def read_value(self) -> None:
        """Read prefixes and opening brackets up to and with a number or a variable."""
        has_sign = False
        while True:
            kind, text, number, start, end = self.lexer.operand()
            self.end = end
            if kind == "prefix":
                is_repeatable = text in self.grammar.repeatable
                if has_sign and not is_repeatable:
                    raise Unreadable(self.fault("format", start, end))
                has_sign = not is_repeatable
                operator = self.grammar.prefixes[text]
                if operator is not None:
                    self.waiting.append((operator, start, end))
            elif kind == "open":
                self.open(self.grammar.functions[text], start, end)
                has_sign = False
            else:
                self.add("number", number, start, end)
                if kind == "variable":
                    self.add("#", 0.0, start, end)
                return

    def continues(self, whole: bool) -> bool:
        """Read closing brackets, then an operator or a comma; return False where the expression ends."""
        lexer, operators = self.lexer, self.grammar.operators
        while True:
            is_inside = len(self.brackets) > 1
            if not is_inside and not whole:
                return False
            token, bracket = lexer.following(), self.brackets[-1]
            if is_inside and token.text == bracket.function.closing:
                lexer.pass_over(token)
                if self.close(token.end):
                    return True
            elif token.text in operators:
                lexer.pass_over(token)
                self.add_operator(operators[token.text], token, bracket)
                return True
            elif not is_inside:
                return False
            elif token.text == "," and (
                self.grammar.takes_any_comma or bracket.arguments < max(bracket.function.steps)
            ):
                lexer.pass_over(token)
                self.add_waiting(0)
                bracket.arguments, bracket.families, bracket.join = bracket.arguments + 1, 0, None
                return True
            else:
                raise Unreadable(lexer.unclosed(bracket.start, token))

    def add_operator(self, operator: Operator, token: Following, bracket: _Bracket) -> None:
        if self.grammar.compares_first:
            operator = self.with_comparisons(operator, token, bracket)
        self.add_waiting(operator.precedence)
        self.waiting.append((operator, token.start, token.end))
        bracket.families = bracket.families | operator.family if operator.family else 0
        if self.mixed is None and any(bracket.families & doubt == doubt for doubt in self.grammar.doubtful):
            self.mixed = self.lexer.span(token.start, token.end)

    def with_comparisons(self, operator: Operator, token: Following, bracket: _Bracket) -> Operator:
        """The operator, below all others where it joins a comparison with the next one."""
        if operator.step in _COMPARISONS and bracket.join is not None:
            raise Unreadable(self.fault("format", bracket.join.start, bracket.join.end))
        if operator.step not in _LOGICAL:
            return operator
        compares = any(waiting.step in _COMPARISONS for waiting, _, _ in self.waiting[bracket.outside :])
        if compares or self.conditions[-1]:
            return Operator(operator.precedence - JOIN_OFFSET, operator.step)
        bracket.join = token
        return operator


def read_expression(
    lexer: Lexer, grammar: Grammar, *, whole: bool = True, levels: int, size: int
) -> tuple[Expression | None, Fault | None]:
    """
    Read the expression that comes next; return it, None where it cannot be calculated, and the fault, if any.

    whole: up to where no operator follows, as after `=`; else one value alone, as after an address: a number, a
    variable, a function or a bracket, with or without a sign. levels: brackets within brackets, those of functions and
    of `#[` included; deeper is a fault, but can be calculated. size: limit of steps and of open brackets.
    """
    reader = _Reader(lexer, grammar, levels, size)
    try:
        reader.read_value()
        while reader.continues(whole):
            reader.read_value()
        reader.add_waiting(0)
    except Unreadable as stop:
        return None, stop.fault
    span = lexer.span(reader.brackets[0].start, reader.end)
    is_condition = grammar.checks_conditions and reader.conditions[-1]
    return Expression(tuple(reader.steps), *span, is_condition, reader.mixed), reader.too_deep
