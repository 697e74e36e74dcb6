"""Reports of findings made by hand, some of them hostile."""

from __future__ import annotations

import json
import math
import re
import unicodedata
from typing import Any

import jsonschema
import msgspec
import pytest
from cases import looped
from hypothesis import given
from hypothesis import strategies as st

from polarcheck.files.batch import tasks as batch
from polarcheck.foundation.finding import Edit, FileReport, Finding, Fix, NotEvaluated, Report
from polarcheck.program.reading.excerpt import Excerpt, cells, excerpt, visible
from polarcheck.reports import Background, formats, render
from polarcheck.reports.pages import json_schema
from polarcheck.reports.text import first_sentence
from polarcheck.rules.rule import load_all


def finding(**changes: Any) -> Finding:
    given = {
        "rule": "rapid-in-polar",
        "severity": "error",
        "message": "G0 cannot be used in the polar mode",
        "line": 12,
        "column": 1,
        "end_line": 12,
        "end_column": 3,
        "block": "G0 X1.8",
        "program": "O0001",
        "section_line": 9,
        "alarm": "PS0146",
    }
    given.update(changes)
    given.setdefault("end_line", given["line"])
    return Finding(**given)


def missing(rule: str = "interference", reason: str = "no radius for T0808", blocks: int = 14) -> Any:
    return NotEvaluated(rule=rule, reason=reason, blocks=blocks)


def file(*findings: Finding, path: str = "a.nc", **changes: Any) -> FileReport:
    verdict = "fail" if findings else "pass"
    given = {
        "path": path,
        "machine": "fanuc",
        "programs": ["O0001"],
        "blocks": 40,
        "sections": 1,
        "verdict": verdict,
        "not_evaluated": [],
    }
    return FileReport(**{**given, "findings": list(findings), **changes})


def report(*files: FileReport) -> Report:
    return batch.report(list(files), "fanuc")


def text(*files: FileReport, lines: dict[int, str] | None = None, **changes: Any) -> str:
    shown = {file.path: lines or {9: "G12.1", 12: "G0 X1.8"} for file in files}
    return render("text", report(*files), Background(shown, load_all(), **changes))


# ---- text ----


def test_a_finding_shows_what_where_and_why() -> None:
    assert (
        text(file(finding()))
        == """\
error: G0 cannot be used in the polar mode
    at   a.nc:12:1
     9 | G12.1
    12 | G0 X1.8
       | ^^
  rule   rapid-in-polar, alarm PS0146
   why   The control stops with an alarm at a block with G0, and at a move without a code of its own
         while G0 is still in force, as after the approach.

fail  a.nc: 1 error, 1 polar section, 40 blocks

1 file checked for fanuc; 1 error
More about a rule: polarcheck explain rapid-in-polar
"""
    )


def test_why_is_said_once_for_each_rule() -> None:
    shown = text(file(finding(), finding(line=14, end_line=14)), file(finding(), path="b.nc"))
    assert shown.count("error: G0") == 3
    assert shown.count("   why") == 1


def test_what_several_rules_miss_is_said_once_with_all_their_names() -> None:
    gaps = [missing(), missing("overcut", blocks=20), missing("c-feed-above-limit", "the feed is not known")]
    shown = text(file(not_evaluated=gaps, verdict="unverified"))
    assert (
        shown
        == """\
not evaluated: no radius for T0808
    at   a.nc, 20 blocks
 rules   interference, overcut

not evaluated: the feed is not known
    at   a.nc, 14 blocks
  rule   c-feed-above-limit

unverified  a.nc: no findings, 1 polar section, 40 blocks

1 file checked for fanuc; no findings
"""
    )


def test_of_many_files_those_that_pass_are_counted() -> None:
    gaps = [missing()]
    files = [file(path=f"{number}.nc", sections=0) for number in range(20)]
    files += [file(path=f"x{number}.nc", not_evaluated=gaps, verdict="unverified") for number in range(5)]
    assert (
        text(*files)
        == """\
not evaluated: no radius for T0808
    at   x0.nc, 14 blocks
    at   x1.nc, 14 blocks
    at   x2.nc, 14 blocks
         and in 2 more files
  rule   interference

unverified  x0.nc: no findings, 1 polar section, 40 blocks
unverified  x1.nc: no findings, 1 polar section, 40 blocks
unverified  x2.nc: no findings, 1 polar section, 40 blocks
unverified  x3.nc: no findings, 1 polar section, 40 blocks
unverified  x4.nc: no findings, 1 polar section, 40 blocks

25 files checked for fanuc: 5 unverified, 20 pass (no polar section); no findings
"""
    )


