"""What one command knows of a program, the others know, too: each fact on three controls, whose words differ."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from click.testing import CliRunner, Result
from hexagon_program import CONTROLS, CUTTER, HEX
from programs import ROOT, report_of, tables_of

from polarcheck.commands import main
from polarcheck.program.execution.listing import Listing
from polarcheck.reports.made_parts.part_report import in_one_line, made_by

SAMPLES = ROOT / "sample_programs"
#: A hexagon of 36 mm across its flats with R 4 of offset 1; a / stands for the end of a block.
PROGRAMS = {
    "fanuc-30i": HEX,
    "haas-lathe": (
        "%/O1000/G21 G98 G40/T0101/M154/G28 H0/G97 P3000 M133/G0 X60. Z2. C0/G17/G112/G1 X28. F1000./Z-4. F200./"
        "G42 X18. Y0 F150./Y10.392/X0 Y20.785/X-18. Y10.392/Y-10.392/X0 Y-20.785/X18. Y-10.392/Y0/G40 X28./Z2. F1000./"
        "G113/G0 X100. Z50./M135/M155/M30/%"
    ),
    "siemens-transmit": (
        "G90 G40 G71 DIAMON/T1 D1/G94/SETMS(2) S2=3000 M2=3/G0 X60 Z2 C0/DIAMOF/TRANSMIT/G1 X28 F1000/Z-4 F200/"
        "G42 X18 Y0 F150/Y10.392/X0 Y20.785/X-18 Y10.392/Y-10.392/X0 Y-20.785/X18 Y-10.392/Y0/G40 X28/Z2 F1000/"
        "TRAFOOF/DIAMON/G0 X100 Z50/M30"
    ),
    "okuma-osp": (
        "O1/G90 G40/G0 X300 Z100/T010101/G94 M110/G97 SB=3000 M13/G0 X60 Z2/G137 C0/G17/G101 X28 F1000/Z-4 F200/"
        "G42 X18 Y0 F150/Y10.392/X0 Y20.785/X-18 Y10.392/Y-10.392/X0 Y-20.785/X18 Y-10.392/Y0/G40 X28/Z2 F1000/"
        "G136/G0 X300 Z100/M12/M109/M2"
    ),
}
#: What rests on a variable without a value, by control: what is written, and what is in its place.
UNKNOWN = {
    "R of an arc": {
        "fanuc-30i": ("X0 C20.785/X-36. C10.392", "G3 X0 C20.785 R#500/G1 X-36. C10.392"),
        "haas-lathe": ("X0 Y20.785/X-18. Y10.392", "G3 X0 Y20.785 R#500/G1 X-18. Y10.392"),
        "siemens-transmit": ("X0 Y20.785/X-18 Y10.392", "G3 X0 Y20.785 CR=R500/G1 X-18 Y10.392"),
        "okuma-osp": ("X0 Y20.785/X-18 Y10.392", "G103 X0 Y20.785 L=VC500/G101 X-18 Y10.392"),
    },
    "center of an arc": {
        "fanuc-30i": ("X0 C20.785/X-36. C10.392", "G3 X0 C20.785 I#500 J0/G1 X-36. C10.392"),
        "haas-lathe": ("X0 Y20.785/X-18. Y10.392", "G3 X0 Y20.785 I#500 J0/G1 X-18. Y10.392"),
        "siemens-transmit": ("X0 Y20.785/X-18 Y10.392", "G3 X0 Y20.785 I=R500 J0/G1 X-18 Y10.392"),
    },
    "a code": {
        "fanuc-30i": ("F150/C10.392", "F150/G#500 X36. C0/C10.392"),
        "haas-lathe": ("F150./Y10.392", "F150./G#500 X18. Y0/Y10.392"),
    },
    "the depth": {
        "fanuc-30i": ("Z-4.", "Z-#500"),
        "haas-lathe": ("Z-4.", "Z-#500"),
        "siemens-transmit": ("Z-4", "Z=-R500"),
        "okuma-osp": ("Z-4", "Z=-VC500"),
    },
    "the tool": {
        "fanuc-30i": ("T0101", "T#500"),
        "haas-lathe": ("T0101", "T#500"),
        "siemens-transmit": ("T1 D1", "T=R500 D1"),
    },
}
#: Orders that move no axis, by control.
ORDERS = {
    "the sense of the live tool": {
        "fanuc-30i": ("M13", "M14"),
        "haas-lathe": ("M133", "M134"),
        "siemens-transmit": ("M2=3", "M2=4"),
        "okuma-osp": ("M13", "M14"),
    },
    "its speed": {
        "fanuc-30i": ("S3000", "S300"),
        "haas-lathe": ("P3000", "P300"),
        "siemens-transmit": ("S2=3000", "S2=300"),
        "okuma-osp": ("SB=3000", "SB=300"),
    },
    "no speed": {
        "fanuc-30i": ("S3000 M13", "M13"),
        "haas-lathe": ("P3000 M133", "M133"),
        "siemens-transmit": ("S2=3000 M2=3", "M2=3"),
        "okuma-osp": ("SB=3000 M13", "M13"),
    },
    "no live tool": {
        "fanuc-30i": ("S3000 M13", "S3000"),
        "haas-lathe": ("P3000 M133", ""),
        "siemens-transmit": ("S2=3000 M2=3", ""),
        "okuma-osp": ("SB=3000 M13", "SB=3000"),
    },
    "no reference of C": {"fanuc-30i": ("G28 H0/", ""), "haas-lathe": ("G28 H0/", "")},
    "the mode again": {
        "fanuc-30i": ("G12.1", "G12.1/G12.1"),
        "haas-lathe": ("G112", "G112/G112"),
        "okuma-osp": ("G137 C0", "G137 C0/G137 C0"),
    },
    "a feed below 0": {
        control: ("F150", "F=-150" if control.startswith("siemens") else "F-150") for control in PROGRAMS
    },
    "coolant": {
        control: ("G94" if "94" in text else "G98", ("G94" if "94" in text else "G98") + " M8")
        for control, text in PROGRAMS.items()
    },
}
#: A word of C that no control needs: with G28 it goes, too.
C_OF_ENTRY = {
    "fanuc-30i": (("G28 H0/", ""), ("Z2. C0", "Z2.")),
    "haas-lathe": (("G28 H0/", ""), ("Z2. C0", "Z2.")),
    "gsk-988": (("G28 H0/", ""), ("Z2. C0", "Z2.")),
}
#: A square with round corners in the place of the hexagon.
SQUARE = "C12./G3 X24. C18. R6./G1 X-24./G3 X-36. C12. R6./G1 C-12./G3 X-24. C-18. R6./G1 X24./G3 X36. C-12. R6./G1 C0"
MANIFEST = """title = "Post"
features = ["contour"]
[tools.1]
radius = 4.0
[controls.lathe]
machine = "{control}"
[[case]]
feature = "contour"
control = "lathe"
program = "a.nc"
golden = "a.jsonl"
verdict = "{verdict}"
"""
#: A point lost, or a number of least increments where others have a point.
POINTS = {
    "a corner": ("20.785", "20785"),
    "depth in a block of its own": ("Z2. C0/", "Z2. C0/G1 Z-15 F400/"),
    "approach": ("Z2. C0", "Z2 C0"),
    "retract": ("X100. Z50.", "X100. Z50"),
}


def program(control: str, *changes: tuple[str, str]) -> str:
    text = PROGRAMS.get(control, HEX)
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text.replace("/", "\n") + "\n"


def pairs(table: dict[str, dict[str, tuple[str, str]]]) -> Sequence[tuple[str, str]]:
    return [(control, name) for name, changes in table.items() for control in changes]


def run(*arguments: str | Path) -> Result:
    result = CliRunner().invoke(main, [str(argument) for argument in arguments])
    assert result.exit_code in (0, 1, 2), result.exception
    return result


def written(folder: Path, *texts: str) -> list[Path]:
    files = [folder / f"{number}.nc" for number in range(len(texts))]
    for file, text in zip(files, texts, strict=True):
        file.write_text(text, "utf-8")
    return files


def compared(folder: Path, control: str, old: str, new: str) -> Result:
    return run("compare", "--machine", control, "--no-config", "--tool", CUTTER, *written(folder, old, new))


def certified(folder: Path, control: str, golden: str, text: str, verdict: str = "pass") -> Result:
    """What certify says of a program with the verdict that it must have, against the golden trace of another one."""
    manifest, trace = folder / "post.toml", folder / "a.jsonl"
    trace.unlink(missing_ok=True)
    for of_case, of_program, options in (("pass", golden, ["--update"]), (verdict, text, [])):
        manifest.write_text(MANIFEST.format(control=control, verdict=of_case), "utf-8")
        (folder / "a.nc").write_text(of_program, "utf-8")
        result = run("certify", manifest, *options)
        assert trace.exists()
    return result


@pytest.mark.nightly
@looped("control", PROGRAMS)
def test_the_program_is_sound_and_like_itself(control: str, tmp_path: Path) -> None:
    text = program(control)
    report = report_of(text, control, CUTTER)
    assert (report.verdict, report.findings) == ("pass", [])
    assert in_one_line(tables_of(text, control, CUTTER)) == "hexagon, 36.000 across flats, to Z-4.000"
    assert compared(tmp_path, control, text, text).exit_code == 0
    assert certified(tmp_path, control, text, text).exit_code == 0


@pytest.mark.nightly
@looped(("control", "name"), pairs(UNKNOWN), one_in=11)
def test_a_value_that_is_not_known_is_known_to_no_command(control: str, name: str, tmp_path: Path) -> None:
    sound, text = program(control), program(control, UNKNOWN[name][control])
    report = report_of(text, control, CUTTER)
    assert (report.verdict, [finding.rule for finding in report.findings]) == ("unverified", [])
    if name != "the tool":
        (shape, *_) = made_by(tables_of(text, control, CUTTER))
        assert "not known" in f"{shape.text} {shape.needs}"
    for old in (text.replace("500", "501"), sound):
        result = compared(tmp_path, control, old, text)
        assert result.exit_code > 0
        assert "not compared, because" in result.stdout
        assert "nan" not in result.stdout
    assert certified(tmp_path, control, sound, text, verdict="unverified").exit_code == 1
    (file,) = written(tmp_path, text)
    options = ["--no-config", "--tool", CUTTER]
    target = next(other for other in PROGRAMS if other != control)
    for command in (
        ["unroll", "--machine", control],
        ["compensate", "--center", "--machine", control],
        ["convert", "--from", control, "--to", target],
    ):
        result = run(*command, *options, file)
        assert (result.exit_code, result.stdout) == (2, ""), command


@pytest.mark.nightly
@looped(("control", "name"), pairs(ORDERS), one_in=11)
def test_another_order_is_another_program(control: str, name: str, tmp_path: Path) -> None:
    sound, text = program(control), program(control, ORDERS[name][control])
    assert compared(tmp_path, control, sound, text).exit_code == 1
    assert certified(tmp_path, control, sound, text).exit_code == 1


@pytest.mark.ci
@looped(
    ("word", "text"), [("M13", "M#500 has become"), ("F150", "F not known has become F150 mm/min"), ("M30", "M#500")]
)
def test_a_difference_shows_what_is_not_known_as_it_is_written(word: str, text: str, tmp_path: Path) -> None:
    unknown = program("fanuc-30i", (word, f"{word[0]}#500"))
    result = compared(tmp_path, "fanuc-30i", unknown, program("fanuc-30i"))
    assert text in result.stdout
    assert "nan" not in result.stdout


#: What a reader takes as meant, and a control does not.
MISREAD = {
    "a dash of print": ("-20.785", "\u201320.785"),
    "a letter": ("20.785", "2O.785"),
    "a comma": ("20.785", "20,785"),
    "a stray character": ("20.785", "20.785 ?"),
}


@pytest.mark.nightly
@looped(("control", "name"), [*itertools.product(("fanuc-30i", "haas-lathe", "siemens-transmit"), MISREAD)], one_in=5)
def test_what_a_control_cannot_read_is_not_compared(control: str, name: str, tmp_path: Path) -> None:
    sound, text = program(control), program(control, MISREAD[name])
    assert report_of(text, control, CUTTER).verdict == "fail"
    result = compared(tmp_path, control, sound, text)
    assert (result.exit_code, "characters that the control cannot read" in result.stdout) == (2, True)


#: What shifts, turns or rounds the path by a value that is not known, or starts a spindle by one; and where it stands.
UNKNOWN_STATES = {
    "TRANS Z=R500": "G1 X28",
    "ATRANS Z=R500": "G1 X28",
    "TRANS X=R500": "G42",
    "TRANS X5 Y=R500": "G42",
    "ROT RPL=R500": "G42",
    "RNDM=R500": "TRANSMIT",
    "SETMS(R500)": "G0 X60",
    "M2=R500": "G0 X60",
}


@pytest.mark.nightly
@looped("words", UNKNOWN_STATES)
def test_a_state_that_is_not_known_is_known_to_no_command(words: str, tmp_path: Path) -> None:
    control, place = "siemens-transmit", UNKNOWN_STATES[words]
    text = program(control, (place, f"{words}/{place}"))
    report = report_of(text, control, CUTTER)
    assert (report.verdict, [finding.rule for finding in report.findings]) == ("unverified", [])
    if "Z=" in words:
        assert "Z not known" in in_one_line(tables_of(text, control, CUTTER))
    for old in (text.replace("500", "501"), program(control)):
        assert compared(tmp_path, control, old, text).exit_code > 0
    assert certified(tmp_path, control, program(control), text, verdict="unverified").exit_code == 1


#: What changes no move that is followed, and is no sound program any more; and the rule that says so.
ERRORS = {
    "fanuc-30i": {
        "/G42 X36.": ("/G18/G42 X36.", "plane-selected-in-polar"),
        "/Z-4.": ("/M98 P9/Z-4.", "subprogram-missing"),
        "/G12.1": ("/G12.1 F1000", "polar-switch-not-alone"),
        "/M5": ("/#1=LN[0]/M5", "arithmetic-error"),
        "/M30": ("/GOTO7/M30", "jump-target-missing"),
    },
    "haas-lathe": {
        "/M155": ("/M98 P9/M155", "subprogram-missing"),
        "/M135": ("/#1=SQRT[-1]/M135", "arithmetic-error"),
    },
    "siemens-transmit": {
        "/M30": ("/L9/M30", "subprogram-missing"),
    },
    "okuma-osp": {"/M12": ("/CALL O9/M12", "subprogram-missing")},
}


@pytest.mark.nightly
@looped(("control", "words"), [(control, words) for control, changes in ERRORS.items() for words in changes])
def test_what_a_check_finds_in_one_of_two_programs_is_not_the_same_metal(
    control: str, words: str, tmp_path: Path
) -> None:
    new, rule = ERRORS[control][words]
    sound, text = program(control), program(control, (words, new))
    assert rule in [finding.rule for finding in report_of(text, control, CUTTER).findings]
    result = compared(tmp_path, control, sound, text)
    # The call of a missing program is an order that one of both lacks, where positions behind it do not count.
    is_order = rule == "subprogram-missing" and rule not in result.stdout
    assert result.exit_code == (1 if is_order else 2), result.stdout
    assert ("is added" if is_order else rule) in result.stdout


@pytest.mark.ci
@looped(
    ("old", "new", "code"),
    [
        ("G64 ADIS=0.1", "G64 ADIS=5", 1),
        ("G64 ADIS=R1", "G64 ADIS=R2", 1),
        ("SOFT", "BRISK", 1),
        ("LIMS=500", "", 1),
        ("SOFT ; BRISK", "SOFT", 0),
        ('MSG("SOFT")', "STOPRE", 0),
    ],
)
def test_what_changes_speeds_and_corners_unseen_is_not_the_same_metal(
    old: str, new: str, code: int, tmp_path: Path
) -> None:
    texts = [program("siemens-transmit", ("/G42", f"/{words}/G42" if words else "/G42")) for words in (old, new)]
    assert compared(tmp_path, "siemens-transmit", *texts).exit_code == code
    assert certified(tmp_path, "siemens-transmit", *texts).exit_code == code


@pytest.mark.ci
@looped(
    ("old", "new"),
    [
        *(("VZOFZ=5", "VZOFZ=6"), ("VZOFZ=5", ""), ("VTOFZ[1]=VC1", "VTOFZ[1]=VC2"), ("G20 HP=1", "G20 HP=2")),
        *(("VLMON[1]=5", "VLMON[1]=6"), ("VXYZ=5", ""), ("N5 VZOFZ=5", "N7 VZOFZ = 5")),
    ],
)
def test_what_is_no_word_of_the_path_is_compared(old: str, new: str, tmp_path: Path) -> None:
    texts = [program("okuma-osp", ("/G0 X60", f"/{words}/G0 X60" if words else "/G0 X60")) for words in (old, new)]
    assert [report_of(text, "okuma-osp", CUTTER).verdict for text in texts] == ["pass", "pass"]
    code = int(not new.startswith("N7"))
    assert compared(tmp_path, "okuma-osp", *texts).exit_code == code
    assert certified(tmp_path, "okuma-osp", *texts).exit_code == code


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "siemens-transmit", "gsk-988"])
def test_the_plane_at_the_beginning_of_a_section_is_that_of_the_golden_trace(control: str, tmp_path: Path) -> None:
    sound, text = program(control), program(control, ("/G0 X60", "/G18/G0 X60"))
    code = int(control != "haas-lathe")  # G17 stands before its G112
    assert compared(tmp_path, control, sound, text).exit_code == code
    assert certified(tmp_path, control, sound, text).exit_code == code


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "okuma-osp", "gsk-988"])
def test_what_leaves_the_mode_in_another_program_is_not_judged(control: str, tmp_path: Path) -> None:
    end = "RTS" if control == "okuma-osp" else "M99"
    place = "/Z2 F1000/" if control == "okuma-osp" else "/Z2. F1000./" if "haas" in control else "/Z2. F1000/"
    text = program(control, (place, f"{place}{end}/")).partition(f"\n{end}\n")[0] + f"\n{end}\n"
    report = report_of(text, control, CUTTER)
    assert (report.verdict, [finding.rule for finding in report.findings]) == ("unverified", [])
    reasons = [gap.reason for gap in report.not_evaluated if gap.matters]
    assert any(f"{end} in line" in reason and "leaves the polar mode on" in reason for reason in reasons)
    (file,) = written(tmp_path, text)
    result = run("compensate", "--center", "--machine", control, "--no-config", "--tool", CUTTER, file)
    assert (result.exit_code, result.stdout) == (2, "")


@pytest.mark.ci
@looped("words", ["G10 P1 R#500", "G10 P1 R5.", "#2001=5."])
def test_an_offset_that_is_set_in_the_mode_is_no_path_of_the_tool_center(words: str, tmp_path: Path) -> None:
    text = program("fanuc-30i", ("/G42", f"/{words}/G42"))
    assert report_of(text, "fanuc-30i", CUTTER).verdict == "fail"
    (file,) = written(tmp_path, text)
    result = run("compensate", "--center", "--machine", "fanuc-30i", "--no-config", "--tool", CUTTER, file)
    assert (result.exit_code, result.stdout) == (2, "")


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "siemens-transmit", "okuma-osp"])
def test_a_warning_in_one_program_alone_is_not_the_same_metal(control: str, tmp_path: Path) -> None:
    sound = program(control)
    twice = sound.replace("F150", "F150. F150." if control == "haas-lathe" else "F150 F150").replace("..", ".")
    assert [finding.rule for finding in report_of(twice, control, CUTTER).findings] == ["word-repeated"]
    result = compared(tmp_path, control, sound, twice)
    assert (result.exit_code, "a check finds word-repeated" in result.stdout) == (2, True)
    # With another comment it may be what that says.
    comment = "; TEXT" if control == "siemens-transmit" else "(TEXT)"
    result = compared(tmp_path, control, sound, twice.replace("\nG0 X60", f"\n{comment}\nG0 X60"))
    assert (result.exit_code, "a check finds word-repeated" in result.stdout) == (0, True)


@pytest.mark.ci
@looped(("words", "verdict"), [("VC[VC500]=5", "unverified"), ("VC[2]=5", "pass"), ("VC[1+1]=VC500", "unverified")])
def test_a_variable_by_its_index_is_the_variable(words: str, verdict: str) -> None:
    text = program("okuma-osp", ("O1", f"O1/VC2=4/{words}"), ("Z-4", "Z=-VC2"))
    assert report_of(text, "okuma-osp", CUTTER).verdict == verdict
    depth = "Z-5.000" if verdict == "pass" else "Z not known"
    assert depth in in_one_line(tables_of(text, "okuma-osp", CUTTER))


@pytest.mark.nightly
@looped(
    ("control", "place", "words"),
    [
        *itertools.product(("fanuc-30i", "haas-lathe"), ("G42", "G0 X60."), ("#[#500]=5.", "M99 P#500")),
        ("doosan", "G42", "#[#500]=5."),
        ("mazak-eia", "G42", "M99 P#500"),
    ],
)
def test_a_variable_or_a_block_that_nobody_knows_leaves_all_unknown(
    control: str, place: str, words: str, tmp_path: Path
) -> None:
    engage = [("G28 H0", "M200/G28 H0" if "mazak" in control else "M35/G28 H0")] * (control in ("doosan", "mazak-eia"))
    text = program(control, *engage, (place, f"{words}/{place}"))
    report = report_of(text, control, CUTTER)
    assert (report.verdict, [finding.rule for finding in report.findings]) == ("unverified", [])
    for old in (text.replace("500", "501"), program(control, *engage)):
        assert compared(tmp_path, control, old, text).exit_code > 0


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "siemens-transmit"])
def test_a_move_before_the_first_code_of_motion_is_a_move(control: str, tmp_path: Path) -> None:
    place = "/T1 D1" if control == "siemens-transmit" else "/T0101"
    sound, text = program(control), program(control, (place, f"/X70.{place}"))
    assert compared(tmp_path, control, sound, text).exit_code == 1
    assert certified(tmp_path, control, sound, text).exit_code == 1


#: Moves of Z alone, and others in rapid traverse; and those that are the same.
OF_Z = {
    "fanuc-30i": ("/Z2. F1000", "/Z-7. F1000", "/Z2. F1500", "/Z0. F1000/Z2."),
    "haas-lathe": ("/Z2. F1000.", "/Z-7. F1000.", "/G0 Z2.", "/Z0. F1000./Z2."),
    "siemens-transmit": ("/Z2 F1000", "/Z-7 F1000", "/Z2 F1500", "/Z0 F1000/Z2"),
    "okuma-osp": ("/Z2 F1000", "/Z-7 F1000", "/Z2 F1500", "/Z0 F1000/Z2"),
}


@pytest.mark.nightly
@looped("control", OF_Z, one_in=4)
def test_moves_of_z_alone_are_those_of_the_path(control: str, tmp_path: Path) -> None:
    sound, (old, deeper, other_feed, divided) = program(control), OF_Z[control]
    for new, code in ((deeper, 1), (other_feed, 1), (divided, 0)):
        text = program(control, (old, new))
        assert compared(tmp_path, control, sound, text).exit_code == code
        assert certified(tmp_path, control, sound, text).exit_code == code


@pytest.mark.nightly
@looped("control", ["fanuc-30i", "fanuc-16i", "doosan"])
def test_a_feed_of_an_unknown_unit_is_not_that_of_a_known_one(control: str, tmp_path: Path) -> None:
    engage = [("G28 H0", "M35/G28 H0")] * (control == "doosan")
    sound, text = program(control, *engage), program(control, *engage, ("G98 ", ""))
    assert [finding.rule for finding in report_of(text, control, CUTTER).findings] == ["feed-mode-unknown"]
    result = compared(tmp_path, control, sound, text)
    assert (result.exit_code, "no code says whether F is per minute" in result.stdout) == (2, True)


@pytest.mark.nightly
@looped("control", C_OF_ENTRY)
def test_the_same_metal_at_an_unknown_angle_is_not_compared(control: str, tmp_path: Path) -> None:
    text = program(control, *C_OF_ENTRY[control])
    result = compared(tmp_path, control, text, text.replace("\nM30", "\n#1=1\nM30"))
    assert result.exit_code == 2
    assert "C at its beginning is not known in either" in result.stdout
    rules = [finding.rule for finding in report_of(text, control, CUTTER).findings]
    assert "c-angle-unknown-at-entry" in rules


@pytest.mark.nightly
@looped(("control", "name"), [*itertools.product(("fanuc-30i", "doosan", "mazak-eia"), POINTS)])
def test_a_lost_point_is_seen_by_all(control: str, name: str, tmp_path: Path) -> None:
    engage = [("G28 H0", "M200/G28 H0" if "mazak" in control else "M35/G28 H0")] * (control != "fanuc-30i")
    sound, text = program(control, *engage), program(control, *engage, POINTS[name])
    rules = [finding.rule for finding in report_of(text, control, CUTTER).findings if finding.severity != "note"]
    assert "number-without-point" in rules
    assert compared(tmp_path, control, sound, text).exit_code == 1


@pytest.mark.nightly
@looped("control", CONTROLS)
def test_what_follows_from_what_is_silenced_is_silenced(control: str) -> None:
    low, high = HEX.index("C10.392"), HEX.index("/G40 X")
    silenced = f"G0 {SQUARE.replace('/', ' (POLARCHECK ALLOW RAPID-IN-POLAR TRIED)/', 1)}"
    for contour in (SQUARE, silenced):
        report = report_of((HEX[:low] + contour + HEX[high:]).replace("/", "\n") + "\n", control, CUTTER)
        assert (report.verdict, [finding.rule for finding in report.findings]) == ("pass", [])
    assert [finding.rule for finding in report.silenced] == ["rapid-in-polar"]


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "gsk-988", "okuma-osp"])
def test_the_order_of_words_in_a_block_is_no_difference(control: str, tmp_path: Path) -> None:
    text = program(control)
    start = {"haas-lathe": "G97 P3000 M133", "okuma-osp": "G97 SB=3000 M13"}.get(control, "G97 S3000 M13")
    turned = text.replace(start, " ".join(reversed(start.split()))).replace("G28 H0", "H0 G28")
    assert turned != text
    assert compared(tmp_path, control, text, turned).exit_code == 0
    assert certified(tmp_path, control, text, turned).exit_code == 0
    # Of two codes of a group the last one counts.
    texts = [program(control, (start, f"{codes}{start.removeprefix('G97')}")) for codes in ("G97 G96", "G96 G97")]
    assert compared(tmp_path, control, *texts).exit_code > 0


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "siemens-transmit", "okuma-osp"])
def test_the_feed_of_a_first_move_is_compared(control: str, tmp_path: Path) -> None:
    dot = "." if control == "haas-lathe" else ""
    texts = [program(control, ("/G0 X60", f"/G1 Z5. F{feed}{dot}/G0 X60")) for feed in (10, 20)]
    if control == "okuma-osp":
        texts = [text.replace("G0 X300 Z100\n", "", 1) for text in texts]
    assert compared(tmp_path, control, *texts).exit_code == 1
    assert certified(tmp_path, control, *texts).exit_code == 1


@looped(("control", "call"), [("fanuc-30i", "M98 P#500"), ("haas-lathe", "M97 P#500"), ("mazak-eia", "M98 P#500")])
def test_a_program_that_nobody_knows_is_rewritten_by_no_command(control: str, call: str, tmp_path: Path) -> None:
    engage = [("G28 H0", "M200/G28 H0")] * (control == "mazak-eia")
    (file,) = written(tmp_path, program(control, *engage, ("/G0 X60", f"/{call}/G0 X60")))
    target = "haas-lathe" if control != "haas-lathe" else "fanuc-30i"
    options = ["--no-config", "--tool", CUTTER]
    for command in (
        ["unroll", "--machine", control],
        ["compensate", "--center", "--machine", control],
        ["convert", "--from", control, "--to", target],
    ):
        result = run(*command, *options, file)
        assert (result.exit_code, result.stdout) == (2, ""), command


@pytest.mark.ci
@looped(
    ("control", "unused", "used"),
    [
        ("fanuc-30i", "F#500", "F150"),
        ("haas-lathe", "F#500", "F150."),
        ("siemens-transmit", "F=R500", "F150"),
        ("okuma-osp", "F=VC500", "F150"),
    ],
)
def test_a_feed_that_no_move_runs_at_is_without_weight(control: str, unused: str, used: str) -> None:
    text = program(control, ("/G42", f"/{unused}/G42"))
    assert report_of(text, control, CUTTER).verdict == "pass"
    assert report_of(text.replace(f" {used}\n", "\n"), control, CUTTER).verdict == "unverified"


@pytest.mark.ci
@looped(
    ("control", "place", "known", "unknown"),
    [
        ("fanuc-30i", "/G42", "M98 P2000 L1", "M98 P2000 L#500"),
        ("haas-lathe", "/G42", "M98 P2000 L1", "M98 P2000 L#500"),
        ("siemens-transmit", "/G0 X60", "POS[C]=0", "POS[C]=R500"),
        ("okuma-osp", "/G0 X60", "G0 Z2", "G0 Z=VC500"),
        ("gsk-988", "/G0 X60", "G0 Z2.", "G0 Z#500"),
    ],
)
def test_a_value_that_is_not_known_is_in_no_golden_trace(
    control: str, place: str, known: str, unknown: str, tmp_path: Path
) -> None:
    end = "O2000\nX28. F1000.\nM99\n" if control == "haas-lathe" else "O2000\nX56. F1000.\nM99\n"
    sound, text = (program(control, (place, f"/{words}{place}")) for words in (known, unknown))
    if "M98" in known:
        sound, text = (other.removesuffix("%\n") + end for other in (sound, text))
    verdict = report_of(text, control, CUTTER).verdict
    assert compared(tmp_path, control, sound, text).exit_code > 0
    assert certified(tmp_path, control, sound, text, verdict=verdict).exit_code == 1


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "gsk-988"])
def test_the_center_of_an_arc_outside_of_sections_is_compared(control: str, tmp_path: Path) -> None:
    dot = "." * (control == "haas-lathe")
    turned = f"/G0 X60. Z5./G1 X50. F100{dot}/G2 X60. Z0. R10./G0 X60."
    sound, text = (program(control, ("/G0 X60.", words)) for words in (turned, turned.replace("R10.", "R11.")))
    assert compared(tmp_path, control, sound, text).exit_code == 1
    assert certified(tmp_path, control, sound, text).exit_code == 1


@pytest.mark.ci
@looped(("control", "call"), [("fanuc-30i", "M98 P2000"), ("haas-lathe", "M98 P2000"), ("siemens-transmit", "L2000")])
def test_two_programs_that_are_both_missing_are_not_the_same(control: str, call: str, tmp_path: Path) -> None:
    sound, text = (program(control, ("/G0 X60", f"/{words}/G0 X60")) for words in (call, call.replace("2000", "2001")))
    assert compared(tmp_path, control, sound, text).exit_code > 0
    assert compared(tmp_path, control, sound, sound.replace("Z-4", "Z-04")).exit_code == 0


@pytest.mark.ci
@looped("words", ["$TC_DP6[1,1]=5", "DISC=50", "$P_UIFR[1,X,TR]=1"])
def test_what_may_move_the_path_and_is_not_simulated_is_not_unrolled(words: str, tmp_path: Path) -> None:
    control = "siemens-transmit"
    text = program(control, ("/G0 X60", f"/{words}/G0 X60"))
    assert report_of(text, control, CUTTER).verdict == "unverified"
    (file,) = written(tmp_path, text)
    result = run("unroll", "--machine", control, "--no-config", "--tool", CUTTER, file)
    assert (result.exit_code, result.stdout) == (2, "")


@pytest.mark.ci
@looped(
    ("control", "words"),
    [
        ("fanuc-30i", "IF[#500GT0]GOTO9/G1 Z-5./N9"),
        ("haas-lathe", "WHILE[#100LT#500]DO1/#100=#100+1./G1 W-1. F100./END1"),
        ("siemens-transmit", "IF R500>0/G1 Z-5/ENDIF"),
        ("okuma-osp", "IF [VC500 GT 0] N5/G101 Z-5/N5"),
    ],
)
def test_a_part_that_depends_on_an_unknown_condition_is_not_known(control: str, words: str) -> None:
    text = program(control, ("/G42", f"/{words}/G42"))
    assert report_of(text, control, CUTTER).verdict == "unverified"
    (shape, *_) = made_by(tables_of(text, control, CUTTER))
    assert "the condition of line" in f"{shape.needs}"
    assert not in_one_line(tables_of(text, control, CUTTER))
    # Behind the section it decides nothing of the part.
    text = program(control, ("/M30" if control != "okuma-osp" else "/M2", f"/{words}/M30"))
    assert in_one_line(tables_of(text, control, CUTTER)).startswith("hexagon, 36.000")


@pytest.mark.ci
@looped(
    ("control", "first", "last"),
    [
        ("fanuc-30i", "G97 S3000", "M13"),
        ("siemens-transmit", "SETMS(2) S2=3000 M2=3", "M8"),
        ("okuma-osp", "G97 SB=3000", "M13"),
    ],
)
def test_the_words_of_a_block_may_stand_in_two_blocks(control: str, first: str, last: str, tmp_path: Path) -> None:
    text = program(control)
    whole = first if first in text and last not in text else f"{first} {last}"
    text = text.replace(whole, f"{first} {last}")
    for divided, code in ((f"{first}\n{last}", 0), (f"{last}\n{first}", 1), (f"{first}\nG4 F1\n{last}", 1)):
        other = text.replace(f"{first} {last}", divided)
        assert compared(tmp_path, control, text, other).exit_code == code
        assert certified(tmp_path, control, text, other).exit_code == code


@pytest.mark.ci
def test_a_word_that_belongs_to_a_code_stands_beside_it(tmp_path: Path) -> None:
    sound, text = program("haas-lathe"), program("haas-lathe", ("P3000 M133", "P3000/M133"))
    assert compared(tmp_path, "haas-lathe", sound, text).exit_code > 0
    assert certified(tmp_path, "haas-lathe", sound, text).exit_code == 1


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "gsk-988"])
def test_a_distance_from_where_it_is_not_known_is_compared(control: str, tmp_path: Path) -> None:
    texts = [program(control, ("/T0101", f"/G0 {words}/T0101")) for words in ("W0", "W-1.", "W-1", "W-2.", "U5.")]
    for old, new, code in ((0, 1, 1), (1, 3, 1), (1, 4, 1), (1, 1, 0)):
        changed = texts[new].replace("W-1.", "W-1.0")
        assert compared(tmp_path, control, texts[old], changed).exit_code == code
        assert certified(tmp_path, control, texts[old], changed).exit_code == code


@pytest.mark.ci
@looped(
    ("control", "words"), [("siemens-transmit", "R[R500]=4"), ("okuma-osp", "VC[VC500]=5"), ("fanuc-30i", "#[#500]=5.")]
)
def test_a_variable_that_nobody_reads_changes_nothing(control: str, words: str, tmp_path: Path) -> None:
    sound, text = program(control), program(control, ("/G0 X60", f"/{words}/G0 X60"))
    # By the number of a variable FANUC sets offsets, too.
    is_offset = control == "fanuc-30i"
    assert report_of(text, control, CUTTER).verdict == ("unverified" if is_offset else "pass")
    result = compared(tmp_path, control, sound, text)
    assert (result.exit_code, f"{words} is added" in result.stdout) == (int(is_offset), is_offset)


@pytest.mark.nightly
@looped("words", ["G54", "G52 X1.", "#2001=5.", "T0102", "G53 X0."])
def test_what_displaces_the_contour_is_not_written(words: str, tmp_path: Path) -> None:
    (file,) = written(tmp_path, program("fanuc-30i", ("/G42", f"/{words}/G42")))
    for command in (
        ["compensate", "--center", "--machine", "fanuc-30i"],
        ["convert", "--from", "fanuc-30i", "--to", "gsk-988"],
    ):
        result = run(*command, "--no-config", "--tool", CUTTER, file)
        assert (result.exit_code, result.stdout) == (2, ""), command


@pytest.mark.ci
def test_a_frame_that_ends_at_the_switch_is_no_depth(tmp_path: Path) -> None:
    control = "siemens-transmit"
    plain = program(control)
    # Before TRANSMIT it moves the approach alone, in the mode the depth as well.
    for place, depth in (("/G0 X60", "Z-4.000"), ("/G1 X28", "Z-7.000")):
        text = program(control, (place, f"/TRANS Z-3{place}"))
        assert in_one_line(tables_of(text, control, CUTTER)) == f"hexagon, 36.000 across flats, to {depth}"
        assert compared(tmp_path, control, plain, text).exit_code == 1
        assert certified(tmp_path, control, plain, text).exit_code == 1


@pytest.mark.ci
@looped(
    ("control", "old", "new"),
    [
        *(
            ("fanuc-30i", "G92 X50. Z-5. F1.", "G92 X50. Z-5. F2."),
            ("gsk-988", "G92 X50. Z-5. F1.", "G92 X50. Z-5. F2."),
        ),
        *(("haas-lathe", "G92 X50. Z-5. F1.", "G92 X50. Z-5. F2."), ("haas-lathe", "M19 R1.", "M19 R2.")),
        *(("fanuc-30i", "M19 R1.", "M19 R2."), ("gsk-988", "M19 R1.", "M19 R2.")),
        ("fanuc-30i", "G92 X50. Z-5. F1./X49./G0 Z2.", "G92 X50. Z-5. F1./X49. F2./G0 Z2."),
    ],
)
def test_the_lead_of_a_thread_and_the_angle_of_a_spindle_are_orders(
    control: str, old: str, new: str, tmp_path: Path
) -> None:
    sound, text = (program(control, ("/G0 X60", f"/G0 X60. Z2./{words}/G0 X60")) for words in (old, new))
    verdict = report_of(sound, control, CUTTER).verdict
    assert report_of(text, control, CUTTER).verdict == verdict == "pass"
    assert compared(tmp_path, control, sound, text).exit_code == 1
    assert certified(tmp_path, control, sound, text).exit_code == 1


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "siemens-transmit"])
def test_block_skip_is_that_of_the_golden_trace(control: str, tmp_path: Path) -> None:
    sound = program(control).replace("\nG0 X60", "\n/M8\n/M9\nG0 X60", 1)
    assert compared(tmp_path, control, sound, sound).exit_code == 0
    assert certified(tmp_path, control, sound, sound).exit_code == 0
    for new, code in (("M8\nM9", 1), ("/M8\nM9", 1), ("/M8  (ON)\n/M9", 0)):
        text = sound.replace("/M8\n/M9", new.replace("(ON)", "; ON") if control == "siemens-transmit" else new)
        assert compared(tmp_path, control, sound, text).exit_code == code
        assert certified(tmp_path, control, sound, text).exit_code == code


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "gsk-988", "fagor-8055t"])
def test_the_order_of_axes_from_where_they_are_not_known_is_no_difference(control: str, tmp_path: Path) -> None:
    if control == "fagor-8055t":
        text = PROGRAMS["okuma-osp"].partition("G42")[2].partition("/Z2")[0].replace("Y", "C")
        head = "%1/G90 G40 G71 G94/T1 D1/G97 S0 M5/G15/M45 S3000/G0 X60 Z2 C0/G16 XC/G1 X28 F1000/Z-4 F200/G42"
        sound = f"{head}{text}/Z2 F1000/G16/G18/G0 X100 Z50/M30/".replace("/", "\n")
    else:
        sound = program(control)
    (first,) = [line for line in sound.splitlines() if line.startswith("G0 X60")]
    x, z, c = first.removeprefix("G0 ").split()
    for words, code in ((f"G0 {z}\n{x} {c}", 0), (f"G0 {c}\n{x}\n{z}", 0), (f"G0 X70.\n{first}", 1)):
        text = sound.replace(first, words)
        assert compared(tmp_path, control, sound, text).exit_code == code
        assert certified(tmp_path, control, sound, text).exit_code == code


@pytest.mark.ci
@looped(
    ("words", "verdict"),
    [
        *((f"{words} X#500", "unverified") for words in ("G10 P1", "G10 P0", "G10", "G10 L2 P1", "G10 L10 P1")),
        *(("G10 P#500 X1.", "unverified"), ("#2001=#500", "unverified"), ("#2002=#500", "pass")),
        *((f"{words} X#500", "pass") for words in ("G10 P2", "G10 L10 P2")),
    ],
)
def test_an_offset_of_another_tool_leaves_nothing_open(words: str, verdict: str, tmp_path: Path) -> None:
    sound, text = program("fanuc-30i"), program("fanuc-30i", ("/G0 X60", f"/{words}/G0 X60"))
    assert report_of(text, "fanuc-30i", CUTTER).verdict == verdict
    result = compared(tmp_path, "fanuc-30i", sound, text)
    assert (result.exit_code, "nan" in result.stdout) == (1, False)
    assert f"{words.removesuffix('.')} is added" in result.stdout


@pytest.mark.ci
@looped(
    ("old", "new"),
    [("X0 Y20.785", "X0 Y20.785 RND=R500"), ("/G42", "/RNDM=R500/G42"), ("X0 Y20.785", "X0 Y20.785 CHR=R500")],
)
def test_corners_of_an_unknown_size_are_no_corners_of_the_part(old: str, new: str) -> None:
    text = program("siemens-transmit", (old, new))
    assert report_of(text, "siemens-transmit", CUTTER).verdict == "unverified"
    (shape, *_) = made_by(tables_of(text, "siemens-transmit", CUTTER))
    assert "corners not simulated" in f"{shape.needs}"
    assert not in_one_line(tables_of(text, "siemens-transmit", CUTTER))


@pytest.mark.ci
@looped(
    ("control", "deeper"),
    [
        ("fanuc-30i", "G1 Z-#500 F200"),
        ("haas-lathe", "G1 Z-#500 F200."),
        ("siemens-transmit", "G1 Z=-R500 F200"),
        ("okuma-osp", "G101 Z=-VC500 F200"),
    ],
)
def test_a_pass_at_an_unknown_depth_may_be_the_deepest(control: str, deeper: str) -> None:
    text = program(control)
    contour = text[text.index("G42") : text.index("Z2", text.index("G42"))]
    text = text.replace(contour, f"{contour}{deeper}\n{contour}", 1)
    assert report_of(text, control, CUTTER).verdict == "unverified"
    (shape, *_) = made_by(tables_of(text, control, CUTTER))
    assert (shape.z, "to Z not known" in shape.text) == (None, True)
    assert in_one_line(tables_of(text, control, CUTTER)) == "hexagon, 36.000 across flats, to Z not known"


#: Programs whose sections name the virtual axis otherwise than the machine writes it, by what a G12.1 has beside it.
CITIZEN = (
    "O1/G21 G98 G40/T0101/G97 S3000 M13/G28 H0/G0 X60. Z-2. C0/G12.1 D1/G1 X28. F1000./Z4. F200./G42 X18. C0 F150./"
    "C10.392/X0 C20.785/X-18. C10.392/C-10.392/X0 C-20.785/X18. C-10.392/C0/G40 X28./Z-2. F1000./G13.1/M5/M30"
)
_SECTION = CITIZEN[CITIZEN.index("/G12.1") : CITIZEN.index("/M5")]


@pytest.mark.ci
@looped(
    ("control", "text"),
    [
        ("citizen", CITIZEN),
        ("citizen", CITIZEN.replace("C", "Y").replace("Y0/G12.1 D1", "C0/G12.1 D0")),
        ("citizen", CITIZEN.replace("/M5", f"/G0 X60. Z-2. C0{_SECTION.replace('C', 'Y').replace('D1', 'D0')}/M5")),
        *((control, text) for control, text in PROGRAMS.items()),
    ],
)
def test_what_a_rewriter_writes_is_to_a_check_what_it_was(control: str, text: str, tmp_path: Path) -> None:
    old = text.replace("/", "\n") + "\n"
    (file,) = written(tmp_path, old)
    new = run("compensate", "--center", "--machine", control, "--no-config", "--tool", CUTTER, file).stdout
    assert new
    for of_text in (old, new):
        report = report_of(of_text, control, CUTTER)
        assert (report.verdict, report.findings) == ("pass", [])
    assert compared(tmp_path, control, old, new).exit_code == 0


@pytest.mark.ci
@looped("control", ["fanuc-30i", "siemens-transmit", "okuma-osp"])
def test_a_straight_move_outside_of_sections_may_be_divided(control: str, tmp_path: Path) -> None:
    dot = "." if control in ("fanuc-30i", "haas-lathe") else ""
    place = "/G0 X300 Z100/M12" if control == "okuma-osp" else f"/G0 X100{dot} Z50{dot}"
    approach = f"/G0 X80{dot}/Z60{dot}"
    whole = f"{approach}/G1 X90{dot} F100{dot}/X120{dot}/G0 Z100{dot}{place}"
    sound = program(control, (place, whole))
    for old, new, code in (
        (f"/X120{dot}", f"/X100{dot}/X110{dot}/X120{dot}", 0),
        (approach, f"/G0 X80{dot}/Z50{dot}/Z60{dot}", 0),
        (f"/X120{dot}", f"/X100{dot}/M9/X120{dot}", 1),
        (f"/X120{dot}", f"/X100{dot} F200{dot}/X120{dot}", 1),
        (f"/X120{dot}", f"/X130{dot}/X120{dot}", 1),
    ):
        text = program(control, (place, whole.replace(old, new)))
        assert compared(tmp_path, control, sound, text).exit_code == code
        assert certified(tmp_path, control, sound, text).exit_code == code


@pytest.mark.ci
@looped(
    ("control", "words", "verdict"),
    [
        *itertools.product(
            ("fanuc-30i", "haas-lathe", "gsk-988"),
            ("G10 L2 P2 X#500", "G54/G10 L2 P2 X#500", "#5241=#500", "G55/#5261=#500"),
            ("pass",),
        ),
        *itertools.product(
            ("fanuc-30i", "haas-lathe", "gsk-988"),
            ("G10 L2 P1 X#500", "G10 L2 P0 X#500", "G55/G10 L2 P2 X#500", "#5201=#500", "G55/#5241=#500"),
            ("unverified",),
        ),
        *(("fanuc-30i", f"{code}G10 L20 P1 X#500", "unverified") for code in ("G54.1 P1/", "G54.1 P#500/")),
        *(("fanuc-30i", f"{code}G10 L20 P1 X#500", "pass") for code in ("", "G54.1 P2/")),
    ],
)
def test_a_work_offset_of_no_section_leaves_nothing_open(control: str, words: str, verdict: str) -> None:
    text = program(control, ("/G0 X60", f"/{words}/G0 X60"))
    assert report_of(text, control, CUTTER).verdict == verdict


@pytest.mark.ci
@looped("target", ["haas-lathe", "okuma-osp", "mazak-integrex"])
def test_what_is_a_note_on_one_lathe_and_fails_a_program_on_another_is_to_decide(target: str, tmp_path: Path) -> None:
    (file,) = written(tmp_path, program("takisawa", (" M200", ""), ("M13", "M70")))
    findings = report_of(file.read_text("utf-8"), "takisawa", CUTTER).findings
    assert ("c-axis-not-engaged", "note") in [(finding.rule, finding.severity) for finding in findings]
    result = run("convert", "--from", "takisawa", "--to", target, "--no-config", "--tool", CUTTER, file)
    assert (result.exit_code, "to decide: c-axis-not-engaged" in result.stderr) == (1, True)
    findings = report_of(result.stdout, target, CUTTER).findings
    assert ("c-axis-not-engaged", "warning") in [(finding.rule, finding.severity) for finding in findings]


#: Ends of programs behind a condition that is not known, by control: those of which no section can come, and others.
ENDS = {
    "fanuc-30i": (
        (
            "#501=#501+1/IF[#501GE10]THEN #3000=1/M5/M30",
            "IF[#501GE10]GOTO 9/M5/M30/N9M8/M5/M30",
            "IF[#501GE10]GOTO 9/N9M99",
        ),
        ("N9G0 Z3./IF[#501GE10]GOTO 9/M30", "IF[#501GE10]GOTO 9/M30/N9 M99 P8", "IF[#501GE10]GOTO 9/M30/N9 M98 P7"),
    ),
    "haas-lathe": (
        ("IF[#501GE10]THEN #3000=1/M30", "IF[#501GE10]GOTO 9/M135/M30/N9M8/M135/M30"),
        (
            "IF[#501GE10]GOTO 9/M30/N9G112/G1 X5.F9./G113/M30",
            "WHILE[#501GE10]DO1/G0 Z3./END1/M30",
            "IF[#501GE10]GOTO 9/M30/N9M#502/M30",
        ),
    ),
    "siemens-transmit": (
        ("IF R501>=10 GOTOF ENDE/M30/ENDE: M8/M30", "IF R501>=10/M0/ENDIF/M30"),
        ("AGAIN: G0 Z3/IF R501>=10 GOTOB AGAIN/M30", "IF R501>=10 GOTOF ENDE/M30/ENDE: TRANSMIT/G1 X5/TRAFOOF/M30"),
    ),
    "okuma-osp": (
        ("IF[VC501 GE 10]NEND/M2/NEND M12/M109/M2",),
        ("NBACK G0 Z3/IF[VC501 GE 10]NBACK/M2", "IF[VC501 GE 10]NEND/M2/NEND G137/G101 X5/G136/M2"),
    ),
}


@looped("control", ENDS)
def test_a_condition_of_which_no_section_can_come_has_no_weight(control: str, tmp_path: Path) -> None:
    end = program(control).rpartition("\nG0 ")[2].replace("\n", "/").rstrip("/").partition("/")[2]
    for verdict, ends in zip(("pass", "unverified"), ENDS[control], strict=True):
        for words in ends:
            text = program(control, (f"/{end}", f"/{words}"))
            assert (words, report_of(text, control, CUTTER).verdict) == (words, verdict)
    # What such a condition leads to is compared all the same.
    text = program(control, (f"/{end}", f"/{ENDS[control][0][-1]}"))
    other = text.replace("M8\n", "M9\n").replace("M12\n", "M13\n").replace("M0\n", "M1\n").replace("N9M99", "N9M8\nM99")
    assert other != text
    for new, code in ((text, 0), (other, 1)):
        assert certified(tmp_path, control, text, new).exit_code == code
        assert ("not compared, because" in compared(tmp_path, control, text, new).stdout) is (new is other)


def test_what_runs_behind_conditions_is_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of many conditions each would look at all that follows."""
    looked_at = 0
    target = Listing._target

    def counted(*arguments: Any) -> int:
        nonlocal looked_at
        looked_at += 1
        return target(*arguments)

    monkeypatch.setattr(Listing, "_target", counted)
    text = program("fanuc-30i", ("/M30", "/IF[#501GE10]THEN #3000=1" * 200 + "/M30"))
    assert report_of(text, "fanuc-30i", CUTTER).verdict == "pass"
    assert 200 <= looked_at <= 500


