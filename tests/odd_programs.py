"""
Programs for any control whose moves no setter writes: arcs of an increment, ends that rounding puts together, centers
at an end of their arc, radii below half the chord, huge ones, moves of no length and through the center, helices,
variables without a value. With subprograms, loops, computed words and cycles around them; and plain moves of X and C.

    machine, tools = "okuma-osp", ("1:radius=5",)
    program = drawn(Random(7), machine)

Each is written in the words of a Hand (test_every_machine.py), with the codes of units of the profile.
"""

from __future__ import annotations

import cmath
import math
from random import Random

from programs import machine_of
from test_every_machine import HANDS, Hand

#: Of a point on the plane or its distance from the last one [mm].
_LENGTHS = (
    0.0,
    0.0,
    0.0004,
    0.0005,
    0.001,
    0.001,
    0.0015,
    0.002,
    0.003,
    0.004,
    0.01,
    0.0127,
    0.1,
    1.0,
    5.0,
    10.0,
    25.0,
)
_FAR = (12.0, 20.0, 30.0, 40.0, 19.999, 20.0005, 33.333)
_HUGE = (1000.0, 99999.999, 1e6, 1e9)
_FEEDS = ("F100.", "F200.", "F200", "F.1", "F0.001", "F99999.", "F0", "F1000.", "F#1", "F[100.*2]")
_MACRO = ("#1=5.", "#2=0", "#1=#1+.001", "#3=[1/3]", "#500=#0", "R1=5", "LV1=2.", "V1=3.", "P1=2")
_VALUES = ("#1", "#2", "#500", "[#1+.001]", "[1/3]", "R1", "=R1", "-#1", "[#1*0]", "V1")
_CODES = (
    "G4 P10",
    "G4 X1.",
    "M8",
    "M9",
    "M5",
    "M3 S500",
    "G18",
    "G17",
    "G90",
    "G91",
    "G98",
    "G99",
    "G94",
    "G95",
    "T0202",
)
_CODES += ("G40", "G41", "G42", "G61", "G64", "G9", "G0 Z5.", "G54", "/X20.", "(A)", "S1000", "G50 S2000", "G53", "M1")
_CYCLES = (
    "G83 Z-5. R2. F50.",
    "G83 X10. Z-5. Q1. F100",
    "G80",
    "G90 X30. Z-5. F.2",
    "G71 U1. R1.",
    "G71 P10 Q20 U.5 W.1 F.2",
    "N10 G0 X20.",
    "N20 G1 Z-5.",
    "G76 P010060 Q100 R50",
    "G92 X20. Z-10. F1.5",
    "G81 Z-3. F100",
    "G28 U0 W0",
    "G32 Z-5. F1.",
)
_ENDS = ("\n", "\n", "\n", "\r\n", ";\n")


def drawn(random: Random, machine: str) -> bytes:
    """A program for a machine."""
    writer = _Writer(random, machine)
    if random.random() < 0.2:
        writer.plain_moves()
    else:
        writer.sections()
    return random.choice(_ENDS).join(writer.lines).encode()


