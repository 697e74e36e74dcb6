"""The tools that turn, where they stand, and the table of what they cut."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, Table, cached_property, mask_at
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ROUNDING

#: A facing move that ends within this radius of X0 leaves a whole face [mm]: the nose of the tool reaches over it.
CENTER = 1.5
#: How far a grooving insert reaches along Z to either side of its reference point, at most [mm].
INSERT = 8.0
#: The height up to which a cut of a face clears.
ABOVE_ALL = np.inf


class Cuts(Table, frozen=True):
    """
    Cuts of turning tools, n of them, in the order of the program.

    row: int[n]. low, high: float64[n], the range of Z [mm]; high is inf where all above is cut. x_low, x_high:
    float64[n], radius at its ends [mm]. bulge: float64[n], how far an arc may lie off the line between them [mm].
    is_surface: bool[n], outside of the radius nothing is left; else something may be: grooves, threads, roughing.
    is_bore: bool[n], cut from inside. is_face: bool[n], a whole face at `low`.
    """

    row: Rows
    low: Floats
    high: Floats
    x_low: Floats
    x_high: Floats
    bulge: Floats
    is_surface: Mask
    is_bore: Mask
    is_face: Mask

    @classmethod
    def none(cls) -> Cuts:
        no, never = np.zeros(0), np.zeros(0, bool)
        return cls(np.zeros(0, np.int64), no, no, no, no, no, never, never, never)


#: A shorter way along Z shows nothing of where the part lies, and turning begins no farther behind the face [mm].
_LONG, _BESIDE_FACE = 1.0, 0.5


class TurningTools(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace

    @cached_property
    def tool_call(self) -> Rows:
        """A number per T word: the same tool may turn first and mill then."""
        return np.cumsum(self.trace.blocks.has("T") | self.trace.blocks.starts)

    @cached_property
    def turns(self) -> Mask:
        """Rows of tool calls that neither use C nor drill nor enter the mode."""
        trace = self.trace
        rotary = trace.machine.polar.rotary_words
        uses_c = trace.blocks.has(*rotary) & trace.modal.uses_axes & trace.axes.moves
        uses_c |= trace.blocks.has("Y", "V") & trace.axes.moves
        excluded = uses_c | (trace.modal.drilling != 0) | (trace.mode.section >= 0) | trace.mode.on_cylinder
        call = self.tool_call
        has_other = mask_at(int(call.max(initial=0)) + 1, call[excluded])
        return np.asarray(~has_other[call] & trace.tools.has_called_tool & ~trace.modal.on_sub_spindle)

    @cached_property
    def x_and_z(self) -> tuple[Floats, Floats, Floats, Floats]:
        """
        X before and after each row, Z before and after each row.

        A cycle ends where it began (columns/path/cycle_ends.py).
        """
        path = self.trace.path
        return path.x_before, path.x, path.z_before, path.z

    @cached_property
    def _feeds(self) -> Mask:
        """Rows in which turning tools move X or Z at feed."""
        return np.asarray(self.turns & self.trace.axes.at_feed & self.trace.axes.moves)

    @cached_property
    def moving_rows(self) -> Rows:
        """Rows in which turning tools move X or Z at feed; only Z before them may be unknown, at the first approach."""
        x_before, x_after, _, z_after = self.x_and_z
        return np.flatnonzero(self._feeds & ~np.isnan(x_before + x_after + z_after))

    @property
    def is_lost(self) -> Mask:
        """Rows in which turning tools cut, and where is not known."""
        x_before, x_after, _, z_after = self.x_and_z
        return np.asarray(self._feeds & np.isnan(x_before + x_after + z_after))

    @property
    def turns_anything(self) -> bool:
        """A turning tool moves at feed."""
        return bool(self._feeds.any())

    @cached_property
    def first_drilled(self) -> int:
        """The first row that drills on X0, by a cycle or in Z at feed; the number of rows for none."""
        trace = self.trace
        on_center = np.abs(self.x_and_z[0]) <= CENTER
        down = trace.path.moves_z & (np.abs(trace.path.x) <= CENTER) & on_center
        down &= trace.path.z < trace.path.z_before - 1
        cycle = (trace.modal.drilling != 0) | trace.blocks.listed("repetitive_cycle")
        rows = np.flatnonzero((down | (cycle & on_center)) & (trace.mode.section < 0))
        return int(rows[0]) if len(rows) else len(trace)


def sense_of_turning(trace: Trace) -> str:
    """
    The way along Z into the part that turning shows: plus, minus, or empty where it shows none.

    All its ways along the part lead away from the face (Z0 where nothing is faced), and most of them lies behind it: a
    tool that cuts on its way out of the part begins far behind the face.
    """
    tools = TurningTools(trace)
    x_before, x, z_before, z = (column[tools.moving_rows] for column in tools.x_and_z)
    faces = z[(np.abs(z - z_before) <= ROUNDING) & (x <= CENTER) & (x < x_before)]
    is_along = (np.abs(x - x_before) <= ROUNDING) & (np.abs(z - z_before) > _LONG) & (x > CENTER)
    begins, ends = z_before[is_along], z[is_along]
    if not len(ends):
        return ""
    for name, sense in (("plus", 1), ("minus", -1)):
        face = float((faces * sense).min()) if len(faces) else 0.0
        first, last = begins * sense - face, ends * sense - face
        is_away = (last > first).all() and last.min() > _LONG
        if is_away and first.min() <= _BESIDE_FACE and last.max() > -first.min():
            return name
    return ""


def z_into_part(trace: Trace) -> str:
    """The way along Z into the part: plus, minus, or empty where turning and the machine contradict each other."""
    stated, z = trace.machine.control.z_into_part, trace.path.z
    outside = (trace.axes.motion == Motion.LINE) & (trace.mode.section < 0)
    may_rise = bool((outside & (z > trace.path.z_before + _LONG)).any()) or stated == "plus"
    shown = sense_of_turning(trace) if may_rise else ""
    return (stated or shown or "minus") if stated == shown or not (stated and shown) else ""


def upright(trace: Trace) -> Trace:
    """The trace for what looks at depths: Z rises away from the part in it, and is not known where that is open."""
    sense = z_into_part(trace)
    if sense == "minus":
        return trace
    from polarcheck.columns.path.upright import DepthlessPath, UprightPath, with_path

    return with_path(trace, UprightPath if sense else DepthlessPath)