def test_a_program_without_polar_mode_is_said_to_have_none() -> None:
    assert "pass (no polar section)  a.nc: no findings, 40 blocks\n" in text(file(sections=0))
    assert "fail  a.nc: 1 error, no polar section, 40 blocks\n" in text(file(finding(), sections=0))
    assert "unverified  a.nc: no findings, no polar section" in text(file(sections=0, verdict="unverified"))
    assert (
        text(file(), file(path="b.nc", sections=0))
        == """\
pass                     a.nc: no findings, 1 polar section, 40 blocks
pass (no polar section)  b.nc: no findings, 40 blocks

2 files checked for fanuc: 2 pass (1 with no polar section); no findings
"""
    )


def test_machines_are_named_by_file_where_they_differ() -> None:
    files = [file(finding(severity="warning"), machine="fanuc-16i"), file(path="b.nc", machine="mine/n\x1bl.toml")]
    shown = text(*files)
    assert "fail  a.nc: 1 warning, 1 polar section, 40 blocks, for fanuc-16i\n" in shown
    assert "pass  b.nc: no findings, 1 polar section, 40 blocks, for mine/n\\x1bl.toml\n" in shown
    assert "\n2 files checked for 2 machines: 1 fail, 1 pass; 1 warning\n" in shown
    told = json.loads(render("json", report(*files), Background()))
    assert told["machine"] is None
    assert [checked["machine"] for checked in told["files"]] == ["fanuc-16i", "mine/n\x1bl.toml"]
    alike = report(*(msgspec.structs.replace(checked, machine="okuma-osp") for checked in files))
    assert alike.machine == "okuma-osp"
    assert "2 files checked for okuma-osp: 1 fail, 1 pass; 1 warning" in render("text", alike, Background())
    assert ", for okuma-osp" not in render("text", alike, Background())
    assert report().machine == "fanuc"


def test_program_count_and_fix_are_shown() -> None:
    fix = Fix(title="write G1", safe=False, edits=[Edit(line=12, column=1, end_line=12, end_column=3, text="G1")])
    shown = text(file(finding(count=7, fix=fix), programs=["O0001", "O0002"]))
    assert "    at   a.nc:12:1, program O0001, in 7 runs of the block\n" in shown
    assert "   fix   write G1 (look at it first: --diff --unsafe-fixes)\n" in shown
    assert shown.splitlines()[-2] == "1 file checked for fanuc; 1 error"


def test_quiet_is_findings_only() -> None:
    shown = text(file(finding(), not_evaluated=[missing()]), file(path="b.nc"), quiet=True)
    assert shown.startswith("error: G0 cannot be used in the polar mode\n    at   a.nc:12:1\n")
    assert not re.search("not evaluated|pass|fail|checked|explain", shown)
    assert text(file(), quiet=True) == ""


def test_no_line_is_wider_than_the_terminal() -> None:
    long = finding(message="the tool " * 30, line=12, column=400, end_column=420, end_line=12)
    gaps = [missing(f"some-rule-{number}", "no radius " * 20) for number in range(30)]
    for columns in (60, 80, 100):
        shown = text(file(long, not_evaluated=gaps), lines={9: "G12.1", 12: "X" * 900}, columns=columns)
        assert max(map(len, shown.splitlines())) <= columns
        assert re.search(r"^       \| +\^{20}$", shown, re.MULTILINE)


def test_color_changes_nothing_but_color() -> None:
    files = [file(finding(severity=level), not_evaluated=[missing()]) for level in ("error", "warning", "note")]
    colored = text(*files, color=True)
    assert "\x1b[1;31merror\x1b[0m: \x1b[1mG0" in colored
    assert re.sub(r"\x1b\[[\d;]*m", "", colored) == text(*files)


def test_first_sentences_end_where_a_reader_would_end_them() -> None:
    assert first_sentence("Title.\n\nG12.1 is on, e.g. Y or i.e. C; see p. 51 for 0.5 mm\nof it. Next.") == (
        "G12.1 is on, e.g. Y or i.e. C; see p. 51 for 0.5 mm of it."
    )
    assert first_sentence("Title.") == ""
    for rule in load_all().values():
        assert first_sentence(rule.page).endswith("."), rule.name


# ---- excerpts ----


def underlined(line: str, start: int, end: int, room: int = 80) -> str:
    """What stands above the marks, cell by cell."""
    shown = excerpt(line, start, end, room)
    grid: list[str] = []
    for character in shown.text:
        width = cells(character)
        if width:
            grid += [character, *[""] * (width - 1)]
        else:
            grid[-1] += character
    return "".join(grid[shown.first : shown.first + shown.marked])


