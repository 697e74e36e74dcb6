from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.words.unknown_words import UnknownWords
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{word} is calculated with {variable}, and no block of the file sets {variable}: it counts as 0; set it before,"
    " or correct its number",
    values=("word", "variable"),
    doubts=(("position", "section"),),
)
def variable_never_set(blocks: ExecutedBlocks, unknown_words: UnknownWords) -> Hits:
    """
    Coordinate calculated with a variable that nothing sets.

    In a calculation a vacant variable counts as 0. Where no block of the file sets it, its number is mistyped, or an
    assignment is missing, and the contour is another than was meant. The first coordinate in the polar mode that rests
    on it is reported; what follows from the contour is listed under it. Arguments of macro calls may be left out on
    purpose, and are not reported.

    Source: FANUC B-62754EN/01, chapter 16.3.

    Bad:

        O0001
        T0101
        #107=#112+20.
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C#107             (expect: variable-never-set)
        X-40.
        G13.1
        M30

    Good:

        O0001
        T0101
        #112=5.
        #107=#112+20.
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C#107
        X-40.
        G13.1
        M30
    """
    # Compares nothing: the words are those for which the execution has noted a vacant variable.
    return Hits(blocks.with_words(unknown_words.with_vacant), at=unknown_words.with_vacant)


def details(hit: Hit) -> Details:
    return {"variable": f"#{hit.trace.run.never_set[hit.words[0]]}"}
