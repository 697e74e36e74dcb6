"""The path of a program beside its golden trace, or beside the path of another program."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import msgspec
import numpy as np

from polarcheck.foundation.errors import TooHardError, counted
from polarcheck.geometry.comparison.path_deviation import PathDeviation, path_deviation
from polarcheck.rewrite.certify.golden import GoldenTrace, changed_orders
from polarcheck.rewrite.certify.tool_path import ToolPath, tool_path
from polarcheck.rewrite.compare.differences import common_pieces, feed_differs
from polarcheck.rewrite.compare.terms import EXACT


class Comparison(NamedTuple):
    """
    A path compared with another one.

    deviation: the largest [mm]; None where they cannot be laid beside each other.
    reasons: why they are not the same, each in one line. remarks: what was not compared.
    """

    deviation: float | None
    reasons: list[str]
    remarks: list[str]


def with_golden(
    our_trace: GoldenTrace, golden_trace: GoldenTrace, sense: int, tolerance: float, title: str
) -> Comparison:
    """
    Compare a path with its golden trace: points and Z within the tolerance, C at the beginning of each section, F; and
    the orders beside the moves.

    sense: 1 where C of the machine grows with the angle on the plane, -1 where it falls. tolerance: [mm]. title: of the
    golden trace, for the reasons.
    """
    ours, golden = tool_path(our_trace.moves, sense), tool_path(golden_trace.moves, sense)

    def turned_by(number: int, mine: ToolPath, theirs: ToolPath) -> tuple[float, str]:
        angles = {"here": float(mine.turned[number]), "there": float(theirs.turned[number])}
        alone = [place for place, angle in angles.items() if not np.isnan(angle)]
        if len(alone) == 1:
            return 0.0, f"C at its beginning is known {alone[0]} alone, as {angles[alone[0]]:.3f} deg"
        apart = _wrapped(angles["here"] - angles["there"])
        is_turned = abs(np.radians(apart)) * mine.farthest > tolerance
        return 0.0, f"it is turned by {apart:.3f} deg against {title}" if is_turned else ""

    if golden_trace.is_old:
        ours, golden = (path[~path.is_still] for path in (ours, golden))
    comparison = _compared(ours, golden, tolerance, title, turned_by)
    if not comparison.reasons and comparison.deviation is not None:
        comparison.reasons.extend(_feed_changes(ours, golden, tolerance, title))
    if golden_trace.is_old:
        comparison.reasons.append(f"{title} is of an earlier version, without what stands outside: certify --update")
    elif comparison.deviation is not None or not comparison.reasons:
        comparison.reasons.extend(changed_orders(our_trace, golden_trace, tolerance, title))
    return comparison


def with_other(ours: ToolPath, reference: ToolPath, tolerance: float, title: str) -> Comparison:
    """
    Compare a path with that of another program: points and Z within the tolerance, up to one turn of the whole part.

    tolerance: [mm]. title: of the other case, for the reasons.
    """
    turns: list[float] = []
    remarks: list[str] = []

    def turned_by(number: int, mine: ToolPath, theirs: ToolPath) -> tuple[float, str]:
        apart = ours.turned - reference.turned
        if not turns or np.isnan(apart[[0, number]]).any():
            if turns:
                remarks.append(f"section {number + 1}: its angle is not compared, C at its beginning is not known")
            best = min(
                _turns(mine, theirs, number),
                key=lambda turn: (round(_deviation(mine, theirs, turn, tolerance), 9), abs(turn)),
            )
            turns.append(best)
            return best, ""
        turn = _wrapped(turns[0] - float(apart[number] - apart[0]))
        off = _wrapped(turn - turns[0])
        agrees = abs(np.radians(off)) * mine.farthest <= tolerance
        if not agrees and _deviation(mine, theirs, turns[0], tolerance) <= tolerance:
            return turns[0], f"it is turned by {-off:.3f} deg against {title}"
        return turn, ""

    comparison = _compared(ours, reference, tolerance, title, turned_by)
    return comparison._replace(remarks=comparison.remarks + remarks)


def _compared(
    ours: ToolPath,
    reference: ToolPath,
    tolerance: float,
    title: str,
    turned_by: Callable[[int, ToolPath, ToolPath], tuple[float, str]],
) -> Comparison:
    """
    Compare two paths section by section.

    turned_by: returns the angle by which a section of the other path lies turned [deg], and why it does not agree.
    """
    count, expected = len(ours.turned), len(reference.turned)
    if count != expected:
        return Comparison(
            None,
            [f"the path has {counted(count, 'polar section')}, {title} has {counted(expected, 'polar section')}"],
            [],
        )
    if ours.is_programmed.any() != reference.is_programmed.any():
        which = "this program" if ours.is_programmed.any() else title
        return Comparison(None, [f"R of a cutter is not known in {which}: its path is the programmed one"], [])
    largest, reasons, remarks = 0.0, list[str](), list[str]()
    for number in range(count):
        mine, theirs = ours.of_section(number), reference.of_section(number)
        section = f"section {number + 1}"
        if np.isnan(mine.z_end).all() and np.isnan(theirs.z_end).all():
            remarks.append(f"{section}: Z is not compared, it is not known")
            mine, theirs = _without_z(mine), _without_z(theirs)
        is_known = [path.is_known for path in (mine, theirs)]
        unknown = [int(np.count_nonzero(~of_path)) for of_path in is_known]
        if unknown[0] != unknown[1]:
            which = "this program" if unknown[0] > unknown[1] else title
            return Comparison(None, [*reasons, f"{section}: a position is not known in {which}"], remarks)
        if unknown[0]:
            remarks.append(f"{section}: {counted(unknown[0], 'move')} not compared, a position is not known")
            mine, theirs = mine[is_known[0]], theirs[is_known[1]]
            if not len(mine) or not len(theirs):
                continue
        turn, why = turned_by(number, mine, theirs)
        try:
            deviation = path_deviation(theirs.by_degrees(turn), mine, tolerance)
        except TooHardError as error:
            return Comparison(None, [*reasons, f"{section}: not compared with {title}: {error}"], remarks)
        largest = max(largest, deviation.largest)
        if why:
            reasons.append(f"{section}: {why}")
        other_turn = None if deviation.is_within or why else _turn_that_fits(mine, theirs, turn, tolerance)
        if other_turn is not None:
            reasons.append(f"{section}: it is turned by {_wrapped(other_turn - turn):.3f} deg against {title}")
        elif not deviation.is_within:
            reasons.append(_farthest_apart(deviation, mine, tolerance, title, section))
    return Comparison(largest, reasons, remarks)


def _farthest_apart(deviation: PathDeviation, mine: ToolPath, tolerance: float, title: str, section: str) -> str:
    """Return how far and where a path differs from another one."""
    location = deviation.place
    where = section
    point_text = ""
    if location is not None:
        where = f"line {mine.row[location.new_move]}"
        point_text = f" at x {location.new.real:.3f} c {location.new.imag:.3f} z {location.new_z:.3f}"
    most = "" if deviation.is_exact else "up to "
    return f"{where}: {most}{deviation.largest:.3f} mm from {title}{point_text} (tolerance {tolerance:g})"


def _without_z(path: ToolPath) -> ToolPath:
    flat = np.zeros(len(path))
    return msgspec.structs.replace(path, z_start=flat, z_end=flat)


def _deviation(mine: ToolPath, theirs: ToolPath, turned: float, tolerance: float) -> float:
    try:
        return path_deviation(theirs.by_degrees(turned), mine, tolerance).largest
    except TooHardError:
        return np.inf


def _turn_that_fits(mine: ToolPath, theirs: ToolPath, turned: float, tolerance: float) -> float | None:
    """Return the angle by which the other path lies turned as a whole [deg]; None where it is another path."""
    begins = _turn_of_starts(mine, theirs)
    if abs(_wrapped(begins - turned)) < EXACT or _deviation(mine, theirs, begins, tolerance) > tolerance:
        return None
    return begins


def _turn_of_starts(mine: ToolPath, theirs: ToolPath) -> float:
    """Return the angle from the first point of the other path to ours [deg]."""
    return float(np.degrees(np.angle(mine.start[0] * theirs.start[0].conj())))


def _turns(mine: ToolPath, theirs: ToolPath, number: int) -> Iterator[float]:
    """Yield the angles by which the other path may lie turned [deg]: not at all, as on the part, as its beginning."""
    yield 0.0
    on_part = _wrapped(float(theirs.turned[number] - mine.turned[number]))
    if not np.isnan(on_part):
        yield on_part
    yield _turn_of_starts(mine, theirs)


def _wrapped(angle: float) -> float:
    """Return an angle from -180 up to 180 [deg]."""
    return (angle + 180) % 360 - 180


def _feed(path: ToolPath, move: int) -> str:
    feed = float(path.feed[move])
    return "rapid traverse" if path.rapid[move] else "not known" if np.isnan(feed) else f"{feed:g} mm/min"


def _feed_changes(ours: ToolPath, golden: ToolPath, tolerance: float, title: str) -> Iterator[str]:
    """Yield for each section the first move with another F than the golden trace has there; the paths are the same."""
    for number in range(len(ours.turned)):
        mine, theirs = ours.of_section(number), golden.of_section(number)
        move, golden_move, length = common_pieces(mine, theirs)
        differs = feed_differs(theirs, golden_move, mine, move, EXACT) & (length > 2 * tolerance)
        for first, second in zip(move[differs][:1].tolist(), golden_move[differs][:1].tolist(), strict=True):
            yield f"line {mine.row[first]}: F is {_feed(mine, first)}, in {title} {_feed(theirs, second)}"
