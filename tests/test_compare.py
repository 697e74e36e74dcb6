"""`polarcheck compare`: twins of a program are the same metal, slips are found, and what is unknown is no verdict."""

from __future__ import annotations

import itertools
import json
import random
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from cases import looped
from click.testing import CliRunner, Result
from polarcheck.errors import UsageError
from programs import ROOT, job_of, machine_of
from setter_programs import drawn as program_of_setter
from single_slips import SLIPS, planted
from twin_sections import CONTROLS, Control, drawn, written

import polarcheck
from polarcheck.checking import check
from polarcheck.commands import main
from polarcheck.reports.pages.painting import plain
from polarcheck.rewrite.compare import comparison_page as page
from polarcheck.rewrite.compare import differences, order_differences
from polarcheck.rewrite.compare.comparison_report import DIFFERS, NOT_COMPARED, SAME_METAL, SAME_WORDS, Comparison
from polarcheck.rewrite.compare.revision_comparison import Revision, compared, default_tolerance
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rewrite.schemas import schema

HEXAGON = (ROOT / "sample_programs" / "hexagon.nc").read_text()
RADIUS = ("1:radius=4,nose=0", "2:radius=4,nose=0")
MACRO = """#1=0
WHILE[#1LT6]DO1
#1=#1+1
X[{radius}*2*COS[#1*60]] C[{radius}*SIN[#1*60]]
END1
"""


def revision(program: str, machine: str = "fanuc", tools: Sequence[str] = RADIUS, **job: Any) -> Revision:
    runs = check.read(program.encode(), machine_of(machine), job_of(*tools, job=job), "a.nc")
    return Revision("a.nc", machine, runs)


def comparison(old: str | Revision, new: str | Revision, tolerance: float = 0.0, **arguments: Any) -> Comparison:
    pair = [revision(each, **arguments) if isinstance(each, str) else each for each in (old, new)]
    return compared(pair[0], pair[1], Terms(tolerance or default_tolerance(*pair)))


def kinds(result: Comparison) -> set[str]:
    found = [*result.outside, *(each for section in result.sections for each in section.differences)]
    return {each.what for each in found}


def text(result: Comparison) -> str:
    return page.text(result, inch=False, paint=plain)


def changed(*pairs: tuple[str, str], program: str = HEXAGON) -> str:
    for old, new in pairs:
        assert old in program
        program = program.replace(old, new)
    return program


# ---- the same metal ----

IN_INCH = changed(
    ("G21", "G20"), ("X70. Z2.", "X2.7559 Z.0787"), ("X60.", "X2.3622"), ("F1500", "F59.055"),
    ("Z-5. F300", "Z-.1969 F11.811"),
    ("X30.", "X1.1811"), ("F200", "F7.874"), ("C17.321", "C.6819"), ("C-17.321", "C-.6819"), ("C8.660", "C.3409"),
    ("C-8.660", "C-.3409"), ("X-30.", "X-1.1811"), ("Z2.", "Z.0787"), ("X100. Z50.", "X3.937 Z1.9685"),
)  # fmt: skip


@pytest.mark.ci
@looped(
    ("new", "verdict"),
    [
        pytest.param(HEXAGON, SAME_WORDS, id="itself"),
        pytest.param(re.sub(r"(?m)^(?=[GXZTCM])", "N10 ", HEXAGON), SAME_WORDS, id="renumbered"),
        pytest.param(changed(("(HEXAGON", "(AGAIN: HEXAGON"), ("G1 X60. C0", "G1  X60.C0")), SAME_WORDS, id="comments"),
        pytest.param(changed(("C8.660", "C8.6602")), SAME_METAL, id="digits"),
        pytest.param(changed(("X-30. C8.660", "X-15. C12.9905\nX-30. C8.660")), SAME_METAL, id="split"),
        pytest.param(changed(("C-8.660\nX0", "H-17.320\nX0")), SAME_METAL, id="increments"),
        pytest.param(IN_INCH, SAME_METAL, id="inch"),
        pytest.param(changed(("Z-5. F300", "Z-2. F300\nZ-5.")), SAME_METAL, id="plunge in two steps"),
        pytest.param(changed(("G0 X100. Z50.", "G0 X80. Z26.\nX100. Z50.")), SAME_METAL, id="rapid in two steps"),
        pytest.param(changed(("G21 G98 G40", "G21 G98")), SAME_METAL, id="codes in force"),
    ], one_in=3,
)  # fmt: skip
def test_twins_are_the_same_metal(new: str, verdict: str) -> None:
    tools = RADIUS if "G20" not in new else ()
    old = revision(HEXAGON)
    result = comparison(old, revision(new) if tools else revision(new, tools=("1:radius=0.15748,nose=0",)))
    assert result.verdict == verdict, text(result)
    assert result.deviation is not None
    assert result.deviation <= result.tolerance
    assert not result.not_compared


