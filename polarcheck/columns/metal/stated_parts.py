"""Comments that state shape, size or depth of the part, beside what their sections make."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.finished import Finished
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.comment_patterns import PART_DEPTH, PART_SIZE
from polarcheck.columns.words.comment_reader import StatedShape, depth_in, shape_in
from polarcheck.columns.words.comments import Comments, named_tool
from polarcheck.columns.words.stock_comments import StockComments
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, different, is_among
from polarcheck.foundation.states import Motion
from polarcheck.geometry.shapes.shape import POLYGONS

if TYPE_CHECKING:
    from polarcheck.geometry.shapes.shape import Shape

#: What is made may differ from a comment by so much: sizes of drawings are rounded, and have tolerances [mm].
_SIZE_TOLERANCE, _SIZE_SHARE = 0.25, 0.01
_DEPTH_TOLERANCE, _DEPTH_SHARE = 0.3, 0.02
#: A program with more sections than this is not held against its comments.
_MOST_SECTIONS = 100


class PartComment(NamedTuple):
    """
    What a comment states, where, and the sections that it speaks of.

    comment: its number in text.comments.
    row: of its block, or the first one below it.
    tool: that it names, -1 for none.
    size: None where it states none.
    depth: [mm], NaN where it states none.
    of_size, of_depth: numbers of the sections; another comment nearer to a section takes its place.
    """

    comment: int
    row: int
    tool: int
    size: StatedShape | None
    depth: float
    of_size: Sequence[int] = ()
    of_depth: Sequence[int] = ()


class Contradiction(NamedTuple):
    """
    A comment that its sections contradict.

    row: of the contour, or of its depth.
    comment: its number.
    stated, made: sizes or depths [mm].
    shape: that is made; DEPTH where the depth differs, TURNED where the program turns to a larger diameter than that of
    the bar, BEYOND where the part reaches beyond it.
    """

    row: int
    comment: int
    stated: float
    made: float
    shape: str


DEPTH, TURNED, BEYOND = "depth", "turned", "beyond"


class PartComments(Columns, frozen=True):
    """Statements of comments on the part; contours are computed only where a comment needs them."""

    trace: Trace
    comments: Comments
    finished: Finished
    stock_comments: StockComments
    bar: Bar

    @cached_property
    def contradictions(self) -> dict[int, Contradiction]:
        """
        By row what its comment contradicts.

        Raises TooHardError where the contours cannot be computed.
        """
        hits: dict[int, Contradiction] = {}
        for comment in self.part_comments:
            for hit in (*self._sizes(comment), *self._depths(comment)):
                hits.setdefault(hit.row, hit)
        for hit in self._bars():
            hits.setdefault(hit.row, hit)
        return hits

    @property
    def contradicts(self) -> Mask:
        """The rows of contradictions."""
        mask = np.zeros(len(self.trace), bool)
        mask[[*self.contradictions]] = True
        return mask

    @property
    def stated(self) -> Floats:
        """The size or depth of the comment [mm]; NaN elsewhere."""
        column = np.full(len(self.trace), np.nan)
        for row, hit in self.contradictions.items():
            column[row] = hit.stated
        return column

    # ---- which sections a comment speaks of ----

    @cached_property
    def part_comments(self) -> list[PartComment]:
        """The comments that speak of sections, in the order of the file."""
        sections = self.trace.mode.sections
        if not 0 < len(sections) <= _MOST_SECTIONS or not len(self.comments):
            return []
        statements = [*self._statements()]
        of_size = self._nearest([statement for statement in statements if statement.size is not None])
        of_depth = self._nearest([statement for statement in statements if not np.isnan(statement.depth)])
        return [
            statement._replace(of_size=of_size.get(statement.comment, []), of_depth=of_depth.get(statement.comment, []))
            for statement in statements
        ]

    def _statements(self) -> Iterator[PartComment]:
        """What comments state, without the sections."""
        for number, written, row, is_behind, in_inch in self.comments.with_words((*PART_SIZE.words, *PART_DEPTH.words)):
            size, depth = shape_in(written, in_inch), depth_in(written, in_inch)
            if not is_behind and (size is not None or depth is not None):
                tool = named_tool(written)
                yield PartComment(number, row, -1 if tool is None else tool, size, np.nan if depth is None else depth)

    def _nearest(self, statements: list[PartComment]) -> dict[int, list[int]]:
        """By comment the sections that have no nearer one."""
        of_comment: dict[int, list[int]] = {}
        for section in range(len(self.trace.mode.sections)) if statements else []:
            ranked = [(self._nearness(section, statement), statement.comment) for statement in statements]
            nearness, comment = max(ranked)
            if nearness >= 0:
                of_comment.setdefault(comment, []).append(section)
        return of_comment

    def _nearness(self, section: int, statement: PartComment) -> int:
        """
        How near a comment is to a section: more for a later one from the call of its tool to its end, 0 for a line of a
        list of tools, -1 for one that does not speak of it.
        """
        trace, sections, row = self.trace, self.trace.mode.sections, statement.row
        enter, last = int(sections.enter[section]), int(sections.last[section])
        is_of_tool = statement.tool < 0 or statement.tool in self._numbers_of_tool(enter)
        if int(self._tool_call[enter]) <= row <= last:
            return row + 1 if is_of_tool else -1
        same = bool(trace.blocks.program[row] == trace.blocks.program[enter])
        return 0 if statement.tool >= 0 and is_of_tool and same and row <= enter else -1

    def _numbers_of_tool(self, row: int) -> tuple[int, int]:
        """The numbers by which a comment may name the tool in force: 8 and 808 for T0808."""
        call = int(self._tool_call[row])
        word = float(self.trace.blocks.word("T")[call])
        return int(self.trace.tools.tool[row]), -2 if np.isnan(word) else int(abs(word))

    @cached_property
    def _tool_call(self) -> Rows:
        """The row that called the tool in force; the first of the program before any call."""
        trace = self.trace
        calls = trace.tools.calls_tool & (trace.tools.tool > 0) | trace.blocks.starts
        return np.maximum(last_row(calls, trace.blocks.starts), 0)

    # ---- shapes and sizes ----

    @cached_property
    def _shapes(self) -> dict[int, list[Shape]]:
        """By section what its contours make, depth by depth."""
        from polarcheck.geometry.shapes.shapes import shapes_of

        shapes: dict[int, list[Shape]] = {}
        for level in (*self.finished.levels, *self.finished.meant):
            of_level = [] if level.tangled else shapes_of(level.outline, level.gap, self.finished.overcuts.bar)
            row = int(level.walls.row[0])
            # The first block of the contour as programmed; a shape may begin with any of its sides.
            shapes.setdefault(level.section, []).extend(shape._replace(row=row) for shape in of_level)
        return shapes

    def _sizes(self, comment: PartComment) -> Iterator[Contradiction]:
        size = comment.size
        if size is None or not comment.of_size:
            return
        if any(_fits(size, shape) for shapes in self._shapes.values() for shape in shapes):
            # Another section may reach the size, as where this tool leaves something for the next one.
            return
        of_comment = [shape for section in comment.of_size for shape in self._shapes.get(section, [])]
        comparable = _comparable(size, of_comment)
        if comparable:
            shape, machined = min(comparable, key=lambda pair: pair[1])
            yield Contradiction(shape.row, comment.comment, size.size, machined, shape.name)
        elif of_comment and size.shape in POLYGONS.values() and all(map(_is_regular_polygon, of_comment)):
            shape = of_comment[0]
            yield Contradiction(shape.row, comment.comment, size.size, shape.values["across_flats"], shape.name)

    # ---- depths ----

    def _depths(self, comment: PartComment) -> Iterator[Contradiction]:
        depth = comment.depth
        if np.isnan(depth) or not comment.of_depth:
            return
        z, section = self.trace.path.z, self.trace.mode.section
        of_comment = np.isin(section, comment.of_depth)
        chosen = np.flatnonzero(of_comment & self.trace.path.moves_at_feed)
        top = z[self.trace.mode.sections.enter[comment.of_depth]]
        # Where the tool does not come from above Z0 the face is unknown.
        if not len(chosen) or np.isnan(z[chosen]).any() or not (top > 0).all():
            return
        bottom = np.full(len(self.trace.mode.sections), np.inf)
        np.minimum.at(bottom, section[chosen], z[chosen])
        bottoms = bottom[np.isfinite(bottom)]
        if bottoms.min() >= 0 or _is_depth(depth, np.subtract.outer(self._faces(~of_comment), bottoms)).any():
            return
        row = int(chosen[np.argmin(z[chosen])])
        yield Contradiction(row, comment.comment, depth, -float(bottoms.min()), DEPTH)

    def _faces(self, rows: Mask) -> Floats:
        """Every Z to which these rows cut, and Z0: a depth may be meant from any of these faces."""
        trace = self.trace
        at_feed = is_among(trace.axes.motion, (Motion.LINE, Motion.CW, Motion.CCW))
        ends = np.append(trace.path.z[rows & at_feed], trace.path.z_of_cycles[rows])
        return different(np.append(np.nan_to_num(ends), 0.0))

    # ---- bars ----

    def _bars(self) -> Iterator[Contradiction]:
        """The bar of a comment that is smaller than what the program turns, or than its part."""
        sections = self.trace.mode.sections
        if not 0 < len(sections) <= _MOST_SECTIONS or not self.stock_comments.of_program:
            return
        row = int(sections.enter[0])
        comment = int(self.stock_comments.comment[row])
        if comment < 0:
            return
        across_flats = float(self.stock_comments.across_flats[row])
        # A hexagon reaches out to its corners.
        size = float(np.fmax(self.stock_comments.diameter[row], across_flats * 2 / np.sqrt(3)))
        stated = size if np.isnan(across_flats) else across_flats
        largest = size + max(_SIZE_TOLERANCE, _SIZE_SHARE * size)
        stock = self.bar.known
        if stock.source == "turning" and stock.smallest > largest:
            turns = np.flatnonzero(self.trace.blocks.line_in_file == stock.lines[0])
            yield Contradiction(int(turns[0]), comment, stated, stock.smallest, TURNED)
        elif stock.source == "comment" and self._may_be_beyond(largest / 2):
            yield from (Contradiction(at, comment, stated, needed, BEYOND) for at, needed in self._beyond(largest / 2))

    def _may_be_beyond(self, radius: float) -> bool:
        """A cheap test: some of a contour lies beyond this radius with both ends."""
        walls, _ = self.finished.overcuts.walls
        return bool(((np.abs(walls.start) > radius) & (np.abs(walls.end) > radius)).any())

    def _beyond(self, radius: float) -> Iterator[tuple[int, float]]:
        """
        The first row of the contour whose part reaches beyond this radius, and the diameter that it needs [mm].

        None where another contour of the program stays within. Straight sides may end beyond the bar, and an arc around
        the axis goes round it; a corner arc there is for nothing, and so is a whole contour.
        """
        from polarcheck.geometry.shapes.side_rings import nearest_of, rings

        hits = []
        for level in self.finished.levels:
            for ring in rings(level.outline, level.gap) if not (level.tangled or level.open) else ():
                if not ring.closed or ring.inside:
                    continue
                nearest = nearest_of(ring)
                is_beyond = nearest > radius
                is_corner = ~ring.is_line & ~(np.abs(ring.center) <= _SIZE_TOLERANCE)
                if not is_beyond.all() and not (is_beyond & is_corner).any():
                    return
                hits.append((int(level.walls.row[0]), 2 * float(nearest[is_beyond].max())))
        yield from hits[:1]


def _fits(size: StatedShape, shape: Shape) -> bool:
    """A shape has this size, in whatever way it is measured, and is no other regular polygon."""
    if size.shape in POLYGONS.values() and _is_regular_polygon(shape) and shape.name != size.shape:
        return False
    tolerance = max(_SIZE_TOLERANCE, _SIZE_SHARE * size.size)
    return any(abs(value - size.size) <= tolerance for value in _values(shape, size.is_across_flats))


def _is_depth(depth: float, value: Floats) -> Mask:
    return np.asarray(np.abs(value - depth) <= max(_DEPTH_TOLERANCE, _DEPTH_SHARE * depth))


def _values(shape: Shape, is_across_flats: bool) -> Iterator[float]:
    """Each number by which a comment may give the size of a shape: across flats, else also corners and diameters."""
    values = shape.values
    yield from (values[name] for name in ("across_flats", "apart", "width") if name in values)
    yield from (2 * values[name] for name in ("distance", "least", "most") if name in values)
    yield from (values[name] for name in ("least", "most") if name in values)
    if is_across_flats:
        return
    yield from (values[name] for name in ("diameter", "corner_diameter", "distance", "length") if name in values)
    if "across_flats" in values and "sides" in values:
        yield values["across_flats"] / float(np.cos(np.pi / values["sides"]))


def _comparable(size: StatedShape, shapes: list[Shape]) -> list[tuple[Shape, float]]:
    """The shapes of which the comment can speak, with their sizes."""
    if size.shape == "boss":
        return [(shape, shape.values["diameter"]) for shape in shapes if shape.name == "circle" and not shape.inside]
    pairs = []
    for shape in shapes:
        value = shape.values.get("across_flats", shape.values.get("apart", np.nan))
        if shape.inside or np.isnan(value) or "regular_by_x" in shape.values:
            continue
        is_polygon = "across_flats" in shape.values
        if shape.name == size.shape or not size.shape or (size.shape == "flats" and not is_polygon):
            pairs.append((shape, value))
    # Corners that are cut off beside the flats make twice as many sides.
    with_corners = {name: 2 * sides for sides, name in POLYGONS.items()}.get(size.shape, 0)
    pairs += [
        (shape, shape.values["least"])
        for shape in shapes
        if shape.values.get("sides") == with_corners and "least" in shape.values and not shape.inside
    ]
    return pairs


def _is_regular_polygon(shape: Shape) -> bool:
    return shape.name in POLYGONS.values() and shape.is_regular and not shape.inside and "across_flats" in shape.values
