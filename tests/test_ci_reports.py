"""Reports for CI, of findings with nasty text, each held against the schema of its readers or read as they read it."""

from __future__ import annotations

import json
import os
import re
import xml.etree.ElementTree as ElementTree
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

import jsonschema
import markdown_it
import msgspec
import pytest
import xmlschema
from cases import looped
from hypothesis import given
from hypothesis import strategies as st
from test_cli import COMPENSATED, GOOD, RAPID, RAPID_ONLY, call, check, make
from test_reports import file, finding, missing, report

from polarcheck.foundation.finding import Edit, FileReport, Fix, Silenced, Undecided
from polarcheck.program.reading import files
from polarcheck.program.reading.excerpt import visible, without_commands
from polarcheck.program.reading.file_names import spelled, unspelled
from polarcheck.reports import PER_FILE, Background, formats, pieces, render
from polarcheck.reports.ci import rule_help
from polarcheck.reports.ci.repository_paths import from_root, uri
from polarcheck.reports.ci.step_summary import step_summary
from polarcheck.reports.github import MOST
from polarcheck.rules.rule import load_all

pytestmark = pytest.mark.usefixtures("own_folder")

SCHEMAS = Path(__file__).parent / "schemas"
#: Formats that hold many programs.
OF_MANY = [form for form in formats() if form not in PER_FILE]
#: What ends or begins something in one of the formats, what acts on a terminal, and what XML and UTF-8 cannot hold.
NASTY = (
    "100% a:b,c;d\r\ne <b>&amp;\"'[x](1) ]]> |`*_ \u00e4\u00d6\u00df \u89d2 \x1b[31m \x00\x1a\x12 \ud800 "
    "::error:: ##[add-path]x"
)
#: As the system has it: a blank, a backslash, marks of addresses, what acts, a byte that is no character.
RAW_NAME = 'a b#\u00fc\\x%41:,?<"\x1b\n\udcff.nc'
NASTY_PATH = files.display_path(f"part s/{RAW_NAME}")
CI_FORMATS = ("checkstyle", "github", "gitlab", "jsonl", "junit", "sarif")


def nasty(**changes: Any) -> FileReport:
    fix = Fix(title=NASTY, safe=False, edits=[Edit(line=12, column=1, end_line=12, end_column=3, text=NASTY)])
    given = {"message": NASTY, "block": NASTY, "program": NASTY, "alarm": NASTY, "source": NASTY, "fix": fix}
    bad = finding(**{**given, "values": {"text": NASTY}, **changes})
    gap = missing("overcut", NASTY)
    known = silenced(message=NASTY, reason=NASTY, by="allow")
    return file(bad, finding(line=3, rule=NASTY), path=NASTY_PATH, not_evaluated=[gap], silenced=[known])


def silenced(**changes: Any) -> Silenced:
    plain = msgspec.structs.asdict(finding(line=changes.pop("line", 5)))
    return Silenced(**{**plain, "by": "allow", "reason": "proven on the lathe", **changes})


def unread(reason: str, path: str = "gone.nc") -> FileReport:
    return file(path=path, programs=[], blocks=0, sections=0, verdict="unreadable", reason=reason)


def background(**changes: Any) -> Background:
    return Background(rules=load_all(), **changes)


def shown(form: str, *of: FileReport, **changes: Any) -> str:
    return render(form, report(*of), background(**changes))


@cache
def schema(name: str) -> Any:
    return jsonschema.Draft202012Validator(json.loads((SCHEMAS / f"{name}.json").read_text("utf-8")))


def sarif(*of: FileReport, **changes: Any) -> Any:
    """The one run, which fits the schema."""
    log = json.loads(shown("sarif", *of, **changes))
    schema("sarif").validate(log)
    return log["runs"][0]


@cache
def junit_schema() -> Any:
    return xmlschema.XMLSchema10(os.fspath(SCHEMAS / "junit-10.xsd"))


