from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.slots import Slots
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "{room} for a cutter of {slots.diameter:length}: it goes {slots.depth:length} deep into {opposite}; "
    "take {smaller}, or write the walls farther apart",
    values={
        "diameter": "slots.diameter",
        "depth": "slots.depth",
        "width": "width_of_slot",
        "plane_x": "place_of_slot.real",
        "plane_c": "place_of_slot.imag",
        "other_line": "line_of_slot",
    },
    worse=("depth", "-width"),
    gouges=True,
    needs=("compensation.radius",),
    where="slots.compared",
    worst="slots.depth",
    once="slot",
    follows={"loop": ("overcut",)},
)
def slot_narrower_than_cutter(slots: Slots) -> Mask:
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
    return slots.depth > 0
