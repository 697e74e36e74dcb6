"""`check --diff` and `check --fix`: what is shown, what is written, and what is not."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import msgspec
import pytest
from cases import looped
from click.testing import CliRunner, Result
from hypothesis import given, settings
from hypothesis import strategies as st
from polarcheck.errors import OutputError
from programs import CORPUS, ROOT, job_of, machine_of, report_of
from test_samples import SAMPLES
from test_samples import settings as settings_of_sample

import polarcheck
from polarcheck.checking import edits
from polarcheck.checking.settings import Settings
from polarcheck.columns.trace import Trace
from polarcheck.commands import main
from polarcheck.foundation.finding import FileReport
from polarcheck.program.reading import replacing, source
from polarcheck.rewrite.fixes import fix_rounds
from polarcheck.rewrite.fixes.fix_comparison import _VERDICTS
from polarcheck.rules import repair
from polarcheck.rules.editing import Replace
from polarcheck.rules.repair import Mended, Repair
from polarcheck.rules.rule import load_all

pytestmark = pytest.mark.usefixtures("own_folder")

of_posix = pytest.mark.skipif(sys.platform == "win32", reason="links, modes and signals of POSIX")
IMPORTED_FROM = os.fspath(Path(polarcheck.__file__).parent.parent)
#: A safe fix, and an unsafe one.
HEAD = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\n"
DASH = HEAD + "C–10.\nX60.\nG13.1\n"
MINUS = DASH.replace("–", "-")
OPEN = HEAD + "C10.\nX60.\nG0 Z50.\nM30\n"
CLOSED = OPEN.replace("G0 Z", "G13.1\nG0 Z")
BOTH = HEAD + "C–10.\nX60.\nG0 Z50.\nM30\n"
#: Orders behind a section.
AFTER = "G1 X99. F300\nM8 S3000\nG4 P500\nG28 H0\n"
#: G13.1 would stand in offset mode: the fix makes another finding of it.
REFUSED = "T0101\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG0 G40 X60.\nG0 Z50.\nM30\n"
NO_NEWS = ("--tool", "1:radius=4")


def check(*arguments: str, given: str | bytes | None = None, **environment: str) -> Result:
    return CliRunner().invoke(main, ["check", *arguments], input=given, env=environment)


def make(**texts: str) -> None:
    for name, text in texts.items():
        Path(name.replace("__", ".")).write_text(text, "utf-8", newline="")


def text_of(name: str) -> str:
    return Path(name).read_bytes().decode()


# ---- the command ----


@pytest.mark.nightly
def test_nothing_is_written_unless_it_is_asked_for() -> None:
    make(a__nc=BOTH)
    for asked in ((), ("--diff",), ("--diff", "--unsafe-fixes"), ("--unsafe-fixes",), ("--backup",)):
        check("a.nc", *asked)
        assert text_of("a.nc") == BOTH
    check("a.nc", POLARCHECK_FIX="1", POLARCHECK_UNSAFE_FIXES="1")
    assert text_of("a.nc") == BOTH
    assert [path.name for path in Path().iterdir()] == ["a.nc"]


def test_a_diff_shows_the_safe_fixes() -> None:
    make(a__nc=BOTH)
    result = check("a.nc", "--diff")
    assert result.exit_code == 1
    assert result.stdout == (
        "--- a.nc\n+++ a.nc\n@@ -1,7 +1,7 @@\n"
        " G98 G0 X60. C0\n G12.1\n G1 X40. F200\n-C–10.\n+C-10.\n X60.\n G0 Z50.\n M30\n"
    )
    assert result.stderr == "polarcheck: --fix would write 1 fix into 1 file; 1 more with --unsafe-fixes\n"


def test_a_diff_shows_the_unsafe_fixes_where_they_are_asked_for() -> None:
    make(a__nc=BOTH)
    result = check("a.nc", "--diff", "--unsafe-fixes")
    assert result.exit_code == 1
    assert "-C–10.\n+C-10.\n X60.\n+G13.1\n G0 Z50.\n" in result.stdout
    assert result.stderr == "polarcheck: --fix would write 2 fixes into 1 file\n"


@pytest.mark.ci
@looped(("text", "code"), [(MINUS, 0), (OPEN, 0), (DASH, 1)])
def test_a_diff_ends_with_one_where_it_would_change_something(text: str, code: int) -> None:
    make(a__nc=text)
    result = check("a.nc", "--diff")
    assert result.exit_code == code
    assert bool(result.stdout) == bool(code)


def test_a_diff_of_a_file_that_cannot_be_read_could_not_run() -> None:
    make(a__nc=DASH)
    result = check("a.nc", "b.nc", "--diff")
    assert result.exit_code == 2
    assert "+C-10.\n" in result.stdout
    assert "polarcheck: b.nc: No such file or directory\n" in result.stderr


@pytest.mark.ci
def test_a_diff_is_painted_where_color_is_asked_for() -> None:
    make(a__nc=DASH)
    assert "\x1b[31m-C–10.\x1b[0m\n\x1b[32m+C-10.\x1b[0m\n" in check("a.nc", "--diff", "--color", "always").stdout
    assert "\x1b" not in check("a.nc", "--diff").stdout


def test_nothing_in_a_diff_acts() -> None:
    make(a__nc=DASH.replace("X60.\n", "X60. (\x1b[31m\u202e)\r\n"))
    shown = check("a.nc", "--diff").stdout
    assert " X60. (\\x1b[31m\\u202e)\n" in shown


@pytest.mark.ci
def test_fixes_are_written_and_the_result_is_checked() -> None:
    make(a__nc=DASH)
    result = check("a.nc", "--fix")
    assert result.exit_code == 0
    assert text_of("a.nc") == MINUS
    assert result.stderr == "polarcheck: a.nc:4: fixed: Write a minus sign [wrong-dash]\n"
    assert result.stdout.endswith("; no findings, 1 fixed\n")
    assert check("a.nc", "--fix").stdout.endswith("; no findings\n")


@pytest.mark.nightly
def test_the_exit_code_is_that_of_the_result() -> None:
    make(a__nc=BOTH)
    result = check("a.nc", "--fix")
    assert result.exit_code == 1
    assert "polarcheck: 1 more with --unsafe-fixes\n" in result.stderr
    assert "1 error, 1 fixed\n" in result.stdout
    assert text_of("a.nc") == BOTH.replace("–", "-")
    assert check("a.nc", "--fix", "--unsafe-fixes").exit_code == 0
    assert text_of("a.nc") == CLOSED.replace("C10", "C-10")


@pytest.mark.nightly
def test_rules_are_chosen_as_for_the_check() -> None:
    make(a__nc=BOTH, b__nc=BOTH)
    check("a.nc", "--fix", "--unsafe-fixes", "--select", "polar-never-left")
    assert text_of("a.nc") == BOTH.replace("G0 Z", "G13.1\nG0 Z")
    check("b.nc", "--fix", "--unsafe-fixes", "--ignore", "polar-never-left")
    assert text_of("b.nc") == BOTH.replace("–", "-")


def test_quiet_tells_only_what_is_left() -> None:
    make(a__nc=BOTH)
    result = check("a.nc", "--fix", "-q")
    assert result.stderr == ""
    assert "fixed" not in result.stdout
    assert text_of("a.nc") == BOTH.replace("–", "-")


@pytest.mark.nightly
def test_of_many_fixes_some_are_told_one_by_one() -> None:
    lines = "".join(f"(A{number})\nG12.1 M8\nG1 X40. F200\nX60.\nG13.1\nG0 Z50.\n" for number in range(25))
    make(a__nc="G98 G0 X60. C0\n" + lines)
    result = check("a.nc", "--fix", "--select", "polar-switch-not-alone")
    assert result.stderr.count("fixed: Write G12.1 in a block of its own") == 20
    assert "polarcheck: a.nc: 5 more fixed\n" in result.stderr
    assert "polarcheck: a.nc:9: fixed: " in result.stderr, "the lines of the file as it was"


@pytest.mark.nightly
def test_several_files_are_fixed_each_for_itself() -> None:
    make(a__nc=DASH, b__nc=MINUS, c__nc=DASH)
    result = check(".", "--diff")
    assert re.findall(r"^\+\+\+ (.*)$", result.stdout, re.MULTILINE) == ["a.nc", "c.nc"]
    assert result.stderr == "polarcheck: --fix would write 2 fixes into 2 files\n"
    assert check(".", "--fix").stdout.endswith(", 2 fixed\n")


@pytest.mark.nightly
def test_the_command_that_a_report_names_fixes_nothing() -> None:
    make(**{f"{name}__nc": OPEN for name in "abcd"})
    assert "in full: polarcheck check a.nc\n" in check(".", "--fix", "--backup").stdout


@looped(
    ("options", "said"),
    [
        (("--diff", "--fix"), "leave out one of the two"),
        (("--diff", "-o", "json:x.json"), "leave out -o"),
    ],
)
def test_options_that_exclude_each_other(options: tuple[str, ...], said: str) -> None:
    make(a__nc=DASH)
    result = check("a.nc", *options)
    assert result.exit_code == 2
    assert result.stderr == f"polarcheck: --diff shows what --fix would change, and writes nothing: {said}\n"
    assert text_of("a.nc") == DASH


@looped("option", ["--unsafe-fixes", "--backup"])
def test_options_that_do_nothing_alone_say_so(option: str) -> None:
    make(a__nc=MINUS)
    result = check("a.nc", option)
    assert result.exit_code == 0
    assert result.stderr == f"polarcheck: warning: {option} does nothing without --fix\n"


@pytest.mark.ci
@of_posix
@pytest.mark.skipif(shutil.which("patch") is None, reason="patch is not here")
def test_a_diff_of_plain_lines_can_be_applied() -> None:
    sections = "".join(
        f"(PART {number})\n" * 5 + f"G12.1 M8\nG17\nG1 X4{number}.\nX60.\nG13.1\nG0 Z50.\n" for number in range(9)
    )
    make(a__nc="G98 G0 X60. C0\n" + sections, b__nc="G98 G0 X60. C0\n" + sections)
    shown = check("a.nc", "--diff", "--unsafe-fixes", "--select", "polar").stdout
    assert shown.count("@@ -") > 1
    subprocess.run(["patch", "-p0", "b.nc"], input=shown, text=True, check=True, capture_output=True, timeout=60)
    check("a.nc", "--fix", "--unsafe-fixes", "--select", "polar")
    assert text_of("a.nc") == text_of("b.nc")


# ---- standard input ----


def test_standard_input_is_written_to_standard_output_and_the_report_beside_it() -> None:
    result = check("-", "--fix", given=BOTH.encode())
    assert result.exit_code == 1
    assert result.stdout == BOTH.replace("–", "-")
    assert "polar-never-left" in result.stderr
    assert "1 error, 1 fixed" in result.stderr


def test_standard_input_without_fixes_comes_out_as_it_was() -> None:
    data = MINUS.replace("\n", "\r\n").encode() + b"\x1a(\xe9)"
    result = check("-", "--fix", given=data)
    assert result.stdout_bytes == data


def test_a_diff_of_standard_input() -> None:
    result = check("-", "--diff", given=DASH.encode())
    assert result.exit_code == 1
    assert result.stdout.startswith("--- -\n+++ -\n")


# ---- what is not fixed ----


@pytest.mark.ci
def test_a_fix_that_brings_another_finding_is_not_made() -> None:
    make(a__nc=REFUSED)
    result = check("a.nc", "--fix", "--unsafe-fixes", *NO_NEWS)
    assert text_of("a.nc") == REFUSED
    assert result.exit_code == 1
    assert "polarcheck: a.nc:3: not fixed: Write G13.1 behind the last block of the section [polar-never-left]: " in (
        result.stderr
    )
    assert "the result would have polar-switched-in-offset-mode in line 6: " in result.stderr


def test_the_rule_that_would_find_more_need_not_be_chosen() -> None:
    make(a__nc=REFUSED)
    check("a.nc", "--fix", "--unsafe-fixes", "--select", "polar-never-left", *NO_NEWS)
    assert text_of("a.nc") == REFUSED


def settings_for(machine: str = "fanuc", *tools: str, **changes: float) -> Settings:
    return Settings(
        machine,
        machine_of(machine, {"limits": changes} if changes else None),
        job_of(*tools),
        list(load_all().values()),
        {},
    )


def outcome(program: str, *, unsafe: bool = True, machine: str = "fanuc", **changes: float) -> fix_rounds.Outcome:
    return fix_rounds.with_fixes(program.encode(), settings_for(machine, "1:radius=4", **changes), "-", unsafe=unsafe)


def test_what_somebody_has_answered_for_is_not_fixed() -> None:
    def answered(report: FileReport) -> FileReport:
        return msgspec.structs.replace(report, findings=[])

    found = fix_rounds.with_fixes(DASH.encode(), settings_for(), "-", suppress=answered)
    assert (found.data, found.fixed, found.refused) == (DASH.encode(), [], [])


@pytest.mark.nightly
def test_what_a_baseline_knows_is_not_fixed() -> None:
    make(a__nc=DASH, b__nc=DASH)
    assert CliRunner().invoke(main, ["baseline", "create", "a.nc", "-o", "known.json"]).exit_code == 0
    fixed = check("--fix", "--baseline", "known.json", "a.nc", "b.nc")
    assert text_of("a.nc") == DASH
    assert text_of("b.nc") == MINUS
    assert "1 fixed" in fixed.stdout
    assert "1 silenced" in fixed.stdout


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ("X40.->X41.", "the result would be another: the path differs by 0.5 mm: X40 C0 | X41 C0, in line 3"),
        ("\nX60.->\nX60. C2.", "the result would be another: the path differs by 12 mm: X60 C-10 | X60 C2, in line 5"),
        ("F200->F300", "the result would be another: F200 mm/min has become F300 mm/min along 30 mm, in line 3"),
        ("C–10.->Z1.\nC–10.", "the result would be another: the path differs by 49 mm: "),
        ("X60.\n->", "the result would be another: the path differs by 10 mm: X60 C-10 | X40 C-10, in line 5"),
        ("Z50.->Z51.", "the result would be another: the path differs by 1 mm: "),
        ("G0 Z50.\n->G0 Z50.\nX100.\n", "the result would be another: the path differs by 18.3772 mm: "),
        ("M8 S3000\nG4 P500\n->S3000\nG4 P500\n", "the result would be another: M8 S3000 has become "),
        ("M8 S3000->M9 S3000", "the result would be another: M8 S3000 has become "),
        ("M8 S3000->M8 S300", "the result would be another: M8 S3000 has become M8 S300"),
        ("G4 P500->G4 P50", "the result would be another: G4 P500 has become G4 P50"),
        ("G28 H0\n->", "the result would be another: G28 H0 is missing"),
        (
            "G1 X99. F300->G1 X99. F900",
            "the result would be another: F300 mm/min has become F900 mm/min along 17.877 mm, in line 8",
        ),
        ("–->–", "the finding would still be there, in line 4"),
        ("M30\n->G12.1\nM30\n", "the result would have polar-never-left in line 8: "),
        ("C–10.->C-10. G53", "the result would have "),
    ],
)
def test_a_fix_that_does_more_than_it_says_is_not_made(wrong: str, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A repair of a wrong dash with a fault of its own."""
    program = f"{DASH}G0 Z50.\n{AFTER if wrong.partition('->')[0] in AFTER else ''}M30\n"
    old, new = wrong.split("->")
    (at,) = [found.start() for found in re.finditer(re.escape(old), program)][:1]

    def wrong_dash(trace: Trace) -> Mended:
        dash = program.index("–")
        replaced: list[Replace] = [(at, at + len(old), new.replace("–", "-" if "–->" not in wrong else "–"))]
        if not at <= dash < at + len(old):
            replaced.append((dash, dash + 1, "-"))
        return Mended("Faulty", True, tuple(replaced))

    faulty = Repair("wrong-dash", wrong_dash, ())
    for module in (repair, fix_rounds):
        monkeypatch.setattr(module, "repair_of", lambda name: faulty if name == "wrong-dash" else None)
    found = outcome(program)
    assert found.data == program.encode()
    assert not found.fixed
    (refused,) = found.refused
    assert refused.reason.startswith(said)


