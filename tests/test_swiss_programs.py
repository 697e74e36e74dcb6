"""
Programs for spindles on which Z goes into the part upward, and their twins on a FANUC with every Z the other way.

No manual prints such a program whole: shapes and numbers are our own, and each program follows the named page in what
it says of the mode. The face is at Z-0.5, turning goes to +Z, and mills retract to -Z, as the headstock of a sliding
head feeds the bar (Citizen, E32 Programming, V-1).
"""

from __future__ import annotations

import re
from typing import NamedTuple

import pytest
from cases import looped
from programs import report_of, tables_of
from test_z_into_part import TURNING, mirrored

from polarcheck.reports.made_parts.part_report import in_one_line, made_by

TOOL = "1:radius=4,nose=0"
TURN = f"G21\n{TURNING}"


def halved(text: str) -> str:
    """X as a radius."""
    return re.sub(r"X(-?[\d.]+)", lambda word: f"X{float(word[1]) / 2:.3f}", text)


class Swiss(NamedTuple):
    """A program of a machine; depth: the Z word that goes deepest. made: what `makes:` says of it."""

    machine: str
    text: str
    depth: str
    made: str

    @property
    def twin(self) -> str:
        """The same for a FANUC: X as a diameter, C as the virtual axis, every Z the other way."""
        lines, in_mode = [], False
        for line in mirrored(self.text).splitlines():
            in_mode = line.startswith("G12.1") or (in_mode and line != "G13.1")
            if self.machine == "mitsubishi-m700" or (self.machine == "citizen" and in_mode):
                line = re.sub(r"X(-?[\d.]+)", lambda word: f"X{2 * float(word[1]):.3f}", line).replace("Y", "C")
            lines.append(line.replace("G94", "G98").partition(" D0")[0])
        return "\n".join("" if line == "G17" else line for line in lines) + "\n"


PROGRAMS = {
    # Citizen: G12.1 D0 E=C, G17, X as a radius, Y and no rapid traverse in the mode, of a post for L lathes (public
    # source 56168976015). Mitsubishi M700V, p. 73: F in the mode.
    "citizen: hexagon": Swiss(
        "citizen",
        f"O1\n{TURN}T0101\nG98\nG0 X30. Z-1. C0\nG12.1 D0 E=C\nG17\nG1 X15. Y0. F1500\nZ6. F300\nG42 X7. Y0. F200\n"
        "Y4.041\nX0. Y8.083\nX-7. Y4.041\nY-4.041\nX0. Y-8.083\nX7. Y-4.041\nY0.\nG40 X15. F1500\nZ-1.\n"
        "G13.1\nG0 X60.\nM2\n",
        "Z6.",
        "hexagon, 14.000 across flats, to Z6.000",
    ),
    "citizen: square in two passes": Swiss(
        "citizen",
        f"O2\n{TURN}T0101\nG98\nG0 X36. Z-2. C0\nG12.1 D0 E=C\nG17\nG1 X18. Y0. F1500\n"
        + "".join(f"Z{z} F300\nG41 X6. Y0. F150\nY-6.\nX-6.\nY6.\nX6.\nY0.\nG40 X18. F1500\n" for z in ("2.5", "5."))
        + "Z-2.\nG13.1\nG0 X60.\nM2\n",
        "Z5.",
        "square, 12.000 across flats, to Z5.000",
    ),
    # FANUC B-62764EN/01, p. 51 and 53: G12.1, G42, lines and arcs by R, G40, G13.1, in blocks of their own.
    "fanuc: rectangle with round corners": Swiss(
        "fanuc-30i",
        f"O3\n{TURN}T0101\nG98\nG0 X34. Z-1. C0\nG12.1\nG1 X34. F1500\nZ4. F300\nG42 X12. F200\nC3.\nG3 X8. C5. R2.\n"
        "G1 X-8.\nG3 X-12. C3. R2.\nG1 C-3.\nG3 X-8. C-5. R2.\nG1 X8.\nG3 X12. C-3. R2.\nG1 C0.\nG40 X34.\nZ-1.\n"
        "G13.1\nG0 X60.\nM30\n",
        "Z4.",
        "rectangle 12.000 x 10.000, corners R2.000, to Z4.000",
    ),
    # FANUC B-62764EN/01, p. 52: the highest F of a circle near the center; a groove in the face, without compensation.
    "fanuc: groove in the face": Swiss(
        "fanuc-30i",
        f"O4\n{TURN}T0101\nG98\nG0 X10. Z-1. C0\nG12.1\nG1 X10. F500\nZ1.5 F60\nG3 X10. C0. I-5. J0. F120\n"
        "G1 Z-1. F500\nG13.1\nG0 X60.\nM30\n",
        "Z1.5",
        "circle 2.000; groove 8.000 wide, x from -9.000 to 9.000, c from -9.000 to 9.000, to Z1.500",
    ),
    # Mitsubishi M700V, p. 77: G94, a ramp along X, arcs by R, X as a radius in the mode.
    "mitsubishi: disc": Swiss(
        "mitsubishi-m700",
        f"O5\n{halved(TURN)}T0101\nG94\nG0 X20. Z-3. C0\nG12.1\nG1 X20. F1000\nZ3. F200\nG42 X6.5 F120\nG3 X-6.5 R6.5\n"
        "G3 X6.5 R6.5\nG1 G40 X20. F1000\nZ-3.\nG13.1\nG0 X30.\nM30\n",
        "Z3.",
        "circle 13.000, to Z3.000",
    ),
    # GSK 988T, G12.1: the single contour of the manual, G42 and arcs by R from the middle of a side.
    "gsk: two flats and two arcs": Swiss(
        "gsk-988",
        f"O6\n{TURN}T0101\nG98\nG0 X40. Z-1. C0\nG12.1\nG1 X40. F1000\nZ8. F200\nG42 X14. F200\nC4.\n"
        "G3 X-14. C4. R8.0623\nG1 C-4.\nG3 X14. C-4. R8.0623\nG1 C0.\nG40 X40.\nZ-1.\nG13.1\nG0 X60.\nM30\n",
        "Z8.",
        "round 16.125 with 2 flats 14.000 apart, to Z8.000",
    ),
    # Builder's guide to G12.1, order of a section: two flats at 0 and 180 deg, G41, positioning at feed.
    "builder's guide: two flats": Swiss(
        "fanuc-30i",
        f"O7\n{TURN}T0101\nG98\n"
        + "".join(
            f"G0 Z-1. C{c}\nX36.\nG12.1\nG1 X36. C14. F1500\nZ5. F300\nG41 X14. F150\nC-14.\nG40 X36. F1500\nZ-1.\n"
            "G13.1\n"
            for c in ("0", "180.")
        )
        + "G0 X60.\nM30\n",
        "Z5.",
        "flats 14.000 apart, to Z5.000",
    ),
}
#: By kind what it makes of a program: the deepest Z with the other sign, all of it above the face, without that Z.
SLIPS = {
    "sign of the depth": lambda swiss: swiss.text.replace(f"\n{swiss.depth}", f"\nZ-{swiss.depth[1:]}", 1),
    "all of it in the air": lambda swiss: re.sub(r"\nZ[\d.]+ F", "\nZ-6. F", swiss.text).replace(
        "Z-1.\nG13", "Z-8.\nG13"
    ),
    "depth is missing": lambda swiss: re.sub(r"\nZ[\d.]+ F.*", "", swiss.text),
}


