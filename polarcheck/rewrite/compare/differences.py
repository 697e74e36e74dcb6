"""What differs between two stretches: path, depth, feeds, and orders along the path."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Rows
from polarcheck.foundation.states import FeedMode
from polarcheck.geometry import polar
from polarcheck.geometry.comparison.path_deviation import PathDeviation, path_deviation
from polarcheck.geometry.plane_path import SpacePath
from polarcheck.geometry.tolerances import ZERO
from polarcheck.rewrite.compare.compared_sections import FedPath, Stretch
from polarcheck.rewrite.compare.comparison_report import Difference
from polarcheck.rewrite.compare.order_differences import listed, order_differences
from polarcheck.rewrite.compare.orders import Step
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rules.quantity import rounded

#: The most changes of F in a list.
_LISTED = 20


def deviation_of(old: Stretch, new: Stretch, tolerance: float) -> PathDeviation | None:
    """Return how far the paths are apart; None where neither moves. Raises TooHardError."""
    if not len(old.path) and not len(new.path):
        return None
    return path_deviation(old.path, new.path, tolerance)


def differences(old: Stretch, new: Stretch, deviation: PathDeviation | None, terms: Terms) -> Iterator[Difference]:
    """Yield what differs between two parts whose paths are known; deviation: None where the paths were not compared."""
    has_other_moves = terms.has_other_moves and old.section >= 0
    is_same_path = not has_other_moves and (deviation is None or deviation.is_within)
    if deviation is not None and not is_same_path:
        yield _of_path(old, new, deviation)
    if not is_same_path:
        yield from _of_depth(old, new, terms.tolerance)
    if is_same_path and deviation is not None:
        yield from _feeds_along(old, new, terms)
    elif not is_same_path:
        yield from _feeds_apart(old, new)
    if has_other_moves:
        return

    def moved(step: Step, new_step: Step) -> Difference | None:
        """Return the difference of two orders in their positions on the path."""
        here, there = old.path.position(step.row), new.path.position(new_step.row)
        apart = np.nan_to_num(np.subtract(here, there))[: 2 if old.is_rewritten else 3]
        if not is_same_path or np.abs(apart).max() <= 2 * terms.tolerance:
            return None
        places = [
            _location(old, step.row, complex(*here[:2]), here[2]),
            _location(new, new_step.row, complex(*there[:2]), there[2]),
        ]
        text = f"{step.text} stands elsewhere on the path: {places[0]} | {places[1]}"
        return Difference("place", text, places[0], places[1], "", step.line, new_step.line)

    yield from listed(order_differences(old.steps, new.steps, terms.tolerance, moved))


# ---- path ----


def _of_path(old: Stretch, new: Stretch, deviation: PathDeviation) -> Difference:
    location = deviation.place
    if location is None:
        missing = [part for part in (old, new) if not len(part.path)]
        name = "new" if missing[0] is new else "old"
        moving = old if missing[0] is new else new
        line = moving.line(int(moving.path.row[0]))
        text = f"the {name} revision moves nothing here"
        return Difference(
            "path", text, old_line=line if moving is old else None, new_line=line if moving is new else None
        )
    old_row, new_row = int(old.path.row[location.old_move]), int(new.path.row[location.new_move])
    at_old = _location(old, old_row, location.old, location.old_z)
    at_new = _location(new, new_row, location.new, location.new_z)
    largest = _largest(old, deviation)
    size = f"{'' if deviation.is_exact else 'up to '}{old.quantity(largest, old_row).shown('length', 1)}"
    if old.section < 0 and largest == 0:
        size = "C alone"
    units = [part.quantity(0.0, row).unit for part, row in ((old, old_row), (new, new_row))]
    if units[0] != units[1]:
        at_old, at_new = f"{at_old} {units[0]}", f"{at_new} {units[1]}"
    text = f"the path differs by {size}: {at_old} | {at_new}"
    return Difference("path", text, 0.0, rounded(largest), "mm", old.line(old_row), new.line(new_row))


def _largest(old: Stretch, deviation: PathDeviation) -> float:
    """Return the deviation as a length [mm]; outside sections the share of C in it does not count."""
    location = deviation.place
    if old.section >= 0 or location is None:
        return deviation.largest
    apart = abs(location.old - location.new)
    return apart if apart > ZERO else 0.0


def length_of(part: Stretch, deviation: PathDeviation | None) -> float:
    """Return the largest deviation of a part [mm]; 0 where nothing moves."""
    return 0.0 if deviation is None else _largest(part, deviation)


def _location(part: Stretch, row: int, point: complex, third: float) -> str:
    """
    Return the point in the units of the program, as `X60 C5 Z-2`.

    third: the third coordinate of the path: Z in a section; outside, where the point is Z + 1j*X, the scaled C.
    """
    trace, section = part.trace, part.section
    if section >= 0:
        point = point / complex(trace.path.section_turn[section])
        x, across, z = point.real, point.imag, third
        name = trace.axes.virtual_axis_of(int(trace.mode.sections.enter[section]))
        words = f"{name}{_number(part, row, across)}"
    else:
        x, z = point.imag, point.real
        words = f"C{third / part.c_scale:.3f}".rstrip("0").rstrip(".")
    x = x / float(trace.lengths.x_factor[row])
    depth = f" Z{_number(part, row, z)}" if part.knows_z else ""
    return f"X{_number(part, row, x)} {words}{depth}"


def _number(part: Stretch, row: int, value: float) -> str:
    return part.quantity(value, row).shown("length").partition(" ")[0]


def depth_of(stretch: Stretch) -> float | None:
    """Return the least Z of the moves at feed of a section [mm]; None where it is not known."""
    z = stretch.path.z_end[~stretch.path.rapid]
    return rounded(z.min()) if len(z) and stretch.knows_z and not np.isnan(z).any() else None


def _of_depth(old: Stretch, new: Stretch, tolerance: float) -> Iterator[Difference]:
    before, after = depth_of(old), depth_of(new)
    if old.section < 0 or before is None or after is None or abs(before - after) <= tolerance:
        return
    rows = [int(part.path.row[~part.path.rapid][0]) for part in (old, new)]
    depths = [
        part.quantity(z, row).shown("length") for part, row, z in zip((old, new), rows, (before, after), strict=True)
    ]
    yield Difference("depth", f"the depth was Z{depths[0]} and is Z{depths[1]}", before, after, "mm")


# ---- feeds ----


def common_pieces(old: SpacePath, new: SpacePath) -> tuple[Rows, Rows, Floats]:
    """
    Return the pieces of a path that two programs have in common, however moves divide it: for each piece the move of
    either program, and the length on the old path [mm].
    """
    ends = [np.cumsum(_lengths(path)) for path in (old, new)]
    if not min(float(end[-1]) if len(end) else 0.0 for end in ends) > ZERO:
        return np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros(0)
    shares = [end / end[-1] for end in ends]
    cuts = np.union1d(*shares)
    middle = (cuts + np.append(0.0, cuts[:-1])) / 2
    moves = [np.minimum(np.searchsorted(share, middle), len(share) - 1) for share in shares]
    return moves[0], moves[1], np.diff(cuts, prepend=0.0) * ends[0][-1]


def _lengths(path: SpacePath) -> Floats:
    """Return the length of each move in space [mm]; what is not known of it counts as 0."""
    length = polar.length(path.start, path.end, path.center, path.kind)
    return np.asarray(np.hypot(np.nan_to_num(length), np.nan_to_num(path.z_end - path.z_start)))


def _feeds_along(old: Stretch, new: Stretch, terms: Terms) -> Iterator[Difference]:
    """
    Yield where F differs along the common path; all changes from one value to the same other value are one difference.
    """
    before, after, length = common_pieces(old.path, new.path)
    # The ends of moves that are the same up to the tolerance leave slivers between them.
    totals = [float(_lengths(part.path).sum()) for part in (old, new)]
    sliver = 10 * terms.tolerance + 2 * abs(totals[0] - totals[1])
    differs = feed_differs(old.path, before, new.path, after, terms.feed) & (length > sliver)
    groups: dict[tuple[str, str], list[tuple[int, int, float]]] = {}
    for index in np.flatnonzero(differs).tolist():
        first, second = int(before[index]), int(after[index])
        groups.setdefault((_feed(old, first), _feed(new, second)), []).append((first, second, float(length[index])))
    for (was, is_now), places in list(groups.items())[:_LISTED]:
        first, second, _ = places[0]
        distance = sum(piece for *_, piece in places)
        row, new_row = int(old.path.row[first]), int(new.path.row[second])
        text = f"{was} has become {is_now} along {old.quantity(distance, row).shown('length')}"
        yield Difference("feed", text, was, is_now, "", old.line(row), new.line(new_row), rounded(distance))
    if len(groups) > _LISTED:
        yield Difference("feed", f"and {len(groups) - _LISTED} other changes of F")


def feed_differs(old: FedPath, first: Rows, new: FedPath, second: Rows, share: float) -> Mask:
    """Return a mask of the pairs of moves with another F, by more than a share, or rapid traverse in one alone."""
    rapid = old.rapid[first], new.rapid[second]
    feed, new_feed = old.feed[first], new.feed[second]
    is_known = ~np.isnan(feed), ~np.isnan(new_feed)
    same = (np.abs(feed - new_feed) <= share * np.abs(feed)) & (old.feed_mode[first] == new.feed_mode[second])
    at_feed = ~rapid[0] & ~rapid[1]
    return np.asarray((rapid[0] != rapid[1]) | (at_feed & ((is_known[0] != is_known[1]) | (is_known[0] & ~same))))


def _feed(part: Stretch, move: int) -> str:
    """`F120 mm/min`, `F0.1 mm/rev`, `rapid traverse`, `F not known`, `no F`."""
    if part.path.rapid[move]:
        return "rapid traverse"
    row, feed = int(part.path.row[move]), float(part.path.feed[move])
    if np.isnan(feed):
        return "no F" if part.trace.feedrate.feed_word[row] < 0 else "F not known"
    quantity = part.quantity(feed, row)
    text = quantity.shown("feed")
    if part.path.feed_mode[move] == FeedMode.PER_REVOLUTION:
        text = quantity.as_feed.shown("length", 2) + "/rev"
    return f"F{text}"


def _feeds_apart(old: Stretch, new: Stretch) -> Iterator[Difference]:
    """Yield a difference if two differing paths do not have the same values of F; each value counts once."""
    feeds = [list(dict.fromkeys(_feed(part, move) for move in _changes_of_feed(part))) for part in (old, new)]
    if sorted(feeds[0]) != sorted(feeds[1]):
        texts = [", ".join(values[:_LISTED]) or "none" for values in feeds]
        yield Difference("feed", f"F was {texts[0]} and is {texts[1]}", texts[0], texts[1])


def _changes_of_feed(stretch: Stretch) -> list[int]:
    if not len(stretch.path.row):
        return []
    feed = np.nan_to_num(stretch.path.feed, nan=-1)
    changes = (np.diff(feed) != 0) | (np.diff(stretch.path.rapid) != 0) | (np.diff(stretch.path.feed_mode) != 0)
    return [0, *(np.flatnonzero(changes) + 1).tolist()]
