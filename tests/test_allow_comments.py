"""Allow comments: what they silence and where, and what is said of those that silence nothing."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from cases import looped
from hexagon_program import CONTROLS, CUTTER, hexagon
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import job_of, machine_of, report_of, said

from polarcheck.checking import check
from polarcheck.columns.words.allow_syntax import grouped, read_allow
from polarcheck.foundation.finding import FileReport
from polarcheck.rules.rule import load_all

RULES = load_all()
NAMES = grouped({rule.name: rule.group for rule in RULES.values()})
HEAD = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\n"
TAIL = "G1 C-5.\nG13.1\nM30\n"
RAPID = f"{HEAD}G0 C5.\n{TAIL}"
REASON = "PROVEN ON L7"
ONLY = ("rapid-in-polar", "silence")
COMMENT = f"(POLARCHECK ALLOW RAPID-IN-POLAR {REASON})"


def report(program: str, *only: str, machine: str = "fanuc") -> FileReport:
    found = report_of(program, machine, only=only or ONLY)
    assert {one.by for one in found.silenced} <= {"allow"}
    return found


def silent(program: str, *only: str, machine: str = "fanuc") -> list[tuple[int, str, str]]:
    """Line, rule and reason of what is silenced."""
    return [(one.line, one.rule, one.reason) for one in report(program, *only, machine=machine).silenced]


def messages(program: str, rule: str) -> list[str]:
    return [one.message for one in report(program).findings if one.rule == rule]


# ---- where ----


@pytest.mark.ci
@looped(
    "block",
    [
        f"G0 C5. {COMMENT}\n",
        f"{COMMENT} G0 C5.\n",
        f"G0 C5. (polarcheck allow: rapid_in_polar {REASON})\n",
        f"G0 C5. (POLARCHECK: ALLOW RAPID-IN-POLAR: {REASON})\n",
        f"G0 C5. ( POLARCHECK  ALLOW  RAPID-IN-POLAR,POLAR - {REASON} )\n",
        f"G0 C5. (POLARCHECK ALLOW POLAR {REASON})\n",
        f"G0 C5. ; POLARCHECK ALLOW RAPID-IN-POLAR {REASON}\n",
        f"G0 C5. ; {COMMENT}\n",
        f"G0 C5. (FAST) {COMMENT} (END)\n",
        f"#1=5.\nG0 C#1 {COMMENT}\n",
    ],
    one_in=4,
)
def test_in_the_block(block: str) -> None:
    program = HEAD + block + TAIL
    line = 3 + block.count("\n")
    assert silent(program) == [(line, "rapid-in-polar", REASON)]
    assert (said(report(program)), report(program).verdict) == ([], "pass")


@looped(
    "block", [f"G1 X30 X35 ; POLARCHECK ALLOW WORD-REPEATED {REASON}", f"; POLARCHECK ALLOW TEXT {REASON}\nG1 X30 X35"]
)
def test_behind_a_semicolon_where_the_control_has_these_comments(block: str) -> None:
    program = f"N10 G94 G18 G0 X60 C0\nTRANSMIT\nG1 X40 F200\n{block}\nG1 Y-5\nTRAFOOF\nM30\n"
    line = 4 + block.count("\n")
    found = silent(program, "word-repeated", "silence", machine="siemens-transmit")
    assert found == [(line, "word-repeated", REASON)]


@pytest.mark.ci
@looped("between", ["", "\n", "\n(ANOTHER COMMENT)\n\n", "N10\n", f"{COMMENT}\n", "N20 (X)\n"])
def test_alone_before_the_block(between: str) -> None:
    program = f"{HEAD}N9 {COMMENT}\n{between}G0 C5.\nG0 C6.\n{TAIL}"
    line = 5 + between.count("\n")
    assert silent(program) == [(line, "rapid-in-polar", REASON)]
    assert said(report(program)) == [(line + 1, "rapid-in-polar")]


def test_the_next_block_alone_is_meant_not_one_behind_a_block_that_only_may_be_skipped() -> None:
    assert said(report(f"{HEAD}{COMMENT}\n/\nG0 C5.\n{TAIL}"))[-1:] == [(6, "rapid-in-polar")]


def test_blocks_that_share_a_line_are_told_apart() -> None:
    blocks = f"{HEAD}G0 C5.;{COMMENT};G0 C6.;G1 C-5.;\nG13.1\n".replace("F200\n", "F200;\n")
    assert [one.column for one in report(blocks).silenced] == [blocks.split("\n")[3].index("G0 C6.") + 1]
    assert len(said(report(blocks))) == 1


@pytest.mark.ci
@looped(
    "head",
    [
        "%\nO0001\n(POLARCHECK ALLOW-FILE {})\n",
        "%\nO0001 (POLARCHECK ALLOW-FILE {})\n",
        "%\n(POLARCHECK ALLOW-FILE {})\nO0001\n",
        "(POLARCHECK ALLOW-FILE {})\n",
        "(POLARCHECK ALLOW-FILE {})\n%\nO0001\n",
        "% POLARCHECK ALLOW-FILE {}\nO0001\n",
        "%POLARCHECK ALLOW-FILE {}\nO0001\n",
        "% (POLARCHECK ALLOW-FILE {})\nO0001\n",
        "%\n:0001 (PART 7)\n(REV B)\nN1 (POLARCHECK ALLOW-FILE {})\n",
        "%\r\nO0001\r\n(POLARCHECK ALLOW-FILE {})\r\n",
    ],
    one_in=3,
)
def test_at_the_head_of_the_file(head: str) -> None:
    program = head.format(f"RAPID-IN-POLAR {REASON}") + RAPID.replace("G1 C-5.", "G0 C-5.")
    line = head.count("\n") + 4
    assert silent(program) == [(line, "rapid-in-polar", REASON), (line + 1, "rapid-in-polar", REASON)]
    assert said(report(program)) == []


def test_the_head_of_a_later_program_is_for_that_one() -> None:
    head = "(POLARCHECK ALLOW-FILE RAPID-IN-POLAR PROVEN)\n"
    program = f"O1\n{RAPID}O2\n{head}{RAPID}O3\n{RAPID}"
    assert silent(program) == [(14, "rapid-in-polar", "PROVEN")]
    assert said(report(program)) == [(5, "rapid-in-polar"), (22, "rapid-in-polar")]


@pytest.mark.ci
@looped("at", [1, 3, 4])
def test_behind_the_head_it_is_not_heeded_and_told(at: int) -> None:
    lines = RAPID.splitlines()
    lines.insert(at, "(POLARCHECK ALLOW-FILE RAPID-IN-POLAR PROVEN)")
    program = "\n".join(lines) + "\n"
    assert not silent(program)
    assert [rule for _, rule in said(report(program))].count("rapid-in-polar") == 1
    (told,) = messages(program, "allow-not-understood")
    assert "ALLOW-FILE stands before the first block" in told


def test_on_the_tape_mark_only_the_file_can_be_allowed() -> None:
    program = f"%POLARCHECK ALLOW RAPID-IN-POLAR {REASON}\n{RAPID}"
    assert not silent(program)
    assert "only ALLOW-FILE" in messages(program, "allow-not-understood")[0]


def test_a_range_takes_the_blocks_of_both_comments() -> None:
    on, off = f"(POLARCHECK ALLOW-ON RAPID-IN-POLAR {REASON})", "(POLARCHECK ALLOW-OFF RAPID-IN-POLAR)"
    blocks = f"G0 C1.\nG0 C2. {on}\nG0 C3.\nG0 C4. {off}\nG0 C5.\n"
    program = HEAD + blocks + TAIL
    assert [line for line, _, _ in silent(program)] == [5, 6, 7]
    assert said(report(program)) == [(4, "rapid-in-polar"), (8, "rapid-in-polar")]


@pytest.mark.ci
@looped(
    ("on", "off", "quiet"),
    [
        ("POLAR", "POLAR", [5]),
        ("POLAR", "RAPID-IN-POLAR", [5]),
        ("RAPID-IN-POLAR", "POLAR", [5]),
        ("RAPID-IN-POLAR", "", [5]),
        ("OVERCUT, RAPID-IN-POLAR", "RAPID-IN-POLAR, OVERCUT", [5]),
        ("RAPID-IN-POLAR", "OVERCUT", [5, 7]),
    ],
)
def test_what_ends_a_range(on: str, off: str, quiet: list[int]) -> None:
    comments = f"(POLARCHECK ALLOW-ON {on} {REASON})\nG0 C5.\n(POLARCHECK ALLOW-OFF {off})\nG0 C6.\n"
    assert [line for line, _, _ in silent(HEAD + comments + TAIL)] == quiet


def test_a_range_without_an_end_reaches_to_the_end_of_the_file_and_is_told() -> None:
    program = f"{HEAD}(POLARCHECK ALLOW-ON RAPID-IN-POLAR {REASON})\nG0 C5.\n{TAIL}O2\n{RAPID}"
    assert len(silent(program)) == 2
    found = report(program)
    assert (said(found), found.verdict) == ([(4, "allow-range-unpaired")], "pass")
    assert messages(program, "allow-range-unpaired")[0].startswith("no ALLOW-OFF RAPID-IN-POLAR closes this range")


@looped("names", ["RAPID-IN-POLAR", "", "POLAR, OVERCUT"])
def test_an_end_without_a_range_is_told(names: str) -> None:
    assert said(report(f"{HEAD}(POLARCHECK ALLOW-OFF {names})\n{TAIL}")) == [(4, "allow-range-unpaired")]


# ---- names ----


@looped(
    ("words", "names", "reason"),
    [
        ("RAPID-IN-POLAR", ["rapid-in-polar"], ""),
        ("RAPID-IN-POLAR, OVERCUT BELOW 0.01", ["rapid-in-polar", "overcut"], "BELOW 0.01"),
        ("RAPID-IN-POLAR ARC-WITHOUT-CENTER FACE", ["rapid-in-polar", "arc-without-center"], "FACE"),
        ("RAPID-IN-POLAR,RAPID-IN-POLAR X", ["rapid-in-polar"], "X"),
        # A reason may begin with the name of a group, or of a rule that is a word of its own.
        ("INTERFERENCE OVERCUT IS BELOW 0.01", ["interference"], "OVERCUT IS BELOW 0.01"),
        ("PATH-NEAR-CENTER FEED IS HELD", ["path-near-center"], "FEED IS HELD"),
        ("FEED PROVEN", ["feed"], "PROVEN"),
        ("RAPID-IN-POLAR -- SAME AS ARC-WITHOUT-CENTER", ["rapid-in-polar"], "SAME AS ARC-WITHOUT-CENTER"),
        ("RAPID-IN-POLAR X-AXIS IS CLEAR", ["rapid-in-polar"], "X-AXIS IS CLEAR"),
        ("Rapid-In-Polar Überlauf geprüft", ["rapid-in-polar"], "Überlauf geprüft"),
    ],
)
def test_names_and_reason(words: str, names: list[str], reason: str) -> None:
    found = read_allow(f"(POLARCHECK ALLOW {words})", NAMES)
    assert (found.kind, list(found.names), found.reason, found.fault) == ("ALLOW", names, reason, "")


@pytest.mark.ci
@looped(
    ("comment", "names", "told"),
    [
        ("POLARCHECK ALLOW", [], "no rule is named"),
        ("POLARCHECK ALLOW -- --", [], "no rule is named"),
        ("POLARCHECK ALLOW ALL", [], "there is no allow for everything"),
        ("POLARCHECK ALLOW RAPID-IN-POLR X", [], "RAPID-IN-POLR; did you mean RAPID-IN-POLAR?"),
        ("POLARCHECK ALLOW RAPID-IN-POL", [], "did you mean RAPID-IN-POLAR?"),
        ("POLARCHECK ALLOW RAPID IN POLAR PROVEN", [], "a name has hyphens: write RAPID-IN-POLAR"),
        ("POLARCHECK ALLOW RAPID, IN POLAR", [], "there is no rule or group RAPID; did you mean"),
        ("POLARCHECK ALLOW PS0146 X", [], "no rule or group PS0146"),
        ("POLARCHECK ALLOW BECAUSE IT WORKS", [], "no rule or group BECAUSE"),
        ("POLARCHECK ALLOW OVERCUT, PROVEN", ["overcut"], "no rule or group PROVEN"),
        ("POLARCHECK ALLOW OVERCUT,", ["overcut"], "a name is missing behind the comma"),
        ("POLARCHECK ALLOW OVERCUT RAPID-IN-POL", ["overcut"], "did you mean RAPID-IN-POLAR?"),
        # What a cut has left of a rule of this group is not the group.
        ("POLARCHECK ALLOW POLAR-", [], "no rule or group POLAR-"),
        ("POLARCHECK ALOW OVERCUT", [], "did you mean ALLOW?"),
        ("POLARCHECK IGNORE OVERCUT", [], "did you mean ALLOW?"),
        ("POLARCHECK ALLOWFILE OVERCUT", [], "did you mean ALLOW-FILE?"),
    ],
    one_in=4,
)
def test_what_is_not_understood_is_told_and_not_heeded(comment: str, names: list[str], told: str) -> None:
    found = read_allow(f"({comment})", NAMES)
    assert list(found.names) == names
    assert told in found.fault
    program = f"{HEAD}G0 C5. ({comment})\n{TAIL}"
    assert "rapid-in-polar" in [rule for _, rule in said(report(program))]
    assert told in messages(program, "allow-not-understood")[0]


@looped(
    "comment",
    ["POLARCHECK ALL OK", "POLARCHECK 0.1 PASS", "SEE POLARCHECK ALLOW", "POLARCHECKED ALLOW X", "POLARCHECK"],
)
def test_comments_that_only_speak_of_it_are_left_alone(comment: str) -> None:
    assert said(report(f"{HEAD}G1 C5. ({comment})\n{TAIL}")) == []


@pytest.mark.ci
def test_a_name_that_a_post_has_cut_is_told() -> None:
    """Some posts end comments behind so many characters."""
    comment = "(POLARCHECK ALLOW CANCEL-SHORTER-THAN-RADIUS PROVEN)"
    for length in range(len("(POLARCHECK ALLOW "), comment.index(" PROVEN"), 3):
        cut = comment[:length] + ")"
        assert messages(f"{HEAD}{cut}\nG1 C5.\n{TAIL}", "allow-not-understood"), cut


def test_a_reason_is_asked_for() -> None:
    program = f"{HEAD}G0 C5. (POLARCHECK ALLOW RAPID-IN-POLAR)\n{TAIL}"
    found = report(program)
    assert ([one.rule for one in found.silenced], said(found)) == (["rapid-in-polar"], [(4, "allow-without-reason")])
    assert found.verdict == "pass"


def test_a_group_allows_its_rules_only() -> None:
    assert silent(f"{HEAD}G0 C5. (POLARCHECK ALLOW MOTION {REASON})\n{TAIL}", *ONLY) == []


# ---- what follows ----

MIRRORED = "T0101\nG98 G0 X100. C0\nG12.1\nG1 G41 X40. F200{}\nC20.\nX-40.\nC-20.\nX40.\nC0\nG40 X100.\nG13.1\nM30\n"


@pytest.mark.ci
def test_what_follows_from_a_finding_that_is_allowed_is_silenced_with_it() -> None:
    plain = report_of(MIRRORED.format(""), "fanuc", "1:radius=4")
    (cause,) = (one for one in plain.findings if one.rule == "side-of-compensation-mirrored")
    assert [one.rule for one in cause.follows] == ["start-up-sweeps-contour"]
    allowed = f" (POLARCHECK ALLOW {cause.rule.upper()} {REASON})"
    found = report_of(MIRRORED.format(allowed), "fanuc", "1:radius=4")
    assert [(one.rule, [follower.rule for follower in one.follows]) for one in found.silenced] == [
        (cause.rule, ["start-up-sweeps-contour"])
    ]
    assert said(found) == []


ROUNDED = (
    "X36. C0 F150/C12./G3 X24. C18. R6./G1 X-24./G3 X-36. C12. R6./G1 C-12./G3 X-24. C-18. R6./G1 X24./"
    "G3 X36. C-12. R6./G1 C0"
)


@pytest.mark.nightly
@looped("control", CONTROLS)
def test_a_move_that_was_tried_and_what_follows_from_it_fail_no_file(control: str) -> None:
    """A square of 36 mm with corners of R6; one of its moves is in rapid traverse, and the setter answers for it."""
    hex_corners = "X36. C0 F150/C10.392/X0 C20.785/X-36. C10.392/C-10.392/X0 C-20.785/X36. C-10.392/C0"
    square = hexagon((hex_corners, ROUNDED))
    assert report_of(square, control, CUTTER).verdict == "pass"
    rapid = square.replace("C12.", "G0 C12. (POLARCHECK ALLOW RAPID-IN-POLAR TRIED)", 1)
    report = report_of(rapid, control, CUTTER)
    assert (report.verdict, [one.rule for one in report.findings if one.severity != "note"]) == ("pass", [])
    (silenced,) = report.silenced
    assert silenced.rule == "rapid-in-polar"


def test_what_follows_can_be_allowed_and_raises_no_severity() -> None:
    allowed = f" (POLARCHECK ALLOW START-UP-SWEEPS-CONTOUR {REASON})"
    found = report_of(MIRRORED.format(allowed), "fanuc", "1:radius=4")
    assert [one.rule for one in found.silenced] == ["start-up-sweeps-contour"]
    (cause,) = (one for one in found.findings if one.rule == "side-of-compensation-mirrored")
    assert cause.follows == []
    assert "allow-without-effect" not in [rule for _, rule in said(found)]


def test_a_finding_for_many_blocks_is_silenced_where_it_is_reported() -> None:
    program = "G98 G0 X60. C0\nG12.1\nG1 X40. F900{}\nX2. C5.{}\nC-5.\nG13.1\nM30\n"
    limit = {"limits": {"c_feed": 300}}
    (found,) = report_of(program.format("", ""), changes=limit, only=["c-feed-above-limit"]).findings
    allow = f" (POLARCHECK ALLOW C-FEED-ABOVE-LIMIT {REASON})"
    texts = [program.format(*(allow if at == line else "" for at in (3, 4))) for line in (3, 4)]
    lines = [report_of(text, changes=limit, only=["c-feed-above-limit"]).silenced for text in texts]
    assert [bool(one) for one in lines] == [found.line == 3, found.line == 4]


@pytest.mark.nightly
def test_silenced_findings_take_no_place_of_others_in_a_list_that_is_cut() -> None:
    on, off = "(POLARCHECK ALLOW-ON RAPID-IN-POLAR X)\n", "(POLARCHECK ALLOW-OFF RAPID-IN-POLAR)\n"
    program = HEAD + on + "G0 C5.\n" * 1100 + off + "G0 C6.\n" + TAIL
    found = report(program)
    assert said(found) == [(1106, "rapid-in-polar")]
    assert len(found.silenced) == 1000
    assert found.verdict == "fail"


# ---- runs, channels, called programs ----


def test_both_states_of_block_skip_give_one() -> None:
    program = f"O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\n/G4 U1.\nG0 C5. {COMMENT}\n/G0 C6. {COMMENT}\n{TAIL}"
    found = report(program)
    assert said(found) == []
    told = [(one.line, "(with block skip off)" in one.message) for one in found.silenced]
    assert told == [(6, False), (7, True)]


def test_in_one_channel() -> None:
    head = f"(POLARCHECK ALLOW-FILE RAPID-IN-POLAR {REASON})\n"
    program = f"$1\n{RAPID}$2\n{RAPID.replace('G0 C5.', f'G0 C5. {COMMENT}')}"
    found = report(program, machine="citizen")
    assert [(one.line, one.channel) for one in found.silenced] == [(13, "$2")]
    assert [(one.line, one.rule, one.channel) for one in found.findings] == [(5, "rapid-in-polar", "$1")]
    found = report(head + program, machine="citizen")
    assert [one.line for one in found.silenced] == [6, 14]
    assert said(found) == []


def test_at_the_head_of_all_channels_one_that_needs_it_is_enough() -> None:
    head = f"(POLARCHECK ALLOW-FILE RAPID-IN-POLAR {REASON})\n"
    program = f"{head}$1\n{RAPID}$2\n{RAPID.replace('G0 C5.', 'G1 C5.')}"
    assert said(report(program, machine="citizen")) == []
    nothing = f"{head}$1\n{RAPID}$2\n{RAPID}".replace("G0 C5.", "G1 C5.")
    assert said(report(nothing, machine="citizen")) == [(1, "allow-without-effect")]


@pytest.mark.ci
@looped(
    ("call", "called", "is_silent"),
    [
        ("M98 P100", "G0 C5.", False),
        (f"M98 P100 {COMMENT}", "G0 C5.", True),
        (f"{COMMENT}\nM98 P100", "G0 C5.", True),
        ("M98 P100", f"G0 C5. {COMMENT}", True),
        ("M98 P100", f"{COMMENT}\nG0 C5.", True),
        ("M98 P100", f"(POLARCHECK ALLOW-FILE RAPID-IN-POLAR {REASON})\nG0 C5.", True),
        ("M98 P100", f"(POLARCHECK ALLOW-ON RAPID-IN-POLAR {REASON})\nG0 C5.", True),
    ],
)
def test_in_a_called_file_and_at_the_call(tmp_path: Path, call: str, called: str, is_silent: bool) -> None:
    (tmp_path / "O0100").write_text(f"{called}\nG1 C-5.\nM99\n")
    program = f"O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\n{call}\nG0 C7.\nG1 C1.\nG13.1\nM30\n"
    found = report_of(program, job={"run": {"subprograms": [str(tmp_path)]}}, only=ONLY)
    line = 5 + call.count("\n")
    assert [one.line for one in found.silenced] == [line] * is_silent
    assert said(found) == [(line, "rapid-in-polar")] * (not is_silent) + [(line + 1, "rapid-in-polar")]


def test_the_head_of_the_calling_file_is_not_that_of_the_called_one(tmp_path: Path) -> None:
    (tmp_path / "O0100").write_text("G0 C5.\nG1 C-5.\nM99\n")
    head = f"(POLARCHECK ALLOW-FILE RAPID-IN-POLAR {REASON})\n"
    program = f"O1\n{head}G98 G0 X60. C0\nG12.1\nG1 X40. F200\nM98 P100\nG1 C1.\nG13.1\nM30\n"
    found = report_of(program, job={"run": {"subprograms": [str(tmp_path)]}}, only=ONLY)
    # It is for all blocks of the file, and the finding is shown at one of them, the call.
    assert [one.line for one in found.silenced] == [6]


# ---- without effect ----

IDLE = f"{HEAD}G1 C5. (POLARCHECK ALLOW RAPID-IN-POLAR, HIGH PROVEN)\n{TAIL}".replace("HIGH", "OVERCUT")


def rules_of(*names: str) -> list[str]:
    return [name for name in RULES if name not in names]


def test_each_name_without_effect_is_told() -> None:
    found = report_of(IDLE)
    (told,) = (one for one in found.findings if one.rule == "allow-without-effect")
    assert (told.line, told.column, told.severity) == (4, 8, "note")
    assert told.message.startswith("RAPID-IN-POLAR, OVERCUT: ")
    half = report_of(IDLE.replace("G1 C5.", "G0 C5."))
    (told,) = (one for one in half.findings if one.rule == "allow-without-effect")
    assert told.message.startswith("OVERCUT: ")


@pytest.mark.ci
@looped(
    ("rules", "severities"),
    [(rules_of("rapid-in-polar"), {}), (rules_of(), {"rapid-in-polar": "off"})],
)
def test_a_rule_that_is_not_asked_gives_no_such_note(rules: list[str], severities: dict[str, str]) -> None:
    program = IDLE.replace(", OVERCUT", "").encode()
    asked = [RULES[name] for name in rules]
    found = check.check_file(program, machine_of(), job_of(), asked, severities=severities)
    assert "allow-without-effect" not in [rule for _, rule in said(found)]
    found = check.check_file(program, machine_of(), job_of(), list(RULES.values()))
    assert "allow-without-effect" in [rule for _, rule in said(found)]


@pytest.mark.ci
@looped(
    ("program", "what"),
    [
        (MIRRORED.format(f" (POLARCHECK ALLOW OVERCUT {REASON})"), "not evaluated without a radius"),
        (IDLE.replace("G13.1\n", ""), "the section is read otherwise"),
        ("G1 C5. (POLARCHECK ALLOW RAPID-IN-POLAR X)\nM99\n", "judged where it is called"),
        (IDLE.replace("RAPID-IN-POLAR", "ALLOW-WITHOUT-EFFECT").replace(", OVERCUT", ""), "itself"),
    ],
)
def test_nor_does_one_of_which_nobody_knows_what_it_would_find(program: str, what: str) -> None:
    assert "allow-without-effect" not in [rule for _, rule in said(report_of(program))], what


def test_the_note_itself_can_be_allowed() -> None:
    program = f"(POLARCHECK ALLOW-FILE ALLOW-WITHOUT-EFFECT TEMPLATE)\n{IDLE}"
    found = report(program)
    assert said(found) == []
    assert [(one.line, one.rule) for one in found.silenced] == [(5, "allow-without-effect")]


def test_comments_that_are_not_heeded_silence_nothing_and_nothing_is_said_of_them() -> None:
    program = RAPID.replace("G0 C5.", f"G0 C5. {COMMENT}").encode() + b"(POLARCHECK ALLOW NOTHING)\n"
    rules = [rule for rule in RULES.values() if rule.name in ONLY or rule.group in ONLY]
    found = check.check_file(program, machine_of(), job_of(), rules, inline=False)
    assert (said(found), found.silenced) == ([(4, "rapid-in-polar")], [])


# ---- what happens to comments on their way ----


def punched(program: str) -> str:
    """As a control puts it out: lower case dropped, N numbers added, LF CR CR, nothing on the line of the %."""
    lines = []
    for number, line in enumerate(program.split("\n")[:-1]):
        kept = re.sub(r"[a-z$!]", "", line)
        if kept.startswith("%"):
            kept = "%"
        elif kept and not kept.startswith("O"):
            kept = f"N{10 * number}{kept}"
        lines.append(kept)
    return "\n\r\r".join([*lines, ""])


@pytest.mark.ci
@looped(
    "program",
    [
        RAPID.replace("G0 C5.", f"G0 C5. {COMMENT}"),
        RAPID.replace("G0 C5.", f"{COMMENT}\nG0 C5."),
        f"%\nO0001 (Part 7)\n(POLARCHECK ALLOW-FILE RAPID-IN-POLAR {REASON})\n{RAPID}%\n",
        RAPID.replace("G0 C5.", f"(POLARCHECK ALLOW-ON POLAR {REASON})\nG0 C5.\n(POLARCHECK ALLOW-OFF POLAR)"),
    ],
)
def test_a_punch_changes_nothing(program: str) -> None:
    before, after = report(program), report(punched(program))
    assert [(one.line, one.rule, one.reason) for one in after.silenced] == [
        (one.line, one.rule, one.reason) for one in before.silenced
    ]
    assert len(before.silenced) == 1
    assert said(after) == said(before) == []


def test_what_a_punch_destroys_is_told_by_the_finding_itself() -> None:
    lower = RAPID.replace("G0 C5.", "G0 C5. (Polarcheck allow rapid-in-polar proven)")
    assert len(report(lower).silenced) == 1
    assert said(report(punched(lower))) == [(4, "rapid-in-polar")]
    on_mark = f"%POLARCHECK ALLOW-FILE RAPID-IN-POLAR {REASON}\nO1\n{RAPID}"
    assert len(report(on_mark).silenced) == 1
    assert said(report(punched(on_mark))) == [(6, "rapid-in-polar")]


@looped("encoding", ["utf-16", "utf-8-sig", "cp1252"])
def test_any_encoding(encoding: str) -> None:
    program = RAPID.replace("G0 C5.", "G0 C5. (POLARCHECK ALLOW RAPID-IN-POLAR geprüft)")
    (found,) = report_of(program.encode(encoding), only=ONLY).silenced
    assert found.reason == "geprüft"


WORDS = st.sampled_from(
    ["RAPID-IN-POLAR", "POLAR", "ALLOW", "ALL", ",", " ", "-", ":", "\n", "(", ")", "%", ";", "O1", "G0"]
)
KINDS = st.sampled_from(["", "-FILE", "-ON", "-OFF"])


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(KINDS, st.one_of(st.binary(max_size=12), st.lists(WORDS, max_size=6).map("".join).map(str.encode)))
    ),
    st.booleans(),
)
def test_any_bytes_behind_it_are_read(parts: list[tuple[str, bytes]], in_head: bool) -> None:
    comments = b"".join(b"(POLARCHECK ALLOW" + kind.encode() + b" " + words + b")\n" for kind, words in parts)
    program = comments + RAPID.encode() if in_head else RAPID.encode().replace(b"G0 C5.\n", comments + b"G0 C5.\n")
    found = report_of(program, only=["rapid-in-polar", "silence"])
    lines = program.count(b"\n") + program.count(b"\r") + 1
    assert all(1 <= one.line <= lines for one in [*found.findings, *found.silenced])
    named = b"RAPID" in comments.upper() or b"POLAR" in comments.upper().replace(b"POLARCHECK", b"")
    assert named or not any(one.rule == "rapid-in-polar" for one in found.silenced)
