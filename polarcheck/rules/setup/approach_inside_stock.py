from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.approaches import Approaches
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "{stands_at} {x:diameter/x_needed}{since_x}; {to_clear} {x_needed:diameter/x} or more",
    values=("x", "x_needed", "stock", "diameter", "clearance"),
    worse=("x:x_needed",),
    at=("on",),
    subject="reach",
    doubts=(("compensation", "start-up ahead"), ("move", "X before"), ("metal", "block"), ("rapid", "tool call")),
    is_symptom=True,
)
def approach_inside_stock(approaches: Approaches) -> Hits:
    """
    Approach point inside the stock.

    X is the place of the cutter center, not of its edge. To clear the bar the approach needs X = diameter of the stock
    + diameter of the cutter + clearance; nearer, the cutter goes down into the bar beside the shape. It is a warning
    where only the clearance is missing. What counts is where Z goes below the face, and the diameter that the program
    has left down to that depth: that of `[stock]`, or what was turned since. The face is that of `[stock]` or the one
    that the program turns, else Z0. Cuts that stay inside the bar, as pockets do, are not meant, nor is metal that
    mills have taken off before.

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
    inside = approaches.is_near & (approaches.distance < approaches.x_needed - approaches.clearance / 2 - ROUNDING)
    values = {"stock": 2 * approaches.stock_radius, "x_needed": approaches.x_needed}
    return graded(error=inside, warning=approaches.is_near, values=values)


def details(hit: Hit, offsets: ToolOffsets, approaches: Approaches) -> Details:
    diameter, clearance = offsets.cutter_diameter[hit.row], approaches.clearance[hit.row]
    stock, cutter = 2 * approaches.stock_radius[hit.row], hit.length(diameter)
    standing = [step for step in approaches.bar.standing(hit.row, approaches.depth[hit.row]) if step.lines[0]]
    turned = f" turned in line {standing[-1].lines[1]}" if standing else ""
    to_clear = f"stock {hit.length(stock)}{turned} and cutter {cutter} need"
    if clearance > 0:
        to_clear = f"stock {hit.length(stock)}{turned}, cutter {cutter} and clearance {hit.length(clearance)} need"
    stands_at, since_x = _where(hit)
    return {
        "x": approaches.distance[hit.row],
        "diameter": diameter,
        "clearance": clearance,
        "stands_at": stands_at,
        "since_x": since_x,
        "to_clear": to_clear,
    }


def _where(hit: Hit) -> tuple[str, str]:
    """What stands at the diameter, and since when."""
    from polarcheck.columns.filling import last_row
    from polarcheck.rules.wording.ramps import line_before

    trace, row = hit.trace, hit.row
    if not trace.mode.enters[row]:
        return f"the cutter goes down to Z{hit.number(trace.path.z[row])} on a diameter of", line_before(hit, ", since")
    since = int(last_row(trace.blocks.has("X", "U"), trace.blocks.starts)[row])
    at = f" at {hit.switch}"
    return "X stands at", f"{at}, since line {hit.line(since)}" if since >= 0 else at


def needs(offsets: ToolOffsets, approaches: Approaches) -> Needs:
    return approaches.approaches, {"diameter": offsets.cutter_diameter}
