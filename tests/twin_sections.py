"""
The same milling on several controls: random sections, as a program for each of them and as positions alone.

A plan has sections at angles of C, with lines, arcs, ramps, helices and plunges. What a program has to give is worked
out from the plan by sampling (path_sampling.py); nothing of the formulas of the package is used.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from random import Random
from typing import NamedTuple

import numpy as np
from path_sampling import point_at, sampled
from programs import job_of, machine_of, tables_of
from test_every_machine import HANDS, number

from polarcheck.foundation.states import Motion

CONTROLS = (
    *("fanuc", "haas-lathe", "okuma-osp", "siemens-transmit", "mazak-quick-turn", "mazak-integrex", "citizen"),
    *("hurco", "fagor-8055t", "gsk-988"),
)
#: The tool stands so far from the center at G12.1 [mm], so far in front of the face.
OUT, FRONT = 60.0, 5.0
#: Points of a move that are sampled.
COUNT = 2001
NOWHERE = complex("nan+nanj")


class Block(NamedTuple):
    """Kind: 1, 2, 3, or 0 for Z alone. end: plane point [mm]. radius: of an arc. z: [mm]. feed: [mm/min]."""

    kind: int
    end: complex
    radius: float
    z: float
    feed: float


@dataclass(frozen=True)
class Section:
    """Blocks behind G12.1, at an angle of C [deg]."""

    angle: float
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Control:
    """
    What differs between controls beside the words: of the profile, as far as it is the profile's to say.

    in_space: F is along the way with Z. turns: the plane turns with C at G12.1. sense: of C against the plane.
    """

    name: str
    in_space: bool
    turns: bool
    sense: int

    @classmethod
    def of(cls, name: str) -> Control:
        polar = machine_of(name).polar
        return cls(
            name,
            polar.feed_measures == "space",
            polar.zero_angle == "at-switch" or bool(polar.direction_word),
            -1 if polar.zero_angle == "at-c0-reversed" else 1,
        )


class Move(NamedTuple):
    """start, end, center: plane points [mm]. kind: 1, 2, 3. time [s], rates and turn of C [deg] by sampling."""

    start: complex
    end: complex
    center: complex
    kind: int
    time: float
    c_feed: float
    x_feed: float
    turn: float


def drawn(seed: int) -> list[Section]:
    """Two or three sections round the center."""
    draw = Random(seed)  # noqa: S311 - sections that can be written again
    return [
        Section(draw.choice([0.0, 30.0, 90.0, 135.0, 240.0]), tuple(_blocks(draw))) for _ in range(draw.randint(2, 3))
    ]


def _blocks(draw: Random) -> list[Block]:
    way_round, angle = draw.choice([-1, 1]), draw.uniform(-0.5, 0.5)
    feed, z = draw.choice([120.0, 300.0, 750.0]), FRONT

    def point() -> complex:
        return complex(*(round(part, 3) for part in _parts(cmath.rect(draw.uniform(12, 40), angle))))

    here = point()
    found = [Block(1, here, 0, z, feed)]
    for _ in range(draw.randint(3, 6)):
        angle += way_round * draw.uniform(0.3, 1.2)
        if draw.random() < 0.5:
            z = round(draw.uniform(-8, 4), 3)
        if draw.random() < 0.3:
            feed = draw.choice([90.0, 240.0, 600.0])
        if draw.random() < 0.15:
            found.append(Block(0, here, 0, z, feed))
        here, last = point(), here
        kind = draw.choice([1, 1, 2, 3])
        radius = round(abs(here - last) * draw.uniform(0.6, 2), 3) if kind > 1 else 0.0
        found.append(Block(kind, here, radius, z, feed))
    return found


def _parts(point: complex) -> tuple[float, float]:
    return point.real, point.imag


def written(plan: list[Section], name: str, *, incremental: bool = False) -> str:
    """The program for a control; incremental: by U, V, W, H or G91 behind the first block of a section."""
    hand = HANDS[name]
    lines = [hand.head]
    for section in plan:
        angle = number(section.angle)
        lines += [f"G0 Z{number(FRONT)}", f"G0 X{number(OUT * hand.outside)} C{angle}"]
        lines.append(hand.on.replace("C0", f"C{angle}"))
        here, height = complex(OUT, 0), FRONT
        for at, block in enumerate(section.blocks):
            by_steps = incremental and at > 0
            x, c, z = ("X", hand.axis, "Z") if not (by_steps and hand.steps) else (*hand.steps, "W")
            to, depth = (block.end - here, block.z - height) if by_steps else (block.end, block.z)
            words = [hand.codes[max(block.kind - 1, 0)]]
            if by_steps and not hand.steps and at == 1:
                words.insert(0, "G91")
            if block.kind:
                words += [f"{x}{number(to.real * hand.factor)}", f"{c}{number(to.imag)}"]
            if block.kind > 1:
                words.append(f"{hand.arc}{number(block.radius)}")
            if block.z != height:
                words.append(f"{z}{number(depth)}")
            lines.append(" ".join([*words, f"F{number(block.feed)}"]))
            here, height = block.end, block.z
        if incremental and not hand.steps:
            lines.append("G90")
        lines.append(hand.off)
    return "\n".join([*lines, f"G0 Z{number(FRONT)}", "M30", ""])


def expected(section: Section, control: Control) -> list[Move]:
    """The moves on the plane, by sampling."""
    entry = 0.0 if control.turns else control.sense * math.radians(section.angle)
    here, height, found = cmath.rect(OUT, entry), FRONT, []
    for block in section.blocks:
        if block.kind:
            center = NOWHERE if block.kind == 1 else _center(here, block)
            kind = (Motion.LINE, Motion.CW, Motion.CCW)[block.kind - 1]
            shape = (here, block.end, center, kind)
            length, at = point_at(*shape)
            space = math.hypot(length, block.z - height) if control.in_space else length
            rates = sampled(shape, block.feed * length / space, count=COUNT)
            turn = float(np.degrees(np.unwrap(np.angle(at(np.linspace(0, 1, COUNT))))[[0, -1]] @ [-1, 1]))
            time = 60 * space / block.feed
            found.append(
                Move(*shape, time, rates["c_feed"], rates["x_feed"], control.sense * turn),
            )
        here, height = block.end, block.z
    return found


def _center(start: complex, block: Block) -> complex:
    """Of the arc below 180 deg: on the left of the chord for G3, on its right for G2."""
    chord = block.end - start
    away = math.sqrt(block.radius**2 - abs(chord) ** 2 / 4)
    side = 1j if block.kind == 3 else -1j
    return (start + block.end) / 2 + side * chord / abs(chord) * away


def section_time(section: Section, control: Control) -> float:
    """How long the section takes [s], plunges included."""
    moving = iter(expected(section, control))
    height, total = FRONT, 0.0
    for block in section.blocks:
        total += next(moving).time if block.kind else 60 * abs(block.z - height) / block.feed
        height = block.z
    return total


def compare(seed: int, name: str) -> None:
    """Raise AssertionError where the program of a control gives another path, rate, time or C than the plan."""
    plan, control = drawn(seed), Control.of(name)
    program = written(plan, name, incremental=bool(seed % 2))
    tables = tables_of(program, name, "1:radius=3,nose=0", job=job_of(job={"program_units": "mm"}))
    dynamics, moves = tables["dynamics"], tables["dynamics"].moves
    begin, end = moves.c_angles
    assert len(tables["trace"].mode.sections) == len(plan)
    for of_plan, section in enumerate(plan):
        rows = np.flatnonzero(moves.section == of_plan)
        moved = expected(section, control)
        columns = {name: np.array([getattr(one, name) for one in moved]) for name in Move._fields}
        for column in ("start", "end", "center", "kind"):
            np.testing.assert_allclose(getattr(moves, column)[rows], columns[column], atol=2e-6, err_msg=column)
        np.testing.assert_allclose(dynamics.move_time[rows], columns["time"], rtol=1e-6, err_msg="time")
        for column in ("c_feed", "x_feed"):
            np.testing.assert_allclose(
                getattr(dynamics, column)[rows], columns[column], rtol=2e-4, atol=1e-2, err_msg=column
            )
        np.testing.assert_allclose((end - begin)[rows], columns["turn"], atol=1e-4, err_msg="turn of C")
        np.testing.assert_allclose(begin[rows[1:]], end[rows[:-1]], atol=1e-4, err_msg="C goes on")
        at_entry = (begin[rows[0]] - section.angle + 180) % 360 - 180
        np.testing.assert_allclose(at_entry, 0, atol=1e-6, err_msg="C at entry")
        np.testing.assert_allclose(dynamics.section_time[of_plan], section_time(section, control), rtol=1e-6)
