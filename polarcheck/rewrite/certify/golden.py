"""
Golden traces: the moves of the tool center in polar sections, the orders beside them and the moves outside, a line
each, as `trace --path tool --format jsonl --golden` writes them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import msgspec
import numpy as np
from msgspec import UNSET, UnsetType

from polarcheck.columns.filling import before
from polarcheck.columns.trace import Trace
from polarcheck.foundation import bounded
from polarcheck.foundation.arrays import Floats
from polarcheck.foundation.decoding import json_decoder
from polarcheck.foundation.errors import CertificateError
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ZERO
from polarcheck.program.reading import files
from polarcheck.reports.pages import executed
from polarcheck.reports.pages.executed import Move
from polarcheck.reports.pages.trace_report import without_lines
from polarcheck.rewrite.compare.compared_sections import outside
from polarcheck.rewrite.compare.comparison_report import Difference
from polarcheck.rewrite.compare.order_differences import PLACE, listed, order_differences
from polarcheck.rewrite.compare.orders import Step, feed_unit, rows_behind, steps
from polarcheck.rewrite.compare.terms import ANGLE, Terms
from polarcheck.rewrite.writing.original import BLOCKS_NOT_KNOWN
from polarcheck.rules.quantity import rounded
from polarcheck.rules.wording.written import executed_word

#: Of a golden trace [bytes]: 200,000 moves take 90 MB.
_LARGEST = 100_000_000
#: How a line begins that holds an order.
_ORDER = b'{"order":'
#: The first line: the version of the format. Version 1 had neither this line nor the moves outside of sections, nor
#: those of Z alone.
_HEAD = '{"golden":2}\n'
_MOTIONS = {Motion.NONE: "move", Motion.RAPID: "rapid", Motion.LINE: "line", Motion.CW: "cw", Motion.CCW: "ccw"}
#: Motions whose points between show in no path.
_STRAIGHT = (_MOTIONS[Motion.RAPID], _MOTIONS[Motion.LINE])
_Pair = tuple[float | None, float | None]


class GoldenMove(msgspec.Struct, frozen=True):
    """The fields of a move that are compared; they are those of executed.Move."""

    section: int
    kind: str
    start: _Pair
    end: _Pair
    center: _Pair | None
    z: _Pair
    path: str
    feed: float | None
    c_axis: _Pair
    x_feed: float | None = 0.0
    channel: str = ""


class GoldenOrder(msgspec.Struct, frozen=True):
    """
    What a block orders beside its moves: tools, speeds, M codes, references, dwells, cycles; or its move outside.

    order: as it is reported. tokens: its codes, and the addresses of its values. values: lengths in mm, X as a radius;
    null is not known. section: the number of the section, from 0 in each channel. at: where the tool stands in it,
    x, c and Z [mm]. before: the section that an order outside comes before; behind the last one their number. channel:
    as that of a move. line: of the block, absent in a golden trace.
    """

    order: str
    tokens: list[str]
    values: list[float | None]
    section: int | UnsetType = UNSET
    at: list[float | None] | UnsetType = UNSET
    before: int | UnsetType = UNSET
    channel: str | UnsetType = UNSET
    line: int | UnsetType = UNSET

    def step(self, number: int) -> Step:
        """Return the order in the form in which orders are compared; the section is one of its words."""
        place = f"{PLACE}{self.channel or ''} {self.section} {self.before}"
        values = tuple(np.nan if value is None else value for value in self.values)
        return Step(number, self.line or 0, (place, *self.tokens), values, self.order)


class GoldenTrace(msgspec.Struct, frozen=True):
    """The moves of a path, and the orders beside them. is_old: of a version without the moves outside of sections."""

    moves: Sequence[Move] | Sequence[GoldenMove] = ()
    orders: Sequence[GoldenOrder] = ()
    is_old: bool = False


def orders_of(trace: Trace) -> Iterator[GoldenOrder]:
    """Yield the orders of a channel in the order in which they run, with their lines."""
    channel, z_before = trace.text.source.channel, before(trace.path.z, trace.blocks.starts, np.nan)
    of_words = [*steps(trace, is_same_machine=True), *_not_known(trace)]
    in_order = [*_block_skips(trace), *of_words, *_planes_at_entry(trace), *_moves_outside(trace)]
    for step in sorted(in_order, key=lambda step: step.row):
        section = int(trace.mode.section[step.row])
        begun = int(np.searchsorted(trace.mode.sections.enter, step.row, side="right"))
        point, z = trace.path.start[step.row], float(z_before[step.row])
        yield GoldenOrder(
            order=step.text,
            tokens=[*step.tokens],
            values=[rounded(value) for value in step.values],
            section=section if section >= 0 else UNSET,
            at=[rounded(point.real), rounded(point.imag), rounded(z)] if section >= 0 else UNSET,
            before=UNSET if section >= 0 else begun,
            channel=channel or UNSET,
            line=trace.line(step.row),
        )


def _not_known(trace: Trace) -> Iterator[Step]:
    """Yield the words of unknown value, and the blocks behind which it is not known what runs, as they are written."""
    lines, run = trace.blocks.line_in_file, trace.run
    for index in run.unknown_words:
        row, word = int(run.row[index]), executed_word(run, index)
        yield Step(row, int(lines[row]), ("not known", word), (), f"{word} of unknown value")
    remarks = [remark for remark in run.remarks if remark.kind in BLOCKS_NOT_KNOWN] if len(trace) else []
    blocks = {remark.block for remark in remarks}
    # What such a condition leads to at the end of a program has no weight for the verdict: it is kept as it is written.
    first = min((remark.block for remark in remarks if remark.row >= 0), default=len(trace.text.blocks))
    blocks.update(set(range(first, len(trace.text.blocks))).difference(run.block.tolist()))
    ordered = sorted(blocks)
    for block, row in zip(ordered, rows_behind(trace, ordered) if ordered else (), strict=True):
        if text := "".join(trace.text.without_comments(block).split()).upper():
            line = int(trace.text.blocks.line[block])
            yield Step(row, line, ("not known", text), (), f"{text}: what runs is not known")


def _block_skips(trace: Trace) -> Iterator[Step]:
    """Yield where blocks with a / begin and end: a golden trace holds the path of one state of block skip."""
    number = np.where(trace.blocks.has("/"), np.nan_to_num(trace.blocks.word("/"), nan=1.0), 0.0)
    for row in np.flatnonzero(number != before(number, trace.blocks.starts, 0.0)).tolist():
        text = f"block skip /{number[row]:g}" if number[row] else "the end of block skip"
        yield Step(row, int(trace.blocks.line_in_file[row]), ("block skip",), (float(number[row]),), text)


def _planes_at_entry(trace: Trace) -> Iterator[Step]:
    """Yield the plane that is selected where each section begins, wherever its code stands."""
    planes, lines = trace.modal.state("plane"), trace.blocks.line_in_file
    for row in trace.mode.sections.enter.tolist():
        if planes[row]:
            name = f"plane G{int(planes[row])}"
            yield Step(row, int(lines[row]), (name,), (), name)


def _moves_outside(trace: Trace) -> Iterator[Step]:
    """
    Yield the moves outside of sections: X as a radius, Z [mm], C [deg] where each ends, F of those at feed, and the
    centers of arcs; and distances from where it is not known.
    """
    stretch = outside(trace, (), np.arange(len(trace)), Terms(ANGLE))
    yield from (step for step in stretch.steps if not step.tokens[0].startswith("F"))  # F is that of the move, below
    path, lines = stretch.path, trace.blocks.line_in_file[stretch.path.row].tolist()
    places = zip(path.end.imag.tolist(), path.end.real.tolist(), (path.z_end / stretch.c_scale).tolist(), strict=True)
    motions = trace.axes.motion[path.row].tolist()
    # Of rapid traverse from where it is not known only the last end shows in a path.
    is_still = path.rapid & (np.abs(path.end - path.start) <= ZERO) & (np.abs(path.z_end - path.z_start) <= ZERO)
    is_seen = ~is_still | np.append(~is_still[1:], True)[: len(path)]
    for index, (row, line, place) in enumerate(zip(path.row.tolist(), lines, places, strict=True)):
        if not is_seen[index]:
            continue
        tokens, values = ["X", "Z", "C"], [*place]
        if not path.rapid[index]:
            tokens.append(f"F{feed_unit(int(path.feed_mode[index]))}")
            values.append(float(path.feed[index]))
        if not np.isnan(path.center[index]):
            tokens += ["I", "K"]
            values += [float(path.center[index].imag), float(path.center[index].real)]
        known = zip(tokens, values, strict=True)
        words = [f"{token[0]}{round(value, 4) + 0.0:g}{token[1:]}" for token, value in known if value == value]
        motion = _MOTIONS[Motion(motions[index])]
        yield Step(row, line, (motion, *tokens), tuple(values), f"{motion} to {' '.join(words)}")


def changed_orders(ours: GoldenTrace, golden: GoldenTrace, tolerance: float, title: str) -> Iterator[str]:
    """
    Yield what differs between the orders of a program and those of its golden trace, each in one line.

    tolerance: of lengths [mm]. title: of the golden trace.
    """

    def moved(old: Step, step: Step) -> Difference | None:
        if _distance(ours.orders[step.row], golden.orders[old.row]) <= 2 * tolerance:
            return None
        return Difference("place", f"{step.text} stands elsewhere on the path", new_line=step.line)

    before, after = (_undivided(trace.orders) for trace in (golden, ours))
    for difference in listed(order_differences(before, after, tolerance, moved)):
        where = f"line {difference.new_line}: " if difference.new_line else ""
        yield f"{where}{difference.text} against {title}"


def _undivided(orders: Sequence[GoldenOrder]) -> list[Step]:
    """Return the orders as steps; moves outside of sections without the points that divide one straight move."""
    kept: list[Step] = []
    for number, order in enumerate(orders):
        step = order.step(number)
        if len(kept) > 1 and kept[-1].tokens == step.tokens and step.tokens[1] in _STRAIGHT:
            (start, middle), end = (np.array(before.values[:3]) for before in kept[-2:]), np.array(step.values[:3])
            is_move = kept[-2].tokens[:1] == step.tokens[:1] and kept[-2].tokens[2:5] == step.tokens[2:5]
            if is_move and kept[-1].values[3:] == step.values[3:] and _is_between(start, middle, end):
                kept.pop()
        kept.append(step)
    return kept


def _is_between(start: Floats, middle: Floats, end: Floats) -> bool:
    """Return True if a point lies on the way from one to another, of X, Z [mm] and C [deg]; False if one is unknown."""
    whole, piece = end - start, middle - start
    length = float(np.abs(whole).max())
    share = float(piece @ whole) / float(whole @ whole) if length > ZERO else np.nan
    return 0 <= share <= 1 and bool((np.abs(piece - share * whole) <= ZERO).all())


def _distance(order: GoldenOrder, other: GoldenOrder) -> float:
    """Return how far apart two orders of sections stand on the path [mm]; 0 where it is not known."""
    pairs = zip(order.at or (), other.at or (), strict=False)
    return max((abs(a - b) for a, b in pairs if a is not None and b is not None), default=0.0)


def lines(moves: Iterable[Move], orders: Iterable[GoldenOrder]) -> Iterator[str]:
    """Yield a line for each move and order, without the line of its block, which renumbering and comments change."""
    yield _HEAD
    yield from executed.as_jsonl(without_lines(iter(moves)))
    for order in orders:
        yield msgspec.json.encode(msgspec.structs.replace(order, line=UNSET)).decode() + "\n"


def read(path: Path) -> GoldenTrace:
    """Read a golden trace. Raises CertificateError, which names file and line."""
    title = files.display_path(str(path))
    try:
        data = bounded.read_file(path, _LARGEST, "no golden trace is")
    except OSError as error:
        raise CertificateError(f"{title}: {error.strerror or error}") from None
    of_moves, of_orders = json_decoder(GoldenMove), json_decoder(GoldenOrder)
    moves: list[GoldenMove] = []
    orders: list[GoldenOrder] = []
    is_old = not data.startswith(_HEAD.encode())
    for number, line in enumerate(data.splitlines()[not is_old :], 1 + (not is_old)):
        is_order = line.startswith(_ORDER)
        try:
            if is_order:
                orders.append(of_orders.decode(line))
            else:
                moves.append(of_moves.decode(line))
        except (msgspec.DecodeError, UnicodeDecodeError) as error:
            what = "an order" if is_order else "a move"
            raise CertificateError(f"{title}:{number}: expected {what} of a golden trace: {error}") from None
    return GoldenTrace(moves, orders, is_old)


def is_golden(path: Path) -> bool:
    """Return True for a file that may be rewritten: it holds a golden trace, or nothing."""
    try:
        read(path)
    except CertificateError:
        return False
    return True