@looped(
    ("control", "dwell", "same", "longer"),
    [
        ("fanuc-30i", "G4 P500", ("G4 X.5", "G4 U0.5"), ("G4 P501", "G4 X.6", "G4 X5")),
        ("gsk-988", "G4 X.5", ("G4 P500",), ("G4 P.5", "G4")),
        ("haas-lathe", "G4 P500", ("G4 P0.5",), ("G4 P0.501", "G4 P5")),
        ("siemens-transmit", "G4 F.5", ("G4 F0.50",), ("G4 F.6", "G4 S.5")),
    ],
)
def test_a_dwell_is_as_long_by_whichever_word(
    control: str, dwell: str, same: Sequence[str], longer: Sequence[str], tmp_path: Path
) -> None:
    sound = program(control, ("/G42", f"/{dwell}/G42"))
    for code, words in ((0, same), (1, longer)):
        for word in words:
            text = program(control, ("/G42", f"/{word}/G42"))
            assert (word, min(compared(tmp_path, control, sound, text).exit_code, 1)) == (word, code)
            assert (word, certified(tmp_path, control, sound, text).exit_code) == (word, code)


@pytest.mark.ci
@looped("control", ["fanuc-30i", "haas-lathe", "siemens-transmit", "takisawa"])
def test_an_order_beside_a_contour_stands_where_it_stood_on_the_path_of_the_tool_center(
    control: str, tmp_path: Path
) -> None:
    second = "Y" if control in PROGRAMS and control != "fanuc-30i" else "C"
    place = f"{second}10.392/"
    text = program(control, (place, f"{place}M8/"), (f"/{second}0/", f"/M9/{second}0/"))
    (file,) = written(tmp_path, text)
    center = run("compensate", "--center", "--machine", control, "--no-config", "--tool", CUTTER, file).stdout
    assert "M8" in center
    assert compared(tmp_path, control, text, center).exit_code == 0
    elsewhere = center.replace("M8\n", "").replace("M9\n", "M8\nM9\n")
    assert "M8 stands" in compared(tmp_path, control, center, elsewhere).stdout
    before = program(control, ("/Z-4", "/M8/Z-4"))
    behind = before.replace("M8\n", "").replace("\nG42", "\nM8\nG42")
    assert "M8 stands elsewhere" in compared(tmp_path, control, before, behind).stdout