def junit(*of: FileReport, **changes: Any) -> ElementTree.Element:
    """The root, which fits the schema, and whose counts are those of its tests."""
    text = shown("junit", *of, **changes)
    junit_schema().validate(text)
    root = ElementTree.fromstring(text)  # noqa: S314  our own
    for suite in (root, *root.iter("testsuite")):
        for name, tag in (("tests", "testcase"), ("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
            if name in suite.attrib:
                assert int(suite.attrib[name]) == len(list(suite.iter(tag))), (suite.attrib, name)
    return root


def outcomes(root: ElementTree.Element) -> dict[tuple[str, str], str]:
    """By file and group: the tag of what a test holds, passed where it holds nothing."""
    return {
        (case.attrib["name"], case.attrib["classname"].removeprefix("polarcheck.")): next(
            (part.tag for part in case if part.tag != "system-out"), "passed"
        )
        for case in root.iter("testcase")
    }


# ---- all of them ----


@looped("form", CI_FORMATS)
def test_nasty_text_is_no_fault_and_all_is_the_same_twice(form: str) -> None:
    text = shown(form, nasty(), file(path="b.nc"), unread(NASTY, path="n.nc"))
    assert text == shown(form, nasty(), file(path="b.nc"), unread(NASTY, path="n.nc"))
    assert text.encode().decode("utf-8") == text
    assert text.endswith("\n")


@pytest.mark.one_in(12)
@pytest.mark.ci
@pytest.mark.parametrize("form", OF_MANY)
def test_the_exit_code_is_that_of_the_text(form: str) -> None:
    make(a__nc=RAPID, b__nc=GOOD, c__nc=COMPENSATED)
    assert check("a.nc", "b.nc", *RAPID_ONLY, "--format", form).exit_code == 1
    assert check("b.nc", *RAPID_ONLY, "--format", form).exit_code == 0
    assert check("a.nc", *RAPID_ONLY, "--fail-on", "never", "--format", form).exit_code == 0
    assert check("c.nc", "--select", "overcut", "--strict", "--format", form).exit_code == 1
    assert check("b.nc", "gone.nc", *RAPID_ONLY, "--format", form).exit_code == 2
    assert check("b.nc", *RAPID_ONLY, "-o", f"{form}:out.txt").exit_code == 0
    assert Path("out.txt").read_bytes() == check("b.nc", *RAPID_ONLY, "--format", form).stdout_bytes


def test_several_reports_are_written_at_once() -> None:
    make(a__nc=RAPID)
    outputs = [word for form in CI_FORMATS for word in ("-o", f"{form}:report.{form}")]
    assert check("a.nc", *RAPID_ONLY, *outputs).exit_code == 1
    for form in CI_FORMATS:
        assert "rapid-in-polar" in Path(f"report.{form}").read_text("utf-8")


def test_formats_for_people_stand_first() -> None:
    assert formats()[:3] == ["text", "short", "concise"]
    assert formats()[3:] == sorted(formats()[3:])
    assert {*CI_FORMATS, "json", *PER_FILE} == {*formats()[3:]}


# ---- paths ----


@pytest.mark.ci
@given(st.text(st.characters(codec=None) | st.sampled_from("\\xuU0af"), max_size=20))
def test_what_is_spelled_out_of_a_name_can_be_read_back(name: str) -> None:
    assert unspelled(spelled(name)) == name


@looped(
    ("path", "expected"),
    [
        ("a.nc", "nc/lathe 3/a.nc"),
        ("./a.nc", "nc/lathe 3/a.nc"),
        ("../a.nc", "nc/a.nc"),
        ("../../a.nc", "a.nc"),
        ("/work/nc/a.nc", "nc/a.nc"),
        ("/work/../other/a.nc", "/other/a.nc"),
        ("../../../a.nc", "/a.nc"),
        ("/works/a.nc", "/works/a.nc"),
        ("-", "-"),
    ],
)
def test_paths_begin_at_the_root_of_the_repository(path: str, expected: str) -> None:
    known = background(root="/work", folder="/work/nc/lathe 3")
    assert from_root(path, known) == expected
    address = uri(path, known)
    assert unquote(address) == (f"file://{expected}" if expected.startswith("/") else expected)
    assert " " not in address


def test_drives_and_unknown_folders_are_paths_too() -> None:
    windows = background(root="C:/work", folder="C:/work/nc")
    assert uri("C:/work/nc/a b.nc", windows) == "nc/a%20b.nc"
    assert uri("a.nc", windows) == "nc/a.nc"
    assert uri("D:/a b.nc", windows) == "file:///D:/a%20b.nc"
    assert uri("\ud800.nc", windows) == "nc/%ED%A0%80.nc"
    assert from_root("./a.nc", background()) == "a.nc"
    assert from_root("../a.nc", background()) == "../a.nc"


def test_a_folder_of_a_repository_is_not_its_root(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("sub").mkdir()
    Path(".git").mkdir()
    Path("sub", "a.nc").write_text(RAPID)
    monkeypatch.chdir("sub")
    entries = json.loads(check("a.nc", *RAPID_ONLY, "--format", "gitlab").stdout)
    assert [entry["location"]["path"] for entry in entries] == ["sub/a.nc"]


# ---- sarif ----


def test_sarif_fits_its_schema_and_the_schema_can_refuse() -> None:
    run = sarif(nasty(), file(path="b.nc"), unread(NASTY, path="n.nc"))
    assert [result["ruleId"] for result in run["results"]] == [visible(NASTY), *["rapid-in-polar"] * 2]
    log = json.loads(shown("sarif", nasty()))
    (result, *_) = log["runs"][0]["results"]
    result["locations"][0]["physicalLocation"]["region"]["startLine"] = 0
    assert not schema("sarif").is_valid(log)


def test_sarif_addresses_are_those_of_the_files() -> None:
    (result, *_) = sarif(nasty(), root="/work", folder="/work/nc")["results"]
    address = result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    assert re.fullmatch(r"[A-Za-z0-9/._~%-]+", address)
    assert unquote_to_bytes(address) == os.fsencode(f"nc/part s/{RAW_NAME}")


@pytest.mark.parametrize("path", ["/srv/a.nc", "C:/shop/a.nc", "nc/a.nc"])
def test_only_a_relative_address_has_a_base_in_sarif(path: str) -> None:
    of = file(finding(), path=path, not_evaluated=[missing()]), unread("No such file", path=path)
    (result,) = sarif(*of, root="/work", folder="/work")["results"]
    assert ("uriBaseId" in result["locations"][0]["physicalLocation"]["artifactLocation"]) == (path == "nc/a.nc")


def test_sarif_places_and_links_the_section() -> None:
    (result,) = sarif(file(finding(column=4, end_column=8)))["results"]
    place = result["locations"][0]
    assert place["physicalLocation"]["region"] == {"startLine": 12, "startColumn": 4, "endLine": 12, "endColumn": 8}
    assert place["logicalLocations"] == [{"name": "O0001"}]
    assert result["message"]["text"] == (
        "G0 cannot be used in the polar mode. The control shows alarm PS0146. The polar section begins at [line 9](1)."
    )
    assert result["relatedLocations"][0]["physicalLocation"]["region"] == {"startLine": 9}
    (plain,) = sarif(file(finding(line=9, alarm=None, message="it ends here, G0 Z100.")))["results"]
    assert plain["message"]["text"] == "it ends here, G0 Z100."
    assert "relatedLocations" not in plain


def test_no_text_of_a_program_is_a_link_in_sarif() -> None:
    (result,) = sarif(file(finding(message="[here](http://localhost) and [there](1)", section_line=None)))["results"]
    assert "](" not in result["message"]["text"]


@pytest.mark.nightly
def test_sarif_has_the_page_of_each_rule() -> None:
    found = [finding(rule=name, line=line) for line, name in enumerate(load_all(), 1)]
    run = sarif(file(*found))
    rules = run["tool"]["driver"]["rules"]
    assert [rule["id"] for rule in rules] == sorted(load_all())
    for result in run["results"]:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
    for rule in rules:
        assert rule["fullDescription"]["text"] != rule["shortDescription"]["text"]
        assert "Bad" in rule["help"]["markdown"]
        assert "(expect:" not in rule["help"]["text"]


@pytest.mark.ci
def test_pages_mean_in_markdown_what_they_say() -> None:
    reader = markdown_it.MarkdownIt()
    for rule in load_all().values():
        html = reader.render(rule_help.markdown(rule))
        assert html.startswith(f"<p><strong>{rule.title}"[:40].replace('"', "&quot;"))
        assert not re.search(r"<(?!/?(?:p|strong|code|pre)\b)", html), (rule.name, html)
        text = re.sub(r"<[^>]*>", "", html)
        prose = [part for part in rule.page.split("\n\n") if "<" not in part and "&" not in part and '"' not in part]
        for word in prose[1].replace("`", "").split():
            assert word in text, (rule.name, word)


def test_sarif_keeps_what_is_silenced() -> None:
    by_allow, by_baseline = silenced(), silenced(line=7, by="baseline", reason="")
    run = sarif(file(finding(), silenced=[by_allow, by_baseline]), file(path="b.nc"), has_baseline=True)
    allowed, known, new = run["results"]
    assert allowed["suppressions"] == [
        {"kind": "inSource", "status": "accepted", "justification": "proven on the lathe"}
    ]
    assert known["suppressions"][0]["kind"] == "external"
    assert new["suppressions"] == []
    assert [result["baselineState"] for result in run["results"]] == ["new", "unchanged", "new"]
    (first, second) = sarif(file(finding(), silenced=[by_allow]))["results"]
    assert "baselineState" not in {**first, **second}
    assert "suppressions" not in sarif(file(finding()))["results"][0]
    (new,) = sarif(file(finding()), has_baseline=True)["results"]
    assert new["baselineState"] == "new"


@pytest.mark.ci
def test_a_baseline_of_the_command_makes_the_others_new() -> None:
    make(a__nc=RAPID)
    assert call("baseline", "create", "a.nc", "-o", "known.json").exit_code == 0
    make(b__nc=RAPID)
    told = check("a.nc", "b.nc", *RAPID_ONLY, "--baseline", "known.json", "--format", "sarif")
    run = json.loads(told.stdout)["runs"][0]
    schema("sarif").validate(json.loads(told.stdout))
    assert [(one["baselineState"], len(one["suppressions"])) for one in run["results"]] == [
        ("unchanged", 1),
        ("new", 0),
    ]
    fresh = json.loads(check("b.nc", *RAPID_ONLY, "--baseline", "known.json", "--format", "sarif").stdout)
    assert fresh["runs"][0]["results"][0]["baselineState"] == "new"


@pytest.mark.one_in(10)
@pytest.mark.nightly
@pytest.mark.parametrize("form", OF_MANY)
def test_many_files_are_written_as_few_are(form: str) -> None:
    """Piece by piece, and where the format can file by file, as they are finished."""
    for number in range(12):
        Path(f"{number:02}.nc").write_text(RAPID if number % 3 else GOOD)
    whole = check(".", *RAPID_ONLY, "--format", form, "-o", f"{form}:out")
    assert Path("out").read_bytes() == whole.stdout_bytes
    of = [nasty(), file(path="b.nc"), file(finding(), path="c.nc", silenced=[silenced()])]
    assert "".join(pieces(form, report(*of), background())) == shown(form, *of)


def test_sarif_says_what_went_wrong_and_what_was_not_looked_at() -> None:
    gaps = [missing(), missing("overcut"), msgspec.structs.replace(missing("x", "no weight"), matters=False)]
    (invocation,) = sarif(unread("No such file", path="gone.nc"), file(not_evaluated=gaps))["invocations"]
    assert not invocation["executionSuccessful"]
    assert [(one["level"], one["message"]["text"]) for one in invocation["toolExecutionNotifications"]] == [
        ("error", "gone.nc: No such file"),
        ("warning", "not evaluated: no radius for T0808 (interference, overcut)"),
    ]
    assert sarif(file())["invocations"] == [{"executionSuccessful": True, "toolExecutionNotifications": []}]


def test_what_could_not_be_read_reaches_the_report_of_the_command() -> None:
    make(a__nc=GOOD)
    told = check("a.nc", "gone.nc", "--format", "sarif", "-o", "junit:j.xml")
    (invocation,) = json.loads(told.stdout)["runs"][0]["invocations"]
    assert not invocation["executionSuccessful"]
    assert invocation["toolExecutionNotifications"][0]["message"]["text"].startswith("gone.nc: ")
    root = ElementTree.fromstring(Path("j.xml").read_text("utf-8"))  # noqa: S314
    assert root.attrib["errors"] == "1"


def test_sarif_holds_fixes() -> None:
    fix = Fix(title="write G1", safe=True, edits=[Edit(line=12, column=1, end_line=12, end_column=3, text="G1")])
    (result,) = sarif(file(finding(fix=fix)))["results"]
    (change,) = result["fixes"][0]["artifactChanges"]
    assert change["replacements"][0]["insertedContent"] == {"text": "G1"}
    assert change["artifactLocation"]["uri"] == "a.nc"


# ---- github ----

ANNOTATION = re.compile(r"::(error|warning|notice) ([^:]*)::(.*)")


def unescaped(text: str) -> str:
    for written, mark in (("%3A", ":"), ("%2C", ","), ("%0D", "\r"), ("%0A", "\n"), ("%25", "%")):
        text = text.replace(written, mark)
    return text


def annotations(text: str) -> list[tuple[str, dict[str, str], str]]:
    """As the runner reads them."""
    found = [ANNOTATION.fullmatch(line) for line in text.split("\n")]
    return [
        (one[1], {key: unescaped(value) for key, _, value in (p.partition("=") for p in one[2].split(","))}, one[3])
        for one in found
        if one
    ]


def test_github_annotations_say_what_was_found() -> None:
    (first, second) = annotations(shown("github", nasty(), file(path="b.nc")))
    assert unescaped(first[2]) == visible(NASTY)
    assert first[1]["file"] == visible(NASTY_PATH)
    assert first[1]["title"] == visible(f"rapid-in-polar, alarm {NASTY}")
    assert second[1]["title"].startswith(visible(NASTY))
    (one,) = annotations(shown("github", file(finding(severity="note", column=4, end_column=8))))
    assert one[0] == "notice"
    assert {key: one[1][key] for key in ("line", "endLine", "col", "endColumn")} == {
        "line": "12",
        "endLine": "12",
        "col": "4",
        "endColumn": "7",
    }
    (wide,) = annotations(shown("github", file(finding(line=12, end_line=14))))
    assert "col" not in wide[1]
    assert "file" not in annotations(shown("github", file(finding(), path="-")))[0][1]


def test_github_shows_the_worst_first_and_says_what_is_left() -> None:
    many = [finding(line=line, severity="note") for line in range(1, 21)]
    many += [finding(line=line, severity="error") for line in range(21, 36)]
    text = shown("github", file(*many), file(finding(severity="warning"), path="b.nc"))
    assert [one[0] for one in annotations(text)] == ["error"] * MOST + ["warning"] + ["notice"] * MOST
    last = text.splitlines()[-1]
    assert last.startswith("polarcheck: 5 errors, 10 notices more without an annotation")
    inside = re.findall(r"^::group::(.*)\n((?:- .*\n)*)::endgroup::$", text, re.MULTILINE)
    assert [(title, len(lines.splitlines())) for title, lines in inside] == [("a.nc: fail", 35), ("b.nc: fail", 1)]
    assert "annotation" not in shown("github", file(finding()))


def test_no_name_of_a_file_is_a_command_to_the_runner() -> None:
    for name in ("::stop-commands::x.nc", "##[add-path]x.nc", "  ::add-mask::e.nc"):
        gap = missing("overcut", f"no radius {name}")
        text = shown("github", file(finding(message=name), path=name, machine=name, not_evaluated=[gap]))
        for line in text.splitlines():
            assert not line.lstrip().startswith("::") or re.match("::(error |group::|endgroup::)", line), line
            assert "##[" not in line or line.startswith("::"), line


def test_quiet_is_annotations_only() -> None:
    text = shown("github", file(finding(), not_evaluated=[missing()]), quiet=True)
    assert len(text.splitlines()) == len(annotations(text)) == 1


@pytest.mark.ci
def test_the_summary_of_a_step_is_appended() -> None:
    make(a__nc=RAPID, summary__md="before\n")
    result = check("a.nc", *RAPID_ONLY, "--format", "github", GITHUB_STEP_SUMMARY="summary.md")
    assert result.exit_code == 1
    text = Path("summary.md").read_text("utf-8")
    assert text.startswith("before\n### polarcheck\n")
    assert "| 1 | 1 | error | rapid-in-polar |" in text
    assert "| error | a\\.nc\\:4 | G0 cannot be used" in text
    check("a.nc", *RAPID_ONLY, GITHUB_STEP_SUMMARY="summary.md")
    assert Path("summary.md").read_text("utf-8") == text
    check("a.nc", *RAPID_ONLY, "-o", "github:out.txt", GITHUB_STEP_SUMMARY="summary.md")
    assert Path("summary.md").read_text("utf-8").count("### polarcheck") == 2
    told = check("a.nc", *RAPID_ONLY, "--format", "github", GITHUB_STEP_SUMMARY="no/folder.md")
    assert told.exit_code == 2
    assert told.stderr.startswith("polarcheck: GITHUB_STEP_SUMMARY: no/folder.md: ")


def test_a_summary_is_cut_before_it_is_too_large() -> None:
    many = report(*(file(finding(message="\u00e4" * 300), path=f"{number}.nc") for number in range(100)))
    for room in (300, 5_000, 20_000):
        text = step_summary(many, background(), room)
        assert 0 < len(text.encode()) <= room
        assert re.search(r"\n\n\d+ lines more: this page takes no more than 1 MiB.\n$", text)
    assert step_summary(many, background(), 10) == ""
    assert "more" not in step_summary(many, background())


def test_what_is_silenced_has_no_line_of_its_own_in_a_summary() -> None:
    text = step_summary(report(file(silenced=[silenced()])), background())
    assert "1 silenced" in text
    assert "| findings |" not in text


def test_nothing_in_a_summary_means_anything_to_markdown() -> None:
    bad = "[a](http://localhost) ![i](x) <script>x</script> **b** `c` |d| ~~e~~ @name #1 www.example.com\n# f"
    text = step_summary(report(file(finding(message=bad), path="*a*|b.nc"), unread(bad)), background())
    reader = markdown_it.MarkdownIt().enable("table")
    html = reader.render(text)
    assert not re.search(r"<(?!/?(?:h3|p|table|thead|tbody|tr|th|td)\b)", html), html
    assert html.count("<table>") == 3
    assert "[a](http://localhost) ![i](x) &lt;script&gt;x&lt;/script&gt; **b** `c` |d| ~~e~~ @name" in html
    assert not re.search(r"(?<!\\)(?:://|www\.|@|#1)", text.replace("### ", ""))


# ---- gitlab ----


def entries(*of: FileReport, **changes: Any) -> Any:
    found = json.loads(shown("gitlab", *of, **changes))
    schema("gitlab").validate(found)
    return found


def test_gitlab_fits_its_schema() -> None:
    found = entries(nasty(), file(finding(severity="warning"), finding(severity="note"), path="./b.nc"))
    assert [one["severity"] for one in found] == ["major", "major", "minor", "info"]
    assert found[0]["description"] == visible(NASTY)
    assert found[0]["location"]["path"] == visible(NASTY_PATH)
    assert found[2]["location"]["path"] == "b.nc"
    assert not schema("gitlab").is_valid([{**found[0], "severity": "error"}])
    assert entries(file()) == []


def test_gitlab_fingerprints_differ_and_stay() -> None:
    same = [finding(line=line, fingerprint="f") for line in (3, 7, 9)]
    before = [one["fingerprint"] for one in entries(file(*same), file(*same, path="b.nc"))]
    assert len({*before}) == 6
    moved = [finding(line=line + 5, fingerprint="f") for line in (3, 7, 9)]
    assert [one["fingerprint"] for one in entries(file(*moved), file(*moved, path="b.nc"))] == before


# ---- junit ----


@pytest.mark.nightly
def test_junit_fits_its_schema_and_the_schema_can_refuse() -> None:
    root = junit(nasty(), file(path="b.nc"), file(path="c.nc", sections=0), unread(NASTY, path="n.nc"))
    failure = next(root.iter("failure"))
    assert failure.attrib == {"type": "error", "message": visible(NASTY)}
    assert f"{without_commands(visible(NASTY))} [rapid-in-polar]" in str(failure.text)
    text = shown("junit", file()).replace("classname", "file")
    assert not junit_schema().is_valid(text)


@pytest.mark.ci
def test_what_is_clean_is_a_test_that_passes() -> None:
    groups = list(dict.fromkeys(rule.group for rule in load_all().values()))
    found = outcomes(junit(file(finding(), finding()), file(path="b.nc"), file(path="c.nc", sections=0)))
    assert found == {
        **{("a.nc", group): "failure" if group == "polar" else "passed" for group in groups},
        **{("b.nc", group): "passed" for group in groups},
        ("c.nc", "no-polar-section"): "passed",
    }
    root = junit(file(finding(), finding(line=14)))
    assert next(root.iter("failure")).attrib["message"] == "G0 cannot be used in the polar mode (and 1 more)"


def test_what_could_not_be_judged_is_skipped_and_with_strict_it_fails() -> None:
    make(c__nc=COMPENSATED)
    for options, outcome, code in (((), "skipped", 0), (("--strict",), "failure", 1)):
        result = check("c.nc", "--select", "overcut,rapid-in-polar", "--format", "junit", *options)
        junit_schema().validate(result.stdout)
        root = ElementTree.fromstring(result.stdout)  # noqa: S314
        assert outcomes(root) == {
            ("c.nc", "compensation"): outcome,
            ("c.nc", "polar"): "passed",
            ("c.nc", "deselected"): outcome,
        }
        assert next(root.iter(outcome)).attrib["message"].startswith("no radius for T0101")
        assert result.exit_code == code
    undecided = Undecided(**msgspec.structs.asdict(finding()))
    (case,) = junit(file(undecided, verdict="unverified")).iter("skipped")
    assert case.attrib == {"type": "unverified", "message": "G0 cannot be used in the polar mode"}


def test_only_rules_that_ran_are_tests_and_only_what_fails_is_a_failure() -> None:
    make(a__nc=RAPID)
    select = ("--select", "rapid-in-polar,overcut", "--severity", "overcut=off", "--format", "junit")
    for severity, fail_on, outcome in (("note", "warning", "passed"), ("note", "note", "failure")):
        options = ("--severity", f"rapid-in-polar={severity}", "--fail-on", fail_on)
        root = ElementTree.fromstring(check("a.nc", *select, *options).stdout)  # noqa: S314
        assert outcomes(root) == {("a.nc", "polar"): outcome, ("a.nc", "deselected"): "skipped"}
    # What fails the file fails its test, whatever the exit code is.
    told, _ = ElementTree.fromstring(check("a.nc", *select, "--fail-on", "never").stdout).iter("testcase")  # noqa: S314
    assert (told[0].tag, "G0 cannot be used" in str(told[0].text)) == ("failure", True)


def test_a_suite_says_what_its_pass_rests_on() -> None:
    make(a__nc=GOOD)
    root = ElementTree.fromstring(check("a.nc", *RAPID_ONLY, "--format", "junit").stdout)  # noqa: S314
    (said,) = root.iter("system-out")
    assert str(said.text).startswith("rests on fanuc; looked at: polar sections")


# ---- checkstyle, jsonl ----


def test_checkstyle_can_be_read() -> None:
    several = file(finding(severity="warning", line=2, column=7), finding(severity="note"), path="b.nc")
    root = ElementTree.fromstring(shown("checkstyle", nasty(), several, file(path="c.nc")))  # noqa: S314
    assert [one.attrib["name"] for one in root] == [visible(NASTY_PATH), "b.nc", "c.nc"]
    assert [len(one) for one in root] == [2, 2, 0]
    assert root[0][0].attrib["message"] == visible(NASTY)
    assert root[1][0].attrib == {
        "line": "2",
        "column": "7",
        "severity": "warning",
        "message": "G0 cannot be used in the polar mode",
        "source": "polarcheck.rapid-in-polar",
    }
    assert root[1][1].attrib["severity"] == "info"


def test_json_lines_say_what_json_says() -> None:
    of = (nasty(), file(path="b.nc"), file(finding(), path="c.nc", silenced=[silenced()]))
    lines = [json.loads(line) for line in shown("jsonl", *of).split("\n")[:-1]]
    whole = json.loads(shown("json", *of))
    for file_report in whole["files"]:
        own = [line for line in lines if line.get("path") == file_report["path"]]
        for kind, key in (("finding", "findings"), ("silenced", "silenced")):
            said = [
                {k: v for k, v in line.items() if k not in ("type", "path")} for line in own if line["type"] == kind
            ]
            assert said == file_report[key]
        assert own[-1] == {
            "type": "file",
            **{k: v for k, v in file_report.items() if k not in ("findings", "silenced")},
        }
    assert lines[-1] == {
        "type": "summary",
        **{key: whole[key] for key in ("schema", "tool", "machine", "settings")},
        **whole["summary"],
    }
    assert shown("jsonl").count("\n") == 1


# ---- statistics ----


@pytest.mark.nightly
def test_statistics_stand_in_place_of_the_findings() -> None:
    make(a__nc=RAPID + RAPID, b__nc=RAPID, c__nc=GOOD)
    result = check("a.nc", "b.nc", "c.nc", *RAPID_ONLY, "--statistics")
    assert result.exit_code == 1
    assert result.stdout == (
        """\
findings  files  fixable  severity  rule
       3      2        3  error     rapid-in-polar

3 files checked for fanuc: 2 fail, 1 unverified; 3 errors
"""
    )
    quiet = check("a.nc", "b.nc", "c.nc", *RAPID_ONLY, "--statistics", "-q").stdout
    assert quiet == "".join(result.stdout.splitlines(keepends=True)[:2])
    one = {"rule": "rapid-in-polar", "severity": "error", "findings": 3, "files": 2, "fixable": 3, "silenced": 0}
    told = {
        form: check("a.nc", "b.nc", *RAPID_ONLY, "--statistics", "--format", form).stdout for form in ("json", "jsonl")
    }
    assert json.loads(told["json"]) == [one]
    assert json.loads(told["jsonl"]) == one
    assert check("c.nc", *RAPID_ONLY, "--statistics").stdout == "1 file checked for fanuc; no findings\n"


def test_statistics_have_colors_and_count_what_is_silenced() -> None:
    from polarcheck.reports.pages.statistics import statistics

    fix = Fix(title="x", safe=True, edits=[])
    known = [silenced(), silenced(rule=NASTY)]
    of = report(file(finding(severity="note"), finding(fix=fix), finding(), silenced=known))
    plain = statistics(of, background(), "text")
    assert [line.split()[:5] for line in plain.splitlines()[:4]] == [
        ["findings", "files", "fixable", "silenced", "severity"],
        ["2", "1", "1", "1", "error"],
        ["1", "1", "0", "0", "note"],
        ["0", "0", "0", "1", "error"],
    ]
    colored = statistics(of, background(color=True), "text")
    assert "\x1b[1;31merror\x1b[0m" in colored
    assert re.sub(r"\x1b\[[\d;]*m", "", colored) == plain


def test_statistics_need_a_format_that_can_hold_them() -> None:
    make(a__nc=RAPID)
    result = call("check", "a.nc", "--statistics", "--format", "sarif")
    assert result.exit_code == 2
    assert result.stderr == (
        "polarcheck: --statistics: expected --format text, short, concise, json, jsonl, found sarif\n"
    )
    assert check("a.nc", *RAPID_ONLY, "--statistics", "-o", "sarif:s.sarif").exit_code == 1
    schema("sarif").validate(json.loads(Path("s.sarif").read_text("utf-8")))
