"""
Programs in the styles of posts and of people, drawn by a seed: 100 of them for lathes of five makers of controls.

A style says how the words look and what stands around them; a lathe says which words there are. What is milled and
turned is the same kind of work in all of them: turning, contours with and without compensation, pockets, depths,
sections at several angles of C, holes on the face.
"""

from __future__ import annotations

import cmath
import math
import random
from typing import NamedTuple

STYLES = ("autodesk", "nx", "mastercam", "esprit", "gibbscam", "by hand")


class Lathe(NamedTuple):
    """The words of a lathe; X words are diameters outside of the mode, there too where `diameter` says so."""

    machine: str
    system: str = "A"
    virtual: str = "C"
    diameter: bool = True
    line: str = "G1"
    arcs: tuple[str, str] = ("G2", "G3")
    radius: str = "R"
    centers: bool = True
    before: str = ""
    on: str = "G12.1"
    behind: str = ""
    off: str = "G13.1"
    after: str = ""
    engage: str = ""
    release: str = ""
    reference: str = "G28 H0"
    start: str = "G97 S{speed} M3"
    stop: str = "M5"
    spin: str = "G97 S{speed} M3"
    units: tuple[str, str] = ("G21", "G20")
    rapids: bool = False
    turn_feed: str = "G99"
    minute_feed: str = "G98"
    home: str = "G28 U0\nG28 W0"
    calls: bool = True
    loops: bool = True
    comment: str = "({})"
    split: float = 180.0
    tool: str = "T{0:02d}{0:02d}"
    drilling: str = "G83"
    point: bool = True


LATHES = (
    Lathe("fanuc-30i"),
    Lathe("takisawa", engage="M76", release="M75", start="G97 S{speed} M70", stop="M72", split=120),
    Lathe("doosan", engage="M35", release="M34", behind="G18", split=120),
    Lathe("haas-lathe", virtual="Y", diameter=False, before="G17", on="G112", off="G113", after="G18", engage="M154",
          release="M155", start="G97 P{speed} M133", stop="M135", rapids=True, loops=True, split=120),
    Lathe("siemens-transmit", "S", "Y", False, radius="CR=", before="DIAMOF", on="TRANSMIT", behind="G17",
          off="TRAFOOF", after="DIAMON", reference="", start="S3={speed} M3=3", stop="M3=5", spin="S{speed} M3",
          units=("G710", "G700"), rapids=True, turn_feed="G95", minute_feed="G94", home="", calls=False, loops=False,
          comment="; {}", tool="T{0} D1", drilling=""),
    Lathe("okuma-osp", "B", "Y", False, "G101", ("G102", "G103"), "L", False, "", "G137 C0", "G17", "G136", "", "M110",
          "M109", "", "G97 SB={speed} M13", "M12", "G97 S{speed} M3", ("", ""), False, "G95", "G94", "", False, False,
          split=90, tool="T{0:02d}{0:02d}{0:02d}", drilling=""),
    Lathe("mazak-quick-turn", before="G17 XC", engage="M200", release="M202", reference="", start="G97 S{speed} M203",
          stop="M205", split=120),
    Lathe("mazak-integrex", "B", "C", False, before="G10.9 X0\nG17 XC", after="G10.9 X1", engage="M200", release="M202",
          reference="", start="G97 S{speed} M3", stop="M5", spin="G97 S{speed} M203", turn_feed="G95",
          minute_feed="G94", home="G28 X0 Z0", tool="T{0:02d}.01 M6"),
)  # fmt: skip
BY_MACHINE = {lathe.machine: lathe for lathe in LATHES}


class Drawn(NamedTuple):
    """A program. tools: for the option --tool; their radii are in the units of the program."""

    name: str
    machine: str
    text: str
    tools: tuple[str, ...]
    inch: bool


class Piece(NamedTuple):
    """A line, or an arc about its center, up to its end on the part [mm]."""

    end: complex
    center: complex | None = None
    clockwise: bool = False


def programs(count: int = 100) -> list[Drawn]:
    """Return so many programs: all styles on all lathes in turn."""
    return [drawn(seed) for seed in range(count)]


