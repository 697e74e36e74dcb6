"""What a machine file lacks is told with the place where it is to be added."""

from __future__ import annotations

from pathlib import Path

import pytest
from cases import looped
from programs import report_of, said

from polarcheck.program.machines import profiles

PROGRAM = "O1\nT0101\n{}\nG98 G0 X60. C0\nG12.1\nG1 X40. F{}\nC10.\nX60.\nG13.1\nM30\n"
IN_FILE, IN_NEW = "lathe.toml", "a file of your own (polarcheck machines new)"


@pytest.fixture(autouse=True)
def _in_an_empty_folder(own_folder: None) -> None:
    pass


def messages(values: str, before: str, feed: str = "200") -> dict[str, str]:
    """What is found on a lathe of one's own, by rule."""
    Path("lathe.toml").write_text(f"inherits = 'fanuc-30i'\n{values}\n", "utf-8")
    program = PROGRAM.format(before.replace(" / ", "\n"), feed)
    report = report_of(program, profiles.load("lathe.toml").machine, "1:radius=4")
    return {finding.rule: finding.message for finding in report.findings} | {
        f"no {entry.rule}": entry.reason for entry in report.not_evaluated
    }


@pytest.mark.ci
@looped(
    ("values", "before", "rule", "told"),
    [
        ("[m_codes]\nc_axis_on = ['M35']", "M8\nM76", "c-axis-not-engaged",
         "; if M76 of line 4 engages it, add that to m_codes.c_axis_on in lathe.toml"),
        ("[m_codes]\nc_axis_on = ['M35']", "M76 / M70 / M76", "c-axis-not-engaged",
         "; if M76 of line 3 or M70 of line 4 engages it, add that to m_codes.c_axis_on in lathe.toml"),
        ("[m_codes]\nc_axis_on = ['M35']", "M8 / M9", "c-axis-not-engaged", "M35 is missing before G12.1"),
        ("[m_codes]\nlive_tool_on = ['M33']", "M76", "live-tool-stopped-in-cut",
         "; if M76 of line 3 starts it, add that to m_codes.live_tool_on in lathe.toml"),
        ("[m_codes]\nspindle_on = ['M3 P11']\nlive_tool_on = ['M3 P12']", "M3 P14", "live-tool-stopped-in-cut",
         "; if M3 P14 of line 3 starts it, add that to m_codes.live_tool_on in lathe.toml"),
        ("", "G245", "unknown-code", "; if the lathe has it, add it to control.known_codes in lathe.toml"),
        ("", "G4.7", "unknown-code", "; if the lathe has it, add it to control.known_codes in lathe.toml"),
        ("", "G4.75", "unknown-code", "G4.75 is no code of this control"),
        ("", "M35", "no c-axis-not-engaged",
         "names no code that engages the C axis: if M35 of line 3 does, add it to m_codes.c_axis_on in lathe.toml"),
        ("", "M33", "no live-tool-stopped-in-cut",
         "code that starts the live tool: if M33 of line 3 does, add it to m_codes.live_tool_on in lathe.toml"),
        ("[polar]\nlinear_axis = 2", "M8", "no all",
         'give their names in order, as control.axes = ["X", "Z", "C"] in lathe.toml'),
    ], one_in=3,
)  # fmt: skip
def test_a_lathe_of_ones_own_is_told_where_to_add(values: str, before: str, rule: str, told: str) -> None:
    assert messages(values, before)[rule].endswith(told)


@looped(
    ("values", "before"),
    [
        ("", "M8 / M9 / M6 / M3 S500"),
        ("[m_codes]\nc_axis_on = ['M35']\nlive_tool_on = ['M33']", "M35 / M33 S500 / M77"),
        ("[m_codes]\ntool_change = ['M77']", "M77"),
    ],
)
def test_nothing_is_told_to_be_added_where_nothing_may_be_meant(values: str, before: str) -> None:
    assert not {"no c-axis-not-engaged", "no live-tool-stopped-in-cut"} & set(messages(values, before))


def test_a_code_of_another_program_is_not_the_one() -> None:
    Path("lathe.toml").write_text("inherits = 'fanuc-30i'\n[m_codes]\nc_axis_on = ['M35']\n", "utf-8")
    two = "O2\nM77\nM30\n" + PROGRAM.format("M8", 200)
    report = report_of(two, profiles.load("lathe.toml").machine, only=["c-axis-not-engaged"])
    assert [finding.message.endswith("before G12.1") for finding in report.findings] == [True]


def test_what_the_file_lacks_has_no_weight() -> None:
    Path("lathe.toml").write_text("inherits = 'fanuc-30i'\n", "utf-8")
    report = report_of(PROGRAM.format("M35", 200), profiles.load("lathe.toml").machine, only=["c-axis-not-engaged"])
    assert [entry.matters for entry in report.not_evaluated] == [False]
    assert report.verdict == "pass"


@pytest.mark.ci
@looped(("feed", "key"), [("900", "no c-feed-above-limit"), ("90000", "c-feed-above-limit")])
def test_the_limit_of_c_is_asked_for_where_it_belongs(feed: str, key: str) -> None:
    assert "limits.c_feed in lathe.toml" in messages("", "M8", feed.replace("900", "9000", 1))[key]
    program = PROGRAM.format("M8", feed.replace("900", "9000", 1))
    report = report_of(program, "fanuc-30i", "1:radius=4")
    told = [found.message for found in report.findings] + [entry.reason for entry in report.not_evaluated]
    assert any("--set limits.c_feed=..." in text for text in told)


@looped(
    ("before", "rule", "told"),
    [
        ("G245", "unknown-code", f"; if the lathe has it, add it to control.known_codes in {IN_NEW}"),
        ("M76", "c-axis-not-engaged", f"; if M76 of line 3 engages it, add that to m_codes.c_axis_on in {IN_NEW}"),
    ],
)
def test_on_a_machine_of_ours_a_file_is_to_be_made(before: str, rule: str, told: str) -> None:
    changes = {"m_codes": {"c_axis_on": ["M35"]}}
    report = report_of(PROGRAM.format(before, 200), "fanuc-30i", "1:radius=4", changes=changes)
    assert next(found.message for found in report.findings if found.rule == rule).endswith(told)


def test_on_a_machine_of_ours_the_codes_of_the_builder_are_not_asked_for() -> None:
    report = report_of(PROGRAM.format("M35", 200), "fanuc-30i", "1:radius=4")
    assert not {"c-axis-not-engaged", "live-tool-stopped-in-cut"} & {entry.rule for entry in report.not_evaluated}


def test_a_file_that_inherits_from_a_file_is_the_one_to_add_to() -> None:
    Path("shop.toml").write_text("inherits = 'fanuc-30i'\n", "utf-8")
    Path("lathe.toml").write_text("inherits = 'shop.toml'\n", "utf-8")
    report = report_of("G245\n", profiles.load("lathe.toml").machine, only=["unknown-code"])
    assert said(report) == [(1, "unknown-code")]
    assert report.findings[0].message.endswith("control.known_codes in lathe.toml")
