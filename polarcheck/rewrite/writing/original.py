"""The program that is rewritten."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.checking import check
from polarcheck.checking.not_evaluated import unknown_values
from polarcheck.checking.settings import Settings
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.macro_faults import reason_of
from polarcheck.foundation.finding import SEVERITIES, Severity
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

#: Remarks of blocks behind which nobody knows what runs.
BLOCKS_NOT_KNOWN = ("condition-unknown", "program-unknown", "return-jumps")


#: Groups of rules about text that a control reads otherwise, or not at all.
_GROUPS = ("text", "macro")
#: Further rules of that kind. Errors of the mode itself, such as a rate of C or a code that it does not allow, stay or
#: end with it; where the path of the tool center is not certain, the columns say so.
_RULES = (
    "arc-center-on-path", "arc-end-off-circle", "arc-off-polar-plane", "arc-radius-too-small", "arc-without-center",
    "arc-word-of-other-plane", "cancel-on-arc", "incremental-word-of-other-code-system", "linear-axis-never-programmed",
    "modal-state-wrong-at-entry", "origin-shifted-in-polar", "polar-axis-number-wrong", "polar-shift-incremental",
    "second-axis-never-programmed", "start-up-on-arc", "wrong-axis-address-in-polar",
)  # fmt: skip


class Original(msgspec.Struct, frozen=True):
    """
    The program that is rewritten.

    path: as it is shown. data: its bytes. settings: its machine, job and encoding. tables: of its one run.
    """

    path: str
    data: bytes
    settings: Settings
    tables: Tables

    @property
    def trace(self) -> Trace:
        """The executed blocks."""
        trace: Trace = self.tables["trace"]
        return trace

    @property
    def unknown(self) -> list[Refusal]:
        """The variables without a value, those on which sections rest before the others."""
        values = sorted(unknown_values(self.tables), key=lambda value: not value.matters)
        return [Refusal(value.line, value.reason) for value in values]

    @property
    def unpointed(self) -> list[tuple[int, Refusal]]:
        """Numbers without a point that the control counts in increments, though they seem to be meant otherwise."""
        trace, reasons = self.trace, []
        for index in np.flatnonzero(trace.coordinates.is_taken_as_pointed).tolist():
            row, written = int(trace.run.row[index]), trace.text.written(trace.run.words, index)
            text = f"{written} has no point, and the control counts it in increments: write the point, or"
            how = "--set control.number_without_point=whole-unit where the control takes it for a whole unit"
            reasons.append((row, Refusal(trace.line(row), f"{text} {how}")))
        return reasons

    def faults(self, *rules: str) -> list[Refusal]:
        """
        Return what makes sections of the program uncertain: errors of a check, whatever the job makes of them and allow
        comments aside, and numbers without a point.

        rules: names of further rules, of which warnings count, too.
        """
        chosen = [rule for name, rule in load_all().items() if rule.group in _GROUPS or name in (*_RULES, *rules)]
        report = check.check_runs([("", self.tables)], chosen, inline=False)
        found = [
            Refusal(finding.line, f"{finding.message} [{finding.rule}]")
            for finding in report.findings
            if finding.section_line is not None
            # Arcs are off their circles where that is but a warning, too, as on a control whose manual was not at hand.
            and SEVERITIES[finding.severity]
            >= (Severity.WARNING if finding.rule in rules or finding.rule.startswith("arc-") else Severity.ERROR)
        ]
        return found + [reason for row, reason in self.unpointed if self.trace.mode.whole_section[row] >= 0]


def read(path: str, data: bytes, settings: Settings) -> Original:
    """
    Read a program with its settings.

    Raises SourceError, TooHardError; RefusedError for a file with several channels, which wait for each other, and for
    one that runs otherwise with block skip or calls another file, since one result cannot be both; and where a section
    rests on a variable without a value, or a condition, a call or a return in the mode does, so that nobody knows which
    blocks run.
    """
    runs = check.read(data, settings.machine, settings.job, path, settings.encoding)
    if len({tables["text"].source.channel for _, tables in runs}) > 1:
        raise RefusedError([Refusal(0, "the file has several channels: divide it into one file for each")])
    if len(runs) > 1:
        raise RefusedError(
            [Refusal(0, "it runs otherwise with block skip than without: choose with --block-skip on or off")]
        )
    tables = runs[0][1]
    if parts := tables["text"].source.parts:
        reason = "it calls a program that stands in another file: put both into one file, the called one behind it"
        raise RefusedError([Refusal(0, f"{parts[0].name}: {reason}")])
    original = Original(path, data, settings, tables)
    if any(value.matters for value in unknown_values(tables)):
        raise RefusedError(original.unknown)
    machine, lines = settings.machine, tables["text"].blocks.line
    trace = original.trace
    # A main program that jumps back out of the mode begins anew: what runs is the same blocks again.
    is_left_on = len(trace) > 0 and bool(trace.mode.in_polar[-1])
    not_known = [
        remark
        for remark in trace.run.remarks
        if remark.kind in BLOCKS_NOT_KNOWN and (is_left_on or remark.kind != "return-jumps")
    ]
    if not_known:
        reasons = [Refusal(int(lines[remark.block]), reason_of(remark, trace.run, machine)) for remark in not_known]
        raise RefusedError(reasons)
    return original
