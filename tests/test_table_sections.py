"""Where the polar mode begins and ends, as it is programmed and as it was meant."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
from cases import looped
from programs import machine_of, report_of, said, trace_of

from polarcheck.columns.modes.sections import Marks, Sections, find_sections, section_column
from polarcheck.foundation.arrays import Mask

HEAD = "O1\nG21 G98\nT0101\nG0 X60. C0\n"


def sections(program: str) -> list[tuple[int, int, bool]]:
    """Line of the G12.1, line of the first row behind the section (0: none), whether its G13.1 is there."""
    trace = trace_of(HEAD + program)
    lines = [*trace.blocks.line.tolist(), 0]
    found = trace.mode.sections
    columns = (found.enter.tolist(), found.leave.tolist(), found.left.tolist())
    return [(lines[enter] - 4, max(lines[leave] - 4, 0), left) for enter, leave, left in zip(*columns, strict=True)]


@looped(
    ("program", "expected"),
    [
        ("G12.1\nG1 X40. F100\nC5.\nG13.1\nM30\n", [(1, 4, True)]),
        ("G12.1\nG1 X40. F100\nG13.1\nG0 X60. C0\nG12.1\nG1 X40.\nG13.1\nM30\n", [(1, 3, True), (5, 7, True)]),
        # What follows the last cut can only stand outside: there the G13.1 is missing.
        ("G12.1\nG1 X40. F100\nC5.\nG0 X80.\nG28 U0\nM30\n", [(1, 4, False)]),
        ("G12.1\nG1 X40. F100\nC5.\nT0202\nG0 X80.\nM30\n", [(1, 4, False)]),
        ("G12.1\nG1 X40. F100\nC5.\nM30\n", [(1, 4, False)]),
        # A G0 between cuts is a fault of its own and ends nothing.
        ("G12.1\nG1 X40. F100\nG0 X50.\nG1 C5.\nG13.1\nM30\n", [(1, 5, True)]),
        # A G12.1 again, before anything could only stand outside, is none that begins a section.
        ("G12.1\nG1 X40. F100\nG12.1\nG1 C5.\nG13.1\nM30\n", [(1, 5, True)]),
        ("G12.1\nG1 X40. F100\nC5.\nG0 X80. Z5.\nG12.1\nG1 X40.\nC5.\nG13.1\nM30\n", [(1, 4, False), (5, 8, True)]),
        ("G12.1\nG1 X40. F100\nC5.\nG28 U0\nG12.1\nG1 X40.\nC5.\nG13.1\nM30\n", [(1, 4, False), (5, 8, True)]),
        ("G12.1\nG1 X40. F100\nC5.\nT0202\nG12.1\nG1 X40.\nC5.\nG13.1\nM30\n", [(1, 4, False), (5, 8, True)]),
        # Turning by the same tool behind a G0 is no part of the section, be its last cut a circle.
        ("G12.1\nG1 X40. F100\nC5.\nX60.\nG0 X62.\nG99 G1 Z-9. F.2\nX66.\nG0 Z5.\nM30\n", [(1, 5, False)]),
        ("G12.1\nG1 X40. F100\nG3 I-20. J0\nG1 X60.\nG0 X62.\nG1 Z-9.\nX66.\nG0 Z5.\nM30\n", [(1, 5, False)]),
        # A move in X alone after G28 does not bring the mode back.
        ("G12.1\nG1 X40. F100\nC5.\nG28 U0\nG1 X30.\nT0202\nM30\n", [(1, 4, False)]),
        # M1 before the retract, or anywhere in the work of a tool, ends nothing.
        ("G12.1\nG1 X40. F100\nC5.\nM1\nX60.\nG13.1\nM30\n", [(1, 6, True)]),
        ("G12.1\nG1 X40. F100\nC5.\nM01\nG0 X60.\nG13.1\nM30\n", [(1, 6, True)]),
        ("G12.1\nG1 X40. F100\nC5.\n/M1\nG13.1\nG0 X60.\nM30\n", [(1, 5, True)]),
        # Behind a reference return it stands between two tools, and the G13.1 behind it at the head of the next one.
        ("G12.1\nG1 X40. F100\nC5.\nX60.\nG30 U0 W0\nM1\nG40\nG13.1\nT0202\nM30\n", [(1, 5, False)]),
        ("G12.1\nG1 X40. F100\nC5.\nG0 X60.\nM1\nT0202\nG13.1\nM30\n", [(1, 4, False)]),
        ("G12.1\nG1 X40. F100\nC5.\nX60.\nM1\nT0202\nM30\n", [(1, 6, False)]),
        # A program that begins with a switch begins another program: nothing of the one before reaches into it.
        ("G12.1\nG1 X40. F100\nC5.\nO2 G12.1\nG1 X40.\nG13.1\nM30\n", [(1, 4, False), (4, 6, True)]),
        ("G12.1\nG1 X40. F100\nC5.\nO2 G13.1\nM30\n", [(1, 4, False)]),
        # A G0 before any cut was meant to stand in the section.
        ("G12.1\nG0 X1.\nM30\n", [(1, 3, False)]),
        ("G12.1\nG0 X80.\nC5.\nT0202\nM30\n", [(1, 4, False)]),
        ("G12.1\nG0 X80.\nG28 U0\nM30\n", [(1, 3, False)]),
        # But not one behind a G12.1 that was meant to be the G13.1.
        ("G12.1\nG1 X40. F100\nC5.\nG12.1\nG0 X80.\nM30\n", [(1, 5, False)]),
        # The G13.1 of another tool does not belong to it.
        ("G12.1\nG1 X40. F100\nC5.\nT0202\nG13.1\nM30\n", [(1, 4, False)]),
    ],
)
def test_sections_end_where_they_were_meant_to(program: str, expected: list[tuple[int, int, bool]]) -> None:
    assert sections(program) == expected


CHOSEN_BACK = "O1\nT0101\nG98 G0 X60. C0 Z5.\n{}\n{}\nG1 X20. F200\n{}10.\nX60.\n{}{}\nG0 Z100.\nM30\n"


@pytest.mark.nightly
@looped(
    ("machine", "on", "axis", "off", "back"),
    [
        ("haas-lathe", "G112", "Y", "G113", "G18"),
        ("citizen", "G12.1 D0 E=C", "Y", "G13.1", "G18"),
        ("hurco", "G101", "Y", "G109", "G18"),
        ("mazak-integrex", "G12.1", "C", "G13.1", "G18"),
        ("siemens-transmit", "TRANSMIT", "Y", "TRAFOOF", "G18"),
        ("okuma-osp", "G137 C0", "Y", "G136", "G18"),
        ("turning-center", "G12.1", "C", "G13.1", "G17"),
    ],
    one_in=4,
)
@looped("retract", ["", "Z5. F500\n", "G0 X70. {}0\n"])
def test_a_plane_chosen_back_ends_a_section_that_nobody_has_left(
    machine: str, on: str, axis: str, off: str, back: str, retract: str
) -> None:
    """The code that ends the mode is missing before it, and it stays: else the lathe stays in the plane of the mode."""
    retract = retract.format(axis)
    if "G0" in retract and "G0" not in machine_of(machine).polar.allowed_codes:
        return
    plane = {"haas-lathe": "G17", "turning-center": "G18"}.get(machine, "")
    program = CHOSEN_BACK.format(on, plane, axis, retract, back)
    findings = [one for one in report_of(program, machine, "1:radius=4").findings if one.severity == "error"]
    (left,) = [one for one in findings if one.rule == "polar-never-left"]
    assert left.message.endswith(f"{off} is missing before line {9 + bool(retract)}, {back}")
    assert left.fix is not None
    assert [(edit.line, edit.text) for edit in left.fix.edits] == [(8 + bool(retract), f"\n{off}")]
    assert "plane-selected-in-polar" not in {one.rule for one in findings}


def test_a_plane_between_two_cuts_is_a_fault_of_its_own() -> None:
    report = report_of(CHOSEN_BACK.format("G112", "G17", "Y", "", "G18\nG1 Y5.\nG113"), "haas-lathe", "1:radius=4")
    assert (9, "plane-selected-in-polar") in said(report)
    assert "polar-never-left" not in {rule for _, rule in said(report)}


def test_the_rows_of_a_section_are_those_from_its_entry_to_its_exit() -> None:
    trace = trace_of(HEAD + "G12.1\nG1 X40. F100\nG13.1\nG0 X60.\nG112\nG1 X40.\nG113\nM30\n")
    assert trace.mode.section.tolist() == [-1] * 4 + [0, 0, -1, -1, 1, 1, -1, -1]
    assert trace.mode.in_polar.tolist() == [False] * 5 + [True, False, False, False, True, False, False]
    assert trace.mode.anywhere_in_section(trace.blocks.codes("G112")).tolist() == [False] * 8 + [
        True,
        True,
        False,
        False,
    ]
    assert trace.mode.first_in_section(trace.mode.section >= 0).tolist() == trace.mode.enters.tolist()


def test_a_section_left_open_by_m99_is_for_the_caller_to_leave() -> None:
    trace = trace_of("O1\nG12.1\nG1 X40. F100\nC5.\nM99\n")
    assert trace.mode.sections.left.tolist() == [True]
    assert trace.mode.sections.returned.tolist() == [True]
    assert not trace.mode.leaves.any(), "no row of it holds the G13.1"
    ended = trace_of("O1\nG12.1\nG1 X40. F100\nC5.\nM30\n")
    assert ended.mode.sections.returned.tolist() == [False]


def marks(generator: np.random.Generator, count: int) -> Marks:
    """Any rows at all, as no program has them; but that a program begins with its O number."""

    def some(share: float) -> Mask:
        return generator.random(count) < share

    on, off, cuts = some(0.2), some(0.15), some(0.4)
    starts = some(0.05)
    return Marks(
        on=on & ~off,
        off=off,
        starts=starts,
        outside=some(0.05),
        planes=some(0.05),
        tool_ends=some(0.05),
        tools_in_mode=np.zeros(count, bool),
        stops=some(0.05),
        rapid=some(0.2),
        cuts=cuts,
        moves=cuts | some(0.2),
        returns=some(0.03),
        broken_off=np.append(starts[1:], True) & some(0.5),
        rapid_stands=bool(generator.random() < 0.5),
    )


@looped("seed", range(50))
def test_whatever_the_rows_sections_are_in_order_and_apart(seed: int) -> None:
    generator = np.random.default_rng(seed)
    given = marks(generator, int(generator.integers(1, 60)))
    found = find_sections(given)
    lengths = [len(column) for column in msgspec.structs.astuple(found)[:4]]
    assert lengths == [len(found)] * 4
    assert sorted([*found.enter, *found.again]) == np.flatnonzero(given.on).tolist(), "each G12.1 begins or repeats"
    assert (found.leave > found.enter).all()
    assert (found.leave[:-1] <= found.enter[1:]).all()
    inside = section_column(found, len(given.on)) >= 0
    begins = np.isin(np.arange(len(given.on)), found.enter)
    assert not (inside & given.off).any()
    assert not (inside & given.starts & ~begins).any(), "a section ends where its program does"
    # What polar-entered-twice compares: in the mode and not its beginning, switched on.
    assert np.flatnonzero(inside & ~begins & given.on).tolist() == found.again.tolist()
    by_off = found.left & ~found.returned
    assert given.off[found.leave[by_off]].all()


@looped(("enter", "leave", "count"), [([], [], 3), ([0], [2], 3), ([1, 4], [4, 9], 9), ([0, 3, 5], [2, 4, 6], 8)])
def test_section_column_by_a_plain_loop(enter: list[int], leave: list[int], count: int) -> None:
    flags, rows = np.ones(len(enter), bool), np.array([], np.int64)
    found = Sections(np.array(enter, np.int64), np.array(leave, np.int64), flags, flags, rows)
    expected = [-1] * count
    for number, (first, end) in enumerate(zip(enter, leave, strict=True)):
        for row in range(first, end):
            expected[row] = number
    assert section_column(found, count).tolist() == expected
