"""Baselines: what is known is silenced, what is new is told, and what no longer occurs is said."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import msgspec
import pytest
from click.testing import CliRunner, Result
from polarcheck.errors import BaselineError
from programs import ROOT, report_of

import polarcheck
from polarcheck.checking.fingerprints import normal
from polarcheck.commands import baseline as baseline_command
from polarcheck.commands import main
from polarcheck.files.baselines.baseline_file import Contents, Entry, Location, program_of, read, text_of
from polarcheck.files.settings.of_programs import Options

pytestmark = pytest.mark.usefixtures("own_folder")

FILE = "polarcheck-baseline.json"
ONLY = ("--select", "rapid-in-polar")
RAPID = "O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C5.\nG1 C-5.\nG13.1\nM30\n"
TWICE = RAPID.replace("G1 C-5.\n", "G1 C-5.\nG0 C5.\nG1 C-5.\n")
OTHER = RAPID.replace("G0 C5.", "G0 C7.")
GOOD = RAPID.replace("G0 C5.", "G1 C5.")


def make(**texts: str) -> None:
    for name, text in texts.items():
        path = Path(name.replace("__", ".").replace("_of_", "/"))
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(text.encode())


def call(*arguments: Any, given: str | None = None) -> Result:
    return CliRunner().invoke(main, [str(argument) for argument in arguments], input=given)


def check(*arguments: Any, given: str | None = None) -> Result:
    return call("check", *arguments, "--baseline", FILE, *ONLY, given=given)


def baseline(*arguments: Any) -> Result:
    return call("baseline", *arguments, *ONLY)


def entries() -> list[tuple[str, str, int]]:
    return [(entry.file, entry.block, entry.count) for entry in read(Path(FILE)).entries]


def silenced(result: Result) -> dict[str, int]:
    """How much is silenced in each file of a JSON report."""
    return {file["path"]: len(file["silenced"]) for file in json.loads(result.stdout)["files"]}


# ---- create, check ----


@pytest.mark.ci
def test_what_is_known_is_silent_and_what_is_new_is_told() -> None:
    make(a__nc=RAPID, sub_of_b__nc=OTHER)
    result = baseline("create", ".", "--reason", "PROVEN SINCE 2019")
    assert (result.exit_code, result.stdout) == (0, f"{FILE}: 2 findings of 2 files known\n")
    assert entries() == [("a.nc", "G0 C5.", 1), ("sub/b.nc", "G0 C7.", 1)]
    result = check(".")
    assert (result.exit_code, result.stderr) == (0, "")
    assert "unverified (1 silenced)  a.nc: no findings, 1 polar section" in result.stdout
    assert "2 unverified; no findings, 2 silenced" in result.stdout
    make(polarcheck__toml="select = { rules = ['rapid-in-polar'], reason = 'THE OTHERS RUN ELSEWHERE' }\n")
    whole = call("check", "--baseline", FILE, "a.nc")
    Path("polarcheck.toml").unlink()
    assert "pass (1 silenced)  a.nc: no findings, 1 polar section" in whole.stdout
    make(a__nc=RAPID.replace("G1 C-5.", "G0 C-5."))
    result = check(".", "--format", "json")
    assert result.exit_code == 1
    (file, _) = json.loads(result.stdout)["files"]
    assert [found["block"] for found in file["findings"]] == ["G0 C-5."]
    (known,) = file["silenced"]
    assert (known["by"], known["reason"], known["block"]) == ("baseline", "PROVEN SINCE 2019", "G0 C5.")
    assert file["verdict"] == "fail"


@pytest.mark.ci
def test_the_file_is_for_people_and_for_tools_that_compare_lines() -> None:
    make(b__nc=TWICE, a__nc=RAPID)
    assert baseline("create", "b.nc", "a.nc").exit_code == 0
    first = Path(FILE).read_bytes()
    assert b"\r" not in first
    assert first.count(b"\n") == 11
    assert entries() == [("a.nc", "G0 C5.", 1), ("b.nc", "G0 C5.", 2)]
    assert baseline("create", "a.nc", "b.nc", "-o", "again.json").exit_code == 0
    assert Path("again.json").read_bytes() == first
    assert baseline("update", ".").exit_code == 0
    assert Path(FILE).read_bytes() == first


def test_nothing_is_overwritten() -> None:
    make(a__nc=RAPID)
    Path(FILE).write_text("mine")
    result = baseline("create", "a.nc")
    assert (result.exit_code, Path(FILE).read_text()) == (2, "mine")
    assert result.stderr == (
        f"polarcheck: -o {FILE}: is there already; `polarcheck baseline update` rewrites it, or name another\n"
    )
    assert call("baseline", "create", "a.nc", "-o", "b.nc").exit_code == 2
    assert not Path("b.nc").exists()
    Path(FILE).unlink()
    assert baseline("create", "a.nc").exit_code == 0
    before = Path(FILE).read_bytes()
    result = call("check", "a.nc", "--baseline", FILE, "-o", f"json:{FILE}")
    assert (result.exit_code, Path(FILE).read_bytes()) == (2, before)


@pytest.mark.parametrize("command", ["update", "prune"])
def test_there_must_be_one_to_rewrite(command: str) -> None:
    make(a__nc=RAPID)
    result = baseline(command, "a.nc")
    assert (result.exit_code, Path(FILE).exists()) == (2, False)
    assert "`polarcheck baseline create` writes it" in result.stderr


# ---- what changes nothing ----


@pytest.mark.parametrize(
    "changed",
    [
        RAPID.replace("\n", "\r\n"),
        RAPID.replace("\n", "\n\r\r"),
        "".join(f"N{10 * at} {line}\n" for at, line in enumerate(RAPID.splitlines())),
        RAPID.replace("G0 C5.", "  G00   C5.000 (FAST) ;"),
        RAPID.replace("G0 C5.", "g0c+5.0"),
        RAPID.replace("G0 C5.", "G04 U1.\nG1 C1.\nG0 C5.\nG1 C2."),
        RAPID.replace("O1\n", "%\nO0017 (OTHER NUMBER)\n(REV B)\n"),
    ],
    ids=["CRLF", "LF CR CR", "numbered", "spelled", "lower case", "blocks around", "head"],
)
def test_the_same_finding(changed: str) -> None:
    make(a__nc=RAPID)
    baseline("create", "a.nc")
    make(a__nc=changed)
    result = check("a.nc", "--format", "json")
    assert (result.exit_code, silenced(result)) == (0, {"a.nc": 1})
    assert result.stderr == ""


def respelled(program: str) -> str:
    """As another hand would write it: N numbers, zeros, remarks, the line ends of a punch."""
    lines = []
    for number, line in enumerate(program.splitlines()):
        text = re.sub(r"(?<=[XCZIJ])(-?)(\d+)\.(\d*)", r"\g<1>0\2.\g<3>0", line)
        text = re.sub(r"G([0-3])(?![\d.])", r"G0\1", text)
        is_block = text.strip() and text[0] not in "%O:(/N;" and "(" not in text
        lines.append(f"N{10 * number} {text} (X)" if is_block else text)
    return "\n\r\r".join([*lines, ""])


@pytest.mark.one_in(12)
@pytest.mark.parametrize("path", sorted((ROOT / "sample_programs").glob("*.nc")), ids=lambda path: path.stem)
def test_sample_programs_keep_their_fingerprints(path: Path) -> None:
    text = path.read_text("utf-8")
    if re.search(r"#|GOTO|M98|M99", text):
        pytest.skip("its macro statements and jumps name N numbers")
    groups = ("polar", "compensation", "feed", "motion", "setup")
    before, after = (
        sorted((found.rule, found.fingerprint) for found in report_of(program, only=groups).findings)
        for program in (text, respelled(text))
    )
    assert before == after


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("N10 G01 X+05.00 Z-0.50", "g1x5.z-.5;"),
        ("/N10 G00X0", "/ G0 X00"),
        ("#1=#2+05.0", "#1 = #2 + 5."),
        ("T0101 M06", "T101M6"),
    ],
)
def test_one_spelling_of_a_block(one: str, other: str) -> None:
    assert normal(one) == normal(other)


@pytest.mark.parametrize(("one", "other"), [("X5.", "X5"), ("#1+5.", "#15."), ("G12.1", "G121"), ("X50.", "X5.")])
def test_what_means_something_else_has_another_spelling(one: str, other: str) -> None:
    assert normal(one) != normal(other)


def test_what_stands_in_comments_alone_is_told_apart() -> None:
    first, second = (
        [found.fingerprint for found in report_of(f"G0 X1.\n{text}\nM30\n", only=["allow-not-understood"]).findings]
        for text in ("(POLARCHECK ALLOW WRONG X)\n(POLARCHECK ALLOW FALSE X)", "N5 (POLARCHECK ALLOW  FALSE X)")
    )
    assert len(set(first)) == 2
    assert second == first[1:]


@pytest.mark.ci
def test_rules_have_fingerprints_of_their_own() -> None:
    found = report_of("G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C5. C6.\nG1 C-5.\nG13.1\nM30\n").findings
    assert len({one.fingerprint for one in found}) == len({one.rule for one in found}) > 1


# ---- counts ----


def test_one_more_of_the_same_is_new() -> None:
    make(a__nc=RAPID)
    baseline("create", "a.nc")
    make(a__nc=TWICE)
    result = check("a.nc", "--format", "concise")
    assert result.exit_code == 1
    assert result.stdout.startswith("a.nc:7:1: error: ")
    assert result.stdout.count("\n") == 1


@pytest.mark.nightly
def test_one_less_is_said_and_can_be_dropped() -> None:
    make(a__nc=TWICE, b__nc=RAPID)
    baseline("create", ".", "--reason", "OLD")
    make(a__nc=RAPID, b__nc=GOOD)
    result = check(".")
    assert result.exit_code == 0
    assert result.stderr == (
        f"polarcheck: warning: {FILE}: 2 known findings no longer occur: rapid-in-polar in a.nc, "
        "rapid-in-polar in b.nc; `polarcheck baseline prune` drops them\n"
    )
    make(c__nc=RAPID)
    assert baseline("prune", ".").stdout == f"{FILE}: 1 finding of 1 file known; 2 gone\n"
    assert [(entry.file, entry.count, entry.reason) for entry in read(Path(FILE)).entries] == [("a.nc", 1, "OLD")]
    assert check(".", "--format", "concise").exit_code == 1
    assert check("a.nc").stderr == ""


def test_an_update_takes_what_is_new_and_keeps_reasons() -> None:
    make(a__nc=RAPID, b__nc=OTHER)
    baseline("create", ".", "--reason", "OLD")
    make(a__nc=RAPID.replace("G1 C-5.", "G0 C-5."), b__nc=GOOD)
    result = baseline("update", ".", "--reason", "NEW")
    assert result.stdout == f"{FILE}: 2 findings of 1 file known; 1 new, 1 gone\n"
    assert [(entry.block, entry.reason) for entry in read(Path(FILE)).entries] == [
        ("G0 C-5.", "NEW"),
        ("G0 C5.", "OLD"),
    ]


@pytest.mark.nightly
def test_files_and_rules_that_are_not_asked_keep_what_is_known_of_them() -> None:
    make(a__nc=RAPID, b__nc=RAPID)
    baseline("create", ".")
    make(a__nc=GOOD)
    before = Path(FILE).read_bytes()
    for arguments in (("b.nc", *ONLY), ("a.nc", "--select", "arc-without-center"), ("a.nc", "--ignore", "polar")):
        assert call("check", *arguments, "--baseline", FILE).stderr == ""
        for command in ("prune", "update"):
            assert call("baseline", command, *arguments, "--ignore", "setup,silence,text").exit_code == 0
            assert Path(FILE).read_bytes() == before


def test_what_could_not_be_evaluated_is_not_gone() -> None:
    text = "T0101\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\nM30\n"
    make(a__nc=text)
    rule = "start-up-shorter-than-radius"
    tool = ("--tool", "1:radius=30")
    call("baseline", "create", "a.nc", "--select", rule, *tool)
    assert [entry.rule for entry in read(Path(FILE)).entries] == [rule]
    before = Path(FILE).read_bytes()
    assert call("check", "a.nc", "--select", rule, "--baseline", FILE).stderr == ""
    call("baseline", "prune", "a.nc", "--select", rule)
    assert Path(FILE).read_bytes() == before
    result = call("check", "a.nc", "--select", rule, "--baseline", FILE, "--tool", "1:radius=.1")
    assert "1 known finding no longer occurs: start-up-shorter-than-radius in a.nc; " in result.stderr


# ---- what is worse ----


def test_a_finding_that_is_more_severe_now_is_told() -> None:
    make(a__nc=RAPID)
    baseline("create", "a.nc", "--severity", "rapid-in-polar=note")
    assert check("a.nc", "--severity", "rapid-in-polar=note", "--fail-on", "note").exit_code == 0
    result = check("a.nc", "--severity", "rapid-in-polar=warning")
    assert (result.exit_code, result.stderr) == (1, "")


MIRRORED = "T0101\nG98 G0 X100. C0\nG12.1\nG1 G41 X40. F200\nC20.\nX-40.\nC-20.\nX40.\nC0\nG40 X100.\nG13.1\nM30\n"


@pytest.mark.ci
def test_what_follows_goes_with_its_cause_and_what_follows_newly_is_told() -> None:
    make(a__nc=MIRRORED)
    tool = ("--tool", "1:radius=4")
    both = ("--select", "side-of-compensation-mirrored", "--select", "start-up-sweeps-contour")
    call("baseline", "create", "a.nc", *tool, *both)
    (entry,) = read(Path(FILE)).entries
    assert (entry.rule, entry.follows) == ("side-of-compensation-mirrored", ["start-up-sweeps-contour"])
    result = call("check", "a.nc", "--baseline", FILE, "--format", "json", *tool, *both)
    assert result.exit_code == 0
    (found,) = json.loads(result.stdout)["files"][0]["silenced"]
    assert [one["rule"] for one in found["follows"]] == entry.follows
    Path(FILE).write_text(Path(FILE).read_text().replace(', "follows": ["start-up-sweeps-contour"]', ""))
    assert call("check", "a.nc", "--baseline", FILE, *tool, *both).exit_code == 1


# ---- files that move ----


@pytest.mark.ci
def test_a_file_that_has_moved_is_known_by_what_is_found_in_it() -> None:
    make(a__nc=RAPID, b__nc=OTHER)
    baseline("create", ".", "--reason", "OLD")
    Path("new").mkdir()
    Path("a.nc").rename("new/a.nc")
    Path("b.nc").rename("new/c.nc")
    result = check(".", "--format", "json")
    assert (result.exit_code, silenced(result)) == (0, {"new/a.nc": 1, "new/c.nc": 1})
    assert result.stderr == (
        f"polarcheck: warning: {FILE}: 2 files were moved: a.nc is new/a.nc, b.nc is new/c.nc; `polarcheck baseline "
        "update` takes the new paths\n"
    )
    assert baseline("update", ".").exit_code == 0
    assert [(entry.file, entry.reason) for entry in read(Path(FILE)).entries] == [
        ("new/a.nc", "OLD"),
        ("new/c.nc", "OLD"),
    ]
    assert check(".").stderr == ""


@pytest.mark.ci
@pytest.mark.parametrize("command", ["prune", "update"])
def test_a_file_that_has_moved_where_the_run_was_not_keeps_what_is_known_of_it(command: str) -> None:
    make(a__nc=RAPID, sub_of_b__nc=OTHER)
    baseline("create", ".", "--reason", "OLD")
    Path("sub/b.nc").rename("sub/c.nc")
    before = Path(FILE).read_bytes()
    Path("other").mkdir()
    for paths in (["a.nc"], ["other", "a.nc"]):
        assert baseline(command, *paths).exit_code == 0
        assert Path(FILE).read_bytes() == before
    assert check(".").exit_code == 0
    Path("sub/c.nc").unlink()
    assert baseline(command, "a.nc", "sub").exit_code == 0
    assert [entry.file for entry in read(Path(FILE)).entries] == ["a.nc"]


def test_a_copy_is_new() -> None:
    make(a__nc=RAPID)
    baseline("create", "a.nc")
    make(b__nc=RAPID)
    result = check(".", "--format", "concise")
    assert (result.exit_code, result.stdout[:4]) == (1, "b.nc")


def test_a_gone_file_stands_for_one_other_and_the_name_counts_first() -> None:
    make(z__nc=RAPID)
    baseline("create", "z.nc")
    Path("z.nc").unlink()
    make(a__nc=RAPID, sub_of_z__nc=RAPID)
    result = check(".", "--format", "json")
    assert silenced(result) == {"a.nc": 0, "sub/z.nc": 1}


def test_one_block_in_common_does_not_make_a_new_program_an_old_one() -> None:
    make(a__nc=RAPID.replace("G1 C-5.\n", "G0 C-5.\nG0 C6.\nG1 C8.\n"))
    baseline("create", "a.nc")
    assert len(entries()) == 3
    Path("a.nc").unlink()
    make(b__nc=RAPID)
    result = check(".")
    assert result.exit_code == 1
    assert "3 known findings no longer occur: a.nc, which is gone (3)" in result.stderr


def first_schema() -> None:
    """Write the baseline as the first version did, without places."""
    contents = read(Path(FILE))
    old = [msgspec.structs.replace(entry, places=[]) for entry in contents.entries]
    Path(FILE).write_text(text_of(Contents(old, schema=1)), "utf-8")


@pytest.mark.ci
def test_a_baseline_of_the_first_schema_is_read_and_upgraded() -> None:
    make(a__nc=RAPID, b__nc=TWICE)
    baseline("create", ".", "--reason", "OLD")
    new = Path(FILE).read_bytes()
    first_schema()
    old = Path(FILE).read_bytes()
    assert (b"programs" in old, b"places" in old) == (False, False)
    # One file keeps all of its findings, the other one has moved with half of them.
    Path("b.nc").unlink()
    make(c__nc=RAPID)
    result = check(".", "--format", "json")
    assert (result.exit_code, silenced(result)) == (0, {"a.nc": 1, "c.nc": 1})
    told = result.stderr.splitlines()
    assert told[0] == (
        f"polarcheck: warning: {FILE}: 2 lines of an earlier version of polarcheck, where a finding that is worse now "
        "stays silent; `polarcheck baseline update` upgrades them"
    )
    assert "b.nc is c.nc" in told[1]
    assert baseline("prune", "a.nc").exit_code == 0
    assert Path(FILE).read_bytes() == old
    make(b__nc=TWICE)
    Path("c.nc").unlink()
    assert baseline("update", ".").exit_code == 0
    assert Path(FILE).read_bytes() == new
    first_schema()
    Path("a.nc").unlink()
    make(d__nc=OTHER.replace("G1 C-5.", "G0 C5.\nG0 C4.\nG0 C3."))
    assert check("d.nc").exit_code == 1


def test_a_file_with_entries_of_its_own_takes_none_of_another() -> None:
    make(a__nc=RAPID, b__nc=OTHER)
    baseline("create", ".")
    Path("a.nc").unlink()
    make(b__nc=OTHER.replace("G1 C-5.", "G0 C5."))
    assert check(".", "--format", "json").exit_code == 1


def test_paths_are_counted_from_the_folder_of_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    make(shop_of_a__nc=RAPID)
    Path("known").mkdir()
    assert baseline("create", "shop", "-o", "known/b.json").exit_code == 0
    assert [entry.file for entry in read(Path("known/b.json")).entries] == ["../shop/a.nc"]
    monkeypatch.chdir("shop")
    result = call("check", "a.nc", "--baseline", "../known/b.json", *ONLY)
    assert (result.exit_code, result.stderr) == (0, "")


def test_standard_input() -> None:
    baseline_of_input = CliRunner().invoke(main, ["baseline", "create", "-", *ONLY], input=RAPID)
    assert baseline_of_input.exit_code == 0
    assert check("-", given=RAPID).exit_code == 0
    assert check("-", given=TWICE).exit_code == 1


def test_what_an_editor_holds_is_known_as_its_file() -> None:
    make(sub_of_a__nc=RAPID)
    baseline("create", "sub")
    result = check("-", "--stdin-filename", "sub/a.nc", "--format", "json", given=TWICE)
    assert (silenced(result), result.exit_code, result.stderr) == ({"sub/a.nc": 1}, 1, "")


@pytest.mark.nightly
def test_many_files_by_several_processes() -> None:
    for number in range(30):
        make(**{f"{number:02}__nc": RAPID if number % 2 else TWICE})
    assert baseline("create", ".", "--jobs", "2").stdout == f"{FILE}: 45 findings of 30 files known\n"
    make(**{"07__nc": TWICE, "08__nc": RAPID})
    shown = [check(".", "--jobs", jobs) for jobs in ("1", "2")]
    assert shown[0].stdout == shown[1].stdout
    assert shown[0].stderr == shown[1].stderr
    assert shown[0].stdout.startswith("07.nc:7:1: error: ")
    assert "1 known finding no longer occurs: rapid-in-polar in 08.nc;" in shown[0].stderr


# ---- faults ----


def broken(text: str | bytes) -> str:
    Path(FILE).write_bytes(text if isinstance(text, bytes) else text.encode())
    make(a__nc=RAPID)
    result = check("a.nc")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1
    return result.stderr


ENTRY = '{"file": "a.nc", "rule": "rapid-in-polar", "fingerprint": "0", "severity": "error"%s}'


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "is no JSON"),
        ("[]", "Expected `object`, got `array`; expected a file that `polarcheck baseline create` has written"),
        ('{"schema": 1}', "missing required field `findings`"),
        ('{"schema": 1,\n"findings": [\n}', "in line 3"),
        ('{"schema": 3, "findings": []}', "schema: expected 1 or 2, found 3"),
        ("\x1b[2J", "is no JSON"),
        (b"\xff\xfe\x00", "polarcheck-baseline.json: "),
    ],
)
def test_a_broken_file_is_one_line(text: str | bytes, told: str) -> None:
    message = broken(text)
    assert message.startswith(f"polarcheck: {FILE}: ")
    assert told in message
    assert "\x1b" not in message


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (', "count": 0', "count: expected a number above 0, found 0"),
        (', "count": "2"', "Expected `int`, got `str` - at `$.count`"),
        (', "resaon": "x"', "unknown field `resaon`; did you mean reason?"),
        (', "follows": "x"', "`$.follows`"),
        (', "places": [{}, {"at": 1}]', "places: expected 1, as many as count says, found 2"),
        (', "places": [{"at": "x"}]', "`$.places[0].at`"),
        (', "places": [{"values": {"depth": "x"}}]', "`$.places[0].values[...]`"),
    ],
)
def test_a_broken_entry_is_named_with_its_line(more: str, told: str) -> None:
    text = f'{{"schema": 1, "findings": [\n{ENTRY % ""},\n{ENTRY % more}\n]}}'
    message = broken(text)
    assert message.startswith(f"polarcheck: {FILE}: line 3, finding 2: ")
    assert told in message
    assert "severity: expected one of note, warning, error, found 'bad'" in broken(
        text.replace(more, "").replace("error", "bad")
    )


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ('"blocks": "AAA"', "blocks: expected hashes in base 64, four characters each"),
        ('"blocks": "AA=="', "blocks: expected hashes in base 64, four characters each"),
        ('"blocks": "A\\u00fcAA"', "blocks: expected hashes in base 64, four characters each"),
        ('"of": 0', "of: expected a number above 0, found 0"),
        ('"block": ""', "unknown field `block`; did you mean blocks?"),
    ],
)
def test_a_broken_line_of_a_program_is_named(more: str, told: str) -> None:
    message = broken(f'{{"schema": 2, "programs": [\n{{"file": "a.nc", {more}}}], "findings": []}}')
    assert message == f"polarcheck: {FILE}: line 2, program 1: {told}\n" or told in message


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_editors_and_shells_of_windows_may_have_written_it(encoding: str) -> None:
    make(a__nc=RAPID)
    baseline("create", "a.nc", "--reason", "geprüft")
    Path(FILE).write_bytes(Path(FILE).read_text("utf-8").replace("\n", "\r\n").encode(encoding))
    assert check("a.nc").exit_code == 0
    assert [entry.reason for entry in read(Path(FILE)).entries] == ["geprüft"]


def test_what_cannot_be_read_keeps_what_is_known_of_it_and_is_told() -> None:
    make(a__nc=RAPID, b__nc=RAPID)
    baseline("create", ".")
    before = Path(FILE).read_bytes()
    result = baseline("update", ".", "--max-size", "10")
    assert (result.exit_code, Path(FILE).read_bytes()) == (2, before)
    assert result.stderr.count("larger than 10 bytes") == 2
    with pytest.raises(BaselineError, match="is a folder"):
        read(Path())


def test_text_of_a_file_comes_back_as_it_was() -> None:
    entries = [
        Entry(file='a"\n\x1b.nc', rule="x", fingerprint="1", severity="note", count=3, follows=["y"], reason="ü")
    ]
    entries.append(
        msgspec.structs.replace(entries[0], rule="y", count=1, places=[Location(at=3, values={"depth": 0.5})])
    )
    programs = [program_of('a"\n\x1b.nc', [0, 1, 2**24 - 1], 2)]
    Path(FILE).write_text(text_of(Contents(entries, programs)), "utf-8")
    contents = read(Path(FILE))
    assert (contents.entries, contents.programs, contents.lines) == (entries, programs, [7, 8])
    assert contents.programs[0].hashes == [0, 1, 2**24 - 1]
    Path(FILE).write_text(text_of(Contents()), "utf-8")
    assert read(Path(FILE)) == Contents([], [], [])


def test_nothing_acts_on_a_terminal() -> None:
    make(a__nc=RAPID.replace("G0 C5.", "G0 C5. (\x1b[2J)"))
    baseline("create", "a.nc", "--reason", "\x1b[31mRED")
    assert b"\x1b" not in Path(FILE).read_bytes()
    result = check("a.nc", "--show-silenced")
    assert result.exit_code == 0
    assert "\x1b" not in result.output
    assert "[rapid-in-polar]" in result.stdout
    assert "\\x1b[31mRED" in result.stdout


# ---- reports ----


@pytest.mark.nightly
def test_what_is_silenced_is_listed_on_demand() -> None:
    make(a__nc=RAPID)
    baseline("create", "a.nc")
    assert "by baseline" not in check("a.nc").stdout
    shown = check("a.nc", "--show-silenced").stdout
    assert "silenced: 1 finding\n    at   a.nc:5:1: error: G0 cannot be used" in shown
    assert "(by baseline, no reason" in " ".join(shown.split())
    line = "a.nc:5:1: silenced: error: G0 cannot be used in the polar mode; write G1 with a high F [rapid-in-polar] (by"
    for form in ("concise", "short"):
        assert line in check("a.nc", "--show-silenced", "--format", form).stdout
        assert "a.nc:5" not in check("a.nc", "--format", form).stdout
    other = OTHER.replace("G0 C7.", "G0 C7. (POLARCHECK ALLOW RAPID-IN-POLAR PROVEN)")
    make(b__nc=other, c__nc=GOOD)
    shown = check("b.nc", "c.nc", "--show-silenced").stdout
    assert "(by allow: PROVEN)" in " ".join(shown.split())
    assert "2 unverified; no findings, 1 silenced" in shown
    make(polarcheck__toml="select = { rules = ['rapid-in-polar'], reason = 'THE OTHERS RUN ELSEWHERE' }\n")
    assert "2 pass (1 with findings silenced); no findings, 1 silenced" in call("check", "b.nc", "c.nc").stdout
    Path("polarcheck.toml").unlink()
    assert check("b.nc", "--no-inline").exit_code == 1


def test_a_verdict_says_what_it_does_not_rest_on() -> None:
    make(a__nc=RAPID.replace("G1 C-5.", "G0 C-5. (POLARCHECK ALLOW RAPID-IN-POLAR PROVEN)"))
    result = call("check", "a.nc", *ONLY)
    assert "fail (1 silenced)  a.nc: 1 error, 1 polar section" in result.stdout
    empty = "O1\nG0 X1. X2. (POLARCHECK ALLOW WORD-REPEATED PROVEN)\nM30\n"
    make(b__nc=empty)
    result = call("check", "b.nc")
    assert "pass (no polar section, 1 silenced)  b.nc: no findings" in result.stdout


# ---- the command ----


def test_it_takes_all_options_that_decide_what_is_found() -> None:
    of_exit_code = {"strict", "fail_on", "max_warnings"}
    others = {"use_config", "baseline", "use_baseline", "extras", "named", "gives_verdicts", "keywords"}
    assert set(Options.__struct_fields__) - of_exit_code - others <= set(baseline_command.DECIDING)
    for command in ("create", "update", "prune"):
        parameters = {one.name for one in baseline_command.baseline.commands[command].params}
        assert {*baseline_command.DECIDING, "output"} <= parameters


@pytest.mark.ci
def test_the_process() -> None:
    """As a shell starts it, with its output to pipes."""
    make(a__nc=RAPID)
    environment = {**os.environ, "PYTHONPATH": os.fspath(Path(polarcheck.__file__).parent.parent)}
    command = [sys.executable, "-m", "polarcheck"]

    def run(*arguments: str) -> tuple[int, str, str]:
        done = subprocess.run(
            [*command, *arguments, *ONLY], capture_output=True, text=True, env=environment, timeout=120
        )
        return done.returncode, done.stdout, done.stderr

    assert run("baseline", "create", "a.nc") == (0, f"{FILE}: 1 finding of 1 file known\n", "")
    status, shown, told = run("check", "a.nc", "--baseline", FILE)
    assert (status, told) == (0, "")
    assert "unverified (1 silenced)" in shown
    assert run("baseline", "create", "a.nc")[0] == 2


def test_the_name_alone_shows_what_it_can() -> None:
    result = CliRunner().invoke(main, ["baseline"])
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.splitlines()[0].startswith("Usage: ")
    assert "\n  create " in result.stderr
