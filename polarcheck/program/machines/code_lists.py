"""The G codes of a control by what they do: lists that are data, some the same in all G-code systems, some not."""

from collections.abc import Iterable

import msgspec


class GCodes(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    G codes that are the same in G-code systems A, B and C; `G54-G59` is a range of whole numbers.

    Codes that end each other form a modal group; modal.STATES says which lists belong to which group.

    rapid: rapid traverse
    line: linear interpolation
    arc_clockwise: circular interpolation, clockwise
    arc_counterclockwise: circular interpolation, counterclockwise
    motion_not_followed: other codes of the group of motion, whose way is not simulated: involutes, splines, threads
    plane_xy: plane selection, XY
    plane_zx: plane selection, ZX
    plane_yz: plane selection, YZ
    compensation_off: cutter compensation cancel
    compensation_left: cutter compensation, tool to the left of the programmed path
    compensation_right: cutter compensation, tool to the right of the programmed path
    corner_by_arc: cutter compensation goes round outer corners by an arc of R
    corner_by_intersection: cutter compensation goes round outer corners by the point where both ways meet
    feed_inverse_time: F is the inverse of the time that the block takes
    feed_on_plane: F is along the way on the plane, whatever polar.feed_measures says
    feed_in_space: F is along the way of X, C and Z in space
    feed_as_machine: F is along what polar.feed_measures says
    feed_at_center: F is that of the tool center on arcs in cutter compensation, as without such codes
    feed_at_contour: F is that of the contour on arcs in cutter compensation
    feed_at_inner_contour: F is that of the contour on the inner side of arcs, that of the tool center elsewhere
    constant_surface_speed: S is a surface speed, so that the spindle turns faster near the center
    constant_surface_speed_off: S is a spindle speed
    constant_surface_speed_ended_by: codes of feed that end it, too, where all are one group
    work_offset: work coordinate systems; the first is in force where the program selects none
    work_offset_extended: further work coordinate systems, selected by P
    drilling_cycle: canned cycles for drilling, boring and tapping
    drilling_cycle_off: canned cycle cancel
    cycle_contour: begins the contour that a multiple repetitive cycle runs by its name; the blocks are no moves there
    cycle_contour_off: ends it
    scaling: scaling
    scaling_off: what ends it, in the order of the codes that begin it
    rotation: coordinate system rotation
    rotation_off: what ends it, in the order of the codes that begin it
    mirror_image: mirror image, that of two turrets included
    mirror_image_off: what ends it, in the order of the codes that begin it
    frame_shift: begins a frame that the axis words beside it shift; without any it is none
    frame_shift_added: shifts the frame in force further, along its own axes
    frame_rotation: begins a frame that the angle beside it turns; without any it is none
    frame_rotation_added: turns the frame in force further
    frame_not_simulated: frames whose way is not simulated: scaling, mirror image
    tool_length_offset: tool length offset; H beside it is an offset number
    tool_length_offset_off: tool length offset cancel
    dwell: dwell; which words beside it are a time is feed.dwell_words
    data_input: data input by the program, of what L says
    data_input_work_offset: numbers of L by which data input sets work offsets
    data_input_tool_offset: numbers of L by which data input sets tool offsets
    reference_check: reference position return check
    reference_return: return to the reference position; the axes named with it are there afterwards
    sub_spindle: behind them the program is for the sub-spindle
    sub_spindle_off: behind them it is for the main spindle again
    c_axis_reference: codes that, with C or H, take the C axis to its reference point, the zero of its angle
    local_shift: local coordinate system
    machine_coordinates: move in machine coordinates
    cylindrical_interpolation: cylindrical interpolation, which is not simulated; its word 0, or none, ends it
    axis_words_no_move: further codes beside which axis words are no end point of a move
    """

    rapid: list[str]
    line: list[str]
    arc_clockwise: list[str]
    arc_counterclockwise: list[str]
    motion_not_followed: list[str]
    plane_xy: list[str]
    plane_zx: list[str]
    plane_yz: list[str]
    compensation_off: list[str]
    compensation_left: list[str]
    compensation_right: list[str]
    corner_by_arc: list[str]
    corner_by_intersection: list[str]
    feed_inverse_time: list[str]
    feed_on_plane: list[str]
    feed_in_space: list[str]
    feed_as_machine: list[str]
    feed_at_center: list[str]
    feed_at_contour: list[str]
    feed_at_inner_contour: list[str]
    constant_surface_speed: list[str]
    constant_surface_speed_off: list[str]
    constant_surface_speed_ended_by: list[str]
    work_offset: list[str]
    work_offset_extended: list[str]
    drilling_cycle: list[str]
    drilling_cycle_off: list[str]
    cycle_contour: list[str]
    cycle_contour_off: list[str]
    scaling: list[str]
    scaling_off: list[str]
    rotation: list[str]
    rotation_off: list[str]
    mirror_image: list[str]
    mirror_image_off: list[str]
    frame_shift: list[str]
    frame_shift_added: list[str]
    frame_rotation: list[str]
    frame_rotation_added: list[str]
    frame_not_simulated: list[str]
    tool_length_offset: list[str]
    tool_length_offset_off: list[str]
    dwell: list[str]
    data_input: list[str]
    data_input_work_offset: list[int]
    data_input_tool_offset: list[int]
    reference_check: list[str]
    reference_return: list[str]
    sub_spindle: list[str]
    sub_spindle_off: list[str]
    c_axis_reference: list[str]
    local_shift: list[str]
    machine_coordinates: list[str]
    cylindrical_interpolation: list[str]
    axis_words_no_move: list[str]


#: Lists of GCodes that may hold words of a control's own language.
FRAME_LISTS = ("frame_shift", "frame_shift_added", "frame_rotation", "frame_rotation_added", "frame_not_simulated")


class GCodeSystem(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    G codes that differ between G-code systems A, B and C; the table of the system in force counts.

    inch: inch input
    mm: metric input
    feed_per_minute: F is per minute
    feed_per_revolution: F is per revolution of the spindle
    absolute: axis words are coordinates; in system A all are, but U, V, W and H
    incremental: axis words are distances
    thread_cutting: thread cutting, one pass
    turning_cycle: turning cycle along the outer or inner diameter
    threading_cycle: thread cutting cycle
    facing_cycle: facing cycle
    repetitive_cycle: multiple repetitive cycles: roughing, finishing, grooving, threading
    coordinate_setting: sets the coordinates of the present position or, with S alone, the highest spindle speed
    coordinate_preset: takes back what local coordinate system and coordinate setting have moved
    feed_is_lead: cycles whose F is the lead of a thread and no feed for later blocks
    """

    inch: list[str]
    mm: list[str]
    feed_per_minute: list[str]
    feed_per_revolution: list[str]
    absolute: list[str]
    incremental: list[str]
    thread_cutting: list[str]
    turning_cycle: list[str]
    threading_cycle: list[str]
    facing_cycle: list[str]
    repetitive_cycle: list[str]
    coordinate_setting: list[str]
    coordinate_preset: list[str]
    feed_is_lead: list[str]


def is_code(text: str, letters: str = "G") -> bool:
    """`G12.1`, or `G54-G59`."""
    first, dash, last = text.partition("-")
    if not dash:
        return _is_one(first, letters)
    return all(_is_one(end, letters) for end in (first, last)) and "." not in text and int(first[1:]) <= int(last[1:])


def _is_one(text: str, letters: str) -> bool:
    whole, point, tenths = text[1:].partition(".")
    is_number = whole.isdecimal() and len(whole) < 4 and (not point or (len(tenths) == 1 and tenths.isdecimal()))
    return text.isascii() and text[:1] in letters and is_number


def numbers(words: Iterable[str]) -> list[int]:
    """Codes and ranges of codes as the whole numbers that columns hold: ten times their values."""
    numbered: list[int] = []
    for word in words:
        first, _, last = word.partition("-")
        start = round(float(first[1:]) * 10)
        numbered += range(start, round(float(last[1:]) * 10) + 1, 10) if last else (start,)
    return numbered


def expanded(words: Iterable[str]) -> list[str]:
    """The codes one by one, those of a range too."""
    results: list[str] = []
    for word in words:
        results += [f"{word[0]}{number // 10}" for number in numbers([word])] if "-" in word else [word]
    return results
