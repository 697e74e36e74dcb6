"""Programs that could take hours: bounds by counting give up loop by loop, the limit of time the rest; both say so."""

from __future__ import annotations

import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped
from click.testing import CliRunner
from clocks import Clock, even, jump
from polarcheck.errors import StoppedError, TooHardError
from programs import ROOT, report_of, said, tables_of

from polarcheck.columns.contour import fitting_radius
from polarcheck.commands import main
from polarcheck.foundation.finding import FileReport
from polarcheck.foundation.states import Motion
from polarcheck.foundation.time_limit import keep_time, time_limit
from polarcheck.geometry import segments
from polarcheck.geometry.overcuts import bounds
from polarcheck.geometry.polygons import areas, noding
from polarcheck.geometry.segments import Curves

sys.path.insert(0, str(ROOT / "benchmarks"))

from hard_programs import FAMILIES, in_mode, loop, run
from hard_programs import contour as square

MACHINE, TOOL = "fanuc-30i", "1:radius=4"
#: Every table that rules compare and that is made of contours.
HARD_RULES = {"overcut", "slot-narrower-than-cutter", "uncompensated-cut-into-part", "material-left"}


def given_up(report: FileReport) -> dict[str, str]:
    """The reasons, by rule, of what matters and was not evaluated; of several the last."""
    return {missing.rule: missing.reason for missing in report.not_evaluated if missing.matters}


def checked(program: str, *tools: str) -> FileReport:
    return report_of(program, MACHINE, *(tools or (TOOL,)))


# ---- without any time ----


@pytest.mark.ci
@looped("family", FAMILIES, one_in=42)
def test_without_any_time_a_check_ends_and_says_so(family: str) -> None:
    """What needs no time is judged as ever; a file is never passed whose contours nobody has looked at."""
    program = FAMILIES[family].make(200)
    tools = [f"{number}:radius=4" for number in range(1, FAMILIES[family].offsets + 1)]
    whole = checked(program, *tools)
    with time_limit(-1):
        report = checked(program, *tools)
    reasons = given_up(report)
    if any("--max-seconds" in reason for reason in reasons.values()):
        assert report.verdict != "pass"
    else:
        assert said(report) == said(whole)
    late = {rule for rule, reason in reasons.items() if "--max-seconds" in reason}
    left = {(line, rule) for line, rule in said(whole) if rule not in late}
    following = {(found.line, found.rule) for each in whole.findings for found in each.follows}
    assert left <= set(said(report)) | following


@pytest.mark.nightly
def test_the_limit_is_kept_wherever_it_runs_out() -> None:
    """A few milliseconds end anywhere: in a table, in a trial, in a message."""
    program = FAMILIES["overcut-loops"].make(400)
    for milliseconds in (1, 5, 20, 60, 150, 400):
        with time_limit(milliseconds / 1000):
            report = checked(program)
        assert report.verdict == "fail" or any("--max-seconds" in reason for reason in given_up(report).values())


@looped("family", ["zigzag", "bosses", "overcut-loops", "passes", "slanted-leads", "bare-moves"], one_in=12)
@looped("seconds", [-1, 0.01])
def test_every_column_of_contours_is_there_or_given_up(family: str, seconds: float) -> None:
    tables = tables_of(FAMILIES[family].make(200), MACHINE, TOOL)
    asked = 0
    for name in ("overcuts", "slots", "uncompensated_cuts", "coverage", "mirrored", "fitting"):
        table = tables[name]
        for column in dir(type(table)):
            if column.startswith("_") or callable(getattr(type(table), column)):
                continue
            asked += 1
            with time_limit(seconds):
                try:
                    getattr(table, column)
                except TooHardError as error:
                    assert "--max-seconds" in str(error)  # noqa: PT017 - either is right
    assert asked > 30


# ---- loops that are given up by themselves ----

#: A square of 40 with a groove of 6 mm, which a cutter of R4 cuts into in lines 8 and 14.
GROOVE = [
    "G1 C3. F500",
    "G41 X60. F200",
    *("X30.", "C20.", "X-20.", "C-20.", "X30.", "C-3.", "X60."),
    "G40 X100.",
]
CIRCLES = [f"G3 X80. C0 I-{9_000_000 + number}. J0" for number in range(30)]
BEYOND = {
    "a point too far": (["X300000.", "C10."], "reaches farther than 100000 mm"),
    "a point as far as there are": (["X9999999.", "C10."], "reaches farther than 100000 mm"),
    "circles with too many chords": ([*CIRCLES, "G1 C10."], "arcs of more than 400000 chords"),
}


