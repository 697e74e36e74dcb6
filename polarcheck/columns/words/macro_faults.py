"""
What macro and flow found wrong, as a table: one element per fault, with the rule that reports it and the reason.

One table maps each kind of fault to its rule; two more have the reasons, of faults and of what a run could not know.
"""

from __future__ import annotations

import bisect
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Mask, cached_property, is_among
from polarcheck.foundation.errors import consecutive, first_of
from polarcheck.program.execution.kinds import FaultKind, RemarkKind
from polarcheck.program.execution.programs import find_programs
from polarcheck.program.execution.run import Remark, Run
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.excerpt import shortened

#: The kinds of fault that each rule reports. Words of other dialects look like a faulty word (E=C, CR=10), and nobody
#: knows what the control makes of them: no rule reports them, and the first is told as not evaluated, by name.
_KINDS_OF = {
    "macro-syntax": (
        "format statement-format missing-open-bracket missing-close-bracket missing-equal missing-comma if-format "
        "while-format too-long"
    ),
    "": "word-format stray-character",
    "nesting-too-deep": "bracket-levels call-levels loop-levels",
    "arithmetic-error": (
        "zero-divide overflow integer-overflow negative-square-root arc-function-beyond-one logarithm-not-positive "
        "argument-out-of-range"
    ),
    "macro-argument": "argument-address argument-sets",
    "subprogram-missing": "program-number program-not-found",
    "jump-target-missing": (
        "sequence-number-not-found sequence-number-vacant label-not-found label-too-long return-target-not-found "
        "call-target-not-found"
    ),
    "loop-unbalanced": (
        "loop-without-end end-without-loop structure-without-end end-without-structure loops-crossed loop-inside-itself"
    ),
    "endless-loop": "nothing-changes too-many-blocks too-many-statements runs-too-long too-many-repeats",
    "mixed-macro-and-nc": "nc-and-macro",
    "loop-number-out-of-range": "loop-number",
    "variable-out-of-range": "variable-number",
    "read-only-variable": "read-only",
    "vacant-variable": "word-vacant",
    "ambiguous-precedence": "mixed-logic",
    "duplicate-sequence-number": "sequence-number-twice",
    "unreachable-block": "never-run loop-never-run",
}
#: The rule that reports each kind of fault; "" where none does.
RULES: Final[Mapping[str, str]] = {kind: rule for rule, kinds in _KINDS_OF.items() for kind in kinds.split()}

#: The rule that reports a program that never ends, and one that was broken off at a bound.
ENDLESS_LOOP = "endless-loop"
_BOUNDS = ("too-many-blocks", "too-many-statements", "runs-too-long", "too-many-repeats")
#: What a condition that is not known may end.
_LOOPS = ("nothing-changes", *_BOUNDS[:-1])
#: So many missing programs are reported one by one: more are missing for one reason, as a folder that nobody has given.
_ONE_BY_ONE = 5
#: Spans of their numbers in a message.
_NAMED = 8
_MANY = "many programs"
#: Of a name in a reason [characters].
_LONGEST = 40

