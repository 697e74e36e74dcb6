from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.spindles import Spindles
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the C axis is clamped here; write {code_needed} before {switch}",
    values=("code_needed",),
    once="section",
)
def c_axis_clamped_in_polar(spindles: Spindles) -> Mask:
    """
    Contour with the C axis clamped.

    The brake holds the spindle for drilling. In the polar mode C turns with every move: against the brake the drive
    stops with an alarm for excess error, or the contour is cut with a C axis that lags behind. Release the brake before
    G12.1. The rule is silent if the machine profile names no code that clamps.

    Source: C-axis clamp and unclamp codes of turning centers, as public posts for Mazak and Okuma write them.

    Bad, set m_codes.c_axis_clamp=["M210"], set m_codes.c_axis_unclamp=["M212"]:

        M210
        G98 G0 X60. C0
        G12.1
        G1 C10. F200      (expect: c-axis-clamped-in-polar)
        X40.
        C-10.
        X60.
        G13.1

    Bad, set m_codes.c_axis_clamp=["M210"], set m_codes.c_axis_unclamp=["M212"]:

        G98 G0 X60. C0
        M212
        G12.1
        G1 C10. F200
        M210
        X40.              (expect: c-axis-clamped-in-polar)
        C-10.
        X60.
        G13.1

    Good, set m_codes.c_axis_clamp=["M210"], set m_codes.c_axis_unclamp=["M212"]:

        M210
        G98 G0 X60. C0
        M212
        G12.1
        G1 C10. F200
        X40.
        C-10.
        X60.
        G13.1
        M210
    """
    # A slot along X alone is cut with the clamp on.
    return spindles.turns & spindles.clamped


def details(hit: Hit, spindles: Spindles, machine: Machine) -> Details:
    codes = machine.m_codes
    off = codes.sub_c_axis_unclamp if spindles.on_sub_spindle[hit.row] else codes.c_axis_unclamp
    return {"code_needed": next(iter(off), "the code that releases it")}
