from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.switch_words import SwitchWords


@rule(
    ERROR,
    "{E} beside {switch} {infeed_fault}",
    values={"word": "E", "infeed": "infeed_taken"},
    at=("E",),
    follows={"block": ("too-many-digits",)},
)
def infeed_out_of_range(switch_words: SwitchWords) -> Hits:
    """
    Infeed that its word cannot hold.

    E of G12.1 is a number of least increments, with as many digits as a number can have: up to 999999.999 mm or
    99999.9999 inch, and a tenth of that where the control counts in a tenth of the increment. Beyond it there is an
    alarm. Digits below the least increment are dropped, which is a warning: the passes lie where they were not meant,
    and of an infeed below one increment nothing is left, so that the contour is cut in a single pass.

    Source: GSK 988, description of G12.1 IP P Q E, table of ranges.

    Bad, machine gsk-988, tool 2:radius=5, tool 2:nose=0:

        T0202
        G98 G0 X120. C0
        G12.1 E1000000.       (expect: infeed-out-of-range)
        G42 G1 X80. F200
        C40.
        X-80.
        C-40.
        X80.
        C0
        G40 X120.
        G13.1

    Bad, machine gsk-988, tool 2:radius=5, tool 2:nose=0:

        T0202
        G98 G0 X120. C0
        G12.1 E4.0005         (expect: infeed-out-of-range)
        G42 G1 X80. F200
        C40.
        X-80.
        C-40.
        X80.
        C0
        G40 X120.
        G13.1

    Good, machine gsk-988, tool 2:radius=5, tool 2:nose=0:

        T0202
        G98 G0 X120. C0
        G12.1 E-4.005
        G42 G1 X80. F200
        C40.
        X-80.
        C-40.
        X80.
        C0
        G40 X120.
        G13.1
    """
    # Compares nothing: the message tells what the word can hold, from the same columns.
    return graded(error=switch_words.infeed_too_large, warning=switch_words.infeed_too_fine)
