"""The feed table: its numbers in closed form, what it makes of a program, and what `polarcheck feeds` shows."""

from __future__ import annotations

import json
import math
import re
from typing import Any

import jsonschema
import numpy as np
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import report_of, tables_of
from test_cli import call, make
from test_dynamics import contours, inside
from test_feed_in_space import SPACE, helices

from polarcheck.rewrite import schemas as schema
from polarcheck.rewrite.feeds.feed_edits import WithFeeds, with_feeds
from polarcheck.rewrite.feeds.table import FeedRow, FeedTable, feed_number, feed_table, highest
from polarcheck.rules.feed_words import feed_below

pytestmark = pytest.mark.usefixtures("own_folder")

SLOW = {"limits": {"c_feed": 3600}}
HEADS = ("line", "block", "F", "highest", "limited by", "allowed", "C deg/min", "s", "s then")
#: A flat 3 off the center, in two halves, and back.
FLAT = inside("G1 X6. C20. F500", "C-20.", "X60.", "C0")


def table_of(program: str, *tools: str, changes: Any = SLOW, **more: Any) -> FeedTable:
    return feed_table(tables_of(program, "fanuc", *tools, changes=changes, **more))


def row_of(program: str, line: int, *tools: str, **more: Any) -> FeedRow:
    [found] = [row for row in table_of(program, *tools, **more).rows if row.line == line]
    return found


def applied(program: str, *tools: str, changes: Any = SLOW, **more: Any) -> WithFeeds:
    tables = tables_of(program, "fanuc", *tools, changes=changes, **more)
    made = with_feeds("a.nc", program.encode(), [tables], None)
    assert made is not None
    return made


# ---- the highest F ----


def test_the_limit_of_c_in_closed_form() -> None:
    row = row_of(FLAT, 6)
    assert row.allowed == pytest.approx(math.radians(3600) * 3, abs=1e-6)
    assert (row.feed, row.highest, row.limited_by) == (500, 188, "C")
    assert row.c_feed == pytest.approx(math.degrees(500 / 3), abs=1e-5)
    assert row.time == pytest.approx(60 * 40 / 500)
    assert row.highest_time == pytest.approx(60 * 40 / 188)


def test_the_limit_of_acceleration_in_closed_form() -> None:
    """On a line C needs 3 sqrt(3) / 8 * F^2 / d^2, in mm/s and rad."""
    limit = 40.0
    row = row_of(FLAT, 6, changes={"limits": {"c_feed": 20000, "c_acceleration": limit}})
    feed = 60 * math.sqrt(math.radians(limit) * 3**2 / (3 * math.sqrt(3) / 8))
    assert row.allowed == pytest.approx(feed)
    assert (row.highest, row.limited_by) == (math.floor(feed), "acceleration of C")


def test_the_limit_of_x_in_closed_form() -> None:
    row = row_of(FLAT, 6, changes={"limits": {"c_feed": 20000, "x_feed": 100}})
    assert row.allowed == pytest.approx(100 * math.hypot(20, 3) / 20)
    assert (row.highest, row.limited_by) == (101, "X")


@pytest.mark.ci
@looped(
    ("changes", "highest", "limited_by"),
    [
        ({"c_feed": 3600}, 188, "C"),
        ({"c_feed": 20000}, 500, "programmed"),
        ({}, 500, "programmed"),
        ({"c_feed": 20000, "polar_feed": 150}, 150, "limit of F in the mode"),
        ({"c_feed": 3600, "polar_feed": 150}, 150, "limit of F in the mode"),
        ({"c_feed": 3600, "automatic_override": True}, 169, "C"),
    ],
)
def test_what_limits_f(changes: dict[str, Any], highest: float, limited_by: str) -> None:
    row = row_of(FLAT, 6, changes={"limits": changes})
    assert (row.highest, row.limited_by) == (highest, limited_by)