@pytest.mark.ci
def test_macro_and_its_blocks_are_the_same_metal() -> None:
    head, tail = "O1\nG21 G98 G40\nT0101\nG0 X70. Z2. C0\nG12.1\nG1 X40. C0 F200\n", "G13.1\nM30\n"
    blocks = "".join(
        f"X{40 * x:.4f} C{20 * y:.4f}\n"
        for x, y in ((0.5, 0.8660254), (-0.5, 0.8660254), (-1, 0), (-0.5, -0.8660254), (0.5, -0.8660254), (1, 0))
    )
    assert comparison(head + MACRO.format(radius="20.") + tail, head + blocks + tail).verdict == SAME_METAL
    assert comparison(head + MACRO.format(radius="20.1") + tail, head + blocks + tail).deviation == pytest.approx(0.1)


@pytest.mark.nightly
def test_arcs_by_radius_by_center_and_in_parts_are_the_same_metal() -> None:
    program = "O1\nG21 G98 G40\nT0101\nG0 X70. Z2. C0\nG12.1\nG1 X40. C0 F200\n{}G13.1\nM30\n"
    whole = program.format("G3 X-40. C0 R20.\nG3 X40. C0 R20.\n")
    by_center = program.format("G3 X-40. C0 I-20. J0\nG3 X40. C0 I20. J0\n")
    parts = program.format("G3 X20. C17.3205 R20.\nX-20. R20.\nX-40. C0 R20.\nX0 C-20. R20.\nX40. C0 R20.\n")
    for other in (by_center, parts):
        assert comparison(whole, other).verdict == SAME_METAL
    assert comparison(whole, program.format("G2 X-40. C0 R20.\nG3 X40. C0 R20.\n")).verdict == DIFFERS
    assert comparison(whole, program.format("G3 X-40. C0 R20.1\nG3 X40. C0 R20.\n")).verdict == DIFFERS


@pytest.mark.ci
@looped("name", CONTROLS, one_in=12)
@looped("incremental", [False, True])
def test_a_section_for_another_control_is_the_same_metal(name: str, incremental: bool) -> None:
    """Those whose plane lies on the part likewise: C stands for another direction elsewhere."""
    control = Control.of(name)
    likewise = next(
        each for each in CONTROLS if (Control.of(each).turns, Control.of(each).sense) == (control.turns, control.sense)
    )
    pair = [
        revision(written(drawn(3), each, incremental=steps), each, ("1:radius=3,nose=0",), program_units="mm")
        for each, steps in ((likewise, False), (name, incremental))
    ]
    result = comparison(pair[0], pair[1])
    assert result.verdict in (SAME_METAL, SAME_WORDS), text(result)
    assert [reason.reason for reason in result.not_compared if reason.matters] == []


# ---- what differs ----


