"""
Parts with a [[part]] or a drawing each, and sound programs that mill them, drawn at random.

    plan = drawn_plan(7)
    program = plan.program()
    plan.features           # what must stand and what must be gone, by construction
    plan.tables(program)    # the same as [[part]] entries

A plan has features (a hexagon, a slot, three flats, ...), each milled by passes; tests/setter_programs.py writes the
blocks. A feature knows its contour in the frame of the part, where angles count from C0: that is the truth which
tests/part_judge.py compares metal with.
"""

from __future__ import annotations

import cmath
import math
import random
from collections.abc import Callable
from typing import Any, NamedTuple

import shapely  # type: ignore[import-untyped]
from milled_shapes import SHAPES, Contour, Draw, Grid, Piece, mirrored, polygon, ring, shifted
from setter_dialects import DIALECTS, Dialect
from setter_pen import Style
from setter_programs import INCH_RADII, MM_RADII, Cut, Maker, Program

#: Larger than every bar [mm].
FAR = 500.0
NAMES = {
    3: "triangle", 4: "square", 5: "pentagon", 6: "hexagon", 7: "heptagon", 8: "octagon", 9: "nonagon", 10: "decagon",
    11: "hendecagon", 12: "dodecagon",
}  # fmt: skip
#: Shapes of milled_shapes that are drawn, since no [[part]] has them.
FREE = (
    "obround",
    "cam",
    "free_contour",
    "cross",
    "keyed_hexagon",
    "keyed_rectangle",
    "free_polygon",
    "lobes",
    "keyway",
)


class Form(NamedTuple):
    """
    A shape with its numbers, in the frame of its section.

    kind: a kind of BUILDERS. values: lengths [mm], angles [rad]. corner: "", "arcs" or "chamfers". reverse: travelled
    clockwise.
    """

    kind: str
    values: dict[str, float]
    corner: str = ""
    reverse: bool = False

    def with_values(self, **values: float) -> Form:
        return self._replace(values={**self.values, **values})

    def contour(self) -> Contour:
        contour = BUILDERS[self.kind](self)
        return mirrored(mirrored_shape(contour)) if self.reverse else contour

    @property
    def center(self) -> complex:
        return complex(self.values.get("center", 0.0), 0)


class Feature(NamedTuple):
    """
    What the part has.

    form: of one of its contours, in the frame of a section. angles: of C at the entry of its sections [deg]; several
    of flats by indexing. z: of its bottom [mm]. keys: of its [[part]], in the frame of the part; drawing says so.
    """

    form: Form
    angles: tuple[float, ...]
    z: float
    keys: dict[str, Any]

    @property
    def is_drawn(self) -> bool:
        return "drawing" in self.keys

    @property
    def is_pocket(self) -> bool:
        return self.form.contour().is_pocket

    @property
    def is_round(self) -> bool:
        return self.form.kind == "circle"

    def stands(self) -> Any:
        """What may stand at its depths: all around a pocket, all within a boss; in the frame of the part."""
        area = shapely.Point(0, 0).buffer(FAR)
        for angle in self.angles:
            area = area.intersection(turned_area(region(self.form.contour()), angle))
        return area


class Pass(NamedTuple):
    """
    How a contour is milled.

    feature: its number. form: what is milled. angle: of C at entry [deg]. tool: offset number. radius: of it [mm].
    depths: in their order [mm]. how: as of Cut. offset: the contour is milled at this distance, as roughing [mm].
    wrong: the number of the pass that mills another contour, and that. contour: in place of that of the form.
    """

    feature: int
    form: Form
    angle: float
    tool: int
    radius: float
    depths: tuple[float, ...]
    how: str = "ramps"
    offset: float = 0.0
    wrong: tuple[int, Contour] | None = None
    contour: Contour | None = None

    def cut(self, is_index: bool) -> Cut:
        contour = self.milled(self.contour or self.form.contour())
        wrong = (self.wrong[0], self.milled(self.wrong[1])) if self.wrong else None
        return Cut(contour, self.tool, self.depths, self.angle if is_index else None, self.how, wrong=wrong)

    def milled(self, contour: Contour) -> Contour:
        by = self.offset + (self.radius if self.how == "center path" else 0.0)
        return shifted(contour, by) if by else contour


