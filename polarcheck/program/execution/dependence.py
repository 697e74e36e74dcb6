"""Programs that call a changed file, directly or through others."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from polarcheck.foundation.record import recorded
from polarcheck.program.execution.called_programs import Shelf, names_of
from polarcheck.program.execution.programs import ProgramName, needs_flow, read_text
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.channel_texts import channels
from polarcheck.program.reading.source import Source


def calls_one_of(source: Source, machine: Machine, folders: Sequence[str], names: Collection[str]) -> bool:
    """
    Return True if a file calls one of some files that lie, or lay, in the folders of its job.

    names: of these files, without their folders. A call whose number is computed may be that of any of them.
    """
    if not names:
        return False
    control = machine.control
    texts = [read_text(channel, machine) for channel in channels(source, control.channel_mark, control.line_comments)]
    for text in texts:
        if not needs_flow(text, machine.macro.flow_codes):
            continue
        with recorded() as read:
            listing = Shelf(text, machine, folders).listing
        patterns = [names_of(ProgramName(look_up.number, look_up.name)) for look_up in read.look_ups]
        if any(pattern is not None and pattern.fullmatch(name) for pattern in patterns for name in names):
            return True
        if any(listing.computes_calls(file) for file in range(len(listing.files))):
            return True
    return False
