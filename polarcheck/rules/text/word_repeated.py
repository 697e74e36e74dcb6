from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.program.reading.words import Words
    from polarcheck.rules.hit import Details, Hit

#: Of many words of one address so many are listed, and the last.
_LISTED = 3


@rule(
    WARNING,
    "{repeated}; the control takes the last: write one of them, or a block for each{count:blocks}",
    values=("count",),
    worse=("count",),
    over="words",
    doubts=(("position", "loop"),),
)
def word_repeated(written: Written) -> Hits:
    """
    Same address twice in a block.

    The control takes the last of the two or, with parameter 3403#6 set, stops with an alarm. Mostly two blocks have
    lost the line end between them. G and M words may stand together, and I J K in macro calls. An address that is
    repeated in more than five blocks is reported once.

    Source: FANUC alarm 5074.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10. X60. C0      (expect: word-repeated)
        G13.1

    Good:

        O0001
        G98 G0 X60. C0 M8 M10
        G1 X50. R4. ,R1. F200
        G65 P9000 I1. J2. I3. J4.
        M30
        O9000
        G4 U1.
        M99
    """
    return Hits(written.repeat_count > 0, values={"count": written.repeat_count})


def details(hit: Hit, words: Words) -> Details:
    import numpy as np

    from polarcheck.foundation.arrays import stretch
    from polarcheck.foundation.errors import enumerated
    from polarcheck.rules.places import squeezed
    from polarcheck.rules.wording.written import short

    low, high = stretch(words.block, int(words.block[hit.index]), int(words.block[hit.index]) + 1)
    same = low + np.flatnonzero(words.address[low:high] == words.address[hit.index])
    # A line of 50 MB may be one block: only what is listed is taken out of it.
    listed = same if len(same) <= _LISTED + 1 else np.append(same[:_LISTED], same[-1])
    spans = zip(words.start[listed].tolist(), words.end[listed].tolist(), strict=True)
    written = [short(squeezed(hit.trace.text.source.excerpt(start, end))) for start, end in spans]
    written[-1:] = written[-1:] if len(listed) == len(same) else ["...", written[-1]]
    letter = chr(int(words.address[hit.index]))
    address = f",{letter.upper()}" if letter.islower() else letter
    often = "twice" if len(same) == 2 else f"{len(same)} times"
    return {"repeated": f"{address} is written {often} in this block: {enumerated(written)}"}
