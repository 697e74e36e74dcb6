"""Phrases of the rules about comments that contradict the part or the tool."""

from __future__ import annotations

from polarcheck.columns.metal.part_comments import BEYOND, DEPTH, TURNED, PartComments
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.words.tool_comments import ToolComments
from polarcheck.program.reading.words import Text
from polarcheck.rules.quantity import in_row
from polarcheck.rules.wording.phrases.common import short


def quoted(text: Text, tool_comments: ToolComments, row: int) -> str:
    """The comment that names another tool."""
    return comment_in_words(text, int(tool_comments.comment[row]))


def comment_in_words(text: Text, number: int) -> str:
    """A comment by its number, as it is written."""
    comments = text.comments
    return short(text.source.excerpt(int(comments.start[number]), int(comments.end[number])))


def comment_on_part(text: Text, part_comments: PartComments, row: int) -> str:
    """The comment that states shape, size or depth, with its line."""
    number = part_comments.contradictions[row].comment
    line = int(text.blocks.line[text.comments.block[number]])
    return f"{comment_in_words(text, number)} in line {line}"


def what_is_made(part_comments: PartComments, lengths: Lengths, row: int) -> str:
    """What the sections of a comment make instead of what it states."""
    hit = part_comments.contradictions[row]
    made = f"{in_row(hit.made, lengths, row):length}"
    whole = {
        DEPTH: f"the cut is {made} deep",
        TURNED: f"the program turns to {made} here",
        BEYOND: f"the contour reaches beyond it, to {made}",
    }
    measure = {"flats": "apart", "circle": "in diameter"}.get(hit.shape, "across flats")
    return whole.get(hit.shape, f"the part here: {hit.shape} {made} {measure}")