def warnings_of(text: str, machine: str) -> list[tuple[str, int]]:
    report = report_of(text, machine, TOOL, job={"stock": {"diameter": 18.0}})
    return [(finding.rule, finding.line) for finding in report.findings if finding.severity != "note"]


@pytest.mark.nightly
@looped("name", list(PROGRAMS))
def test_such_programs_are_sound_and_so_are_their_twins(name: str) -> None:
    swiss = PROGRAMS[name]
    assert warnings_of(swiss.text, swiss.machine) == []
    assert warnings_of(swiss.twin, "fanuc-30i") == []


@pytest.mark.ci
@looped("name", list(PROGRAMS))
def test_what_is_made_goes_to_the_mirrored_depth(name: str) -> None:
    swiss = PROGRAMS[name]
    tables, twins = (
        tables_of(text, machine, TOOL) for text, machine in ((swiss.text, swiss.machine), (swiss.twin, "fanuc-30i"))
    )
    assert in_one_line(tables) == swiss.made
    assert in_one_line(twins) == mirrored(swiss.made)
    assert [mirrored(entry.text) for entry in made_by(tables)] == [entry.text for entry in made_by(twins)]


@pytest.mark.nightly
@looped("kind", list(SLIPS))
@looped("name", list(PROGRAMS))
def test_slips_in_them_are_those_of_their_twins(name: str, kind: str) -> None:
    slip = PROGRAMS[name]._replace(text=SLIPS[kind](PROGRAMS[name]))
    words = warnings_of(slip.text, slip.machine)
    assert {rule for rule, _ in words} == {"cut-in-air"}
    assert warnings_of(slip.twin, "fanuc-30i") == words


@pytest.mark.nightly
@looped("name", list(PROGRAMS))
def test_in_rapid_traverse_they_hit_the_bar(name: str) -> None:
    """The mill goes to the depth over the bar in rapid traverse before the mode."""
    swiss = PROGRAMS[name]
    across = "X3." if swiss.machine == "mitsubishi-m700" else "X6."
    slip = swiss._replace(text=swiss.text.replace("\nG12.1", f"\nG0 {across}\nZ{swiss.depth[1:]}\nZ-1.\nG12.1", 1))
    words = warnings_of(slip.text, swiss.machine)
    assert ("rapid-plunge-into-stock", slip.text.splitlines().index(f"G0 {across}") + 2) in words
    assert warnings_of(slip.twin, "fanuc-30i") == words
