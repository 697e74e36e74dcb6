from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry_angles import EntryAngles
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "no block positions {rotary} after the section before: it stands {turns} from the {switch} of that section, and "
    "this section is turned by that angle; {to_position}",
    values=("turned", "c_angle"),
    worse=("turned",),
    over="sections",
    at=("on",),
    once="program",
    doubts=(("metal", "program"), ("position", "section")),
)
def c_elsewhere_at_entry(entry_angles: EntryAngles) -> Mask:
    """
    Second section at another angle of C, without a block that positions C.

    The angle of C at G12.1 becomes the direction of X on the plane. A section leaves C wherever its last point lies:
    after X40. C20. that is 45 deg. If the next G12.1 follows without a C word, its whole shape is turned by as much
    against the first. Write G0 C0, or the angle that is meant, before each G12.1. Where C stands at the same angle, or
    what the section cuts is the same turned by that angle, as a round or a hexagon at 60 deg, nothing is reported.

    Source: FANUC B-62764EN/01, p. 51; builder's guide to G12.1, angular orientation of the plane.

    Bad:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        C20.
        G13.1
        G12.1             (expect: c-elsewhere-at-entry)
        G1 X30. F200
        C15.
        X60.
        G13.1

    Good:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        C20.
        G13.1
        G0 C0
        G12.1
        G1 X30. F200
        C15.
        X60.
        G13.1

    Good:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        C20.
        G13.1
        G12.1
        G1 X40. C0 F200
        G3 I-20. J0
        G1 X60.
        G13.1
    """
    # NaN where C stands as at the section before.
    return entry_angles.turned_by == entry_angles.turned_by


def details(hit: Hit, entry_angles: EntryAngles) -> Details:
    import numpy as np

    enter, by = hit.trace.mode.sections.enter, abs(float(entry_angles.turned_by[hit.index]))
    here, before = (float(hit.trace.path.c_angle[enter[at]]) for at in (hit.index, hit.index - 1))
    return {
        "turned": by,
        "c_angle": here % 360,
        "turns": f"{by:.4g} deg" if np.isnan(here - before) else f"at {here % 360:.4g} deg, {by:.4g} deg",
        "to_position": _to_position(hit),
    }


def _to_position(hit: Hit) -> str:
    """What to write where nobody has positioned C; of a mode that is left and entered again at once, what to delete."""
    from polarcheck.rules.wording.written import switch

    trace, sections = hit.trace, hit.trace.mode.sections
    enter, last = int(sections.enter[hit.index]), int(sections.last[hit.index - 1])
    begins = switch(trace.blocks, trace.machine, enter)
    approach = f"write {hit.rotary} with the approach before {begins}"
    if last >= len(trace) or trace.axes.moves[last:enter].any():
        return approach
    ends = f"{switch(trace.blocks, trace.machine, last)} of line {hit.line(last)}"
    return f"nothing moves between {ends} and {begins}: delete both, or {approach}"
