from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Motion
from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arc_words import ArcWords
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{word} in a straight move does nothing: {forgotten_arc}",
    values=("word",),
    gouges=True,
    once="motion",
    subject="",
    doubts=(("compensation", "loop"),),
)
def arc_word_without_arc(arc_words: ArcWords) -> Hits:
    """
    R, I or J in a move that is no arc.

    These words belong to G2 and G3. In a straight move the control ignores them, so that a G2 or G3 that was forgotten
    cuts the corner off where it should be round, and nothing is said. Not reported are corners that a control takes so,
    as `,R`, the words beside G40, and 0.

    Source: FANUC B-62764EN/01, p. 51 (I, J and R are words of G02 and G03).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C16.
        X32. C20. R4.       (expect: arc-word-without-arc)
        G1 X-32.
        G3 X-40. C16. R4.
        G1 C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C16.
        G3 X32. C20. R4.
        G1 X-32. I0
        G3 X-40. C16. R4.
        G1 C-20.
        X40.
        C0
        G40 X100. I10.
        G13.1
    """
    # Compares nothing: the table looks for words that neither an arc nor a corner uses.
    return Hits(arc_words.rows, at=arc_words.at)


def details(hit: Hit, arc_words: ArcWords, machine: Machine) -> Details:
    from polarcheck.rules.wording.written import move_code

    codes = {Motion.CW: move_code(machine, "arc_clockwise"), Motion.CCW: move_code(machine, "arc_counterclockwise")}
    sense = arc_words.sense(hit.row)
    missing = f"{' or '.join(codes.values()) if sense is None else codes[sense]} is missing"
    return {
        "word": hit.word_list,
        "forgotten_arc": missing + (f", here and in {hit.count - 1} more blocks" if hit.count > 1 else ""),
    }
