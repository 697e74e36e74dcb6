from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.stated_parts import PartComments
    from polarcheck.rules.hit import Details, Hit

#: How a size of a shape is measured; of others it is across flats.
_ACROSS = {
    "flats": "apart",
    "circle": "in diameter",
    "rectangle": "on one side",
    "keyway": "wide",
    "slot": "wide",
    "round with keyway": "wide",
}


@rule(
    WARNING,
    "{comment_on_part} states {stated_shape}{stated:length}; {what_is_made}",
    values=("stated", "made"),
    worse=("stated:made",),
    subject="metal",
)
def comment_contradicts_part(part_comments: PartComments) -> Hits:
    """
    Another shape, size or depth than the comment of this section or tool states, or a bar smaller than the part.

    The program was changed for another part and the comment was left as it was, or a word of the contour is wrong.
    Compare with the drawing.

    What counts is a comment between the call of the tool and the end of the section, the line of a list of tools with
    the number of this tool, and the title of a program with one section, or one shape; the nearest one, and only where
    it states sizes in plain words: HEX 24 AF, SQ 20, FLATS 22, DIA 30 BOSS, DIA 20 PIN, KEYWAY 8, DEPTH 5, 5 DEEP. A
    plain DIA 20 counts in the title alone, against a larger round, where nothing is turned. Of several sizes one that
    is made is enough. Roughing, sockets, bars (HEX 24 AF FROM HEX 32), and a size that another section reaches
    contradict nothing. A depth counts from Z0 or from any face that the program cuts. A polygon with as many sides as
    the comment says is regular, too: where two words move a flat, nothing else objects to it.

    The comment that states the bar of the program (BAR DIA 28, STOCK D50, HEX BAR 32) may stand anywhere in it. It
    contradicts a larger diameter that the program turns first, and a contour that reaches beyond the bar with its
    corners. Sharp corners of a hexagon that the bar cuts off, and a rectangle that makes two flats, contradict nothing.

    Source: notes of shops at the heads of sections.

    Bad, tool 1:radius=4:

        O1
        G21 G98
        T0101 (HEX 24 AF)
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C6.351    (expect: comment-contradicts-part)
        X0 C12.702
        X-22. C6.351
        C-6.351
        X0 C-12.702
        X22. C-6.351
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30

    Bad, tool 1:radius=4:

        O1
        G21 G98
        T0101 (SQ 22)
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C6.351    (expect: comment-contradicts-part)
        X0 C12.702
        X-22. C6.351
        C-6.351
        X0 C-12.702
        X22. C-6.351
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30

    Bad, tool 1:radius=4:

        O1
        G21 G98
        (T1 EM8, DEPTH 6)
        T0101
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300    (expect: comment-contradicts-part)
        G42 X22. F200
        C6.351
        X0 C12.702
        X-22. C6.351
        C-6.351
        X0 C-12.702
        X22. C-6.351
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30

    Bad, tool 1:radius=4:

        O1 (SHAFT HEX 24 AF FROM BAR 30)
        G21 G98
        T0101
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C6.351    (expect: comment-contradicts-part)
        X0 C12.702
        X-22. C6.351
        C-6.351
        X0 C-12.702
        X22. C-6.351
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30

    Bad, tool 1:radius=4:

        O1 (BAR DIA 25)
        G21 G98
        T0202
        G97 S500 M3
        G0 X34. Z2.
        G1 X30. F100
        Z-20.    (expect: comment-contradicts-part)
        G0 X60. Z50.
        M5
        T0101 S2500 M13
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C6.351
        X0 C12.702
        X-22. C6.351
        C-6.351
        X0 C-12.702
        X22. C-6.351
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30

    Good, tool 1:radius=4:

        O1
        G21 G98
        T0101 (EM8, HEX 22 AF, DEPTH 5)
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C6.351
        X0 C12.702
        X-22. C6.351
        C-6.351
        X0 C-12.702
        X22. C-6.351
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30

    Good, tool 1:radius=4:

        O1
        G21 G98
        T0101 (ROUGH HEX 24 AF)
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C6.351
        X0 C12.702
        X-22. C6.351
        C-6.351
        X0 C-12.702
        X22. C-6.351
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30

    Good, tool 1:radius=4:

        O1 (SHAFT 22 AF FROM HEX 24)
        G21 G98
        T0101 (HEX 24 BAR)
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C6.351
        X0 C12.702
        X-22. C6.351
        C-6.351
        X0 C-12.702
        X22. C-6.351
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30
    """
    # Compares nothing: the table looks for the sections that each comment speaks of, and measures what they make.
    return Hits(part_comments.contradicts, values={"stated": part_comments.stated})


def details(hit: Hit, part_comments: PartComments) -> Details:
    from polarcheck.columns.metal.stated_parts import BEYOND, DEPTH, TURNED, UNEVEN
    from polarcheck.rules.wording.written import comment_in_words

    contradiction, text = part_comments.contradictions[hit.row], hit.trace.text
    line = int(text.blocks.line[text.comments.block[contradiction.comment]])
    made = hit.length(contradiction.made)
    whole = {
        DEPTH: f"the cut is {made} deep",
        TURNED: f"the program turns to {made} here",
        BEYOND: f"the contour reaches beyond it, to {made}",
        UNEVEN: f"the polygon here is not regular, it measures {made} along X",
    }
    across = _ACROSS.get(contradiction.shape, "across flats")
    return {
        "made": contradiction.made,
        "stated_shape": f"{contradiction.stated_shape} " if contradiction.stated_shape else "",
        "comment_on_part": f"{comment_in_words(text, contradiction.comment)} in line {line}",
        "what_is_made": whole.get(contradiction.shape, f"the part here: {contradiction.shape} {made} {across}"),
    }