@pytest.mark.ci
@looped(
    ("new", "expected", "words"),
    [
        (changed(("Z-5.", "Z-5.5")), {"path", "depth"}, "the depth was Z-5 mm and is Z-5.5 mm"),
        (changed(("X0 C17.321", "X0 C17.821")), {"path"}, "the path differs by"),
        (changed(("F200", "F250")), {"feed"}, "F200 mm/min has become F250 mm/min along 142.636 mm"),
        (changed(("G28 H0", "G28 H0\nM8")), {"order"}, "M8 is added"),
        (changed(("M13", "M13 M8"), ("Z2.\nG13.1", "Z2.\nM9\nG13.1")), {"order"}, "M9 is added"),
        (changed(("S3000", "S3200")), {"order", "speed"}, "S was 3000 and is 3200"),
        (changed(("T0101", "T0202")), {"order", "tool"}, "T0101 has become T0202"),
        (changed(("G42", "G41")), {"path"}, "the path differs by"),
        (changed(("G13.1\n", "")), {"section"}, "the polar mode is left no more"),
        (changed(("G1 X60. C0 F1500", "G0 X60. C0")), {"feed"}, "has become rapid traverse"),
        (changed(("G98", "G99")), {"feed"}, "F200 mm/rev"),
        (changed(("Z2. C0", "Z2. C90.")), {"path", "c_angle"}, "C at the beginning of the section was 0 and is 90"),
        (changed(("X100. Z50.", "X100. Z40.")), {"path"}, "X100 C360 Z50 | X100 C360 Z40"),
        (changed(("G0 X100.", "G4 P500\nG0 X100.")), {"order"}, "G4 P500 is added"),
        (changed(("G0 X100. Z50.", "G0 X100. Z50.\nG1 Z40. F0.2")), {"path", "feed"}, "outside of sections"),
    ],
    one_in=12,
)  # fmt: skip
def test_changes_are_found(new: str, expected: set[str], words: str) -> None:
    for pair, shown in (((HEXAGON, new), words), ((new, HEXAGON), "")):
        result = comparison(*pair)
        assert result.verdict == DIFFERS
        assert expected <= kinds(result)
        assert shown in text(result)


@pytest.mark.ci
def test_order_that_stands_elsewhere_on_the_path() -> None:
    early = changed(("G42 X30. F200", "M8\nG42 X30. F200"))
    late = changed(("X0 C-17.321", "M8\nX0 C-17.321"))
    assert kinds(comparison(early, late)) == {"place"}
    assert comparison(early, changed(("G42 X30. F200", "M8 G42 X30. F200"))).verdict == SAME_METAL


def test_metal_is_compared_though_words_beside_differ() -> None:
    """The deviation is that of the corner that has moved: it stands 0.5 mm beside, and R makes it larger."""
    result = comparison(HEXAGON, changed(("X0 C17.321", "X0 C17.821")), tools=("1:radius=0,nose=0",))
    assert result.deviation == pytest.approx(0.5, abs=1e-3)
    assert result.is_exact
    assert [section.change for section in result.sections] == ["changed"]
    difference = result.sections[0].differences[0]
    assert (difference.old_line, difference.new_line, difference.new) == (14, 14, result.deviation)


SECTION = "G0 X70. Z2. C{angle}\nG12.1\nG1 X60. C0 F1500\nZ-{depth}. F300\nX40. F200\nC8.660\nX-40.\nZ2.\nG13.1\n"


def of_sections(*sections: tuple[int, int]) -> str:
    body = "".join(SECTION.format(angle=angle, depth=depth) for angle, depth in sections)
    return f"O1\nG21 G98 G40\nT0101\n{body}G0 X100. Z50.\nM30\n"


@pytest.mark.nightly
@looped(
    ("new", "changes"),
    [
        (((0, 5), (90, 6), (180, 7)), ["same"] * 3),
        (((0, 5), (180, 7)), ["same", "missing", "same"]),
        (((0, 5), (45, 9), (90, 6), (180, 7)), ["same", "same", "same", "added"]),
        (((90, 6), (0, 5), (180, 7)), ["moved", "same", "same"]),
        (((0, 5), (90, 8), (180, 7)), ["same", "changed", "same"]),
        ((), ["missing"] * 3),
    ],
    one_in=2,
)
def test_sections_are_paired_by_what_they_do(new: Sequence[tuple[int, int]], changes: list[str]) -> None:
    result = comparison(of_sections((0, 5), (90, 6), (180, 7)), of_sections(*new))
    assert sorted(section.change for section in result.sections) == sorted(changes)
    assert result.verdict == (SAME_WORDS if set(changes) == {"same"} else DIFFERS)