def test_at_the_limit_itself_f_is_lowered() -> None:
    """F < L * R * pi / 180: at 1145.9 deg/min 5 mm from the center F 100 is too high."""
    program = inside("G1 X10. C5. F100", "C-5.", "X60.")
    assert row_of(program, 6, changes={"limits": {"c_feed": math.degrees(20)}}).highest == 99
    override = {"c_feed": math.degrees(20), "automatic_override": True, "override_share": 100}
    assert row_of(program, 6, changes={"limits": override}).highest == 100


@pytest.mark.nightly
def test_f_is_rounded_as_messages_do() -> None:
    for feed, points in ((500, ""), (500, "."), (40, ""), (7.5, ""), (0.3, "")):
        for c_feed in (3600, 777, 91, 7.3):
            program = inside("G1 X6. C20. F9000", f"C-20. F{feed}{points}", "X60.")
            tables = tables_of(program, "fanuc", changes={"limits": {"c_feed": c_feed}})
            trace, row = tables["trace"], 5
            told = highest(trace, tables["highest_feeds"])[row]
            below = feed_below(
                trace.blocks, trace.lengths, trace.run, row, float(tables["tool_center"].feed_allowed[row])
            )
            if tables["highest_feeds"].must_be_lower[row]:
                assert below == f"F{feed_number(told, points == '.')}"


def test_through_the_center_no_f_is_low_enough() -> None:
    row = row_of(inside("G1 X-60. F500"), 5)
    assert (row.highest, row.limited_by, row.allowed, row.highest_time) == (None, "center", 0, None)


@looped("block", ["G1 G41 X6. C20. F500\nC-20.", "G99 G1 X6. C20. F.2\nC-20."])
def test_what_is_not_known_has_no_highest_f(block: str) -> None:
    row = row_of(inside(block, "G40 X60."), 6)
    assert (row.highest, row.limited_by) == (None, "not known")


def test_chip_load_needs_teeth_and_s() -> None:
    program = FLAT.replace("G12.1", "G97 S2000 M3\nG12.1")
    assert row_of(program, 7, "1:radius=0,teeth=4").chip_load == pytest.approx(188 / (2000 * 4))
    assert row_of(program, 7, "1:radius=0").chip_load is None
    assert row_of(FLAT, 6, "1:radius=0,teeth=4").chip_load is None
    own = {**SLOW, "m_codes": {"live_tool_on": ["M33"]}}
    assert row_of(program, 7, "1:radius=0,teeth=4", changes=own).chip_load is None
    assert row_of(program.replace("M3\n", "M33\n"), 7, "1:radius=0,teeth=4", changes=own).chip_load == 0.0235


# ---- what it costs ----


def test_times_of_the_table_and_of_one_f_for_all() -> None:
    table = table_of(FLAT)
    [section] = table.sections
    fast = math.hypot(27, 20) + 27 + 20
    assert section.cutting == pytest.approx(60 * (fast + 40) / 500)
    assert section.highest_cutting == pytest.approx(60 * (fast / 500 + 40 / 188))
    assert section.one_feed == 188
    assert section.one_feed_cutting == pytest.approx(60 * (fast + 40) / 188)
    assert section.lost == pytest.approx(60 * 40 * (1 / 188 - 1 / 500), abs=1e-5)
    assert section.won == pytest.approx(60 * fast * (1 / 188 - 1 / 500), abs=1e-5)
    assert table.program.won == section.won
    assert [one.reason for one in table.program.unknown] == ["rapid traverse"]


def test_a_block_of_a_loop_stands_there_once() -> None:
    program = inside("G1 X60. F500", "#1=0", "WHILE[#1LT3]DO1", "G1 X6. C20.", "C-20.", "X60. C0", "#1=#1+1", "END1")
    row = row_of(program, 9)
    assert (row.runs, row.highest, row.several) == (3, 188, False)
    assert row.time == pytest.approx(3 * 60 * 40 / 500)