#: The hexagon of some controls with X as a diameter in the place of a radius, or with what makes it one elsewhere.
MEASURES = {
    "siemens-transmit": [
        [("DIAMOF/", ""), ("X28", "X56"), ("X18", "X36"), ("X-18", "X-36")],
        [("DIAMOF/TRANSMIT", "TRANSMIT/DIAMOF")],
    ],
    "hurco": [[("G7/G101", "G101/G7")], [("G109/G8", "G8/G109")]],
    "mazak-integrex": [
        [("G10.9 X0/", ""), ("X28.", "X56."), ("X18.", "X36."), ("X-18.", "X-36.")],
        [("G10.9 X0/G17 XC", "G17 XC/G10.9 X0")],
    ],
}
_AS_RADIUS = "G1 X28. {0}0 F1000/Z-4. F200/G42 X18. {0}0 F150/{0}10.392/X0 {0}20.785/X-18. {0}10.392/{0}-10.392/"
_AS_RADIUS += "X0 {0}-20.785/X18. {0}-10.392/{0}0/G40 X28./Z2. F1000/"
WITH_RADII = {
    "siemens-transmit": PROGRAMS["siemens-transmit"],
    "hurco": "O1/G21 G90 G94 G40 G97/T0101/M131/M33 S3000/G0 X60. Z2. C0/G7/G101/G17/"
    + _AS_RADIUS.format("Y")
    + "G109/G8/G0 X100. Z50./M35/M130/M30",
    "mazak-integrex": "O1/G21 G90 G94 G40 G97/T0101/M205/M200/G28 C0/M3 S3000/G0 X60. Z2. C0/G10.9 X0/G17 XC/G12.1/"
    + _AS_RADIUS.format("C")
    + "G13.1/G10.9 X1/M5/M202/G0 X100. Z50./M30",
}


