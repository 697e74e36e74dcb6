from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import OUT_OF_PLACE
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.strokes import Strokes
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{block} moves to the next cut at Z{depth}; before the similar cut of line {other_line} the tool is lifted: a Z "
    "above the part is missing before this block",
    values=("z", "other_line"),
    gouges=True,
    follows={"section": OUT_OF_PLACE},
    doubts=(("speed", "block"), ("metal", "block")),
)
def lift_missing_between_cuts(strokes: Strokes) -> Mask:
    """
    Move to the next cut at depth, where others are above the part.

    A tool cuts at several places: it is positioned, goes down by a Z word, cuts, and is lifted. In one place the lift
    is missing. The tool goes to the next place through the part, and the Z word there moves nothing. At least two other
    places with the same Z show what was meant.

    Source: builder's guide to G12.1, order of a section.

    Bad, tool 1:radius=1.5:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X30. C-12. F1500
        Z-3. F100
        X-30. F200
        Z2. F1500
        X30. C-8.
        Z-3. F100
        X-30. F200
        X30. C-4. F1500    (expect: lift-missing-between-cuts)
        Z-3. F100
        X-30. F200
        Z2. F1500
        G13.1

    Good, tool 1:radius=1.5:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X30. C-12. F1500
        Z-3. F100
        X-30. F200
        Z2. F1500
        X30. C-8.
        Z-3. F100
        X-30. F200
        Z2. F1500
        X30. C-4.
        Z-3. F100
        X-30. F200
        Z2. F1500
        G13.1
    """
    # Compares nothing: the strokes of a tool have to be read together.
    return strokes.lacks_lift


def details(hit: Hit, strokes: Strokes) -> Details:
    _, lifted = strokes.unlifted[hit.row]
    z = hit.trace.path.z[hit.row]
    return {"z": z, "depth": hit.number(z), "other_line": hit.line(int(lifted[-1]))}
