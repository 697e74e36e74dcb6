from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.allow_comments import Allows


@rule(NOTE, "{unpaired}", over="allows")
def allow_range_unpaired(allows: Allows) -> Hits:
    """
    ALLOW-ON without ALLOW-OFF, or the other way round.

    A range that is never closed reaches to the end of the file, and silences what is written behind it later. Close it
    with ALLOW-OFF and the same names. If the whole file is meant, ALLOW-FILE at its head says so. An ALLOW-OFF that
    closes nothing names another rule than the ALLOW-ON, or stands before it.

    Source: polarcheck, docs/silence.md.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        (POLARCHECK ALLOW-ON RAPID-IN-POLAR PROVEN ON L7)   (expect: allow-range-unpaired)
        G0 C5.
        G1 C-5.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        (POLARCHECK ALLOW-ON RAPID-IN-POLAR PROVEN ON L7)
        G0 C5.
        (POLARCHECK ALLOW-OFF RAPID-IN-POLAR)
        G1 C-5.
        G13.1
    """
    return Hits(allows.is_in_main_file & (allows.unpaired != ""), values={"unpaired": allows.unpaired})
