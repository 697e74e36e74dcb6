"""
What runs when a macro runs: the variables, an assignment, the value of a word, the arguments and the program of a call.

Sources: FANUC B-62754EN/01, chapter 16 (variables, vacancy, rounding at an address); B-63684EN/01, p. 304 (arguments).
Which variables there are, and which codes call, is the profile's to say: its table [macro].
"""

from __future__ import annotations

import enum
from collections.abc import Mapping
from typing import Final

import msgspec
from msgspec.structs import replace

from polarcheck.program.execution.arithmetic import FAULTY, UNKNOWN, Arithmetic, FromVacant, Unknown, Value, round_to
from polarcheck.program.execution.expression import DEFAULT, Fault, evaluate
from polarcheck.program.execution.kinds import FaultKind
from polarcheck.program.execution.programs import ProgramName
from polarcheck.program.execution.statement import Statement, Word
from polarcheck.program.execution.variable_names import FIRST_PARAMETER, FIRST_VARIABLE, PARAMETERS
from polarcheck.program.machines.macro_keys import Macro


class _Locals(msgspec.Struct):
    """
    The local variables of one macro.

    values: by number.
    unassigned: value of the others.
    """

    values: dict[int, Value] = {}
    unassigned: Value = None


class VariableKind(enum.Enum):
    """The kind of a variable number on a control."""

    NONE = enum.auto()
    VACANT = enum.auto()  # #0
    LOCAL = enum.auto()
    COMMON = enum.auto()
    RETAINED = enum.auto()
    SYSTEM = enum.auto()
    CLOCK = enum.auto()
    READ_ONLY = enum.auto()


class Variables:
    """
    What the variables hold while a program runs: a float, None for vacant, NaN for unknown.

    #0 is always vacant; local variables belong to the macro that runs, all others to every program.
    macro: the ranges of the control. given: values known from the job, by number.
    """

    def __init__(self, macro: Macro, given: Mapping[int, Value] | None = None) -> None:
        self._macro = macro
        self._shared: dict[int, Value] = dict(given or {})
        self._unassigned: Value = None
        self._levels: list[_Locals] = [_Locals()]
        self._kinds: dict[int, VariableKind] = {}

    @property
    def depth(self) -> int:
        """How many macro calls deep; 0 in the main program."""
        return len(self._levels) - 1

    def kind(self, number: float) -> VariableKind:
        """Return the kind of a variable number, rounded to a whole one."""
        if not -0.5 < number < 1e9:
            return VariableKind.NONE
        whole = _whole(number)
        if whole not in self._kinds:
            self._kinds[whole] = _kind(whole, self._macro)
        return self._kinds[whole]

    def exists(self, number: float) -> bool:
        """Return True if the control has a variable of this number."""
        return self.kind(number) is not VariableKind.NONE

    def value(self, number: float) -> Value:
        """The value of a variable that exists; one that is not known names the variable that it rests on."""
        value = self._held(number)
        return Unknown(_whole(number)) if value is UNKNOWN else value

    def _held(self, number: float) -> Value:
        whole, kind = _whole(number), self.kind(number)
        if kind is VariableKind.LOCAL:
            unassigned = UNKNOWN if whole >= FIRST_VARIABLE else self._levels[-1].unassigned
            return self._levels[-1].values.get(whole, unassigned)
        if kind is VariableKind.VACANT:
            return None
        if kind is VariableKind.CLOCK:
            return UNKNOWN
        return self._shared.get(whole, self._unassigned if kind is VariableKind.COMMON else UNKNOWN)

    def write(self, number: float, value: Value) -> FaultKind | None:
        """Assign; None makes vacant. Gives the kind of fault, if any. A number that is unknown may be any."""
        if number != number:
            self.forget()
            return None
        kind = self.kind(number)
        if kind is VariableKind.NONE:
            return "variable-number"
        if kind in (VariableKind.VACANT, VariableKind.READ_ONLY):
            return "read-only"
        (self._levels[-1].values if kind is VariableKind.LOCAL else self._shared)[_whole(number)] = value
        return None

    def belongs_to_program(self, number: int) -> bool:
        """Return True for a common variable, and for a local one of the main program: it is no argument of a call."""
        return number > 0 and (self.kind(number) is VariableKind.COMMON or not self.depth)

    def enter(self, arguments: Mapping[int, Value]) -> None:
        """A macro call: new local variables, vacant but for the arguments."""
        self._levels.append(_Locals(dict(arguments)))

    def leave(self) -> None:
        """The return from a macro: the caller's local variables are back. In the main program nothing happens."""
        if self.depth:
            self._levels.pop()

    def forget(self) -> None:
        """Any variable in reach may have been assigned: all are unknown until assigned again."""
        self._levels[-1] = _Locals(unassigned=UNKNOWN)
        self._shared = {}
        self._unassigned = UNKNOWN