def drawn(seed: int) -> Drawn:
    """Return the program of a seed."""
    lathe = LATHES[seed % len(LATHES)]
    style = STYLES[(seed // len(LATHES) + seed) % len(STYLES)]
    return _Writer(lathe, style, random.Random(seed)).program(f"{style} {seed}")  # noqa: S311


class _Writer:
    def __init__(self, lathe: Lathe, style: str, random_: random.Random) -> None:
        self.lathe, self.style, self.random = lathe, style, random_
        # An Okuma counts in mm; one in four others is in inch.
        self.inch = bool(lathe.units[0]) and random_.random() < 0.25
        self.lines: list[str] = []
        self.subs: list[list[str]] = []
        self.motion, self.words = "", dict[str, str]()
        self.number = 0
        self.places = 4 if self.inch else 3

    # ---- words ----

    def value(self, length: float) -> str:
        number = length / 25.4 if self.inch else length
        if self.style == "esprit":
            return (
                f"{number:.{self.places}f}".replace("-0.000", "0.000") if abs(number) > 1e-6 else f"{0:.{self.places}f}"
            )
        text = f"{number:.{self.places}f}".rstrip("0")
        text = "0." if text in ("-0.", "0.") else text
        if self.style in ("mastercam", "by hand"):
            text = text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) and len(text.strip("-")) > 2 else text
        return text

    def feed(self, rate: float, per_turn: bool = False) -> str:
        number = rate / 25.4 if self.inch else rate
        text = f"{number:.4f}".rstrip("0") if per_turn else f"{number:.2f}".rstrip("0")
        return f"F{text if self.lathe.point or '.' not in text[:-1] else text.rstrip('.')}"

    def code(self, code: str) -> str:
        if self.style in ("nx", "gibbscam") and len(code) == 2 and code[0] in "GM":
            return f"{code[0]}0{code[1]}"
        return code

    def block(self, *words: str) -> None:
        for text in "\n".join((" ".join(filter(None, words)),)).split("\n"):
            parts = [self.code(word) for word in text.split()]
            if not parts:
                continue
            if self.lathe.system != "S" and self.style == "mastercam" and "=" not in text and "XC" not in text:
                self.lines.append("".join(parts))
            else:
                self.lines.append(self.numbered(" ".join(parts)))

    def numbered(self, text: str) -> str:
        if self.style == "nx":
            self.number += 10
            return f"N{self.number:04d} {text}"
        if self.style == "gibbscam":
            self.number += 1
            return f"N{self.number} {text}"
        return text

    def say(self, text: str) -> None:
        self.lines.append(self.lathe.comment.format(text))

    def blocks(self, text: str, **values: int) -> None:
        for line in text.format(**values).split("\n"):
            self.block(line)

    # ---- moves ----

    def go(self, code: str, x: float | None = None, z: float | None = None, c: float | None = None, *more: str) -> None:
        """A move outside of the mode. x: radius [mm], c: angle [deg]."""
        by_hand = self.style == "by hand"
        words = [code] if code != self.motion or not by_hand else []
        self.motion = code
        words += [f"X{self.value(2 * x)}"] if x is not None else []
        words += [f"Z{self.value(z)}"] if z is not None else []
        words += [f"C{c:g}{'' if '.' in f'{c:g}' else '.'}"] if c is not None else []
        self.block(*words, *more)

    def inside(self, code: str, *words: str) -> None:
        is_modal = self.style in ("mastercam", "by hand", "gibbscam")
        self.block(*([code] if code != self.motion or not is_modal else []), *words)
        self.motion = code

    def place(self, point: complex, last: complex | None = None) -> list[str]:
        """The words of a point in the mode; those that stay are left out by posts that do so."""
        factor, words = 2 if self.lathe.diameter else 1, []
        drops = self.style in ("mastercam", "by hand", "gibbscam", "nx") and last is not None
        if not drops or abs(point.real - last.real) > 5e-4:  # type: ignore[union-attr]
            words.append(f"X{self.value(factor * point.real)}")
        if not drops or abs(point.imag - last.imag) > 5e-4:  # type: ignore[union-attr]
            words.append(f"{self.lathe.virtual}{self.value(point.imag)}")
        return words

    def line(self, start: complex, end: complex, *more: str) -> None:
        self.inside(self.lathe.line, *self.place(end, start), *more)

    def arc(self, start: complex, piece: Piece, *more: str) -> None:
        """An arc, in parts where the lathe or the post has a limit; by its center or its radius."""
        assert piece.center is not None
        turn = cmath.phase((piece.end - piece.center) / (start - piece.center))
        if piece.clockwise:
            turn -= 2 * math.pi * (turn >= -1e-9)
        else:
            turn += 2 * math.pi * (turn <= 1e-9)
        by_center = self.lathe.centers and self.style in ("autodesk", "nx", "gibbscam")
        limit = min(self.lathe.split, 360.0 if by_center else 120.0)
        parts = math.ceil(abs(math.degrees(turn)) / limit - 1e-6)
        for index in range(1, parts + 1):
            end = piece.center + (start - piece.center) * cmath.exp(1j * turn / parts)
            end = piece.end if index == parts else end
            toward = piece.center - start
            how = [f"I{self.value(toward.real)}", f"J{self.value(toward.imag)}"]
            how = how if by_center else [f"{self.lathe.radius}{self.value(abs(toward))}"]
            words = self.place(end, None if abs(end - start) < 1e-6 else start)
            self.inside(self.lathe.arcs[0 if piece.clockwise else 1], *words, *how, *more)
            start, more = end, ()

    # ---- the program ----

    def program(self, name: str) -> Drawn:
        draw, lathe = self.random, self.lathe
        number = draw.randrange(1, 8000)
        self.head(number, name.upper())
        mill, radius = draw.randrange(2, 12), draw.choice([2.0, 3.0, 4.0, 5.0])
        if self.inch:
            radius = draw.choice([0.125, 0.1875, 0.25]) * 25.4
        if draw.random() < 0.6:
            self.turning(1)
        self.call(mill, f"END MILL D{self.value(2 * radius).strip('0')}")
        self.mill_on(draw.choice([1500, 2000, 3200]))
        sections = draw.choice([1, 1, 2, 3])
        for index in range(sections):
            turned = (0.0 if index == 0 or not lathe.reference else draw.choice([0.0, 60.0, 90.0, 180.0])) % 360
            self.section(radius, turned, index)
        if lathe.drilling and draw.random() < 0.4:
            self.holes(draw.choice([3, 4, 6]))
        self.mill_off()
        self.end()
        text = "\n".join(self.lines) + "\n"
        length = radius / 25.4 if self.inch else radius
        return Drawn(name, lathe.machine, text, (f"{mill}:radius={length:g}",), self.inch)

    def head(self, number: int, name: str) -> None:
        lathe = self.lathe
        units = lathe.units[self.inch]
        takes_percent = lathe.system != "S" and lathe.machine != "okuma-osp"
        if (takes_percent and self.style != "by hand") or (self.random.random() < 0.3 and takes_percent):
            self.lines.append("%")
        comment = lathe.comment.format
        if lathe.system == "S":
            self.say(name)
        else:
            first = {"mastercam": f"O{number:04d}({name})", "nx": f"O{number:04d}", "esprit": f"O{number:04d}"}
            self.lines.append(first.get(self.style, f"O{number} {comment(name)}"))
        plane = "G18" if lathe.machine != "okuma-osp" else ""
        if self.style == "autodesk":
            self.say("T20 D=8. CR=0. TAPER=118DEG - ZMIN=-4. - DRILL")
            self.block(lathe.minute_feed, plane)
            self.block(units)
        elif self.style == "nx":
            self.block("G40", plane, lathe.minute_feed, "" if lathe.system == "A" else "G90", units)
        elif self.style == "mastercam":
            self.say("DATE=12-03-24 - TIME=10:15")
            self.say("MATERIAL - STEEL MM - 1045")
            self.block(units)
        elif self.style == "esprit":
            self.say("POST: TURNMILL  DATE: 12.03.2024")
            self.block(units, "G40", lathe.minute_feed)
        elif self.style == "gibbscam":
            self.say(f"PROGRAM: {name}")
            self.say("FORMAT: LATHE MILL/TURN")
            self.block(units, "G40", "" if lathe.machine in ("okuma-osp", "siemens-transmit") else "G80")
        else:
            self.block(units, lathe.minute_feed)
        if lathe.system == "S":
            self.block("G90", "DIAMON")

    def call(self, tool: int, what: str) -> None:
        call = self.lathe.tool.format(tool)
        if self.style == "autodesk":
            if self.lathe.home:
                self.blocks(self.lathe.home)
            self.say(what)
            self.block("M1")
        elif self.style in ("mastercam", "gibbscam", "esprit"):
            self.say(f"TOOL - {tool} OFFSET - {tool}" if self.style == "mastercam" else f"OPERATION: {what}")
        self.block(*(("G0",) if self.style == "mastercam" else ()), call)
        self.motion = "G0" if self.style == "mastercam" else self.motion

    def turning(self, tool: int) -> None:
        """The face, and the bar to its diameter, by feed per revolution."""
        lathe, draw = self.lathe, self.random
        self.call(tool, "TURNING TOOL")
        radius = 40.0
        if draw.random() < 0.5 and self.style != "by hand":
            if lathe.machine not in ("siemens-transmit",):
                self.block("G50" if lathe.system == "A" or lathe.machine == "okuma-osp" else "G92", "S2500")
            speed = 180 if not self.inch else 600
            self.block("G96", f"S{speed}", "M3" if lathe.machine != "mazak-integrex" else "M203")
        else:
            self.blocks(lathe.spin, speed=1200)
        self.go("G0", radius + 2, 0.0, None, "M8")
        self.block(lathe.turn_feed)
        self.go("G1", 0.0 if draw.random() < 0.5 else -0.8, None, None, self.feed(0.2, per_turn=True))
        self.go("G0", None, 2.0)
        self.go("G0", radius)
        self.go("G1", None, -12.0, None, self.feed(0.25, per_turn=True))
        if self.style in ("gibbscam", "esprit"):
            self.block("G3", f"X{self.value(2 * radius + 4)}",
                       f"Z{self.value(-14.0)}", f"{lathe.radius}{self.value(2.0)}")  # fmt: skip
            self.motion = "G3"
        self.go("G1", radius + 3)
        self.go("G0", 60.0, 50.0, None, "M9")
        self.block("G97", "S500")
        self.block("M205" if lathe.machine == "mazak-integrex" else "M5")

    def mill_on(self, speed: int) -> None:
        lathe = self.lathe
        if lathe.engage:
            self.block(lathe.engage)
        if lathe.reference:
            self.block(lathe.reference if self.style != "gibbscam" else lathe.reference.replace("H0", "H0."))
        self.blocks(lathe.start, speed=speed)
        self.block(lathe.minute_feed)
        if self.style in ("autodesk", "nx", "gibbscam"):
            self.block("M8")

    def mill_off(self) -> None:
        self.block("M9") if self.style != "by hand" else None
        self.block(self.lathe.stop)
        if self.lathe.release:
            self.block(self.lathe.release)

    def section(self, radius: float, turned: float, index: int) -> None:
        draw, lathe = self.random, self.lathe
        pieces, is_pocket, start = _shape(draw, radius)
        has_side = draw.random() < 0.6
        name = "POCKET" if is_pocket else "CONTOUR"
        if self.style in ("esprit", "gibbscam", "autodesk"):
            self.say(f"{name} {index + 1}")
        far = 50.0 if not is_pocket else start.real - radius - 1.0
        first = complex(far, 0.0)
        self.go("G0", far if draw.random() < 0.7 or is_pocket else far + 5, None, turned)
        self.go("G0", None, 2.0)
        for line in filter(None, lathe.before.split("\n")):
            self.block(line)
        self.block(lathe.on)
        for line in filter(None, lathe.behind.split("\n")):
            self.block(line)
        self.motion = ""
        rapid = "G0" if lathe.rapids and draw.random() < 0.7 else lathe.line
        self.inside(rapid, *self.place(first), *([self.feed(1500)] if rapid != "G0" else []))
        depths = sorted({round(-draw.uniform(1, 6), 2) for _ in range(draw.choice([1, 1, 2, 3]))}, reverse=True)
        how = "plain"
        if lathe.calls and self.style in ("gibbscam", "by hand") and len(depths) > 1:
            how = "called"
        if lathe.loops and self.style == "by hand" and len(depths) > 1 and draw.random() < 0.5:
            how = "loop"
        side = ("G41" if is_pocket else "G42") if has_side else ""
        rate = draw.choice([120.0, 180.0, 250.0])
        if how == "loop":
            step = abs(depths[-1]) / len(depths)
            number = self.value(step)
            self.lines.append("#100=0")
            self.lines.append(f"WHILE[#100LT{self.value(step * len(depths) - 0.05)}]DO1")
            self.lines.append(f"#100=#100+{number}")
            self.motion = ""
            self.inside(lathe.line, "Z-#100" if draw.random() < 0.5 else "Z[-#100]", self.feed(80))
            self.round(pieces, first, start, side, rate, radius)
            self.lines.append("END1")
        elif how == "called":
            for depth in depths:
                self.inside(lathe.line, f"Z{self.value(depth)}", self.feed(80))
                self.block("M98", f"P{9000 + len(self.subs)}")
                self.motion = ""
            self.lines, saved, self.motion = [], self.lines, ""
            self.round(pieces, first, start, side, rate, radius)
            self.block("M99")
            self.subs.append(self.lines)
            self.lines, self.motion = saved, ""
        else:
            for depth in depths:
                self.inside(lathe.line, f"Z{self.value(depth)}", self.feed(80))
                self.round(pieces, first, start, side, rate, radius)
        if draw.random() < 0.15:
            self.block("G4", "F1." if lathe.machine in ("okuma-osp", "siemens-transmit") else "P500")
        out = "G0" if lathe.rapids and draw.random() < 0.7 else lathe.line
        self.inside(out, f"Z{self.value(2.0)}", *([self.feed(1500)] if out != "G0" else []))
        self.block(lathe.off)
        for line in filter(None, lathe.after.split("\n")):
            self.block(line)
        self.motion = ""
        self.go("G0", None, 20.0)

    def round(self, pieces: list[Piece], first: complex, start: complex, side: str, rate: float, radius: float) -> None:
        """From the first point to the contour, round it, and back: with G41 or G42 where there is a side."""
        draw = self.random
        inward = -1 if first.real < start.real else 1
        by_arc = draw.random() < 0.5 and self.style != "by hand"
        lead = radius + 1.5
        # The lead-in ends on the contour in its direction.
        corner = start + inward * lead
        if by_arc:
            begin = corner - 1j * lead
            self.line(first, begin, *([side] if side else []), self.feed(rate))
            clockwise = ((start - corner) / (begin - corner)).imag < 0
            self.arc(begin, Piece(start, corner, clockwise))
        else:
            self.line(first, start, *([side] if side else []), self.feed(rate))
        here = start
        for piece in pieces:
            if piece.center is None:
                self.line(here, piece.end)
            else:
                self.arc(here, piece)
            here = piece.end
        if by_arc:
            leave = corner + 1j * lead
            clockwise = ((leave - corner) / (start - corner)).imag < 0
            self.arc(here, Piece(leave, corner, clockwise))
            here = leave
        self.line(here, first, *(["G40"] if side else []))

    def holes(self, count: int) -> None:
        """Holes on the face, by the cycle of the lathe."""
        self.say("HOLES")
        self.go("G0", 15.0, 5.0, 0.0)
        cycle = [
            self.lathe.drilling,
            f"Z{self.value(-10.0)}",
            f"R{self.value(-3.0)}",
            f"Q{3000 if not self.inch else 1000}",
        ]
        cycle = [word for word in cycle if self.lathe.machine != "haas-lathe" or word[0] != "Q"]
        for index in range(count):
            angle = f"C{360 * index / count:g}."
            self.block(*(cycle if not index else []), angle, *([self.feed(100)] if not index else []))
        self.block("G80")
        self.motion = ""

    def end(self) -> None:
        self.motion = ""
        if self.lathe.home and self.style != "by hand":
            self.blocks(self.lathe.home)
        else:
            self.go("G0", 80.0, 100.0)
        self.block("M30" if self.lathe.machine != "okuma-osp" else "M2")
        for index, sub in enumerate(self.subs):
            self.lines.append(f"O{9000 + index}")
            self.lines += sub
        if self.lines[0] == "%":
            self.lines.append("%")


def _shape(draw: random.Random, radius: float) -> tuple[list[Piece], bool, complex]:
    """A closed contour about the center of C from a point on its right side; whether it is a pocket; the point."""
    kind = draw.choice(["rounded", "rounded", "hexagon", "flats", "pocket", "circle"])
    if kind == "circle":
        size = round(draw.uniform(3 * radius + 4, 28), 2)
        return [Piece(complex(-size, 0), 0j), Piece(complex(size, 0), 0j)], draw.random() < 0.5, complex(size, 0)
    if kind == "hexagon":
        apothem = round(draw.uniform(12, 20), 2)
        corners = [cmath.rect(apothem / math.cos(math.pi / 6), math.radians(30 + 60 * index)) for index in range(6)]
        points = [complex(round(point.real, 4), round(point.imag, 4)) for point in corners]
        return [*(Piece(point) for point in points), Piece(complex(apothem, 0))], False, complex(apothem, 0)
    half, height = (round(draw.uniform(3 * radius + 4, high), 2) for high in (28, 26))
    corner = round(draw.uniform(1.5, 4) + (radius if kind == "pocket" else 0), 2)
    if kind == "flats":
        angle = math.acos(min(height, 24.0) / 30)
        right, left = cmath.rect(30.0, math.pi / 2 - angle), cmath.rect(30.0, math.pi / 2 + angle)
        pieces = [
            Piece(right, 0j),
            Piece(left),
            Piece(left.conjugate(), 0j),
            Piece(right.conjugate()),
            Piece(30 + 0j, 0j),
        ]
        return pieces, False, 30 + 0j
    result, point = list[Piece](), complex(half, 0)
    for across, along in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        center = complex(across * (half - corner), along * (height - corner))
        right, top = complex(across * half, center.imag), complex(center.real, along * height)
        first, second = (right, top) if across == along else (top, right)
        result += [Piece(first), Piece(second, center)]
    return [*result, Piece(point)], kind == "pocket", point