@pytest.mark.ci
@looped("seed", range(2), one_in=2)
def test_slips_of_setters_are_found(seed: int) -> None:
    """Each slip that makes another part, or another way to it."""
    program = program_of_setter(seed)
    tools = [f"{number}:radius={size / (25.4 if program.inch else 1)},nose=0" for number, size in program.radii.items()]
    sound = revision(program.text(), program.machine, tools)
    missed = []
    for slip in SLIPS[seed::3]:
        slipped = planted(slip, program, random.Random(seed))  # noqa: S311 - slips that can be made again
        if slipped is None or slip.is_real:
            continue
        result = comparison(sound, revision(slipped.program.text(), program.machine, tools))
        missed += [slip.name] * (result.verdict != DIFFERS)
    assert missed == []


TURNING = """O1
G21 G99 G40
T0101
G0 X50. Z2.
G83 Z-20. R2. Q5000 F0.1
G80
G0 Z3.
M98 P2 L2
M30
O2
G0 W1.
M99
"""


@pytest.mark.nightly
def test_programs_without_sections_are_compared() -> None:
    assert comparison(TURNING, changed(("X50.", "X50.000"), program=TURNING)).verdict == SAME_WORDS
    unrolled = changed(("M98 P2 L2", "G0 W1.\nW1."), ("O2\nG0 W1.\nM99\n", ""), program=TURNING)
    assert comparison(TURNING, unrolled).verdict == SAME_METAL
    for slip in (("Q5000", "Q500"), ("Z-20.", "Z-21."), ("L2", "L3"), ("X50.", "X51."), ("G99", "G98"), ("W1.", "W2.")):
        assert comparison(TURNING, changed(slip, program=TURNING)).verdict == DIFFERS, slip


@pytest.mark.ci
@looped("words", ["G13.1 M9", "G13.1 G0 Z50.", "G13.1 T0202", "G13.1 S500"])
@looped("tail", ["G0 X100. Z60.\nM30\n", "M30\n"])
def test_what_stands_beside_the_end_of_a_section_is_compared(words: str, tail: str) -> None:
    program = f"O1\nT0101\nG98 G0 X70. Z2. C0\n{SECTION.format(angle=0, depth=5)}{tail}"
    result = comparison(program, program.replace("G13.1", words))
    assert result.verdict == DIFFERS
    assert result.outside, text(result)
    assert comparison(program, program.replace("G13.1", "N5 G13.1")).verdict == SAME_WORDS


@pytest.mark.ci
def test_arcs_outside_of_sections() -> None:
    program = "O1\nG21 G99\nT0101\nG0 X50. Z2.\n{}\nM30\n"
    by_radius, by_center = program.format("G3 X60. Z-3. R5. F0.1"), program.format("G3 X60. Z-3. I0 K-5. F0.1")
    in_parts = program.format("G3 X57.0711 Z0.5355 R5. F0.1\nX60. Z-3. R5.")
    assert comparison(by_radius, by_center).verdict == SAME_METAL
    assert comparison(by_radius, in_parts).verdict == SAME_METAL
    assert comparison(by_radius, program.format("G2 X60. Z-3. R5. F0.1")).verdict == DIFFERS


@pytest.mark.ci
def test_another_origin_on_another_machine_is_no_verdict() -> None:
    program = "O1\nG21 G99\nT0101\nG54\nG0 X50. Z2.\nG1 Z-5. F0.1\nM30\n"
    old = revision(program, "fanuc-30i")
    assert comparison(old, revision(program, "haas-lathe")).verdict == SAME_METAL
    for words in ("G55", "G54\nG52 Z1.", "G54\nG10 L2 P1 Z-5."):
        assert comparison(old, revision(program.replace("G54", words), "haas-lathe")).verdict == NOT_COMPARED, words


