"""
Sound programs that turn first and mill then, drawn at random, and slips against the metal in them.

    program = drawn(7)
    program.text(), program.tools, program.stock
    slipped(program, kind)      # None where the program has no place for it

Each block is a Line with a role, by which slips find it. Lengths in mm, X as a diameter.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import NamedTuple


class Line(NamedTuple):
    """A block. role: what it does. section: the number of its polar section, -1 outside."""

    text: str
    role: str
    section: int = -1


class Program(NamedTuple):
    """
    A program, what it is run with, and what its slips need.

    stock: what `[stock]` says. spigot: diameter where the mills cut. raw: diameter of the bar. low: Z to which the
    spigot is turned. radii: of the cutters by tool number. shape: of its sections.
    """

    seed: int
    lines: tuple[Line, ...]
    radii: dict[int, float]
    stock: dict[str, float]
    spigot: float
    raw: float
    low: float
    shape: str

    def text(self) -> str:
        return "\n".join(line.text for line in self.lines) + "\n"

    @property
    def tools(self) -> list[str]:
        return [f"{number}:radius={radius},nose=0" for number, radius in self.radii.items()]


SHAPES = ("polygon", "rectangle", "flats", "pocket", "slots")


def number(value: float) -> str:
    """As a control takes it, with its point."""
    text = f"{round(value, 3) + 0.0:.3f}".rstrip("0")
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) and text not in ("0.", "-0.") else text


def word(address: str, value: float) -> str:
    return address + number(value)


class Writer:
    """Writes one program."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.draw = random.Random(seed)  # noqa: S311 - programs that can be drawn again
        self.lines: list[Line] = []
        self.section = -1
        draw = self.draw
        self.spigot = float(draw.randrange(24, 52, 2))
        more = draw.choice((0.0, 6.0, 12.0))
        self.kind = draw.choice(("round", "round", "round", "hexagon", "tube"))
        self.raw = self.spigot + more if self.kind != "hexagon" else (self.spigot + max(more, 4.0)) * 2 / math.sqrt(3)
        self.is_turned = more > 0 or self.kind == "hexagon"
        self.black = draw.choice((0.0, 0.0, 1.0, 2.0))
        self.deep = round(draw.uniform(3, 9), 1)
        self.low = -round(self.deep + draw.uniform(2, 14), 1)
        self.bore = 0.0
        self.shape = draw.choice(SHAPES)
        self.radii: dict[int, float] = {}
        self.stock: dict[str, float] = {}

    def write(self, text: str, role: str) -> None:
        self.lines.append(Line(text, role, self.section))

    def program(self) -> Program:
        draw = self.draw
        self.write(f"O{1000 + self.seed % 8000}", "head")
        self.write("G21 G40", "head")
        if self.kind == "hexagon":
            self.stock = {"hexagon": round(self.raw * math.sqrt(3) / 2, 3)}
        else:
            self.stock = {"diameter": self.raw}
        if self.kind == "tube":
            self.bore = self.stock["bore"] = float(draw.randrange(6, 13))
        if self.black:
            self.stock["face"] = self.black
        self.turn()
        self.mill()
        self.write("M30", "end")
        return Program(
            self.seed,
            tuple(self.lines),
            self.radii,
            self.stock,
            self.spigot,
            self.raw,
            self.low,
            self.shape,
        )

    # ---- turning ----

    def tool(self, tool: int, speed: int) -> None:
        self.write(f"T{tool:02}{tool:02}", "call")
        self.write(f"G97 S{speed} M3", "turn")

    def home(self) -> None:
        self.write("G0 X140. Z60.", "home")
        self.write("M5", "turn")

    def turn(self) -> None:
        draw = self.draw
        two = draw.random() < 0.4
        self.tool(11, 1500)
        out = word("X", self.raw + 4)
        self.write(f"G0 {out} {word('Z', self.black + 2)} G99", "turn")
        self.face(out)
        if self.is_turned:
            self.outside(out, is_last=not two)
        self.home()
        if two and self.is_turned:
            self.tool(12, 1800)
            self.finish(draw.choice(("plain", "chamfer", "radius", "cone")))
            self.home()
        if draw.random() < 0.3 and not self.bore:
            self.bored()
        if draw.random() < 0.25:
            self.groove()
        if draw.random() < 0.2:
            self.thread()

    def face(self, out: str) -> None:
        how = self.draw.choice(("moves", "cycle", "steps")) if self.black else self.draw.choice(("moves", "cycle"))
        center = "X-1.6"
        if how == "cycle":
            self.write(f"G94 {center} Z0. F.15", "face")
            self.write("G0 Z2.", "turn")
            return
        for z in (self.black / 2, 0.0) if how == "steps" else (0.0,):
            self.write(f"G0 {word('Z', z)}", "turn")
            self.write(f"G1 {center} F.15", "face")
            self.write(f"G0 {word('Z', z + 2)}", "turn")
            self.write(f"G0 {out}", "turn")

    def outside(self, out: str, is_last: bool) -> None:
        draw, left = self.draw, 0.0 if is_last else 0.4
        x, low = self.spigot + left, self.low + left / 4
        how = draw.choice(("moves", "G90", "G71", "G94"))
        if how == "moves":
            passes = max(1, math.ceil((self.raw - x) / 6))
            for k in range(1, passes + 1):
                at = self.raw + (x - self.raw) * k / passes
                self.write(f"G0 {word('X', at)} Z2.", "turn")
                self.write(f"G1 {word('Z', low)} F.2", "spigot")
                self.write(f"{word('X', at + 2)}", "turn")
                self.write("G0 Z2.", "turn")
            return
        self.write(f"G0 {out} Z2.", "turn")
        if how == "G90":
            self.write(f"G90 {word('X', (self.raw + x) / 2)} {word('Z', low)} F.2", "spigot")
            self.write(f"{word('X', x)}", "spigot")
        elif how == "G94":
            self.write(f"G94 {word('X', x)} {word('Z', low / 2)} F.15", "spigot")
            self.write(f"{word('Z', low)}", "spigot")
        else:
            self.write("G71 U1.5 R.5", "turn")
            self.write("G71 P10 Q20 U.4 W.1 F.2", "turn")
            self.write(f"N10 G0 {word('X', x)}", "turn")
            self.write(f"G1 {word('Z', low)} F.12", "spigot")
            self.write(f"N20 {word('X', self.raw + 1)}", "turn")
            if is_last:
                self.write("G70 P10 Q20", "turn")
        self.write("G0 Z2.", "turn")

    def finish(self, how: str) -> None:
        x, low = self.spigot, self.low
        if how in ("chamfer", "radius"):
            size = self.draw.choice((0.5, 1.0))
            self.write(f"G0 {word('X', x - 2 * size)} Z2. G99", "turn")
            self.write("G1 Z0. F.1", "turn")
            arc = f"G3 {word('X', x)} {word('Z', -size)} {word('R', size)}"
            self.write(arc if how == "radius" else f"{word('X', x)} {word('Z', -size)}", "turn")
            self.write(f"G1 {word('Z', low)}", "spigot")
        elif how == "cone" and self.raw - x > 5:
            self.write(f"G0 {word('X', x)} Z2. G99", "turn")
            self.write(f"G1 {word('Z', low + 1)} F.1", "spigot")
            self.write(f"{word('X', x + 2)} {word('Z', low)}", "turn")
        else:
            self.write(f"G0 {word('X', x)} Z2. G99", "turn")
            self.write(f"G1 {word('Z', low)} F.1", "spigot")
        self.write(f"{word('X', self.raw + 1)}", "turn")

    def bored(self) -> None:
        draw = self.draw
        drill = float(draw.randrange(6, 11))
        self.write("T0909", "call")
        self.write("G97 S900 M3", "turn")
        self.write("G0 X0. Z5. G99", "turn")
        if draw.random() < 0.5:
            self.write(f"G83 {word('Z', self.low)} Q4000 F.12", "drill")
            self.write("G80", "turn")
        else:
            self.write(f"G1 {word('Z', self.low)} F.12", "drill")
            self.write("G0 Z5.", "turn")
        self.home()
        self.bore = drill + 2
        self.tool(10, 1200)
        self.write(f"G0 {word('X', self.bore)} Z2. G99", "turn")
        self.write(f"G1 {word('Z', self.low + 1)} F.1", "bore")
        self.write(f"{word('X', drill)}", "turn")
        self.write("G0 Z2.", "turn")
        self.home()

    def groove(self) -> None:
        z = self.low - 4 if self.draw.random() < 0.6 else self.low + 1
        out, bottom = self.raw + 4, self.spigot - 3
        self.tool(8, 900)
        self.write(f"G0 {word('X', out)} {word('Z', z)} G99", "turn")
        if self.draw.random() < 0.5:
            self.write(f"G1 {word('X', bottom)} F.06", "turn")
            self.write(f"G0 {word('X', out)}", "turn")
        else:
            self.write("G75 R.3", "turn")
            self.write(f"G75 {word('X', bottom)} {word('Z', z)} P1000 F.06", "turn")
        self.home()

    def thread(self) -> None:
        self.tool(7, 700)
        self.write(f"G0 {word('X', self.raw + 4)} {word('Z', self.low - 6)} G99", "turn")
        root, z = self.raw - 1.2, self.low - 16
        self.write(f"G92 {word('X', self.raw - 0.5)} {word('Z', z)} F1.", "turn")
        self.write(f"{word('X', root)}", "turn")
        self.write("G0 X140.", "turn")
        self.home()

    # ---- milling ----

    def mill(self) -> None:
        draw, shape = self.draw, self.shape
        size = self.spigot
        depths: tuple[float, ...] = (-self.deep,)
        if draw.random() < 0.4:
            depths = (-self.deep / 2, -self.deep)
        radius = draw.choice((3.0, 4.0, 5.0, 6.0))
        if shape in ("polygon", "rectangle"):
            corners = self.polygon() if shape == "polygon" else self.rectangle()
            nearest = min(abs((a + b) / 2) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True))
            radius = max(radius, math.ceil((size / 2 - nearest) / 2 + 0.6))
            if draw.random() < 0.35:
                self.boss(1, radius, [corner * (1 + 0.3 / nearest) for corner in corners], depths)
                self.boss(2, radius, corners, depths[-1:])
            else:
                self.boss(1, radius, corners, depths)
        elif shape == "flats":
            count = draw.choice((1, 2, 3))
            far = size / 2 - draw.choice((1.5, 2.0, 3.0))
            for k in range(count):
                self.flat(1, radius, far, 360 / count * k, depths)
        elif shape == "pocket":
            inner = math.floor(size / 2 * draw.uniform(0.55, 0.7))
            radius = min(radius, math.floor(inner * 0.45))
            self.pocket(1, float(max(radius, 2)), float(inner), depths)
        else:
            radius = min(radius, 4.0)
            count = draw.choice((1, 2, 4))
            for k in range(count):
                self.slot(1, radius, 360 / count * k, depths)

    def polygon(self) -> list[complex]:
        sides = self.draw.choice((4, 6, 8))
        across = round(self.spigot * self.draw.uniform(0.78, math.cos(math.pi / sides) + 0.04), 1)
        reach, turn = across / 2 / math.cos(math.pi / sides), math.pi / sides
        return [reach * complex(math.cos(a), math.sin(a)) for a in (turn - math.tau / sides * k for k in range(sides))]

    def rectangle(self) -> list[complex]:
        x = round(self.spigot * self.draw.uniform(0.36, 0.4), 1)
        c = round(self.spigot * self.draw.uniform(0.28, 0.34), 1)
        return [complex(x, c), complex(x, -c), complex(-x, -c), complex(-x, c)]

    def call(self, tool: int, radius: float) -> None:
        if tool in self.radii:
            return
        if self.radii:
            self.write("G0 Z60.", "home")
            self.write("M5", "start")
        self.radii[tool] = radius
        self.write(f"T{tool:02}{tool:02}", "call")
        self.write("G98", "start")
        self.write("G97 S3000 M13", "start")
        self.write("G28 H0", "start")

    def enter(self, x: float, c: float, high: float = 2.0) -> None:
        self.section = 1 + max(line.section for line in self.lines)
        self.write(f"G0 {word('Z', high)}", "above")
        self.write(f"C{number(c) if c else '0'}", "index")
        self.write(word("X", x), "approach")
        self.write("G12.1", "on")

    def leave(self) -> None:
        self.write("Z2. F1500", "retract")
        self.write("G13.1", "off")
        self.write("G0 Z20.", "clear")
        self.section = -1

    def clear_of(self, radius: float) -> float:
        """X that clears the bar at the depth of the mills, as a diameter."""
        return float(math.ceil(self.spigot + 2 * radius + 3))

    def boss(self, tool: int, radius: float, corners: list[complex], depths: tuple[float, ...]) -> None:
        """Run clockwise with G41, from a lead on the extension of the last side."""
        self.call(tool, radius)
        x = self.clear_of(radius)
        along = (corners[1] - corners[0]) / abs(corners[1] - corners[0])
        before = corners[0] - along * (self.spigot / 2 + radius)
        away = before + 1j * along * (radius + 2)
        far = max(x / 2, abs(away))
        self.enter(round(2 * far + 1, 0), 0)
        self.write(f"G1 {word('X', 2 * away.real)} {word('C', away.imag)} F1500", "lead")
        for depth in depths:
            self.write(f"G1 {word('Z', depth)} F300", "depth")
            self.write(f"G41 {word('X', 2 * before.real)} {word('C', before.imag)} F250", "ramp")
            for place, corner in enumerate([*corners, corners[0], corners[0] + along * 0.5]):
                # The first point and the last one lie on the first wall, wherever they stand on it.
                role = "contour" if 0 < place <= len(corners) else "overlap"
                self.write(f"{word('X', 2 * corner.real)} {word('C', corner.imag)}", role)
            out = corners[0] + along * 0.5 + 1j * along * (self.spigot / 2 + radius)
            self.write(f"G40 {word('X', 2 * out.real)} {word('C', out.imag)} F1500", "cancel")
            if depth != depths[-1]:
                self.write("Z2.", "lift")
                self.write(f"{word('X', 2 * away.real)} {word('C', away.imag)}", "lead")
        self.leave()

    def flat(self, tool: int, radius: float, far: float, c: float, depths: tuple[float, ...]) -> None:
        self.call(tool, radius)
        x = max(self.clear_of(radius), 2 * far + 2 * radius + 6)
        out = self.spigot / 2 + radius + 3
        self.enter(x, c)
        for depth in depths:
            self.write(f"G1 {word('X', x)} {word('C', out)} F1500", "lead")
            self.write(f"{word('Z', depth)} F300", "depth")
            self.write(f"G41 {word('X', 2 * far)} F250", "ramp")
            self.write(f"{word('C', -out)}", "contour")
            self.write(f"G40 {word('X', x)} F1500", "cancel")
            if depth != depths[-1]:
                self.write("Z2.", "lift")
        self.leave()

    def pocket(self, tool: int, radius: float, inner: float, depths: tuple[float, ...]) -> None:
        """A round groove in the face: one circle of the tool center."""
        self.call(tool, radius)
        start = round(inner - radius - 0.5, 3)
        self.enter(2 * start, 0)
        for depth in depths:
            self.write(f"G1 {word('X', 2 * start)} C0. F900", "lead")
            self.write(f"{word('Z', depth)} F60", "depth")
            self.write(f"G3 {word('X', 2 * start)} C0. {word('I', -start)} J0. F200", "contour")
            self.write("G1 Z2. F900", "lift")
        self.leave()

    def slot(self, tool: int, radius: float, c: float, depths: tuple[float, ...]) -> None:
        """From outside towards X0, of the width of the cutter, and lifted out."""
        self.call(tool, radius)
        x = self.clear_of(radius)
        self.enter(x, c)
        inner = round(self.spigot * self.draw.uniform(0.4, 0.6), 1)
        for depth in depths:
            self.write(f"G1 {word('X', x)} C0. F1500", "lead")
            self.write(f"{word('Z', depth)} F300", "depth")
            self.write(f"{word('X', inner)} F90", "contour")
            self.write("Z2. F500", "lift")
        self.leave()


