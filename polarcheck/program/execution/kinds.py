"""
The kinds of fault that reading and running macro statements can find, and of what a run could not know.

A kind says what is wrong, not who reports it nor in which words: the rules and the sentences stand in checking. The
numbers beside the kinds are FANUC's alarms, of the 16i family and, where it has another, of the 30i.
"""

from __future__ import annotations

from typing import Final, Literal, TypeAlias, get_args

FaultKind: TypeAlias = Literal[
    # ---- a statement that cannot be read ----
    "format",  # 114
    "statement-format",  # 125
    "missing-open-bracket",  # 114, PS1131
    "missing-close-bracket",  # 114, PS1132
    "missing-equal",  # 114, PS1133
    "missing-comma",  # 114, PS1134
    "if-format",  # 114, PS1137
    "while-format",  # 114, PS1138
    "word-format",  # 004 to 007: an address without a number, in a block with macro
    "stray-character",  # 009, in a block with macro
    "too-long",  # no alarm: the bound of this reader
    "bracket-levels",  # 118
    "nc-and-macro",  # 127
    "loop-number",  # 126
    # ---- a calculation ----
    "zero-divide",  # 112
    "overflow",  # 111
    "integer-overflow",  # 110
    "negative-square-root",  # 119
    "arc-function-beyond-one",  # 111, 119
    "logarithm-not-positive",  # 111, 119
    "argument-out-of-range",  # 119, of BIN, BCD and POW
    # ---- variables ----
    "variable-number",  # 115
    "read-only",  # 116
    "word-vacant",  # no alarm: the control drops the address
    # ---- calls ----
    "argument-address",  # 129 for G
    "argument-sets",  # PS1095
    "program-number",  # 076: no P, or no program number
    "program-not-found",  # 078
    "call-target-not-found",  # 078: M98 with the N number of a block that is not there
    "call-levels",  # 077 for subprograms, 122 for macros
    # ---- jumps and loops ----
    "sequence-number-not-found",  # 128
    "sequence-number-vacant",  # 128
    "label-not-found",
    "label-too-long",
    "return-target-not-found",  # 078
    "loop-without-end",  # 124
    "end-without-loop",  # 124, PS1124
    "structure-without-end",  # IF without ENDIF, FOR without ENDFOR
    "end-without-structure",
    "loops-crossed",  # 124
    "loop-inside-itself",  # 124
    "loop-levels",  # 124: loops nested too deep
    # ---- a run that would not end ----
    "nothing-changes",  # no alarm: the control goes on for ever
    "too-many-blocks",  # no alarm, as the next two: a bound of this check
    "too-many-statements",
    "runs-too-long",
    "too-many-repeats",  # no alarm: the bound of this check
    # ---- what is legal, and seldom meant ----
    "mixed-logic",  # no alarm: AND, OR, XOR beside + - * / without brackets
    "sequence-number-twice",  # no alarm: the control takes the next one
    "never-run",  # no alarm, as the next one: blocks that no run comes to
    "loop-never-run",
]

#: All kinds of fault.
KINDS: Final[frozenset[str]] = frozenset(get_args(FaultKind))

#: Why something was not executed or not known.
RemarkKind: TypeAlias = Literal[
    "stops-itself",  # an assignment to a variable that stops the program, as #3000 = 1
    "condition-unknown",
    "program-unknown",  # which program is called
    "program-in-several-files",  # likewise
    "return-jumps",  # M99 P in the main program
    "not-simulated",  # a statement of the control's own language
    "corner-not-made",  # a rounding or a chamfer between two moves
]