class Plan(NamedTuple):
    """
    A part and the way it is milled.

    bar: diameter [mm]. units: of the job, "mm", "inch" or "" for those of the program. tolerance: [mm], NaN for none.
    """

    seed: int
    family: str
    features: tuple[Feature, ...]
    passes: tuple[Pass, ...]
    dialect: Dialect
    style: Style
    inch: bool
    bar: float
    units: str
    tolerance: float

    def program(self) -> Program:
        return _PartMaker(self).program()

    @property
    def allowed(self) -> float:
        return 0.02 if math.isnan(self.tolerance) else self.tolerance


class _PartMaker(Maker):
    """Writes what a plan says, in its style."""

    def __init__(self, plan: Plan) -> None:
        draw = random.Random(f"part {plan.seed}")  # noqa: S311 - programs that can be written again
        contour = plan.passes[0].form.contour()._replace(size=None)
        family, layout = plan.family, "subprogram" if plan.passes[0].how == "subprogram" else "single"
        super().__init__(
            plan.seed, family, layout, plan.dialect, plan.style, plan.inch, contour, draw, grid_of(draw, plan.inch)
        )
        self.plan = plan

    def cuts(self, contour: Contour) -> list[Cut]:
        self.bar = self.plan.bar
        self.radii.update({one.tool: one.radius for one in self.plan.passes})
        return [one.cut(self.plan.dialect.index) for one in self.plan.passes]


# ---- shapes ----


def grid_of(draw: Draw, inch: bool) -> Grid:
    step = 25.4 / 32 if inch else 0.5

    def value(low: float, high: float) -> float:
        return max(round(draw.uniform(low, high) / step), math.ceil(low / step - 1e-9)) * step

    return value


def mirrored_shape(contour: Contour) -> Contour:
    """Mirrored at the X axis, travelled from the same start in the same sense of the walls."""
    pieces, points = [], contour.points()
    for piece, start in zip(contour.pieces[::-1], points[-2::-1], strict=True):
        center = None if piece.center is None else piece.center.conjugate()
        pieces.append(Piece(start.conjugate(), center, piece.ccw))
    return contour._replace(start=points[-1].conjugate(), pieces=tuple(pieces))


def moved(contour: Contour, turn: float = 0.0, by: complex = 0j) -> Contour:
    spoke = cmath.rect(1, turn)

    def place(point: complex) -> complex:
        return point * spoke + by

    pieces = tuple(
        piece._replace(end=place(piece.end), center=None if piece.center is None else place(piece.center))
        for piece in contour.pieces
    )
    return contour._replace(start=place(contour.start), pieces=pieces)


def points_of(contour: Contour, sagitta: float = 5e-4) -> list[complex]:
    """The contour as a polyline."""
    points = [contour.start]
    for piece in contour.pieces:
        start = points[-1]
        if piece.center is None:
            points.append(piece.end)
            continue
        spoke = start - piece.center
        sweep = cmath.phase((piece.end - piece.center) / spoke) % math.tau
        sweep = math.tau if sweep < 1e-9 else sweep
        sweep = sweep if piece.ccw else sweep - math.tau
        count = max(4, math.ceil(abs(sweep) / math.sqrt(8 * sagitta / abs(spoke))))
        points += [piece.center + spoke * cmath.exp(1j * sweep * number / count) for number in range(1, count)]
        points.append(piece.end)
    return points


def region(contour: Contour) -> Any:
    """What may stand: inside of a boss, outside of a pocket, on its side of open walls; up to FAR."""
    points = points_of(contour)
    if not contour.closed:
        first, last = points[1] - points[0], points[-1] - points[-2]
        points = [points[0] - first / abs(first) * FAR, *points[1:-1], points[-1] + last / abs(last) * FAR]
        away = (1j if contour.side == "right" else -1j) * FAR
        points += [points[-1] + away * last / abs(last), points[0] + away * first / abs(first)]
        if contour.name in ("slot", "keyway", "two flats"):
            points = points[:-2]
    area = shapely.Polygon([(point.real, point.imag) for point in points]).buffer(0)
    if contour.name in ("slot", "keyway") or contour.is_pocket:
        return shapely.Point(0, 0).buffer(FAR).difference(area)
    return area


