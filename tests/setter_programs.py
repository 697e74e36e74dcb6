"""
Sound programs as setters and CAM posts write them, drawn at random.

    program = drawn(7)
    program.text(), program.machine, program.radii

A program mills contours of milled_shapes in one of the LAYOUTS, in the words of one of the DIALECTS; each block knows
its role, so that a slip can be made in it.
"""

from __future__ import annotations

import math
import random
from typing import NamedTuple

from milled_shapes import (
    SHAPES,
    Contour,
    Draw,
    Grid,
    Piece,
    first_direction,
    last_direction,
    led,
    mirrored,
    shifted,
)
from setter_dialects import DIALECTS, Dialect
from setter_pen import Line, Pen, Style


class Program(NamedTuple):
    """
    A program, what it is run with, and what is known of it.

    radii: of the cutters by offset number [mm]. bar: the diameter that the cutters meet [mm]. stock: what `[stock]`
    says, or None. evidence: see milled_shapes, and "repeated" where a contour is written twice, "steps"
    where three depths are equally far apart, "bar" where the program or the job says the bar. size: across the flats
    of a hexagon or square [mm]. reach: the diameter that holds the contour [mm].
    """

    seed: int
    family: str
    dialect: Dialect
    inch: bool
    lines: tuple[Line, ...]
    radii: dict[int, float]
    bar: float
    stock: float | None
    evidence: frozenset[str]
    style: Style
    size: float
    reach: float

    @property
    def machine(self) -> str:
        return self.dialect.machine

    def text(self) -> str:
        return "\n".join(line.text for line in self.lines) + "\n"

    def tools(self) -> list[str]:
        """As --tool takes them, in the program's own units."""
        return [f"{offset}:radius={radius / self.scale:.9g},nose=0" for offset, radius in self.radii.items()]

    @property
    def scale(self) -> float:
        return 25.4 if self.inch else 1.0

    def changed(self, index: int, *texts: str) -> Program:
        """With other blocks in place of one."""
        line = self.lines[index]
        blocks = (*self.lines[:index], *(line._replace(text=text) for text in texts), *self.lines[index + 1 :])
        return self._replace(lines=blocks)


class Cut(NamedTuple):
    """
    A contour to be milled: by which tool, to which depths [mm, below 0], at which angle of C [deg], and how.

    wrong: the number of a pass that mills another contour, and that contour; only where how is "ramps".
    """

    contour: Contour
    tool: int
    depths: tuple[float, ...]
    angle: float | None = None
    how: str = "ramps"
    approach: complex | None = None
    wrong: tuple[int, Contour] | None = None


