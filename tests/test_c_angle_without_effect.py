"""C that is positioned before a section and does not turn its plane, on controls whose plane stands still."""

from __future__ import annotations

import pytest
from programs import report_of, said

HEAD = 'G54 G90 G71 G94\nT="MILL" D1\nS2=2000 M2=3\n'
SLOT = "G0 X30 Y0\nG1 Z-2 F200\nX10\nG0 Z2\n"
HEXAGON = "G0 X30 Y0\nG1 Z-2 F200\n" + "".join(
    f"X{x} Y{y}\n" for x, y in ((10, 0), (5, 8.660), (-5, 8.660), (-10, 0), (-5, -8.660), (5, -8.660), (10, 0), (30, 0))
)


def told(*sections: tuple[str, str], machine: str = "siemens-transmit") -> list[int]:
    """Lines of the rule in a program of sections: what stands before TRANSMIT, and what it cuts."""
    program = HEAD + "".join(f"{before}\nTRANSMIT\n{cut}TRAFOOF\n" for before, cut in sections) + "M30\n"
    findings = said(report_of(program, machine, "MILL:radius=2"))
    return [line for line, rule in findings if rule == "c-angle-without-effect"]


@pytest.mark.parametrize("second", ["G0 X60 C90", "G0 X60 C=IC(60)", "SPOS=45", "G0 X60 C=DC(300)"])
def test_the_same_slot_at_another_angle_of_c(second: str) -> None:
    assert told(("G0 X60 Z2 C0", SLOT), (second, SLOT)) == [12]


def test_each_of_several_sections_is_one_finding() -> None:
    assert told(*((f"G0 X60 Z2 C{angle}", SLOT) for angle in (0, 90, 180))) == [12, 19]


@pytest.mark.parametrize(
    ("second", "cut"),
    [
        ("G0 X60 C90", "ROT RPL=90\n" + SLOT + "ROT\n"),
        ("G55 G0 X60 C90", SLOT),
        ("TRANS C90\nG0 X60 C0", SLOT),
        ("$P_PFRAME=CTRANS(C,90)\nG0 X60 C90", SLOT),
        ("L100\nG0 X60 C90", SLOT),
        ("G0 X60 C90", SLOT.replace("X10", "X12")),
        ("G0 X60 C90", SLOT.replace("Z-2", "Z-4")),
        ("G0 X60 C0", SLOT),
        ("G0 X60 C360", SLOT),
        ("G0 X60", SLOT),
        ('T="OTHER" D1\nG0 X60 C90', SLOT),
    ],
)
def test_sound_second_sections(second: str, cut: str) -> None:
    assert told(("G0 X60 Z2 C0", SLOT), (second, cut)) == []


def test_a_contour_that_is_the_same_turned_by_the_angle() -> None:
    assert told(("G0 X60 Z2 C0", HEXAGON), ("G0 X60 Z2 C60", HEXAGON)) == []
    assert told(("G0 X60 Z2 C0", HEXAGON), ("G0 X60 Z2 C45", HEXAGON)) != []