#: Where a rule reports several kinds: what is wrong, to follow the words at fault or to stand for itself.
_REASONS: Final[Mapping[FaultKind, str]] = {
    "format": "does not fit into the expression",
    "statement-format": "cannot be read as a macro statement or the rest of one",
    "missing-open-bracket": "lacks an opening bracket [",
    "missing-close-bracket": "lacks a closing bracket {closing}",
    "missing-equal": "lacks the = of an assignment",
    "missing-comma": "lacks the comma between two values",
    "if-format": "cannot follow the condition of an IF: write GOTO 10, or THEN and one assignment",
    "while-format": "cannot follow the condition of a WHILE: write DO and a number",
    "too-long": "is longer than a block can be",
    "bracket-levels": "is a bracket more than {bracket_levels} levels deep",
    "call-levels": "calls more than {levels} levels deep and is not followed",
    "loop-levels": "is a loop more than {levels} levels deep",
    "zero-divide": "divides by zero",
    "overflow": "gives a result above {largest_number:g}",
    "integer-overflow": "takes a whole number of more than 32 bits",
    "negative-square-root": "takes the square root of {number:g}",
    "arc-function-beyond-one": "takes ASIN or ACOS of {number:g}, which lies beyond 1",
    "logarithm-not-positive": "takes LN of {number:g}",
    "argument-out-of-range": "takes BIN, BCD or POW of {number:g}, which has no result",
    "argument-address": "hands over no argument: a macro call takes A to F, H to K, M and Q to Z",
    "argument-sets": "begins an eleventh set of I J K: a macro call takes ten",
    "program-number": "names no program: P takes a number from 1 to 99999999{local_call}",
    "program-not-found": (
        "calls {program}{times}, which is not in this file and in no folder of the job (--subprograms FOLDER); "
        "positions after it are not known{others}"
    ),
    "sequence-number-not-found": "there is no N{number:.15g} in this program",
    "sequence-number-vacant": "the number to go to is a vacant variable",
    "label-not-found": "there is no label {label}{where} in this program",
    "label-too-long": (
        "{label} is no sequence name of this control, which has N and {limit} letters or digits at most; give it a "
        "shorter one"
    ),
    "return-target-not-found": "there is no N{number:.15g} in the calling program",
    "call-target-not-found": "there is no N{number:.15g} in {called}",
    "loop-without-end": "DO{number} has no END{number} behind it",
    "end-without-loop": "END{number} has no DO{number} before it",
    "structure-without-end": "{keyword} has no {missing} behind it",
    "end-without-structure": "{keyword} has no {missing} before it",
    "loops-crossed": "DO{number} begins inside the loop of DO{other} and ends outside it",
    "loop-inside-itself": "DO{number} stands inside the loop of another DO{number}",
    "nothing-changes": "comes back here with no variable changed since the last time: it never ends until it is reset",
    "too-many-blocks": (
        "is still reached after {limit} blocks more than the file has; the rest is not executed (--max-blocks)"
    ),
    "too-many-statements": (
        "is still reached after {limit} macro statements and calls more than the file has; the rest is not executed "
        "(--max-statements)"
    ),
    "runs-too-long": "is still reached after {limit:g} seconds; the rest is not executed (--max-seconds)",
    "never-run": "the block before it goes elsewhere, and no jump leads here",
    "loop-never-run": "{expression} is false as {counter} begins with {start:g}{comparison}",
    "too-many-repeats": (
        "calls {repeats:.15g} times, more than the {limit} blocks that a check executes; it is run once here"
    ),
}

#: What is to be given where it hangs on a variable.
_VARIABLES = "; [run.variables] in polarcheck.toml gives variables, as in 500 = 1.5"
#: Why something was not executed or not known.
_REMARKS: Final[Mapping[RemarkKind, str]] = {
    "stops-itself": "the program stops itself with #{number}{variables}",
    "condition-unknown": (
        "the condition depends on a value that is not known, and is taken as not fulfilled{variables}"
    ),
    "program-unknown": "which program is called depends on a value that is not known{variables}",
    "program-in-several-files": (
        "{program} is in {files}, which differ: which of them the control calls is not known, and {first} is checked; "
        "keep one of them in the folders of the job"
    ),
    "not-simulated": "{name} is not simulated",
    "corner-not-made": "{word} is not simulated: {reason}",
    "return-jumps": "{code} P in the main program jumps and is taken as the end: check what follows it yourself",
}


