from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.workpiece import Workpiece


@rule(
    ERROR,
    "{way} takes the cutter, R {cutter}, in rapid traverse into {bar_there} down to Z{depth}; {way_down}",
    values={"radius": "workpiece.radius", "z": "path.z", "stock": "bar_in_the_way"},
    worse=("-z",),
    gouges=True,
    where="workpiece.is_mill",
    once="tool call",
    follows={
        "motion": ("rapid-in-polar", "rapid-along-contour"),
        "tool call": ("approach-inside-stock",),
    },
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
