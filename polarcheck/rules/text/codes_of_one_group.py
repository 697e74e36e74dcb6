from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{code} and {other_code} of one modal group in a block; the control takes the last, {code}{count:blocks}",
    values=("code", "other_code", "count"),
    worse=("count",),
    over="words",
)
def codes_of_one_group(written: Written) -> Hits:
    """
    Two G codes of one modal group in a block.

    They exclude each other: the control takes the last one or, with parameter 3403#6 set, stops with an alarm. Write
    only the one that is meant. The same two in more than five blocks are reported once. Not reported are G90, G92 and
    G94 beside G0 to G3 in G-code system A, where they are cycles: other systems and mills write them so, in another
    meaning.

    Source: FANUC alarm 5074; B-62754EN/01, G code list.

    Bad:

        G98 G0 X60. C0
        G12.1
        G0 G1 X40. F200   (expect: codes-of-one-group)
        C10.
        X60.
        G13.1

    Bad:

        G17 G18 G40 G80   (expect: codes-of-one-group)

    Good:

        G40 G80 G97 G98 G0 X60. C0
        G1 X50. G1 F100
        G0 X60.
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    return Hits(written.overruled_count > 0, values={"count": written.overruled_count})


def details(hit: Hit, written: Written) -> Details:
    from polarcheck.rules.wording.written import g_code

    return {
        "code": g_code(hit.trace.text, hit.index),
        "other_code": g_code(hit.trace.text, int(written.overruled[hit.index])),
    }