@pytest.mark.ci
@looped(("control", "number"), [(control, number) for control, changes in MEASURES.items() for number in (0, 1)])
def test_where_x_becomes_a_radius_is_seen_in_the_path(control: str, number: int, tmp_path: Path) -> None:
    text = other = WITH_RADII[control]
    for old, new in MEASURES[control][number]:
        assert old in other, old
        other = other.replace(old, new)
    texts = [written_text.replace("/", "\n") + "\n" for written_text in (text, other)]
    assert report_of(texts[1], control, CUTTER).verdict == "pass"
    assert compared(tmp_path, control, *texts).exit_code == 0
    assert certified(tmp_path, control, *texts).exit_code == 0


@pytest.mark.ci
@looped(
    ("control", "old", "new"),
    [
        ("siemens-transmit", "SETMS(2) S2=3000 M2=3/G0 X60 Z2 C0", "G0 X60 Z2 C0/SETMS(2) S2=3000 M2=3"),
        ("fanuc-30i", "#1=4./G0 X60. Z2. C0", "G0 X60. Z2. C0/#1=4."),
        ("okuma-osp", "V1=4/G0 X60 Z2", "G0 X60 Z2/V1=4"),
    ],
)
def test_a_statement_at_another_place_is_another_text(control: str, old: str, new: str, tmp_path: Path) -> None:
    move = next(part for part in old.split("/") if part.startswith("G0"))
    sound = program(control, (old if control.startswith("siemens") else move, old))
    result = compared(tmp_path, control, sound, sound.replace(old.replace("/", "\n"), new.replace("/", "\n")))
    assert "the same but for" not in result.stdout


