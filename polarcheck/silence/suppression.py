"""Suppressed findings: an allow comment or a baseline moves them to a list of their own."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from polarcheck.finding import ALLOW, Finding, Silenced
from polarcheck.reading.source import Source

#: The first word of an allow comment.
WORD = b"POLARCHECK"
#: The table of a rule that runs after all others, because it needs their findings.
UNUSED = "unused_allows"
#: An allow comment by its position in the file [characters], and a name in it.
Used = tuple[int, str]


def mentions_allow(source: Source) -> bool:
    """True if the file can hold allow comments. For most files it is False, and this package is not loaded."""
    return WORD in source.code.tobytes().upper()


def silenced(finding: Finding, by: str, reason: str) -> Silenced:
    """The finding, suppressed by `by` (ALLOW or BASELINE)."""
    values = {name: getattr(finding, name) for name in Finding.__struct_fields__}
    return Silenced(**values, by=by, reason=reason)


def allowed(finding: Finding, reason: str) -> Silenced:
    """The finding, suppressed by a comment of the program."""
    return silenced(finding, ALLOW, reason)


def divided(findings: Iterable[Finding]) -> tuple[list[Finding], list[Silenced]]:
    """Separate reported from suppressed findings, also among those that follow from a reported one."""
    reported: list[Finding] = []
    suppressed: list[Silenced] = []
    for finding in findings:
        if isinstance(finding, Silenced):
            suppressed.append(finding)
            continue
        followers = [follower for follower in finding.follows if not isinstance(follower, Silenced)]
        suppressed += [follower for follower in finding.follows if isinstance(follower, Silenced)]
        if len(followers) < len(finding.follows):
            finding = msgspec.structs.replace(finding, follows=followers)
        reported.append(finding)
    return reported, suppressed
