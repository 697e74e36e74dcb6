"""What stands in the polar mode and at its ends, and what the words mean there."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.machines.codes import NO_CODE, code, code_set
from polarcheck.machines.modal import COORDINATE_SETTING, Motion
from polarcheck.reading.words import NumberFault
from polarcheck.table.trace import Trace

_AXES = ("X", "Y", "Z", "C", "U", "V", "W", "H")
_PLANES = ("G17", "G18", "G19")
_LENGTH_OFFSETS = ("G43", "G44", "G49")
_SHIFTS = ("G52", "G53", "G54-G59", "G54.1")
#: Blocks with these can only stand outside; what G0 means beside them is no question of its own.
_OUTSIDE = ("G27", "G28", "G30", "G53")
#: G10 L.: work offsets; tool offsets (B-63524EN/01, programmable data input).
_WORK_OFFSETS = (2, 20)
_TOOL_OFFSETS = (10, 11, 12, 13)

#: Codes of systems B and C that system A does not have, or has for something else.
_IN_SYSTEM_A = ("G90", "G91", "G94", "G95")

_ANGLES = np.array([30, 45, 60, 90, 120, 135, 150, 180, 210, 225, 240, 270, 300, 315, 330, 360], np.float64)
#: An angle read as a length lies this many times farther out than the rest of the section.
_FAR = 2.0


class Modes:
    """Columns of one trace, one value per row."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    # ---- codes in the mode ----

    @cached_property
    def _allowed(self) -> Mask:
        """Over code numbers: whether the profile allows the G code in the mode."""
        return code_set(self.trace.machine.polar.allowed_codes)

    def _words_with(self, table: Mask) -> Mask:
        """Per G word: in the mode, of a code in the table, and not allowed there."""
        trace = self.trace
        codes = trace.g_codes
        return np.asarray(trace.in_polar[trace.run.row[trace.g_words]] & table[codes] & ~self._allowed[codes])

    def _rows_of(self, words: Mask) -> Mask:
        rows = np.zeros(len(self.trace), bool)
        rows[self.trace.run.row[self.trace.g_words[words]]] = True
        return rows

    def _with(self, *codes: str) -> Mask:
        """Rows in the mode with one of these codes, where the profile does not allow it."""
        return self._rows_of(self._words_with(code_set(codes)))

    @cached_property
    def selects_plane(self) -> Mask:
        """G17, G18, G19 in the mode."""
        return self._with(*_PLANES)

    @cached_property
    def sets_length_offset(self) -> Mask:
        """G43, G44, G49 in the mode."""
        return self._with(*_LENGTH_OFFSETS)

    @cached_property
    def rapid(self) -> Mask:
        """G0 in the mode, and the first move in each section that takes G0 from before."""
        trace = self.trace
        modal = trace.in_polar & (trace.state("motion") == Motion.RAPID) & ~trace.codes(*_OUTSIDE)
        first = trace.first_in_section(modal & (trace.motion == Motion.RAPID))
        return np.asarray(modal & (trace.codes("G0") | first))

    @cached_property
    def _setting(self) -> str:
        return COORDINATE_SETTING[self.trace.machine.control.g_code_system]

    @cached_property
    def data_input(self) -> tuple[Mask, Mask]:
        """G10 in the mode that changes a work offset, and one that changes a tool offset."""
        trace = self.trace
        writes = self._with("G10")
        kind, number = trace.word("L"), trace.word("P")
        plain = np.isnan(kind)
        # Without L a lathe takes P0 as the work shift, other numbers as tool offsets.
        work = writes & (np.isin(kind, _WORK_OFFSETS) | (plain & (number == 0)))
        tool = writes & (np.isin(kind, _TOOL_OFFSETS) | (plain & (number > 0)))
        return work, tool

    @cached_property
    def shifts_origin(self) -> Mask:
        """Another origin in the mode: G50 (G92) with axis words, G52, G53, G54 to G59, a work offset by G10."""
        return (self._with(self._setting) & self.trace.has(*_AXES)) | self._with(*_SHIFTS) | self.data_input[0]

    @cached_property
    def _not_allowed(self) -> Mask:
        """Per G word: not allowed in the mode, and no rule of its own for it."""
        trace = self.trace
        polar = trace.machine.polar
        told = code_set([*polar.on, *polar.off, "G0", *_PLANES, *_LENGTH_OFFSETS, *_SHIFTS])
        told[NO_CODE] = True
        if trace.machine.control.unknown_codes_are_errors:
            told |= ~code_set(trace.machine.control.known_codes)
        row = trace.run.row[trace.g_words]
        told_here = (trace.g_codes == code(self._setting)) & self.shifts_origin[row]
        work, tool = self.data_input
        told_here |= (trace.g_codes == code("G10")) & (work | tool)[row]
        return np.asarray(self._words_with(~told) & ~told_here)

    @cached_property
    def words_not_allowed(self) -> Mask:
        """Per executed word: a G code that cannot be used in the mode, and no rule of its own for it."""
        return self.trace.words_at(self.trace.g_words[self._not_allowed])

    @cached_property
    def not_allowed(self) -> Mask:
        """A G code that cannot be used in the mode, and no rule of its own for it."""
        return self._rows_of(self._not_allowed & (self.trace.g_codes != code(self._setting)))

    @cached_property
    def limits_speed(self) -> Mask:
        """G50 (G92) with nothing but S in the mode."""
        return self._rows_of(self._not_allowed) & ~self.not_allowed

    # ---- words of another G-code system ----

    @cached_property
    def is_of_other_system(self) -> Mask:
        """Rows in the mode with a word that this G-code system does not have, or has for something else."""
        trace = self.trace
        if trace.machine.control.g_code_system == "A":
            return trace.in_polar & trace.codes(*_IN_SYSTEM_A)
        return trace.in_polar & trace.uses_axes & trace.has(*self._increments)

    @cached_property
    def words_of_other_system(self) -> Mask:
        """Per executed word: one that this G-code system has for something else; the first kind of each row."""
        trace = self.trace
        if trace.machine.control.g_code_system == "A":
            kinds = [trace.words_at(trace.g_words[trace.g_codes == code(name)]) for name in _IN_SYSTEM_A]
        else:
            kinds = [trace.words_at(trace.word_indices(name)) for name in self._increments]
        chosen, told = np.zeros(len(trace.run.words), bool), np.zeros(len(trace), bool)
        for kind in kinds:
            new = kind & ~told[trace.run.row]
            chosen |= new
            told[trace.run.row[new]] = True
        return chosen

    @cached_property
    def _increments(self) -> tuple[str, ...]:
        polar = self.trace.machine.polar
        return tuple(a for a in ("U", "W", polar.virtual_axis_increment) if a not in polar.other_virtual_axis)

    # ---- entry and exit ----

    @cached_property
    def words_beside_switch(self) -> Mask:
        """Per word: shares the block of a G12.1 or of the G13.1 that ends a section, and is not allowed there."""
        trace = self.trace
        polar, words = trace.machine.polar, trace.run.words
        switching = trace.enters | trace.enters_again | trace.leaves
        free = [ord(name) for name in ("N", "O", "/", *polar.switch_words) if len(name) == 1]
        at = np.flatnonzero(switching[trace.run.row])
        beside = np.zeros(len(words), bool)
        beside[at] = ~np.isin(words.address[at], free) & (words.fault[at] == NumberFault.NONE)
        names = [*polar.on, *polar.off, *(name for name in polar.switch_words if len(name) > 1)]
        for letter, indices, numbers in (("G", trace.g_words, trace.g_codes), ("M", trace.m_words, trace.m_codes)):
            beside[indices] &= ~code_set(name for name in names if name[0] == letter)[numbers]
        return beside

    @cached_property
    def switch_not_alone(self) -> Mask:
        """G12.1 or G13.1 shares its block."""
        rows = np.zeros(len(self.trace), bool)
        rows[self.trace.run.row[self.words_beside_switch]] = True
        return rows

    @cached_property
    def plane_wrong_at_entry(self) -> Mask:
        """G12.1 while the program has selected a plane that the profile does not want."""
        trace = self.trace
        wanted = [round(float(name[1:])) for name in trace.machine.polar.plane_before]
        plane = trace.state("plane")
        return np.asarray(trace.enters & bool(wanted) & (plane != 0) & ~np.isin(plane, wanted))

    @cached_property
    def state_wrong_at_entry(self) -> Mask:
        """G12.1 while a drilling cycle, scaling, rotation or mirror image is in force."""
        trace = self.trace
        wrong = trace.drilling != 0
        for group in ("scaling", "rotation", "mirror"):
            wrong = wrong | (trace.state(group) != 0)
        return np.asarray(trace.enters & wrong)

    @cached_property
    def constant_speed_at_entry(self) -> Mask:
        """G12.1 while G96 is in force."""
        return np.asarray(self.trace.enters & (self.trace.state("speed") == 96))

    # ---- the virtual axis ----

    @cached_property
    def other_axis(self) -> Mask:
        """Rows in the mode with the address of the virtual axis of other controls."""
        trace = self.trace
        return trace.in_polar & trace.uses_axes & trace.has(*trace.machine.polar.other_virtual_axis)

    @cached_property
    def other_axis_words(self) -> Mask:
        """Per executed word: of the address of the virtual axis of other controls."""
        trace = self.trace
        return trace.words_at(trace.word_indices(*trace.machine.polar.other_virtual_axis))

    @cached_property
    def virtual_words(self) -> Mask:
        """Per executed word: of the virtual axis."""
        return self.trace.words_at(self.trace.word_indices(self.trace.machine.polar.virtual_axis))

    @cached_property
    def _reach(self) -> Floats:
        """Per section: how far X, and C where it is no likely angle, lie from the center [mm]."""
        trace = self.trace
        c = np.where(_is_angle(np.abs(self._virtual_value)), np.nan, self._virtual_length)
        reach = np.zeros(len(trace.sections))
        for column in (np.abs(trace.x), np.abs(c)):
            known = (trace.section >= 0) & np.isfinite(column)
            np.maximum.at(reach, trace.section[known], column[known])
        return reach

    @cached_property
    def _virtual_value(self) -> Floats:
        """Value of the virtual axis as written in the mode, else NaN."""
        trace = self.trace
        return np.where(trace.in_polar & trace.uses_axes, trace.word(trace.machine.polar.virtual_axis), np.nan)

    @cached_property
    def _virtual_length(self) -> Floats:
        return self.trace.length_of(self.trace.machine.polar.virtual_axis)

    @cached_property
    def looks_like_angle(self) -> Mask:
        """
        A length on the virtual axis that can only be meant as an angle: 30, 45, 60, 90, 180 ..., far outside all else.

        Not where the same length is there with both signs, as on a symmetrical contour, and not in a drilling cycle
        that the mode does not allow, since C is an angle once the cycle stands outside.
        """
        trace = self.trace
        size = np.abs(self._virtual_value)
        is_angle = _is_angle(size)
        rows = np.flatnonzero(is_angle)
        if not len(rows):
            return is_angle
        value, section = self._virtual_value[rows], trace.section[rows]
        which = np.asarray(np.searchsorted(_ANGLES, np.abs(value)))
        signs = np.zeros((2, len(trace.sections), len(_ANGLES)), bool)
        signs[(value < 0).astype(int), section, which] = True
        symmetrical = (signs[0] & signs[1])[section, which]
        length, reach = np.abs(self._virtual_length[rows]), self._reach[section]
        stock = trace.job.stock.diameter / 2 * np.broadcast_to(trace.job_scale, len(trace))[rows]
        cycle = trace.drilling[rows]
        misplaced = (cycle != 0) & ~self._allowed[cycle * 10]
        far = (reach > 0) & (length > _FAR * reach) & ~(length <= stock)
        is_angle[rows] = far & ~symmetrical & ~misplaced
        return is_angle

    @cached_property
    def reach(self) -> Floats:
        """How far the rest of the section lies from the center [mm]."""
        return np.append(self._reach, np.nan)[self.trace.section]

    @cached_property
    def virtual_length(self) -> Floats:
        """The virtual axis as a length without its sign [mm]."""
        return np.abs(self._virtual_length)

    @cached_property
    def interpolates_z(self) -> Mask:
        """Lines in the mode that move Z and X or C at once."""
        trace = self.trace
        moving = trace.in_polar & trace.moves_plane & trace.moves_z & (trace.motion == Motion.LINE)
        return np.asarray(moving & (trace.length > 0))


def _is_angle(size: Floats) -> Mask:
    """Whether a number is one of the angles; NumPy's isin would load its masked arrays for doubles."""
    return np.asarray(_ANGLES[np.searchsorted(_ANGLES, size) % len(_ANGLES)] == size)