@looped(
    ("line", "fault", "marked"),
    [
        ("G0 X1.8", "X1.8", "X1.8"),
        ("\tG0\tX1.8", "X1.8", "X1.8"),
        ("(\u89d2\u5ea6) X1.8", "X1.8", "X1.8"),
        ("(\u89d2\u5ea6) X1.8", "\u5ea6", "\u5ea6"),
        ("(a\u0308) X1.8", "X1.8", "X1.8"),
        ("(\x1b[2J) X1.8", "X1.8", "X1.8"),
        ("X\x851.8", "\x85", "\\x85"),
        ("\r\rG0 X1.8", "G0", "G0"),
        ("X" * 500 + "G0" + "Y" * 500, "G0", "G0"),
    ],
)
def test_marks_stand_under_the_words_at_fault(line: str, fault: str, marked: str) -> None:
    start = line.index(fault)
    assert underlined(line, start, start + len(fault)) == marked


def test_a_fault_at_the_end_of_a_line_is_marked_behind_it() -> None:
    assert excerpt("G0 X1.", 6, 7, 80) == Excerpt("G0 X1.", 6, 1)
    assert excerpt("", 0, 1, 80) == Excerpt("", 0, 1)


def test_a_long_line_is_cut_around_the_fault() -> None:
    line = "".join(f"X{number}. " for number in range(1000))
    start = line.index("X500.")
    shown = excerpt(line, start, start + 5, 60)
    assert shown.text.startswith("...")
    assert shown.text.endswith("...")
    assert cells(shown.text) == 60
    assert underlined(line, start, start + 5, 60) == "X500."
    assert excerpt("X" * 60, 0, 1, 60).text == "X" * 60
    assert excerpt("X" * 60, 55, 60, 60) == Excerpt("X" * 60, 55, 5)


@pytest.mark.nightly
@given(st.text(max_size=80), st.integers(0, 90), st.integers(1, 20), st.integers(20, 60))
def test_excerpts_of_anything_are_one_harmless_line(line: str, start: int, length: int, room: int) -> None:
    shown = excerpt(line, start, start + length, room)
    assert shown.text.isprintable()
    assert cells(shown.text) <= room
    assert shown.first >= 0
    assert shown.marked >= 1
    assert shown.first + shown.marked <= room + 1


# ---- what comes from a program is data ----

DIRECTIONS = ("LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI")
HOSTILE = "G0\x1b[2J\x07\x00\r\n\x9b31m\u202eX\u2066\ufeff [red]<b>%0A::error::"


@looped("form", formats())
def test_nothing_from_a_program_acts_on_a_terminal(form: str) -> None:
    found = finding(message=HOSTILE, block=HOSTILE, program=HOSTILE, alarm=HOSTILE, rule=HOSTILE)
    gap = missing(HOSTILE, HOSTILE)
    bad = file(found, path=HOSTILE, programs=[HOSTILE, "O2"], not_evaluated=[gap])
    background = Background({HOSTILE: {9: HOSTILE, 12: HOSTILE}}, load_all())
    shown = render(form, report(bad), background)
    for line in shown.split("\n"):
        assert not [c for c in line if unicodedata.category(c) == "Cc" or unicodedata.bidirectional(c) in DIRECTIONS]
        # JSON may hold letters that no font has.
        assert form in ("json", "jsonl", "sarif", "gitlab") or line.isprintable()
    assert shown.count("\n") == len(shown.splitlines())


def test_visible_keeps_letters_of_all_languages() -> None:
    assert visible("Stra\u00dfe \u89d2\u5ea6 \u0441") == "Stra\u00dfe \u89d2\u5ea6 \u0441"
    assert visible("a\tb\x1b\u202e\U000e0001\u00a0") == "a\\x09b\\x1b\\u202e\\U000e0001\\xa0"


# ---- concise ----


def test_concise_is_one_line_for_each_finding() -> None:
    files = [file(finding(), finding(line=13, column=4, severity="note", rule="x")), file(path="b c.nc")]
    assert render("concise", report(*files), Background()) == (
        "a.nc:12:1: error: G0 cannot be used in the polar mode [rapid-in-polar]\n"
        "a.nc:13:4: note: G0 cannot be used in the polar mode [x]\n"
    )


# ---- short ----