@pytest.mark.nightly
def test_one_fix_that_is_refused_does_not_stop_the_others() -> None:
    two = "O1\n" + REFUSED + "O2\n" + BOTH
    found = outcome(two)
    assert [(one.rule, one.line) for one in found.fixed] == [("polar-never-left", 12), ("wrong-dash", 14)]
    assert [(one.rule, one.line) for one in found.refused] == [("polar-never-left", 4)]
    assert found.data.decode() == two.replace("–", "-").replace("X60.\nG0 Z", "X60.\nG13.1\nG0 Z").replace(
        "G40 X60.\nG13.1", "G40 X60."
    )


def test_fixes_that_touch_each_other_come_one_after_the_other() -> None:
    found = outcome(HEAD + "G17 C–10.\nX60.\nG13.1\n")
    assert found.data.decode() == HEAD + "C-10.\nX60.\nG13.1\n"
    assert len(found.fixed) == 2


@pytest.mark.nightly
def test_the_fixes_of_one_round_after_another_end() -> None:
    program = HEAD + "".join(f"G17 C–{number}0.\n" for number in range(1, 4)) + "X60.\nG13.1\n"
    found = outcome(program)
    assert found.data.decode() == program.replace("G17 ", "").replace("–", "-")
    assert outcome(found.data.decode()).fixed == []


