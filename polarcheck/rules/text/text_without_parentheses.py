from __future__ import annotations

import itertools
import re
from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.program.reading.words import Text
    from polarcheck.rules.hit import Details, Hit

#: The first words are looked for in this much of a text [characters], and in as many texts.
_LOOKED_AT = 200
#: Characters that frame a text and are no part of it.
_LINES = " \t-|=:*#"
#: In this many blocks or more, text is a copied column, not a comment.
_DESCRIPTION = 5


@rule(
    ERROR,
    "{prose}",
    values=("count",),
    worse=("count",),
    over="prose",
    subject="word",
)
def text_without_parentheses(written: Written) -> Hits:
    """
    Text for people that stands in no parentheses.

    Manuals print a program as a table: the blocks, and beside them what they do. If both columns are copied, or a
    title or comment is typed without parentheses, the control reads the text as words: each letter is an address. It
    stops at the first letter without a number or, worse, executes one that has a number. All such text in a file is one
    finding. The program is checked as if the text stood in parentheses. Words of macro statements and of controls' own
    languages are not such text.

    Source: FANUC B-63524EN/01, p. 649 (a comment stands between control-out and control-in); alarms 004 to 010.

    Bad:

        O0001
        T0101
        G98 G0 X60. C0      MOVE TO THE START          (expect: text-without-parentheses)
        G12.1               Polar interpolation ON
        G1 X40. F200        C-axis stays at zero
        C5.                 Infeed must be smaller than the cutter
        X60.
        G13.1               Polar interpolation OFF
        M30                 End

    Bad:

        O0001 FLANGE, SECOND SIDE      (expect: text-without-parentheses)
        T0101
        G98 G0 X60. Z2.
        M30

    Good:

        %
        O0001 (FLANGE, SECOND SIDE)
        T0101
        #1=40.
        G98 G0 X60. C0 (MOVE TO THE START)
        IF[#1GT60.]GOTO 20
        G12.1
        G1 X#1 F200
        X60.
        G13.1
        N20 M30
        %
    """
    count = written.prose_count
    return Hits(count > 0, values={"count": count})


def details(hit: Hit, text: Text, written: Written) -> Details:
    from polarcheck.rules.wording.written import short

    spans = zip(text.prose.start[hit.index :].tolist(), text.prose.end[hit.index :].tolist(), strict=True)
    written_texts = [
        text.source.excerpt(start, min(end, start + _LOOKED_AT)) for start, end in itertools.islice(spans, _LOOKED_AT)
    ]
    texts = (re.sub(r"</?\w[^<>\n]*+>", " ", each).strip(_LINES) for each in written_texts)
    first = short(next((each for each in texts if re.search(r"[^\W\d_]{2}", each)), written_texts[0]))
    count = int(written.prose_count[hit.index])
    where = f" in {count} blocks, first" if count > 1 else ":"
    what = "a description copied with the program: " if count >= _DESCRIPTION else ""
    return {
        "prose": f"text that stands in no parentheses{where} `{first}`; {what}the control reads each letter as an "
        "address and stops; put it in parentheses or delete it"
    }