FANUC = ("fanuc", "fanuc-16i", "fanuc-30i", "doosan", "colchester")
OPEN_SHAPES = ("one_flat", "two_flats", "slot", "keyway")
BOSSES = (
    "hexagon",
    "square",
    "octagon",
    "many_sides",
    "hexagon_turned",
    "d_shape",
    "double_d",
    "round_boss",
    "eccentric",
    "rectangle",
    "obround",
    "cam",
    "free_contour",
    "cross",
    "keyed_hexagon",
    "keyed_rectangle",
    "free_polygon",
    "lobes",
)
POCKETS = ("pocket", "round_pocket", "pocket_aside")
LAYOUTS = {
    "single": (*BOSSES, *OPEN_SHAPES, *POCKETS),
    "depths": (*BOSSES, *OPEN_SHAPES, *POCKETS),
    "one ramp": (*BOSSES, *POCKETS),
    "rough and finish": (*BOSSES, "pocket", "round_pocket"),
    "roughing passes": (*BOSSES, "pocket", "round_pocket"),
    "indexed": ("one_flat", "keyway", "pocket_aside"),
    "macro depths": (*BOSSES, *POCKETS),
    "macro polygon": ("hexagon", "octagon"),
    "subprogram": (*BOSSES, *POCKETS),
    "subprogram indexed": ("one_flat", "keyway", "pocket_aside"),
    "center path": (*BOSSES, "slot", "keyway", *POCKETS),
    "boss and pocket": ("hexagon", "square", "octagon", "double_d", "round_boss"),
    "island": ("round_pocket",),
    "spring pass": (*BOSSES, "pocket", "round_pocket"),
    "zigzag": ("zigzag",),
}
#: The layouts whose contours may begin and end on an extension, at a corner or beyond their start.
LED_LAYOUTS = ("single", "depths", "rough and finish", "roughing passes", "spring pass", "boss and pocket")
FAMILIES = [f"{shape}, {layout}" for layout, shapes in LAYOUTS.items() for shape in shapes]
MM_RADII = (2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
INCH_RADII = tuple(25.4 * share / 32 for share in (3, 4, 5, 6, 8, 10))


def _without_half_circles(contour: Contour) -> Contour:
    """The contour for a control that takes less than half a circle in one block."""
    pieces: list[Piece] = []
    for start, piece in zip(contour.points(), contour.pieces, strict=False):
        if piece.center is not None and abs(start + piece.end - 2 * piece.center) < 1e-6:
            turned = (start - piece.center) * (1j if piece.ccw else -1j)
            pieces.append(piece._replace(end=piece.center + turned))
        pieces.append(piece)
    return contour._replace(pieces=tuple(pieces))


def drawn(seed: int, machine: str = "", family: str = "", lead: str = "") -> Program:
    """The program of a seed; lead: "corner", "extension" or "overlap", on contours and layouts that admit it."""
    draw = random.Random(f"{seed} {family}")  # noqa: S311 - programs that can be written again
    family = family or FAMILIES[seed % len(FAMILIES)]
    shape, _, layout = family.partition(", ")
    dialect = DIALECTS[machine or draw.choice([*DIALECTS, "fanuc", "fanuc", "fanuc-30i", "haas-lathe"])]
    while not _can(dialect, layout):
        if machine:
            family = draw.choice(FAMILIES)
            shape, _, layout = family.partition(", ")
        else:
            dialect = DIALECTS[draw.choice([*DIALECTS])]
    inch = draw.choice(dialect.units) == "inch" if draw.random() < 0.35 or "mm" not in dialect.units else False
    grid = _grid(draw, inch)
    contour = SHAPES[shape](draw, grid)
    if not dialect.centers:
        contour = _without_half_circles(contour)
    is_closed_boss = contour.closed and contour.side == "right"
    repeats = draw.random() < 0.25
    style = Style(
        repeats,
        repeats and draw.random() < 0.4,
        draw.random() < 0.25,
        dialect.centers and draw.random() < 0.5,
        not repeats and layout != "macro polygon" and draw.random() < 0.15,
        draw.random() < 0.2,
        draw.random() < 0.15,
        draw.choice(("normal", "normal", "aside", "arc"))
        if is_closed_boss and layout not in ("center path", "macro polygon", "zigzag")
        else "normal",
        contour.side == "left" or draw.random() < 0.75,
        draw.random() < 0.2,
    )
    if dialect.machine == "siemens-transmit":
        style = style._replace(packed=False)
    if dialect.machine == "turning-center" or layout.startswith(("macro", "subprogram")):
        style = style._replace(repeats_z=False)
    if lead and layout in LED_LAYOUTS:
        style = style._replace(lead=lead)
    return Maker(seed, family, layout, dialect, style, inch, contour, draw, grid).program()


def _can(dialect: Dialect, layout: str) -> bool:
    if layout.startswith(("macro", "subprogram")):
        return dialect.calls and (dialect.index or "indexed" not in layout)
    return dialect.index or layout != "indexed"


def _grid(draw: Draw, inch: bool) -> Grid:
    step = 25.4 / 32 if inch else 0.5

    def value(low: float, high: float) -> float:
        return max(round(draw.uniform(low, high) / step), math.ceil(low / step - 1e-9)) * step

    return value


class Maker:
    """Puts a program together."""

    def __init__(
        self,
        seed: int,
        family: str,
        layout: str,
        dialect: Dialect,
        style: Style,
        inch: bool,
        contour: Contour,
        draw: Draw,
        grid: Grid,
    ) -> None:
        self.seed, self.family, self.layout, self.dialect, self.style = seed, family, layout, dialect, style
        self.inch, self.contour, self.draw, self.grid = inch, contour, draw, grid
        self.pen = Pen(dialect, style, inch)
        self.feed = draw.choice((80.0, 100.0, 120.0, 150.0, 200.0)) if not inch else 25.4 * draw.choice((3, 4, 5, 6, 8))
        self.fast = draw.choice((800.0, 1000.0, 1500.0)) if not inch else 25.4 * draw.choice((30, 40, 60))
        self.safe = 2.0 if not inch else 2.54
        self.radii: dict[int, float] = {}
        self.subprogram: list[Line] = []
        is_fanuc = dialect.machine in FANUC
        self.goes_home = is_fanuc and draw.random() < 0.2
        self.sets_offsets = is_fanuc and layout != "macro polygon" and draw.random() < 0.1
        self.is_safe = draw.random() < 0.25
        self.coolant = draw.random() < 0.2

    def program(self) -> Program:
        draw, contour = self.draw, self.contour
        if draw.random() < 0.4 and self.layout not in ("macro polygon", "zigzag"):
            contour = mirrored(contour)
        step = 25.4 / 16 if self.inch else 1.0
        self.bar = (
            contour.bar
            if contour.name in ("D", "round with two flats", "one flat", "two flats", "slot", "keyway", "zigzag")
            else math.ceil((contour.bar + draw.uniform(0.2, 2)) / step) * step
        )
        cuts = self.cuts(contour)
        self.turned = draw.choice(("", "", "lines", "cycle" if self.dialect.cycles else "lines"))
        source = (
            draw.choice(("stock", "stock", "comment", "", "")) if not self.turned else draw.choice(("", "", "comment"))
        )
        stock = self.bar if source == "stock" else None
        self.head(source)
        if self.turned:
            self.turning(min(min(cut.depths) for cut in cuts))
        self.size_of = next((cut.tool for cut in reversed(cuts) if cut.contour == contour), 0) * (draw.random() < 0.6)
        tool = 0
        for number, cut in enumerate(cuts):
            if cut.tool != tool:
                if tool:
                    self.away("away")
                self.call(cut.tool, number)
                tool = cut.tool
            self.pen.section = number
            self.cut(cut, cuts[number - 1] if number else None)
            self.pen.section = -1
        if draw.random() < 0.12 and self.dialect.index:
            self.away("away")
            self.holes()
        self.end()
        written = [
            tuple(line.text for line in self.pen.lines if line.section == number and line.role == "contour")
            for number in range(len(cuts))
        ]
        is_repeated = (
            len(set(written)) < len(written)
            or self.layout == "depths"
            or (self.layout == "one ramp" and len(cuts[0].depths) > 1)
        )
        evidence = set(contour.evidence) | ({"repeated"} if is_repeated else set())
        depths = [depth for cut in cuts for depth in cut.depths]
        if len(depths) > 2 and self.layout not in ("macro depths", "rough and finish"):
            evidence.add("steps")
        if self.turned or source:
            evidence.add("bar")
        lines = self.pen.lines + self.subprogram
        if self.style.numbers:
            lines = _numbered(lines, draw)
        return Program(
            self.seed,
            self.family,
            self.dialect,
            self.inch,
            tuple(lines),
            self.radii,
            self.bar,
            stock,
            frozenset(evidence),
            self.style,
            self.contour.size[1] if self.contour.size else 0.0,
            2 * max(abs(point) for point in contour.points()),
        )

    # ---- what is milled ----

    def cutter(self, contour: Contour, offset: int, least: float = 0.0, most: float = math.inf) -> float:
        choices = INCH_RADII if self.inch else MM_RADII
        arcs = [
            abs(piece.end - piece.center)
            for piece in contour.pieces
            if piece.center is not None and piece.ccw == (contour.side == "left")
        ]
        most = min([most, 8.0, *(0.92 * arc for arc in arcs)])
        if contour.name in ("slot", "keyway"):
            most = min(most, 0.75 * abs(contour.start.imag))
        fits = [radius for radius in choices if least <= radius <= most]
        if not fits:
            fits = [radius for radius in choices if radius <= most][-1:] or [choices[0]]
        self.radii[offset] = self.draw.choice(fits)
        return self.radii[offset]

    def cuts(self, contour: Contour) -> list[Cut]:
        draw, layout = self.draw, self.layout
        step = self.grid(1.5, 3)
        deep = self.grid(3, 7)
        steps = tuple(-step * (number + 1) for number in range(draw.choice((2, 3))))
        first = draw.choice((1, 1, 2, 3, 9))
        room = (self.bar / 2 - min(abs(point) for point in contour.points())) / 2
        least = room if contour.closed and not contour.is_pocket else 0.0
        most = 4.0 if contour.name in ("pocket", "round pocket") else math.inf
        radius = self.cutter(contour, first, least, most)
        if layout in ("depths", "one ramp", "macro depths", "subprogram"):
            return [Cut(contour, first, steps, how={"depths": "ramps", "one ramp": "one ramp"}.get(layout, layout))]
        if layout == "rough and finish":
            second = first + draw.choice((1, 2))
            self.cutter(contour, second, 0.0, most)
            return [Cut(shifted(contour, 0.5), first, steps), Cut(contour, second, steps[-1:])]
        if layout == "roughing passes":
            apart = round(radius * draw.uniform(0.6, 1.2), 1)
            arcs = [
                abs(piece.end - piece.center)
                for piece in contour.pieces
                if piece.center is not None and piece.ccw == (contour.side == "left")
            ]
            apart = min([apart, *(round(arc - radius * 1.05, 2) for arc in arcs)])
            if not contour.is_pocket:
                deepest = self.bar / 2 - min(abs(point) for point in shifted(contour, 0.0).points())
                if contour.bar < self.bar:
                    unit = 25.4 / 16 if self.inch else 1.0
                    self.bar += 2 * math.ceil(apart / unit) * unit
                else:
                    apart = min(apart, round(0.6 * deepest, 1))
            apart = min(apart, 0.3 * min(abs(point) for point in contour.points())) if contour.is_pocket else apart
            return [Cut(shifted(contour, apart), first, (-deep,)), Cut(contour, first, (-deep,))]
        if layout in ("indexed", "subprogram indexed"):
            count = draw.choice((2, 3, 4)) if contour.name != "pocket aside" else draw.choice((2, 3))
            how = "ramps" if layout == "indexed" else "subprogram"
            return [Cut(contour, first, (-deep,), 360.0 / count * number, how) for number in range(count)]
        if layout == "center path":
            return [Cut(shifted(contour, radius), first, (-deep,), how="center path")]
        if layout == "spring pass":
            return [Cut(contour, first, (-deep, -deep), how=draw.choice(("ramps", "one ramp")))]
        if layout == "zigzag":
            self.cutter(contour, first, 2.6)
            return [Cut(contour, first, draw.choice(((-step,), steps)), how="center path")]
        if layout == "macro polygon":
            return [Cut(contour, first, (-deep,), how="macro polygon")]
        if layout == "boss and pocket":
            inner = min(abs(point) for point in contour.points())
            size = math.floor(inner * draw.uniform(0.5, 0.65))
            second = first + 1
            pocket = Contour(
                "round pocket",
                complex(size, 0),
                tuple(Piece(size * 1j**number, 0j) for number in (1, 2, 3, 4)),
                "left",
                True,
                frozenset(),
                2 * size,
            )
            self.cutter(pocket, second, 0.0, (size - 2.5) / 1.0 - 0.5)
            return [Cut(contour, first, (-deep,)), Cut(pocket, second, (-deep / 2,))]
        if layout == "island":
            outer, inner = abs(contour.start), math.floor(abs(contour.start) * 0.4)
            self.cutter(contour, first, 0.0, (outer - inner) / 2.6)
            island = Contour(
                "round",
                complex(inner, 0),
                tuple(Piece(inner * 1j**number, 0j) for number in (1, 2, 3, 4)),
                "right",
                True,
                frozenset({"tangent"}),
                2 * inner,
            )
            between = complex((outer + inner) / 2, 0)
            return [Cut(contour, first, (-deep,), approach=between), Cut(island, first, (-deep,), approach=between)]
        return [Cut(contour, first, (-deep,))]

    # ---- its blocks ----

    def head(self, source: str) -> None:
        pen, draw, dialect = self.pen, self.draw, self.dialect
        if dialect.machine != "siemens-transmit":
            pen.write("head", "%")
            pen.write("head", f"O{1000 + self.seed % 8000}")
        if source == "comment":
            pen.remark(
                draw.choice(("BAR DIA {}", "STOCK D{}", "BAR D{}")).format(
                    self.plain(self.raw_bar() if self.turned else self.bar)
                ),
                "bar",
            )
        pen.write("head", dialect.inch if self.inch else dialect.metric, *dialect.head)
        if self.is_safe and dialect.off == "G13.1":
            pen.write("head", "G13.1")

    def plain(self, value: float) -> str:
        return f"{value / self.pen.scale:.4g}"

    def raw_bar(self) -> float:
        step = 25.4 / 8 if self.inch else 5.0
        return (math.floor(self.bar / step + 0.2) + 1) * step

    def turning(self, deepest: float) -> None:
        pen, dialect = self.pen, self.dialect
        raw, scale = self.raw_bar(), 2 if dialect.diameter_outside else 1
        low, out = deepest - self.grid(8, 15), raw / 2 + 2

        def x(radius: float) -> str:
            return "X" + pen.number(radius * scale)

        def z(value: float) -> str:
            return "Z" + pen.height(value)

        feed = "F.2" if not self.inch else "F.008"
        number = 11
        pen.write("turn", self.tool_word(number), pen.comment("OD TURNING"))
        pen.write("turn", dialect.per_revolution, "G97", "S1200", "M3")
        pen.write("turn", "G0", x(out), z(self.safe))
        if self.turned == "cycle":
            pen.write("turn", "G94", x(-0.8), z(0), feed)
            kind = self.draw.choice(("G90", "G71"))
            if kind == "G90":
                pen.write("turn", "G90", x((raw + self.bar) / 4), z(low), feed)
                pen.write("turn", x(self.bar / 2))
            else:
                one = pen.number(1.5)
                pen.write("turn", "G71", "U" + one, "R" + pen.number(0.5))
                pen.write("turn", "G71", "P100", "Q200", "U" + pen.number(0.5), "W" + pen.number(0.1), feed)
                pen.write("turn", "N100", "G0", x(self.bar / 2))
                pen.write("turn", "G1", z(low))
                pen.write("turn", "N200", x(raw / 2 + 1))
                pen.write("turn", "G70", "P100", "Q200")
        else:
            pen.write("turn", "G0", z(0))
            pen.write("turn", "G1", x(-0.8), feed)
            pen.write("turn", "G0", z(self.safe))
            pen.write("turn", x(self.bar / 2))
            pen.write("turn", "G1", z(low))
            pen.write("turn", x(raw / 2 + 1))
        pen.write("turn", "G0", x(raw / 2 + 40), z(80))
        pen.write("turn", "M5")

    def tool_word(self, number: int) -> str:
        if self.dialect.machine == "siemens-transmit":
            return f"T{number} D1"
        if self.dialect.machine == "okuma-osp":
            return f"T{number:02}{number:02}{number:02}"
        return f"T{number:02}{number:02}"

    def call(self, tool: int, number: int) -> None:
        pen, dialect, draw = self.pen, self.dialect, self.draw
        radius = self.radii[tool]
        remark = ""
        if draw.random() < 0.5:
            size = self.plain(2 * radius) if not self.inch else f"{2 * radius / 25.4:.4g}"
            remark = pen.comment(draw.choice(("END MILL D{}", "EM D{}", "D{} END MILL")).format(size))
        pen.lines.append(Line(" ".join(word for word in (self.tool_word(tool), remark) if word), "call", -1))
        size = self.contour.size
        if size and self.size_of == tool and self.layout not in ("macro polygon", "center path"):
            pen.remark(f"{size[0]} {self.plain(size[1])} AF", "size")
        if number == 0 or self.turned:
            pen.write("start", dialect.per_minute)
        pen.feed = ""
        if dialect.engage:
            if not self.turned:
                pen.write("start", "M5")
            pen.write("start", dialect.engage)
        if dialect.reference:
            pen.write("start", dialect.reference)
        if self.sets_offsets:
            pen.write("offset", "G10", f"P{tool}", "R" + pen.number(radius))
        pen.lines.append(Line(dialect.spindle, "start", -1))
        if self.coolant:
            pen.write("start", "M8")

    def away(self, role: str) -> None:
        if self.dialect.spindle_off:
            self.pen.write("start", self.dialect.spindle_off)
        if self.goes_home:
            self.pen.write(role, "G28", "U0", "W0")
        else:
            self.pen.rapid(role, self.bar / 2 + 50, 80.0)

    def holes(self) -> None:
        """Holes along Z on a circle, drilled outside of the mode by another live tool."""
        pen, dialect, draw = self.pen, self.dialect, self.draw
        pen.write("drill", self.tool_word(12), pen.comment("DRILL D4.2" if not self.inch else "DRILL D.166"))
        pen.lines.append(Line(dialect.spindle, "start", -1))
        count = draw.choice((2, 3, 4))
        pen.motion = ""
        for number in range(count):
            pen.rapid("drill", c=360.0 / count * number)
            if not number:
                pen.rapid("drill", self.bar * 0.3, self.safe)
            pen.write("drill", "G1", "Z" + pen.height(-12.0), "F50." if not self.inch else "F2.")
            pen.write("drill", "G0", "Z" + pen.height(self.safe))
        self.pen.feed = ""

    def end(self) -> None:
        if self.dialect.release and self.dialect.release != self.dialect.spindle_off:
            self.pen.rapid("away", None, 50.0)
            if self.dialect.spindle_off:
                self.pen.write("start", self.dialect.spindle_off)
            self.pen.write("start", self.dialect.release)
            self.pen.rapid("away", self.bar / 2 + 50, 80.0)
        else:
            self.away("away")
        self.pen.write("end", "M30")
        if self.dialect.machine != "siemens-transmit" and not self.subprogram:
            self.pen.write("end", "%")

    def cut(self, cut: Cut, before: Cut | None) -> None:
        """A section."""
        pen, style, radius = self.pen, self.style, self.radii[cut.tool]
        if cut.how == "ramps":
            cut = cut._replace(contour=led(cut.contour, style.lead, radius))
        contour = cut.contour
        normal = first_direction(contour) * (-1j if contour.side == "right" else 1j)
        start, finish = self.approach(cut, normal, radius)
        inside = contour.is_pocket
        far = (
            max(self.bar / 2 + radius + self.grid(3, 8), start.real + 2)
            if not inside and cut.approach is None
            else max(start.real, 2.0)
        )
        if contour.name in ("slot", "keyway"):
            far = start.real
        from_above = (
            style.from_above
            or len(cut.depths) > 1
            or inside
            or cut.approach is not None
            or cut.how not in ("ramps", "center path")
        )
        angle = cut.angle or 0.0
        if before is not None and before.tool == cut.tool and cut.angle is not None and cut.angle:
            pen.rapid("index", c=angle)
            pen.rapid("position", far, self.safe)
        elif self.draw.random() < 0.5:
            pen.rapid("position", far, self.safe, angle)
        else:
            pen.rapid("position angle", c=angle)
            pen.rapid("position", far, self.safe)
        if not from_above:
            pen.rapid("plunge outside", z=cut.depths[0])
        pen.enter(far)
        if cut.how == "macro polygon":
            self.macro_polygon(cut, far)
        else:
            self.passes(cut, start, finish, normal, radius, from_above)
        if from_above and not (style.leaves_at_depth and not inside and cut.approach is None):
            pen.depth(self.safe, self.fast, "retract")
            if self.is_safe and cut.how in ("center path", "subprogram"):
                pen.write("safe", "G40")
            pen.leave()
        else:
            pen.leave()
            pen.rapid("retract", z=self.safe)
        if self.draw.random() < 0.5 or cut.angle is not None:
            pen.rapid("clear", z=20.0)

    def approach(self, cut: Cut, normal: complex, radius: float) -> tuple[complex, complex]:
        """Where the cutter stands before and behind the contour, outside of the part."""
        contour = cut.contour
        if cut.approach is not None:
            return cut.approach, cut.approach
        if contour.name in ("slot", "keyway"):
            far = complex(abs(contour.start.real) + radius + 2, 0)
            return far, far
        if contour.is_pocket:
            start = contour.start + normal * (radius + 0.75)
            return start, contour.pieces[-1].end + normal * (radius + 0.75)
        if not contour.closed:
            last = last_direction(contour) * (-1j if contour.side == "right" else 1j)
            end = contour.pieces[-1].end
            return contour.start + normal * (radius + 2), end + last * (radius + 2)
        away = radius + 2.0
        while abs(contour.start + normal * away) < self.bar / 2 + radius + 1.5:
            away += 1
        start = contour.start + normal * away
        digits = 3 if not self.inch else 4
        finish, last = start, last_direction(contour)
        if abs(last - first_direction(contour)) > 1e-3 or abs(contour.pieces[-1].end - contour.start) > 1e-6:
            finish = contour.pieces[-1].end + last * (-1j if contour.side == "right" else 1j) * away
        return complex(round(start.real, digits), round(start.imag, digits)), finish

    def passes(
        self, cut: Cut, start: complex, finish: complex, normal: complex, radius: float, from_above: bool
    ) -> None:
        pen, contour = self.pen, cut.contour
        code = "" if cut.how == "center path" else "G42" if contour.side == "right" else "G41"
        lead, first, last = self.leads(contour, normal, radius)
        if lead:
            start = first + normal * max(radius + 2.0, abs(start - contour.start) - abs(first - contour.start))
            while abs(start) < self.bar / 2 + radius + 0.1:
                start += normal
            finish = start
        elif self.style.lead == "corner" and abs(first_direction(contour) - last_direction(contour)) > 1e-3:
            start -= first_direction(contour) * (radius + 1)
            finish += last_direction(contour) * (radius + 1)
        elif self.style.lead == "aside" and contour.closed and not contour.is_pocket and cut.approach is None:
            start -= first_direction(contour) * self.draw.choice((2.0, 3.0))
        self.go_to(start)
        feed = self.feed
        if cut.how in ("macro depths", "subprogram"):
            self.called(cut, code, lead, first, last, start, finish)
            return
        for number, depth in enumerate(cut.depths):
            if from_above:
                if number and abs(start - finish) > 1e-6 and cut.how != "one ramp":
                    pen.depth(self.safe, self.fast, "lift")
                    self.go_around(start, finish)
                pen.depth(depth, feed / 2 if contour.is_pocket or cut.approach else self.fast)
            wrong = cut.wrong[1] if cut.wrong and cut.wrong[0] == number else None
            if cut.how != "one ramp" or number == 0:
                pen.move("ramp" if code else "lead", Piece(wrong.start if wrong and not lead else first), feed, code)
            for piece in [lead] if lead and (cut.how != "one ramp" or not number) else []:
                pen.move("contour", piece, feed)
            for piece in (wrong or contour).pieces:
                pen.move("contour", piece, feed)
            if cut.how == "one ramp" and number + 1 < len(cut.depths):
                continue
            if last is not None:
                pen.move("contour", last, feed)
            pen.move("cancel" if code else "lead", Piece(finish), self.fast, "G40" if code else "")

    def leads(self, contour: Contour, normal: complex, radius: float) -> tuple[Piece | None, complex, Piece | None]:
        """An arc onto the contour, where it begins, and the arc that leaves it."""
        if self.style.lead != "arc" or not contour.closed or contour.is_pocket:
            return None, contour.start, None
        size = radius + 2.0
        way = first_direction(contour)
        center = contour.start + normal * size
        turn = contour.side != "right"
        return (
            Piece(contour.start, center, turn),
            center - way * size,
            Piece(center + last_direction(contour) * size, center, turn),
        )

    def go_to(self, place: complex) -> None:
        pen = self.pen
        if abs(place.imag - pen.at.imag) > 1e-6 and abs(place.real - pen.at.real) > 1e-6 and abs(place) < self.bar:
            pen.move("approach", Piece(complex(pen.at.real, place.imag)), self.fast)
        if abs(place - pen.at) > 1e-6:
            pen.move("approach", Piece(place), self.fast)

    def go_around(self, start: complex, finish: complex) -> None:
        """Above the part, from the end of an open contour to its start."""
        if start.real * finish.real < 0:
            self.pen.move(
                "approach", Piece(complex(finish.real, start.imag - math.copysign(6, -start.imag))), self.fast
            )
            self.pen.move("approach", Piece(complex(start.real, start.imag - math.copysign(6, -start.imag))), self.fast)
        self.pen.move("approach", Piece(start), self.fast)

    def called(
        self,
        cut: Cut,
        code: str,
        lead: Piece | None,
        first: complex,
        last: Piece | None,
        start: complex,
        finish: complex,
    ) -> None:
        """The contour in a subprogram, or in a loop over the depths."""
        pen, feed, steps = self.pen, self.feed, cut.depths
        down = feed / 2 if cut.contour.is_pocket else self.fast

        def contour() -> None:
            pen.feed = ""
            pen.x, pen.c = (pen.x_word(start.real), pen.number(start.imag)) if self.style.steps else ("", "")
            pen.move("ramp", Piece(first), feed, code)
            for piece in [*([lead] if lead else []), *cut.contour.pieces, *([last] if last else [])]:
                pen.move("contour", piece, feed)
            pen.move("cancel", Piece(finish), self.fast, "G40")

        if cut.how == "macro depths":
            pen.write("macro", "#1=0")
            pen.write("macro", f"WHILE[#1 LT {len(steps)}]DO1")
            pen.write("macro", "#1=#1+1")
            pen.write("plunge", pen.dialect.line, f"Z[-{pen.number(-steps[0])}*#1]", pen.feed_word(down))
            pen.motion = pen.dialect.line
            contour()
            pen.write("macro", "END1")
            return
        for depth in steps:
            pen.depth(depth, down)
            pen.write("call subprogram", "M98 P100")
        if not self.subprogram:
            lines, pen.lines, section, pen.section = pen.lines, [], pen.section, 0
            pen.lines.append(Line("O100", "head"))
            pen.motion = ""
            contour()
            pen.lines += [Line("M99", "end"), Line("%", "end")]
            self.subprogram, pen.lines, pen.section = pen.lines, lines, section
        pen.motion, pen.feed = "", ""
        pen.at = finish

    def macro_polygon(self, cut: Cut, far: float) -> None:
        pen, contour, feed = self.pen, cut.contour, self.feed
        count = 6 if "hexagon" in self.family else 8
        scale = 2 if self.dialect.diameter_inside else 1
        across = 2 * min(abs(point) for point in contour.points())
        c, deep = self.dialect.virtual, cut.depths[0]
        for text in (f"#1={count}", f"#2={pen.number(across)}", "#3=#2/2*TAN[180/#1]", "#4=0"):
            pen.write("macro", text)
        pen.depth(deep, self.fast)
        one = "#2" if scale == 2 else "[#2/2]"
        pen.write("ramp", "G42", f"X{one}", f"{c}0", pen.feed_word(feed))
        pen.write("macro", "WHILE[#4 LT #1]DO1")
        pen.write("macro", "#5=#4*360/#1")
        pen.write(
            "contour", f"X[#2{'' if scale == 2 else '/2'}*COS[#5]-{scale}*#3*SIN[#5]]", f"{c}[#2/2*SIN[#5]+#3*COS[#5]]"
        )
        pen.write("macro", "#4=#4+1")
        pen.write("macro", "END1")
        pen.write("contour", f"X{one}", f"{c}0")
        pen.write("cancel", "G40", "X" + pen.x_word(far), f"{c}0", pen.feed_word(self.fast))


def _numbered(lines: list[Line], draw: Draw) -> list[Line]:
    """With N words, but where a block has one already."""
    step = draw.choice((1, 10))
    numbered, number = [], 0
    for line in lines:
        if line.text.startswith(("%", "O", "N", "(", ";", "#", "W", "E")) or line.role == "turn":
            numbered.append(line)
            continue
        number += step
        numbered.append(line._replace(text=f"N{number} {line.text}"))
    return numbered