def test_short_is_the_lines_of_concise_and_what_to_run_next() -> None:
    files = [file(), file(finding(), path="b c.nc"), file(finding(severity="note"), path="d.nc", verdict="pass")]
    files += [file(path="e.nc", verdict="unverified", not_evaluated=[missing()]), file(finding(), path="f.nc")]
    shown = render("short", report(*files), Background(command="polarcheck check --machine fanuc"))
    assert shown == render("concise", report(*files), Background()) + (
        """
5 files checked for fanuc: 2 fail, 1 unverified, 2 pass; 2 errors, 1 note
What is wrong with one of them, in full: polarcheck check --machine fanuc 'b c.nc'
Why one of them is unverified: polarcheck check --machine fanuc e.nc
"""
    )
    colored = render("short", report(*files), Background(color=True, command="polarcheck check --machine fanuc"))
    assert "b c.nc:12:1: \x1b[1;31merror\x1b[0m: G0" in colored
    assert re.sub(r"\x1b\[[\d;]*m", "", colored) == shown
    assert render("short", report(*files), Background(quiet=True)) == render("concise", report(*files), Background())


def test_short_has_nothing_to_add_where_all_pass_and_nothing_to_run_for_standard_input() -> None:
    assert render("short", report(file(), file(path="b.nc")), Background()) == (
        "2 files checked for fanuc: 2 pass; no findings\n"
    )
    assert "in full" not in render("short", report(file(finding(), path="-")), Background())
    assert render("short", report(), Background()) == ""


# ---- json ----


def test_json_is_the_contract() -> None:
    shown = json.loads(render("json", report(file(finding(), not_evaluated=[missing()])), Background()))
    assert list(shown) == ["schema", "tool", "machine", "settings", "files", "summary"]
    assert list(shown["tool"]) == ["name", "version"]
    assert list(shown["summary"]) == [
        *("files", "errors", "warnings", "notes", "silenced", "pass", "unverified", "fail", "unreadable"),
        *("not_read", "excluded"),
    ]
    (checked,) = shown["files"]
    keys = [
        "path",
        "machine",
        "programs",
        "blocks",
        "sections",
        "verdict",
        "sha256",
        "profile_sha256",
        "doubtful",
        "polar_sections",
        "findings",
        "not_evaluated",
        "looked_at",
        "silenced",
        "stock",
    ]
    assert list(checked) == keys
    keys = "rule severity message line column end_line end_column block program section_line alarm values count source"
    assert list(checked["findings"][0]) == [*keys.split(), "fingerprint", "fix", "follows"]
    assert list(checked["not_evaluated"][0]) == ["rule", "reason", "blocks", "matters"]


def test_verdicts_are_counted() -> None:
    files = [file(finding()), file(), file(verdict="unverified", not_evaluated=[missing()]), file(finding())]
    told = json.loads(render("json", report(*files), Background()))["summary"]
    assert told == {
        "files": 4,
        "errors": 2,
        "warnings": 0,
        "notes": 0,
        "silenced": 0,
        "pass": 1,
        "unverified": 1,
        "fail": 2,
        "unreadable": 0,
        "not_read": [],
        "excluded": 0,
    }


def test_json_never_holds_nan() -> None:
    shown = render("json", report(file(finding(values={"radius": math.nan, "limit": math.inf}))), Background())
    assert json.loads(shown, parse_constant=pytest.fail)["files"][0]["findings"][0]["values"]["radius"] is None


def test_json_spells_out_half_characters() -> None:
    shown = render("json", report(file(finding(message="\ud800", values={"text": ["\udcff"]}))), Background())
    found = json.loads(shown.encode())["files"][0]["findings"][0]
    assert found["message"] == "\\ud800"
    assert found["values"]["text"] == ["\\udcff"]


def test_json_fits_its_schema_and_the_schema_can_refuse() -> None:
    fix = Fix(title="write G1", safe=True, edits=[Edit(line=1, column=1, end_line=1, end_column=3, text="G1")])
    shown = json.loads(
        render(
            "json",
            report(file(finding(fix=fix, values={"radius": 9.525, "offset": "MILL_8/1"}), not_evaluated=[missing()])),
            Background(),
        )
    )
    check = jsonschema.Draft202012Validator(json_schema.schema("report"))
    check.validate(shown)
    for change in ({"schema": 1}, {"files": [{**shown["files"][0], "verdict": "good"}]}, {"machine": 3}):
        assert not check.is_valid({**shown, **change})
    (checked,) = shown["files"]
    for values in ({"radius": "9.525"}, {"radius": None}, {"offset": 1.5}, {"other_line": "8"}, {"rpm": 3}):
        changed = {**checked, "findings": [{**checked["findings"][0], "values": values}]}
        assert not check.is_valid({**shown, "files": [changed]}), values
