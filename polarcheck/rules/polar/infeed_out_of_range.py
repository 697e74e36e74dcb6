from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.switch_words import SwitchWords
    from polarcheck.columns.path.infeed import Infeed
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{word} beside {switch} {infeed_fault}",
    values=("word", "infeed"),
    at=("E",),
    subject="word",
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


def details(hit: Hit, switch_words: SwitchWords, infeed: Infeed) -> Details:
    row, taken = hit.row, infeed.depth[hit.row]
    is_too_large = switch_words.infeed_too_large[row]
    limit, least, depth = (
        _every_digit(hit, column[row])
        for column in (switch_words.infeed_limit, hit.trace.lengths.least_step, infeed.depth)
    )
    once = "" if taken > 0 else ", which is a single pass"
    return {
        "word": hit.written("E"),
        "infeed": None if is_too_large else taken,
        "infeed_fault": f"is too large: {limit} is the most"
        if is_too_large
        else f"is finer than the least increment, {least}: {depth} is taken{once}",
    }


def _every_digit(hit: Hit, length: float) -> str:
    """A length with all the digits that a control can hold."""
    shown = hit.quantity(float(length))
    return f"{shown.length(shown.value):.10g} {shown.unit}"
