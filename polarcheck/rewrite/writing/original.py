"""The program that is rewritten."""

from __future__ import annotations

import msgspec

from polarcheck.checking import check
from polarcheck.checking.not_evaluated import unknown_values
from polarcheck.checking.settings import Settings
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.macro_faults import reason_of
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError
from polarcheck.rules.tables import Tables

#: Remarks of blocks behind which nobody knows what runs.
BLOCKS_NOT_KNOWN = ("condition-unknown", "program-unknown", "return-jumps")


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
