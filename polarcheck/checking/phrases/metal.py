"""Phrases of the rules about the metal."""

from __future__ import annotations

from polarcheck.checking.phrases.common import short
from polarcheck.reading.words import Text
from polarcheck.table.tool_comments import ToolComments


def quoted(text: Text, tool_comments: ToolComments, row: int) -> str:
    """The comment that names another tool."""
    return comment_in_words(text, int(tool_comments.comment[row]))


def comment_in_words(text: Text, number: int) -> str:
    """A comment by its number, as it is written."""
    comments = text.comments
    return short(text.source.excerpt(int(comments.start[number]), int(comments.end[number])))
