"""
What a program of setter_programs does to the bar: the slow and plain way, sharing no code with polarcheck.

    outcome = simulate(program)
    outcome.events          # what no drawing is needed for: alarms, rapids through metal, ...
    differs(sound, outcome) # whether the part comes out otherwise

The text is read word by word, macro statements and subprograms included. compensation_oracle compensates; what the
cutter sweeps is taken off the bar as areas (shapely), each with the Z down to which it reaches.
"""

from __future__ import annotations

import cmath
import math
import re
from itertools import pairwise
from typing import Any, NamedTuple

import shapely  # type: ignore[import-untyped]
from compensation_oracle import Block, Move, Rules
from compensation_oracle import simulate as compensated
from part_reference import along
from setter_programs import Program

RAPID = "a rapid through metal"
_NO_RAPIDS = ("fanuc", "fanuc-16i", "fanuc-30i", "gsk-988", "doosan", "takisawa", "colchester", "turning-center")
C_LIMIT = 12000.0  # [deg/min]
_TOUCH = 0.2  # [mm] a rapid that meets less of the metal may be on another way than it seems
_CLEAR = 0.02  # [mm] thinner differences are rounding
_WORD = re.compile(r"([A-Z][A-Z0-9]*=|[A-Z])([-+]?(?:\d*\.?\d+|\d+\.)|\[[^A-Z]*?(?:\[[^\]]*\][^\[\]]*)*\]|[-+]?#\d+)?")
_ALARMS = ("inside_arc_too_small", "interferes", "no_intersection", "arc_center_on_path")
_STEPS = 400  # blocks that a program may run


class Sweep(NamedTuple):
    """What the cutter passes over, down to which Z, and how: by rapid, in which section, in which phase."""

    area: Any
    z: float
    is_rapid: bool
    phase: str
    line: int


class Piece(NamedTuple):
    """A line of a contour as programmed, or an arc where it has a center; ccw: its sense."""

    start: complex
    end: complex
    center: complex | None
    ccw: bool


class Outcome(NamedTuple):
    """
    What a program has done.

    sweeps: in their order. events: names of what is wrong whatever the drawing says. minutes: of feed moves. c_rate:
    the highest of the C axis [deg/min]. bar: what stands before. paths: the contour of each pass as programmed.
    """

    sweeps: list[Sweep]
    events: frozenset[str]
    minutes: float
    c_rate: float
    bar: Any
    paths: tuple[tuple[Piece, ...], ...] = ()


def simulate(program: Program) -> Outcome:
    """Run a program."""
    run = _Run(program)
    run.main()
    return run.outcome()


def metal_at(outcome: Outcome, z: float) -> Any:
    """What stands of the bar at a Z."""
    swept = [sweep.area for sweep in outcome.sweeps if sweep.z < z]
    return outcome.bar.difference(shapely.union_all(swept)) if swept else outcome.bar


def levels(*outcomes: Outcome) -> list[float]:
    """The middles of the slabs between all depths below the face."""
    depths = sorted({round(sweep.z, 2) for outcome in outcomes for sweep in outcome.sweeps if sweep.z < -1e-6} | {0.0})
    return [(low + high) / 2 for low, high in pairwise(depths) if high - low > _CLEAR]


def must_stand(program: Program, sound: Outcome, z: float) -> Any:
    """What a sound program leaves at a Z, without what happens to be left within a pocket or slot."""
    stands = metal_at(sound, z)
    pieces = {"slot": 2, "keyway": 1, "pocket": 1, "round_pocket": 1, "pocket_aside": 1}
    shape, _, layout = program.family.partition(", ")
    if shape in pieces and layout != "island" and stands.geom_type == "MultiPolygon":
        areas = sorted(stands.geoms, key=lambda area: shapely.Polygon(area.exterior).area)
        return shapely.MultiPolygon(areas[-pieces[shape] :])
    return stands


def cuts_the_part(program: Program, sound: Outcome, changed: Program, other: Outcome, rapids: bool = False) -> bool:
    """Whether the cutter meets what must stand beside contours: on ramps and ways (or by rapid only)."""
    for sweep in other.sweeps:
        is_way = sweep.is_rapid if rapids else sweep.phase != "OFFSET" and changed.lines[sweep.line].role != "contour"
        if is_way:
            stands = must_stand(program, sound, sweep.z + 0.01).intersection(sweep.area)
            if not stands.buffer(-_TOUCH if rapids else -2 * _CLEAR).is_empty:
                return True
    return False


