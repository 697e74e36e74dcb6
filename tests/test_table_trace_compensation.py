"""Which side is in force in each row, and which moves start up and cancel: against a loop that reads block by block."""

from __future__ import annotations

import itertools

import numpy as np
from cases import looped
from programs import trace_of

from polarcheck.foundation.states import Side

OFF, LEFT, RIGHT = Side.OFF, Side.LEFT, Side.RIGHT
SIDES = {"G40": OFF, "G41": LEFT, "G42": RIGHT}
#: What may stand in a section; moves by an increment, so that none is without length.
BLOCKS = ("G41", "G40", "G42 U1.", "G40 G0 U1.", "G1 U1.", "Z1.")


def sections() -> list[str]:
    """All sections of four of these blocks, one after another; compensation is in force before every other one."""
    found = ["G98 G0 X60. C0"]
    for number, inside in enumerate(itertools.product(BLOCKS, repeat=4)):
        found += ["G42" if number % 2 else "G40", "G12.1", *inside, "G13.1"]
    return found


def read_by_hand(blocks: list[str]) -> dict[str, list[object]]:
    """What each column is, from the words of each block in turn."""
    names = ("side", "side_before", "side_of_move_before", "compensates", "starts_up", "cancels", "offset_mode")
    columns: dict[str, list[object]] = {name: [] for name in names}
    side = moved = OFF
    in_mode = False
    for block in blocks:
        before = side
        side = next((SIDES[word] for word in block.split() if word in SIDES), side)
        if block in ("G12.1", "G13.1"):
            side, in_mode = OFF, False
        moves = in_mode and "U" in block
        row = (side, before, moved, in_mode and side != OFF, moves and side != OFF and moved == OFF)
        for name, value in zip(names, row, strict=False):
            columns[name].append(value)
        columns["cancels"].append(moves and side == OFF and moved != OFF)
        columns["offset_mode"].append(in_mode and moved != OFF)
        if moves:
            moved = side
        if block == "G12.1":
            moved, in_mode = OFF, True
    return columns


def test_all_orders_of_four_blocks() -> None:
    blocks = sections()
    trace = trace_of("\n".join(blocks) + "\n")
    assert len(trace.mode.sections) == len(BLOCKS) ** 4
    expected = read_by_hand(blocks)
    assert any(expected["starts_up"])
    assert any(expected["cancels"])
    for name, column in expected.items():
        assert getattr(trace.compensation, name).tolist() == column, name


def test_rapid_traverse_starts_up_and_cycles_do_not() -> None:
    """G42 takes effect in the block with G0; G90 is a turning cycle in system A."""
    program = "G98 G0 X60. C0 Z2.\nG12.1\nG42 X40.\nG1 C10. F100\nG40 G0 X60.\nG13.1\nG12.1\nG42 G90 X40. Z1.\nG13.1\n"
    trace = trace_of(program)
    assert trace.blocks.line[trace.path.on_plane].tolist() == [3, 4, 5]
    assert trace.blocks.line[trace.compensation.starts_up].tolist() == [3]
    assert trace.blocks.line[trace.compensation.cancels].tolist() == [5]
    assert trace.blocks.line[trace.path.cuts].tolist() == [4]


def test_a_rapid_start_up_compensates_as_one_at_feed() -> None:
    program = "T0101\nG98 G0 X60. C0\nG12.1\n{}G42 X40. F100\nG1 C10.\nX-40.\nG40 {}X-60.\nG13.1\n"
    at_feed, in_rapid = (
        trace_of(program.format(*codes), "fanuc", "1:radius=4") for codes in (("G1 ", ""), ("", "G0 "))
    )
    for name in ("starts_up", "cancels", "offset_mode", "side"):
        assert getattr(at_feed.compensation, name).tolist() == getattr(in_rapid.compensation, name).tolist()


def test_compensation_ends_with_a_forgotten_section() -> None:
    program = "O1\nG98 G0 X60. C0\nG12.1\nG42 G1 X40. F100\nC10.\nG0 Z50.\nM30\n"
    trace = trace_of(program)
    assert trace.compensation.side.tolist() == [*[OFF] * 3, *[RIGHT] * 2, *[OFF] * 2]


# ---- tool offset ----


def test_what_t_calls() -> None:
    trace = trace_of("O1\nG0 X1.\nT0808\nG0 X2.\nT0800\nM30\nO2\nG0 X1.\nM30\n")
    assert trace.tools.tool_called.tolist() == [0, 0, 808, 808, 800, 800, 0, 0, 0]
    assert trace.tools.tool_called_before.tolist() == [0, 0, 0, 808, 808, 800, 0, 0, 0]
    assert trace.tools.has_called_tool.tolist() == [False] * 2 + [True] * 4 + [False] * 3


@looped(
    ("nose", "allowed", "expected"), [("0", [0, 9], True), ("9", [0, 9], True), ("3", [0, 9], False), ("3", [3], True)]
)
def test_noses_that_a_mill_may_have(nose: str, allowed: list[int], expected: bool) -> None:
    changes = {"compensation": {"nose_types": allowed}}
    trace = trace_of("T0101\nT0202\n", "fanuc", f"1:radius=4,nose={nose}", "2:radius=4", changes=changes)
    assert trace.offsets.nose_is_of_mill.tolist() == [expected, False]
    assert np.isnan(trace.offsets.nose[1])
