"""
Frames: coordinate systems of the program, shifted and turned against that of the lathe, and the way in them.

A frame takes a point of the program to that of the lathe: turn * point + shift. The machine does not move where a frame
changes: what is not programmed in the new one stays where it is (as on controls whose frames are a calculation alone).
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.filling import fill_down, positions
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.lengths import RADIUS_FACTOR, Lengths
from polarcheck.foundation.arrays import Floats, Mask, Points, cached_property, is_among, mask_at, side_by_side

#: G18 and G19.
_OTHER_PLANES = (18, 19)


class FrameWords(msgspec.Struct, frozen=True):
    """
    Frame words of each row.

    begins: a new frame. adds: changes the one in force. ends: the frame in force is none from here on. unknown: begins
    one that is not simulated, or changes the one in force so. angle [deg], shift [mm], z [mm]: of the words beside it,
    0 where there is none.
    """

    begins: Mask
    adds: Mask
    ends: Mask
    unknown: Mask
    angle: Floats
    shift: Points
    z: Floats


class Frames(msgspec.Struct, frozen=True, dict=True):
    """
    The frame in force in each row, after its own words.

    angle: by which it is turned [deg]. shift: of its origin on the polar plane [mm]. z: likewise along Z [mm]. NaN
    where it is not simulated.
    """

    angle: Floats
    shift: Points
    z: Floats

    @cached_property
    def turn(self) -> Points:
        """The angle as a factor of plane points."""
        return np.exp(1j * np.radians(self.angle))

    @cached_property
    def is_known(self) -> Mask:
        """The frame in force is simulated."""
        return ~np.isnan(self.angle + self.shift.real + self.shift.imag)


def find_frames(
    blocks: ExecutedBlocks, modal: ModalStates, axes: PlaneAxes, mode: PolarMode, lengths: Lengths
) -> Frames | None:
    """The frames of a program; None where it has none."""
    shifts = blocks.listed("frame_shift", "frame_shift_added")
    turns = blocks.listed("frame_rotation", "frame_rotation_added")
    lost = blocks.listed("frame_not_simulated")
    if not (shifts.any() or turns.any() or lost.any()):
        return None
    keys, polar = blocks.machine.frames, blocks.machine.polar
    ends = blocks.starts | ((axes.switches_on | axes.switches_off) & keys.ended_by_switch)
    written = blocks.has(keys.angle_word)
    # About X or Y nothing turns within the plane; and another plane than that of the mode is turned in none.
    lost = lost | (turns & ~written & (blocks.has("X") | axes.has_virtual_word))
    lost |= turns & mode.in_polar & is_among(modal.state("plane"), _OTHER_PLANES)
    angle = _or_nothing(np.where(written, blocks.word(keys.angle_word), blocks.word("Z")), written | blocks.has("Z"))
    virtual = axes.of_virtual_axis(lengths.length_of) * RADIUS_FACTOR[polar.virtual_axis_programming]
    shift = np.zeros(len(blocks), np.complex128)
    shift.real = _or_nothing(lengths.length_of("X") * lengths.x_factor, shifts & blocks.has("X"))
    shift.imag = _or_nothing(virtual, shifts & axes.has_virtual_word)
    return in_force(
        FrameWords(
            begins=blocks.listed("frame_shift", "frame_rotation"),
            adds=blocks.listed("frame_shift_added", "frame_rotation_added"),
            ends=ends,
            unknown=lost,
            angle=np.where(turns, angle, 0.0),
            shift=shift,
            z=_or_nothing(lengths.length_of("Z"), shifts & blocks.has("Z")),
        )
    )


def _or_nothing(value: Floats, written: Mask) -> Floats:
    """The value of a word, NaN where it is not known; 0 where none is written."""
    return np.where(written, value, 0.0)


def in_force(words: FrameWords) -> Frames:
    """The frames that the words of all rows make."""
    angle = _summed(words.angle, words)
    turned = np.exp(1j * np.radians(np.where(words.adds, angle - words.angle, 0.0))) * words.shift
    shift = np.empty(len(angle), np.complex128)
    shift.real, shift.imag = (_summed(part, words) for part in (turned.real, turned.imag))
    return Frames(angle, shift, _summed(words.z, words))


def _summed(value: Floats, words: FrameWords) -> Floats:
    """The sum of a new frame and of the frames added to it; NaN from a frame on that begins with an unknown value."""
    is_lost = words.unknown | (words.begins & np.isnan(value))
    set_by = np.where(words.begins & ~is_lost, value, np.nan)
    steps = np.where(words.adds & ~is_lost, value, 0.0)
    return positions(set_by, steps, words.ends | is_lost, np.where(is_lost, np.nan, 0.0))


def in_frame(
    frames: Frames | None, in_polar: Mask, absolute: Floats, steps: Floats, *, along_virtual: bool
) -> tuple[Floats, Floats]:
    """
    Coordinates (NaN where none) and increments of an axis as those of the lathe, but along the axes of the frame.

    Outside the mode X is not known in a frame that is turned: it then goes with Z, which is not used.
    """
    if frames is None:
        return absolute, steps
    shift = np.conj(frames.turn) * frames.shift
    is_followed = frames.is_known & (in_polar | (frames.angle == 0))
    moves = ~np.isnan(absolute) | (steps != 0)
    coordinate = np.where(is_followed, absolute + (shift.imag if along_virtual else shift.real), np.nan)
    return coordinate, np.where(moves & ~is_followed, np.nan, steps)


class AxisPath(msgspec.Struct, frozen=True):
    """
    Where an axis is programmed to go, in the coordinates of the lathe but along the axes of the frame.

    absolute, increment, resets, values: as filling.positions takes them.
    """

    absolute: Floats
    increment: Floats
    resets: Mask
    values: Floats

    def positions(self) -> Floats:
        """The axis after each row."""
        return positions(self.absolute, self.increment, self.resets, self.values)


def along(linear: AxisPath, virtual: AxisPath, turn: Points) -> Points:
    """
    Where both axes of the plane stand after each row [mm]; each part NaN while it is unknown.

    turn: of the frame of each row. Where it changes, both coordinates along the new axes hang on both along the old
    ones: this is done for one such row after the other, and for all rows between at once.
    """
    changes = np.flatnonzero(np.append(False, turn[1:] != turn[:-1])[: len(turn)])
    is_change = mask_at(len(turn), changes)
    x, hangs_x = _between(linear, is_change)
    y, hangs_y = _between(virtual, is_change)
    base = np.zeros(len(changes) + 1, np.complex128)
    factor = np.conj(turn[changes]) * turn[changes - 1]
    last = changes - 1
    columns = (x[last], y[last], hangs_x[last], hangs_y[last], factor)
    for number, (own_x, own_y, takes_x, takes_y, by) in enumerate(side_by_side(*columns)):
        before = base[number]
        own_x, own_y = own_x + before.real * takes_x, own_y + before.imag * takes_y
        base[number + 1] = complex(own_x, own_y) if by == 1 else by * complex(own_x, own_y)
    of_row = base[np.cumsum(is_change)]
    result = np.empty(len(turn), np.complex128)
    result.real = x + np.where(hangs_x, of_row.real, 0.0)
    result.imag = y + np.where(hangs_y, of_row.imag, 0.0)
    turned = turn != 1
    result[turned] *= turn[turned]
    return result


def _between(axis_path: AxisPath, is_change: Mask) -> tuple[Floats, Mask]:
    """An axis after each row as if it stood at 0 where the frame turned last; whether that is to be added."""
    programmed = ~np.isnan(axis_path.absolute)
    starts_anew = is_change & ~axis_path.resets
    position = positions(
        axis_path.absolute,
        axis_path.increment,
        axis_path.resets | starts_anew,
        np.where(starts_anew, 0.0, axis_path.values),
    )
    hangs = fill_down(starts_anew & ~programmed, starts_anew | programmed | axis_path.resets, False)
    return position, hangs.astype(bool)