def _whole(number: float) -> int:
    whole = int(number)
    return whole if whole == number else int(round_to(number, 1))


def _kind(number: int, macro: Macro) -> VariableKind:
    if macro.language != "custom-macro" and number >= FIRST_VARIABLE:
        if number >= FIRST_PARAMETER - PARAMETERS:
            is_there = 0 <= number - FIRST_PARAMETER < PARAMETERS
            return VariableKind.RETAINED if is_there else VariableKind.NONE
        return VariableKind.LOCAL if macro.language == "high-level" else VariableKind.COMMON
    ranges = (
        (VariableKind.READ_ONLY, macro.read_only_variables),
        (VariableKind.CLOCK, macro.clock_variables),
        (VariableKind.LOCAL, macro.local_variables),
        (VariableKind.COMMON, macro.common_variables),
        (VariableKind.RETAINED, macro.retained_variables),
        (VariableKind.SYSTEM, macro.system_variables),
    )
    kinds = (kind for kind, spans in ranges if any(first <= number <= last for first, last in spans))
    return next(kinds, VariableKind.NONE) if number else VariableKind.VACANT


def assign(statement: Statement, variables: Variables, arithmetic: Arithmetic = DEFAULT) -> Fault | None:
    """
    Carry out an ASSIGN; give the first fault.

    #2=#1 copies vacancy. A value that cannot be read is unknown. A variable by name has no number and is let go.
    """
    value: Value = FAULTY
    fault: Fault | None = None
    if statement.value is not None:
        value, fault = evaluate(statement.value, variables, arithmetic)
    if statement.target is None:
        return fault
    number, fault_of_target = evaluate(statement.target, variables, arithmetic)
    kind = None if fault_of_target else variables.write(number or 0.0, value)
    if kind is not None:
        fault_of_target = Fault(kind, statement.target.start, statement.target.end, number or 0.0)
    return fault_of_target or fault


#: What a variable is tried with: what gives each of them and the same more is a step, be it written as it may.
_TRIED: Final = (-1.0, 0.0, 0.25, 1.0)


def step_of(statement: Statement, number: float, variables: Variables, arithmetic: Arithmetic = DEFAULT) -> float:
    """
    By how much an ASSIGN changes a variable, be its value known or not: .5 for #5221=#5221+.5; NaN where it is no step.
    """
    held, steps = variables.value(number), []
    if statement.value is None:
        return UNKNOWN
    for tried in _TRIED:
        if variables.write(number, tried) is not None:
            return UNKNOWN
        value, _ = evaluate(statement.value, variables, arithmetic)
        steps.append(UNKNOWN if value is None else value - tried)
    variables.write(number, held)
    return steps[1] if all(abs(step - steps[1]) <= _SAME for step in steps) else UNKNOWN


#: Steps that differ by no more differ by rounding.
_SAME: Final = 1e-9
#: Longer numbers have no exact value here, and no control takes them.
_LARGEST_WORD: Final = 1e15


def word_value(
    word: Word, variables: Variables, increment: float, arithmetic: Arithmetic = DEFAULT
) -> tuple[Value, Fault | None]:
    """
    The value of a word, None where its variable is vacant and the control drops the address; and the first fault. One
    that no word could hold, whatever the control, is unknown.

    increment: the least increment of the address, to which a calculated value is rounded, and to which ROUND rounds. A
    written number comes as it is written: what 10 without a point means is not said here.
    """
    steps = word.value.steps
    if not steps:
        return None, None
    if [step.name for step in steps[-2:]] == ["#", "NEGATE"]:
        value, fault = evaluate(replace(word.value, steps=steps[:-1]), variables, arithmetic, increment)
        value = value if value is None or value != value else 0.0 - value
    else:
        value, fault = evaluate(word.value, variables, arithmetic, increment)
    if value is not None and abs(value) > _LARGEST_WORD:
        return UNKNOWN, fault
    if value is None or value != value or word.written is not None:
        return value, fault
    rounded = round_to(value, increment)
    return (FromVacant(rounded, value.variable) if isinstance(value, FromVacant) else rounded), fault


#: Argument specification I: the local variable of each address. G L N O P are none.
ARGUMENTS: Final = dict(zip("ABCIJKDEFHMQRSTUVWXYZ", [*range(1, 10), 11, 13, *range(17, 27)], strict=True))
_SETS: Final = 10


class Arguments(msgspec.Struct, frozen=True):
    """What a call hands over: the local variables by number; sets: how many sets of I J K; the first fault."""

    values: dict[int, Value]
    sets: int
    fault: Fault | None