@pytest.mark.ci
@looped(("other", "start"), [("haas-lathe", "P2000 M133"), ("takisawa", "S2000 M70"), ("okuma-osp", "SB=2000 M13")])
def test_m3_may_start_the_live_tool_where_no_code_is_named_for_it(other: str, start: str) -> None:
    """Of a Mitsubishi the profile names none: that the main spindle stands on the other lathe is no difference."""
    head = "O1\nG21\nG97 S2000 M3\nG0 X25. Z2. C0\n"
    old = revision(f"{head}G12.1\nG1 X10. C0 F200\nC5.\nX25.\nG13.1\nM30\n", "mitsubishi-m700")
    haas = "G17\nG112\nG1 X10. Y0 F200.\nY5.\nX25.\nG113\nM30\n"
    sections = {
        "haas-lathe": haas,
        "takisawa": "G12.1\nG1 X20. C0 F200\nC5.\nX50.\nG13.1\nM30\n",
        "okuma-osp": "G137 C0\nG101 X10. Y0 F200\nY5.\nX25.\nG136\nM30\n",
    }
    new = head.replace("S2000 M3", start).replace("X25.", "X50.") + sections[other]
    result = comparison(old, revision(new.replace("G21\n", "" if other == "okuma-osp" else "G21\n"), other))
    assert "spindle" not in text(result), text(result)


@pytest.mark.ci
def test_a_corner_that_the_control_makes_is_the_arc_that_it_stands_for() -> None:
    """RND=2 shows in the path, and is no order; outside of the mode, where none is made, it is one."""
    head = "G90 DIAMON G18 G71 G94\nT1 D1\nG0 X60 Z2 C0\nG1 Z-1 F100\nX60.5\nDIAMOF\nTRANSMIT\nG17\n"
    made = f"{head}G1 X20 Y0 F200\nY10 RND=2\nX-20\nY-10 CHF=1\nX20\nY0\nX28\nTRAFOOF\nDIAMON\nM30\n"
    by_hand = made.replace("Y10 RND=2\n", "Y8\nG3 X18 Y10 CR=2\nG1 ").replace("Y-10 CHF=1", "Y-9.2929\nX-19.2929 Y-10")
    revisions = [revision(text, "siemens-transmit", ()) for text in (made, by_hand, made.replace("RND=2", "RND=3"))]
    assert comparison(revisions[0], revisions[1]).verdict == SAME_METAL
    assert kinds(comparison(revisions[0], revisions[2])) == {"path"}
    outside = revision(made.replace("G1 Z-1 F100", "G1 Z-1 F100 RND=1"), "siemens-transmit", ())
    assert comparison(revisions[0], outside).verdict != SAME_METAL


# ---- what is not known ----


@pytest.mark.ci
def test_unknown_radius_is_no_verdict() -> None:
    unknown = revision(HEXAGON, tools=())
    assert comparison(revision(HEXAGON), unknown).verdict == NOT_COMPARED
    assert "R of T0101 is not known: give --tool 1:radius=..." in text(comparison(revision(HEXAGON), unknown))
    # Where it is known to neither, the same path for any R is the same metal.
    digits = revision(changed(("C8.660", "C8.6602")), tools=())
    result = comparison(unknown, digits)
    assert result.verdict == SAME_METAL
    assert [reason.matters for reason in result.not_compared] == [False]
    assert comparison(unknown, revision(changed(("G42", "G41")), tools=())).verdict == DIFFERS


@pytest.mark.ci
def test_blocks_that_are_not_executed_are_no_verdict() -> None:
    unknown = changed(("X100. Z50.", "X100. Z#5003"))
    result = comparison(unknown, changed(("X100. Z#5003", "X100.0 Z#5003"), program=unknown))
    assert result.verdict == NOT_COMPARED
    assert "not compared, because outside of sections: old: Z of line 23 is not known" in text(result)
    assert comparison(unknown, unknown).verdict == SAME_WORDS
    assert comparison(unknown, changed(("F200", "F300"), program=unknown)).verdict == DIFFERS


