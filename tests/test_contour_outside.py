"""A contour that nothing has begun: on each control with C as second axis, and what is none."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said

RULE = "contour-outside-polar-mode"
CONTROLS = {
    "fagor-8055t": "G16 XC",
    "fanuc": "G12.1",
    "doosan": "G12.1",
    "mitsubishi-m700": "G12.1",
    "mazak-integrex": "G12.1",
    "lsis": "G112",
}
SQUARE = "X20. C0 F200\nC10.\nX-20.\nC-10.\nX20.\nC0\n"


def found(machine: str, contour: str, *, ends: str = "") -> list[str]:
    """The messages of the rule about a contour behind the approach."""
    program = f"O1\nT0101\nG94\nG15\nG0 X60. C0 Z2.\nG1 Z-5. F200\n{contour}G1 X60.\nG0 Z5.\n{ends}M30\n"
    report = report_of(program, machine, "1:radius=4")
    return [one.message for one in report.findings if one.rule == RULE]


@pytest.mark.ci
@looped("machine", CONTROLS, one_in=3)
@looped(
    "contour",
    [
        SQUARE,
        "G42 X20. F200\nC10.\nX10.\nC0\nG40 X60.\n",
        "G91 X-40. F200\nC10.\nX-40.\nC-20.\nX40.\nC10.\nG90\n",
        "#1=10.\nX20. F200\nC#1\nX-20.\nC-#1\n",
    ],
)
def test_it_is_one_finding_with_the_code_that_begins_the_mode(machine: str, contour: str) -> None:
    if "G91" in contour and machine in ("fanuc", "doosan", "mitsubishi-m700"):
        contour = contour.replace("G91 ", "").replace("G90\n", "").replace("X", "U").replace("C", "H")
    (message,) = found(machine, contour)
    assert message.endswith(f"write {CONTROLS[machine]} before it")


@pytest.mark.ci
@looped("machine", CONTROLS, one_in=4)
@looped(
    "contour",
    [
        # Grooves and holes in degrees, a helix, facing past the center, C in rapid traverse.
        "X20. F200\nC90.\nC180.\nC270.\n",
        "X20. F200\nC5.\nC-5.\nX24.\n",
        "X-20. F200\nC90.\nC180.\n",
        "X-1.6 F200\nG0 C5.\nX20.\nC-5.\n",
        "X20. C5. Z-6. F200\nX-20. C-5. Z-7.\n",
        "X-1.6 F200\nG0 X60.\nG1 C5.\nC-5.\n",
        "G7.1 C20.\nG41 X20. F200\nC10.\nC5.\nG40 X30.\nG7.1 C0\n",
    ],
)
def test_c_as_an_angle_is_none(machine: str, contour: str) -> None:
    assert found(machine, contour) == []


def test_where_the_code_that_ends_the_mode_stands_that_finding_says_it() -> None:
    program = f"O1\nT0101\nG98 G0 X60. C0 Z2.\nG1 Z-5. F200\n{SQUARE}X60.\nG13.1\nM30\n"
    report = report_of(program, "fanuc", "1:radius=4")
    assert [rule for _, rule in said(report)] == ["polar-never-entered"]
    assert [[one.rule for one in cause.follows] for cause in report.findings] == [[RULE]]