class Faults:
    """Columns over the faults of a run; the methods give what stands in one of them."""

    def __init__(self, run: Run, machine: Machine) -> None:
        self.run = run
        self._macro = machine.macro

    @cached_property
    def kind(self) -> NDArray[np.str_]:
        """What is wrong: kinds.FaultKind."""
        return np.array([fault.kind for fault in self.run.faults], np.str_)

    @cached_property
    def rule(self) -> NDArray[np.str_]:
        """
        The rule that reports each fault; "" where it has reported another kind at the same place before, or the same
        program that is missing.
        """
        said: set[tuple[str, object]] = set()
        rules = []
        one_reason = len(self._missing) > _ONE_BY_ONE
        for fault in self.run.faults:
            rule = RULES[fault.kind]
            if fault.kind in _LOOPS and self._program(fault.block) in self._undecided:
                rules.append("")  # what is not known may end it: that is told as not evaluated
                continue
            program: object = fault.values.get("program", fault.start)
            if "called" in fault.values:  # several calls of a part that is missing
                program = fault.values["called"], fault.values["number"]
            key = rule, _MANY if one_reason and "program" in fault.values else program
            rules.append("" if key in said else rule)
            said.add(key)
        return np.array(rules, np.str_)

    @property
    def is_bound(self) -> Mask:
        """Where a run was broken off at a bound of this check, which the control does not have."""
        return is_among(self.kind, _BOUNDS)

    @cached_property
    def _first_blocks(self) -> list[int]:
        return [program.first for program in find_programs(self.run.text).programs]

    def _program(self, block: int) -> int:
        """The number of the program that a block belongs to."""
        return bisect.bisect_right(self._first_blocks, block)

    @cached_property
    def _undecided(self) -> set[int]:
        """The programs in which a condition hangs on a value that is not known."""
        return {self._program(one.block) for one in self.run.remarks if one.kind == "condition-unknown"}

    def values(self, index: int) -> dict[str, str | int | float]:
        """What is known of a fault, by name, the limits of the control among it."""
        macro = self._macro
        limits: dict[str, str | int | float] = {
            "bracket_levels": macro.bracket_levels,
            "loop_numbers": macro.loop_numbers,
            "largest_number": macro.largest_number,
            "local_call": f"; {macro.local_calls[0]} P calls a part of the same program" if macro.local_calls else "",
        }
        fault = self.run.faults[index]
        written, values = self.run.text.source.excerpt(fault.start, fault.end), fault.values
        closing = ")" if "(" in written and "[" not in written else "]"
        blocks = self._calling_blocks.get(values.get("program"), ())
        return {
            **limits,
            "closing": closing,
            "times": f" in {len(blocks)} blocks" if len(blocks) > 1 else "",
            "others": self._others(values.get("program")),
            "comparison": f"; with {values['instead']} the loop would run" if values.get("instead") else "",
            **values,
        }

    @cached_property
    def _calling_blocks(self) -> dict[object, set[int]]:
        """The blocks that call each program that is missing."""
        found: dict[object, set[int]] = {}
        for fault in self.run.faults:
            if "program" in fault.values:
                found.setdefault(fault.values["program"], set()).add(fault.start)
        return found

    @property
    def _missing(self) -> list[str]:
        """The programs that are missing, in the order of the calls."""
        return [str(program) for program in self._calling_blocks]

    def _others(self, program: object) -> str:
        """The other missing programs that a finding stands for: `; O7002 to O7038 are missing as well`; else empty."""
        if program is None or len(self._missing) <= _ONE_BY_ONE:
            return ""
        others = first_of(_spans([name for name in self._missing if name != program]), _NAMED)
        return f"; {others} are missing as well"

    def reason(self, index: int) -> str:
        """What is wrong, in words."""
        values = self.values(index).items()
        shown = {
            name: shortened(one, _LONGEST) if isinstance(one, str) and name != "others" else one for name, one in values
        }
        text = _REASONS[self.run.faults[index].kind].format_map(shown)
        return text if self._macro.language == "custom-macro" else text.replace("macro statement", "statement")


def reason_of(remark: Remark, run: Run, machine: Machine) -> str:
    """Why something was not executed, in words."""
    variables = _VARIABLES if machine.macro.language == "custom-macro" and not run.blocks_run_once else ""
    return _REMARKS[remark.kind].format_map({"variables": variables, **remark.values})


def _spans(names: Sequence[str]) -> list[str]:
    """Names of programs, numbers that follow each other in one span: `O7002 to O7038`, `<SUB>`."""
    numbers = sorted(int(name[1:]) for name in names if name[1:].isdigit())
    shown = [
        f"O{span[0]:04d} to O{span[-1]:04d}" if len(span) > 2 else ", ".join(f"O{one:04d}" for one in span)
        for span in consecutive(numbers)
    ]
    return [*shown, *(name for name in names if not name[1:].isdigit())]