@pytest.mark.ci
def test_what_is_refused_stands_in_the_way_of_nothing() -> None:
    """Beside a G13.1 that is refused a G40 that changes the way of the tool, and is looked at by itself."""
    last = "T0101\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nX60.\nG13.1\nG0 Z50.\nM30\n"
    found = outcome(f"O1\n{REFUSED}O2\n{last}")
    assert found.data.decode() == f"O1\n{REFUSED}O2\n{last}".replace("X60.\nG13.1", "G40 X60.\nG13.1")
    assert len(found.fixed) == len(found.refused) == 1


@pytest.mark.nightly
def test_of_many_that_are_refused_only_some_are_tried() -> None:
    program = "".join(f"O{number}\n{REFUSED}" for number in range(1, 24))
    job = job_of("1:radius=4", job={"run": {"max_seconds": 1e6}})
    found = fix_rounds.with_fixes(program.encode(), msgspec.structs.replace(settings_for(), job=job), "-", unsafe=True)
    assert not found.fixed
    assert len(found.refused) == fix_rounds.MOST_REFUSED
    assert found.is_whole


@pytest.mark.ci
def test_where_there_are_too_many_some_are_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fix_rounds, "MOST_CHECKS", 1)
    make(a__nc=HEAD + "G17 C–10.\nX60.\nG13.1\n")
    result = check("a.nc", "--fix", "--unsafe-fixes")
    assert "warning: a.nc: it takes too long to try all of its fixes; run it once more for those that are left\n" in (
        result.stderr
    )
    check("a.nc", "--fix", "--unsafe-fixes")
    assert text_of("a.nc") == HEAD + "C-10.\nX60.\nG13.1\n"