class _Writer:
    """
    Writes blocks.

    around: how often a block is a code or a statement. point: on the plane, where the last block leads to [mm].
    digits: of numbers, behind the point. unit: [mm].
    """

    def __init__(self, random: Random, machine: str) -> None:
        self.random = random
        self.hand: Hand = HANDS[machine]
        system = machine_of(machine).system
        inch = bool(system.inch) and random.random() < 0.25
        self.unit = 25.4 if inch else 1.0
        self.digits = random.choice((3, 3, 3, 4, 4, 6)) if not inch else random.choice((4, 4, 5))
        units = system.inch if inch else system.mm
        self.lines = [*self.hand.head.split("\n"), *(units[-1:] if random.random() < 0.9 else ())]
        self.around = random.choice((0.0, 0.0, 0.04))
        self.point = 0j
        self.is_step = False

    # ---- whole programs ----

    def sections(self) -> None:
        """One to three sections, one of which may stand in a subprogram, and what stands around them."""
        random, subprograms = self.random, list[str]()
        for number in range(random.choice((1, 1, 2, 3))):
            begin = len(self.lines)
            self._approach()
            begin = random.choice((begin, begin, len(self.lines)))
            self._section()
            if random.random() < 0.15:
                subprograms += [f"O{2 + number}", *self.lines[begin:], "M99"]
                self.lines[begin:] = [f"M98 P{2 + number}{random.choice(('', ' L2'))}"]
            if random.random() < 0.3:
                self.lines.append(random.choice((*_CYCLES, *_CODES)))
        self.lines += ["M30", *subprograms, ""]

    def plain_moves(self) -> None:
        """Short blocks of X and C without the mode, as a CAM writes them; of some programs a few lead elsewhere."""
        random, outside = self.random, self.hand.outside
        around = random.choice((0j, 5 + 0j, 20 + 0j, complex(self._length(), 0)))
        radius = random.choice((0.001, 0.1, 1.0, 5.0, 10.0, 10.0))
        steps, share = random.choice((30, 60, 120)), random.choice((1.0, 1.0, 0.3, 2.5))
        jumps, depths, feeds = (
            random.choice((0.0, 0.0, 0.05)),
            random.choice((0.0, 0.0, 0.1)),
            random.choice((0.0, 0.2)),
        )
        self.lines += [f"G0 X{self._number((abs(around) + radius) * outside)} C0", "Z2.", "G1 Z-1. F100."]
        self.lines += random.choice(((), (), ("G93",)))
        turned, feed = 0.0, random.choice((200.0, 500.0, 37.5, 0.01, 2000.0))
        for step in range(steps + 1):
            point = around + cmath.rect(radius, math.tau * share * step / steps)
            if random.random() < jumps:
                point = complex(self._length(), self._length())
            angle = math.degrees(cmath.phase(point)) if point else 0.0
            turned += (angle - turned + 180) % 360 - 180
            depth = f" Z{self._number(-1 - step / steps)}" if random.random() < depths else ""
            feed = feed * random.choice((0.5, 2.0)) if random.random() < feeds else feed
            self.lines.append(f"G1 X{self._number(abs(point) * outside)} C{turned:.3f}{depth} F{feed:g}")
        self.lines += ["G98", "G0 Z2.", "X80. C0", "M30", ""]

    # ---- a section ----

    def _approach(self) -> None:
        x, angle = (
            self.random.choice((60.0, 60.0, 45.0, 0.0, 20.0)),
            self.random.choice(("0", "0", "0", "90.", "30.", "-1.")),
        )
        c = f" C{angle}" if self.random.random() < 0.95 else ""
        self.lines.append(f"G0 X{self._number(x * self.hand.outside)}{c} Z{self._number(2.0)}")
        self.lines += self.hand.on.replace("C0", f"C{angle}").split("\n")
        self.point = complex(x, 0)

    def _section(self) -> None:
        random, hand = self.random, self.hand
        side = random.choice(("", "", "G41 ", "G42 "))
        start = complex(random.choice(_FAR), random.choice((0.0, 0.0, self._length())))
        self.lines.append(f"{side}{hand.codes[0]} {self._words(start)} F200.")
        self._depth(random.choice((-1.0, -1.0, 0.0, -0.0004)))
        loops = random.random() < 0.1
        self.lines += ["#9=0", "WHILE[#9LT2]DO1", "#9=#9+1"] if loops else []
        for _ in range(random.choice((1, 2, 3, 5, 8, 12))):
            self._block()
        self.lines += ["END1"] if loops else []
        self.lines += ["G90"] if self.is_step and not hand.steps else []
        self.is_step = False
        self.lines.append(f"{'G40 ' if side else ''}{hand.codes[0]} {self._words(complex(50, 0))}")
        if random.random() < 0.8:
            self._depth(2.0)
        if random.random() < 0.97:
            self.lines += hand.off.split("\n")

    def _block(self) -> None:
        random, chance = self.random, self.random.random()
        if chance < self.around:
            self.lines.append(random.choice(_CODES))
        elif chance < 2 * self.around:
            self.lines.append(random.choice(_MACRO))
        elif chance < 3 * self.around:
            self.lines.append(
                f"{self.hand.codes[0]} {random.choice(('X', self.hand.axis, 'Z'))}{random.choice(_VALUES)}"
            )
        elif chance < 0.15:
            self._depth(random.choice((-1.0, -2.0, -1.0004, 0.5)))
        elif chance < 0.17 and not self.hand.steps:
            self.is_step = not self.is_step
            self.lines.append("G91" if self.is_step else "G90")
        elif chance < 0.45:
            self._move(self.hand.codes[0], "")
        else:
            self._arc()

    def _depth(self, z: float) -> None:
        self.lines.append(f"{self.hand.codes[0]} Z{self._number(z)} F100.")

    def _arc(self) -> None:
        """An arc of any size and sweep on its circle, or one whose end, center and R may not fit each other."""
        random, hand = self.random, self.hand
        ccw = random.random() < 0.5
        start, center = self.point, self.point + complex(self._length(), self._length())
        if random.random() < 0.75 and center != start:
            sweep = random.choice((1e-5, 1e-3, 0.1, 1.0, 1.5, math.pi, 3.2, 6.0, 6.283, math.tau)) * (1 if ccw else -1)
            end = center + (start - center) * cmath.exp(1j * sweep)
            radii = (abs(center - start),) if abs(sweep) <= math.pi + 0.01 else ()
        else:
            end = self._target()
            center = random.choice((center, start, end, (start + end) / 2, end + self._length(), 0j))
            apart = abs(end - start)
            radii = (abs(center - start), apart / 2, apart / 4, apart, *_LENGTHS, *_HUGE, -apart, -10.0)
        if radii and random.random() < 0.5:
            words = hand.arc + self._number(random.choice(radii))
        else:
            words = f"I{self._number(center.real - start.real)} J{self._number(center.imag - start.imag)}"
            words = words.split()[random.randrange(2)] if random.random() < 0.05 else words
        self._move(hand.codes[2 if ccw else 1], f" {words}", end)

    def _move(self, code: str, more: str, end: complex | None = None) -> None:
        random = self.random
        depth = f" Z{self._number(random.choice((-1.0, -2.0, -1.5)))}" if random.random() < 0.06 else ""
        feed = f" {random.choice(_FEEDS)}" if random.random() < 0.15 else ""
        code = "G0" if random.random() < 0.03 else code
        self.lines.append(f"{code} {self._words(self._target() if end is None else end)}{more}{depth}{feed}")

    def _words(self, end: complex) -> str:
        """The words that lead to a point; those of the present one may be left out."""
        hand, random = self.hand, self.random
        way = end - self.point
        by_steps = self.is_step or (bool(hand.steps) and random.random() < 0.1)
        x, c = hand.steps if by_steps and hand.steps else ("X", hand.axis)
        to = way if by_steps else end
        words = [f"{x}{self._number(to.real * hand.factor)}", f"{c}{self._number(to.imag)}"]
        if random.random() < 0.3:
            words = [word for word, moved in zip(words, (way.real, way.imag), strict=True) if moved] or words[:1]
        self.point = end
        return " ".join(words)

    def _target(self) -> complex:
        """A point: the last one, very near to it, the center of the part, or anywhere."""
        random = self.random
        near = self.point + complex(self._length(), self._length())
        far = cmath.rect(random.choice(_FAR), random.uniform(0, math.tau))
        return random.choice((self.point, near, near, near, far, far, 0j, -self.point, complex(self._length(), 0)))

    def _length(self) -> float:
        return self.random.choice(_LENGTHS) * self.random.choice((-1, 1))

    def _number(self, value: float) -> str:
        text = f"{value / self.unit:.{self.digits}f}".rstrip("0")
        return text if self.random.random() < 0.98 else self.random.choice(("0", text.rstrip("."), "-0.", "1", ".001"))
