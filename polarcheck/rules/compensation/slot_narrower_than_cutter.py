from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.slots import Slots
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "{room} for a cutter of {diameter:length}: it goes {depth:length} deep into {opposite}; "
    "take {smaller}, or write the walls farther apart",
    values=("diameter", "depth", "width", "plane_x", "plane_c", "other_line"),
    worse=("depth", "-width"),
    gouges=True,
    once="slot",
    follows={"loop": ("overcut",)},
    is_symptom=True,
)
def slot_narrower_than_cutter(slots: Slots) -> Hits:
    """
    Two walls nearer to each other than the diameter of the cutter.

    A slot, or the room between an island and the wall round it, is programmed wall by wall, each with its own start-up
    and offset cancel. Where the walls lie closer together than the cutter is wide, it cuts into one while it mills the
    other. The control cannot see this: it compares a block with the next one only. Take a smaller cutter, or see
    whether a wall is on the wrong side, as by a wrong sign. Loops of one section at the same Z are compared;
    roughing passes inside each other and flats that go on beyond a corner cut into nothing that is kept. Within one
    loop such a cut is an overcut.

    Source: FANUC B-63664EN, p. 184 (a groove below twice R); B-63944EN-1, p. 216 (what interference check cannot find).

    Bad, tool 1:radius=5:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 X70. C0 F300
        G41 X50. C3.
        X-50.             (expect: slot-narrower-than-cutter)
        G40 X-70. C0.
        G41 X-50. C-3.
        X50.
        G40 X70. C0.
        G13.1

    Good, tool 1:radius=2.5:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 X70. C0 F300
        G41 X50. C3.
        X-50.
        G40 X-70. C0.
        G41 X-50. C-3.
        X50.
        G40 X70. C0.
        G13.1
    """
    return Hits(slots.depth > 0, worst=slots.depth)


def details(hit: Hit, slots: Slots) -> Details:
    into, place = slots.cuts.deepest(hit.row)
    width, across = slots.width(hit.row), float(slots.diameter[hit.row])
    line, other_line = hit.line(hit.row), hit.line(into)
    is_closed = width >= across
    between = hit.quantity(width).beside(hit.quantity(across), "length")
    return {
        "diameter": across,
        "depth": slots.depth[hit.row],
        "width": None if is_closed else width,
        "plane_x": place.real,
        "plane_c": place.imag,
        "other_line": other_line,
        "room": f"line {other_line} leaves no room to go round the corner of line {line}"
        if is_closed
        else f"lines {line} and {other_line} leave {between}",
        "opposite": f"the contour of line {other_line} at {hit.point(place)}",
        "smaller": "a smaller cutter" if is_closed else f"a cutter of {between} at most",
    }


def needs(compensation: CutterCompensation, slots: Slots) -> Needs:
    return slots.compared, {"radius": compensation.radius}
