"""Lengths in the text of comments: `12.5`, `3/4"`, `1-1/4`, `8MM`; and the comments in which words stand."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.reading.words import Text

# No text may cost more than its length: a repeat takes all it can and gives nothing back (`++`), and a number is tried
# at the first of its digits only.
#: A number as a group: whole and fraction, fraction, decimals with a point or a comma.
NUMBER = (
    r"((?<![\d.])\d++(?:\s++|\s*+-\s*+)\d++/\d++(?![\d/.])|(?<![\d/.])\d++\s*+/\s*+\d++(?![\d/])"
    r"|(?<!\d)(?<!\d[.,])\d++(?:[.,]\d++)?+(?![.,]\d|/)\.?+|(?<!\d)\.\d++)"
)
#: Its unit as a group, which may be missing.
UNIT = r"(?:\s*+(\"|''|\u201d|INCH(?:ES)?+\b|IN\b\.?+|ZOLL\b|MM\b))?+"
#: Nothing may be written at the end of a number and its unit that would make it another one: 16H7, 4FL, 10%.
ENDS = r"(?![\w%/#\u00b0])(?![.,]\d)"
_MILLIMETERS = "MM"
#: Fractions of an inch have these denominators.
_DENOMINATORS = (2, 4, 8, 16, 32, 64)
#: Words that are looked at in the comments of a file.
_MOST = 2000
#: No note is longer [characters]. Some patterns cost more than the length of their text, and so little of so much.
LONGEST = 400
#: Zeros before a number.
_ZEROS = re.compile(r"0{9,}+")
#: Quotes round a word; behind a number they are inches.
_QUOTES = re.compile(r"\"(?=[A-Z])|(?<=[A-Z])\"")
#: No more digits than this are a length; a longer number would cost more than its text to convert.
_MOST_DIGITS = 9


def length_of(number: str, unit: str | None, in_inch: bool) -> float | None:
    """
    A number of a comment as a length [mm]; None where it is none.

    number, unit: as NUMBER and UNIT find them. in_inch: the unit of the program, which counts where the comment has
    none of its own; a fraction is always of an inch.
    """
    value = _value_of(number)
    if value is None:
        return None
    is_inch = (unit != _MILLIMETERS) if unit else in_inch or "/" in number
    if "/" in number and not is_inch:
        return None
    return value * (MM_PER_INCH if is_inch else 1.0)


def _value_of(number: str) -> float | None:
    if len(number) > 2 * _MOST_DIGITS:
        return None
    if "/" not in number:
        return float(number.replace(",", "."))
    above, below = re.split(r"\s*/\s*", number)
    whole, _, above = above.replace("-", " ").rpartition(" ")
    if int(below) not in _DENOMINATORS or (whole.strip() and int(above) >= int(below)):
        return None
    return (int(whole) if whole.strip() else 0) + int(above) / int(below)


def plain_text(comment: str) -> str:
    """
    A comment in upper case without its parentheses, as the patterns read it: names of posts have `_` for a blank.

    Empty for a comment so long that it is no plain note.
    """
    comment = _ZEROS.sub("0", comment)
    if len(comment) > LONGEST:
        return ""
    plain = _QUOTES.sub("", comment.upper().replace("_", " "))
    return plain.strip(";()% \"'\t\r\n")


def comments_with(text: Text, words: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """
    The comments in which one of these words stands, in upper or lower case, with their numbers.

    The text of all comments is searched at once, since a file may have 100,000 of them and none of the words. With the
    words more often than in any program that a person writes there are none.
    """
    comments = text.comments
    if not len(comments):
        return
    length = comments.end - comments.start
    begin = np.cumsum(length) - length
    joined = text.source.code[np.repeat(comments.start - begin, length) + np.arange(length.sum())].tobytes().upper()
    wanted = [word.encode("latin-1") for word in words]
    places = [match.start() for word in wanted if word in joined for match in re.finditer(re.escape(word), joined)]
    if not places or len(places) > _MOST:
        return
    numbers = sorted({int(number) for number in np.searchsorted(begin, places, side="right") - 1})
    for number in numbers:
        yield number, text.source.excerpt(int(comments.start[number]), int(comments.end[number]))
