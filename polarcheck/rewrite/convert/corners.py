"""The way round outer corners in cutter compensation, where both machines take it otherwise unless a code says it."""

from __future__ import annotations

from polarcheck.columns.trace import Trace
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.writing.blocks import NewBlock


class Corners:
    """
    The codes that a section needs so that the other machine goes round its outer corners as the source does.

    A control that goes round by lines, as FANUC's, meets one that goes round by arcs (G450 on Siemens) on the
    intersection of the parallels (G451), as long as the contour turns by no more than a right angle.
    """

    def __init__(self, trace: Trace, target: Machine) -> None:
        self.trace, self.target = trace, target
        by_lines = trace.machine.compensation.corner != "arc"
        codes = target.codes("corner_by_intersection"), target.codes("corner_by_arc")
        self._codes = codes if by_lines and target.compensation.corner == "arc" and all(codes) else ([], [])

    def before(self, row: int) -> NewBlock:
        """The block behind the switch of a section; without words where it needs none. row: of the switch."""
        return self._block(row, 0)

    def behind(self, row: int) -> NewBlock:
        """The block behind the section, which takes that back. row: of the switch that ends it."""
        return self._block(row, 1)

    def _block(self, row: int, which: int) -> NewBlock:
        mode = self.trace.mode
        in_section = mode.whole_section == mode.whole_section[row]
        is_compensated = bool((self.trace.compensation.compensates & in_section).any())
        return NewBlock(tuple(self._codes[which][:1]) if is_compensated else ())