def test_a_program_that_is_too_hard_is_left_as_it_is() -> None:
    make(a__nc=DASH)
    result = check("a.nc", "--fix", "--max-seconds", "0.000001")
    assert result.exit_code in (0, 1, 2)
    assert text_of("a.nc") in (DASH, MINUS)


def test_a_bug_in_a_fix_leaves_the_file_and_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=DASH)

    def broken(*_: object) -> None:
        raise ZeroDivisionError("of a test")

    monkeypatch.setattr(fix_rounds, "objection", broken)
    result = check("a.nc", "--fix")
    assert result.exit_code == 3
    assert "internal error: ZeroDivisionError: of a test, while fixing a.nc" in result.stderr
    assert text_of("a.nc") == DASH


# ---- nothing but the named bytes changes ----

ENDS = ("\n", "\r\n", "\n\r\r", "\r\r\n", "\r")
ENCODINGS = {
    "utf-8": "",
    "utf-8-sig": "",
    "utf-16": "",
    "utf-16-le": "utf-16-le",
    "cp1252": "cp1252",
    "shift_jis": "shift_jis",
}


@pytest.mark.one_in(24)
@pytest.mark.ci
@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_encodings_and_line_ends_stay(encoding: str, end: str) -> None:
    text = "(\N{LATIN CAPITAL LETTER C}AF\u00c9)\n" if encoding not in ("shift_jis",) else "(\u30ab\u30bf)\n"
    program = "%\n" + text + OPEN.replace("G12.1", "G12.1 M8") + "%"
    good = program.replace("G12.1 M8", "G12.1\nM8").replace("G0 Z", "G13.1\nG0 Z")
    Path("a.nc").write_bytes(program.replace("\n", end).encode(encoding))
    options = ("--encoding", ENCODINGS[encoding]) if ENCODINGS[encoding] else ()
    result = check("a.nc", "--fix", "--unsafe-fixes", *options, "--select", "polar")
    assert "2 fixed" in result.stdout
    assert Path("a.nc").read_bytes() == good.replace("\n", end).encode(encoding)


