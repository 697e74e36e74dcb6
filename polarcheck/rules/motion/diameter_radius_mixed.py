from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import SECTION_READ_OTHERWISE
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.regularity import Regularity, XReading
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.other_machine import OtherMachine


@rule(
    WARNING,
    "{misfit_of_x}",
    at=("on",),
    once="section",
    subject="",
    doubts=SECTION_READ_OTHERWISE,
    follows={"section": ("wrong-axis-address-in-polar",)},
    gouges=True,
)
def diameter_radius_mixed(arcs: Arcs, regularity: Regularity) -> Mask:
    """
    X written as a radius where the control reads a diameter, or the other way.

    Most lathes read X in the mode as a diameter, some as a radius; C, I, J and R are radii on all. Here the ends of all
    arcs miss their circles as this machine reads X, and none does with the other reading: the program is for another
    machine, or polar.x of the profile is wrong. The shape would come out stretched along X. Reported once for the
    section, in place of its arcs. Without arcs that miss, it is reported where the contour becomes a regular polygon of
    at least five sides with the other reading, or all of its arcs tangent; C may be what is twice as large, and is
    where the arcs show it: it is a radius where X is a diameter.

    Source: FANUC B-62764EN/01, p. 51; Mitsubishi M700V programming manual, parameter 8111 and the example on p. 77.

    Bad:

        G98 G0 X60. C0
        G12.1             (expect: diameter-radius-mixed)
        G1 X20. C10. F200
        G3 X10. C20. I-10. J0
        G1 X-10.
        G3 X-20. C10. I0 J-10.
        G1 C0
        G13.1

    Bad, set polar.x="radius":

        G98 G0 X60. C0
        G12.1             (expect: diameter-radius-mixed)
        G1 X40. C10. F200
        G3 X20. C20. I-10. J0
        G1 X60.
        G13.1

    Bad, set polar.x="radius":

        G98 G0 X60. C0
        G12.1             (expect: diameter-radius-mixed)
        G1 X40. C10. F200
        G3 X20. C20. R10.
        G1 X-20.
        G3 X-40. C10. R10.
        G1 C0
        G13.1

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1             (expect: diameter-radius-mixed)
        G1 G42 X15. F200
        C8.66
        X0 C17.321
        X-15. C8.66
        C-8.66
        X0 C-17.321
        X15. C-8.66
        C0
        G40 X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1             (expect: diameter-radius-mixed)
        G1 X40. C20. F200
        G3 X20. C40. R10.
        G1 X-20.
        G3 X-40. C20. R10.
        G1 C0
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. I-10. J0
        G1 X-20.
        G3 X-40. C10. I0 J-10.
        G1 C0
        G13.1
    """
    return arcs.x_is_misread | arcs.c_is_misread | regularity.x_is_misread


def details(hit: Hit, arcs: Arcs, regularity: Regularity, mode: PolarMode, other_machine: OtherMachine) -> Details:
    is_diameter = bool(hit.trace.lengths.x_factor[hit.row] < 1)
    read, meant = ("diameter", "radius") if is_diameter else ("radius", "diameter")
    reading = None if arcs.x_is_misread[hit.row] else regularity.x_readings.get(int(mode.section[hit.row]))
    if not arcs.x_is_misread[hit.row] and (arcs.c_is_misread[hit.row] or (reading and reading.of_c)):
        half, is_tangent = f"{hit.virtual} half as large", not arcs.c_is_misread[hit.row]
        fits = "is tangent as it is written, all are" if is_tangent else "fits as it is written, all do"
        return {"misfit_of_x": f"no arc of this section {fits} with {half}; write {half}"}
    written_for = other_machine.text or f"; write X as a {read}"
    if reading is None:
        text = f"no arc of this section fits with X read as a {read}, all fit with X as a {meant}"
        return {"misfit_of_x": f"{text}{written_for}"}
    x, c = ("twice", "half") if reading.factor > 1 else ("half", "twice")
    if (reading.factor > 1) == is_diameter:
        return {"misfit_of_x": f"{_misfit(reading, x)}{written_for}, or {hit.virtual} {c} as large"}
    return {"misfit_of_x": f"{_misfit(reading, x)}; write X {x} or {hit.virtual} {c} as large"}


def _misfit(reading: XReading, large: str) -> str:
    """How the section does not fit as X is read, and how it would."""
    from polarcheck.geometry.shapes.shape import polygon_name

    becomes = reading.becomes
    if becomes is None:
        return f"no arc of this section is tangent as it is written, all are with X {large} as large"
    if becomes.is_regular:
        polygon = polygon_name(becomes.corners)
        return f"with all X {large} as large the contour would be a regular {polygon}, as it is written it is not"
    turn = f"{360 / becomes.order:g} deg"
    return f"with all X {large} as large the contour would look the same after each turn of {turn}, now it does not"
