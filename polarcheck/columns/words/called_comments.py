"""Comments that say which tool it is that they name by its number."""

from __future__ import annotations

import re

from polarcheck.columns.words.comment_lengths import LONGEST

#: What a comment says of a tool behind its number. With anything else T6 may be a temper, and T10 a wrench.
_TOOL = re.compile(
    r"\bEND\s?-?MILL|\bE[./]?M\b|\bEM\d|MILL\b|CUTTER|DRILL|\bTAP\b|REAM|\bTURN|\bBOR(?:E|ING)\b|GROOV|THREAD|\bFACE\b|FACING"
    r"|\bSPOT\b|CHAMF|\bPART(?:ING|\s?OFF)|CUT\s?-?OFF|KNURL|FREZA|FRESA|FRAISE|FR(?:AE|\u00c4)SER|BOHR|BROCA|FORET"
    r"|\bD\s*=?\s*[\d.]|\bDIA|\bROUGH|\bFINISH|\b[CDVSTW][CNP][MG][GTNA]\b|\bLIVE\b|\bTOOL\b"
)
#: Words by which a comment speaks of a tool that need not be the one beside it.
_OF_ANOTHER = re.compile(
    r"\bNEXT\b|PRESELECT|\bREADY\b|\bWAS\b|\bOLD\b|\bALT|\bSPARE\b|SISTER|BACK-?UP|REPLAC|\bOR\b|\bSAME\b|\bSEE\b|\bAFTER\b"
    r"|\bBEFORE\b|\bDONE\b|\bOFFSET|\bTORX|\bPREV|\bLIKE\b|\bUSED\b|\bINSTEAD|->|\bTO\b|\bFROM\b"
)
_TOOL_NUMBER = re.compile(r"\bT\s?\d|\bTOOL\b")


def speaks_of_tool(comment: str) -> bool:
    """A comment that says of a tool by its number which it is, and of no other tool."""
    text = comment.upper()
    return (
        len(text) <= LONGEST
        and len(_TOOL_NUMBER.findall(text)) == 1
        and not _OF_ANOTHER.search(text)
        and (bool(_TOOL.search(text)) or not re.search(r"[^\W\d]{2}", text))
    )