@pytest.mark.ci
def test_unknown_angle_and_depth() -> None:
    known = changed(("G28 H0\n", ""))
    no_angle = changed(("Z2. C0", "Z2."), program=known)
    assert comparison(known, no_angle).verdict == NOT_COMPARED
    unknown_in_both = comparison(no_angle, changed(("C8.660", "C8.6602"), program=no_angle))
    assert unknown_in_both.verdict == NOT_COMPARED
    assert "C at its beginning is not known in either" in text(unknown_in_both)


@pytest.mark.ci
def test_a_point_that_is_lost_is_a_difference() -> None:
    for old, new in (("C8.660", "C8660"), ("X30.", "X30"), ("Z-5.", "Z-5")):
        result = comparison(HEXAGON, changed((old, new)))
        assert result.verdict == DIFFERS
        assert f"{old} has become {new}: without a decimal point the new one" in text(result)
    assert comparison(changed(("C8.660", "C8660")), changed(("C8.660", "C8660"), ("F300", "F310"))).verdict == DIFFERS


@pytest.mark.ci
def test_functions_of_other_spindles_are_orders(tmp_path: Path) -> None:
    program = "G18 G90\nS2=796 M2=3\nSPOS=0\nG0 X60 Z2\nTRANSMIT\nG1 X28 Y0 F200\nZ-4\nX-28\nTRAFOOF\nM30\n"
    file, other = tmp_path / "a.mpf", tmp_path / "b.mpf"
    file.write_text(program)
    for old, new in (("S2=796", "S2=3000"), ("M2=3", "M2=4"), (" M2=3", ""), ("S2=796 M2=3\n", "")):
        other.write_text(program.replace(old, new))
        result = CliRunner().invoke(
            main, ["compare", "--machine", "siemens-transmit", "--no-config", str(file), str(other)]
        )
        assert result.exit_code == 1
        assert "differs in orders" in result.output


@pytest.mark.ci
def test_words_that_nobody_can_read_are_no_verdict() -> None:
    unreadable = changed(("X60. C0 F1500", "X6--0. C0 F1500"))
    result = comparison(unreadable, unreadable)
    assert result.verdict == NOT_COMPARED
    assert "old: a word that the control cannot read" in text(result)


@pytest.mark.ci
def test_block_skip_is_compared_in_both_states() -> None:
    skipped = changed(("Z-5. F300", "/Z-5. F300"))
    result = comparison(HEXAGON, skipped)
    assert result.verdict == DIFFERS
    assert sum(section.change == "changed" for section in result.sections) == 1


@pytest.mark.ci
def test_lists_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (differences, order_differences):
        monkeypatch.setattr(module, "_LISTED", 2)
    orders = "".join(f"M{code}\n" for code in (60, 61, 62))
    between = changed(("G28 H0", "M71\nG28 H0"), ("G97", "M72\nG97"), ("G0 X70.", "G4 P1\nG0 X70."))
    assert "and 1 other orders" in text(comparison(HEXAGON, between))
    assert "0 orders have become 3 others" in text(comparison(HEXAGON, changed(("G28 H0", f"{orders}G28 H0"))))
    assert "and 1 other changes of F" in text(
        comparison(HEXAGON, changed(("F1500\nZ-5.", "F1400\nZ-5."), ("F300", "F301"), ("F200", "F201")))
    )


# ---- in Python ----


@pytest.mark.ci
def test_in_python(tmp_path: Path) -> None:
    new = changed(("Z-5.", "Z-5.5"))
    paths = [tmp_path / "old.nc", tmp_path / "new.nc"]
    for path, program in zip(paths, (HEXAGON, new), strict=True):
        path.write_text(program)
    for result in (
        polarcheck.compare(*paths, tools={1: 4.0}),
        polarcheck.compare_text(HEXAGON, new, tools={1: 4.0}, old_machine="fanuc"),
    ):
        assert (result.verdict, result.deviation) == (DIFFERS, pytest.approx(0.5, abs=1e-4))
    assert polarcheck.compare_text(HEXAGON, new, tools={1: 4.0}, tolerance=0.6).verdict == SAME_METAL
    with pytest.raises(UsageError, match=r"compare_text\(\): tolerance: expected a length above 0 \[mm\], found nan"):
        polarcheck.compare_text(HEXAGON, new, tolerance=float("nan"))