def drawn(seed: int) -> Program:
    """The program of a seed."""
    return Writer(seed).program()


# ---- slips ----

#: Blocks in the place of one; none for a block that is left out.
Change = Callable[[Program, int, random.Random], "list[str] | None"]


class Kind(NamedTuple):
    """A kind of slip: in blocks of some roles, of programs of some shapes, of tools of these numbers."""

    roles: tuple[str, ...]
    change: Change
    shapes: tuple[str, ...] = SHAPES
    fits: Callable[[Program], bool] = lambda program: True


def _words(text: str) -> dict[str, str]:
    return {one[0]: one[1:] for one in text.split()}


def _scaled(address: str, factor: float, least: float = 0.5) -> Change:
    def change(program: Program, index: int, draw: random.Random) -> list[str] | None:
        text = program.lines[index].text
        written = _words(text).get(address)
        if written is None or abs(float(written)) < least:
            return None
        return [text.replace(address + written, word(address, float(written) * factor))]

    return change


def _moved(address: str, by: float) -> Change:
    """Nearer to X0 by a length, of X on the diameter."""

    def change(program: Program, index: int, draw: random.Random) -> list[str] | None:
        text = program.lines[index].text
        value = float(_words(text).get(address, "0"))
        if abs(value) <= abs(by):
            return None
        return [text.replace(address + _words(text)[address], word(address, value - math.copysign(by, value)))]

    return change