@pytest.mark.one_in(3)
@pytest.mark.nightly
@pytest.mark.parametrize("case", BEYOND)
def test_a_loop_beyond_all_bounds_is_left_out_alone(case: str) -> None:
    """The other one is judged as if it stood there by itself."""
    blocks, reason = BEYOND[case]
    alone = checked(in_mode([*GROOVE, "G1 X100. C0"]))
    both = checked(in_mode([*GROOVE, "G1 X100. C0", *loop(blocks, 40 + 0j)]))
    cut = [line for line, rule in said(alone) if rule == "overcut"]
    assert cut
    assert [line for line, rule in said(both) if rule == "overcut"] == cut
    assert reason in given_up(both)["overcut"]
    assert "at line 19 " in given_up(both)["overcut"]


WITHOUT_MEASURE = {
    "a number of 150 digits": [f"X{'9' * 150}.", "C10."],
    "an arc of 150 digits": [f"G3 X70. C5. I-{'7' * 150}. J{'3' * 150}.", "G1 C10."],
    "an R of 150 digits": [f"G2 X70. C5. R{'7' * 150}.", "G1 C10."],
}


@pytest.mark.nightly
@looped("case", WITHOUT_MEASURE, one_in=3)
def test_numbers_without_measure_leave_the_other_loop_as_it_is(case: str) -> None:
    alone = checked(in_mode([*GROOVE, "G1 X100. C0"]))
    both = checked(in_mode([*GROOVE, "G1 X100. C0", *loop(WITHOUT_MEASURE[case], 40 + 0j)]))
    cut = [line for line, rule in said(alone) if rule == "overcut"]
    assert cut
    assert [line for line, rule in said(both) if rule == "overcut"] == cut
    assert "too-many-digits" in {rule for _, rule in said(both)}


def test_far_moves_elsewhere_leave_a_sound_contour_sound() -> None:
    """A contour beyond all bounds in another section is no reason to say anything of this one."""
    sound = square(6, 30)
    assert not said(checked(in_mode(sound)))
    both = checked(in_mode([*sound, "G13.1", "G0 X250. C0", "G12.1", *loop(["X300000.", "C10."], 40 + 0j)]))
    assert not [line for line, rule in said(both) if line <= len(sound) + 6 and rule in HARD_RULES]


def test_of_loops_with_too_many_chords_the_longest_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those with more than a loop may have, then the longest, until a file has few enough; each arc counts once."""
    radius = np.array([10.0, 20, 30, 30, 40])
    number = np.array([0, 1, 2, 2, 3])
    curves = Curves(radius + 0j, radius + 0j, np.zeros(5, complex), np.full(5, Motion.CCW), number, number)
    count = segments.chord_counts(curves, 0.002)
    assert count == pytest.approx(np.pi / np.arccos(1 - 0.0005 / radius), abs=1)
    assert len(segments.segments(curves, 0.002)) == round(count.sum())
    assert not len(bounds.long_loops(curves, 0.002))
    monkeypatch.setattr(bounds, "CHORDS", 600)
    assert bounds.long_loops(curves, 0.002).tolist() == [3]
    monkeypatch.setattr(bounds, "CHORDS_OF_FILE", 800)
    assert bounds.long_loops(curves, 0.002).tolist() == [2, 3]
    monkeypatch.setattr(segments, "CHORDS_OF_FILE", 800)
    with pytest.raises(TooHardError, match="chords are too many to look at"):
        segments.segments(curves, 0.002)


def test_only_so_many_loops_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    report = checked(in_mode(block for _ in range(30) for block in loop(["X300000.", "C10."], 40 + 0j)))
    reasons = [missing for missing in report.not_evaluated if missing.rule == "overcut"]
    assert len(reasons) == 21
    assert reasons[-1].reason.startswith("each of 10 more contours reaches")
    # The start-up, which lies outside, is of the loop as well.
    assert reasons[-1].blocks == 10 * reasons[0].blocks


@pytest.mark.nightly
def test_walls_that_only_together_are_too_many_are_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether the tool fits between contours is open where they cross again and again, and nobody passes that."""
    program = FAMILIES["nested-squares"].make(200)
    assert checked(program).verdict == "pass"
    monkeypatch.setattr(noding, "_PAIRS", 0)
    monkeypatch.setattr(noding, "_FREE_PAIRS", 60)
    report = checked(program)
    assert report.verdict == "unverified"
    assert "crosses itself or others beside it" in given_up(report)["slot-narrower-than-cutter"]


