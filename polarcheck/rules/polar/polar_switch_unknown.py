from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.switch_slips import SwitchSlips


@rule(WARNING, "{slip}", values={"code_needed": "switch_meant"})
def polar_switch_unknown(switch_slips: SwitchSlips) -> Hits:
    """
    Code that is meant to switch the polar mode and does not.

    The point of G12.1 is lost, G121, or the digit behind it, G12. The control stops at the code, or knows it as
    something else: the mode does not begin, and C of the contour is an angle. The same holds for G13.1, with which the
    mode does not end. Write the code with its point.

    Where G121 is answered by G120, the builder may have given the mode codes of its own: then polar.on and polar.off of
    a machine profile name them. Until then nothing of the contour is looked at.

    Source: FANUC B-62764EN/01, p. 51; alarm 010; G100 to G199 are free for macros of the builder.

    Bad:

        G98 G0 X60. C0
        G121              (expect: polar-switch-unknown)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13               (expect: polar-switch-unknown)
        G0 Z50.
        M30

    Bad:

        O1
        G98 G0 X60. C0
        G121              (expect: polar-switch-unknown)
        G1 X40. F200
        C10.
        X60.
        G120
        M30

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    certain, begins = switch_slips.is_certain, switch_slips.begins
    return graded(error=certain, warning=begins & ~certain, at=switch_slips.words)