def _swapped(address: str) -> Change:
    def change(program: Program, index: int, draw: random.Random) -> list[str] | None:
        text = program.lines[index].text
        written = _words(text).get(address, "")
        whole = written.lstrip("-").partition(".")[0]
        if len(whole) != 2 or abs(int(whole[0]) - int(whole[1])) < 2:
            return None
        return [text.replace(address + written, address + written.replace(whole, whole[::-1], 1))]

    return change


def _text(old: str, new: str) -> Change:
    def change(program: Program, index: int, draw: random.Random) -> list[str] | None:
        text = program.lines[index].text
        return [text.replace(old, new)] if old in text else None

    return change


def _without(program: Program, index: int, draw: random.Random) -> list[str] | None:
    return []


def _with(block: str) -> Change:
    return lambda program, index, draw: [program.lines[index].text, block]


def _has_two_tools(program: Program) -> bool:
    return len(program.radii) == 2


def _farther_in(section: int) -> Change:
    """A corner of the roughing, section 0, or of the finish, section 1."""

    def change(program: Program, index: int, draw: random.Random) -> list[str] | None:
        return _scaled("X", 0.8, 5.0)(program, index, draw) if program.lines[index].section == section else None

    return change


def _shows_corner(program: Program) -> bool:
    """One tool cuts six sides or more: of a square any corner may be meant, and what a roughing leaves is finished."""
    passes = sum(line.role == "depth" for line in program.lines)
    return len(program.radii) == 1 and sum(line.role == "contour" for line in program.lines) >= 6 * passes


