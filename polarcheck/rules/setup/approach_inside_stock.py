from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.path.path import ProgrammedPath


@rule(
    ERROR,
    "X stands at {path.x:diameter/needed} at {switch}{since_x}; {to_clear} {needed:diameter/path.x} or more",
    values={
        "x": "path.x",
        "x_needed": "needed",
        "stock": "entry.stock_diameter",
        "diameter": "offsets.cutter_diameter",
        "clearance": "entry.clearance",
    },
    worse=("x:x_needed",),
    at=("on",),
    needs=("offsets.cutter_diameter",),
    where="entry.approaches_stock",
    doubts=(("compensation", "first start-up"),),
    follows={
        "section": (
            "degrees-in-polar",
            "number-without-point",
            "arc-radius-too-small",
            "arc-end-off-circle",
            "contour-crosses-itself",
            "nearly-regular-contour",
            "side-of-compensation-mirrored",
        ),
    },
)
def approach_inside_stock(path: ProgrammedPath, entry: Entry) -> Hits:
    """
    Approach point inside the stock.

    X is the place of the cutter center, not of its edge. To clear the bar the approach needs X = diameter of the stock
    + diameter of the cutter + clearance; nearer, the cutter goes down into the bar beside the shape. It is a warning
    where only the clearance is missing. Sections that stay inside the bar, as pockets do, are not meant.

    Source: builder's guide to G12.1, programming the tool approach point.

    Bad, tool 8:diameter=16, set job.stock.diameter=60:

        T0808
        G98 G0 X70. C0
        G12.1             (expect: approach-inside-stock)
        G1 X40. F200
        C10.
        X70.
        G13.1

    Bad, tool 8:diameter=16, set job.stock.diameter=60, set job.stock.clearance=2:

        T0808
        G98 G0 X77. C0
        G12.1             (expect: approach-inside-stock)
        G1 X40. F200
        C10.
        X77.
        G13.1

    Good, tool 8:diameter=16, set job.stock.diameter=60, set job.stock.clearance=2:

        T0808
        G98 G0 X78. C0
        G12.1
        G1 X40. F200
        C10.
        X78.
        G13.1

    Good, tool 8:diameter=16, set job.stock.diameter=60:

        T0808
        G98 G0 X40. C0
        G12.1
        G1 Z-5. F100
        G3 X-40. I-20. J0 F200
        X40. I20. J0
        G1 Z2. F1500
        G13.1
    """
    inside = entry.approaches_stock & (path.x < entry.x_needed - entry.clearance / 2 - ROUNDING)
    near = entry.approaches_stock & (path.x < entry.x_needed - ROUNDING)
    return graded(error=inside, warning=near, values={"stock": entry.stock_diameter, "needed": entry.x_needed})
