from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "X stands at {x:diameter/x_needed} at {switch}{since_x}; {to_clear} {x_needed:diameter/x} or more",
    values=("x", "x_needed", "stock", "diameter", "clearance"),
    worse=("x:x_needed",),
    at=("on",),
    subject="size",
    doubts=(("compensation", "first start-up"), ("move", "X before")),
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
    is_symptom=True,
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
    return graded(error=inside, warning=near, values={"stock": entry.stock_diameter, "x_needed": entry.x_needed})


def details(hit: Hit, path: ProgrammedPath, offsets: ToolOffsets, entry: Entry) -> Details:
    from polarcheck.columns.filling import last_row

    x, since = path.x[hit.row], int(last_row(hit.trace.blocks.has("X", "U"), hit.trace.blocks.starts)[hit.row])
    diameter, clearance = offsets.cutter_diameter[hit.row], entry.clearance[hit.row]
    stock, cutter = hit.length(entry.stock_diameter[hit.row]), hit.length(diameter)
    to_clear = f"stock {stock} and cutter {cutter} need"
    if clearance > 0:
        to_clear = f"stock {stock}, cutter {cutter} and clearance {hit.length(clearance)} need"
    return {
        "x": x,
        "diameter": diameter,
        "clearance": clearance,
        "since_x": f", since line {hit.line(since)}" if since >= 0 else "",
        "to_clear": to_clear,
    }


def needs(offsets: ToolOffsets, entry: Entry) -> Needs:
    return entry.approaches_stock, {"diameter": offsets.cutter_diameter}