def test_inch_and_mm_have_the_same_table() -> None:
    inch = "O1\nG20 G98 G0 X2.4 C0\nG12.1\nG1 X.24 C.8 F20.\nC-.8\nX2.4\nG13.1\nM30\n"
    mm = "O1\nG21 G98 G0 X60.96 C0\nG12.1\nG1 X6.096 C20.32 F508.\nC-20.32\nX60.96\nG13.1\nM30\n"
    one, other = table_of(inch), table_of(mm)
    assert (one.units, other.units) == ("inch", "mm")
    for name in ("feed", "allowed", "c_feed", "time", "limited_by"):
        assert [getattr(row, name) for row in one.rows] == pytest.approx([getattr(row, name) for row in other.rows])
    # 7.5398 inch and 191.5 mm, each in three digits of its own.
    assert one.rows[1].highest == pytest.approx(7.53 * 25.4)
    assert other.rows[1].highest == 191


# ---- the program with it ----


@pytest.mark.nightly
@settings(max_examples=15, deadline=None)
@given(st.one_of(contours(), helices()), st.integers(0, 5), st.randoms(use_true_random=False))
def test_the_table_in_its_program_leaves_no_finding_and_no_block_slower_than_it_must_be(
    program: str, radius: int, random: Any
) -> None:
    tool, only = f"1:radius={radius}", ["c-feed-above-limit"]
    limits = {"limits": {"c_feed": 2000}, **SPACE}
    before = tables_of(program, "fanuc", tool, changes=limits)
    made = applied(program, tool, changes=limits)
    after = tables_of(made.data, "fanuc", tool, changes=limits)
    assert not report_of(made.data, "fanuc", tool, changes=limits, only=only).findings
    asked, feeds = highest(before["trace"], before["highest_feeds"]), before["highest_feeds"]
    known = feeds.cuts & ~np.isnan(asked)
    assert after["trace"].feedrate.programmed_feed[known] == pytest.approx(asked[known])
    lowered = np.flatnonzero(feeds.must_be_lower & ~np.isnan(asked))
    if not len(lowered):
        assert made.data == program.encode()
        return
    line = int(before["trace"].blocks.line[random.choice(lowered.tolist())])
    trace = after["trace"]
    feed = float(trace.feedrate.programmed_feed[np.flatnonzero(trace.blocks.line == line)[0]])
    lines = made.data.decode().split("\n")
    raised = max(feed * 1.01, feed + (1 if feed >= 10 else 0))
    lines[line - 1] = re.sub(r" F[\d.]+", "", lines[line - 1]) + f" F{raised:.4f}"
    found = report_of("\n".join(lines), "fanuc", tool, changes=limits, only=only).findings
    assert line in [one.line for one in found]


def test_f_is_lowered_and_restored_as_it_stands() -> None:
    program = FLAT.replace("F500", "F500.")
    made = applied(program).data.decode()
    assert made == program.replace("C-20.", "C-20. F188.").replace("X60.\nC0", "X60. F500.\nC0")
    assert applied(made).data.decode() == made


def test_a_block_with_an_f_of_its_own() -> None:
    program = inside("G1 X6. C20. F800", "C-20. F500", "F300", "X60.", "G13.1", "G1 X70. F100")
    made = applied(program).data.decode()
    assert made == program.replace("F500", "F188")


def test_what_is_behind_the_section_keeps_its_f() -> None:
    program = inside("G1 X6. C20. F500", "C-20.", "G0 X60.").replace("M30", "G1 Z-3.\nM30")
    assert "G1 Z-3. F500\n" in applied(program).data.decode()


def test_a_called_block_gets_the_lowest_f_of_its_runs() -> None:
    """One subprogram near to the center and, at an F that is low anyway, once more."""
    body = "O1\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X6. C20. F500\nM98 P2\nF150\nM98 P2\nX60.\nG13.1\nM30\n"
    program = body + "O2\nG1 C-20.\nC20.\nM99\n"
    made = applied(program)
    assert made.lowest == [13, 14]
    assert "G1 C-20. F150\n" in made.data.decode()
    assert not report_of(made.data, "fanuc", changes=SLOW, only=["c-feed-above-limit"]).findings
    assert [row.several for row in table_of(program).rows if row.line == 13] == [True]


