"""Comments that state shape, size or depth of the part, beside what their sections make."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.finished import Finished, Level
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.comment_patterns import ALLOWANCE, PART_DEPTH, PART_SIZE, TITLE_DIAMETER
from polarcheck.columns.words.comment_reader import (
    StatedShape,
    allowance_in,
    depth_in,
    shapes_in,
    title_diameter_in,
    tolerance_of,
)
from polarcheck.columns.words.comments import Comments, named_tool
from polarcheck.columns.words.stock_comments import StockComments
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, column_at, different, folded
from polarcheck.geometry.shapes.shape import POLYGONS, SIDES_OF

if TYPE_CHECKING:
    from polarcheck.geometry.segments import Curves
    from polarcheck.geometry.shapes.shape import Shape

#: The cut may differ from the depth of a comment by so much: depths of drawings are rounded [mm].
_DEPTH_TOLERANCE, _DEPTH_SHARE = 0.3, 0.02
#: A shorter wall may be that of a corner [mm].
_SHORTEST = 0.5
#: Sides of a regular polygon are as far from its center, but for the digits of its corners [mm].
_SAME = 0.05
#: A program with more sections than this is not held against its comments.
_MOST_SECTIONS = 100


class PartComment(msgspec.Struct, frozen=True):
    """
    What a comment states, where, and the sections that it speaks of.

    comment: its number in text.comments.
    row: of its block, or the first one below it.
    tool: that it names, -1 for none.
    sizes: empty where it states none; one that fits is enough.
    depth: [mm], NaN where it states none.
    diameter: of the part, in the title of its program [mm], NaN where it states none.
    in_title: it stands at the head of its program, before all blocks.
    of_size, of_depth: numbers of the sections; another comment nearer to a section takes its place.
    """

    comment: int
    row: int
    tool: int
    sizes: tuple[StatedShape, ...] = ()
    depth: float = np.nan
    diameter: float = np.nan
    in_title: bool = False
    of_size: Sequence[int] = ()
    of_depth: Sequence[int] = ()


class Contradiction(msgspec.Struct, frozen=True):
    """
    A comment that its sections contradict.

    row: of the contour, or of its depth.
    comment: its number.
    stated, made: sizes or depths [mm].
    shape: that is made; DEPTH where the depth differs, TURNED where the program turns to a larger diameter than that of
    the bar, BEYOND where the part reaches beyond it, UNEVEN of a polygon with as many sides that is not regular.
    stated_shape: that the comment states; empty where it is the same.
    """

    row: int
    comment: int
    stated: float
    made: float
    shape: str
    stated_shape: str = ""


DEPTH, TURNED, BEYOND, UNEVEN = "depth", "turned", "beyond", "uneven"


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
    def has_areas(self) -> bool:
        """
        True where walls of unknown R have the size of a comment, and none of known R has it.

        No polygon is computed then, and what is made is told nevertheless.
        """
        overcuts = self.finished.overcuts
        stated = [comment.sizes for comment in self.part_comments if comment.of_size]
        return "contradictions" in vars(self) and any(
            _has_walls_of(sizes, overcuts.walls_of_unknown_radius[0]) and not _has_walls_of(sizes, overcuts.walls[0])
            for sizes in stated
        )

    @property
    def contradicts(self) -> Mask:
        """The rows of contradictions."""
        return self.trace.blocks.mask_of([*self.contradictions])

    @property
    def stated(self) -> Floats:
        """The size or depth of the comment [mm]; NaN elsewhere."""
        stated = [hit.stated for hit in self.contradictions.values()]
        return column_at(len(self.trace), [*self.contradictions], stated, np.nan)

    # ---- which sections a comment speaks of ----

    @cached_property
    def part_comments(self) -> list[PartComment]:
        """The comments that speak of sections, in the order of the file."""
        sections = self.trace.mode.sections
        if not 0 < len(sections) <= _MOST_SECTIONS or not len(self.comments):
            return []
        statements = [*self._statements()]
        with_size = [statement for statement in statements if statement.sizes or not np.isnan(statement.diameter)]
        of_size = self._nearest(with_size)
        rough = self._rough_sections if with_size else set()
        of_depth = self._nearest([statement for statement in statements if not np.isnan(statement.depth)])
        return [
            msgspec.structs.replace(
                statement,
                of_size=[section for section in of_size.get(statement.comment, []) if section not in rough],
                of_depth=of_depth.get(statement.comment, []),
            )
            for statement in statements
        ]

    def _statements(self) -> Iterator[PartComment]:
        """What comments state, without the sections."""
        words = (*PART_SIZE.words, *PART_DEPTH.words, TITLE_DIAMETER.words[0])
        for number, written, row, is_behind, in_inch in self.comments.with_words(words):
            if is_behind:
                continue
            tool, in_title = named_tool(written), self._is_in_title(row)
            depth = depth_in(written, in_inch)
            diameter = title_diameter_in(written, in_inch) if in_title else None
            statement = PartComment(
                number,
                row,
                tool=-1 if tool is None else tool,
                sizes=tuple(shapes_in(written, in_inch)),
                depth=np.nan if depth is None else depth,
                diameter=np.nan if diameter is None else diameter,
                in_title=in_title,
            )
            if statement.sizes or depth is not None or diameter is not None:
                yield statement

    def _is_in_title(self, row: int) -> bool:
        """A comment of this row stands in the block of the O word, or right behind it."""
        starts = self.trace.blocks.starts
        return bool(starts[row]) or bool(starts[row - 1] and self.trace.blocks.has("O")[row - 1])

    @property
    def _rough_sections(self) -> set[int]:
        """The sections of which a comment says that they leave metal for another tool."""
        rough = [
            PartComment(number, row, -1 if (tool := named_tool(written)) is None else tool)
            for number, written, row, is_behind, in_inch in self.comments.with_words(ALLOWANCE.words)
            if not is_behind and allowance_in(written, in_inch)
        ]
        sections = range(len(self.trace.mode.sections))
        return {section for section in sections if any(self._nearness(section, one) >= 0 for one in rough)}

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
        list of tools and for a title, -1 for one that does not speak of it.
        """
        trace, sections, row = self.trace, self.trace.mode.sections, statement.row
        enter, last = int(sections.enter[section]), int(sections.last[section])
        is_of_tool = statement.tool < 0 or statement.tool in self._numbers_of_tool(enter)
        if int(self._tool_call[enter]) <= row <= last:
            return row + 1 if is_of_tool else -1
        same = bool(trace.blocks.program[row] == trace.blocks.program[enter])
        speaks_of = statement.tool >= 0 or (statement.in_title and bool(statement.sizes or statement.diameter > 0))
        return 0 if speaks_of and is_of_tool and same and row <= enter else -1

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
        """By section what its contours make, depth by depth, alone and together with other sections."""
        finished = self.finished
        shapes: dict[int, list[Shape]] = {}
        joined = [level for level in (*finished.of_part, *finished.meant_of_part) if len(level.sections) > 1]
        for level in (*finished.levels, *finished.meant, *joined):
            shapes.setdefault(level.section, []).extend(self._shapes_of(level))
        return shapes

    def _shapes_of(self, level: Level) -> list[Shape]:
        from polarcheck.geometry.shapes.shapes import shapes_of

        of_level = [] if level.tangled else shapes_of(level.outline, level.gap, self.finished.overcuts.bar)
        # The first block of the contour as programmed; a shape may begin with any of its sides.
        return [msgspec.structs.replace(shape, row=int(level.walls.row[0])) for shape in of_level]

    def _sizes(self, comment: PartComment) -> Iterator[Contradiction]:
        overcuts = self.finished.overcuts
        if (
            not comment.of_size
            or _has_walls_of(comment.sizes, overcuts.walls[0])
            or _has_walls_of(comment.sizes, overcuts.walls_of_unknown_radius[0])
        ):
            return
        from polarcheck.columns.metal.stated_sizes import fits

        of_comment = [shape for section in comment.of_size for shape in self._shapes.get(section, [])]
        if comment.in_title and not self._is_one_part(comment):
            return
        shapes = [shape for shapes in self._shapes.values() for shape in shapes]
        if any(fits(size, shape) for size in comment.sizes for shape in shapes):
            # Another section may reach the size, as where this tool leaves something for the next one.
            return
        if not self.trace.path.moves_of(self.trace.path.cuts).is_known.all():
            return  # so may one of which not all is known
        hits = [hit for size in comment.sizes for hit in self._contradictions(comment, size, of_comment)]
        yield from hits[:1] or self._beyond_diameter(comment, of_comment)

    def _contradictions(
        self, comment: PartComment, size: StatedShape, of_comment: list[Shape]
    ) -> Iterator[Contradiction]:
        from polarcheck.columns.metal.stated_sizes import comparable, has_side, is_regular_polygon, is_size, is_uneven

        pairs = comparable(size, of_comment)
        if comment.in_title:
            # A title may speak of what another program makes.
            pairs = [pair for pair in pairs if pair[0].name != "rectangle" or has_side(size, pair[0])]
        if pairs:
            shape, machined = min(pairs, key=lambda pair: pair[1])
            stated_shape = size.shape if shape.name == "rectangle" else ""
            yield Contradiction(shape.row, comment.comment, size.size, machined, shape.name, stated_shape)
        elif of_comment and size.shape in POLYGONS.values() and all(map(is_regular_polygon, of_comment)):
            shape = of_comment[0]
            across = shape.values["across_flats"]
            if not comment.in_title or is_size(size, across):
                yield Contradiction(shape.row, comment.comment, size.size, across, shape.name, size.shape)
        else:
            for shape in of_comment:
                if is_uneven(size, shape):
                    along_x = shape.values["x_most"] - shape.values["x_least"]
                    yield Contradiction(shape.row, comment.comment, size.size, along_x, UNEVEN, size.shape)

    def _is_one_part(self, comment: PartComment) -> bool:
        """The program of a title has one section, or makes one shape."""
        sections, program = self.trace.mode.sections, self.trace.blocks.program
        is_of_program = program[sections.enter] == program[comment.row]
        if np.count_nonzero(is_of_program) == 1:
            return True
        levels = [
            level for level in (*self.finished.of_part, *self.finished.meant_of_part) if is_of_program[level.section]
        ]
        shapes = [shape for level in levels for shape in self._shapes_of(level)]
        from polarcheck.columns.metal.stated_sizes import are_alike

        return bool(shapes) and all(are_alike(shape, shapes[0]) for shape in shapes)

    def _beyond_diameter(self, comment: PartComment, shapes: list[Shape]) -> Iterator[Contradiction]:
        """A round that is larger than the diameter of the title, if nothing is turned to that diameter."""
        if np.isnan(comment.diameter) or self.bar.tools.turns_anything:
            return
        largest = comment.diameter + tolerance_of(comment.diameter)
        for shape in shapes:
            if shape.name == "circle" and not shape.inside and shape.values["diameter"] > largest:
                yield Contradiction(shape.row, comment.comment, comment.diameter, shape.values["diameter"], shape.name)
                return

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
        bottom = folded(np.minimum, section[chosen], z[chosen], len(self.trace.mode.sections), np.inf)
        bottoms = bottom[np.isfinite(bottom)]
        if bottoms.min() >= 0 or _is_depth(depth, np.subtract.outer(self._faces(~of_comment), bottoms)).any():
            return
        row = int(chosen[np.argmin(z[chosen])])
        yield Contradiction(row, comment.comment, depth, -float(bottoms.min()), DEPTH)

    def _faces(self, rows: Mask) -> Floats:
        """Every Z to which these rows cut, and Z0: a depth may be meant from any of these faces."""
        trace = self.trace
        ends = np.append(trace.path.z[rows & trace.axes.at_feed], trace.path.z_of_cycles[rows])
        return different(np.append(np.nan_to_num(ends), 0.0))

    # ---- bars ----

    def _bars(self) -> Iterator[Contradiction]:
        """The bar of a comment that is smaller than what the program turns, or than its part."""
        sections = self.trace.mode.sections
        if not 0 < len(sections) <= _MOST_SECTIONS or not self.stock_comments.of_program:
            return
        comment = int(self.stock_comments.comment[int(sections.enter[0])])
        if comment < 0:
            return
        from polarcheck.columns.metal.stated_bars import StatedBars

        bars = StatedBars(self.trace, self.stock_comments, self.bar, self.finished)
        yield from (Contradiction(row, comment, bars.stated, made, TURNED) for row, made in bars.turned())
        yield from (Contradiction(row, comment, bars.stated, made, BEYOND) for row, made in bars.beyond())


def _is_depth(depth: float, value: Floats) -> Mask:
    return np.asarray(np.abs(value - depth) <= max(_DEPTH_TOLERANCE, _DEPTH_SHARE * depth))


def _has_walls_of(sizes: Sequence[StatedShape], walls: Curves) -> bool:
    """
    A cheap test: straight walls lie at half of one of these sizes from the axis, all that it has, and all as far.

    Then some shape has this size.
    """
    if not sizes:
        return False
    along = walls.end - walls.start
    is_side = ~walls.is_arc & walls.is_known & (np.abs(along) > _SHORTEST)
    direction = along[is_side] / np.abs(along[is_side])
    distance = np.abs((walls.start[is_side] * direction.conj()).imag)
    for size in sizes:
        at_size = np.abs(2 * distance - size.size) <= tolerance_of(size.size)
        angle = np.rint(np.degrees(np.angle(direction[at_size]))) % 360
        is_even = at_size.any() and np.ptp(distance[at_size]) <= _SAME
        if is_even and len(different(angle)) == SIDES_OF.get(size.shape, -1):
            return True
    return False