# ---- the command ----


def run(*arguments: object, source: str | None = None) -> Result:
    return CliRunner().invoke(main, ["compare", *map(str, arguments)], input=source)


@pytest.fixture
def pair(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("polarcheck.toml").write_text("[tools.1]\nradius = 4\nnose = 0\n")
    Path("old.nc").write_text(HEXAGON)
    Path("new.nc").write_text(changed(("F200", "F250")))
    return tmp_path


@pytest.mark.nightly
def test_exit_codes(pair: Path) -> None:
    assert run("old.nc", "old.nc").exit_code == 0
    differing = run("old.nc", "new.nc")
    assert (differing.exit_code, differing.output.splitlines()[0]) == (
        1,
        "old.nc | new.nc: differs in feed; largest deviation 0.0000 mm of the path",
    )
    Path("other").mkdir()
    Path("other/new.nc").write_text(changed(("C8.660", "C8.66")))
    Path("other/polarcheck.toml").write_text('machine = "fanuc"\n')
    assert run("old.nc", "other/new.nc").exit_code == 2
    assert run("old.nc", "-", "--tolerance", "0.002", source=changed(("C8.660", "C8.66"))).exit_code == 0
    assert run("old.nc", "-", "--tolerance", "0.6", source=changed(("Z-5.", "Z-5.5"))).exit_code == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("old.nc",), "expected OLD and NEW, found 1 path"),
        (("old.nc", "."), "expected two programs or two folders"),
        (("-", "-"), "- can stand for one of the two programs only"),
        (("old.nc", "gone.nc"), "gone.nc: "),
        (("old.nc", "new.nc", "--tolerance", "0"), "expected a length above 0"),
        (("old.nc", "new.nc", "--tolerance", "nan"), "expected a length above 0"),
        (("old.nc", "new.nc", "--new-machine", "lathe"), "lathe"),
        (("--git", "old.nc", "new.nc"), "expected the 7 arguments that git gives, found 2"),
    ],
)
def test_what_cannot_be_compared_ends_with_2(pair: Path, arguments: Sequence[str], message: str) -> None:
    result = run(*arguments)
    assert result.exit_code == 2
    assert message in result.output
    assert len(result.output.splitlines()) == 1


def test_page_shows_what_is_printed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """docs/compare.md: the report of a hexagon that has become deeper and faster."""
    monkeypatch.chdir(tmp_path)
    Path("hexagon.nc").write_text(HEXAGON)
    Path("deeper.nc").write_text(changed(("Z-5. F300", "Z-5.5 F300"), ("F200", "F250")))
    lines = (ROOT / "docs" / "compare.md").read_text("utf-8").splitlines()
    begins = next(number for number, line in enumerate(lines) if line.startswith("    $ polarcheck compare "))
    shown = [*itertools.takewhile(str.strip, lines[begins + 1 :])]
    printed = run(*lines[begins].split()[3:]).stdout
    assert "".join(f"{line.removeprefix('    ')}\n" for line in shown) == printed


def test_pair_that_takes_too_long_is_named(pair: Path) -> None:
    Path("long.nc").write_text(changed(("M5", "M5\n#1=0\nWHILE[#1LT900000]DO1\n#1=#1+1\nEND1")))
    result = run("long.nc", "old.nc", "--max-statements", "1000")
    assert (result.exit_code, "not compared, because old: " in result.output) == (2, True)
    result = run("long.nc", "old.nc", "--max-seconds", "0.0001")
    assert result.exit_code == 2


