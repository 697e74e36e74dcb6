"""The rotary axis under another address than C: the profile names it once, and everything follows."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from msgspec.structs import replace
from polarcheck.errors import MachineError
from programs import ROOT, machine_of, report_of, said, tables_of, trace_of

from polarcheck.foundation.finding import FileReport
from polarcheck.program.machines import profiles

SAMPLES = ROOT / "sample_programs"
#: Sample programs by the lathe that they are written for, where C is the virtual and the rotary axis.
PROGRAMS = [
    (path, machine)
    for folder, machine in (
        *((SAMPLES, "fanuc-30i"), (SAMPLES / "fanuc-16i", "fanuc-16i"), (SAMPLES / "turning-center", "turning-center")),
        *((SAMPLES / "gsk-988", "gsk-988"), (SAMPLES / "mitsubishi-m700", "mitsubishi-m700")),
    )
    for path in sorted(folder.glob("*.nc"))
]
CODES = {"m_codes": {"c_axis_on": ["M35"], "c_axis_off": ["M34"]}, "limits": {"c_feed": 5000}}
CONTOUR = """%
O1
G98 G40 G97 T0101
M35
G28 A0
G0 X60. A30. Z5.
G12.1
G42 G1 X40. F200
A10.
G3 X20. A20. R10.
G1 X-20.
A-10.
X40. A-10.
A0
G40 X60.
G13.1
G0 Z50. A90.
M34
M30
%
"""
TOOL = "1:radius=4"


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def renamed(program: str, name: str) -> str:
    """The program with another address for C, outside of comments; a name of several characters takes its =."""
    word = f"{name}=" if len(name) > 1 else name
    own = re.compile(r"(?<![A-Z,<>])C(?=[ ]?[-+\d.#\[])")
    parts = re.split(r"(\([^)\n]*\)?)", program)
    return "".join(part if part.startswith("(") else own.sub(word, part) for part in parts)


def findings(report: FileReport) -> list[tuple[Any, ...]]:
    """What is found, without its words."""
    return [(one.rule, one.line, one.severity, one.alarm, one.count) for one in report.findings]


@pytest.mark.nightly
@pytest.mark.one_in(21)
@pytest.mark.parametrize(
    ("path", "machine", "name"),
    # Two of the four names for each program, each time others.
    [
        pytest.param(path, machine, name, id=f"{path.stem}-{machine}-{name}")
        for number, (path, machine) in enumerate(PROGRAMS)
        for name in ("A", "B", "H", "C2")[number % 2 :: 2]
    ],
)
def test_the_same_program_with_another_address(path: Path, machine: str, name: str) -> None:
    """The same tool center path, rates and findings."""
    program = path.read_text("utf-8").replace("H0", "C0")
    changes = {"polar": {"rotary_address": name}}
    other = renamed(program, name)
    assert other != program
    tables, twin = tables_of(program, machine, TOOL), tables_of(other, machine, TOOL, changes=changes)
    for table, column in (
        *(("path", "end"), ("path", "c_angle"), ("path", "z"), ("path", "x")),
        *(("tool_center", "c_feed"), ("tool_center", "nearest")),
        *(("moves", "start"), ("moves", "end"), ("moves", "c_feed")),
    ):
        left, right = (getattr(one[table], column) for one in (tables, twin))
        assert np.array_equal(left, right, equal_nan=True), (table, column)
    report, of_twin = report_of(program, machine, TOOL), report_of(other, machine, TOOL, changes=changes)
    text = {"number-without-point", "lower-case-word", "unknown-code"} if len(name) > 1 else set()
    assert [one for one in findings(of_twin) if one[0] not in text] == [
        one for one in findings(report) if one[0] not in text
    ]
    assert of_twin.polar_sections == [replace(section, rotary=name) for section in report.polar_sections]
    assert of_twin.verdict == report.verdict


@looped(
    ("machine", "changes", "names"),
    [
        ("fanuc", {"polar": {"virtual_axis": "Y"}}, ("C", "H", "Y", "V", ["C", "H"])),
        ("fanuc", {"polar": {"virtual_axis": "A"}}, ("A", "", "A", "", ["Y", "V", "C", "H"])),
        ("fanuc", {"polar": {"virtual_axis": "C2"}}, ("C2", "", "C2", "", ["Y", "V", "C", "H"])),
        ("fanuc", {"polar": {"rotary_address": "B"}}, ("B", "", "B", "", ["Y", "V", "C", "H"])),
        ("fanuc", {"polar": {"rotary_address": "C"}}, ("C", "H", "C", "H", ["Y", "V"])),
        (
            "fanuc",
            {"polar": {"rotary_address": "A", "rotary_incremental": "E"}},
            ("A", "E", "A", "E", ["Y", "V", "C", "H"]),
        ),
        ("fanuc", {"polar": {"rotary_address": "A", "virtual_axis": "Y"}}, ("A", "", "Y", "V", ["A", ""])),
        (
            "fanuc",
            {"polar": {"virtual_axis": "Y", "virtual_axis_incremental": "H"}},
            ("C", "H", "Y", "H", ["C", "H"]),
        ),
        ("fanuc", {"control": {"axes": ["X", "Z", "B"]}}, ("B", "", "B", "", ["Y", "V", "C", "H"])),
        (
            "fanuc",
            {"control": {"axes": ["X", "Z", "C", "A"]}, "parameters": {"5461": 4}},
            ("A", "", "A", "", ["Y", "V"]),
        ),
        ("fanuc", {"control": {"axes": ["X1", "Z1", "C1"]}}, ("C", "H", "C", "H", ["Y", "V"])),
        ("fanuc", {"polar": {"virtual_axis": "Y1"}}, ("C", "H", "Y", "V", ["C", "H"])),
        ("fanuc", {"polar": {"rotary_address": "C1"}}, ("C", "H", "C", "H", ["Y", "V"])),
        ("haas-lathe", {"polar": {"rotary_address": "B"}}, ("B", "", "Y", "V", ["B", ""])),
        ("mitsubishi-m700", {"parameters": {"1516": "B"}}, ("B", "", "B", "", ["Y", "V", "C", "H"])),
        ("mitsubishi-m700", {"parameters": {"1516": "b", "1517": 0}}, ("B", "", "Y", "V", ["B", ""])),
        ("mitsubishi-m700", {"parameters": {"1516": "A", "1517": 1}}, ("A", "", "A", "", ["Y", "V", "C", "H"])),
        ("citizen", {"parameters": {"1517": 1}}, ("C", "H", "C", "H", ["Y", "V"])),
    ],
)
def test_what_follows_from_a_name(machine: str, changes: dict[str, Any], names: tuple[Any, ...]) -> None:
    polar = machine_of(machine, changes).polar
    assert (
        *polar.rotary_words,
        polar.virtual_axis,
        polar.virtual_axis_incremental,
        polar.virtual_axis_of_other_controls,
    ) == names


def test_the_words_beside_the_switch_follow() -> None:
    """Those that are inherited, and those that a parameter of a nearer file lets stand there."""
    assert machine_of("gsk-988", {"polar": {"rotary_address": "B"}}).polar.words_beside_switch[:2] == ["X", "B"]
    assert machine_of("citizen", {"polar": {"rotary_address": "B"}}).polar.virtual_axis_by_word["D1"] == ("B", "")
    Path("lathe.toml").write_text("inherits = 'fanuc'\n[polar]\nrotary_address = 'A'\n", "utf-8")
    nearer = profiles.load("lathe.toml", {"parameters": {"5450#2": 1}})
    assert nearer.machine.polar.words_beside_switch == ["X", "A"]
    origin = nearer.origins["polar.virtual_axis"]
    assert (origin.profile, origin.source) == ("lathe.toml", "follows from polar.rotary_address")
    further = profiles.load("lathe.toml", {"polar": {"rotary_address": "C"}}).machine.polar
    assert (*further.rotary_words, further.virtual_axis, further.virtual_axis_incremental) == ("C", "H", "C", "H")


@looped(
    ("text", "said"),
    [
        ("[polar]\nrotary_address = 'X'", "polar.rotary_address: expected A, B, C or H, or the name of an axis as C2"),
        (
            "[polar]\nvirtual_axis = 'C22222'",
            "polar.virtual_axis: expected an address, one letter or the name of an axis",
        ),
        ("[polar]\nvirtual_axis = 'M2'", "polar.virtual_axis: expected an address"),
        ("[polar]\nwords_beside_switch = ['R2']", "polar.words_beside_switch: 'R2' is no code"),
        ("[polar]\nrotary_address = 3", "polar.rotary_address: expected"),
        ("[polar]\nrotary_address = 'c2'", "polar.rotary_address: expected"),
        ("[polar]\nrotary_address = 'A'\n[control]\naxes = ['X', 'Z', 'C']", "polar.rotary_axis is 3, C, but polar.ro"),
        (
            "[parameters]\n5461 = 2\n[control]\naxes = ['X', 'Z', 'C']",
            "polar.rotary_axis is 2, but Z is no rotary axis",
        ),
        ("[control]\naxes = ['X', 'Z', 3]", "control.axes: expected"),
    ],
)
def test_a_name_that_cannot_be_is_one_line(text: str, said: str) -> None:
    Path("own.toml").write_text(f"inherits = 'fanuc'\n{text}\n", "utf-8")
    with pytest.raises(MachineError) as error:
        profiles.load("own.toml")
    assert said in str(error.value)
    assert str(error.value).startswith("own.toml: ")
    assert "\n" not in str(error.value)


@pytest.mark.ci
def test_words_outside_the_mode_are_angles_of_that_axis() -> None:
    """G28 and the approach; C words there are no axis."""
    changes = {"polar": {"rotary_address": "A"}, **CODES}
    report = report_of(CONTOUR, "fanuc", TOOL, changes=changes)
    assert (said(report), report.verdict) == ([], "pass")
    trace = trace_of(CONTOUR.replace("G28 A0", "G28 A0\nG0 C45."), "fanuc", TOOL, changes=changes)
    assert trace.path.section_entry.tolist() == [30.0]
    assert trace.machine.address_number("C") in trace.run.words.address


@pytest.mark.ci
@looped(
    ("before", "after", "rule", "words"),
    [
        ("M35\nG28 A0\n", "M35\n", "c-axis-not-referenced", "A has not gone to its reference point.*G28 A0"),
        ("M35\n", "", "c-axis-not-engaged", "the A axis is not engaged"),
        (" A30.", "", "c-angle-unknown-at-entry", "A has not been positioned"),
        ("\nA10.", "\nA10. F5000", "c-feed-above-limit", "^A axis would turn"),
        ("\nA10.", "\nA360.", "degrees-in-polar", "A360"),
        ("\nA10.", "\nC10.", "wrong-axis-address-in-polar", "its second axis is A here"),
        ("\nG40 X60.\n", "\nG40 X60.\nX-60. A0\n", "path-through-center", "center of the A axis"),
    ],
    one_in=2,
)
def test_messages_name_the_axis(before: str, after: str, rule: str, words: str) -> None:
    assert before in CONTOUR
    program = CONTOUR.replace(before, after, 1)
    if rule == "c-angle-unknown-at-entry":
        program = program.replace("G28 A0\n", "")
    report = report_of(program, "fanuc", TOOL, changes={"polar": {"rotary_address": "A"}, **CODES}, only=[rule])
    assert [one.rule for one in report.findings] == [rule]
    assert re.search(words, report.findings[0].message), report.findings[0].message
    twin = report_of(program.replace("C10.", "Y10.").replace("A", "C"), "fanuc", TOOL, changes=CODES, only=[rule])
    assert [one.line for one in twin.findings] == [one.line for one in report.findings]


@pytest.mark.nightly
def test_a_second_spindle_is_followed_by_its_name() -> None:
    """C2=10. with the profile of that spindle; its findings write the name with =."""
    program = renamed(CONTOUR.replace("A", "C"), "C2")
    changes = {"polar": {"rotary_address": "C2"}, **CODES}
    report = report_of(program, "fanuc", TOOL, changes=changes)
    assert (said(report), report.verdict) == ([], "pass")
    missing = report_of(program.replace("G28 C2=0\n", ""), "fanuc", TOOL, changes=changes)
    assert "write G28 C2=0 before" in missing.findings[0].message


@pytest.mark.nightly
@looped("words", ["X0 C2=0", "x0 c2=0", "X0 C2=5.", "P1 Q4", "C2=0 X0"], one_in=4)
def test_a_named_axis_beside_the_switch(words: str) -> None:
    """Where the control takes the axes there: by name, by number, in lower case."""
    program = renamed(CONTOUR.replace("A", "C"), "C2").replace("G12.1", f"G12.1 {words}")
    changes = {
        "polar": {"rotary_address": "C2", "words_beside_switch": ["X", "C2", "P", "Q"], "rotary_axis": 4},
        "control": {"axes": ["X", "Z", "C", "C2"]},
        **CODES,
    }
    if "5." not in words:
        assert said(report_of(program, "fanuc", TOOL, changes=changes)) == []
    trace = trace_of(program, "fanuc", TOOL, changes=changes)
    assert trace.path.center_shift[trace.mode.sections.enter[0]] == (5j if "5." in words else 0)


@pytest.mark.nightly
@looped(("name", "number"), [("A", 4), ("C2", 5)])
def test_q_names_another_rotary_axis(name: str, number: int) -> None:
    """Its words are lengths in its section, where C moves by itself; what angle it enters at is not followed."""
    changes = {"control": {"axes": ["X", "Z", "C", "A", "C2"]}}
    usual = CONTOUR.replace("A", "C").replace("M35\n", "").replace("M34\n", "").replace("G28 C0\n", "")
    usual = usual.replace("G98 ", "").replace("C30.", "C0").replace("G12.1", "G12.1 P1 Q3")
    other = renamed(usual, name).replace("Q3", f"Q{number}")
    one, two = (trace_of(program, "gsk-988", TOOL, changes=changes) for program in (usual, other))
    assert np.array_equal(one.path.end, two.path.end, equal_nan=True)
    reports = [report_of(program, "gsk-988", TOOL, changes=changes) for program in (usual, other)]
    assert [said(report) for report in reports] == [[], []]
    reasons = [[missing.reason for missing in report.not_evaluated if missing.matters] for report in reports]
    assert reasons[0] == []
    assert len(reasons[1]) == 1
    assert reasons[1][0].startswith("Q names another rotary axis than 3")
    beside = other.replace("X-20.\n", "X-20. C5.\n")
    assert said(report_of(beside, "gsk-988", TOOL, changes=changes)) == []
    assert np.array_equal(trace_of(beside, "gsk-988", TOOL, changes=changes).path.end, two.path.end, equal_nan=True)


def test_sections_on_two_rotary_axes() -> None:
    """Each takes its own words; without names of the axes Q tells nothing of them."""
    changes = {"control": {"axes": ["X", "Z", "C", "A"]}}
    head, section, end = (
        "%\nO1\nG0 X60. C0\n",
        "G12.1 P1 Q{}\nG1 X40. F200\n{}10.\nX60.\n{}0\nG13.1\nG0 X60. C0\n",
        "M30\n%\n",
    )
    program = head + section.format(3, "C", "C") + section.format(4, "A", "A") + section.format(3, "C", "C") + end
    trace = trace_of(program, "gsk-988", changes=changes)
    ends = [trace.path.end[trace.mode.in_polar & (trace.mode.section == number)] for number in range(3)]
    assert np.array_equal(ends[0], ends[1])
    assert np.array_equal(ends[0], ends[2])
    assert [trace.axes.virtual_axis_of(row) for row in trace.mode.sections.enter.tolist()] == ["C", "A", "C"]
    assert said(report_of(program.replace("G0 X60. C0\n", "T0101\nG0 X60. C0\n", 1), "gsk-988", changes=changes)) == []