def test_leaders_and_what_stands_behind_the_end_stay() -> None:
    program = (
        b"\0\0\x12\x14%\r\n"
        + BOTH.replace("\n", "\r\n").replace("–", "\x96").encode("latin-1")
        + b"%\0\0\x1a\xff(G12.1 M8)"
    )
    Path("a.nc").write_bytes(program)
    check("a.nc", "--fix", "--unsafe-fixes")
    assert Path("a.nc").read_bytes() == program.replace(b"\x96", b"-").replace(b"G0 Z", b"G13.1\r\nG0 Z")


def test_an_encoding_that_is_not_given_back_as_it_was_is_left_alone() -> None:
    # Two ways to write one character: what comes back is the other one.
    data = DASH.replace("–", "-").replace("G12.1", "G12.1 M8").encode() + b"(\xed\x40 \xfa\x5c)\n"
    assert data.decode("cp932").encode("cp932") != data
    Path("a.nc").write_bytes(data)
    result = check("a.nc", "--fix", "--encoding", "cp932")
    assert Path("a.nc").read_bytes() == data
    assert (
        "not fixed: Write G12.1 in a block of its own [polar-switch-not-alone]: its encoding, cp932, " in result.stderr
    )


@st.composite
def texts_with_edits(draw: st.DrawFn) -> tuple[str, list[tuple[int, int, str]]]:
    text = draw(st.text(st.characters(exclude_categories=["Cs"]), max_size=60))
    cuts = sorted(draw(st.sets(st.integers(0, len(text)), max_size=8)))
    pieces = list(zip(cuts[::2], cuts[1::2], strict=False))
    return text, [(start, end, draw(st.text("AB-.\n", max_size=4))) for start, end in pieces]


@pytest.mark.nightly
@given(texts_with_edits(), st.sampled_from(["utf-8", "utf-16-le", "utf-8-sig"]))
def test_only_the_named_characters_change(case: tuple[str, list[tuple[int, int, str]]], encoding: str) -> None:
    text, spans = case
    read = source.read_source(text.encode(encoding), encoding=encoding)
    text = read.text
    wanted = text
    for start, end, new in sorted(spans, reverse=True):
        wanted = wanted[:start] + new + wanted[end:]
    found = edits.applied(read, spans)
    assert found is not None
    assert found.decode(encoding) == source.read_source(wanted.encode(encoding), encoding=encoding).text


