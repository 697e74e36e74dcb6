from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} cannot be used in the polar mode; write it {where}",
    values=("code",),
    subject="word",
)
def code_not_allowed_in_polar(mode_words: ModeWords) -> Hits:
    """
    Code that cannot be used in the polar mode.

    While the mode is on the control accepts moves in G1, G2, G3, dwell, cutter compensation, macro calls and the choice
    of feed, and stops with an alarm at anything else: reference return, drilling and turning cycles, thread cutting,
    spindle speed control, change of units. Write it before G12.1 or after G13.1. A hole pattern needs no polar mode: in
    a drilling cycle C is the angle of the hole. G50 with S alone moves nothing and is a warning.

    Source: FANUC B-62764EN/01, p. 51; 30i alarm list, PS0146; Mitsubishi M700V programming manual, p. 76, P481.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10. G97 S2000    (expect: code-not-allowed-in-polar)
        C-10.
        X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        G50 S3000         (expect: code-not-allowed-in-polar)
        C-10.
        X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G83 X40. C90. Z-10. F100   (expect: code-not-allowed-in-polar)
        C180.
        G80
        G13.1

    Good:

        G50 S3000
        G97 S2000
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G4 X1.
        C10.
        X60.
        G13.1
        G83 X40. C90. Z-10. F100
        C180.
        G80
    """
    other = mode_words.only_outside
    limits_speed = other & mode_words.sets_coordinates
    return graded(error=mode_words.rows(other & ~limits_speed), warning=mode_words.rows(limits_speed), at=other)


def details(hit: Hit) -> Details:
    is_cycle = hit.trace.blocks.listed("drilling_cycle")[hit.row]
    return {"where": hit.outside + (f", where its {hit.rotary} is an angle again" if is_cycle else "")}
