"""The certificate for people: a matrix with features down and controls across, and the reasons below it."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator

from polarcheck.foundation.errors import counted
from polarcheck.program.reading.excerpt import cells, visible, without_commands
from polarcheck.rewrite.certify.results import (
    FAIL,
    MISSING,
    NO_GOLDEN,
    NOT_OFFERED,
    NOT_RUN,
    PASS,
    CaseResult,
    Cell,
    Certificate,
)

#: Takes the name of a style and a text.
Paint = Callable[[str, str], str]
#: The style of each state, by the names that reports have for verdicts.
_STYLES = {
    PASS: "pass",
    NO_GOLDEN: "unverified",
    FAIL: "fail",
    NOT_RUN: "fail",
    MISSING: "unverified",
    NOT_OFFERED: "aside",
}
_GAP = "  "
_INDENT = "    "


def text(certificate: Certificate, columns: int, paint: Paint) -> str:
    """Return the certificate. columns: width of the terminal [characters]. paint: colors a text."""
    lines = [*_head(certificate), "", *_matrix(certificate, columns, paint)]
    for case in certificate.cases:
        if case.remarks or (case.reasons and case.state != NO_GOLDEN):
            lines += ["", *_reasons(case, columns, paint)]
    if certificate.summary.no_golden:
        lines += ["", "no golden trace yet: certify --update"]
    lines += ["", summary(certificate)]
    return without_commands("".join(f"{line.rstrip()}\n" for line in lines))


def _head(certificate: Certificate) -> Iterator[str]:
    yield visible(certificate.title or certificate.manifest)


def _matrix(certificate: Certificate, columns: int, paint: Paint) -> Iterator[str]:
    """Yield the table; controls for which there is no room follow below in a table of their own."""
    rows = {
        feature: [cell for cell in certificate.cells if cell.feature == feature] for feature in certificate.features
    }
    heads = [visible(control) for control in certificate.controls]
    first = max((cells(visible(feature)) for feature in certificate.features), default=0)
    widths = [
        max([cells(head), *(cells(words(row[number], certificate)) for row in rows.values())])
        for number, head in enumerate(heads)
    ]
    begin = 0
    while begin < len(heads):
        end, room = begin + 1, columns - first - len(_GAP) - widths[begin]
        while end < len(heads) and room >= widths[end] + len(_GAP):
            room -= widths[end] + len(_GAP)
            end += 1
        if begin:
            yield ""
        yield " " * first + "".join(f"{_GAP}{_padded(heads[index], widths[index])}" for index in range(begin, end))
        for feature, row in rows.items():
            states = (
                _GAP + paint(_STYLES[row[index].state], words(row[index], certificate))
                + " " * (widths[index] - cells(words(row[index], certificate)))
                for index in range(begin, end)
            )  # fmt: skip
            yield _padded(visible(feature), first) + "".join(states)
        begin = end


def words(cell: Cell, certificate: Certificate) -> str:
    """Return the state of a cell, with the number of its cases in that state where it has several."""
    if len(cell.cases) < 2:
        return cell.state
    states = [case.state for case in certificate.cases if case.name in cell.cases]
    count = states.count(cell.state)
    return f"{cell.state} {count} of {len(cell.cases)}" if cell.state != PASS else f"{cell.state} {count}"


def _padded(words: str, width: int) -> str:
    return words + " " * (width - cells(words))


def _reasons(case: CaseResult, columns: int, paint: Paint) -> Iterator[str]:
    yield f"{visible(case.name)}: {paint(_STYLES[case.state], case.state)}  {visible(case.program)}"
    for reason in [*case.reasons, *(f"note: {remark}" for remark in case.remarks)]:
        yield from textwrap.wrap(
            visible(reason),
            max(columns, 40),
            initial_indent=_INDENT,
            subsequent_indent=_INDENT + "  ",
            break_long_words=False,
            break_on_hyphens=False,
        )


def summary(certificate: Certificate) -> str:
    """Return the counts in one line."""
    counts = certificate.summary
    parts = [f"{counted(counts.cases, 'case')}: {counts.passed} pass, {counts.fail} fail"]
    parts += [f"{counts.no_golden} without a golden trace"] * bool(counts.no_golden)
    parts += [f"{counts.not_run} not run"] * bool(counts.not_run)
    parts += [f"{counted(counts.missing, 'feature')} of a control missing"] * bool(counts.missing)
    parts += [f"{counts.not_offered} not offered"] * bool(counts.not_offered)
    return ", ".join(parts)
