"""What mills touch on their way to a place, and sections that cut nothing: the bar, the part and the rules on them."""

from __future__ import annotations

import pytest
from programs import report_of

HEAD = "G21 G98 G40/T0101/G28 H0/G97 S3000 M13/G0 X60. Z2. C0/G12.1/G1 X60. F1500/Z-5."
HEXAGON = "C8.66/X0 C17.321/X-30. C8.66/C-8.66/X0 C-17.321/X30. C-8.66/C0"
END = "G40 X60. F1500/Z2./G13.1/G0 X100. Z50./M30"
CONTOUR = f"G42 X30. C0 F200/{HEXAGON}"
HOLE = "G0 X26. Z2. C0/G12.1/G1 X26. F500/Z-4. F40/G41 X34. F80/G3 I-4./G1 G40 X26."
TURNING = "T0303/G97 S1500 M3/G0 X42. Z2. G99/G1 Z0 F0.2/X-1.6/G0 X40. Z1./G1 Z-30./X44./G0 X100. Z50./M5"


def found(program: str, radius: float = 4, **job: object) -> dict[str, str]:
    """Rule and severity of the findings that count, of blocks parted by `/`."""
    blocks = f"O1\n{program.replace('/', chr(10))}\n"
    report = report_of(blocks, "fanuc-30i", f"1:radius={radius},nose=0", job=job or None)
    return {finding.rule: finding.severity for finding in report.findings if finding.severity != "note"}


def bar(diameter: float, **more: object) -> dict[str, object]:
    return {"stock": {"diameter": diameter, **more}}


def test_a_hexagon_is_sound() -> None:
    assert found(f"{HEAD}/{CONTOUR}/{END}") == {}
    assert found(f"{HEAD}/{CONTOUR}/{END}", **bar(40)) == {}


@pytest.mark.parametrize("job", [{}, bar(40), bar(60)])
def test_an_index_with_the_cutter_in_a_hole_goes_through_the_part(job: dict[str, object]) -> None:
    program = f"G21 G98 G40/T0101/G97 S3000 M13/{HOLE}/{{retract}}G13.1/G0 C120./Z50./X100./M30"
    assert found(program.format(retract="Z2./"), 2.5, **job) == {}
    assert found(program.format(retract=""), 2.5, **job) == {"rapid-through-part": "error"}
    assert found(program.format(retract="").replace("C120.", "X60."), 2.5, **job) == {
        "uncompensated-cut-into-part": "error"
    }


def test_a_rapid_plunge_needs_a_bar() -> None:
    slot = "G21 G98 G40/T0101/G97 S3000 M13/G0 X24. Z2. C0/{plunge}/G12.1/G1 X10. F200/X24./Z2. F1000/G13.1/G0 Z50./M30"
    assert found(slot.format(plunge="Z-3.")) == {}
    assert found(slot.format(plunge="Z-3."), **bar(40)) == {"rapid-plunge-into-stock": "error"}
    assert found(slot.format(plunge="G1 Z-3. F60"), **bar(40)) == {}
    turned = slot.replace("T0101", f"{TURNING}/T0101/G98", 1)
    assert found(turned.format(plunge="Z-3.")) == {"rapid-plunge-into-stock": "error"}
    assert found(turned.format(plunge="G1 Z-3. F60")) == {}
    assert found(turned.format(plunge="Z-3."), stock={"unknown": True}) == {}


def test_what_is_milled_off_is_no_longer_in_the_way() -> None:
    """The second pass of a slot is entered in rapid traverse down to the first one."""
    slot = (
        "G21 G98 G40/T0101/G97 S3000 M13/G0 X24. Z2. C0/G1 Z-3. F60/G12.1/G1 X10. F200/X24./Z2. F1000/G13.1/"
        "G0 Z{first}/G1 Z-6. F60/G12.1/G1 X10. F200/X24./Z2. F1000/G13.1/G0 Z50./M30"
    )
    assert found(slot.format(first="-2.5"), **bar(40)) == {}
    assert found(slot.format(first="-4.5"), **bar(40)) == {"rapid-plunge-into-stock": "error"}