@pytest.mark.nightly
@given(texts_with_edits())
def test_lines_lead_back_to_where_they_come_from(case: tuple[str, list[tuple[int, int, str]]]) -> None:
    text, spans = case
    before = source.read_source(text.encode())
    data = edits.applied(before, spans)
    assert data is not None
    after = source.read_source(data)
    if (b"\n" in data) != ("\n" in text):
        return  # lines end at CR in the one, and not in the other
    origin = edits.origins(before, after, spans)
    assert len(origin) == len(after.line_starts)
    assert all(1 <= line <= len(before.line_starts) for line in origin)
    assert list(origin) == sorted(origin)
    if not spans:
        assert list(origin) == list(range(1, len(before.line_starts) + 1))


# ---- the file ----


@pytest.mark.nightly
def test_the_old_program_is_kept_where_that_is_asked_for() -> None:
    make(a__nc=BOTH)
    check("a.nc", "--fix", "--backup")
    assert text_of("a.nc.orig") == BOTH
    result = check("a.nc", "--fix", "--unsafe-fixes", "--backup")
    assert result.exit_code == 2
    assert "polarcheck: a.nc: not written: a.nc.orig is there already, and differs; move it away\n" in result.stderr
    assert text_of("a.nc.orig") == BOTH
    assert text_of("a.nc") == BOTH.replace("–", "-")
    make(a__nc=BOTH)
    assert check("a.nc", "--fix", "--backup").exit_code == 1, "the same is kept already"


@pytest.mark.nightly
def test_a_program_that_was_kept_is_no_program_of_its_folder() -> None:
    make(O0001=DASH)
    check(".", "--fix", "--backup")
    assert sorted(path.name for path in Path().iterdir()) == ["O0001", "O0001.orig"]
    assert "1 file checked" in check(".", "--fix", "--backup").stdout


@of_posix
def test_the_mode_of_a_file_stays() -> None:
    make(a__nc=DASH)
    Path("a.nc").chmod(0o640)
    check("a.nc", "--fix", "--backup")
    assert {stat.S_IMODE(Path(name).stat().st_mode) for name in ("a.nc", "a.nc.orig")} == {0o640}


of_root = pytest.mark.skipif(sys.platform == "win32" or os.geteuid() != 0, reason="only root acts as others")


@of_root
def test_a_program_of_somebody_else_stays_theirs() -> None:
    make(a__nc=DASH)
    Path("a.nc").chmod(0o664)
    os.chown("a.nc", 1234, 1235)
    assert check("a.nc", "--fix", "--backup").exit_code == 0
    assert text_of("a.nc") == MINUS
    for name in ("a.nc", "a.nc.orig"):
        status = Path(name).stat()
        assert (status.st_uid, status.st_gid, stat.S_IMODE(status.st_mode)) == (1234, 1235, 0o664)


