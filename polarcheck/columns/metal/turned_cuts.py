"""
What turning tools cut, as ranges of Z with the radius that they leave: moves at feed, and the blocks of cycles.

The nose of the tool and the width of the insert are not known: a cut says up to which radius metal may be gone, and,
where it follows the surface, beyond which radius none is left.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.filling import happened
from polarcheck.columns.metal.turning_tools import ABOVE_ALL, CENTER, INSERT, Cuts, TurningTools
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, is_among, mask_at
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ROUNDING

if TYPE_CHECKING:
    from polarcheck.columns.metal.turned_cycles import TurnedCycles


class TurnedCuts(Columns, frozen=True):
    """Columns of one trace, one value per row, and its cuts."""

    trace: Trace
    tools: TurningTools

    @cached_property
    def _cycles(self) -> TurnedCycles:
        from polarcheck.columns.metal.turned_cycles import TurnedCycles  # imported late: most programs do not turn

        return TurnedCycles(self.trace, self.tools)

    @cached_property
    def unknown_rows(self) -> Rows:
        """Rows in which turning tools go to an unknown place, or of unknown effect: what they cut is not known."""
        trace = self.trace
        if not self.tools.turns.any():
            return np.flatnonzero(self.tools.is_lost)
        lost = (trace.blocks.has("X", "U") & np.isnan(trace.path.x)) | (
            trace.blocks.has("Z", "W") & np.isnan(trace.path.z)
        )
        lost &= trace.axes.moves & ~trace.modal.in_cycle & ~trace.blocks.listed("reference_return", "repetitive_cycle")
        lost |= self._cycles.is_lost | trace.run.unknown
        return np.flatnonzero((self.tools.turns & lost) | self.tools.is_lost)

    @cached_property
    def cuts(self) -> Cuts:
        """All cuts, in the order of the program."""
        if not self.tools.turns.any():
            return Cuts.none()
        cuts = Cuts.concatenated([self._of_moves, self._cycles.cuts, self._cycles.repetitive_cuts])
        return cuts[np.argsort(cuts.row, kind="stable")]

    # ---- moves ----

    @property
    def _of_moves(self) -> Cuts:
        rows = self.tools.moving_rows
        x_from, x_to, z_from, z_to = (column[rows] for column in self.tools.x_and_z)
        inside = self._is_inside[self.tools.tool_call[rows]]
        comes_from_above = np.isnan(z_from)
        z_from = np.where(comes_from_above, z_to + 1.0, z_from)
        level = np.abs(z_to - z_from) <= ROUNDING
        inward, outward = level & (x_to < x_from - ROUNDING), level & (x_to > x_from + ROUNDING)
        face = inward & (np.abs(x_to) <= CENTER) & (x_from > x_to + CENTER) & ~inside
        groove = inward & ~face & ~inside & self._backs_out(rows)
        shoulder = inward & ~face & ~inside & ~groove
        # A shoulder that is left outward says nothing: what it runs along is the end of another cut.
        chosen = ~outward | inside
        chosen &= ~level | inward | inside
        chosen &= inside | face | ((x_from > 0) & (x_to > 0))
        falls = z_to <= z_from
        return Cuts(
            row=rows,
            low=np.where(groove, z_to - INSERT, np.minimum(z_from, z_to)),
            high=np.where(
                face | shoulder | comes_from_above, ABOVE_ALL, np.where(groove, z_to + INSERT, np.maximum(z_from, z_to))
            ),
            x_low=np.where(face, 0.0, np.where(inward, x_to, np.where(falls, x_to, x_from))),
            x_high=np.where(face, 0.0, np.where(inward, x_to, np.where(falls, x_from, x_to))),
            bulge=self._bulge(rows),
            is_surface=~groove & ~self._is_roughing[rows],
            is_bore=inside,
            is_face=face,
        )[chosen]

    def _backs_out(self, rows: Rows) -> Mask:
        """The next move of the tool leads away from the center at the same Z: it has cut a groove."""
        x_before, x_after, z_before, z_after = self.tools.x_and_z
        moves = np.flatnonzero(
            self.tools.turns & ((np.abs(x_after - x_before) > ROUNDING) | (np.abs(z_after - z_before) > ROUNDING))
        )
        index = np.searchsorted(moves, rows, side="right")
        following = np.append(moves, -1)[index]
        same = (following >= 0) & (self.tools.tool_call[following] == self.tools.tool_call[rows])
        level = np.abs(z_after[following] - z_before[following]) <= ROUNDING
        return np.asarray(same & level & (x_after[following] > x_before[following]))

    def _bulge(self, rows: Rows) -> Floats:
        """How far arcs may lie off their chord [mm]; as long as the chord where the radius is not known."""
        trace = self.trace
        x_from, x_to, z_from, z_to = (column[rows] for column in self.tools.x_and_z)
        chord = np.nan_to_num(np.hypot(x_to - x_from, z_to - z_from))
        lengths = trace.lengths
        radius = np.abs(lengths.length_of(trace.machine.arcs.radius_word)[rows])
        center = np.hypot(*(np.nan_to_num(lengths.length_of(word)[rows]) for word in ("I", "K")))
        radius = np.where(np.isnan(radius) & (center > 0), center, radius)
        with np.errstate(invalid="ignore"):
            sagitta = radius - np.sqrt(np.maximum(radius**2 - chord**2 / 4, 0))
        is_arc = is_among(trace.axes.motion[rows], (Motion.CW, Motion.CCW))
        return np.where(is_arc, np.where(np.isnan(sagitta), chord, sagitta), 0.0)

    @cached_property
    def _is_roughing(self) -> Mask:
        """Rows of a contour that a cycle only roughs: its finishing cycle, with the same P and Q, is missing."""
        trace, none = self.trace, np.zeros(len(self.trace), bool)
        cycle = trace.blocks.listed("repetitive_cycle") & trace.blocks.has("P") & trace.blocks.has("Q")
        rows = np.flatnonzero(cycle & self.tools.turns)
        if not len(rows):
            return none
        p, q = (trace.blocks.word(word)[rows] for word in ("P", "Q"))
        pairs = np.stack([p, q], axis=1)
        alone = (pairs[:, None, :] == pairs[None, :, :]).all(axis=2).sum(axis=1) == 1
        mask = none.copy()
        mask[rows[alone]] = True
        return happened(mask, np.diff(self.tools.tool_call, prepend=-1) != 0)

    # ---- inside ----

    @cached_property
    def _is_inside(self) -> Mask:
        """
        Per tool call: it turns inside. Its last move of X at depth leads towards the center, behind a cut along Z, or
        its cycle cuts outward.

        A tool that turns outside leaves the metal away from the center.
        """
        call, rows = self.tools.tool_call, self.tools.moving_rows
        bored = self._cycles.cuts
        inside = mask_at(int(call.max(initial=0)) + 1, call[bored.row[bored.is_bore]])
        if not len(rows):
            return inside
        x_before, x_after, z_before, z_after = self.tools.x_and_z
        depth = min(-ROUNDING, float(np.fmax.reduce(z_before[rows])) - 1)
        moves = (np.abs(x_after - x_before) > ROUNDING) | (np.abs(z_after - z_before) > ROUNDING)
        moving = np.flatnonzero(self.tools.turns & self.trace.axes.moves & moves)
        along = self.trace.blocks.mask_of(rows[z_after[rows] < z_before[rows] - ROUNDING])
        follows_cut = np.append(False, along[moving[:-1]])[: len(moving)]
        moves_x = (np.abs(x_after - x_before)[moving] > ROUNDING) & (z_before[moving] < depth)
        moving, follows_cut = moving[moves_x], follows_cut[moves_x]
        is_last = np.append(np.diff(call[moving]) != 0, True)[: len(moving)]
        towards = (x_after[moving] < x_before[moving]) & (x_after[moving] > CENTER)
        inside[call[moving[is_last & towards & follows_cut]]] = True
        return inside
