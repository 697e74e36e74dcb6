from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import MOVES, Motion
from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.uncompensated_cuts import UncompensatedCuts
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{bare}{from_point} {goes} {part}; {way_round}",
    values=("depth", "plane_x", "plane_c", "z", "other_line"),
    worse=("depth",),
    gouges=True,
    once="loop",
    follows={
        "motion": ("rapid-in-polar",),
        "X before": ("rapid-through-part",),
        "tool call": ("rapid-plunge-into-stock",),
    },
    is_symptom=True,
    doubts=(("speed", "block"), ("rapid", "block")),
)
def uncompensated_cut_into_part(uncompensated_cuts: UncompensatedCuts) -> Hits:
    """
    Move without compensation through the finished part.

    A contour is milled with G41 or G42, and a move with G40 in the same section leads through what it leaves, or nearer
    to it than R: on the way to the next contour, back to the start, or out after G13.1. It counts at the Z of the
    contour and deeper; above that it is a slot or a facing pass. In rapid traverse it is an error. At feed it is a
    warning, since a slot may be milled without compensation on purpose: mill it in a section of its own, or allow it. A
    line to and fro behind a move of Z down is such a slot.

    Source: builder's guide to G12.1 (approach and retract outside the part); FANUC B-63664EN, p. 170 (what the path
    of the tool center is without compensation).

    Bad, tool 1:radius=5:

        T0101
        G98 G0 X80. Z2. C0
        G12.1
        G1 X80. C5. F500
        Z-3.
        G42 X40. C0. F200
        X20. C17.32
        X-20.
        X-40. C0.
        X-20. C-17.32
        X20.
        X40. C0.
        G40 X80. C5.
        X-80.             (expect: uncompensated-cut-into-part)
        G13.1

    Bad, tool 1:radius=5:

        T0101
        G98 G0 X80. Z2. C0
        G12.1
        G1 X80. C5. F500
        Z-3.
        G42 X40. C0. F200
        X20. C17.32
        X-20.
        X-40. C0.
        X-20. C-17.32
        X20.
        X40. C0.
        G40 X80. C5.
        G13.1
        G0 X0.            (expect: uncompensated-cut-into-part)

    Good, tool 1:radius=5:

        T0101
        G98 G0 X80. Z2. C0
        G12.1
        G1 X80. C5. F500
        Z-3.
        G42 X40. C0. F200
        X20. C17.32
        X-20.
        X-40. C0.
        X-20. C-17.32
        X20.
        X40. C0.
        G40 X80. C5.
        Z2. F1000
        X-80.
        Z-3. F300
        X-20. F100
        X-80.
        Z2. F1000
        G13.1
    """
    cuts = uncompensated_cuts.depth > 0
    return graded(error=uncompensated_cuts.is_rapid, warning=cuts, worst=uncompensated_cuts.graveness)


def details(hit: Hit, uncompensated_cuts: UncompensatedCuts) -> Details:
    trace, row = hit.trace, hit.row
    into, place = uncompensated_cuts.cuts.deepest(row)
    depth, z = uncompensated_cuts.depth[row], trace.path.z[row]
    goes = f"goes {hit.length(depth)} deep into"
    if depth >= hit.radius:
        goes = "leads through" if trace.path.travels[row] or not trace.mode.in_polar[row] else "goes down into"
    return {
        "depth": depth,
        "plane_x": place.real,
        "plane_c": place.imag,
        "z": z,
        "other_line": hit.line(into),
        "bare": f"{trace.machine.codes(MOVES[int(trace.axes.motion[row])])[0]} without compensation",
        "from_point": _from_point(hit),
        "goes": goes,
        "part": f"the part that the contour of line {hit.line(into)} leaves, at {hit.point(place)} Z{hit.number(z)}",
        "way_round": _way_round(hit),
    }


def _from_point(hit: Hit) -> str:
    """` from X32. C0 of line 7`, where a move begins whose start is not that of a cut in the mode."""
    from polarcheck.columns.filling import last_row

    blocks, path, mode, row = hit.trace.blocks, hit.trace.path, hit.trace.mode, hit.row
    at = int(last_row(blocks.has("X", "U"), blocks.starts)[row - 1]) if row else -1
    if at < 0 or mode.in_polar[at] or not mode.in_polar[row] or not path.travels[row]:
        return ""
    return f" from {hit.point(complex(path.start[row]))} (line {hit.line(at)})"


def _way_round(hit: Hit) -> str:
    """What to write where a move without compensation leads through the part."""
    from polarcheck.rules.wording.ramps import increments_in_force

    blocks, machine, row = hit.trace.blocks, hit.trace.machine, hit.row
    if hit.trace.axes.motion[row] == Motion.RAPID and not blocks.listed("rapid")[row] and blocks.has("F")[row]:
        rapid, line = machine.codes("rapid")[0], machine.codes("line")[0]
        return f"{rapid} is still in force: write {line} here, or retract Z first"
    return f"retract Z above the part first, or go round it{increments_in_force(hit)}"
