"""The cutter on the wrong side: sound loops with G41 and G42 exchanged, and faults that are not to be taken for it."""

from __future__ import annotations

import re

import pytest
from cases import looped
from programs import report_of, said

from polarcheck.foundation.finding import FileReport

MIRRORED = "side-of-compensation-mirrored"

#: Sound sections for R 4 mm, each with the line of its G41 or G42; `/` separates blocks.
SOUND = {
    "square": "G0 X100. Z2. C0/G12.1/G1 Z-5. F300/G42 X40. F200/C20./X-40./C-20./X40./C0/G40 X100./Z2./G13.1",
    "hexagon": "G0 X100. Z2. C0/G12.1/G1 Z-5. F300/G42 X30. F200/C8.660/X0 C17.321/X-30. C8.660/C-8.660/X0 C-17.321/"
    "X30. C-8.660/C0/G40 X100./Z2./G13.1",
    "lead of an arc": "G0 X132. Z2. C0/G12.1/G1 C-8. F300/Z-5./G42 X40. F200/X36./G2 X20. C0 R8./G3 I-10. J0/"
    "G2 X36. C8. R8./G1 G40 X132./Z2./G13.1",
    "plunge in offset mode": "G0 X132. Z2. C0/G12.1/G1 C-8. F300/G42 X36. F200/Z-5./G2 X20. C0 R8./G3 I-10. J0/"
    "G2 X36. C8. R8./G1 Z2./G40 X132./G13.1",
    "tangent leads": "G0 X40. Z2. C0/G12.1/G1 C-60. F300/Z-5./G42 C-40. F200/C20./X-40./C-20./X60./G40 X90./Z2./G13.1",
    "pocket": "G0 X10. Z2. C0/G12.1/G1 Z-5. F300/G41 X40. F200/C20./X-40./C-20./X40./C0/G40 X10./Z2./G13.1",
    "round pocket": "G0 X10. Z2. C0/G12.1/G1 Z-5. F300/G41 X40. F200/G3 I-20. J0/G1 G40 X10./Z2./G13.1",
    "two flats": "G0 X70. Z2. C0/G12.1/G1 C-40. F300/Z-5. F300/G42 X30. F200/C40./X-30./C-40./G40 X-70./Z2./G13.1",
    "four flats": "G0 X120. Z2. C0/G12.1/G1 Z-5. F300/G42 X40. F200/C30./X30. C45./X-30./X-40. C30./C-30./X-30. C-45./"
    "X30./X40. C-30./C0/G40 X120./Z2./G13.1",
    "keyway": "G0 X90. Z2. C0/G12.1/G1 Z-5. F300/G41 X60. C6. F200/X20./C-6./X60./G40 X90. C0/Z2./G13.1",
}
#: Of a keyway nobody knows whether a rib is meant.
TOLD = [name for name in SOUND if name != "keyway"]
HEAD, END = "O1/G21 G40 G97 G98 G18/T0101/", "/M30/"
_WORD = re.compile(r"(?<![A-Z#])([XZCIJRF])(-?\d+\.?\d*|-?\.\d+)")


def in_inch(section: str) -> str:
    """The same section in inch."""
    return _WORD.sub(lambda word: f"{word[1]}{float(word[2]) / 25.4:.5f}", section)


def exchanged(section: str) -> str:
    """G41 for G42 and the reverse."""
    return re.sub("G4[12]", lambda code: {"G41": "G42", "G42": "G41"}[code[0]], section)


def report(section: str, radius: float = 4.0, units: str = "G21", machine: str = "fanuc") -> FileReport:
    program = (HEAD.replace("G21", units) + section + END).replace("/", "\n")
    return report_of(program, machine, f"1:radius={radius}")


def serious(found: FileReport) -> list[tuple[int, str]]:
    return sorted((one.line, one.rule) for one in found.findings if one.severity != "note")


@pytest.mark.nightly
@looped("section", [SOUND[name] for name in TOLD], ids=TOLD, one_in=36)
@looped("units", ["G21", "G20"])
@looped("machine", ["fanuc", "fanuc-30i"])
def test_the_other_side_is_one_finding(section: str, units: str, machine: str) -> None:
    section, radius = (section, 4.0) if units == "G21" else (in_inch(section), 4 / 25.4)
    assert serious(report(section, radius, units, machine)) == []
    wrong = exchanged(section)
    at = next(number for number, block in enumerate((HEAD + wrong).split("/"), 1) if re.search("G4[12] ", block))
    found = report(wrong, radius, units, machine)
    assert serious(found) == [(at, MIRRORED)]
    finding = next(one for one in found.findings if one.rule == MIRRORED)
    assert finding.severity == "error"
    assert finding.follows
    assert finding.block[finding.column - 1 : finding.end_column - 1] in ("G41", "G42")
    assert "; write " + ("G42" if "G42" in section else "G41") in finding.message


