from __future__ import annotations

from polarcheck.checking.causes import SECTION_READ_OTHERWISE
from polarcheck.checking.rule import NOTE, Mask, OtherMachine, rule


@rule(NOTE, "reads well on another machine: {fit}", at=("on",), follows={"program": SECTION_READ_OTHERWISE})
def other_machine_fits(other_machine: OtherMachine) -> Mask:
    """
    Program for another machine.

    The codes that switch the polar mode, the address of its second axis, and whether X is a diameter or a radius in it
    differ from control to control. What looks like many faults may be a program that is right on another lathe. Check
    which control the program is for, and check it with --machine.

    Source: FANUC B-62764EN/01, p. 51; Haas codes, G112; Mitsubishi M700V, p. 73 and 77; Okuma OSP-P300 post.

    Good, machine haas-lathe:

        O1
        G17 G98
        M5
        M154
        G28 H0
        T0101
        M133 P1000
        G0 X80. C0
        G112
        G1 X20. F20.
        Y10.
        X-20.
        Y-10.
        X20.
        G113
        M135
        M155
        M30

    Good:

        O1
        T0101
        G98
        G0 X100. C0
        G12.1
        G1 X80. C20. F200
        G3 X40. C40. R20.
        G1 X60.
        G13.1
        M30
    """
    # Compares nothing: machines are compared by reading the program as each of them would.
    return other_machine.fits