def turned_area(area: Any, angle: float) -> Any:
    return shapely.affinity.rotate(area, angle, origin=(0, 0)) if angle else area


def _corners(form: Form) -> tuple[tuple[float, ...], float]:
    small = form.values.get("small", 0.0)
    return ((small,) if form.corner == "arcs" else ()), small if form.corner == "chamfers" else 0.0


def _closed(name: str, start: complex, pieces: list[Piece], side: str = "right") -> Contour:
    widest = max(abs(point) for point in [start, *(piece.end for piece in pieces)])
    return Contour(name, start, tuple(pieces), side, True, frozenset(), 2 * widest)


def _polygon(form: Form) -> Contour:
    values = form.values
    start, pieces = ring(polygon(int(values["sides"]), values["across"]), *_corners(form))
    pocket = bool(values.get("inside"))
    contour = _closed("pocket" if pocket else "sides", start, pieces, "left" if pocket else "right")
    return moved(contour, values.get("turn", 0.0), form.center)


def _rectangle(form: Form) -> Contour:
    values = form.values
    width, height = values["along"] / 2, values["across"] / 2
    corners = [complex(width, height), complex(-width, height), complex(-width, -height), complex(width, -height)]
    start, pieces = ring(corners, *_corners(form))
    pocket = bool(values.get("inside"))
    contour = _closed("pocket" if pocket else "rectangle", start, pieces, "left" if pocket else "right")
    return moved(contour, values.get("turn", 0.0), form.center)


def _circle(form: Form) -> Contour:
    radius, pocket = form.values["diameter"] / 2, bool(form.values.get("inside"))
    pieces = [Piece(form.center + radius * 1j**number, form.center) for number in (1, 2, 3, 4)]
    name = "round pocket" if pocket else "round"
    return _closed(name, form.center + radius, pieces, "left" if pocket else "right")


def _round_slot(form: Form) -> Contour:
    """Long in C where turn is 0."""
    radius, half = form.values["width"] / 2, (form.values["length"] - form.values["width"]) / 2
    up, down = 1j * half, -1j * half
    pieces = [
        Piece(up + radius), Piece(up + 1j * radius, up), Piece(up - radius, up), Piece(down - radius),
        Piece(down - 1j * radius, down), Piece(down + radius, down), Piece(complex(radius)),
    ]  # fmt: skip
    contour = _closed("pocket", complex(radius), pieces, "left")
    return moved(contour, form.values.get("turn", 0.0), form.center)


def _slot(form: Form) -> Contour:
    """Through, along X."""
    half, far = form.values["width"] / 2, form.values["far"]
    pieces = (Piece(complex(-far, half)), Piece(complex(-far, -half)), Piece(complex(far, -half)))
    return Contour("slot", complex(far, half), pieces, "left", False, frozenset(), 0.0)


def _flat(form: Form) -> Contour:
    """A wall at +X that ends beyond the bar."""
    flat, half = form.values["distance"], form.values["half"]
    return Contour(
        "one flat", complex(flat, -half), (Piece(complex(flat, half)),), "right", False, frozenset(), 2 * flat
    )


def _two_flats(form: Form) -> Contour:
    """Both in one section, with an arc around the bar between them."""
    flat, beyond = form.values["distance"], form.values["beyond"]
    half = math.sqrt(beyond * beyond - flat * flat)
    pieces = (Piece(complex(flat, half)), Piece(complex(-flat, half), 0j), Piece(complex(-flat, -half)))
    return Contour("two flats", complex(flat, -half), pieces, "right", False, frozenset(), 2 * flat)


def _d_shape(form: Form) -> Contour:
    """Round but for one flat or two."""
    flat, radius = form.values["distance"], form.values["diameter"] / 2
    half = math.sqrt(radius * radius - flat * flat)
    if form.values["count"] == 1:
        pieces = [Piece(complex(flat, half)), Piece(complex(-radius), 0j), Piece(complex(flat, -half), 0j)]
    else:
        ends = [complex(flat, half), complex(-flat, half), complex(-flat, -half), complex(flat, -half)]
        pieces = [Piece(ends[0]), Piece(ends[1], 0j), Piece(ends[2]), Piece(ends[3], 0j)]
    contour = _closed("D", complex(flat), [*pieces, Piece(complex(flat))])
    return contour._replace(bar=2 * radius)