def all_rules(report: FileReport) -> set[str]:
    """The rules of the findings, and of those that follow from them."""
    return {one.rule for finding in report.findings for one in (finding, *finding.follows)}


@pytest.mark.nightly
def test_what_is_not_looked_for_is_said_without_weight(monkeypatch: pytest.MonkeyPatch) -> None:
    from polarcheck.geometry.material_left import ribs, strips

    for family, module, bound in (("slanted-leads", ribs, "_PAIRS"), ("passes", strips, "_MOST_PIECES")):
        program = FAMILIES[family].make(200)
        assert "material-left" in all_rules(checked(program))
        with monkeypatch.context() as patch:
            patch.setattr(module, bound, -1)
            report = checked(program)
        assert "material-left" not in all_rules(report)
        missing = next(one for one in report.not_evaluated if one.rule == "material-left")
        assert "nobody has looked for what stays between them" in missing.reason
        assert not missing.matters


def test_a_pass_that_is_written_once_more_deeper_sweeps_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    """Thirty depths of one contour are looked at as one."""
    from polarcheck.geometry.material_left import strips

    one = [*square(24, 60), *square(24, 50)]
    blocks = [block for depth in range(30) for block in ("G1 Z2. F500", "X250. C0", f"G1 Z-{depth + 1}.", *one)]
    monkeypatch.setattr(strips, "_MOST_PIECES", 4 * len(one))
    assert "material-left" in {rule for _, rule in said(checked(in_mode([*blocks, "G1 Z2."])))}


# ---- the same, with less ----


@pytest.mark.nightly
def test_loops_that_begin_in_a_row_are_held_together_by_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    """What they are cut into grows with their number, not with its square."""
    from polarcheck.geometry.polygons import faces

    counts = []
    for moves in (200, 400):
        found = []

        def kept(*given: Any, found: list[int] = found) -> Any:
            edges = noding.noded(*given)
            found.append(len(edges.wall))
            return edges

        with monkeypatch.context() as patch:
            patch.setattr(faces, "noded", kept)
            checked(FAMILIES["nested-squares"].make(moves))
        counts.append(max(found))
    assert counts[1] < 2.2 * counts[0]


def test_a_trial_is_given_up_between_two_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    tables = tables_of(in_mode(GROOVE), MACHINE, TOOL)
    assert tables["fitting"]._candidates.any()
    tried = []
    monkeypatch.setattr(fitting_radius, "keep_time", lambda: tried.append(1))
    assert tables["fitting"].radius[-1] == pytest.approx(3, rel=0.02)
    assert 0 < len(tried) <= fitting_radius._TRIALS


def test_walls_without_a_length_meet_nothing() -> None:
    """Points nearer than a touch are one; nothing is divided by what lies between them."""
    start, end = np.array([0, 1, 1 + 1e-9, 0.5 - 1j]), np.array([1, 1 + 1e-9, 2, 0.5 + 1j])
    edges = noding.noded(start, end, np.zeros(4, np.int64))
    assert edges.wall.tolist() == [0, 0, 2, 3, 3]
    assert not edges.tangled.any()


# ---- areas ----


def test_areas_without_an_answer_are_too_hard() -> None:
    bow = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    with pytest.raises(TooHardError, match="areas of its contours cannot be computed"):
        areas.intersection(bow, shapely.box(0.5, 0.5, 3, 3))
    with pytest.raises(TooHardError, match="areas of its contours cannot be computed"):
        areas.difference(np.array([shapely.box(0, 0, 1, 1), bow]), shapely.box(0.5, 0.5, 3, 3))


def test_areas_are_taken_in_portions(monkeypatch: pytest.MonkeyPatch) -> None:
    boxes = shapely.box(np.arange(20), 0, np.arange(20) + 1.5, 1)
    whole = areas.intersection(boxes, boxes[3])
    asked = []
    monkeypatch.setattr(areas, "_AT_A_TIME", 30)
    monkeypatch.setattr(areas, "keep_time", lambda: asked.append(1))
    assert (areas.intersection(boxes, boxes[3]) == whole).all()
    assert len(asked) == 7
    assert shapely.area(areas.buffer(boxes, 1.0)) == pytest.approx(shapely.area(shapely.buffer(boxes, 1.0)))
    assert not len(areas.make_valid(boxes[:0]))
    assert areas.union(boxes[0], boxes[1]).area == pytest.approx(2.5)
    monkeypatch.setattr(areas, "_MOST", 90)
    with pytest.raises(TooHardError, match="100 points are too many"):
        areas.union_all(boxes)
    assert (areas.intersection(boxes, boxes[3]) == whole).all()