def test_blocks_of_a_loop_have_the_lowest_f_that_one_of_its_runs_needs() -> None:
    program = inside(
        "G1 X60. C20. F500", "#1=0", "WHILE[#1LT3]DO1", "G1 X[6.+4*#1] (IN)", "C-20.", "C20.", "#1=#1+1", "END1"
    )
    made = applied(program)
    text = made.data.decode()
    assert "G1 X[6.+4*#1] F500 (IN)\nC-20. F188\nC20.\n" in text
    assert made.left == []
    assert made.lowest == [9, 10]
    assert not report_of(made.data, "fanuc", changes=SLOW, only=["c-feed-above-limit"]).findings


def test_an_f_that_is_an_expression_is_left_and_said() -> None:
    program = inside("#1=500", "G1 X6. C20. F#1", "C-20. F#1", "C20. F500", "X60.")
    made = applied(program)
    assert made.left == [7]
    assert "C-20. F#1\n" in made.data.decode()
    assert "C20. F188.\n" in made.data.decode()


# ---- the command ----


def feeds(*arguments: Any) -> Any:
    return call("feeds", "a.nc", "--set", "limits.c_feed=3600", *arguments)


def test_the_table_as_text() -> None:
    make(a__nc=FLAT)
    lines = feeds().stdout.split("\n")
    assert lines[0] == "a.nc on fanuc: C 3600 deg/min"
    assert re.split(r" {2,}", lines[1]) == [*HEADS]
    assert lines[3].split() == ["6", "C-20.", "500", "188", "C", "188.496", "9549", "4.80", "12.77"]
    assert "with F188 for all cutting" in feeds().stdout
    assert "rapid traverse, 1 block from line 3: give limits.x_rapid" in feeds().stdout


def test_the_table_as_json_fits_its_schema() -> None:
    make(a__nc=FLAT)
    shown = json.loads(feeds("--format", "json").stdout, parse_constant=pytest.fail)
    jsonschema.Draft202012Validator(schema.schema("feeds")).validate(shown)
    [table] = shown["tables"]
    assert [row["line"] for row in table["rows"]] == [5, 6, 7, 8]
    assert table["rows"][1]["limited_by"] == "C"


def test_the_curve_as_csv() -> None:
    make(a__nc=FLAT)
    head, *rows = feeds("--format", "csv").stdout.split()
    assert head == "time,section,line,feed,true_feed,highest,c_feed,channel"
    values = [row.split(",") for row in rows]
    times = [float(value[0]) for value in values]
    assert times == sorted(times)
    assert times[-1] == pytest.approx(60 * (math.hypot(27, 20) + 40 + 27 + 20) / 500, abs=1e-5)
    fastest = max(float(value[6]) for value in values if value[2] == "6")
    assert fastest == pytest.approx(math.degrees(500 / 3), abs=1e-5)


def test_the_diff() -> None:
    make(a__nc=FLAT)
    assert feeds("--diff").stdout.split("\n")[5:12] == [
        " G1 X6. C20. F500",
        "-C-20.",
        "-X60.",
        "+C-20. F188",
        "+X60. F500",
        " C0",
        " G13.1",
    ]
    assert "leave out --format json" in feeds("--diff", "--format", "json").output


def test_a_program_without_a_section() -> None:
    make(a__nc="O1\nG0 X60.\nM30\n")
    assert "no block cuts in the polar mode" in feeds().stdout
    assert feeds("--diff").stdout == ""


def test_text_of_a_program_is_shown_and_does_not_act() -> None:
    make(a__nc=FLAT.replace("C-20.", "C-20. (\x1b[31m<script>)"))
    assert "\x1b" not in feeds().stdout
    assert "\\x1b[31m<script>" in feeds().stdout