def test_json_is_as_its_schema_says(pair: Path) -> None:
    result = run("old.nc", "new.nc", "--format", "json")
    report = json.loads(result.stdout)
    jsonschema.Draft202012Validator(schema("comparison")).validate(report)
    (found,) = report["files"]
    assert (found["verdict"], found["tolerance"], found["old"]["machine"]) == (DIFFERS, 0.001, "fanuc")
    (section,) = found["sections"]
    assert section["old"]["time"] > section["new"]["time"]
    (feed,) = section["differences"]
    assert (feed["what"], feed["old"], feed["new"], feed["old_line"]) == ("feed", "F200 mm/min", "F250 mm/min", 12)


@pytest.mark.ci
def test_folders_are_compared_file_by_file(pair: Path) -> None:
    for folder, names in (("a", ("1.nc", "2.nc", "3.nc")), ("b", ("2.nc", "3.nc", "4.nc"))):
        Path(folder).mkdir()
        for name in names:
            Path(folder, name).write_text(changed(("F200", "F250")) if (folder, name) == ("b", "3.nc") else HEXAGON)
    result = run("a", "b")
    assert result.exit_code == 1
    lines = [line for line in result.stdout.splitlines() if not line.startswith(" ")]
    assert [line.partition(": ")[2][:12] for line in lines] == [
        "the same but",
        "differs in f",
        "only in the ",
        "only in the ",
    ]
    shown = json.loads(run("a", "b", "--format", "json").stdout)
    assert (shown["only_old"], shown["only_new"]) == (["1.nc"], ["4.nc"])


@pytest.mark.ci
def test_a_revision_from_elsewhere_has_the_settings_of_the_other(
    pair: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    elsewhere = tmp_path_factory.mktemp("blob") / "old.nc"
    elsewhere.write_text(HEXAGON)
    assert run(elsewhere, "old.nc").exit_code == 0
    assert "R of T0101" not in run(elsewhere, "new.nc").output
    assert run(elsewhere, elsewhere, "--settings-of", "old.nc").exit_code == 0


@pytest.mark.ci
def test_names_and_words_of_strangers_are_shown_without_escapes(pair: Path) -> None:
    Path("a\x1b[2J.nc").write_text(changed(("T0101", "T0101 (\x1b[2J)")))
    for form in ("text", "json"):
        assert "\x1b" not in run("old.nc", "a\x1b[2J.nc", "--format", form).output
    assert "\x1b[1;31m" in run("old.nc", "new.nc", "--color", "always").output


GIT = ("git", "-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false")


@pytest.mark.ci
def test_git_shows_metal(pair: Path) -> None:
    """As a diff driver, as a difftool and as a textconv, as docs/compare.md says."""
    command = f'"{sys.executable}" -m polarcheck'

    def git(*arguments: str) -> str:
        done = subprocess.run([*GIT, *arguments], capture_output=True, text=True, check=True)
        return done.stdout

    git("init", "-q")
    Path(".gitattributes").write_text("*.nc diff=polarcheck\n")
    git("add", ".")
    git("commit", "-q", "-m", "a")
    Path("old.nc").write_text(changed(("F200", "F250")))
    Path("new.nc").unlink()
    driver = git("-c", f"diff.polarcheck.command={command} compare --git", "diff")
    assert "old.nc | old.nc: differs in feed" in driver
    assert "new.nc: only in the old revision" in driver
    tool = git("difftool", "-y", "--extcmd", f"{command} compare", "--", "old.nc")
    assert "F200 mm/min has become F250 mm/min" in tool
    page_of_docs = (ROOT / "docs" / "compare.md").read_text("utf-8")
    (textconv,) = re.findall(r"textconv '(.*)'", page_of_docs)
    shown = git("-c", f"diff.polarcheck.textconv={textconv.replace('polarcheck', command, 1)}", "diff", "--", "old.nc")
    assert re.search(r"(?m)^-0,line,.*,4\.0,200\.0,", shown)
    assert re.search(r"(?m)^\+0,line,.*,4\.0,250\.0,", shown)