def _rough_at_c20(program: Program, index: int, draw: random.Random) -> list[str] | None:
    return ["C20."] if program.lines[index].section == 0 else None


def _is_deep(program: Program) -> bool:
    """Ten times the depth is far below the spigot and several times as deep as the cutter is wide."""
    deep = min(float(_words(line.text)["Z"]) for line in program.lines if line.role == "depth") * 10
    return program.raw >= program.spigot + 6 and deep < min(program.low, -6 * max(program.radii.values()))


def _longer(program: Program, index: int, draw: random.Random) -> list[str] | None:
    """`Z-33.7` for `Z-3.7`, where that is ten times as much or more."""
    text = program.lines[index].text
    written = _words(text)["Z"]
    return [text.replace("Z" + written, "Z-" + written[1] + written[1:])] if written[1] not in "0." else None


def _is_turned_at_once(program: Program) -> bool:
    return program.raw >= program.spigot + 6 and sum(line.role == "spigot" for line in program.lines) == 1


_BOSS, _OPEN, _ONE, _WITH_G41 = ("polygon", "rectangle"), ("slots",), ("polygon",), ("polygon", "rectangle", "flats")
KINDS: dict[str, Kind] = {
    "lead inside the bar": Kind(("lead",), _moved("X", 12.0), ("slots",)),
    "depth ten times": Kind(("depth",), _scaled("Z", 10), SHAPES, _is_deep),
    "digit too many in the depth": Kind(("depth",), _longer, SHAPES, _is_deep),
    "sign of the depth": Kind(("depth",), _scaled("Z", -1)),
    "depth is missing": Kind(("depth",), _without),
    "rapid traverse below the face": Kind(("above",), _text("Z2.", "Z-2."), ("pocket",)),
    "rapid traverse far below the face": Kind(("above",), _text("Z2.", "Z-20."), ("pocket",)),
    "contour X ten times": Kind(("contour",), _scaled("X", 10), _ONE, _shows_corner),
    "contour C ten times": Kind(("contour",), _scaled("C", 10), _ONE, _shows_corner),
    "contour X without its sign": Kind(("contour",), _scaled("X", -1), _ONE, _shows_corner),
    "contour C without its sign": Kind(("contour",), _scaled("C", -1), _ONE, _shows_corner),
    "contour X as a radius": Kind(("contour",), _scaled("X", 0.5), _ONE, _shows_corner),
    "contour X doubled": Kind(("contour",), _scaled("X", 2), _ONE, _shows_corner),
    "contour C doubled": Kind(("contour",), _scaled("C", 2), _ONE, _shows_corner),
    "contour C halved": Kind(("contour",), _scaled("C", 0.5), _ONE, _shows_corner),
    "digits of X swapped": Kind(("contour",), _swapped("X"), _ONE, _shows_corner),
    "digits of C swapped": Kind(("contour",), _swapped("C"), _ONE, _shows_corner),
    "corner is missing": Kind(("contour",), _without, _ONE, _shows_corner),
    "G42 for G41": Kind(("ramp",), _text("G41", "G42"), _WITH_G41),
    "G41 is missing": Kind(("ramp",), _text("G41 ", ""), _WITH_G41),
    "G40 is missing": Kind(("cancel",), _text("G40 ", ""), _WITH_G41),
    "block of G40 is missing": Kind(("cancel",), _without, _WITH_G41),
    "roughing at another C": Kind(("index",), _rough_at_c20, _BOSS, _has_two_tools),
    "spigot too short": Kind(("spigot",), _scaled("Z", 0.1), _OPEN, _is_turned_at_once),
    "roughing too far in": Kind(("contour",), _farther_in(0), _BOSS, _has_two_tools),
    "finish too far in": Kind(("contour",), _farther_in(1), _BOSS, _has_two_tools),
    "G13.1 is missing": Kind(("off",), _without),
    "G12.1 is missing": Kind(("on",), _without, ("pocket", *_WITH_G41)),
    "turret turns in the mode": Kind(("contour",), _with("T0808"), _WITH_G41),
    "unit of the program": Kind(("head",), _text("G21", "G20")),
    "lead in rapid traverse": Kind(("lead",), _text("G1 ", "G0 ")),
}


def slipped(program: Program, name: str) -> Program | None:
    """The program with a slip of this kind; None where it has no place for one."""
    kind, draw = KINDS[name], random.Random(f"{program.seed} {name}")  # noqa: S311 - slips that can be drawn again
    if program.shape not in kind.shapes or not kind.fits(program):
        return None
    places = [index for index, line in enumerate(program.lines) if line.role in kind.roles]
    draw.shuffle(places)
    for index in places:
        texts = kind.change(program, index, draw)
        if texts is not None and texts != [program.lines[index].text]:
            line = program.lines[index]
            changed = tuple(line._replace(text=text) for text in texts)
            return program._replace(lines=(*program.lines[:index], *changed, *program.lines[index + 1 :]))
    return None
