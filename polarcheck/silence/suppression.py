"""Findings that somebody has answered for: out of the findings, and none of them is lost."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from polarcheck.finding import ALLOW, Finding, Silenced
from polarcheck.reading.source import Source

#: With what an allow comment begins.
WORD = b"POLARCHECK"
#: The table that a rule names which is asked once it is known what all others have found.
UNUSED = "unused_allows"
#: A name of an allow comment, with the position of that.
Used = tuple[int, str]


def mentions_allow(source: Source) -> bool:
    """Whether there can be any allow comments: most files have none, and need nothing of what reads them."""
    return WORD in source.code.tobytes().upper()


def silenced(finding: Finding, by: str, reason: str) -> Silenced:
    """A finding as one that is silenced."""
    values = {name: getattr(finding, name) for name in Finding.__struct_fields__}
    return Silenced(**values, by=by, reason=reason)


def allowed(finding: Finding, reason: str) -> Silenced:
    """A finding that a comment of the program allows."""
    return silenced(finding, ALLOW, reason)


def divided(findings: Iterable[Finding]) -> tuple[list[Finding], list[Silenced]]:
    """The findings that are told, and those that are silenced; of what follows from one of them, too."""
    told: list[Finding] = []
    silent: list[Silenced] = []
    for finding in findings:
        if isinstance(finding, Silenced):
            silent.append(finding)
            continue
        own = [one for one in finding.follows if not isinstance(one, Silenced)]
        silent += [one for one in finding.follows if isinstance(one, Silenced)]
        told.append(finding if len(own) == len(finding.follows) else msgspec.structs.replace(finding, follows=own))
    return told, silent
