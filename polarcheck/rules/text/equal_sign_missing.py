from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "{word} lacks its =: R is an arithmetic parameter here (R1=5), and the radius of an arc CR=; the control stops",
    values=("word",),
    over="words",
)
def equal_sign_missing(written: Written) -> Mask:
    """
    Arithmetic parameter without =.

    R is no word of Siemens controls: R1 to R999 are parameters, which take a value by `=`, as in `R1=5`. The radius of
    an arc is `CR=10`. The control stops at `R10` in an arc, as programs for ISO controls have it, and at `R1 5`.

    Source: NC programming 840D sl 12/2019 p. 192 (CR=), and its chapter on arithmetic parameters.

    Bad, machine siemens-transmit:

        G94 S2=1000 M2=3
        DIAMOF
        G0 X60 C0
        TRANSMIT
        G17
        G1 X20 F200
        G3 X0 Y20 R20        ; (expect: equal-sign-missing)
        G1 X60
        TRAFOOF
        M30

    Good, machine siemens-transmit:

        R1=20
        G94 S2=1000 M2=3
        DIAMOF
        G0 X60 C0
        TRANSMIT
        G17
        G1 X20 F200
        G3 X0 Y20 CR=20
        G1 X60
        TRAFOOF
        M30
    """
    # Compares nothing: the table finds the words.
    return written.lacks_equal_sign