@pytest.mark.ci
def test_g41_in_a_block_of_its_own_is_the_word_at_fault() -> None:
    wrong = SOUND["square"].replace("G42 X40.", "G41/X40.")
    assert serious(report(wrong)) == [(7, MIRRORED)]


@pytest.mark.ci
def test_of_two_loops_the_wrong_one_is_named() -> None:
    wrong = SOUND["square"].replace("/Z2./G13.1", "/G41 X40./C20./X-40./C-20./X40./C0/G40 X100./Z2./G13.1")
    assert serious(report(wrong)) == [(14, MIRRORED)]


@pytest.mark.nightly
def test_a_negative_r_is_wrong_itself_or_the_code_is() -> None:
    found = report(SOUND["square"], -4.0)
    assert serious(found) == [(7, MIRRORED)]
    finding = next(one for one in found.findings if one.rule == MIRRORED)
    assert finding.message.startswith("G42 with the negative R -4 mm has the cutter on the wrong side")
    assert finding.message.endswith("write G41, or R 4 mm in the tool offset")
    assert serious(report(exchanged(SOUND["square"]), -4.0)) == []


@pytest.mark.ci
@looped(
    ("name", "changed", "radius"),
    [
        ("keyway", {}, 7.0),
        ("keyway", {"/G1 Z-5. F300": "/G1 C9. F300/Z-5.", "G40 X90. C0": "G40 X90. C-9."}, 7.0),
        ("pocket", {"G0 X10.": "G0 X90."}, 4.0),
        ("pocket", {"G40 X10.": "G40 X90."}, 4.0),
        ("square", {"G0 X100.": "G0 X10."}, 4.0),
        ("square", {"G40 X100.": "G40 X10."}, 4.0),
        ("square", {"/C20./": "/C20./X30./C10./X20./C20./"}, 6.0),
        ("square", {"X-40./C-20.": "X40./C-20."}, 4.0),
        ("square", {"X-40./C-20.": "X-40./C20.5"}, 4.0),
        ("two flats", {"G0 X70.": "G0 X10."}, 4.0),
        ("round pocket", {}, 21.0),
        ("lead of an arc", {"G1 G40 X132.": "G1 G40 X10. C0"}, 6.0),
    ],
    one_in=12,
)
def test_another_fault_is_not_called_mirrored(name: str, changed: dict[str, str], radius: float) -> None:
    section = SOUND[name]
    for old, new in changed.items():
        assert old in section
        section = section.replace(old, new, 1)
    for wrong in (section, in_inch(section)):
        inch = wrong is not section
        found = report(wrong, radius / 25.4 if inch else radius, "G20" if inch else "G21")
        assert MIRRORED not in [rule for _, rule in said(found)]


def test_a_slot_beside_its_walls_is_not_told() -> None:
    """Two walls of which nobody knows whether a rib is meant: the ramps are in the open."""
    slot = "G0 X90. Z2. C0/G12.1/G1 C12. F300/Z-5. F300/G41 X60. C6. F200/X-60./G40 X-90. C12./Z2./G13.1"
    for section in (slot, exchanged(slot)):
        assert MIRRORED not in [rule for _, rule in said(report(section))]


#: A square of which one side bends inward by 2 degrees: a tool center that is wrong there cuts next to nothing.
BENT = "G0 X100. Z2. C0/G12.1/G1 Z-5. F300/G42 X40. F200/C20./X0 C19.65/X-40. C20./C-20./X40./C0/G40 X100./Z2./G13.1"


@pytest.mark.nightly
@looped(("pause", "is_mirrored"), [("", True), ("M8/", True), ("M8/M9/", False), ("M8/M9/M8/", False)], one_in=4)
def test_a_loop_that_the_control_objects_to_on_the_other_side_is_not_mirrored(pause: str, is_mirrored: bool) -> None:
    """Two blocks without a way leave the corner unknown to the control, whichever side the cutter is on."""
    wrong = exchanged(BENT).replace("X-40. C20.", pause + "X-40. C20.")
    for section, units in ((wrong, "G21"), (in_inch(wrong), "G20")):
        found = report(section, 4.0 if units == "G21" else 4 / 25.4, units)
        assert (MIRRORED in [one.rule for one in found.findings]) == is_mirrored
    assert MIRRORED not in [rule for _, rule in said(report(exchanged(wrong)))]
