"""Suppressed findings: an allow comment or a baseline moves them to a list of their own."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from polarcheck.foundation.finding import ALLOW, Finding, Silenced

#: The table of a rule that runs after all others, because it needs their findings.
UNUSED = "unused_allows"


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
