"""The word that begins an allow comment, for those who must know whether a file can hold one."""

from __future__ import annotations

from polarcheck.program.reading.source import Source

#: The first word of an allow comment.
WORD = b"POLARCHECK"
#: An allow comment by its position in the file [characters], and a name in it.
Used = tuple[int, str]


def mentions_allow(source: Source) -> bool:
    """True if the file can hold allow comments. For most files it is False, and the others are not loaded."""
    return WORD in source.code.tobytes().upper()
