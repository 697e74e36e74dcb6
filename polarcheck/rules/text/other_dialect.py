from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.dialect import Dialect
    from polarcheck.rules.hit import Details, Hit

#: More of a line is not needed to find it.
_SIGN_LENGTH = 40


@rule(
    NOTE,
    "{written_for}; no rule looked at it: convert it for this lathe before it is checked",
    over="files",
    doubts=(("mode", "file"),),
)
def other_dialect(dialect: Dialect) -> Hits:
    """
    File in the language of another machine.

    Programs of LinuxCNC with its o words, of Heidenhain controls in plain language, files for 3D printers, plotters and
    the like are no programs in ISO code, though some of their words look so. A lathe control stops in one of the first
    blocks, or moves to places that nobody meant. Nothing else is said of such a file, and its verdict is unverified.
    Signs of several kinds must agree: a single strange word is reported as what it is.

    Source: LinuxCNC, G-code and O codes; Marlin G-code; Heidenhain TNC plain language.

    Bad:

        o100 sub         (expect: other-dialect)
        #<depth>=-5
        G1 Z#<depth> F100
        o100 endsub
        o100 call
        M2

    Bad:

        G28              (expect: other-dialect)
        M104 S200
        G92 E0
        G1 X10 Y10 E5 F300
        G1 X20 E10

    Bad:

        0 BEGIN PGM FLAT MM    (expect: other-dialect)
        1 TOOL CALL 1 Z S5000
        2 L X+10 R0 FMAX M3
        3 END PGM FLAT MM

    Good:

        O0001
        G28 U0 W0
        T0101
        G98 G0 X60. Z2.
        G1 Z-5. F100
        M30
    """
    # Compares nothing: the table looks for the signs of other languages.
    return Hits(dialect.is_other)


def details(hit: Hit, dialect: Dialect) -> Details:
    found = dialect.recognised
    if found is None:
        return {"written_for": "this file is a program in ISO code"}
    sign = found.sign[:_SIGN_LENGTH]
    return {"written_for": f"this file is written for {found.title}, as `{sign}` in line {found.line} shows"}
