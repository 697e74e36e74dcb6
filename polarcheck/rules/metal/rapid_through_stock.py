from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Motion
from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.bar import Bar
    from polarcheck.columns.metal.workpiece import Workpiece
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{block} takes the cutter, R {cutter}, {height} {through} what stands of the bar ({bar}); {at_depth}",
    values=("radius", "z", "stock"),
    worse=("-z",),
    gouges=True,
    once="tool call",
    subject="rapid",
    follows={"block": ("rapid-through-part",)},
)
def rapid_through_stock(workpiece: Workpiece) -> Hits:
    """
    Rapid traverse through the bar.

    The mill moves in rapid traverse below the face, and metal of the bar stands in its way that nothing has taken off
    yet: the retract before an index of C is missing, or X comes too near at depth. The bar is that of `[stock]`, or
    what the program itself turns before its first section, or what a comment says; then it is a warning. What mills
    have taken off up to there is no longer in the way. Tools that are not followed, as drills, are taken to have made
    their holes as large as needed.

    Source: builder's guide to G12.1, programming the tool approach point.

    Bad, tool 1:radius=2.5, set job.stock.diameter=40:

        T0101
        G98 G0 X24. Z2. C0
        G1 Z-3. F60
        G12.1
        G1 X20. F200
        C3.
        X24.
        G13.1
        G0 C90.           (expect: rapid-through-stock)

    Bad, tool 1:radius=2.5:

        (BAR DIA 40)
        T0101
        G98 G0 X24. Z2. C0
        G1 Z-3. F60
        G12.1
        G1 X20. F200
        C3.
        X24.
        G13.1
        G0 C90.           (expect: rapid-through-stock)

    Good, tool 1:radius=2.5, set job.stock.diameter=40:

        T0101
        G98 G0 X24. Z2. C0
        G1 Z-3. F60
        G12.1
        G1 X20. F200
        C3.
        X24.
        G13.1
        G0 Z2.
        C90.
    """
    hits = workpiece.hits_bar & ~workpiece.plunges
    may_miss = workpiece.may_miss_bar
    return graded(error=hits & workpiece.bar_is_certain & ~may_miss, warning=hits, undecided=may_miss)


def details(hit: Hit, workpiece: Workpiece, bar: Bar) -> Details:
    from polarcheck.rules.wording.metal import bar_diameter, bar_in_words, height_in_words, height_of_move, through

    height = height_of_move(bar.trace, hit.row)
    return {
        "radius": workpiece.radius[hit.row],
        "z": height * bar.trace.path.z_sense,
        "stock": bar_diameter(hit, bar, height),
        "cutter": hit.length(workpiece.radius[hit.row]),
        "height": height_in_words(hit, bar.trace),
        "through": through(hit, workpiece),
        "bar": bar_in_words(hit, bar, height),
        "at_depth": _at_depth(hit),
    }


def _at_depth(hit: Hit) -> str:
    """What to write where rapid traverse leads through metal: a feed where G0 is still in force, or a retract."""
    from polarcheck.rules.wording.metal import of_line
    from polarcheck.rules.wording.written import code_of

    trace, row = hit.trace, hit.row
    rapid = trace.blocks.listed("rapid")
    if not trace.mode.in_polar[row] or trace.axes.motion[row] != Motion.RAPID or rapid[row]:
        return "retract Z first"
    where, line = of_line(trace, rapid, row, row), code_of(trace.machine, "line")
    return f"{code_of(trace.machine, 'rapid')}{where} is still in force: write {line} here, or retract Z first"