@pytest.mark.ci
def test_a_word_of_a_language_of_its_own_is_shown_as_it_is_written(tmp_path: Path) -> None:
    texts = [program("siemens-transmit", ("/G42", f"/OFFN={size} G42")) for size in (0, 0.2)]
    assert "OFFN=0 has become OFFN=0.2" in compared(tmp_path, "siemens-transmit", *texts).stdout


@pytest.mark.ci
@looped(
    ("control", "place", "text"),
    [
        (
            "siemens-transmit",
            "G0 X28 Y0",
            program("siemens-transmit", ("G0 X60 Z2 C0", "G0 Z2 C0"), ("G1 X28", "G0 X28 Y0")),
        ),
        ("haas-lathe", "G0 X28. Y0", program("haas-lathe", ("G0 X60. Z2. C0", "G0 Z2. C0"), ("G1 X28.", "G0 X28. Y0"))),
        ("fagor-8055t", "G0 X40. C0", (SAMPLES / "fagor-8055t/face.nc").read_text("utf-8")),
    ],
)
def test_a_program_that_positions_behind_the_switch_is_compared(
    control: str, place: str, text: str, tmp_path: Path
) -> None:
    code, x, second = place.split()
    result = compared(tmp_path, control, text, text.replace(place, f"{code} {second} {x}"))
    assert (result.exit_code, "the same metal" in result.stdout) == (0, True)
    elsewhere = compared(tmp_path, control, text, text.replace(place, f"{code} {x[0]}5{x[1:]} {second}"))
    assert (elsewhere.exit_code, "the path differs" in elsewhere.stdout) == (1, True)


@pytest.mark.ci
@looped("control", C_OF_ENTRY)
def test_a_place_is_not_known_to_the_line_where_c_is_not(control: str) -> None:
    second = "Y" if control == "haas-lathe" else "C"
    slot = f"X20. {second}-8. F150\n{second}8.\n{second}-8.\nX28. {second}0"
    texts = [program(control, *changes) for changes in ((), C_OF_ENTRY[control])]
    lines = [
        in_one_line(tables_of(re.sub(r"G42.*?G40 X\S+", slot, text, flags=re.DOTALL), control, CUTTER))
        for text in texts
    ]
    assert ["is not known" in line for line in lines] == [False, True]
    assert all("c from" in line for line in lines)
