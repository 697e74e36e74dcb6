"""Programs that call a changed file, directly or through others."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from polarcheck.execution.library import Shelf, names_of
from polarcheck.execution.programs import needs_flow, read_text
from polarcheck.machines.machine import Machine
from polarcheck.reading.channels import channels
from polarcheck.reading.source import Source


def calls_one_of(source: Source, machine: Machine, folders: Sequence[str], names: Iterable[str]) -> bool:
    """
    Whether a file calls one of some files that lie, or lay, in the folders of its job; names: without their folders.

    A call whose number is computed may be that of any of them.
    """
    changed = list(names)
    if not changed:
        return False
    control = machine.control
    texts = [read_text(one, machine) for one in channels(source, control.channel_mark, control.line_comments)]
    for text in texts:
        if not needs_flow(text, machine.macro.flow_codes):
            continue
        listing = Shelf(text, machine, folders).listing
        for file in range(len(listing.files)):
            wanted = [names_of(called) for called in listing.calls(file)]
            if any(one is not None and one.fullmatch(name) for one in wanted for name in changed):
                return True
            if listing.computes_calls(file):
                return True
    return False
