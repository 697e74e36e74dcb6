"""Tools with edges: T calls the tool by number or name, D the edge, and both together the offset in force."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from cases import looped
from polarcheck.errors import JobError, UsageError
from programs import job_of, report_of, said, tables_of, trace_of
from test_cli import call, check, make

from polarcheck.program.machines.offset_keys import canonical, key_of
from polarcheck.reports.pages import executed, json_schema

pytestmark = pytest.mark.usefixtures("own_folder")

NAMED = 'T="MILL_8" D1'
FACE = """{call}
G94 G0 X60 Y0 Z20
DIAMOF
TRANSMIT
G17
G1 X40 Y10 F300
G41 X20
Y0
{inside}Y-20
G40 X40
TRAFOOF
DIAMON
M30
"""


def face(call: str, inside: str = "") -> str:
    return FACE.format(call=call, inside=inside)


def section_of(program: str, *tools: str, **more: Any) -> tuple[int | str | None, float | None, str]:
    """Offset, R and its source of the one section."""
    (found,) = report_of(program, "siemens-transmit", *tools, **more).polar_sections
    return found.offset, found.radius, found.radius_source


@pytest.mark.ci
@looped(
    ("calls", "tool", "offset"),
    [
        (NAMED, "MILL_8/1", "MILL_8/1"),
        (NAMED, "MILL_8", "MILL_8/1"),
        ('N20 T = "Mill_8" D01', "mill_8/01", "MILL_8/1"),
        ('T="MILL_8"', "MILL_8", "MILL_8/1"),
        ('T="MILL_8" D2', "MILL_8/2", "MILL_8/2"),
        ('T="MILL_8" D1\nD2', "MILL_8/2", "MILL_8/2"),
        ('T="8" D1', "8", "8/1"),
        ("T8 D1", "8/1", "8/1"),
        ("T8 D1", "T8", "8/1"),
        ("T8", "8", "8/1"),
        ("T8 D2", "8/2", "8/2"),
        ("T8\nM6\nD3", "8/3", "8/3"),
        ("T8 D2\nT9", "9/1", "9/1"),
        ("T8 D2\nT8", "8/2", "8/2"),
        ("T8 D2\nD0\nD2", "8/2", "8/2"),
        ("T1208 D1", "1208", "1208/1"),
        ('T="FACE MILL 8" D1', "FACE MILL 8/1", "FACE MILL 8/1"),
        ('T="FRÄSER:8.5" D1', "fräser:8.5", "FRÄSER:8.5/1"),
        ('T="FRÄSER:8.5" D2', '"fräser:8.5"/2', "FRÄSER:8.5/2"),
        ('T="D10/2" D1', '"D10/2"/1', "D10/2/1"),
        ('T="D10/2" D3', "D10/2/3", "D10/2/3"),
    ],
    one_in=5,
)
def test_the_offset_in_force_is_tool_and_edge(calls: str, tool: str, offset: str) -> None:
    assert section_of(face(calls), f"{tool}:radius=4") == (offset, 4.0, "command line")


@pytest.mark.ci
@looped(
    ("calls", "tool"), [(NAMED, "MILL_8/2"), ("T8 D2", "8"), ("T9 D1", "8"), ("T0808 D1", "8"), ("T8 D1", "MILL_8")]
)
def test_another_edge_and_another_tool_are_other_offsets(calls: str, tool: str) -> None:
    _, radius, source = section_of(face(calls), f"{tool}:radius=4")
    assert (radius, source) == (None, "none")


@pytest.mark.ci
@looped(
    ("edge", "calls", "offset"),
    [(0, "T8", None), (0, "T8\nD1", "8/1"), (2, "T8", "8/2"), (-1, "T7 D3\nT8", "8/3"), (-1, "T8", None)],
)
def test_the_machine_says_which_edge_a_tool_change_calls(edge: int, calls: str, offset: str | None) -> None:
    changes = {"offsets": {"edge_after_tool": edge}}
    assert section_of(face(calls), changes=changes)[0] == offset


@pytest.mark.ci
@looped(
    ("key", "calls"),
    [
        ("MILL_8/1", NAMED),
        ("MILL_8", NAMED),
        ("8/1", "T8 D1"),
        ("8", "T8 D1"),
        ("08/1", "T8"),
        ("Fräser 8/2", 'T="FRÄSER 8" D2'),
    ],
    one_in=2,
)
def test_a_job_gives_edges_by_their_keys(key: str, calls: str) -> None:
    job = {"tools": {key: {"radius": 4.0}}}
    assert section_of(face(calls), job=job)[1:] == (4.0, "job")
    jsonschema.Draft202012Validator(json_schema.schema("job")).validate(job)


def test_the_command_line_changes_the_edge_of_the_job() -> None:
    job = job_of("8/1:nose=0", job={"tools": {"8": {"radius": 4.0}, "8/2": {"radius": 3.0}}})
    assert {key: (tool.radius, tool.nose) for key, tool in job.tools.items()} == {"8": (4.0, 0), "8/2": (3.0, None)}


@looped(("first", "second"), [("8", "8/1"), ("8", "08"), ("MILL", "mill/1")])
def test_one_offset_is_given_once(first: str, second: str) -> None:
    with pytest.raises(JobError, match=f"tools.{first} and tools.{second} are one tool offset"):
        job_of(job={"tools": {first: {"radius": 4.0}, second: {"radius": 3.0}}})


@looped(
    ("written", "key"),
    [("8", "8"), ("008", "8"), ("8/1", "8"), ("8/02", "8/2"), ("mill/1", "MILL"), ("a/b", "A/B"), ("A/1/1", "A/1/1")],
)
def test_an_offset_has_one_key(written: str, key: str) -> None:
    assert canonical(written) == key
    assert canonical(key) == key


def test_the_key_of_a_name_that_ends_as_an_edge_keeps_its_edge() -> None:
    assert canonical(key_of("A/1", 1)) == "A/1/1"
    assert canonical("A/1") == key_of("A", 1) == "A"


# ---- what is said ----


@pytest.mark.ci
def test_what_is_missing_is_named_by_tool_and_edge() -> None:
    reasons = [entry.reason for entry in report_of(face(NAMED), "siemens-transmit").not_evaluated]
    asked = "no radius for T MILL_8 edge 1: give --tool MILL_8/1:radius=... or"
    assert f'{asked} [tools."MILL_8/1"] radius in polarcheck.toml' in reasons
    reasons = [entry.reason for entry in report_of(face("T8 D2"), "siemens-transmit").not_evaluated]
    assert 'no radius for T8 edge 2: give --tool 8/2:radius=... or [tools."8/2"] radius in polarcheck.toml' in reasons
    reasons = [entry.reason for entry in report_of(face('T="A B"'), "siemens-transmit").not_evaluated]
    assert "no radius for T A B edge 1: give --tool 'A B/1:radius=...' or" in " ".join(reasons)
    reasons = [entry.reason for entry in report_of(face("D1"), "siemens-transmit").not_evaluated]
    assert "no radius for the tool called before edge 1: call T8 D1 before it" in reasons


@pytest.mark.ci
def test_a_name_of_a_program_acts_nowhere() -> None:
    make(a__mpf=face('T="A\x1b[2J\x07<b>"'))
    for form in ("text", "json", "html"):
        shown = check("a.mpf", "--machine", "siemens-transmit", "--format", form).stdout
        assert "\x1b[2J" not in shown
        assert "\x07" not in shown
        assert form != "html" or "A\\x1b[2J\\x07<B>" not in shown


@pytest.mark.ci
def test_the_report_holds_name_and_edge() -> None:
    make(
        a__mpf=face(NAMED),
        b__mpf=face("T8 D2"),
        polarcheck__toml='machine = "siemens-transmit"\n[tools."MILL_8/1"]\nradius = 4\n',
    )
    result = check("a.mpf", "b.mpf", "--tool", "8/2:radius=3", "--format", "json")
    jsonschema.Draft202012Validator(json_schema.schema("report")).validate(json.loads(result.stdout))
    found = [file["polar_sections"][0] for file in json.loads(result.stdout)["files"]]
    assert [(one["offset"], one["radius"], one["radius_source"]) for one in found] == [
        ("MILL_8/1", 4, "job"),
        ("8/2", 3, "command line"),
    ]
    assert "offset MILL_8/1 with R 4" in check("a.mpf").stdout
    assert "no program" not in result.stderr
    assert "--tool MILL_9/2: no program of this run calls offset MILL_9/2" in (
        check("a.mpf", "--tool", "mill_9/2:radius=3").stderr
    )


def test_the_executed_table_names_tool_and_edge() -> None:
    rows = list(
        executed.rows(*(tables_of(face(NAMED, "D2\n"), "siemens-transmit")[name] for name in ("trace", "tool_center")))
    )
    assert {(row["tool"], row["offset_number"]) for row in rows} == {("MILL_8", "MILL_8/1"), ("MILL_8", "MILL_8/2")}
    rows = list(executed.rows(*(tables_of("T0808\n")[name] for name in ("trace", "tool_center"))))
    assert [(row["tool"], row["offset_number"]) for row in rows] == [(8, 8)]
    Path("a.mpf").write_text(face('T="A B"'), "utf-8")
    shown = call("trace", "a.mpf", "--machine", "siemens-transmit", "--path", "tool").stderr
    assert "no radius for T A B edge 1" in shown
    assert "give --tool 'A B/1:radius=...' or --offsets FILE" in shown


def test_r_is_taken_from_the_comment_of_the_edge() -> None:
    calls = "T8 D1 ; END MILL 8 MM\nD2 ; D=12.\n"
    found = report_of(face(calls), "siemens-transmit", job={"radius_from_comments": True})
    assert (found.polar_sections[0].offset, found.polar_sections[0].radius) == ("8/2", 6.0)
    assert (2, "radius-from-comment") in said(found)


@looped(
    ("option", "told"),
    [
        ("MILL_8:radius=4", "--tool MILL_8:radius=4: expected NUMBER:KEY=VALUE as in 8:radius=0.375"),
        ("8/2:radius=4", "--tool 8/2:radius=4: expected NUMBER:KEY=VALUE as in 8:radius=0.375"),
    ],
)
def test_a_control_without_edges_has_numbers_alone(option: str, told: str) -> None:
    make(a__nc="T0808\n")
    result = check("a.nc", "--tool", option)
    assert (result.exit_code, result.stderr) == (2, f"polarcheck: {told}\n")
    make(polarcheck__toml='[tools."8/2"]\nradius = 4\n')
    result = check("a.nc")
    expected = "polarcheck.toml:1: tools.8/2: expected the number of a tool offset, 8 for T0808, found 8/2"
    assert (result.exit_code, result.stderr) == (2, f"polarcheck: {expected}\n")
    make(polarcheck__toml='[tools."8/1"]\nradius = 4\n')
    assert check("a.nc").exit_code == 0


@looped("option", [":radius=4", '"":radius=4', " /2:radius", "MILL\x1b:radius=4", "MILL:radius", "8/0:radius=4"])
def test_an_option_that_names_no_tool_is_one_clear_line(option: str) -> None:
    with pytest.raises(UsageError, match="--tool"):
        job_of(option)
    make(a__nc="T0808\n")
    result = check("a.nc", "--machine", "siemens-transmit", "--tool", option)
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert "\x1b" not in result.stderr


# ---- rules ----


def test_d_is_no_fault_where_it_calls_an_edge() -> None:
    assert "d-word-on-lathe" not in str(report_of(face("T8 D1"), "siemens-transmit", "8:radius=4").findings)
    assert said(report_of("T0808\nG98 G0 X60. C0\nG12.1\nG1 G41 D8 X40. F200\nC-10.\nG40 X60.\nG13.1\n")) == [
        (4, "d-word-on-lathe")
    ]


@pytest.mark.nightly
@looped("calls", ["T8 D0", "T8 D1\nD0", "T0", 'T="MILL_8" D0'], one_in=3)
def test_without_an_edge_compensation_has_no_radius(calls: str) -> None:
    assert [rule for _, rule in said(report_of(face(calls), "siemens-transmit"))] == ["offset-number-missing"]
    plain = face(calls).replace("G41 ", "").replace("G40 ", "")
    assert [rule for _, rule in said(report_of(plain, "siemens-transmit"))] == ["no-tool-offset-at-entry"]


@pytest.mark.ci
@looped(("word", "named"), [("D2", "T8 edge 2"), ("T9 D1", "T9 edge 1"), ("D0", "T8 edge 0")], one_in=2)
def test_another_edge_is_called_without_compensation_alone(word: str, named: str) -> None:
    tools = [f"{key}:radius=2" for key in ("8", "8/2", "9")]
    found = report_of(face("T8 D1", f"{word}\n"), "siemens-transmit", *tools).findings
    ours = [finding for finding in found if finding.rule == "offset-changed-in-polar"]
    assert [(finding.line, named in finding.message) for finding in ours] == [(9, True)]
    again = report_of(face("T8 D1", "D1\n"), "siemens-transmit", *tools)
    assert "offset-changed-in-polar" not in str(again.findings)
    free = face("T8 D1").replace("G17\n", "G17\nD2\n")
    assert report_of(free, "siemens-transmit", *tools).findings == []


def test_each_contour_has_the_radius_of_its_own_edge() -> None:
    contour = "G1 X40 Y10 F300\nG41 X20\nY-20\nG40 X40\n"
    program = f"T8 D1\nG94 G0 X60 Y0\nDIAMOF\nTRANSMIT\nG17\n{contour}D2\n{contour}TRAFOOF\n"
    trace = trace_of(program, "siemens-transmit", "8/1:radius=4", "8/2:radius=3")
    assert trace.compensation.radius[trace.compensation.side != 40].tolist() == [4.0, 4.0, 3.0, 3.0]


def test_a_named_tool_has_edges_where_numbers_have_offset_digits() -> None:
    program = 'T="MILL_8" D2\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\n'
    found = report_of(program, "siemens-iso", "MILL_8/2:radius=4", "8:radius=3")
    assert [(one.offset, one.radius) for one in found.polar_sections] == [("MILL_8/2", 4.0)]
    plain = report_of(program.replace('T="MILL_8" D2', "T0808"), "siemens-iso", "MILL_8/2:radius=4", "8:radius=3")
    assert [(one.offset, one.radius) for one in plain.polar_sections] == [(8, 3.0)]


@pytest.mark.ci
def test_many_edges_take_no_time_that_grows_with_their_square() -> None:
    program = "".join(f"T{number} D{number % 9 + 1}\n" for number in range(1, 20_001))
    trace = trace_of(program + face("T7 D2"), "siemens-transmit", "7/2:radius=4")
    assert trace.tools.offset_count > 20_000
    assert trace.offsets.radius_of_offset[-1] == 4.0


@pytest.mark.nightly
@looped("word", ["D123456", "D1.5.2", "D", "D-1", "T99999999999999999 D1", "D" + "9" * 400])
def test_strange_words_call_nothing_that_is_known(word: str) -> None:
    found = report_of(face(f"T8 {word}" if word[0] == "D" else word), "siemens-transmit", "8/3:radius=4")
    assert found.polar_sections[0].radius is None