def differs(sound: Outcome, other: Outcome) -> bool:
    """Whether more than rounding stands or is missing."""
    for z in levels(sound, other):
        apart = shapely.symmetric_difference(metal_at(sound, z), metal_at(other, z))
        if not apart.buffer(-0.75 * _CLEAR).is_empty:
            return True
    return False


class _Run:
    """The state of the lathe."""

    def __init__(self, program: Program) -> None:
        self.program, self.dialect = program, program.dialect
        remark = program.dialect.remark
        strip = re.compile(r"\([^)]*\)" if remark[0] == "(" else r";.*")
        self.blocks = [strip.sub("", line.text).strip() for line in program.lines]
        self.blocks = ["" if block.startswith("/") else block for block in self.blocks]
        self.bar = shapely.Point(0, 0).buffer(program.bar / 2, quad_segs=90)
        self.feed, self.per_minute, self.motion = 0.0, True, "rapid"
        self.scale = 25.4 if self.dialect.starts_in_inch else 1.0
        self.tool, self.code, self.steps = 0, "", False
        self.x, self.z, self.c = program.bar, 100.0, 0.0
        self.in_mode, self.turn, self.place = False, 1 + 0j, 0j
        self.pending: list[tuple[Block, float, bool, float, int, complex]] = []
        self.entry = 0j
        self.entry_z = 0.0
        self.sweeps: list[Sweep] = []
        self.events: set[str] = set()
        self.minutes, self.c_rate = 0.0, 0.0
        self.variables: dict[int, float] = {}
        self.done = 0
        self.paths: list[tuple[Piece, ...]] = []

    # ---- the order of blocks ----

    def main(self) -> None:
        self.run(0)
        if self.in_mode:
            self.events.add("the mode is never left")
            self.finish_section()

    def run(self, index: int) -> None:
        while index < len(self.blocks) and self.done < _STEPS * 4:
            block = re.sub(r"^N\d+ ?", "", self.blocks[index])
            self.done += 1
            loop = re.match(r"WHILE\[(.*)\]DO1$", block)
            if loop:
                if not self.value(loop[1]):
                    index = next(
                        (i for i in range(index, len(self.blocks)) if "END1" in self.blocks[i]), len(self.blocks)
                    )
            elif block.endswith("END1"):
                index = next((i for i in range(index, -1, -1) if "WHILE" in self.blocks[i]), index + 1) - 1
            elif re.match(r"#\d+=", block):
                name, _, text = block.partition("=")
                self.variables[int(name[1:])] = self.value(text)
            elif "M98" in block:
                start = next((i for i, text in enumerate(self.blocks) if text == "O100"), None)
                if start is not None:
                    self.run(start + 1)
            elif re.search(r"M30|M99", block):
                return
            else:
                self.block(block, index)
            index += 1

    def value(self, text: str) -> float:
        text = text.replace("[", "(").replace("]", ")").replace(" LT ", "<")
        text = re.sub(r"#(\d+)", r"V(\1)", text)
        for name in ("SIN", "COS", "TAN"):
            text = text.replace(name, f"{name.lower()}")
        names = {
            "V": lambda number: self.variables.get(number, 0.0),
            "sin": lambda angle: math.sin(math.radians(angle)),
            "cos": lambda angle: math.cos(math.radians(angle)),
            "tan": lambda angle: math.tan(math.radians(angle)),
        }
        text = re.sub(r"(?<![\d.])0+(?=\d)", "", text)
        return float(eval(text, {"__builtins__": {}}, names))  # noqa: S307 - a text that setter_programs wrote

    # ---- one block ----

    def words(self, block: str) -> list[tuple[str, float]]:
        block = block.replace("TRANSMIT", "G12.1").replace("TRAFOOF", "G13.1").replace("E=C", "")
        block = re.sub(r"G17 XC|DIAMO[NF]|SETMS\(2\)|S2=\d+|M2=3|SB=\d+", "", block)
        words = []
        for letter, text in _WORD.findall(block):
            if text:
                words.append((letter.rstrip("="), self.value(text)))
        return words

    def block(self, block: str, index: int) -> None:
        dialect = self.dialect
        if self.program.lines[index].role == "turn" or not block or block[0] in "%O":
            if self.program.lines[index].role == "turn":
                self.tool = 0
                self.per_minute &= self.dialect.per_revolution not in block
            return
        words = self.words(block)
        codes = {f"G{value:g}" for letter, value in words if letter == "G"}
        values = {letter: value for letter, value in words if letter not in "GMSNP"}
        values |= {letter: values[letter] * dialect.outward for letter in ("Z", "W") if letter in values}
        if dialect.inch and dialect.inch in codes:
            self.scale = 25.4
        if dialect.metric and dialect.metric in codes:
            self.scale = 1.0
        if dialect.per_minute in codes:
            self.per_minute = True
        if dialect.per_revolution in codes:
            self.per_minute = False
        if "T" in values:
            self.call(values["T"])
        on, off = dialect.on.split()[0].replace("TRANSMIT", "G12.1"), dialect.off.replace("TRAFOOF", "G13.1")
        if on in codes:
            self.enter()
            return
        if off in codes:
            self.leave()
            return
        if "F" in values:
            self.feed = values["F"] * self.scale
        if dialect.system == "B":
            self.steps = True if "G91" in codes else False if "G90" in codes else self.steps
        if "G28" in codes:
            if self.in_mode:
                self.events.add("the mode is never left")
                self.leave()
            self.c = 0.0 if "U" not in values else self.c
            if "U" in values:
                turn = cmath.exp(1j * math.radians(self.c))
                self.take([self.x * turn, 200.0 * turn], self.z, 100.0, True, "outside", index)
                self.x, self.z = 200.0, 100.0
            return
        if "G10" in codes:
            return
        for code, name in (
            ("G0", "rapid"),
            (dialect.line, "line"),
            (dialect.cw, "cw"),
            (dialect.ccw, "ccw"),
            ("G1", "line"),
            ("G2", "cw"),
            ("G3", "ccw"),
        ):
            if code in codes:
                self.motion = name
        side = next((code for code in ("G40", "G41", "G42") if code in codes), "")
        if self.in_mode:
            self.in_plane(values, side, index)
        else:
            self.code = side or self.code
            self.outside(values, index)

    def call(self, value: float) -> None:
        if self.in_mode:
            self.events.add("the mode is never left")
            self.leave()
        number = int(value)
        self.tool = number % 100 if self.dialect.machine != "siemens-transmit" else number

    def enter(self) -> None:
        if self.in_mode:
            self.events.add("the mode is entered twice")
            return
        self.in_mode, self.steps = True, False if self.dialect.system == "A" else self.steps
        self.turn = cmath.rect(1, math.radians(self.c)) if self.dialect.index else 1 + 0j
        self.place = complex(self.x, 0)
        self.entry, self.entry_z = self.place, self.z

    def leave(self) -> None:
        if not self.in_mode:
            return
        self.finish_section()
        self.in_mode = False
        self.x = abs(self.place)
        self.c = math.degrees(cmath.phase(self.place * self.turn)) if self.x > 1e-9 else self.c

    @property
    def radius(self) -> float:
        return self.program.radii.get(self.tool, 0.0)

    def in_plane(self, values: dict[str, float], side: str, index: int) -> None:
        dialect, scale = self.dialect, self.scale
        half = 0.5 if dialect.diameter_inside else 1.0
        x, c = self.place.real, self.place.imag
        v = dialect.virtual
        if dialect.system == "B" and self.steps:
            x, c = x + values.get("X", 0.0) * half * scale, c + values.get(v, 0.0) * scale
            z = self.z + values.get("Z", 0.0) * scale
        else:
            x = values["X"] * half * scale if "X" in values else x + values.get("U", 0.0) * half * scale
            c = values[v] * scale if v in values else c + values.get(dialect.virtual_step, 0.0) * scale
            z = values["Z"] * scale if "Z" in values else self.z
        end = complex(x, c)
        kind, center = ("line" if self.motion == "rapid" else self.motion), None
        moves = any(letter in values for letter in ("X", "U", v, dialect.virtual_step))
        if kind != "line" and moves:
            center = self.center(kind, end, values)
            if center is None:
                self.events.add("an arc that the control refuses")
                kind = "line"
        block = Block(
            kind if moves else "none", end if moves else self.place, center if moves else None, side, self.radius
        )
        if self.motion == "rapid" and dialect.machine in _NO_RAPIDS and moves:
            self.events.add("G0 in the mode")
        feed = self.feed if self.per_minute else 0.0
        if not feed and self.motion != "rapid" and (moves or "Z" in values):
            self.events.add("no feed per minute")
        self.pending.append((block, z, self.motion == "rapid", feed, index, self.place))
        self.place, self.z = (end if moves else self.place), z

    def center(self, kind: str, end: complex, values: dict[str, float]) -> complex | None:
        start, chord = self.place, end - self.place
        size = next((values[letter] for letter in ("R", "L", "CR") if letter in values), None)
        if size is not None:
            size *= self.scale
            if abs(chord) < 1e-9 or abs(chord) / 2 > abs(size) + 0.005:
                return None
            across = math.sqrt(max(size**2 - abs(chord) ** 2 / 4, 0.0)) * math.copysign(1, size)
            return start + chord / 2 + chord / abs(chord) * across * (1j if kind == "ccw" else -1j)
        if "I" not in values and "J" not in values:
            return None
        center = start + complex(values.get("I", 0.0), values.get("J", 0.0)) * self.scale
        if abs(abs(end - center) - abs(start - center)) > 0.03 or abs(start - center) < 1e-9:
            return None
        return center

    def finish_section(self) -> None:
        """Compensates the blocks of a section, and takes off what the cutter sweeps."""
        if not self.pending:
            return
        self.paths += self.passes()
        blocks = [block for block, *_ in self.pending]
        try:
            run = compensated(self.entry, blocks, Rules(read_ahead=self.dialect.read_ahead))
        except (ZeroDivisionError, ValueError):
            self.events.add("an alarm of the compensation")
            self.pending = []
            return
        if any(name in run.alarms for name in _ALARMS):
            self.events.add("an alarm of the compensation")
        sides = {"G41": 1, "G42": -1}
        by_row: dict[int, list[Move]] = {}
        for move in run.moves:
            by_row.setdefault(move.row, []).append(move)
        here, z_before, is_on = self.entry, self.entry_z, False
        for row, (block, z, is_rapid, feed, index, _) in enumerate(self.pending):
            was_on = is_on
            is_on = bool(sides.get(block.word)) or (is_on and block.word != "G40")
            if is_on != was_on and row in run.elements:
                ramp = run.elements[row]
                if abs(ramp.end - ramp.start) < self.radius - 1e-6:
                    self.events.add("a ramp shorter than R")
                if ramp.center is not None:
                    self.events.add("a ramp on an arc")
            moves = by_row.get(row, [])
            if not moves and z != z_before:
                moves = [Move(row, "line", here, here, None, "OFFSET" if is_on else "CANCELLED", False)]
            for number, move in enumerate(moves):
                self.sweep(move, z_before if number == 0 else z, z, is_rapid, feed, index)
                here = move.end
            z_before = z
        if is_on:
            self.events.add("the offset is not cancelled")
        self.pending = []

    def passes(self) -> list[tuple[Piece, ...]]:
        """What lies between ramps and the ends of contours, as programmed."""
        found: list[list[Piece]] = [[]]
        for block, _, _, _, index, start in self.pending:
            if self.program.lines[index].role == "contour" and block.kind != "none":
                found[-1].append(Piece(start, block.end, block.center, block.kind == "ccw"))
            elif self.program.lines[index].role != "contour" and found[-1]:
                found.append([])
        return [tuple(one) for one in found if one]

    def sweep(self, move: Move, z_from: float, z_to: float, is_rapid: bool, feed: float, line: int) -> None:
        points = along(move) if abs(move.end - move.start) > 1e-9 or move.center is not None else [move.start]
        self.take(points, z_from, z_to, is_rapid, move.phase, line)
        length = sum(abs(b - a) for a, b in pairwise(points)) + abs(z_to - z_from)
        if feed:
            self.minutes += length / feed
            nearest = (
                shapely.LineString([(p.real, p.imag) for p in points]).distance(shapely.Point(0, 0))
                if len(points) > 1
                else math.inf
            )
            rate = feed / max(nearest, 1e-6) * 180 / math.pi
            is_radial = (
                len(points) == 2
                and abs((points[1] * points[0].conjugate()).imag) < 1e-6
                and (points[1] * points[0].conjugate()).real > 0
            )
            if not is_radial:
                self.c_rate = max(self.c_rate, rate)

    def take(self, points: list[complex], z_from: float, z_to: float, is_rapid: bool, phase: str, line: int) -> None:
        """Sweeps a way of the cutter, in pieces where Z changes along it."""
        radius = self.radius
        if not radius or min(z_from, z_to) >= -1e-9:
            return
        turned = [point * self.turn for point in points] if self.in_mode else points
        pieces = [(turned, min(z_from, z_to))]
        if abs(z_from - z_to) > 1e-6 and len(turned) == 2 and abs(turned[1] - turned[0]) > 1e-6:
            shares = [number / 8 for number in range(9)]
            way = [turned[0] + (turned[1] - turned[0]) * share for share in shares]
            heights = [z_from + (z_to - z_from) * share for share in shares]
            pieces = [([way[i], way[i + 1]], min(heights[i], heights[i + 1])) for i in range(8)]
        for way, z in pieces:
            if z >= -1e-9:
                continue
            pairs = [(point.real, point.imag) for point in way]
            shape = shapely.Point(pairs[0]) if len(pairs) == 1 else shapely.LineString(pairs)
            area = shape.buffer(radius, quad_segs=32)
            if is_rapid and self.stands(area, z):
                self.events.add(RAPID)
            self.sweeps.append(Sweep(area, z, is_rapid, phase, line))

    def stands(self, area: Any, z: float) -> bool:
        """Whether metal is met there, of more than rounding."""
        if not area.intersects(self.bar):
            return False
        tops = sorted({sweep.z for sweep in self.sweeps if sweep.z > z} | {z})
        for top in tops:
            left = self.bar.intersection(area)
            swept = [sweep.area for sweep in self.sweeps if sweep.z <= top + 1e-6]
            left = left.difference(shapely.union_all(swept)) if swept else left
            if not left.buffer(-_TOUCH).is_empty:
                return True
        return False

    # ---- outside of the mode ----

    def outside(self, values: dict[str, float], index: int) -> None:
        scale = self.scale
        half = 0.5 if self.dialect.diameter_outside else 1.0
        is_step = self.dialect.system == "B" and self.steps
        x = (
            self.x * is_step + values["X"] * half * scale
            if "X" in values
            else self.x + values.get("U", 0.0) * half * scale
        )
        z = self.z * is_step + values["Z"] * scale if "Z" in values else self.z + values.get("W", 0.0) * scale
        c = self.c * is_step + values["C"] if "C" in values else self.c + values.get("H", 0.0)
        if not any(letter in values for letter in "XZCUWH"):
            if self.dialect.virtual == "Y" and "Y" in values:
                self.events.add("Y outside the mode")
            return
        if self.motion in ("cw", "ccw"):
            self.events.add("an arc outside the mode")
        if self.motion != "rapid" and not (self.feed and self.per_minute):
            self.events.add("no feed per minute")
        count = max(2, math.ceil(abs(c - self.c) / 3) + 1)
        shares = [number / (count - 1) for number in range(count)]
        points = [
            (self.x + (x - self.x) * share) * cmath.exp(1j * math.radians(self.c + (c - self.c) * share))
            for share in shares
        ]
        if all(abs(point - points[0]) < 1e-9 for point in points):
            points = points[:1]
        if self.tool in self.program.radii:
            self.take(points, self.z, z, self.motion == "rapid", "outside", index)
            if self.motion != "rapid" and self.feed:
                self.minutes += (abs(x - self.x) + abs(z - self.z)) / self.feed + abs(c - self.c) / self.feed
        self.x, self.z, self.c = x, z, c

    def outcome(self) -> Outcome:
        if self.c_rate > C_LIMIT * 1.001:
            self.events.add("C too fast")
        if self.minutes > 60:
            self.events.add("hours")
        return Outcome(self.sweeps, frozenset(self.events), self.minutes, self.c_rate, self.bar, tuple(self.paths))