def test_points_are_compared_in_portions(monkeypatch: pytest.MonkeyPatch) -> None:
    from polarcheck.geometry.material_left import ribs

    count = 5
    start = np.arange(count) * (1 + 1j)
    none = np.zeros(count, np.int64)
    swept = ribs.Swept(start, start + 3j, none, np.ones(count), np.zeros(count), none)
    point = np.linspace(-3, 3, 7) - 4j
    whole = ribs.first_tool(swept, swept.radius, point, np.full(7, 1j))
    monkeypatch.setattr(ribs, "_PAIRS_AT_A_TIME", 1)
    assert (ribs.first_tool(swept, swept.radius, point, np.full(7, 1j)) == whole).all()
    assert np.isfinite(whole).all()


# ---- whole processes ----


@pytest.mark.one_in(6)
@pytest.mark.nightly
@pytest.mark.skipif(sys.platform == "win32", reason="no limit of address space there")
@pytest.mark.parametrize(
    ("family", "moves", "reason"),
    [
        ("zigzag", 3000, "crosses itself more than"),
        ("half-circles", 1000, ""),
        ("long-digits", 1000, ""),
        ("huge-circles", 500, ""),
        ("wide-circles", 500, "arcs of more than"),
        ("sections", 4000, ""),
    ],
)
def test_a_check_stays_within_its_memory(family: str, moves: int, reason: str, tmp_path: Path) -> None:
    """Without the bounds each of the first five took some gigabytes, or ran for ever."""
    path = tmp_path / "hard.nc"
    path.write_text(FAMILIES[family].make(moves), encoding="ascii")
    found = run(path, 300, 1500)
    assert not found.fault
    assert found.megabytes < 1000
    assert not reason or any(reason in told for told in found.not_evaluated)


# ---- when nobody waits any more ----


@pytest.mark.nightly
@looped("turns", [0, 3, 100], one_in=5)
@looped("program", ["G12.1\nG1 X4. F100\nG13.1\nM30\n", "#1=1\nWHILE[#1GT0]DO1\n#1=#1+1\nEND1\nM30\n"])
def test_a_check_that_nobody_waits_for_ends_at_its_next_turn(program: str, turns: int) -> None:
    """Not as one that was too hard, which would be a report: its outcome is of no interest."""
    asked: list[int] = []

    def is_stopped() -> bool:
        asked.append(1)
        return len(asked) > turns

    with pytest.raises(StoppedError), time_limit(60, is_stopped):
        checked(program)
    assert len(asked) == turns + 1


def test_all_that_is_done_for_a_file_has_one_clock() -> None:
    """Neither the execution, once for each state of block skip, nor a limit inside another has time of its own."""
    loop = "O1\n/#1=1\n#2=0\nWHILE[#2LT900000]DO1\n#2=#2+1\nEND1\nM30\n"
    run = {"max_seconds": 1e9, "max_statements": 10**9, "max_blocks": 10**9}
    with time_limit(1e-6):
        report = report_of(loop, "fanuc", job={"run": run})
    assert "seconds" in str(report.findings) or "longer" in str(report.findings)
    with time_limit(1e-6), time_limit(1e9), pytest.raises(TooHardError, match="longer"):
        keep_time()


# ---- beside other work ----


#: Both are given up somewhere: contours, and a loop that no count would end for long.
GIVEN_UP = {
    "contours": FAMILIES["overcut-loops"].make(14),
    "loop": "O1\n#1=0\nWHILE[#1LT900]DO1\n#1=#1+1\nEND1\nM30\n",
}


