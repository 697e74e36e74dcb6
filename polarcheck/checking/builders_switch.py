"""A contour between codes that may be the builder's own switches of the polar mode: its findings are conditional."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from polarcheck.checking.engine import in_order
from polarcheck.columns.modes.switch_slips import SwitchSlips
from polarcheck.foundation.finding import FileReport, Finding, Undecided
from polarcheck.program.execution.runs import runs
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.tables import Tables
from polarcheck.rules.wording.written import executed_word

#: The rule that reports the codes.
RULE = "polar-switch-unknown"


class Supposition(msgspec.Struct, frozen=True):
    """
    That two codes of a channel switch the mode.

    name: of the code that would begin it. channel: its runs on the machine with both codes. spans: the first and last
    line of the file between each of the codes and the one that answers it.
    """

    name: str
    channel: list[tuple[str, Tables]]
    spans: list[tuple[int, int]]


def supposition(tables: Tables) -> Supposition | None:
    """Return what the codes of the builder would make of a channel; None where it has none that answer each other."""
    switch_slips: SwitchSlips = tables["switch_slips"]
    slips = [slip for slip in switch_slips.slips.values() if slip.is_of_builder]
    if not slips:
        return None
    run, machine, trace = tables["run"], tables["machine"], tables["trace"]
    words = switch_slips.words.nonzero()[0].tolist()
    on, off = (
        list(dict.fromkeys(executed_word(run, index) for index in words if run.row[index] in rows))
        for rows in ({slip.row for slip in slips}, {slip.answer for slip in slips})
    )
    source = trace.text.source
    # With several channels, and called files, nothing is supposed: their text is no longer that of one file.
    if source.channel or source.parts or len(on) != 1 or len(off) != 1:
        return None
    lines = trace.blocks.line_in_file
    spans = [(int(lines[slip.row]), int(lines[slip.answer])) for slip in slips]
    own, job = _with(machine, on[0], off[0]), tables["job"]
    return Supposition(on[0], [(state, Tables(run, own, job)) for state, run in runs(source, own, job)], spans)


def _with(machine: Machine, on: str, off: str) -> Machine:
    """Return the machine with two more codes that switch its mode."""
    polar = msgspec.structs.replace(machine.polar, on=[*machine.polar.on, on], off=[*machine.polar.off, off])
    return msgspec.structs.replace(machine, polar=polar)


def with_supposed(report: FileReport, supposed: FileReport, supposition: Supposition) -> FileReport:
    """
    Add the findings of the supposed mode to a report, as conditional ones.

    What the report says of the contour as one outside the mode is left out. The verdict stays that of the codes.
    """
    kept = [finding for finding in report.findings if finding.rule == RULE or not _within(finding, supposition.spans)]
    known = {_identity(finding) for finding in kept}
    conditional = [
        _conditional(finding, supposition.name) for finding in supposed.findings if _identity(finding) not in known
    ]
    return msgspec.structs.replace(report, findings=in_order([*kept, *conditional]))


def _within(finding: Finding, spans: Sequence[tuple[int, int]]) -> bool:
    return any(first <= finding.line <= last for first, last in spans)


def _identity(finding: Finding) -> tuple[str, int, int]:
    return finding.rule, finding.line, finding.column


def _conditional(finding: Finding, name: str) -> Finding:
    """Return a finding that holds if a code begins the mode; it has no fix, since that rests on it, too."""
    values = {field: getattr(finding, field) for field in Finding.__struct_fields__}
    return Undecided(**{**values, "message": f"if {name} begins the mode: {finding.message}", "fix": None})
