from __future__ import annotations

from polarcheck.checking.causes import SECTION_READ_OTHERWISE
from polarcheck.checking.rule import WARNING, Arcs, Mask, rule


@rule(
    WARNING,
    "no arc of this section fits with X read as a {reading}, all fit with X as a {other}{written_for}",
    at=("on",),
    once="section",
    subject="",
    doubts=SECTION_READ_OTHERWISE,
    follows={"section": ("wrong-axis-address-in-polar",)},
)
def diameter_radius_mixed(arcs: Arcs) -> Mask:
    """
    X written as a radius where the control reads a diameter, or the other way.

    Most lathes read X in the mode as a diameter, some as a radius; C, I, J and R are radii on all. Here the ends of all
    arcs miss their circles as this machine reads X, and none does with the other reading: the program is for another
    machine, or polar.x of the profile is wrong. The shape would come out stretched along X. Reported once for the
    section, in place of its arcs.

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
    # Compares nothing: the table tries both readings of X on all arcs of a section and counts which fit.
    return arcs.x_is_misread
