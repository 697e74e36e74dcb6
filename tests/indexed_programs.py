"""Programs with contours of straight lines, section after section at angles of C, in the words of several controls."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

#: Controls of CONTROLS.
NAMES = ("fanuc", "haas-lathe", "okuma-osp", "siemens-iso")


class Control(NamedTuple):
    """
    How a control writes a section.

    head, tail: before and after all sections. on, off: the mode. move: the code of a straight line in the mode.
    second: the letter of the second axis. scale: of X in the mode, 2 for a diameter; before: of X before it.
    """

    head: tuple[str, ...]
    tail: tuple[str, ...]
    on: tuple[str, ...] = ("G12.1",)
    off: tuple[str, ...] = ("G13.1",)
    move: str = "G1"
    second: str = "C"
    scale: float = 2.0
    before: float = 2.0


CONTROLS = {
    "fanuc": Control(("{unit} G98 G40 G97", "M5", "M45", "G28 H0", "T0808", "G97 S2000 M33"), ("M35", "M46", "M30")),
    "haas-lathe": Control(
        ("{unit} G40 G97 G98", "M5", "M154", "G28 H0", "T0808", "G17", "P2500 M133"),
        ("G18", "M135", "M155", "M30"),
        on=("G112", "G17"),
        off=("G113",),
        second="Y",
        scale=1.0,
    ),
    "okuma-osp": Control(
        ("{unit} G97 G40 G94", "M110", "T0808", "M13"),
        ("M12", "M109", "M30"),
        on=("G137{angle}", "G17"),
        off=("G136",),
        move="G101",
        second="Y",
        scale=1.0,
        before=1.0,
    ),
    "siemens-iso": Control(("{unit} G17 G90 G94 G40 G97", "T8 D1"), ("M30",)),
}


class Section(NamedTuple):
    """
    A contour of straight lines, as it is programmed.

    points: of the contour [mm], x + 1j*c. angle: of C at the switch [deg]; None where nothing positions C. side: 41 or
    42, 40 for a path of the tool center. depths: Z of its passes [mm]. approach: X of the tool at the switch [mm].
    """

    points: Sequence[complex]
    angle: float | None = 0.0
    side: int = 42
    depths: Sequence[float] = (-5.0,)
    approach: float = 40.0


def polygon(count: int, across: float, turned: float = 0.0) -> list[complex]:
    """A regular polygon, against the clock from the middle of its first flat and back to it [mm]."""
    turn = cmath.exp(1j * math.radians(turned))
    corner = across / 2 / math.cos(math.pi / count)
    corners = [corner * cmath.exp(1j * math.pi / count * (2 * number + 1)) * turn for number in range(count)]
    middle = across / 2 * turn
    return [middle, *corners, middle]


def flat(distance: float, half: float, turned: float = 0.0) -> list[complex]:
    """One flat, from its end at -c to the other one [mm]."""
    turn = cmath.exp(1j * math.radians(turned))
    return [complex(distance, -half) * turn, complex(distance, half) * turn]


def program(sections: Sequence[Section], control: str = "fanuc", inch: bool = False) -> str:
    """The program of these sections."""
    words = CONTROLS[control]
    lines = [line.format(unit="G20" if inch else "G21") for line in words.head]
    if control == "okuma-osp":  # its unit is a parameter
        lines[0] = lines[0].partition(" ")[2]
    for section in sections:
        angle = "" if section.angle is None else f" C{number(section.angle, 1.0)}"
        lines += [
            f"G0 X{number(words.before * section.approach, _unit(inch))}{angle} Z{number(2.0, _unit(inch))}",
            *(line.format(angle=angle) for line in words.on),
        ]
        for depth in section.depths:
            lines += [f"{words.move} X{_x(words, section.approach, inch)} {words.second}0 F{300 / _unit(inch):.0f}."]
            lines += [f"{words.move} Z{number(depth, _unit(inch))}"]
            for index, point in enumerate(section.points):
                side = f"G{section.side} " if section.side != 40 and not index else ""
                x, c = _x(words, point.real, inch), number(point.imag, _unit(inch))
                lines.append(f"{words.move} {side}X{x} {words.second}{c}")
            cancel = "G40 " if section.side != 40 else ""
            lines += [f"{words.move} {cancel}X{_x(words, section.approach, inch)} {words.second}0"]
        lines += [f"{words.move} Z{number(2.0, _unit(inch))}", *words.off]
    return (
        "\n".join(
            [*lines, f"G0 X{number(words.before * 100.0, _unit(inch))} Z{number(100.0, _unit(inch))}", *words.tail]
        )
        + "\n"
    )


def tool(radius: float, inch: bool = False) -> str:
    """As --tool takes it, in the units of the program; radius [mm]."""
    return f"8:radius={radius / _unit(inch):.6g},nose=0"


def number(value: float, unit: float) -> str:
    """A word's number with a decimal point."""
    text = f"{value / unit:.{5 if unit > 1 else 4}f}".rstrip("0")
    return "0" if text in ("-0.", "0.") else text


def _unit(inch: bool) -> float:
    return 25.4 if inch else 1.0


def _x(words: Control, value: float, inch: bool) -> str:
    return number(words.scale * value, _unit(inch))
