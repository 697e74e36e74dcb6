"""Writes blocks as somebody writes them, in the words of a control."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

from milled_shapes import Piece
from setter_dialects import Dialect


class Line(NamedTuple):
    """A block, what it is for, and the number of its section (-1 outside)."""

    text: str
    role: str
    section: int = -1


class Style(NamedTuple):
    """
    How somebody writes.

    repeats: all words in each block, as CAM posts do. repeats_z: Z, too. packed: without spaces. centers: I and J.
    steps: incremental words in contours. zeros: numbers with all their decimals. numbers: N words. lead: how a contour
    is approached, "normal", "aside", "arc", or as milled_shapes.led has it. from_above: Z goes down in the mode.
    leaves_at_depth: G13.1 before Z.
    """

    repeats: bool
    repeats_z: bool
    packed: bool
    centers: bool
    steps: bool
    zeros: bool
    numbers: bool
    lead: str
    from_above: bool
    leaves_at_depth: bool


class Pen:
    """Writes the blocks of a program."""

    def __init__(self, dialect: Dialect, style: Style, inch: bool) -> None:
        self.dialect, self.style, self.scale = dialect, style, 25.4 if inch else 1.0
        self.digits = 4 if inch else 3
        self.lines: list[Line] = []
        self.section = -1
        self.motion, self.feed = "", ""
        self.x, self.c, self.z = "", "", ""
        self.at = 0j
        self.is_step = False

    def number(self, value: float) -> str:
        text = f"{value / self.scale:.{self.digits}f}"
        if self.style.zeros:
            return text.removeprefix("-") if not float(text) else text
        text = text.rstrip("0")
        if not float(text):
            return "0"
        return text.replace("0.", ".", 1) if self.scale > 1 and abs(float(text)) < 1 else text

    def height(self, z: float) -> str:
        """The number of a Z [mm above the face]."""
        return self.number(z * self.dialect.outward)

    def write(self, role: str, *words: str) -> None:
        text = ("" if self.style.packed else " ").join(word for word in words if word)
        if text:
            self.lines.append(Line(text, role, self.section))

    def remark(self, text: str, role: str = "remark") -> None:
        self.lines.append(Line(self.comment(text), role, self.section))

    def comment(self, text: str) -> str:
        return text.join(self.dialect.remark)

    def rapid(self, role: str, x: float | None = None, z: float | None = None, c: float | None = None) -> None:
        """A move by G0 outside of the mode; x: a radius [mm], c: [deg]."""
        words = ["G0"]
        if x is not None:
            words.append("X" + self.number(x * (2 if self.dialect.diameter_outside else 1)))
        if z is not None:
            self.z = self.height(z)
            words.append("Z" + self.z)
        if c is not None:
            words.append("C" + (f"{c:g}." if c else "0"))
        self.motion = "G0"
        self.write(role, *words)

    def enter(self, x: float) -> None:
        for block in self.dialect.before:
            self.write("before", block)
        self.lines.append(Line(self.dialect.on, "on", self.section))
        for block in self.dialect.behind:
            self.write("behind", block)
        self.at = complex(x, 0)
        self.x, self.c = self.x_word(x), self.number(0.0)

    def leave(self) -> None:
        self.lines.append(Line(self.dialect.off, "off", self.section))
        if self.dialect.machine == "siemens-transmit":
            self.write("behind", "DIAMON")
        self.motion = ""

    def x_word(self, x: float) -> str:
        return self.number(x * (2 if self.dialect.diameter_inside else 1))

    def depth(self, z: float, feed: float, role: str = "plunge") -> None:
        self.z = self.height(z)
        codes = ("G90",) if self.is_step else ()
        self.is_step = False
        self.write(role, *codes, self._code(self.dialect.line), "Z" + self.z, self.feed_word(feed))

    def move(self, role: str, piece: Piece, feed: float, *codes: str) -> None:
        """A move in the mode."""
        kind = self.dialect.line if piece.center is None else self.dialect.ccw if piece.ccw else self.dialect.cw
        x, c = self.x_word(piece.end.real), self.number(piece.end.imag)
        everything = self.style.repeats or piece.center is not None
        words: list[str] = []
        if self.style.steps and self.dialect.system == "B":
            codes = (*codes, *self._step_code(role))
        if self.style.steps and role == "contour":
            dx, dc = float(x) - float(self.x), float(c) - float(self.c)
            letters = ("U", self.dialect.virtual_step) if self.dialect.system == "A" else ("X", self.dialect.virtual)
            for letter, step in zip(letters, (dx, dc), strict=True):
                if abs(step) > 1e-9 or everything:
                    words.append(letter + self.number(step * self.scale))
        else:
            if x != self.x or everything or role in ("ramp", "cancel"):
                words.append("X" + x)
            if c != self.c or everything:
                words.append(self.dialect.virtual + c)
        if self.style.repeats_z:
            words.append("Z" + self.z)
        if piece.center is not None:
            words += self._arc(piece)
        self.write(role, *codes, self._code(kind), *words, self.feed_word(feed))
        self.x, self.c = x, c
        self.at = piece.end

    def _step_code(self, role: str) -> tuple[str, ...]:
        """G91 in the first block of a contour, G90 behind its last."""
        was, self.is_step = self.is_step, role == "contour"
        return () if was == self.is_step else ("G91",) if self.is_step else ("G90",)

    def _arc(self, piece: Piece) -> list[str]:
        assert piece.center is not None
        start = complex(float(self.x) / (2 if self.dialect.diameter_inside else 1), float(self.c)) * self.scale
        spoke = piece.center - start
        sweep = cmath.phase((piece.end - piece.center) / (start - piece.center)) % math.tau
        sweep = sweep if piece.ccw else math.tau - sweep
        if self.dialect.centers and (self.style.centers or sweep > math.pi + 0.01 or abs(piece.end - start) < 1e-3):
            return ["I" + self.number(spoke.real), "J" + self.number(spoke.imag)]
        return [self.dialect.radius_word + self.number(abs(spoke))]

    def _code(self, code: str) -> str:
        written = "" if code == self.motion and not self.style.repeats else code
        self.motion = code
        return written

    def feed_word(self, feed: float) -> str:
        text = "F" + (f"{feed / self.scale:.1f}".removesuffix("0") if self.scale > 1 else f"{feed:g}.")
        written = "" if text == self.feed else text
        self.feed = text
        return written
