"""
Slips that a setter makes in a sound program, one at a time, and whether each does something to the metal or the lathe.

A slip is counted where the part comes out otherwise, or the control stops, or metal is met by rapid, and where a check
without a drawing could know it. What it could know it by, is its witness.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import NamedTuple

from metal_simulation import RAPID, cuts_the_part, differs, simulate
from setter_programs import BOSSES, Program, drawn
from slip_blocks import (
    bar_comment,
    cancelled_at_once,
    contour_at_two_depths,
    deeper,
    degrees,
    depth_word,
    ends_inside,
    entered_again,
    index_word,
    mode_missing,
    other_offset,
    per_minute_missing,
    per_revolution,
    position_angle_missing,
    retract_missing,
    side_late,
    side_swapped,
    size_comment,
    tool_comment,
    units_missing,
    unknown_offset,
    x_too_small,
    z_at_depth_before,
)
from slip_words import (
    Draw,
    Plant,
    all_arcs,
    all_words,
    arc_code,
    arc_word,
    axes_swapped,
    block_changed,
    block_doubled,
    block_missing,
    block_missing_in_contour,
    blocks_swapped,
    digit_lost,
    digit_wrong,
    factor_of,
    letter_for_other,
    neighbour,
    other_arc,
    point_moved,
    sign_changed,
    swapped,
    word_changed,
    word_missing,
)

SHAPE = frozenset({"regular", "tangent", "repeated"})
ALWAYS = frozenset({"always"})
EVENT = frozenset[str]()


class Slip(NamedTuple):
    """
    A kind of slip.

    plant: makes it in a program, or gives None where it cannot be made. needs: the evidence of a program of which one
    must be there for a check to know, or "always"; what the simulation finds wrong without a drawing counts anyway.
    witness: what a check knows it by. is_real: it matters though the metal is the same, as a wrong comment does.
    """

    name: str
    plant: Plant
    needs: frozenset[str]
    witness: str
    is_real: bool = False


def _words(change: Callable[[str, Draw], str | None]) -> Plant:
    return word_changed("XC", change, "contour")


SLIPS = (
    Slip("digits swapped", _words(swapped), SHAPE, "shape"),
    Slip("digit lost", _words(digit_lost), SHAPE, "shape"),
    Slip("digit wrong", _words(digit_wrong), SHAPE, "shape"),
    Slip("point moved", _words(point_moved), SHAPE, "shape"),
    Slip("sign lost", _words(sign_changed), SHAPE, "shape"),
    Slip("value doubled", _words(factor_of(2)), SHAPE, "shape"),
    Slip("value halved", _words(factor_of(0.5)), SHAPE, "shape"),
    Slip("one X as the other of diameter and radius", word_changed("X", factor_of(0.5), "contour"), SHAPE, "shape"),
    Slip("all X as the other of diameter and radius", all_words("X"), SHAPE - {"repeated"}, "shape"),
    Slip("all C doubled", all_words("C"), SHAPE - {"repeated"}, "shape"),
    Slip("neighbour's value", neighbour, SHAPE, "shape"),
    Slip("block missing", block_missing_in_contour, SHAPE, "shape"),
    Slip("block doubled", block_doubled, SHAPE, "shape"),
    Slip("blocks swapped", blocks_swapped, SHAPE, "the contour crosses itself"),
    Slip("word missing", word_missing, SHAPE, "shape"),
    Slip("X and C swapped", axes_swapped, SHAPE, "shape"),
    Slip("X for C", letter_for_other, SHAPE, "shape"),
    Slip("R wrong", arc_word("R", digit_wrong), SHAPE, "no tangent at its ends"),
    Slip("R with point moved", arc_word("R", point_moved), SHAPE, "no tangent at its ends"),
    Slip("sign of R", arc_word("R", sign_changed), SHAPE | {"concentric"}, "tangent with the other sign"),
    Slip("all R doubled", all_arcs, SHAPE - {"repeated"}, "each would be tangent"),
    Slip("sign of I or J", arc_word("I", sign_changed), ALWAYS, "end off the circle, or no tangent"),
    Slip("I or J wrong", arc_word("I", digit_wrong), ALWAYS, "end off the circle"),
    Slip("G2 and G3 swapped", arc_code(other_arc), SHAPE | {"concentric"}, "no tangent at its ends"),
    Slip("G2 forgotten", arc_code(lambda code, program: ""), ALWAYS, "R or I beside a line"),
    Slip("G1 for G2", arc_code(lambda code, program: program.dialect.line), ALWAYS, "R or I beside a line"),
    Slip("G41 for G42", side_swapped, ALWAYS, "cuts into the part"),
    Slip("G41 forgotten", block_changed("G4[12] ?", "", "ramp"), ALWAYS, "G40 that cancels nothing"),
    Slip("G41 late", side_late, ALWAYS, "cuts before it"),
    Slip("G40 at once", cancelled_at_once, ALWAYS, "nothing lies between"),
    Slip("ramp block missing", block_missing("ramp"), ALWAYS, "G40 that cancels nothing"),
    Slip("X halved in the ramp", word_changed("X", factor_of(0.5), "ramp"), ALWAYS, "ramp through the part"),
    Slip("X wrong in the ramp", word_changed("X", digit_wrong, "ramp"), EVENT, "ramp through the part"),
    Slip("G40 forgotten", block_changed("G40 ?", "", "cancel"), ALWAYS, "G13.1 in offset mode"),
    Slip("cancel block missing", block_missing("cancel"), ALWAYS, "G13.1 in offset mode"),
    Slip("approach block missing", block_missing("approach"), EVENT, "ramp or plunge through the part"),
    Slip("depth missing", block_missing("plunge", "plunge outside"), ALWAYS, "cuts only air, or twice the same"),
    Slip("sign of the depth", depth_word(sign_changed), ALWAYS, "cuts only air"),
    Slip("depth ten times", depth_word(deeper), frozenset({"steps"}), "far deeper than the other passes"),
    Slip("retract missing", retract_missing, EVENT, "C or X moved in the part"),
    Slip("sign of the retract", word_changed("Z", sign_changed, "retract", "lift"), EVENT, "rapid in the part"),
    Slip("index missing", index_word("missing"), ALWAYS, "cuts only air"),
    Slip("index twice", index_word("twice"), ALWAYS, "cuts only air"),
    Slip("G0 for G1 in the plunge", block_changed("G1(?!0|1)", "G0", "plunge"), EVENT, "rapid into the bar"),
    Slip("G0 for G1 in the ramp", block_changed("G1(?!0|1)", "G0", "ramp", "approach"), EVENT, "G0 in the mode"),
    Slip("approach inside the bar", x_too_small(0.6), EVENT, "plunge into the part"),
    Slip("approach near the center", x_too_small(0.25), EVENT, "plunge into the part"),
    Slip("down by rapid at the approach", z_at_depth_before, EVENT, "rapid into the bar"),
    Slip("G12.1 missing", mode_missing("on"), ALWAYS, "G13.1 without it"),
    Slip("G13.1 missing", mode_missing("off"), ALWAYS, "the mode is left open"),
    Slip("degrees", degrees, ALWAYS, "rise to 360"),
    Slip("C elsewhere at the second section", position_angle_missing, ALWAYS, "nobody positioned it"),
    Slip("contour at two depths", contour_at_two_depths, ALWAYS, "Z in the middle of a contour"),
    Slip("pass ends inside the bar", ends_inside, frozenset({"bar"}), "material left"),
    Slip("wrong cutter in the comment", tool_comment, ALWAYS, "the comment", is_real=True),
    Slip("wrong size in the comment", size_comment, ALWAYS, "the comment", is_real=True),
    Slip("wrong bar in the comment", bar_comment, ALWAYS, "the part is larger", is_real=True),
    Slip("unit missing", units_missing, ALWAYS, "never reaches its bar, or is all in it", is_real=True),
    Slip("G99 for G98", per_revolution, ALWAYS, "F of a feed per minute"),
    Slip("G98 missing", per_minute_missing, ALWAYS, "F of a feed per minute"),
    Slip("F of a feed per revolution", block_changed(r"F[\d.]+", "F0.1", "ramp", "plunge"), ALWAYS, "takes hours"),
    Slip("left and entered again", entered_again, ALWAYS, "C stands elsewhere"),
    Slip("offset without R", unknown_offset, ALWAYS, "no radius is known"),
    Slip("offset of the other cutter", other_offset, ALWAYS, "the comment, or T with another number"),
)


class Planted(NamedTuple):
    """A program with a slip; line: of the first block that differs, from 1."""

    slip: str
    program: Program
    line: int


def planted(slip: Slip, program: Program, draw: Draw) -> Planted | None:
    """The program with the slip, where it can be made, does something, and a check could know it."""
    changed = slip.plant(program, draw)
    if changed is None or changed.text() == program.text():
        return None
    try:
        if not is_real(slip, program, changed):
            return None
    except (ValueError, SyntaxError, ZeroDivisionError, OverflowError):
        return None
    return Planted(slip.name, changed, _first_change(program, changed) + 1)


def is_real(slip: Slip, program: Program, changed: Program) -> bool:
    """Whether metal or lathe are affected, and a check could know."""
    if slip.is_real:
        return True
    sound, other = simulate(program), simulate(changed)
    events = other.events - sound.events
    if RAPID in events and "bar" not in program.evidence:
        events -= set() if cuts_the_part(program, sound, changed, other, rapids=True) else {RAPID}
    if events:
        return True
    if not differs(sound, other):
        return False
    if "always" in slip.needs or slip.needs & program.evidence:
        return True
    is_drilled = program.family.endswith("center path") and not program.family.startswith(BOSSES)
    return _is_beside(program, changed) and not is_drilled and cuts_the_part(program, sound, changed, other)


def _is_beside(program: Program, changed: Program) -> bool:
    """Whether only ways to and from the contour are changed in the plane."""
    ways = ("ramp", "approach", "position", "position angle", "cancel", "lead")
    if len(program.lines) == len(changed.lines):
        pairs = zip(program.lines, changed.lines, strict=True)
        return all(one.role in ways for one, two in pairs if one.text != two.text)
    index = _first_change(program, changed)
    return index < len(program.lines) and program.lines[index].role in ways


def _first_change(program: Program, changed: Program) -> int:
    pairs = zip(program.lines, changed.lines, strict=False)
    return next((index for index, (one, two) in enumerate(pairs) if one.text != two.text), len(changed.lines))


def drawn_slip(
    seed: int,
    kinds: tuple[Slip, ...] = SLIPS,
    machine: str = "",
    is_sound: Callable[[Program], bool] = lambda one: True,
) -> Planted | None:
    """A slip of the kind that is in turn, in a program of which nothing is said without it."""
    draw = random.Random(f"slip {seed}")  # noqa: S311 - programs that can be written again
    slip = kinds[seed % len(kinds)]
    for _ in range(60):
        program = drawn(draw.randrange(10**6), machine)
        with_slip = planted(slip, program, draw)
        if with_slip is not None and is_sound(program):
            return with_slip
    return None