def _free(form: Form) -> Contour:
    """One of milled_shapes; its number is that of its drawing."""
    draw = random.Random(int(form.values["number"]))  # noqa: S311 - shapes that can be drawn again
    contour = SHAPES[form.corner](draw, grid_of(draw, bool(form.values["inch"])))
    return contour._replace(size=None, evidence=frozenset())


BUILDERS: dict[str, Callable[[Form], Contour]] = {
    "polygon": _polygon, "rectangle": _rectangle, "circle": _circle, "round slot": _round_slot, "slot": _slot,
    "flat": _flat, "two flats": _two_flats, "d": _d_shape, "free": _free,
}  # fmt: skip


# ---- [[part]] ----


def keys_of(form: Form, angles: tuple[float, ...], diameter: float) -> dict[str, Any]:
    """The keys of the [[part]] of a form, with all that may be left out; lengths [mm], angles [deg]."""
    values = form.values
    turn = math.degrees(values.get("turn", 0.0)) + angles[0]
    center = form.center * cmath.rect(1, math.radians(angles[0]))
    keys: dict[str, Any] = {}
    if form.kind == "polygon":
        sides = int(values["sides"])
        keys = {"shape": NAMES[sides]} if sides in NAMES else {"shape": "polygon", "sides": sides}
        keys |= {"across_flats": values["across"], "turned": turn}
    elif form.kind == "rectangle":
        is_long = values["along"] >= values["across"]
        keys = {
            "shape": "rectangle",
            "length": max(values["along"], values["across"]),
            "width": min(values["along"], values["across"]),
            "turned": turn if is_long else turn + 90,
        }
        if not is_long and abs(values["along"] - values["across"]) < 1e-9:
            keys["turned"] = turn
    elif form.kind == "circle":
        keys = {"shape": "circle", "diameter": values["diameter"]}
    elif form.kind == "round slot":
        keys = {"shape": "slot", "width": values["width"], "length": values["length"], "turned": turn + 90}
    elif form.kind == "slot":
        keys = {"shape": "slot", "width": values["width"], "turned": turn}
    elif form.kind in ("flat", "two flats", "d"):
        count = len(angles) if form.kind == "flat" else 2 if form.kind == "two flats" else int(values["count"])
        if count == 1:
            keys = {"shape": "flat", "distance": values["distance"], "turned": turn}
        else:
            keys = {"shape": "flats", "across_flats": 2 * values["distance"], "count": count, "turned": turn}
        if diameter:
            keys["diameter"] = diameter
    if form.corner in ("arcs", "chamfers"):
        keys["corner_radius" if form.corner == "arcs" else "chamfer"] = values["small"]
    if center and form.kind != "slot":
        keys["center"] = [center.real, center.imag]
    if values.get("inside"):
        keys["inside"] = True
    if "turned" in keys:
        keys["turned"] = (keys["turned"] + 180) % 360 - 180
    return keys


# ---- plans ----

FANCY = ("hexagon and slot", "circle and hexagon", "boss and pocket", "boss and pocket aside", "flats and pocket")
FAMILIES = (
    *(f"{NAMES[sides]}" for sides in NAMES),
    *("polygon", "circle", "circle aside", "rectangle", "flat", "flats", "flats in one section", "d", "double d"),
    *("slot", "slot closed", "polygon pocket", "rectangle pocket", "circle pocket"),
    *FANCY,
    *(f"drawn {shape}" for shape in FREE),
    *("drawn d", "drawn double d", "drawn rectangle", "drawn hexagon", "drawn boss and pocket", "drawn circle pocket"),
)


def drawn_plan(seed: int, family: str = "", machine: str = "") -> Plan:
    """The plan of a seed."""
    draw = random.Random(f"plan {seed} {family} {machine}")  # noqa: S311 - plans that can be drawn again
    family = family or FAMILIES[seed % len(FAMILIES)]
    dialect = DIALECTS[machine or draw.choice([*DIALECTS, "fanuc", "fanuc", "fanuc-30i", "haas-lathe"])]
    needs_index = family in ("flats", "flats and pocket")
    while needs_index and not dialect.index:
        dialect = DIALECTS[draw.choice([*DIALECTS])]
    inch = draw.choice(dialect.units) == "inch" if draw.random() < 0.35 or "mm" not in dialect.units else False
    return _Planner(seed, family, draw, dialect, inch).plan()


