from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.spindles import Spindles
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the {rotary} axis is not engaged; {code_needed} is missing before {switch}{or_engaged_by}",
    values=("code_needed",),
    at=("on",),
    once="c axis code",
)
def c_axis_not_engaged(mode: PolarMode, axes: PlaneAxes, entry: Entry, spindles: Spindles, machine: Machine) -> Hits:
    """
    Polar mode without the spindle as C axis.

    The spindle has to be switched to C axis by an M code of the builder before it can be positioned. Without it the
    control stops at the first C, or the spindle is not held at all. Stop the spindle, engage the C axis, then go to its
    reference point: M5, M35, G28 H0. Nothing is said where the machine profile names no such code, nor in an excerpt
    that has none. A sub-spindle with codes of its own is engaged by those. On some lathes the code may stand behind the
    switch, before the first move there (polar.engaged_behind).

    Source: builder's guide to G12.1, sample program.

    Bad, set m_codes.c_axis_on=["M35"], set m_codes.c_axis_off=["M34"]:

        O0001
        T0808 M5
        G97 S2000 M33
        G98 G0 X60. C0
        G12.1             (expect: c-axis-not-engaged)
        G1 C10. F1500
        X40. F200
        C-10.
        X60. F1500
        G13.1
        M30

    Bad, set m_codes.c_axis_on=["M35"], set m_codes.c_axis_off=["M34"]:

        M35
        G28 H0
        M34
        G98 G0 X60. C0
        M33
        G12.1             (expect: c-axis-not-engaged)
        G1 C10. F1500
        X60.
        G13.1

    Bad, set m_codes.c_axis_on=["M35"], set m_codes.sub_c_axis_on=["M135"], set m_codes.sub_c_axis_off=["M134"]:

        M135
        G28 H0
        M134
        G98 G0 X60. C0
        M33
        G12.1             (expect: c-axis-not-engaged)
        G1 C10. F1500
        X60.
        G13.1

    Good, machine haas-lathe:

        G98 G17 G0 X2.4 Y0 C0
        G112
        M154
        G1 X.8 F10.
        Y.4
        X2.4
        G113
        M155

    Good, set m_codes.c_axis_on=["M35"], set m_codes.sub_c_axis_on=["M135"]:

        M135
        G28 H0
        G98 G0 X60. C0
        M33
        G12.1
        G1 C10. F1500
        X60.
        G13.1

    Good, set m_codes.c_axis_on=["M35"], set m_codes.c_axis_off=["M34"]:

        O0001
        T0808 M5
        M35
        G28 H0
        G97 S2000 M33
        G98 G0 X60. C0
        G12.1
        G1 C10. F1500
        X40. F200
        C-10.
        X60. F1500
        G13.1
        M30
    """
    codes, engaging = machine.m_codes, spindles.c_axis_codes
    # A sub-spindle alone does not tell by which code the main spindle is engaged.
    expected = entry.expects(codes.c_axis_on and [*engaging, *codes.c_axis_off, *codes.sub_c_axis_off])
    engaged = spindles.c_axis
    if machine.polar.engaged_behind:
        engaged = engaged | mode.anywhere_in_section(mode.first_in_section(mode.in_polar & axes.moves_plane) & engaged)
    missing = mode.enters & mode.rotary_is_followed & ~engaged & expected
    return Hits(missing, values={"code_needed": " or ".join(engaging)})


def details(hit: Hit, spindles: Spindles) -> Details:
    from polarcheck.rules.remedies import or_by

    return {"or_engaged_by": or_by(hit, spindles, "engages it", "m_codes.c_axis_on")}
