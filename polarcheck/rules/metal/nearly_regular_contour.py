from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Motion
from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.regularity import Regularity
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{misfit}: {remedy} {as_meant}",
    values=("word", "word_needed"),
    subject="shape",
    follows={
        "loop": ("arc-end-off-circle", "arc-radius-too-small", "arc-center-on-path", "start-up-off-contour"),
        "section": ("rapid-in-polar", "contour-open-with-infeed"),
        "block": ("vacant-variable", "arc-without-center"),
    },
    doubts=(("position", "loop"),),
    is_symptom=True,
)
def nearly_regular_contour(regularity: Regularity) -> Hits:
    """
    One word or block that spoils a regular or symmetric contour.

    All corners of the contour but those of one word fit a regular polygon, or come again after a part of a turn or in a
    mirror, and with this word written otherwise all of them do: two of its digits are swapped, one is missing, its sign
    or its point is wrong, it is that of another block. Or a block is missing. Nothing else objects to such a contour,
    and the part is scrap. Shapes with fewer than five corners are not looked at, nor is a side that lies elsewhere on
    purpose, since no slip of the pen explains where it lies. The same is looked at where a tool goes down without
    compensation at four places or more: all but one of them are those of a regular polygon round the center of C; and
    where sections that cut the same stand at angles of C that divide the turn evenly but for one. In a curve of twelve
    short lines or more a point is off it where the curve is smooth with one word of the point written otherwise.

    Source: the geometry of the contour alone.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G42 X30. F200
        C8.66
        X0 C17.321
        X-30. C8.66
        C-8.66
        X0 C-13.721      (expect: nearly-regular-contour)
        X30. C-8.66
        C0
        G40 X60.
        G13.1

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G42 X30. F200
        C8.66
        X0 C17.321
        X-30. C8.66
        X0 C-17.321      (expect: nearly-regular-contour)
        X30. C-8.66
        C0
        G40 X60.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G42 X30. F200
        C8.66
        X0 C17.321
        X-30. C8.66
        C-8.66
        X0 C-17.321
        X30. C-8.66
        C0
        G40 X60.
        G13.1
    """
    # Compares nothing: the table searches the word or block with which a contour would be regular.
    return Hits(regularity.is_wrong, at=regularity.wrong_words)


def details(hit: Hit, regularity: Regularity) -> Details:
    from polarcheck.rules.wording.written import executed_word

    correction = regularity.explained.get(hit.row) or regularity.corrections[hit.row]
    word = executed_word(hit.trace.run, correction.word) if correction.word >= 0 else ""
    text = _with_code(hit, correction.text) if "a block is missing" in correction.why else correction.text
    return {
        "word": word,
        "word_needed": text,
        "misfit": f"{word or 'this block'} does not fit the rest of the {correction.of}, {correction.why}",
        "remedy": correction.remedy.replace(correction.text, text),
        "as_meant": correction.becomes,
    }


def _with_code(hit: Hit, text: str) -> str:
    """The words of a missing line with the code of a line, where that of an arc is in force before it."""
    from polarcheck.rules.wording.written import move_code

    motion, arcs = hit.trace.axes.motion, (Motion.CW, Motion.CCW)
    codes = [move_code(hit.trace.machine, key) for key in ("arc_clockwise", "arc_counterclockwise")]
    if not hit.row or motion[hit.row - 1] not in arcs or text.partition(" ")[0] in codes:
        return text
    return f"{move_code(hit.trace.machine, 'line')} {text}"
