from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Units
from polarcheck.rules.rule import WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.unpointed import Unpointed
    from polarcheck.rules.hit import Details, Hit

#: F without a point in an inch program [inch/min], parameter 1403#0 MIF = 0; in mm it is whole mm/min.
_FEED_INCREMENT_INCH = 0.01


@rule(
    WARNING,
    "{word} has no decimal point: the control takes it as {taken_as}",
    values=("word", "count"),
    worse=("count",),
    over="words",
    once="program",
    subject="size",
    doubts=(("metal", "loop"), ("position", "loop")),
)
def number_without_point(unpointed: Unpointed) -> Hits:
    """
    Length without a decimal point.

    A number without a point counts least increments: C20 is 0.020 mm, in inch 0.0020 inch. With parameter 3401#0
    DPI = 1 it is 20 mm instead, so that one program cuts two shapes on two lathes. Write the point. A program is
    reported once, at the first such coordinate of a section if there is one.

    A control that reads whole units makes a contour of many meters of numbers that were meant in least increments: this
    is reported once in a program, with the parameter that makes it as small as it was meant.

    What is meant is taken from the program. Most are written with points: there C20 is judged as 20 mm, and only a
    number of 1000 or more as the control takes it, since no lathe moves a meter. A program that writes most of its
    coordinates without a point, throughout or in the mode, and most of those as 1000 or more, is written in least
    increments: all of them are judged so, and a note says it once in the program.

    Source: FANUC B-62754EN/01, decimal point programming; parameters 3401#0 and 1403#0.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20               (expect: number-without-point)
        X-40.
        G13.1

    Bad:

        G98 G0 X60 C0     (expect: number-without-point)
        G12.1
        G1 X40 C10 F200
        X-40
        X60.
        G13.1

    Bad:

        G20 G98 G0 X2.5 C0
        G12.1
        G1 X1.5 F8        (expect: number-without-point)
        C.5
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20.
        Z1000             (expect: number-without-point)
        X-40.
        G13.1

    Bad:

        G98 G0 X60000 C0  (expect: number-without-point)
        G12.1
        G1 X40000 F200
        C20000
        C-500
        X-40000
        G13.1

    Bad:

        G10 P1 R4         (expect: number-without-point)
        T0101
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20.
        G13.1

    Good:

        G10 P1 R4.
        T0101
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20.
        X-40.
        G13.1

    Bad, set control.number_without_point="whole-unit":

        G98 G0 X60. C0
        G12.1
        G1 X40000 F200    (expect: number-without-point)
        C20000
        X-40000
        G13.1

    Good, set control.number_without_point="whole-unit":

        G98 G0 X60 C0
        G12.1
        G1 X40 F200
        C20
        G13.1
    """
    warning, note = unpointed.slips | (unpointed.in_meters > 0), unpointed.in_increments > 0
    return graded(
        warning=warning,
        note=note,
        worst=unpointed.rank if (warning | note).any() else None,
        follows={"program": unpointed.is_feed},
    )


def details(hit: Hit, unpointed: Unpointed) -> Details:
    if meters := int(unpointed.in_meters[hit.index]):
        return {"count": meters, "taken_as": _in_meters(hit, meters)}
    count = int(unpointed.in_increments[hit.index])
    more = len(unpointed.of_program(hit.index)) - 1
    others = f"; {more} more {'number has' if more == 1 else 'numbers have'} none" if more > 0 else ""
    if count:
        others = f"; the whole program is read in least increments, {count} of its coordinates have no point"
    return {"count": count or more + 1, "taken_as": _taken_as(hit, others)}


def _in_meters(hit: Hit, count: int) -> str:
    """What a word is that a control reads in whole units, and by which setting of it the section is of usual size."""
    from polarcheck.rules.remedies import place

    value = abs(float(hit.trace.text.words.value[hit.index]))
    unit = "inch" if hit.trace.lengths.units[hit.row] == Units.INCH else "mm"
    steps = ("0.0001 inch", 1e-4), ("0.001 inch", 1e-3)
    by_unit = "; ".join(
        f"in units of {name} it is {value * step:g} {unit}"
        for name, step in (steps if unit == "inch" else (("1 um", 1e-3), ("10 um", 1e-2)))
    )
    setting = place(hit.trace.machine, "control.number_without_point")
    others = f", and {count - 1} more are as large" if count > 1 else ""
    return (
        f"{value:g} {unit}{others}: {by_unit}; if a parameter of the control says so, set {setting} to least-increment"
    )


def _taken_as(hit: Hit, others: str) -> str:
    """What the control takes a word of the file as, and how many more there are."""
    import numpy as np

    trace, table, control = hit.trace, hit.trace.text.words, hit.trace.machine.control
    row = int(np.flatnonzero(trace.run.block == table.block[hit.index])[0])
    address, value = chr(int(table.address[hit.index])), float(table.value[hit.index])
    inch = bool(trace.lengths.units[row] == Units.INCH)
    if address == "F":
        return f"{value * _FEED_INCREMENT_INCH:g} inch/min{others}"
    is_angle = address in "CH" and not trace.mode.in_polar[row]
    least = control.least_increment_inch if inch and not is_angle else control.least_increment
    unit = "deg" if is_angle else "inch" if inch else "mm"
    shown = f"{value * least:.4f}".rstrip("0").rstrip(".")
    return f"{shown} {unit}{others}"