def assign_arguments(
    statement: Statement,
    variables: Variables,
    macro: Macro,
    arithmetic: Arithmetic = DEFAULT,
    increments: Mapping[str, float] | None = None,
) -> Arguments:
    """
    The local variables that G65 or G66 gives the macro.

    I J K in this order fill #4 #5 #6. One of them again, or out of order, begins the next set of three: specification
    II, up to #33; controls without it have specification I only. Of two arguments for the same variable the later one
    counts; a vacant one is as not written.
    increments: what a number without a point is multiplied by, for each address; 1 where not given.
    """
    values: dict[int, Value] = {}
    faults: list[Fault | None] = []
    sets, last, seen = 0, "", set()
    for word in _after_call(statement):
        address = word.address
        if (address in ("P", "L") and address not in seen) or address == "<":
            seen.add(address)
            continue
        if address == "G" and statement.call in macro.modal_macro_calls_each_block:
            continue
        if address not in ARGUMENTS:
            faults.append(Fault("argument-address", word.start, word.end))
            continue
        number = ARGUMENTS[address]
        if address in "IJK" and macro.second_arguments:
            sets += address <= last or not last
            last = address
            if sets > _SETS:
                faults.append(Fault("argument-sets", word.start, word.end))
                break
            number += 3 * (sets - 1)
        value, fault = evaluate(word.value, variables, arithmetic)
        faults.append(fault)
        if value is not None:
            is_counted = word.has_point or value != value
            values[number] = value if is_counted else value * (increments or {}).get(address, 1.0)
    return Arguments(values, sets, next(filter(None, faults), None))


def _after_call(statement: Statement) -> tuple[Word, ...]:
    """The words after the code that makes the call."""
    index = next((i for i, word in enumerate(statement.words) if word.code == statement.call), -1)
    return statement.words[index + 1 :]


class ProgramCall(msgspec.Struct, frozen=True):
    """
    The program that a call names.

    program: its number or name.
    repeats: how often it runs; None where that is unknown.
    fault: the first one, if any.
    begin: the N number at which it begins, UNKNOWN where that is computed and not known; None for its head.
    is_own: the call names no program but a part of the one that calls.
    """

    program: ProgramName
    repeats: int | None
    fault: Fault | None
    begin: float | None = None
    is_own: bool = False


_UNKNOWN_PROGRAM: Final = ProgramName(None, None)


def called_program(
    statement: Statement, variables: Variables, macro: Macro, arithmetic: Arithmetic = DEFAULT
) -> ProgramCall:
    """
    The program that M98, M198, G65 or G66 calls.

    Where the control has `repeats_in_p`, P of a subprogram call with five to eight digits has the repeats before the
    last four: P68003 is six times O8003. Else, and in macro calls, P is the number alone. Where P has no repeats, L has
    them. Where the control has a `sequence_word`, that of a subprogram call is the N number at which the program
    begins; without P and a name it is one of the program that calls. P of `local_calls` is such an N number.
    """
    is_local = statement.call in macro.local_calls
    is_subprogram = is_local or statement.call in macro.subprogram_calls
    words = {word.address: word for word in reversed(statement.words if is_subprogram else _after_call(statement))}
    repeats: int | None = 1
    fault: Fault | None = None
    if "L" in words:
        value, fault = evaluate(words["L"].value, variables, arithmetic)
        repeats = None if value != value else 1 if value is None else max(_whole(value), 0)
    begin: float | None = None
    of_begin = "P" if is_local else macro.sequence_word if is_subprogram else ""
    if of_begin in words:
        begin, fault_of_begin = evaluate(words[of_begin].value, variables, arithmetic)
        fault = fault or fault_of_begin
    if is_local and begin is not None:
        return ProgramCall(_UNKNOWN_PROGRAM, repeats, fault, begin, is_own=True)
    if "<" in words:
        return ProgramCall(ProgramName(None, words["<"].written), repeats, fault, begin)
    if "P" not in words and begin is not None:
        return ProgramCall(_UNKNOWN_PROGRAM, repeats, fault, begin, is_own=True)
    if "P" not in words:
        return ProgramCall(_UNKNOWN_PROGRAM, repeats, Fault("program-number", statement.start, statement.end))
    value, fault_of_number = evaluate(words["P"].value, variables, arithmetic)
    fault = fault_of_number or fault
    if value is not None and value != value:
        return ProgramCall(_UNKNOWN_PROGRAM, repeats, fault)
    number = _whole(value or 0.0) if abs(value or 0.0) < 1e15 else 0
    if macro.repeats_in_p and is_subprogram and 9999 < number <= 99_999_999:
        times, number = divmod(number, 10_000)
        repeats = times
    if not 0 < number <= 99_999_999:
        return ProgramCall(_UNKNOWN_PROGRAM, repeats, Fault("program-number", words["P"].start, words["P"].end))
    return ProgramCall(ProgramName(number, None), repeats, fault, begin)
