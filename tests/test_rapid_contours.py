"""A contour in rapid traverse at depth, on each control that takes G0 in the mode; positioning beside it is sound."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said

RULE = "rapid-along-contour"
MODES = {
    "haas-lathe": ("G112\nG17", "G113", "Y"),
    "siemens-transmit": ("TRANSMIT", "TRAFOOF", "Y"),
    "mitsubishi-m700": ("G12.1", "G13.1", "C"),
    "fagor-8055t": ("G16 XC", "G18", "C"),
}
CORNERS = "11.5 6.64|0 13.28|-11.5 6.64|-11.5 -6.64|0 -13.28|11.5 -6.64|11.5 0"
DOWN, ON, OFF, UP = "G1 Z-5. F100", "G42 X11.5 Y0 F200", "G1 G40 X30. Y0", "G0 Z5."


def rules(machine: str, *blocks: str) -> list[str]:
    """The findings of the rule about a section, which begins above the face at X30 Y0."""
    on, off, axis = MODES[machine]
    lines = "\n".join(blocks).replace("Y", axis)
    program = f"G94 G0 X30. C0 Z5.\n{on}\nG0 X30. {axis}0\n{lines}\n{off}\nG0 X100.\n"
    changes = {"control": {"units": "mm"}}
    report = report_of("T1 D1\n" + program, machine, "1/1:radius=4" if "TRANS" in on else "1:radius=4", changes=changes)
    return [f"{rule} {line}" for line, rule in said(report) if rule == RULE]


def sides(first: str = "") -> str:
    points = (point.split() for point in CORNERS.split("|"))
    return first + "\n".join(f"X{x} Y{y}" for x, y in points)


@pytest.mark.nightly
@looped("machine", MODES, one_in=4)
@looped(
    ("down", "start_up", "contour", "cancel"),
    [
        (DOWN, ON, sides("G0 "), OFF),
        (DOWN, ON, "G1 X11.5 Y6.64\nX0 Y13.28\nG0 X-11.5 Y6.64\nG1 Y-6.64\nX0 Y-13.28", OFF),
        # The start-up is missing, and G0 is still in force.
        ("G0 Z-5.", "M8", sides(), OFF),
        ("G0 Z-5.", "M8", sides(), "G40 X30. Y0"),
    ],
)
def test_a_contour_at_depth_is_one_finding(machine: str, down: str, start_up: str, contour: str, cancel: str) -> None:
    assert len(rules(machine, down, start_up, contour, cancel, UP)) == 1


@pytest.mark.ci
@looped("machine", MODES, one_in=8)
@looped(
    "blocks",
    [
        (DOWN, ON, sides(), OFF, UP),
        (DOWN, ON, sides(), "G0 G40 X30. Y0", UP),
        (DOWN, "G0 G42 X11.5 Y0", sides("G1 F200 "), OFF, UP),
        # Above the face, between two passes.
        (DOWN, ON, sides(), OFF, UP, "G0 X-30. Y2.", "X-25. Y-2.", "X20. Y0", "X30.", DOWN, ON, sides(), OFF, UP),
        ("G0 Z2.", "X11.5 Y6.", "X-11.5", "Y-6.", "X11.5", "Y0", "X30."),
        # Two flats, with the way from one to the other round the outside, in offset mode and without.
        (DOWN, "G42 X11.5 Y-30. F200", "Y30.", "G0 X-30. Y30.", "X-35.", "Y30.", "G1 G40 X-40. Y30.", UP),
        (DOWN, "X11.5 Y-30. F200", "Y30.", "G0 X40.", "Y40.", "X-40.", "X-11.5 Y40.", "G1 Y-30.", "G0 X-50.", UP),
        # A lead-in and a lead-out in rapid traverse.
        (DOWN, "G0 X15. Y0", "G1 X11.5 F200", sides(), "G0 X30.", UP),
        # A line and back, with steps beside the part.
        (DOWN, "X30. Y-8. F200", "X-30.", "G0 Y0", "G1 X30.", "G0 Y8.", "G1 X-30.", UP),
    ],
    ids=range(9),
)
def test_positioning_is_sound(machine: str, blocks: tuple[str, ...]) -> None:
    assert rules(machine, *blocks) == []


@pytest.mark.ci
def test_where_the_face_is_below_z0_it_begins_there() -> None:
    program = (
        "T1\nG94 G0 X30. C0 Z5.\nG12.1\nG0 X30. C0 Z-3.\n" + sides().replace("Y", "C") + "\nX30. C0\nG0 Z5.\nG13.1\n"
    )
    stock = {"stock": {"face": -4.0}}
    for job, count in ((None, 1), (stock, 0)):
        report = report_of(program, "mitsubishi-m700", "1:radius=4", job=job)
        assert [rule for _, rule in said(report)].count(RULE) == count