class _Planner:
    """Draws the features of a family, and how they are milled."""

    def __init__(self, seed: int, family: str, draw: Draw, dialect: Dialect, inch: bool) -> None:
        self.seed, self.family, self.draw, self.dialect, self.inch = seed, family, draw, dialect, inch
        self.grid = grid_of(draw, inch)
        self.radii = INCH_RADII if inch else MM_RADII
        self.features: list[Feature] = []
        self.passes: list[Pass] = []
        self.bar = 0.0
        self.tool = draw.choice((1, 2, 3, 9))
        self.says_turned, self.says_z = draw.random() < 0.6, draw.random() < 0.4
        self.says_diameter = draw.random() < 0.5

    def plan(self) -> Plan:
        draw, family = self.draw, self.family
        is_drawn = family.startswith("drawn ")
        name = family.removeprefix("drawn ")
        if name == "hexagon and slot":
            first = self.boss(self.polygon(6), -self.grid(5, 8))
            width = min(self.grid(9, 13), 0.6 * first.form.values["across"])
            self.slot(width, -self.grid(1.5, 4), first)
            if draw.random() < 0.5:
                self.passes.reverse()
        elif name == "circle and hexagon":
            round_boss = Form("circle", {"diameter": self.grid(30, 44)})
            self.boss(round_boss, -self.grid(6, 10))
            across = math.floor(round_boss.values["diameter"] * 0.8 / 2) * 2.0
            hexagon = Form("polygon", {"sides": draw.choice((4, 6, 8)), "across": across * draw.choice((0.8, 0.9))})
            hexagon = hexagon.with_values(turn=self.turn(int(hexagon.values["sides"])))
            self.boss(hexagon, -self.grid(2, 5))
        elif name in ("boss and pocket", "boss and pocket aside"):
            form = draw.choice((self.polygon(6), self.polygon(8), self.polygon(4), Form("circle", {"diameter": 0.0})))
            across = self.grid(36, 52)
            form = form.with_values(**({"diameter": across} if form.kind == "circle" else {"across": across}))
            if form.corner:
                form = form.with_values(small=min(form.values["small"], 0.1 * across))
            self.boss(form, -self.grid(4, 8))
            aside = math.floor(0.12 * across) if name.endswith("aside") else 0.0
            diameter = math.floor(across * draw.uniform(0.45, 0.55))
            self.pocket(Form("circle", {"diameter": diameter, "inside": 1, "center": aside}), -self.grid(2, 4))
        elif name == "flats and pocket":
            self.flats(draw.choice((2, 3, 4)))
            diameter = math.floor(self.features[0].form.values["distance"] * draw.uniform(0.9, 1.2))
            self.pocket(Form("circle", {"diameter": max(diameter, 8), "inside": 1}), -self.grid(2, 4))
        elif name == "flats":
            self.flats(draw.choice((2, 2, 3, 4, 6, 8)))
        elif name == "flat":
            self.flats(1)
        elif name == "flats in one section":
            self.bar = self.grid(20, 44)
            distance = round(self.bar / 2 * draw.uniform(0.62, 0.85), 1)
            self.boss(Form("two flats", {"distance": distance, "beyond": self.bar / 2 + self.grid(1, 3)}), self.depth())
        elif name in ("d", "double d"):
            self.bar = 2 * self.grid(10, 24)
            distance = round(self.bar / 2 * draw.uniform(0.6, 0.85), 1)
            values = {"distance": distance, "diameter": self.bar, "count": 1 if name == "d" else 2}
            self.boss(Form("d", values, reverse=draw.random() < 0.4), self.depth())
        elif name == "slot":
            self.bar = self.grid(24, 44)
            self.slot(2 * self.grid(5, 8), self.depth(), None)
        elif name in ("slot closed", "polygon pocket", "rectangle pocket", "circle pocket"):
            self.bar = 2 * self.grid(24, 34)
            self.pocket(self.pocket_form(name), self.depth())
        elif name in FREE:
            number = draw.randrange(10**6)
            form = Form("free", {"number": number, "inch": self.inch}, name, draw.random() < 0.4)
            contour = form.contour()
            self.bar = contour.bar if name == "keyway" else 0.0
            if name == "keyway":
                half = abs(contour.start.imag)
                self.milled(form, self.depth(), self.fitting(0.0, 0.75 * half))
            else:
                self.boss(form, self.depth())
        else:
            self.boss(self.boss_form(name), self.depth())
        if is_drawn:
            self.is_one_file = draw.random() < 0.6
            self.features = [self.as_drawing(number, one) for number, one in enumerate(self.features)]
        self.features = [self.said_otherwise(number, one) for number, one in enumerate(self.features)]
        return Plan(
            self.seed,
            family,
            tuple(self.features),
            tuple(self.passes),
            self.dialect,
            self.style(),
            self.inch,
            self.bar,
            draw.choice(("mm", "mm", "")) if not self.inch else draw.choice(("mm", "", "")),
            draw.choice((math.nan, math.nan, 0.01, 0.03, 0.05, 0.1)),
        )

    def style(self) -> Style:
        draw = self.draw
        repeats = draw.random() < 0.25
        is_subprogram = any(one.how == "subprogram" for one in self.passes)
        is_boss = all(not feature.is_pocket and feature.form.contour().closed for feature in self.features)
        is_ramped = is_boss and all(one.how in ("ramps", "one ramp") for one in self.passes)
        style = Style(
            repeats,
            repeats and not is_subprogram and draw.random() < 0.4,
            draw.random() < 0.25 and self.dialect.machine != "siemens-transmit",
            self.dialect.centers and draw.random() < 0.5,
            not repeats and draw.random() < 0.15,
            draw.random() < 0.2,
            draw.random() < 0.15,
            draw.choice(("normal", "normal", "aside", "arc")) if is_ramped else "normal",
            not is_boss or draw.random() < 0.75,
            draw.random() < 0.2,
        )
        return style._replace(repeats_z=False) if self.dialect.machine == "turning-center" else style

    # ---- numbers ----

    def depth(self) -> float:
        return -self.grid(3, 8)

    def turn(self, sides: int) -> float:
        """By less than half of what one side takes [rad]."""
        if self.draw.random() < 0.5:
            return 0.0
        return math.radians(round(math.degrees(math.pi / sides * self.draw.uniform(-0.95, 0.95)), 1))

    def angle(self) -> float:
        """Of C at the entry [deg]."""
        if not self.dialect.index or self.draw.random() < 0.55:
            return 0.0
        return float(self.draw.choice((10, 15, 30, 45, 60, 90, 120, 135, 180, 200, 270, 300)))

    def polygon(self, sides: int) -> Form:
        across, corner = self.grid(18, 50), self.draw.choice(("", "", "arcs", "chamfers"))
        side = across * math.tan(math.pi / sides)
        values = {"sides": sides, "across": across, "turn": self.turn(sides)}
        if corner:
            values["small"] = max(self.grid(0.08 * side, 0.25 * side), 0.5)
        return Form("polygon", values, corner if values.get("small", 0.0) < 0.3 * side else "", self.reverse())

    def reverse(self) -> bool:
        return self.draw.random() < 0.35

    def boss_form(self, name: str) -> Form:
        draw, grid = self.draw, self.grid
        if name == "circle":
            return Form("circle", {"diameter": grid(16, 48)}, "", self.reverse())
        if name == "circle aside":
            return Form("circle", {"diameter": grid(16, 36), "center": grid(2, 6)}, "", self.reverse())
        if name == "rectangle":
            values = {"along": grid(16, 36), "across": grid(16, 36), "turn": self.turn(4)}
            corner = draw.choice(("", "arcs", "chamfers"))
            if corner:
                values["small"] = grid(1.5, min(values["along"], values["across"]) * 0.3)
            return Form("rectangle", values, corner, self.reverse())
        sides = next((sides for sides, one in NAMES.items() if one == name), 0)
        return self.polygon(sides or draw.choice((5, 9, 14, 16)))

    def pocket_form(self, name: str) -> Form:
        draw, grid = self.draw, self.grid
        aside = draw.choice((0.0, grid(3, 12)))
        if name == "slot closed":
            width = 2 * grid(4.5, 7.5)
            return Form(
                "round slot", {"width": width, "length": width + grid(5, 12), "center": aside, "turn": self.turn(4)}
            )
        if name == "circle pocket":
            return Form("circle", {"diameter": 2 * grid(6, 16), "center": aside, "inside": 1})
        small = grid(4, 6)
        if name == "rectangle pocket":
            values = {"along": grid(16, 32), "across": grid(16, 32), "turn": self.turn(4), "center": aside / 2}
            return Form("rectangle", {**values, "small": small, "inside": 1}, "arcs")
        sides = draw.choice((3, 4, 5, 6, 8))
        values = {"sides": sides, "across": grid(20, 32), "turn": self.turn(sides), "center": aside / 2}
        return Form("polygon", {**values, "small": small, "inside": 1}, "arcs")

    def fitting(self, least: float, most: float) -> float:
        """R of a cutter [mm]."""
        fits = [radius for radius in self.radii if least <= radius <= most]
        return self.draw.choice(fits) if fits else max([one for one in self.radii if one <= most] or self.radii[:1])

    # ---- features ----

    def boss(self, form: Form, z: float) -> Feature:
        """Milled around, with roughing passes where one pass leaves a ring of the bar."""
        contour = form.contour()
        way = shapely.LineString([(point.real, point.imag) for point in points_of(contour, 0.01)])
        inner = way.distance(shapely.Point(0, 0))
        widest = max(abs(point) for point in points_of(contour, 0.01))
        step = 25.4 / 16 if self.inch else 1.0
        if not self.bar:
            self.bar = math.ceil((2 * widest + self.draw.uniform(0.2, 2)) / step) * step
        concave = [
            abs(piece.end - piece.center)
            for piece in contour.pieces
            if piece.center is not None and piece.ccw == (contour.side == "left")
        ]
        room = self.bar / 2 - inner
        radius = self.fitting(room / 2 + 0.2, min([8.0, *(0.9 * one for one in concave)]))
        return self.milled(form, z, radius, () if concave else self.rough(radius, room))

    def rough(self, radius: float, room: float) -> tuple[float, ...]:
        """Distances of passes before the last, the farthest first."""
        step = round(1.5 * radius, 1)
        count = max(0, math.ceil((room + 0.2 - 2 * radius) / step))
        if not count and self.draw.random() < 0.2:
            return (round(min(step, 0.5 * room), 1),)
        return tuple(step * number for number in range(count, 0, -1))

    def slot(self, width: float, z: float, within: Feature | None) -> Feature:
        half = width / 2
        form = Form("slot", {"width": width, "far": math.ceil(self.bar / 2) + 8.0}, "", self.reverse())
        radius = self.fitting(half / 2 + 0.2, 0.8 * half)
        return self.milled(form, z, radius)

    def flats(self, count: int) -> None:
        """By indexing, one section for each."""
        self.bar = self.grid(20, 44)
        least = math.cos(math.pi / max(count, 2)) + 0.02 if count > 2 else 0.55
        distance = round(self.bar / 2 * self.draw.uniform(max(least, 0.55), max(least + 0.03, 0.9)), 2)
        half = math.ceil(math.sqrt(self.bar * self.bar / 4 - distance * distance)) + self.draw.choice((6.0, 8.0, 10.0))
        form = Form("flat", {"distance": distance, "half": half}, "", self.reverse())
        room = self.bar / 2 - distance
        radius = self.fitting(room / 2 + 0.2, 8.0)
        first = self.angle()
        angles = tuple((first + 360.0 / count * number) % 360 for number in range(count))
        self.milled(form, self.depth(), radius, self.rough(radius, room), angles)

    def pocket(self, form: Form, z: float) -> Feature:
        """Cleared from the middle outwards."""
        values = form.values
        size = {"circle": "diameter", "round slot": "width", "polygon": "across"}.get(form.kind, "")
        inner = (values[size] if size else min(values["along"], values["across"])) / 2
        most = 0.9 * values["small"] if "small" in values else 0.9 * inner
        radius = self.fitting(0.0, min(most, 6.0, max(inner - 1.8, 2.0)))
        step, offsets = 1.1 * radius, [0.0]
        while inner - offsets[-1] > 1.9 * radius and inner - offsets[-1] - step >= radius + 1.8:
            offsets.append(offsets[-1] + step)
        if inner - offsets[-1] > 1.9 * radius:
            offsets.append(inner - radius - 1.8)
        return self.milled(form, z, radius, tuple(round(one, 2) for one in reversed(offsets[1:])))

    def milled(
        self, form: Form, z: float, radius: float, rough: tuple[float, ...] = (), angles: tuple[float, ...] = ()
    ) -> Feature:
        draw, number = self.draw, len(self.features)
        angles = angles or (self.angle(),)
        keys = keys_of(form, angles, self.bar if self.says_diameter else 0.0)
        if self.says_z:
            keys["z"] = z
        if not self.says_turned:
            keys.pop("turned", None)
        feature = Feature(form, angles, z, keys)
        if number:
            self.tool += 1
        if len(rough) == 0 and draw.random() < 0.35 and z < -2.5:
            count = draw.choice((2, 3))
            depths = (*(round(z * (index + 1) / count, 2) for index in range(count - 1)), z)
        else:
            depths = (z,)
        contour = form.contour()
        how = "ramps"
        if len(depths) > 1 and contour.closed and draw.random() < 0.3:
            how = "one ramp"
        if not rough and self.dialect.calls and len(depths) > 1 and not number and draw.random() < 0.3:
            how = draw.choice(("subprogram", "macro depths")) if self.evenly(depths) else "subprogram"
        if len(depths) == 1 and draw.random() < 0.2 and self.can_shift(form):
            how = "center path"
        finish = 0.0
        if how == "ramps" and len(depths) > 1 and not contour.is_pocket and contour.closed and draw.random() < 0.3:
            finish = 0.5 if self.can_shift(form) else 0.0
        if finish:
            self.passes += [Pass(number, form, one, self.tool, radius, depths, how, finish) for one in angles]
            if draw.random() < 0.5:
                self.tool += 1
            depths = (z,)
        for one in angles:
            for offset in rough:
                self.passes.append(self.rough_pass(number, form, one, radius, z, offset, how))
            self.passes.append(Pass(number, form, one, self.tool, radius, depths, how))
        self.features.append(feature)
        return feature

    def rough_pass(
        self, number: int, form: Form, angle: float, radius: float, z: float, offset: float, how: str
    ) -> Pass:
        if not form.values.get("inside") and form.kind != "round slot":
            return Pass(number, form, angle, self.tool, radius, (z,), how, offset)
        values = {
            key: value - 2 * offset if key in ("diameter", "width", "length", "along", "across") else value
            for key, value in form.values.items()
        }
        small = values.pop("small", 0.0) - offset
        corner = "arcs" if small > 1.05 * radius else ""
        return Pass(
            number,
            form._replace(values={**values, "small": small} if corner else values, corner=corner),
            angle,
            self.tool,
            radius,
            (z,),
            how,
        )

    def can_shift(self, form: Form) -> bool:
        return form.kind not in ("d", "two flats") and (
            form.kind != "free" or form.corner in ("obround", "cam", "free_polygon")
        )

    def evenly(self, depths: tuple[float, ...]) -> bool:
        return all(abs(depth - depths[0] * (number + 1)) < 1e-3 for number, depth in enumerate(depths))

    def said_otherwise(self, number: int, feature: Feature) -> Feature:
        """Across corners for across flats, or with the section that mills it."""
        draw = random.Random(f"keys {self.seed} {self.family} {number}")  # noqa: S311 - plans that can be drawn again
        keys, sections = dict(feature.keys), [one.feature for one in self.passes]
        if feature.form.kind == "polygon" and "across_flats" in keys and draw.random() < 0.2:
            flats = keys.pop("across_flats")
            keys = {**keys, "across_corners": flats / math.cos(math.pi / feature.form.values["sides"])}
        is_one_file = feature.is_drawn and len(self.features) > 1
        if sections.count(number) == 1 and not is_one_file and draw.random() < 0.15:
            keys["section"] = sections.index(number) + 1
        return feature._replace(keys=keys)

    def as_drawing(self, number: int, feature: Feature) -> Feature:
        keys = {"drawing": f"part{'' if self.is_one_file else number or ''}.dxf"}
        if "z" in feature.keys and not (self.is_one_file and len(self.features) > 1):
            keys["z"] = feature.z  # type: ignore[assignment]
        return feature._replace(keys=keys)
