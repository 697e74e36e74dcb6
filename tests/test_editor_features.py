"""What an editor shows and offers: each feature on a program, without the protocol around it."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from lsprotocol import types
from polarcheck.errors import StoppedError
from test_cli import COMPENSATED, GOOD, RAPID

from polarcheck.commands import server as command
from polarcheck.editor import (
    actions,
    allowing,
    diagnostics,
    go_to_definition,
    hover_text,
    program_markdown,
    section_lenses,
)
from polarcheck.editor.analysis import Analysis, judge
from polarcheck.editor.open_text import OpenText, path_of
from polarcheck.editor.structure.document import Document
from polarcheck.editor.words.completions import completions
from polarcheck.foundation.finding import Edit, FileReport, Fix
from polarcheck.rules.rule import load_all

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

URI = "file:///w/O1.NC"
CALLS = """%
O0001(MAIN)
N10 G98 G0 X60. C0
M98 P2
N20 G65 P3 A1.
IF[#1EQ1]GOTO20
G71 P10 Q20 U0.5
M98 P99
M30
O2
G12.1
G1 X40. F200
G13.1
M99 P10
O0003
M99
%
"""


def settings_of(**asked: Any) -> Any:
    return command._Settings(not asked.pop("use_config", True), asked)


def judged_of(text: str, folders: Sequence[Path] = (), **asked: Any) -> Analysis:
    """A buffer beside the working folder's polarcheck.toml, if there is one."""
    here = Path(os.path.realpath("."))
    return judge(OpenText(text), here / "O1.NC", settings_of(**asked), [here, *folders])


def report_of(judged: Analysis) -> FileReport:
    assert judged.report is not None
    return judged.report


def place(line: int, character: int = 0) -> types.Position:
    """A place by the number of its line in a report."""
    return types.Position(line - 1, character)


def shown(judged: Analysis, line: int, character: int = 0, with_markdown: bool = False) -> str:
    found = hover_text.hover(judged, place(line, character), with_markdown)
    if found is None:
        return ""
    assert isinstance(found.contents, types.MarkupContent)
    return found.contents.value


def state_at(judged: Analysis, line: int, character: int = 0) -> str:
    """The state of the block, which stands below the meaning of the word."""
    return shown(judged, line, character).rpartition("\n\n")[2]


def edited(judged: Analysis, edit: types.WorkspaceEdit | None) -> str:
    """The text with an edit applied, from its end on."""
    assert edit is not None
    changes = edit.changes[URI] if edit.changes else edit.document_changes[0].edits  # type: ignore[index,union-attr]
    text = judged.text
    for change in sorted(changes, key=lambda one: text.offset(one.range.start), reverse=True):  # type: ignore[union-attr]
        assert isinstance(change, types.TextEdit)
        text = text.changed([types.TextDocumentContentChangePartial(change.range, change.new_text)])
    return text.text


# ---- marks ----


def test_findings_are_marked_where_they_stand() -> None:
    judged = judged_of(RAPID, select=["rapid-in-polar"])
    (found,) = diagnostics.diagnostics(judged, URI)
    assert (found.code, found.severity, found.source) == (
        "rapid-in-polar",
        types.DiagnosticSeverity.Error,
        "polarcheck",
    )
    assert found.range == types.Range(place(4, 0), place(4, 2))
    assert found.related_information is not None
    (begins,) = found.related_information
    assert begins.location == types.Location(URI, types.Range(place(2, 0), place(2, 5)))
    assert found.code_description is None


def test_no_mark_means_looked_at_and_good() -> None:
    """What was not evaluated is marked at the section, once for each reason, and goes when it is given."""
    (found,) = diagnostics.diagnostics(judged_of(COMPENSATED, select=["start-up-shorter-than-radius"]), URI)
    assert (found.code, found.severity) == ("not-evaluated", types.DiagnosticSeverity.Information)
    assert found.range.start == place(3)
    assert "no radius for T0101" in found.message
    assert found.message.endswith("[start-up-shorter-than-radius]")
    assert not diagnostics.diagnostics(
        judged_of(COMPENSATED, select=["start-up-shorter-than-radius"], tools=["1:radius=4"]), URI
    )


def test_what_follows_from_a_finding_is_told_beside_it() -> None:
    judged = judged_of(RAPID, select=["rapid-in-polar"])
    (found,) = report_of(judged).findings
    after = msgspec.structs.replace(found, rule="overcut", line=5, end_line=5, message="cut into", section_line=None)
    report = msgspec.structs.replace(report_of(judged), findings=[msgspec.structs.replace(found, follows=[after])])
    (mark,) = diagnostics.diagnostics(judged._replace(report=report), URI)
    assert mark.related_information is not None
    _, follows = mark.related_information
    assert (follows.message, follows.location.range.start) == ("follows from it: cut into [overcut]", place(5))


@looped("end", ["\n", "\r\n", "\r", "\n\r\r"])
def test_marks_are_those_of_any_line_end(end: str) -> None:
    judged = judged_of(("(\U0001f600)" + RAPID).replace("\n", end), select=["rapid-in-polar"])
    (found,) = diagnostics.diagnostics(judged, URI)
    first = judged.text.offset(found.range.start)
    assert judged.text.text[first : judged.text.offset(found.range.end)] == "G0"
    assert judged.text.text[first:].startswith(f"G0 C5.{end}")


def test_settings_that_cannot_be_used_are_a_mark() -> None:
    Path("polarcheck.toml").write_text("machin = 'fanuc'\n", "utf-8")
    (found,) = diagnostics.diagnostics(judged_of(RAPID), URI)
    assert (found.code, found.severity, found.range.start) == ("not-checked", types.DiagnosticSeverity.Error, place(1))
    assert "polarcheck.toml" in found.message
    assert "machin" in found.message


# ---- hover ----


def test_a_finding_shows_its_manual_page() -> None:
    judged = judged_of(RAPID, select=["rapid-in-polar"], machine="fanuc-30i")
    assert shown(judged, 4, 1).startswith("rapid-in-polar (polar, error, alarm PS0146")
    page = shown(judged, 4, 1, True)
    assert page.startswith("**rapid-in-polar**, alarm PS0146\n\n")
    assert "\n    G12.1\n" in page
    assert state_at(judged, 4, 4).startswith("Rapid traverse, in the polar mode since line 2\n")


def test_a_block_shows_what_is_in_force() -> None:
    judged = judged_of(COMPENSATED, tools=["1:radius=4"], changes=["limits.c_feed=3600"])
    assert state_at(judged, 5, 6).startswith("Straight line, in the polar mode since line 3\n")
    facts = dict(line.split(": ", 1) for line in state_at(judged, 5, 6).splitlines()[1:])
    assert (facts["tool offset"], facts["feed"]) == ("1, R 4 mm (command line)", "F 200 mm/min")
    assert facts["compensation"] == "G41, to the left"
    assert facts["position behind it"].startswith("X 40 mm (diameter), C -10 mm (length), Z not known, C axis -")
    assert re.fullmatch(r"\d+ of 3600 deg/min", facts["C axis"])
    assert re.fullmatch(r"[\d.]+ mm", facts["nearest to the center"])
    assert re.fullmatch(r"[\d.]+ mm/min", facts["highest F here"])


def test_a_block_is_shown_in_the_units_of_the_program() -> None:
    inch = "G20 T0101\nG98 G0 X2. C0 Z.5\nG12.1\nG1 X1. F10.\nC.2\nG13.1\nG99 F.004\nM30\n"
    judged = judged_of(inch, tools=["1:radius=0.25"])
    facts = dict(line.split(": ", 1) for line in state_at(judged, 5, 1).splitlines()[1:])
    assert facts["position behind it"].startswith("X 1 inch (diameter), C 0.2 inch (length), Z 0.5 inch, C axis ")
    assert facts["tool offset"] == "1, R 0.25 inch (command line)"
    assert facts["feed"] == "F 10 inch/min"
    assert "feed: F 0.004 inch/rev" in shown(judged, 7)
    assert state_at(judged, 3).startswith("The polar mode begins\n")
    assert state_at(judged, 6).startswith("The polar mode ends\n")
    assert state_at(judged, 8).startswith("No movement, outside the polar mode\n")


def test_a_block_that_runs_several_times_says_so() -> None:
    judged = judged_of("O1\nM98 P30002\nM98 P30002\nM30\nO2\nG0 X60.\nM99\n")
    assert "runs: 6 times; this is the first" in shown(judged, 6)


@looped("line", [1, 2, 4])
def test_what_does_nothing_has_no_state(line: int) -> None:
    assert shown(judged_of("%\n(COMMENT)\nG0 X60.\n\nM30\n%\n"), line) == ""


def test_words_of_a_program_format_nothing() -> None:
    assert program_markdown.plain("a*b _c_ <d>[e](f)`#1`\x1b\n") == r"a\*b \_c\_ \<d\>\[e\](f)\`#1\`\\x1b\\x0a"
    assert program_markdown.plain("F < L * R, limits.c_feed, #1=2") == r"F \< L * R, limits.c_feed, #1=2"
    assert [program_markdown.plain(text) for text in ("# 1", "12. b", "+ c", "12.5 mm")] == [
        r"\# 1",
        r"12\. b",
        r"\+ c",
        "12.5 mm",
    ]
    assert program_markdown.page("- 1\n\n    G1 X[#1*2]\n* x") == "\\- 1\n\n    G1 X[#1*2]\n\\* x"


# ---- sections ----


def test_each_section_tells_what_it_asks_of_the_lathe() -> None:
    judged = judged_of(GOOD + COMPENSATED, tools=["1:radius=4"], changes=["limits.c_feed=3600"])
    first, second = section_lenses.code_lenses(judged)
    assert first.range == types.Range(place(2, 0), place(2, 5))
    assert first.command is not None
    assert second.command is not None
    assert re.fullmatch(r"[\d.]+ s \| C \d+ of 3600 deg/min in line \d \| no tool offset", first.command.title)
    assert second.command.title.endswith(" | R 4.000 mm (offset 1, command line)")
    unknown = section_lenses.code_lenses(judged_of(COMPENSATED))[0].command
    assert unknown is not None
    assert unknown.title == "time not known: no radius in line 4 | rate of C not known | R of offset 1 not known"


# ---- where words lead ----


def lines_led_to(judged: Analysis, line: int, character: int = 0) -> list[int]:
    found = go_to_definition.definition(judged, URI, place(line, character))
    assert all(one.uri == URI for one in found)
    return [one.range.start.line + 1 for one in found]


@looped(
    ("line", "character", "targets"),
    [
        (4, 5, [10]),
        (5, 7, [15]),
        (6, 14, [5]),
        (7, 5, [3]),
        (7, 9, [5]),
        (8, 5, []),
        (14, 5, [3]),
        (3, 2, [3]),
        (3, 6, []),
        (5, 1, [5]),
        (10, 1, [10]),
        (1, 0, []),
    ],
    one_in=3,
)
def test_calls_and_numbers_lead_to_their_blocks(line: int, character: int, targets: list[int]) -> None:
    assert lines_led_to(judged_of(CALLS), line, character) == targets


def test_labels_lead_to_their_blocks() -> None:
    program = "%_N_A_MPF\nANF:\nG0 X60\nIF R1==1 GOTOF ENDE\nGOTOB ANF\nENDE: M30\n"
    judged = judged_of(program, machine="siemens-transmit")
    assert lines_led_to(judged, 4, 18) == [6]
    assert lines_led_to(judged, 5, 7) == [2]
    assert lines_led_to(judged, 2, 1) == [2]


def test_a_number_with_its_letter_leads_to_its_block() -> None:
    judged = judged_of("$A.MIN%\nGOTO N3\nN2 G0 X10\nN3 M02\n", machine="okuma-osp")
    assert lines_led_to(judged, 2, 5) == lines_led_to(judged, 2, 6) == [4]


@pytest.mark.parametrize("text", ["O77(SUB)\nG0 X1.\nM99\n", "%\r\n(HEAD)\r\nO0077\r\nM99\r\n", "G0 X1.\nM99\n"])
def test_a_call_leads_to_the_file_in_the_folders_of_subprograms(text: str) -> None:
    Path("sub").mkdir()
    Path("sub/o77.nc").write_bytes(text.encode())
    Path("polarcheck.toml").write_text('[run]\nsubprograms = ["sub"]\n', "utf-8")
    (found,) = go_to_definition.definition(judged_of("M98 P77\nM30\n"), URI, place(1, 5))
    assert path_of(found.uri) == Path(os.path.realpath("sub/o77.nc"))
    head = text[: text.index("O")] if "O" in text else ""
    assert found.range.start.line == head.count("\n")


# ---- allow comments ----


def test_allowing_writes_the_comment_at_the_end_of_the_block() -> None:
    judged = judged_of(RAPID.replace("G0 C5.", "G0 C5. (SLOT)  "), select=["rapid-in-polar"])
    *_, action = actions.actions(judged, URI, 3, types.Range(place(4, 1), place(4, 1)), False)
    assert action.title == "Allow rapid-in-polar here"
    assert action.is_preferred is None
    assert "\nG0 C5. (SLOT) (POLARCHECK ALLOW RAPID-IN-POLAR )  \n" in edited(judged, action.edit)


@looped("end", ["\n", "\r\n", "\r"])
def test_allowing_goes_before_a_comment_that_is_not_closed(end: str) -> None:
    judged = judged_of(RAPID.replace("G0 C5.", "G0 C5. (SLOT").replace("\n", end), select=["rapid-in-polar"])
    *_, action = actions.actions(judged, URI, 3, types.Range(place(4, 1), place(4, 1)), False)
    assert f"{end}(POLARCHECK ALLOW RAPID-IN-POLAR ){end}G0 C5. (SLOT{end}" in edited(judged, action.edit)


@looped(
    ("block", "written"),
    [
        ("G0 C5.", "\nG0 C5. ; POLARCHECK ALLOW RAPID-IN-POLAR \n"),
        ("G0 C5. ; SLOT", "\n; POLARCHECK ALLOW RAPID-IN-POLAR \nG0 C5. ; SLOT\n"),
    ],
)
def test_allowing_is_written_as_the_control_writes_comments(block: str, written: str) -> None:
    judged = judged_of(RAPID.replace("G0 C5.", block), machine="siemens-iso", select=["rapid-in-polar"])
    *_, action = actions.actions(judged, URI, 3, types.Range(place(4, 1), place(4, 1)), False)
    assert written in edited(judged, action.edit)


def test_fixes_are_offered_with_what_they_are_for() -> None:
    judged = judged_of(RAPID, select=["rapid-in-polar"])
    report = report_of(judged)
    edits = [
        Edit(line=4, column=1, end_line=4, end_column=3, text="G1"),
        Edit(line=5, column=1, end_line=5, end_column=3, text="G01"),
    ]
    for safe in (True, False):
        fixed = msgspec.structs.replace(report.findings[0], fix=Fix(title="Write G1", safe=safe, edits=edits))
        found = judged._replace(report=msgspec.structs.replace(report, findings=[fixed]))
        action, _ = actions.actions(found, URI, 3, types.Range(place(4, 0), place(4, 2)), True)
        assert action.title == ("Write G1" if safe else "Write G1 (moves an axis: look at it)")
        assert action.is_preferred is (True if safe else None)
        assert edited(found, action.edit) == RAPID.replace("G0 C5.\nG1 ", "G1 C5.\nG01 ")
        assert action.edit is not None
        assert action.edit.document_changes is not None
        (change,) = action.edit.document_changes
        assert isinstance(change, types.TextDocumentEdit)
        assert change.text_document.version == 3
    assert not actions.actions(judged, URI, 3, types.Range(place(1, 0), place(3, 2)), True)


def test_the_fix_of_a_finding_is_offered() -> None:
    dash = RAPID.replace("C-5.", "C\u20135.").replace("G0 C5.", "C5.")
    judged = judged_of(dash, select=["wrong-dash"])
    first, second = actions.actions(judged, URI, 3, types.Range(place(5, 3), place(5, 3)), True)
    assert edited(judged, first.edit) == dash.replace("\u2013", "-")
    assert first.is_preferred is True
    assert first.diagnostics == diagnostics.diagnostics(judged, URI)
    assert second.title == "Allow wrong-dash here"


def test_where_allow_comments_are_not_heeded_none_is_offered() -> None:
    judged = judged_of(RAPID, select=["rapid-in-polar"], inline=False)
    titles = [one.title for one in actions.actions(judged, URI, 3, types.Range(place(4, 1), place(4, 1)), False)]
    assert "Allow rapid-in-polar here" not in titles


def test_what_is_allowed_is_no_mark() -> None:
    judged = judged_of(RAPID, select=["rapid-in-polar"])
    action = actions.actions(judged, URI, 3, types.Range(place(4, 1), place(4, 1)), False)[-1]
    allowed = judged_of(edited(judged, action.edit), select=["rapid-in-polar"])
    assert not diagnostics.diagnostics(allowed, URI)
    assert [found.rule for found in report_of(allowed).silenced] == ["rapid-in-polar"]


def labels(text: str, judged: Analysis | None = None) -> list[str]:
    """What is offered at the |."""
    before, _, after = text.partition("|")
    opened = OpenText(before + after)
    items = allowing.completions(opened, opened.position(len(before)), judged)
    return [item.label for item in sorted(items, key=lambda item: item.sort_text or "")]


@looped(
    "text",
    [
        "G0 X1. (POLARCHECK ALLOW |",
        "G0 X1. (POLARCHECK ALLOW RAPID-IN|",
        "(polarcheck allow-file rapid-in-polar, |)",
        "; POLARCHECK ALLOW-ON OVERCUT, R|",
        "(POLARCHECK: ALLOW: |)",
    ],
)
def test_names_are_completed_in_an_allow_comment(text: str) -> None:
    found = labels(text)
    assert "RAPID-IN-POLAR" in found
    assert "COMPENSATION" in found
    assert len(found) > len(load_all())


@looped(
    "text",
    [
        "G0 |",
        "(POLAR |",
        "(ALLOW |",
        "(POLARCHECK) ALLOW |",
        "(POLARCHECK ALLOW|",
        "(POLARCHECK ALLOW OVERCUT PROVEN ON |",
    ],
)
def test_elsewhere_no_name_is_completed(text: str) -> None:
    assert "RAPID-IN-POLAR" not in labels(text)


def test_the_words_of_the_comment_are_completed_too() -> None:
    assert labels("(POLARCHECK |") == ["ALLOW", "ALLOW-FILE", "ALLOW-ON", "ALLOW-OFF"]


def test_rules_with_a_finding_here_come_first() -> None:
    judged = judged_of(RAPID, select=["rapid-in-polar"])
    assert labels(RAPID.replace("G0 C5.", "G0 C5. (POLARCHECK ALLOW |)"), judged)[0] == "RAPID-IN-POLAR"


def test_what_is_typed_is_replaced_and_the_page_comes_later() -> None:
    opened = OpenText("(POLARCHECK ALLOW rapid-in)")
    items = allowing.completions(opened, types.Position(0, 26), None)
    (item,) = (item for item in items if item.label == "RAPID-IN-POLAR")
    assert isinstance(item.text_edit, types.TextEdit)
    assert opened.changed(
        [types.TextDocumentContentChangePartial(item.text_edit.range, item.text_edit.new_text)]
    ).text == ("(POLARCHECK ALLOW RAPID-IN-POLAR )")
    assert item.documentation is None
    resolved = allowing.with_page(item, True).documentation
    assert isinstance(resolved, types.MarkupContent)
    assert "G12.1" in resolved.value


# ---- any text, and what nobody vouches for ----


@pytest.mark.nightly
@settings(max_examples=25, deadline=None)
@given(
    st.lists(
        st.sampled_from(
            [
                *CALLS.splitlines(),
                *COMPENSATED.splitlines(),
                "\r",
                "\x85",
                "\ud800",
                "(",
                "%",
                "$1",
                "O",
                "WHILE[#1",
                "#1=#2+G1",
                "GOTO",
                "T=",
                "M98 P",
                "\0",
                "\u2028G0",
                "",
            ]
        ),
        max_size=14,
    ),
    st.sampled_from(["fanuc", "siemens-transmit", "citizen"]),
)
def test_any_text_gives_answers(lines: list[str], machine: str) -> None:
    text = "\n".join(lines)
    judged = judge(OpenText(text), Path("/w/O1.NC"), settings_of(machine=machine, use_config=False), [])
    diagnostics.diagnostics(judged, URI)
    section_lenses.code_lenses(judged)
    for line in range(len(lines) + 2):
        for character in (0, 4, 9):
            at = types.Position(line, character)
            hover_text.hover(judged, at, True)
            go_to_definition.definition(judged, URI, at)
            actions.actions(judged, URI, 1, types.Range(at, at), True)
            allowing.completions(judged.text, at, judged)
            assert judged.settings is not None
            document = Document(URI, judged.path, judged.text, judged.settings.machine)
            completions(document, judged.settings, at)


def test_a_stopped_check_has_no_outcome() -> None:
    with pytest.raises(StoppedError):
        judge(OpenText(RAPID), Path("O1.NC"), settings_of(), [], lambda: True)


@pytest.mark.parametrize(
    ("job", "told"),
    [
        ('offsets = "../table.txt"', "offsets: ../table.txt"),
        ('machine = "../lathe.toml"', "lathe.toml"),
    ],
)
def test_settings_lead_nowhere_outside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, job: str, told: str) -> None:
    """Nobody vouches for a job file that came with the programs: it reads nothing from elsewhere."""
    (tmp_path / "table.txt").write_text("%\nG10 P1 R4.\n%\n", "utf-8")
    (tmp_path / "lathe.toml").write_text('inherits = "fanuc"\n', "utf-8")
    (tmp_path / "w").mkdir()
    monkeypatch.chdir(tmp_path / "w")
    Path("polarcheck.toml").write_text(job + "\n", "utf-8")
    judged = judged_of(GOOD)
    assert told in judged.error
    assert "lies outside the folders that are open" in judged.error
    assert judged_of(GOOD, [Path(os.path.realpath(tmp_path))]).report is not None


def test_job_files_above_the_folder_that_is_open_are_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "polarcheck.toml").write_text("machin = 1\n", "utf-8")
    (tmp_path / "w").mkdir()
    monkeypatch.chdir(tmp_path / "w")
    assert judged_of(GOOD).error == ""
    assert "machin" in judged_of(GOOD, [Path(os.path.realpath(tmp_path))]).error


def test_called_programs_come_from_the_folders_that_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever they lie: a file there is opened if a call names it, and by no other name."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "O77.NC").write_text("O77\nG0 C5.\nM99\n", "utf-8")
    (tmp_path / "w").mkdir()
    monkeypatch.chdir(tmp_path / "w")
    Path("polarcheck.toml").write_text('[run]\nsubprograms = ["../sub"]\n', "utf-8")
    judged = judged_of(RAPID.replace("G0 C5.", "M98 P77"), select=["rapid-in-polar"])
    assert [found.line for found in report_of(judged).findings] == [4]
    assert os.path.realpath("../sub/O77.NC") in judged.read
