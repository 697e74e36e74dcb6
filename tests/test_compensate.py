"""Paths of the tool center written with G41 or G42, and back: parts by construction, and what is cut by shapely."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from cases import looped
from center_paths import Line, beside, cleared, left_standing, polygon, read_section, thickest_difference, words
from click.testing import CliRunner, Result
from programs import job_of, machine_of, report_of
from setter_programs import drawn

from polarcheck.checking.settings import Settings
from polarcheck.commands import main
from polarcheck.rewrite.compensate.centering import centered
from polarcheck.rewrite.compensate.compensating import Compensating, compensated
from polarcheck.rewrite.compensate.contours import SIDES
from polarcheck.rewrite.writing.outcome import Outcome, RefusedError
from polarcheck.rewrite.writing.rewritten_program import rewritten

R = 4.0
#: Two words may each be off by half a least increment, and both ends of a line.
ROUNDING = 0.0015

HEXAGON = polygon([cmath.rect(17.320508, math.radians(60 * k - 30)) for k in range(6)])
WEDGE = polygon([21 + 14j, -3 + 11j, -12 - 10j, 15 - 9j])
POCKET = polygon([18 - 14j, 18 + 14j, -18 + 14j, -18 - 14j])
_CORNERS = [(1, 1), (-1, 1), (-1, -1), (1, -1)]


def rounded_square(half: float, radius: float) -> list[Line]:
    """A square with rounded corners, from the middle of its side at +X on."""
    contour: list[Line] = []
    at = complex(half, 0)
    for x, c in _CORNERS:
        center = complex(x, c) * (half - radius)
        first = complex(x * half, center.imag) if x == c else complex(center.real, c * half)
        last = complex(center.real, c * half) if x == c else complex(x * half, center.imag)
        contour += [Line(at, first), Line(first, last, center)]
        at = last
    return [*contour, Line(at, complex(half, 0))]


_FLAT = 12 + 1j * math.sqrt(20**2 - 12**2)
D_SHAFT = [Line(12, _FLAT), Line(_FLAT, _FLAT.conjugate(), 0j), Line(_FLAT.conjugate(), 12)]
SLOT = [Line(5 - 8j, 16 - 8j), Line(16 - 8j, 16 + 8j, 16 + 0j), Line(16 + 8j, -16 + 8j)]
SLOT += [Line(-16 + 8j, -16 - 8j, -16 + 0j), Line(-16 - 8j, 5 - 8j)]
CIRCLE = [Line(18, 18, 0j)]

#: Contours counterclockwise, and the distance of the tool center to their left.
PARTS: dict[str, tuple[list[Line], float]] = {
    "hexagon": (HEXAGON, -R),
    "wedge": (WEDGE, -R),
    "square": (rounded_square(15, 3), -R),
    "d-shaft": (D_SHAFT, -R),
    "circle": (CIRCLE, -R),
    "pocket": (POCKET, R),
    "slot": (SLOT, R),
}

#: The others take as long again.
QUICK = {("hexagon", True), ("wedge", False), ("d-shaft", True), ("circle", True), ("slot", False)}

PROGRAM = """\
%
O1 (PART)
G21 G98 G40
T0808
G28 H0
G97 S3000 M13
G0 X{x} Z2. C0
G12.1
G1 Z-5. F1500
{blocks}
G1 X{x} C0 F1500
Z2.
G13.1
G0 X150. Z50.
M30
%
"""


def program(path: Sequence[Line], x: float, by_radius: bool = False, lead: str = "") -> str:
    first = words([Line(0j, path[0].start)])
    blocks = [lead or first[0] + " F200", *words(path, by_radius)]
    return PROGRAM.format(x=f"{x:.1f}", blocks="\n".join(blocks))


def rewrite(
    text: str | bytes,
    work: Callable[..., Outcome] = compensated,
    *tools: str,
    machine: str = "fanuc-30i",
    job: dict[str, object] | None = None,
    changes: dict[str, object] | None = None,
) -> Outcome:
    work_job = job_of(*tools or (f"8:radius={R},nose=0",), job={"program_units": "mm", **(job or {})})
    settings = Settings(machine, machine_of(machine, changes), work_job, (), {})
    return rewritten("a.nc", text if isinstance(text, bytes) else text.encode(), settings, work)


def text_of(outcome: Outcome) -> str:
    return outcome.data.decode("latin-1")


# ---- the contour is that of the part ----


@pytest.mark.nightly
@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("name", "round_corners"),
    [
        pytest.param(name, is_round, marks=() if (name, is_round) in QUICK else pytest.mark.ci)
        for name in PARTS
        for is_round in (True, False)
    ],
)
def test_the_new_words_are_those_of_the_part(name: str, round_corners: bool) -> None:
    contour, distance = PARTS[name]
    path = beside(contour, distance, round_corners)
    x = 90.0 if distance < 0 else 4.0
    old = program(path, x, by_radius=round_corners)
    new = text_of(rewrite(old))
    moves, _ = read_section(new)
    assert [move.end for move in moves] == pytest.approx([line.end for line in contour], abs=ROUNDING)
    assert [move.center or 0j for move in moves] == pytest.approx([line.center or 0j for line in contour], abs=0.003)
    assert [move.ccw for move in moves if move.center] == [line.ccw for line in contour if line.center]
    assert ("G42" in new, "G41" in new) == (distance < 0, distance > 0)
    # No finding that the original does not have.
    tools = f"8:radius={R},nose=0"
    findings = [{finding.rule for finding in report_of(text, "fanuc-30i", tools).findings} for text in (old, new)]
    assert findings[1] <= findings[0]
    # Back, the path is the first one, except that the control goes round outer corners by lines.
    again = text_of(rewrite(new, centered))
    assert not {"G41", "G42"} & set(again.split())
    _, old_moves = read_section(old)
    _, new_moves = read_section(again)
    if not round_corners and name not in ("d-shaft", "wedge"):
        ends = [[move.end for move in moves if abs(move.end - move.start) > 0.01] for moves in (old_moves, new_moves)]
        assert ends[1] == pytest.approx(ends[0], abs=0.002)
    if distance < 0:
        standing = [left_standing(cleared(moves[1:-1], R)) for moves in (old_moves, new_moves)]
        assert thickest_difference(*standing) < 0.005
    else:
        assert thickest_difference(cleared(old_moves, R), cleared(new_moves, R)) < 0.005


@pytest.mark.ci
def test_leads_by_arcs_are_compensated_as_well() -> None:
    """Quarter circles lead to a square and away from it; the ramps are the lines before and behind them."""
    path = beside(rounded_square(15, 3), -R, True)
    center = 25 + 0j
    leads = [Line(25 - 6j, 19 + 0j, center, False), Line(19 + 0j, 25 + 6j, center, False)]
    new = text_of(rewrite(program([leads[0], *path, leads[1]], 90.0, lead="G1 X50. C-6. F200")))
    moves, _ = read_section(new)
    assert "G42 G1 X50. C-10. F200" in new
    assert moves[0].end == pytest.approx(15)
    assert [moves[0].center, moves[-1].center] == pytest.approx([center, center])
    assert [moves[0].start, moves[-1].end] == pytest.approx([25 - 10j, 25 + 10j])


def square(half: float, feed: int) -> list[str]:
    corners = [(x * 2 * half, c * half) for x, c in _CORNERS]
    return [f"G1 X{2 * half} C0. F{feed}", *(f"X{x} C{c}" for x, c in corners), f"X{2 * half} C0."]


@pytest.mark.nightly
def test_rough_and_finish_have_their_part_on_one_side() -> None:
    """The finishing pass takes away what the roughing pass leaves, and so says where the part is."""
    blocks = "\n".join([*square(15.0, 250), *square(14.0, 120)])
    new = text_of(rewrite(PROGRAM.format(x="90.", blocks=blocks)))
    assert (new.count("G42"), new.count("G40"), new.count("G41")) == (2, 3, 0)
    assert "G42 G1 X22." in new
    assert "G42 G1 X20. F120" in new or "G42 G1 X20. C0. F120" in new or "G42 X20." in new


@pytest.mark.ci
def test_a_subprogram_at_three_depths() -> None:
    blocks = "X60. F300\nM98 P2 L3"
    sub = "\n".join(["O2", "G1 W-2. F100", *square(19.0, 200), "X60.", "M99", ""])
    new = text_of(rewrite(PROGRAM.format(x="90.", blocks=blocks).replace("%\n", "") + sub))
    assert new.count("G42") == new.count("X30. C15.") == 1
    assert (new.count("G40 X60."), new.count("M98 P2 L3")) == (1, 1)


@pytest.mark.ci
def test_several_depths_stay_in_offset_mode() -> None:
    blocks = "\n".join([*square(19.0, 200), "Z-6. F300", *square(19.0, 200)[1:]])
    new = text_of(rewrite(PROGRAM.format(x="90.", blocks=blocks)))
    assert (new.count("G42"), new.count("G40 X90.")) == (1, 1)


@pytest.mark.ci
def test_flats_that_do_not_close() -> None:
    """Moves from farther out lead to a flat; the bar is not known."""
    blocks = "C-30. F1500\nX38. F200\nC30.\nX90. F1500"
    new = text_of(rewrite(PROGRAM.format(x="90.", blocks=blocks)))
    assert "G42 X30. F200\nC30.\nG40 X90. F1500\n" in new


# ---- the program stays as it is written ----


@pytest.mark.nightly
def test_what_else_stands_in_the_program_stays() -> None:
    """N words, CR LF, no blanks, comments, lower case, latin-1 bytes, M codes beside moves."""
    lines = [
        "%", "O1 (K\xc4SE)", "N10G21G98G40", "N20T0808", "N30G97S3000M13", "N40G0X90.Z2.C0", "N50G12.1",
        "N60G1Z-5.F1500(AT DEPTH)", "N70X38.F200M8(FIRST)", "N80C19.", "N90X-38.", "N100C-19.", "N110X38.", "N120C0.",
        "N130X90.F1500M9", "N140G13.1", "N150M30", "%", "",
    ]  # fmt: skip
    old = "\r\n".join(lines).encode("latin-1")
    new = rewrite(old).data
    changed = {
        b"N70X38.F200M8(FIRST)": b"N70G42X30.F200M8 (FIRST)", b"N80C19.": b"N80C15.", b"N90X-38.": b"N90X-30.",
        b"N100C-19.": b"N100C-15.", b"N110X38.": b"N110X30.", b"N120C0.": b"N120C0", b"N130X90.": b"N130G40X90.",
    }  # fmt: skip
    expected = old
    for before, after in changed.items():
        expected = expected.replace(before, after)
    assert new == expected
    # And back: one comment says whose path it is.
    expected = (
        old.replace(b"N120C0.", b"N120C0")
        .replace(b"M8(", b"M8 (")
        .replace(b"N50G12.1", b"(TOOL CENTER PATH OF T0808 WITH R4.)\r\nN50G12.1")
    )
    assert rewrite(new, centered).data == expected


@pytest.mark.ci
def test_inch_and_incremental_words() -> None:
    blocks = "U-3. F8.\nH.75\nU-3.\nH-1.5\nU3.\nH.75\nU3. F50."
    text = PROGRAM.format(x="4.5", blocks=blocks).replace("G21", "G20").replace("Z-5.", "Z-.2").replace("Z2.", "Z.1")
    moves, _ = read_section(text_of(rewrite(text, compensated, "8:radius=.25,nose=0", job={"program_units": "inch"})))
    corners = [0.5 + 0.5j, -0.5 + 0.5j, -0.5 - 0.5j, 0.5 - 0.5j, 0.5 + 0j]
    assert [move.end for move in moves] == pytest.approx(corners, abs=1e-4)


@pytest.mark.nightly
@pytest.mark.parametrize("seed", [2, 4, 20, 22, 49, 84, 104, 190, 194])
def test_programs_of_setters_there_and_back(seed: int) -> None:
    """Sound programs in the words of several controls; the new program is read back."""
    original = drawn(seed)
    units = {"program_units": "inch" if original.inch else "mm"}
    path = rewrite(original.text(), centered, *original.tools(), machine=original.machine, job=units)
    again = rewrite(path.data, compensated, *original.tools(), machine=original.machine, job=units)
    sides = [[text.count(code) for code in ("G41", "G42")] for text in (original.text(), text_of(again))]
    assert [count > 0 for count in sides[0]] == [count > 0 for count in sides[1]]


# ---- refused ----

SQUARE = "\n".join(square(19.0, 200))


def with_square(before: str = "", after: str = "") -> str:
    """The program of a square with one change."""
    return PROGRAM.format(x="90.", blocks=SQUARE).replace(before, after)


@pytest.mark.nightly
def test_moves_behind_the_contour_keep_their_code_and_feed() -> None:
    """G0 Z2. X90.: the modal code of the last move is said again; F alone in a block stays alone."""
    blocks = "\n".join(["G0 Z-4.", *("G1 " + block for block in SQUARE.splitlines()), "G0 Z2.", "X90."])
    assert "G40 G1 X38. C0\nG0 Z2.\nX90.\n" in text_of(rewrite(PROGRAM.format(x="90.", blocks=blocks)))
    alone = text_of(rewrite(with_square("\nX-38.0 C19.0", "\nF150\nX-38.0 C19.0")))
    assert "X30. C15.\nF150\nX-30. C15.\n" in alone
    assert "X38. C19.\nF150\nX-38. C19.\n" in text_of(rewrite(alone, centered))


@pytest.mark.ci
@looped(
    ("text", "tool", "line", "reason"),
    [
        (with_square(), "9:radius=4", 10, "R of T0808 is not known: give --tool 8:radius=..."),
        (with_square(), "8:radius=0", 10, "R of T0808 is 0 mm, which is not the radius of its cutter"),
        (with_square("T0808\n"), "8:radius=4", 9, "no tool offset is in force"),
        (with_square(SQUARE, "X38. F200\nZ-6.\nC30.\nZ-5."), "8:radius=4", 10, "choose with --side left or right"),
        (with_square("X90. Z2.", "X90. Z2. G42"), "8:radius=4", 8, "G41 or G42 is in force where the mode is switched"),
        (with_square("G12.1", "G12.1\nG12.1"), "8:radius=4", 9, "the polar mode is switched on again within"),
        (with_square("\nX-38.0 C19.0", "\nX[-38.] C19."), "8:radius=4", 12, "X[-38.] C19.: an expression or"),
        (with_square("\nX-38.0 C19.0", "\n#1=-38.\nX#1 C19."), "8:radius=4", 13, "X#1 C19.: an expression or"),
        ("O1\nG0 X60. C0\nM30\n", "8:radius=4", 0, "the program has no polar section"),
    ],
    ids=["R", "R 0", "no offset", "side", "switch", "twice", "macro", "variable", "no section"],
)
def test_refused_with_line_and_reason(text: str, tool: str, line: int, reason: str) -> None:
    with pytest.raises(RefusedError) as refused:
        rewrite(text, compensated, tool)
    first = refused.value.refusals[0]
    assert (first.line, reason in first.text) == (line, True), refused.value.refusals


@pytest.mark.nightly
def test_side_is_chosen_where_the_program_does_not_say_it() -> None:
    """Down onto the path: nothing is cleared beside it. Where arcs are too small there is no contour."""
    blocks = SQUARE.replace("G1 X38.0 C0. F200", "X38. F1500\nZ-9. F100\nC0. F200").replace("C0. F200\nX", "F200\nX")
    text = PROGRAM.format(x="38.", blocks=blocks)
    with pytest.raises(RefusedError, match="both sides of this path: choose with --side part-inside or part-outside"):
        rewrite(text)
    sides = {
        side: text_of(rewrite(text, lambda original, side=side: compensated(original, Compensating(side))))
        for side in SIDES
    }
    assert [("G41" in sides[side], "G42" in sides[side]) for side in SIDES] == [
        (True, False), (False, True), (False, True), (True, False),
    ]  # fmt: skip
    small = PROGRAM.format(x="10.", blocks="G3 X10. C0 I-5. J0 F200")
    with pytest.raises(RefusedError, match="on that side of this path is no contour: its arcs are smaller than R"):
        rewrite(small, lambda original: compensated(original, Compensating("part-inside")), "8:radius=6")


def test_a_control_without_compensation_in_the_mode() -> None:
    codes = ["G1", "G2", "G3", "G4", "G40", "G65", "G98"]
    with pytest.raises(RefusedError, match="takes no G41 in the polar mode"):
        rewrite(PROGRAM.format(x="90.", blocks=SQUARE), changes={"polar": {"allowed_codes": codes}})


def test_center_refuses_a_path_that_is_wrong_already() -> None:
    text = PROGRAM.format(x="90.", blocks="G42 X30. F200\nC9.\nG2 X34. C11. R2.\nG1 C20.\nG40 X90.")
    with pytest.raises(RefusedError, match="inside-arc-smaller-than-radius"):
        rewrite(text, centered)
    with pytest.raises(RefusedError, match="no polar section has G41 or G42"):
        rewrite(PROGRAM.format(x="90.", blocks=SQUARE), centered)
    with pytest.raises(RefusedError, match="R of T0808 is not known"):
        rewrite(PROGRAM.format(x="90.", blocks="G42 X30. F200\nC9.\nG40 X90."), centered, "9:radius=1")


#: Blocks in the place of others of SQUARE with G42, by control; and why no path of the tool center is written.
FAULTS = {
    "an arc off its circle": ("X-38. C19.", "G3 X-38. C19. I-10. J0\nG1", "arc-end-off-circle"),
    "an arc without a center": ("X-38. C19.", "G3 X-38. C19.\nG1", "arc-without-center"),
    "two signs": ("X-38. C19.", "X--38. C19.", "bad-number"),
    "a point lost": ("X-38. C19.", "X-38. C19", "C19 has no point"),
    "a groove": ("C-19.", "C3.\nX-20.\nC-3.\nX-38.\nC-19.", "interference"),
    "a short start-up": ("G42 X38. C0. F200", "X40. C0. F200\nG42 X38. C0.", "start-up-shorter-than-radius"),
    "a cycle": ("G42 X38. C0.", "G90 U0\nG42 X38. C0.", "is missing"),
    "rapid traverse": ("G42 X38. C0.", "G0 G42 X38. C0.", "rapid traverse has become F200 mm/min"),
}


@pytest.mark.ci
@looped(
    ("control", "fault"), [(control, fault) for control in ("fanuc-30i", "colchester", "takisawa") for fault in FAULTS]
)
def test_center_mends_no_fault_unseen(control: str, fault: str) -> None:
    old, new, reason = FAULTS[fault]
    blocks = "G42 X38. C0. F200\nC19.\nX-38. C19.\nC-19.\nX38.\nC0.\nG40 X90."
    sound = PROGRAM.format(x="90.", blocks=blocks)
    assert "G42" not in text_of(rewrite(sound, centered, machine=control))
    with pytest.raises(RefusedError) as refused:
        rewrite(sound.replace(old, new), centered, machine=control)
    assert any(reason in refusal.text for refusal in refused.value.refusals), refused.value.refusals


# ---- the command ----


def call(*arguments: str) -> Result:
    return CliRunner().invoke(main, ["compensate", "--no-config", *arguments], prog_name="polarcheck")


@pytest.mark.nightly
@pytest.mark.usefixtures("own_folder")
def test_the_command() -> None:
    text = PROGRAM.format(x="90.", blocks=SQUARE)
    Path("a.nc").write_text(text)
    tool = ("--tool", "8:radius=4", "--machine", "fanuc-30i")
    result = call("a.nc", *tool)
    assert result.exit_code == 0
    assert "a.nc: contours: 1\n" in result.stderr
    assert "a.nc: T0808: enter R 4.0000 in its tool offset, nose type 0 or 9\n" in result.stderr
    Path("b.nc").write_text(result.stdout)
    back = call("b.nc", "--center", *tool)
    assert "T0808 with R 4.: another R in the offset table changes nothing any more" in back.stderr
    assert read_section(back.stdout)[1] == read_section(text)[1]
    assert call("a.nc", "--diff", *tool).exit_code == 1
    assert call("a.nc").exit_code == 2
    assert "--side is for contours beside a path" in call("a.nc", "--center", "--side", "left").stderr
    assert call("a.nc", "--in-place", *tool).exit_code == 2
    assert Path("a.nc").read_text() == text


@pytest.mark.nightly
def test_long_paths() -> None:
    """25 depths of 100 chords each, as a post writes a shaft."""
    sides = polygon([cmath.rect(25, math.tau * (k + 0.5) / 99) for k in range(99)])
    turn = words([Line(60 + 0j, sides[0].start), *sides, Line(sides[0].start, 60 + 0j)])
    passes = [f"Z-{5 + depth / 10}\n" + "\n".join(turn) for depth in range(25)]
    new = text_of(rewrite(PROGRAM.format(x="120.", blocks="\n".join(passes).replace("\nG1 ", "\n"))))
    moves, _ = read_section(new)
    assert (new.count("G42"), len(moves)) == (25, 25 * 100)
    at_corners = [abs(move.end) for move in moves if abs(move.end.imag) > 1e-6]
    assert at_corners == pytest.approx([25 - R / math.cos(math.pi / 99)] * len(at_corners), abs=0.02)


@pytest.mark.nightly
def test_a_path_that_stays_that_of_the_center_is_to_be_decided() -> None:
    """Two squares close; the path between them does not, and has moves to it and away from it."""
    square = [f"G1 X{x}. C{c}." for x, c in ((36, 0), (36, 18), (-36, 18), (-36, -18), (36, -18), (36, 0))]
    open_path = ["X80. C20. F1500", "Z-3. F200", "X60. C10.", "X20. C26.", "X-20. C26.", "X-60. C10.", "X-80. C20."]
    blocks = [*square, "X80. C0", "Z2.", *open_path, "Z2.", "X80. C0", "Z-3.", *square]
    outcome = rewrite(PROGRAM.format(x="80.", blocks="\n".join(blocks)))
    assert [(decision.line, decision.text.partition(":")[0]) for decision in outcome.decisions] == [
        (20, "lines 20 to 24 stay the path of the tool center")
    ]
    assert "(DECIDE: LINES 20 TO 24 STAY" in text_of(outcome)
    assert not rewrite(PROGRAM.format(x="80.", blocks="\n".join([*square, "X80. C0", "Z2."]))).decisions
