from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.bar import Bar
    from polarcheck.columns.metal.workpiece import Workpiece
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{block} takes the cutter, R {cutter}, in rapid traverse into {bar_there} down to Z{depth}; {way_down}",
    values=("radius", "z", "stock"),
    worse=("-z",),
    gouges=True,
    once="tool call",
    subject="plunge",
    doubts=(("rapid", "tool call"),),
)
def rapid_plunge_into_stock(workpiece: Workpiece) -> Hits:
    """
    Rapid traverse down into the bar.

    The mill goes down in rapid traverse where metal of the bar still stands: G1 is missing, or X or C is that of
    another place. The bar is that of `[stock]`, or what the program itself turns before its first section, or what a
    comment says; then it is a warning.

    Where no bar is known, a pocket shows it: the Z word at feed with which its section begins moves nowhere, since G0
    has gone down before. That is a warning, too.

    Source: builder's guide to G12.1, programming the tool approach point.

    Bad, tool 1:radius=2.5, set job.stock.diameter=40:

        T0101
        G98 G0 X24. Z2. C0
        Z-3.              (expect: rapid-plunge-into-stock)
        G12.1
        G1 X20. F200
        C3.
        X24.
        Z2. F1000
        G13.1

    Bad, tool 1:radius=2.5:

        (BAR DIA 40)
        T0101
        G98 G0 X24. Z2. C0
        Z-3.              (expect: rapid-plunge-into-stock)
        G12.1
        G1 X20. F200
        C3.
        X24.
        Z2. F1000
        G13.1

    Bad, tool 1:radius=2.5:

        T0101
        G98 G0 X24. Z-3. C0    (expect: rapid-plunge-into-stock)
        G12.1
        G1 Z-3. F60
        G41 X34. F200
        G3 I-17.
        G1 G40 X24.
        Z2. F1000
        G13.1

    Good, tool 1:radius=2.5, set job.stock.diameter=40:

        T0101
        G98 G0 X24. Z2. C0
        G1 Z-3. F60
        G12.1
        G1 X20. F200
        C3.
        X24.
        Z2. F1000
        G13.1
    """
    hits = workpiece.hits_bar & workpiece.plunges
    may_miss = workpiece.may_miss_bar
    return graded(
        error=hits & workpiece.bar_is_certain & ~may_miss,
        warning=hits | workpiece.precedes_idle_plunge,
        undecided=may_miss,
    )


def details(hit: Hit, workpiece: Workpiece, bar: Bar) -> Details:
    from polarcheck.rules.wording.metal import bar_diameter, bar_in_words

    z, radius = hit.trace.path.z[hit.row], workpiece.radius[hit.row]
    height = float(bar.trace.path.z[hit.row])
    in_bar = workpiece.hits_bar[hit.row]
    return {
        "radius": radius,
        "z": z,
        "stock": bar_diameter(hit, bar, height) if in_bar else None,
        "cutter": hit.length(radius),
        "bar_there": f"the bar ({bar_in_words(hit, bar, height)})"
        if in_bar
        else "what the pocket still has to take off",
        "depth": hit.number(z),
        "way_down": _way_down(hit, bar, radius, in_bar),
    }


def _way_down(hit: Hit, bar: Bar, radius: float, in_bar: bool) -> str:
    """What to write where rapid traverse leads down into the bar."""
    import numpy as np

    from polarcheck.rules.wording.metal import bar_ends_at, of_line
    from polarcheck.rules.wording.written import code_of

    trace, row = hit.trace, hit.row
    path, line = trace.path, code_of(trace.machine, "line")
    if trace.axes.moves_plane[row] or path.x[row] != path.x_before[row]:
        return f"write a Z above the metal here, and go down to Z{hit.number(path.z[row])} with {line} and a feed"
    if not in_bar or np.isnan(radius):
        return f"write {line} with a feed"
    clear, where = hit.quantity(bar_ends_at(hit, bar) + radius), of_line(trace, trace.blocks.has("X", "U"), row, row)
    return f"write {line} with a feed, or stand outside the bar: {clear:diameter} or more in X{where}"