@of_root
@looped("keep", [True, False])
@looped(
    ("owner", "group", "groups", "is_fixed"),
    [(1234, 1235, [1235], False), (1234, 2000, [], False), (2000, 1235, [], False), (2000, 1235, [1235], True)],
)
def test_a_program_that_would_change_its_owner_is_not_written(
    owner: int, group: int, groups: list[int], is_fixed: bool, keep: bool
) -> None:
    """User 2000, of group 2000 and of more groups, may write to the file and its folder."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "a.nc")
        path.write_bytes(DASH.encode())
        path.chmod(0o666)
        os.chown(path, owner, group)
        Path(folder).chmod(0o777)
        with as_user(2000, groups):
            if is_fixed:
                replacing.rewrite(str(path), DASH.encode(), MINUS.encode(), keep=keep)
            else:
                said = f"not written: it belongs to user {owner}, group {group}, to whom you cannot give the new file"
                with pytest.raises(OutputError, match=said):
                    replacing.rewrite(str(path), DASH.encode(), MINUS.encode(), keep=keep)
        assert path.read_bytes() == (MINUS if is_fixed else DASH).encode()
        kept = ["a.nc.orig"] if is_fixed and keep else []
        assert sorted(entry.name for entry in Path(folder).iterdir()) == ["a.nc", *kept]
        for name in ("a.nc", *kept):
            status = Path(folder, name).stat()
            assert (status.st_uid, status.st_gid, stat.S_IMODE(status.st_mode)) == (owner, group, 0o666)


@contextlib.contextmanager
def as_user(number: int, groups: list[int]) -> Iterator[None]:
    """The rights of another user and of the group with the same number, until the end of the block."""
    before = os.getgroups()
    os.setgroups(groups)
    os.setegid(number)
    os.seteuid(number)
    try:
        yield
    finally:
        os.seteuid(0)
        os.setegid(0)
        os.setgroups(before)


@of_posix
def test_a_link_stays_and_what_it_leads_to_is_written() -> None:
    Path("x").mkdir()
    Path("x/b.nc").write_text(DASH, "utf-8")
    Path("a.nc").symlink_to("x/b.nc")
    check("a.nc", "--fix")
    assert Path("a.nc").is_symlink()
    assert Path("x/b.nc").read_text("utf-8") == MINUS


@of_posix
def test_a_file_with_another_name_is_not_written() -> None:
    make(a__nc=DASH)
    Path("b.nc").hardlink_to("a.nc")
    result = check("a.nc", "--fix")
    assert result.exit_code == 2
    assert "a.nc: not written: it has another name (hard link), which would keep the old program\n" in result.stderr
    assert text_of("a.nc") == text_of("b.nc") == DASH
    assert "1 fixed" not in result.stdout


def test_a_read_only_file_is_not_written() -> None:
    make(a__nc=DASH)
    Path("a.nc").chmod(0o444)
    result = check("a.nc", "--fix")
    assert result.exit_code == 2
    assert "polarcheck: a.nc: not written: it is read-only\n" in result.stderr
    assert text_of("a.nc") == DASH
    Path("a.nc").chmod(0o644)


@pytest.mark.ci
@pytest.mark.parametrize(
    "change", [lambda: make(a__nc=OPEN), lambda: make(a__nc=DASH + "M30\n"), lambda: Path("a.nc").unlink()]
)
def test_a_file_that_was_changed_meanwhile_is_not_written(
    change: Callable[[], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    make(a__nc=DASH)
    real = fix_rounds.with_fixes

    def slow(*arguments: object, **options: object) -> fix_rounds.Outcome:
        found = real(*arguments, **options)  # type: ignore[arg-type]
        change()
        return found

    monkeypatch.setattr(fix_rounds, "with_fixes", slow)
    result = check("a.nc", "--fix")
    assert result.exit_code == 2
    assert "a.nc: not written: " in result.stderr
    assert not Path("a.nc").exists() or text_of("a.nc") != MINUS


def test_a_file_that_is_changed_while_the_new_one_is_written_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=DASH)
    real = replacing._refuse
    times: list[int] = []

    def refuse(target: Path, name: str, old: bytes) -> None:
        if times:
            make(a__nc=OPEN)
        times.append(1)
        real(target, name, old)

    monkeypatch.setattr(replacing, "_refuse", refuse)
    with pytest.raises(OutputError, match="it was changed since it was read"):
        replacing.rewrite("a.nc", DASH.encode(), b"")
    assert text_of("a.nc") == OPEN
    assert [path.name for path in Path().iterdir()] == ["a.nc"]


@pytest.mark.ci
@of_posix
def test_a_kill_leaves_the_old_program_or_the_new_one() -> None:
    """Whenever it comes: SIGKILL at another moment each time, until the new one is there."""
    long = HEAD + "".join(f"X40.{number:03}\nC–{number % 9 + 1}.\n" for number in range(60)) + "X60.\nG13.1\n"
    good, seen = long.replace("–", "-"), set()
    environment = {**os.environ, "PYTHONPATH": IMPORTED_FROM}
    for number in range(3):
        Path("a.nc").write_text(long, "utf-8", newline="")
        process = subprocess.Popen(
            [sys.executable, "-m", "polarcheck", "check", "a.nc", "--fix", "--select", "wrong-dash", "-q"],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        if number < 2:
            # As soon as the new file begins to be there, or a little later.
            end = time.monotonic() + 60
            while process.poll() is None and time.monotonic() < end and not list(Path().glob(".a.nc.*")):
                time.sleep(0.0005)
            time.sleep(number * 0.001)
            process.send_signal(signal.SIGKILL)
        process.wait(timeout=120)
        left = text_of("a.nc")
        assert left in (long, good)
        seen.add(left)
        for piece in Path().glob(".a.nc.*"):
            piece.unlink()
    assert good in seen


# ---- any program ----

FAULTS: dict[str, Callable[[str], str]] = {
    "dash": lambda text: text.replace("C-", "C–", 2),
    "letter": lambda text: text.replace("X40", "X4O", 1),
    "rapid": partial(re.sub, r"\nG1 ([XC])", r"\nG0 \1", count=2),
    "open": lambda text: text.replace("G13.1\n", "", 1),
    "shared": lambda text: text.replace("G12.1\n", "G12.1 M8\n").replace("G13.1\n", "G13.1 G0 Z80.\n", 1),
    "plane": lambda text: text.replace("G12.1\n", "G12.1\nG17\n", 1),
    "fast": partial(re.sub, r"F\d+", "F90000", count=1),
    "point": partial(re.sub, r"\nC(-?\d+)\.\n", r"\nC\1\n", count=1),
    "with Z": partial(re.sub, r"\nX(\d+\.)\n", r"\nX\1 Z-9.\n", count=1),
    "offset": lambda text: text.replace("G40 ", "", 1),
    "numbers": lambda text: "".join(f"N{number}{line}\n" for number, line in enumerate(text.splitlines(), 1)),
    "skip": lambda text: text.replace("\nG12.1", "\n/G12.1").replace("\nG13.1", "\n/G13.1"),
    "no blanks": lambda text: re.sub(r"(?m)^[^(\n]+", lambda line: line[0].replace(" ", ""), text),
    "semicolons": lambda text: text.replace("\n", ";\n"),
}
PROGRAMS = [path for path in SAMPLES if path.stat().st_size < 3000]


@pytest.mark.nightly
@settings(max_examples=15, deadline=None)
@given(
    st.sampled_from(PROGRAMS), st.lists(st.sampled_from(sorted(FAULTS)), min_size=1, max_size=4), st.sampled_from(ENDS)
)
def test_fixes_make_no_program_worse_and_twice_is_once(path: Path, faults: list[str], end: str) -> None:
    text = path.read_text("utf-8")
    for fault in faults:
        text = FAULTS[fault](text)
    given = settings_of_sample(path)
    work = given["job"]
    machine = machine_of(given["machine"], given["changes"])
    own = Settings(given["machine"], machine, work, list(load_all().values()), work.severities)
    never_worse(text.replace("\n", end).encode(), own)


def never_worse(data: bytes, own: Settings) -> None:
    found = fix_rounds.with_fixes(data, own, "-", unsafe=True)
    assert (found.data != data) == bool(found.fixed)
    if found.fixed:
        again = fix_rounds.with_fixes(found.data, own, "-", unsafe=True)
        assert again.data == found.data
        before, after = (report_of(one, own.machine, job=own.job) for one in (data, found.data))
        assert _VERDICTS.index(after.verdict) <= _VERDICTS.index(before.verdict)
        assert len(after.findings) <= sum(1 + len(one.follows) for one in before.findings)


@pytest.mark.nightly
@pytest.mark.skipif(not CORPUS.is_dir(), reason="the real programs are not here")
def test_no_real_program_gets_worse() -> None:
    polar, others = (sorted((CORPUS / name).rglob("*")) for name in ("polar", "general"))
    paths = [path for path in (*polar, *others[::20]) if path.is_file() and path.stat().st_size < 20_000]
    assert len(paths) > 20
    for path in paths:
        never_worse(path.read_bytes(), settings_for("turning-center", "1:radius=4", c_feed=3600))


# ---- the page ----


PAGE = (ROOT / "docs" / "fixes.md").read_text("utf-8")


def test_the_page_has_every_fix() -> None:
    rows = dict(re.findall(r"^\| `([a-z-]+)` \| [^|]* \| ([^|]*) \|", PAGE, re.MULTILINE))
    assert rows == {name: found.title for name in repair.repairs() for found in [repair.repair_of(name)] if found}


def test_the_example_of_the_page_is_as_it_is_shown() -> None:
    program, diff = re.findall(r"^```\w+\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    make(O0007__NC=program)
    (command,) = re.findall(r"^`polarcheck check (.*)` shows:$", PAGE, re.MULTILINE)
    result = check(*command.split())
    assert result.stdout == diff
    assert result.exit_code == 1


@pytest.mark.nightly
def test_the_report_names_what_unsafe_fixes_have_assumed() -> None:
    program = "O7\nT0101\nG98 G0 X60. C0 Z5.\nG12.1 M8\nG1 G41 X40 F200\nC-10.\nG40 X60.\nG0 Z50.\nM30\n"
    options = "--fix", "--unsafe-fixes", "--tool", "1:radius=4"
    make(a__nc=program)
    found = msgspec.json.decode(check("a.nc", *options, "--format", "json").stdout)
    assert [(one["line"], one["block"], one["rule"]) for one in found["assumed"]] == [
        (6, "G1 G41 X40. F200", "number-without-point"),
        (9, "G13.1", "polar-never-left"),
    ]
    make(a__nc=program)
    text = check("a.nc", *options).stdout
    assert "assumed by --unsafe-fixes:" in text
    assert "a.nc:9: G13.1 (polar-never-left: " in text
    again = msgspec.json.decode(check("a.nc", *options, "--format", "json").stdout)
    assert "assumed" not in again
