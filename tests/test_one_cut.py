"""One mistake in a contour, or one R too large for it, is one finding of what is cut, on contours of many forms."""

from __future__ import annotations

import re

import pytest
from cases import looped
from programs import report_of

from polarcheck.foundation.finding import Finding

HEAD, END = "O1/G21 G40 G97 G98 G18/T0101/", "/M30/"
#: Sound sections for R 4 mm; `/` separates blocks.
SOUND = {
    "octagon": "G0 X100. Z2. C0/G12.1/G1 Z-5. F300/G42 X50. F200/C10./X20. C25./X-20./X-50. C10./C-10./X-20. C-25./"
    "X20./X50. C-10./C0/G40 X100./Z2./G13.1",
    "rounded square": "G0 X100. Z2. C0/G12.1/G1 Z-5. F300/G42 X40. F200/C10./G3 X20. C20. R10./G1 X-20./"
    "G3 X-40. C10. R10./G1 C-10./G3 X-20. C-20. R10./G1 X20./G3 X40. C-10. R10./G1 C0/G40 X100./Z2./G13.1",
    "pocket": "G0 X10. Z2. C0/G12.1/G1 Z-5. F300/G41 X60. F200/C15./G3 X50. C20. R5./G1 X-50./G3 X-60. C15. R5./"
    "G1 C-15./G3 X-50. C-20. R5./G1 X50./G3 X60. C-15. R5./G1 C0/G40 X10./Z2./G13.1",
    "cross": "G0 X140. Z2. C0/G12.1/G1 Z-5. F300/G42 X60. F200/C10./X20./C30./X-20./C10./X-60./C-10./X-20./C-30./"
    "X20./C-10./X60./C0/G40 X140./Z2./G13.1",
    "keyway": "G0 X80. Z2. C0/G12.1/G1 Z-5. F300/G41 X60. C6. F200/X20./C-6./X60./G40 X80. C0/Z2./G13.1",
    "rooms": "G0 X40. Z2. C0/G12.1/G1 Z-5. F300/G41 X60. F200/C20./X20./C6./X-20./C20./X-60./C-20./X-20./C-6./X20./"
    "C-20./X60./C1./G40 X40. C0/Z2./G13.1",
    "three rooms": "G0 X60. Z2. C0/G12.1/G1 Z-5. F300/G41 X80. F200/C20./X40./C6./X20./C20./X-20./C6./X-40./C20./"
    "X-80./C-20./X-40./C-6./X-20./C-20./X20./C-6./X40./C-20./X80./C1./G40 X60. C0/Z2./G13.1",
    "groove": "G0 X120. Z2. C0/G12.1/G1 Z-5. F300/G42 X60. F200/C30./X10./C10./X-10./C30./X-60./C-30./X60./C0/"
    "G40 X120./Z2./G13.1",
    "flat": "G0 X100. Z2. C0/G12.1/G1 Z-5. F300/G42 X30. F200/C13.229/G3 X-40. C0 I-15. J-13.229/X30. C-13.229 I20. J0/"
    "G1 C0/G40 X100./Z2./G13.1",
}
_POINT = re.compile(r"[XC]-?[0-9.]+")


def in_inch(section: str) -> str:
    """The same section in inch."""
    words = re.compile(r"(?<![A-Z])([XZCIJRF])(-?[0-9]+[.]?[0-9]*)")
    return words.sub(lambda word: f"{word[1]}{float(word[2]) / 25.4:.5f}", section)


def with_wrong_points(section: str) -> list[str]:
    """The section with a sign or a digit of one point of the contour written otherwise, for each point."""
    blocks, found = section.split("/"), []
    for number, block in enumerate(blocks[4:], 4):
        if block.startswith(("G40", "Z", "G13")):
            continue
        for word in _POINT.finditer(block):
            value = float(word[0][1:])
            for wrong in {-value, value + 3, value - 3} - {value}:
                changed = f"{block[: word.start()]}{word[0][0]}{wrong:.3f}{block[word.end() :]}"
                found.append("/".join([*blocks[:number], changed, *blocks[number + 1 :]]))
    return found


def findings_of(section: str, radius: float = 4.0, units: str = "G21") -> list[Finding]:
    program = (HEAD.replace("G21", units) + section + END).replace("/", "\n")
    found = report_of(program, "fanuc", f"1:radius={radius}", only=["compensation", "motion"])
    return [one for one in found.findings if one.severity != "note"]


@pytest.mark.nightly
@looped("name", SOUND, one_in=20)
def test_a_wrong_point_is_one_finding_of_what_is_cut(name: str) -> None:
    assert findings_of(SOUND[name]) == []
    programs = with_wrong_points(SOUND[name])
    assert len(programs) > 6
    cutting = 0
    for program in programs:
        rules = [one.rule for one in findings_of(program)]
        cutting += "overcut" in rules
        assert rules.count("overcut") <= 1, program
        # A point that is the one before it has a block without a length as well.
        assert len(set(rules) - {"movement-missing-in-offset-mode"}) <= 1, program
        assert "side-of-compensation-mirrored" not in rules, program
    assert cutting or name not in ("rooms", "three rooms", "groove")


@pytest.mark.nightly
@looped(("radius", "room"), [(7.0, 6.0), (6.1, 6.0)])
def test_a_neck_says_for_which_r_it_has_room(radius: float, room: float) -> None:
    (found,) = findings_of(SOUND["rooms"], radius)
    assert (found.rule, found.line, found.count) == ("overcut", 11, 2)
    assert found.message.endswith(
        f"into the contour of line 17 at X-20 C-6; the contour has room for R {room:g} mm at most"
    )
    (inch,) = findings_of(in_inch(SOUND["rooms"]), radius / 25.4, "G20")
    assert inch.message.endswith("the contour has room for R 0.2362 inch at most")


def test_two_necks_are_two_findings() -> None:
    found = findings_of(SOUND["three rooms"], 7.0)
    assert [(one.rule, one.line, one.count) for one in found] == [("overcut", 11, 2), ("overcut", 15, 2)]


def test_a_contour_through_its_own_part_fits_no_cutter() -> None:
    (found,) = findings_of(SOUND["rooms"].replace("C6.", "C-6.", 1))
    assert found.message.endswith("; a smaller one does, too: look for a wrong point of the contour")


@pytest.mark.ci
def test_walls_that_are_not_parallel_have_room_for_what_is_found_by_trying() -> None:
    """Two corners 12 mm apart; the tool center goes round each farther off than R."""
    waist = SOUND["rooms"].replace("X20./C6./X-20./C20./X-60.", "X0 C6./X-60. C20.")
    waist = waist.replace("X-20./C-6./X20./C-20./X60.", "X0 C-6./X60. C-20.")
    assert findings_of(waist) == []
    (found,) = findings_of(waist, 8.0)
    room = float(re.search(r"room for R ([0-9.]+) mm", found.message)[1])  # type: ignore[index]
    assert 5 < room < 6
    assert findings_of(waist, room) == []
    assert [one.rule for one in findings_of(waist, room * 1.02)] == ["overcut"]
