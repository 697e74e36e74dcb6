from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.implied_units import ImpliedUnits
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{needed}: the lengths count as {unit}, and {sizes}; in {other_unit} they fit",
    values=("code", "code_needed"),
    at=("inch", "mm"),
    doubts=(("position", "program"), ("size", "program")),
)
def units_contradict_sizes(implied_units: ImpliedUnits) -> Mask:
    """
    Program whose sizes are those of the other unit.

    G20 or G21 is missing, or is the wrong one of the two, so that the control reads inches as mm or mm as inches. The
    lathe cuts nothing, or into everything. Two sizes at least say so, one of them of a body: the cutter is larger than
    the whole contour, or much too small for it; R of the job is that of the comment in the other unit; no X comes near
    the bar, or all lie far outside it. Others are the digits, F and X. Sizes of cutter and bar count where the job says
    their unit (`units`). Against a G20 or G21 of the program three sizes are needed. What else is found of lengths in
    the program is listed under this finding. Write the code; where the lathe powers up in that unit, give it with
    `--units`.

    Source: FANUC G-code systems A and B, G20 and G21 (inch and metric input); builder's guide to G12.1, T0808 (3/4"
    DIA. CUTTER).

    Bad, set job.units="mm", tool 8:radius=4.7625:

        O1
        T0808 (3/8 DIA. CUTTER)
        G98 G0 X3. C0     (expect: units-contradict-sizes)
        G12.1
        G1 X2.4 F50.
        Z-.2 F5.
        G42 X1.1811
        C.341
        X0 C.6819
        X-1.1811 C.341
        C-.341
        X0 C-.6819
        X1.1811 C-.341
        C0
        G40 X2.4
        Z.1 F50.
        G13.1
        M30

    Bad, set job.units="mm", tool 8:radius=4:

        O1
        G20 G98           (expect: units-contradict-sizes)
        T0808
        G0 X60. C0
        G12.1
        G1 X56. F1000.
        Z-4. F200.
        G42 X36.
        C10.392
        X0 C20.785
        X-36. C10.392
        C-10.392
        X0 C-20.785
        X36. C-10.392
        C0
        G40 X56.
        Z2. F1000.
        G13.1
        M30

    Good, set job.units="mm", tool 8:radius=4.7625:

        O1
        G20 G98
        T0808 (3/8 DIA. CUTTER)
        G0 X3. C0
        G12.1
        G1 X2.4 F50.
        Z-.2 F5.
        G42 X1.1811
        C.341
        X0 C.6819
        X-1.1811 C.341
        C-.341
        X0 C-.6819
        X1.1811 C-.341
        C0
        G40 X2.4
        Z.1 F50.
        G13.1
        M30
    """
    # Compares nothing: how many sizes must speak for the other unit is a matter of the table.
    return implied_units.is_other


def details(hit: Hit, implied_units: ImpliedUnits) -> Details:
    from polarcheck.rules.wording.written import code_of

    trace, row = hit.trace, hit.row
    in_inch = bool(implied_units.in_inch[row])
    units = ("inch", "mm") if in_inch else ("mm", "inch")
    code, code_needed = (code_of(trace.machine, unit) for unit in units)
    is_written = bool(trace.modal.sets("units")[row])
    return {
        "code": code if is_written else None,
        "code_needed": code_needed,
        "needed": f"write {code_needed} instead of {code}" if is_written else f"{code_needed} is missing",
        "unit": units[0],
        "other_unit": units[1],
        "sizes": _sizes(hit, implied_units),
    }


def _sizes(hit: Hit, implied_units: ImpliedUnits) -> str:
    """The sizes that say so, in words."""
    from polarcheck.foundation.errors import enumerated

    too = "large" if implied_units.in_inch[hit.row] else "small"
    says = {
        f"the contours are too {too} for the cutter": implied_units.by_cutter,
        "the comment states another R than the job": implied_units.by_comment,
        f"X is too {too} for the bar": implied_units.by_bar,
        "coordinates have more digits than the control": implied_units.by_digits,
        f"F is too {too}": implied_units.by_feed,
        f"X is very {too}": implied_units.by_x,
    }
    return enumerated(words for words, witness in says.items() if witness[hit.row])