@pytest.mark.nightly
@pytest.mark.one_in(4)
@pytest.mark.parametrize(
    "share", [0.5, pytest.param(0.1, marks=pytest.mark.ci), pytest.param(0.9, marks=pytest.mark.ci)]
)
@pytest.mark.parametrize("program", GIVEN_UP.values(), ids=list(GIVEN_UP))
def test_a_program_is_given_up_at_the_same_place_on_a_busy_machine(
    program: str, share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    def checked_in(seconds: float, busy: float) -> tuple[FileReport, Clock]:
        """The report, where each step takes `busy` times as long on the wall as at the processor."""
        clock = Clock(even, lambda looks: busy * even(looks))
        with monkeypatch.context() as patched:
            clock.use(patched)
            with time_limit(seconds):
                return checked(program), clock

    whole, clock = checked_in(1e6, 1)
    seconds = even(4 * int(share * clock.looks / 4))
    alone, _ = checked_in(seconds, 1)
    assert alone != whole
    for busy in (1.5, 9):
        report, clock = checked_in(seconds, busy)
        assert report == alone
        # A look at the clock of the thread costs more.
        assert clock.looks_at_thread < 20 * busy
    # The last resort is ten times as long on the wall.
    waiting, quarter = checked_in(seconds, 40)[0], checked_in(seconds / 4 + even(1), 1)[0]
    assert (said(waiting), given_up(waiting).keys()) == (said(quarter), given_up(quarter).keys())
    assert waiting.blocks == quarter.blocks


@pytest.mark.parametrize(
    ("work", "wall", "is_late"), [(0, 9.9, False), (0, 10.1, True), (0.9, 9.9, False), (1.1, 1.2, True)]
)
@pytest.mark.parametrize("inner", [1, 100])
def test_work_counts_and_waiting_a_tenth(
    work: float, wall: float, is_late: bool, inner: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Within another limit as well, which may be longer."""
    Clock(lambda looks: work * (looks > 2), lambda looks: wall * (looks > 2)).use(monkeypatch)
    with time_limit(1) as outer, time_limit(inner) as limit:
        assert limit.is_late() == is_late
        assert outer.is_late() == is_late


def spin(seconds: float) -> None:
    """Work for so long."""
    end = time.thread_time() + seconds
    while time.thread_time() < end:
        pass


@pytest.mark.nightly
@pytest.mark.parametrize("is_seen_by_others", [True, False])
def test_the_time_of_a_limit_is_that_of_its_thread(is_seen_by_others: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Others read it; where only the thread itself can, they see the work of the process since."""
    if not is_seen_by_others:
        monkeypatch.delattr(time, "pthread_getcpuclockid", raising=False)
    elif not hasattr(time, "pthread_getcpuclockid"):
        pytest.skip("no thread sees the clock of another")
    spin(0.05)
    with time_limit(1) as limit:
        for _ in range(2):
            assert limit.clock() == pytest.approx(time.thread_time(), abs=0.05)
            before = limit.clock()
            worker = threading.Thread(target=spin, args=[0.15])
            worker.start()
            worker.join()
            assert limit.clock() - before < 0.1
        before = limit.clock()
        seen = []

        def look() -> None:
            seen.append(limit.clock())
            spin(0.15)
            seen.append(limit.clock())

        worker = threading.Thread(target=look)
        worker.start()
        worker.join()
        assert seen[0] - before < 0.1
        assert (seen[1] - seen[0] < 0.1) == is_seen_by_others


# ---- the time runs out at any look at the clock ----


@pytest.mark.ci
@pytest.mark.one_in(12)
@pytest.mark.parametrize("side", ["", "G42 "])
@pytest.mark.parametrize(
    "words",
    [["feeds"], ["check", "--part"], ["check", "--format", "html"], ["part"], ["plot", "-o", "a.html"], ["trace"]],
    ids=" ".join,
)
def test_every_command_ends_in_a_report_when_the_time_runs_out(
    words: list[str], side: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wherever that is: in a table, in the part, in the page."""
    text = FAMILIES["overcut-loops"].make(60).replace("G42 ", side)
    monkeypatch.chdir(tmp_path)

    def looks_of(last: float) -> int:
        clock = Clock(jump(last))
        with monkeypatch.context() as patched:
            clock.use(patched)
            result = CliRunner().invoke(main, [*words, "-", "--no-config", *TOOLS], input=text)
        assert result.exit_code in (0, 1), (last, result.stderr)
        return clock.looks

    every = looks_of(float("inf"))
    for last in sorted({1, 2, every - 1, every - 2, *range(3, every, max(every // 6, 1))}):
        looks_of(last)


TOOLS = ["--machine", "fanuc-30i", "--tool", "1:radius=4"]
