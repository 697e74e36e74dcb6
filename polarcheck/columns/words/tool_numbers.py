"""The tool that a comment names at its head: `T9 END MILL D12`, `TOOL NO. 9 - DRILL`, `T0909`."""

from __future__ import annotations

import re

#: A tool number of up to eight digits behind its zeros, more than any T word has.
_TOOL = re.compile(r"\W*+(?:T\s*+(?=\d)|TOOL\s*+(?:NO\b|NR\b|NUMBER\b|#)[\s:.#]*+(?=\d))0*+(\d{0,8}+)\b(?![.,/]\d)")


def named_tool(comment: str) -> int | None:
    """The number behind T at the head of a comment, as it is written: 909 in `T0909`; None where there is none."""
    match = _TOOL.match(comment.upper())
    return int(match[1] or 0) if match else None
