"""One contour in several sections, each at another angle of C: the angle that is off an even division of the turn."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from polarcheck.columns.contour.correction import Correction
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import Slip, parts_of, plain_number, slip_of
from polarcheck.foundation.arrays import Floats, Rows
from polarcheck.geometry.tolerances import ROUNDING

#: Angles of C that are compared; from so many on, all but one of them show where the last one is.
_FEWEST, _MOST, _SHOW = 3, 36, 4
#: Angles that are nearer than this are one [deg].
_SAME_ANGLE = 0.01
_TURN = 360.0


def off_the_division(trace: Trace) -> Iterator[Correction]:
    """
    The corrections of single angles of C, by which sections that cut the same would divide the turn evenly.

    Of three sections a comment must say how many there are: two of them may be anywhere. Of more the others show it.
    """
    words = _angles(trace)
    if not _FEWEST <= len(words) <= _MOST:
        return
    row = trace.run.row[words]
    angle = trace.run.words.value[words]
    if np.isnan(angle).any():
        return
    enter = trace.mode.sections.enter
    section = np.searchsorted(enter, row)
    has_section = section < np.searchsorted(enter, np.append(row[1:], len(trace)))
    shapes = [_shape(trace, int(number)) for number in section[has_section].tolist()]
    if len(shapes) != len(enter) or len({*shapes}) != 1:
        return
    cut = np.mod(angle[has_section], _TURN)
    odd = _odd(cut)
    if odd is not None:
        yield from _of_angle(trace, words[has_section], *odd)
        return
    for empty in np.flatnonzero(~has_section).tolist():
        all_angles = np.append(cut, np.mod(angle[empty], _TURN))
        # Of three angles the first one may be where C begins.
        is_shown = len(all_angles) >= _SHOW or empty > 0 or _is_stated(trace, len(all_angles))
        if is_shown and _is_even(all_angles):
            becomes = f"the {len(all_angles)} sections would divide the turn evenly"
            yield Correction(
                int(row[empty]),
                int(words[empty]),
                "",
                "nothing is cut at it",
                "with a section behind it",
                becomes,
                "angles",
            )


def _angles(trace: Trace) -> Rows:
    """The executed words that position C outside of the mode."""
    words = trace.blocks.word_indices(trace.machine.polar.rotary_words[0])
    row = trace.run.row[words]
    return words[(trace.mode.section[row] < 0) & trace.modal.uses_axes[row] & ~trace.modal.is_step("C")[row]]


def _shape(trace: Trace, section: int) -> tuple[float, ...]:
    """Numbers that sections have in common that cut the same."""
    rows = np.flatnonzero(trace.path.cuts & (trace.mode.section == section))
    path, weight = trace.path, np.arange(1.0, len(rows) + 1)
    parts = [
        path.end[rows].real,
        path.end[rows].imag,
        path.z[rows],
        np.nan_to_num(path.center[rows] - path.start[rows]).imag,
    ]
    return (len(rows), *(round(float(part @ weight), 2) for part in parts))


def _is_even(angle: Floats) -> bool:
    """The angles divide the turn evenly."""
    step = np.diff(np.sort(angle), append=angle.min() + _TURN)
    return bool(np.abs(step - _TURN / len(angle)).max() <= _SAME_ANGLE)


def _odd(angle: Floats) -> tuple[int, float] | None:
    """The one angle that is off the even division by all others, by its number, and what is to be added to it."""
    count, step = len(angle), _TURN / len(angle)
    apart = np.diff(np.sort(angle))
    if count < _FEWEST or _is_even(angle) or apart.min() <= _SAME_ANGLE:
        return None  # what cuts twice at one angle is found otherwise
    for number in range(count):
        others = np.delete(angle, number)
        place = (others - others[0]) / step
        places = {int(one) % count for one in np.rint(place)}
        if len(places) == count - 1 and np.abs(place - np.rint(place)).max() * step <= _SAME_ANGLE:
            (free,) = {*range(count)} - places
            return number, float(others[0] + free * step - angle[number])
    return None


def _is_stated(trace: Trace, count: int) -> bool:
    """A comment says how many there are: (3 SLOTS)."""
    text, comments = trace.run.text, trace.run.text.comments
    pattern = re.compile(rf"(?<![\d.]){count}\s*(?:X\b|[A-Z]{{4,}})", re.IGNORECASE)
    spans = zip(comments.start.tolist(), comments.end.tolist(), strict=True)
    return any(pattern.search(text.source.excerpt(start, end)) for start, end in spans)


def _of_angle(trace: Trace, words: Rows, number: int, shift: float) -> Iterator[Correction]:
    """The correction of one of these words, if it is a slip of the pen, or all the others show what it is."""
    word, count = int(words[number]), len(words)
    address, written = parts_of(trace.run.written(word))
    is_stated = _is_stated(trace, count)
    if not written or not (is_stated or count >= _SHOW):
        return
    angle = float(written)
    for turn in (0.0, _TURN, -_TURN):
        needed = angle + shift + turn
        if abs(needed) <= ROUNDING:  # no slip that leaves a number makes it 0
            slip = slip_of("0.", angle, _SAME_ANGLE)
            slip = None if slip is None else slip._replace(text="0.")
        else:
            slip = slip_of(written, needed, _SAME_ANGLE)
        if slip is not None:
            break
    else:
        if count < _SHOW + (not is_stated):
            return
        slip = Slip(plain_number(float(np.mod(angle + shift, _TURN))), "another angle is meant", False)
    text, becomes = address + slip.text, f"the {count} sections would divide the turn evenly"
    yield Correction(int(trace.run.row[word]), word, text, slip.kind, f"with {text}", becomes, "angles")
