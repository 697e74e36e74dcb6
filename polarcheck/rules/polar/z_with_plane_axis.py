from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Motion
from polarcheck.rules.rule import ERROR, NOTE, WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit

#: What Z does in one block with axes of the plane, by polar.other_axes.
_OF_Z = {
    "independent": "Z moves on its own there, not on the line in space",
    "together": "compensation may take it for one more corner",
    "forbidden": "this lathe cannot move Z together with the plane",
}


@rule(
    WARNING,
    "{word} in one block in the polar mode: {what_z_does}; write Z in a block of its own",
    values=("word",),
    gouges=True,
    at=("X", "U", "C", "H", "Y", "V", "Z", "W"),
)
def z_with_plane_axis(
    axes: PlaneAxes, mode: PolarMode, path: ProgrammedPath, compensation: CutterCompensation, machine: Machine
) -> Hits:
    """
    Z in one block with X or C.

    Z is not part of the polar plane. FANUC's manual lets such an axis move, but on its own: Z may arrive before X and C
    do, or after them, and the tool does not follow the line in space from start to end. Some lathes cannot move them
    together at all. Where it works as posts write it, compensation may still take the block for one more corner. Move Z
    in a block of its own: in the plane first and then in on approach, out first and then in the plane on retract. A
    block above Z0, from which Z alone goes down, is in the air: how Z runs there does not matter, unless the control
    forbids it. A block that repeats X and C as they are moves Z only, and one that repeats Z as it is moves X and C
    only, unless a document forbids the words themselves (polar.repeated_z). The machine's profile says what Z does
    (polar.other_axes): where that is forbidden this is an error, where Z moves along with the others a note.

    Source: FANUC B-62764EN/01, p. 51, axes that are not in the plane; builder's guide to G12.1, linear interpolation.

    Bad:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. Z-5. F200   (expect: z-with-plane-axis)
        C10.
        X60.
        G13.1

    Bad, machine turning-center:

        G98 G0 X2.4 Z.1 C0
        G12.1
        G1 C.4 Z-.2 F40.    (expect: z-with-plane-axis)
        G1 G41 X.8 F5.
        C-.4
        G40 X2.4
        G13.1

    Bad, machine turning-center:

        G98 G0 X2.4 Z.1 C0
        G12.1
        G1 C.4 F40.
        Z-.2
        G1 G41 X.8 Z-.2 F5. (expect: z-with-plane-axis)
        C-.4
        G40 X2.4
        G13.1

    Bad, set polar.other_axes="together", tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C-20.
        G12.1
        G1 G42 X40. F200
        C10. Z-5.         (expect: z-with-plane-axis)
        C20.
        G40 X60.
        G13.1

    Good, set polar.other_axes="together":

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. C5. Z-5. F200
        C10.
        X60.
        G13.1

    Good:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. C0. Z-5. F200
        G1 X40. C0. Z-5.
        G1 X40. C10. Z-5.
        G1 X60. C10. Z-5.
        G13.1

    Good:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        X40. Z-5.
        C10.
        X60.
        G13.1

    Good:

        G98 G0 X80. Z5. C0
        G12.1
        G1 X50. C10. Z2. F500
        Z-3. F100
        C-10.
        X80.
        G13.1
    """
    moves_both = mode.in_polar & axes.moves_plane & path.judged_z
    if machine.polar.other_axes != "forbidden":
        moves_both &= ~path.ends_above_plunge
    if machine.polar.other_axes == "together":
        # Without compensation no block can be taken for a corner.
        moves_both &= compensation.compensates
    severity = {"forbidden": ERROR, "independent": WARNING, "together": NOTE}[machine.polar.other_axes]
    return Hits(moves_both & (axes.motion == Motion.LINE) & (path.length > 0), severity)


def details(hit: Hit, machine: Machine) -> Details:
    return {"word": hit.word_list, "what_z_does": _OF_Z[machine.polar.other_axes]}
