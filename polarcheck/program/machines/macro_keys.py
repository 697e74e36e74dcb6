"""Custom macro and calls as a lathe knows them: the keys of [macro]."""

import re
from typing import Annotated, Literal

import msgspec

from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.value_checks import (
    Address,
    AddressOrNone,
    Count,
    LanguageCode,
    Plain,
    Positive,
    Ranges,
    Variable,
)

#: The lists of codes among the keys.
CODE_LISTS = (
    "subprogram_calls",
    "local_calls",
    "macro_calls",
    "modal_macro_calls",
    "modal_macro_calls_each_block",
    "modal_macro_cancel",
    "program_returns",
)
_FLOW_CODE = lazy_pattern(r"[GM](?:0|[1-9]\d{0,2})(?:\.[1-9])?", re.ASCII)


class Macro(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    Custom macro and calls.

    language: of statements: custom-macro (#1), high-level (R1, X=R1, IF .. GOTOF NAME) or user-task (VC1, IF [..] NAME)
    parameter_letter: letter of the parameters of such a language, which take a value by = (R1=5); empty: it is a word
    master_spindle_word: word that makes another spindle than 1 that of M3, M4, M5 and S, as SETMS(3); empty: none does
    named_words: words of several letters with = in such a language, by the address that each is read as; empty: none
    other_language: code that begins the other language of a control that has two; empty where it has one
    statements: statement (* for any rest) or first word of one -> what is not followed, as below
    local_variables: ranges, first and last number, of local variables, of which each macro call has its own
    common_variables: ranges of common variables that are vacant at power-on
    retained_variables: ranges of common variables that outlive the power-off: not known until a program assigns them
    system_variables: ranges of system variables: offsets, positions, modal states, signals; not known unless given
    read_only_variables: ranges of system variables that a program cannot assign; nor can it #0, which is always vacant
    clock_variables: ranges of system variables that count on by themselves: not known even after an assignment
    alarm_variables: system variables by which a program ends itself with an alarm: #3000 = 1 (MESSAGE)
    stop_variables: system variables by which a program stops with a message until cycle start: #3006 = 1 (MESSAGE)
    tool_offset_variables: ranges of system variables that are tool offsets, so that an assignment changes one
    work_offset_variables: ranges of system variables that are work offsets
    subprogram_calls: codes that call a subprogram by its number in P or its <NAME>; M198 that of another device
    sequence_name_limit: most letters and digits behind N of a sequence name, to which jumps lead; 0: not known, or none
    sequence_word: address beside such a call of the N number at which it begins, without P in its program; or empty
    local_calls: codes that call the blocks of the same program from the N number in P on
    macro_calls: codes that call a macro once; the other words of the block are its arguments
    modal_macro_calls: codes after which each block that moves an axis calls the macro
    modal_macro_calls_each_block: modal calls that take the words of each block as arguments, G codes too
    modal_macro_cancel: codes that end a modal call
    program_returns: codes that return from a called program
    computed_increments: address -> what a computed value is rounded to there; elsewhere to the least input increment
    bracket_levels: most levels of brackets in an expression, those of functions included
    loop_numbers: highest number of DO and END
    loop_levels: most loops inside each other
    subprogram_levels: most levels of subprogram calls
    macro_levels: most levels of macro calls
    repeats_in_p: whether P of a subprogram call with more than four digits has the repeats before the last four
    second_arguments: whether a macro call takes I J K up to ten times: argument specification II
    signed_angles: whether ATAN gives -180 to 180 and ASIN -90 to 90, else 0 to 360 and 270 to 90
    largest_number: a result above it overflows
    given: variable -> its value, as the job or the machine knows it

    Of a statement, none: it moves nothing and changes no path. speeds: the same, but axes and spindles may run
    otherwise, which a comparison says. path: the path or the feed changes, and the positions stay. moves: nobody knows
    where the axes stand after it. words: the same, and the words behind it are its own. Then there are cycle, which is
    as moves, but outside the mode the positions alone are open until they are programmed again, and calls, which is the
    same of what it names, and nothing without a name.
    """

    language: Literal["custom-macro", "high-level", "user-task"]
    parameter_letter: AddressOrNone = ""
    master_spindle_word: Plain = ""
    named_words: dict[Plain, AddressOrNone] = {}
    other_language: LanguageCode = ""
    statements: dict[Plain, Literal["none", "speeds", "path", "words", "moves", "cycle", "calls"]] = {}
    local_variables: Ranges
    common_variables: Ranges
    retained_variables: Ranges
    system_variables: Ranges
    read_only_variables: Ranges
    clock_variables: Ranges
    alarm_variables: list[int]
    stop_variables: list[int]
    tool_offset_variables: Ranges
    work_offset_variables: Ranges
    subprogram_calls: list[str]
    sequence_name_limit: Annotated[int, msgspec.Meta(ge=0, le=99)]
    sequence_word: AddressOrNone
    local_calls: list[str]
    macro_calls: list[str]
    modal_macro_calls: list[str]
    modal_macro_calls_each_block: list[str]
    modal_macro_cancel: list[str]
    program_returns: list[str]
    computed_increments: dict[Address, Positive]
    bracket_levels: Count
    loop_numbers: Count
    loop_levels: Count
    subprogram_levels: Count
    macro_levels: Count
    repeats_in_p: bool
    second_arguments: bool
    signed_angles: bool
    largest_number: Annotated[float, msgspec.Meta(gt=0)]
    given: dict[Variable, float] = {}

    def __post_init__(self) -> None:
        for code in self.flow_codes:
            if not _FLOW_CODE.fullmatch(code):
                raise ValueError(f"{code!r}: expected a G or M code as in G66.1 or M98, without leading zeros")
        for kind in ("local", "common", "retained", "system", "read_only", "clock"):
            for first, last in getattr(self, f"{kind}_variables"):
                if first > last:
                    raise ValueError(f"{kind}_variables: the range {first} to {last} ends before it begins")

    @property
    def macro_call_codes(self) -> frozenset[str]:
        """The codes that call a macro with arguments, once or modally."""
        return frozenset((*self.macro_calls, *self.modal_macro_calls, *self.modal_macro_calls_each_block))

    @property
    def call_codes(self) -> frozenset[str]:
        """The codes that call a program."""
        return self.macro_call_codes | frozenset((*self.subprogram_calls, *self.local_calls))

    @property
    def flow_codes(self) -> frozenset[str]:
        """The codes that call a program, end a modal call, or return."""
        return self.call_codes | frozenset((*self.modal_macro_cancel, *self.program_returns))
