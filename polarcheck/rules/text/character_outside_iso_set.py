from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.rules.hit import Details, Hit


@rule(
    NOTE,
    "{are} not in the ISO set of controls{count:blocks}",
    values=("characters", "count"),
    worse=("characters", "count"),
    over="foreign",
)
def character_outside_iso_set(written: Written) -> Hits:
    """
    Character that controls have no code for.

    Programs are sent in the ISO code: control characters, NUL and anything beyond plain ASCII may come out as another
    character, or raise a TH alarm on the way into the control, even in a comment. Each line is reported once, more than
    five lines at the first of them. NUL at the head of a file is the leader of a tape, and harmless on a control that
    skips it.

    Source: FANUC B-63524EN/01, p. 649 and tape code list.

    Bad:

        T0101 (FRÄSER Ø16)            (expect: character-outside-iso-set)
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good:

        T0101 (MILL DIA.16)
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    return Hits(written.foreign_line_count > 0, values={"count": written.foreign_line_count})


def details(hit: Hit, written: Written) -> Details:
    count = int(written.foreign_count[hit.index])
    return {"characters": count, "are": "1 character that is" if count == 1 else f"{count} characters that are"}
