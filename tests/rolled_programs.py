"""
Programs of a CAM without the polar mode, and what a program of X and C, or of a section, does: read and sampled here by
itself, without the package.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from unrolled_contours import Piece, as_x_and_c, places

Path = NDArray[np.complex128]

_WORD = re.compile(r"([A-Z])(-?[0-9]*\.?[0-9]*)")


def cam_program(
    points: Path, speed: float | Sequence[float] = 200.0, inverse: bool = False, z: Sequence[float] | None = None
) -> str:
    """A contour as G1 X C F, F being inverse time or the way of X as a radius, Z and C as one vector, per minute."""
    x, c = as_x_and_c(points)
    z = [-2.0] * len(points) if z is None else z
    speeds = [speed] * len(points) if isinstance(speed, float) else list(speed)
    lines = ["%", "O0001", "G21 G98", f"G0 X{2 * x[0]:.3f} C{c[0]:.3f}", "Z2.", f"G1 Z{z[0]:.3f} F100."]
    lines += ["G93"] * inverse
    for k in range(1, len(points)):
        way = math.hypot(abs(points[k] - points[k - 1]), z[k] - z[k - 1])
        counted = 1.0 if inverse else math.hypot(x[k] - x[k - 1], z[k] - z[k - 1], c[k] - c[k - 1])
        depth = f" Z{z[k]:.3f}" if z[k] != z[k - 1] else ""
        lines.append(f"G1 X{2 * x[k]:.3f} C{c[k]:.3f}{depth} F{counted * speeds[k] / way:.4f}")
    return "\n".join([*lines, *["G98"] * inverse, "G0 Z2.", "X80. C0", "M30", "%", ""])


def cam_contour(contour: tuple[complex, list[Piece]], **more: object) -> str:
    """The same of lines and arcs."""
    return cam_program(places(*contour, 0.005), **more)  # type: ignore[arg-type]


def words_of(line: str) -> list[tuple[str, float]]:
    """The words of a block without comments."""
    return [(letter, float(number)) for letter, number in _WORD.findall(re.sub(r"\(.*?\)", "", line.upper())) if number]


def way_of_blocks(program: str, share: int = 8) -> Path:
    """The way on the part of G1 with X as a diameter and C in degrees, outside of sections."""
    x = c = 0.0
    motion = 0
    points: list[complex] = []
    for line in program.splitlines():
        words = dict(words_of(line))
        motion = int(words["G"]) if words.get("G") in (0, 1) else motion
        new_x, new_c = words.get("X", 2 * x) / 2, words.get("C", c)
        if motion == 1 and (new_x, new_c) != (x, c):
            u = np.arange(bool(points), share + 1) / share
            points += ((x + (new_x - x) * u) * np.exp(1j * np.radians(c + (new_c - c) * u))).tolist()
        x, c = new_x, new_c
    return np.array(points)


def way_of_section(
    program: str,
    on: str = "G12.1",
    off: str = "G13.1",
    virtual: str = "C",
    x_counts: float = 2.0,
    spacing: float = 0.03,
) -> tuple[Path, list[str]]:
    """
    The way of the first section on the part below Z0, by points so far apart [mm]; and its lines and arcs, as [G1, G3].

    The section begins on the linear axis with C at its last position before.
    """
    lines = program.splitlines()
    first, last = (next(k for k, line in enumerate(lines) if code in line.split()) for code in (on, off))
    place = [dict(words_of(line)) for line in lines[:first]]
    c_angle = next(block["C"] for block in reversed(place) if "C" in block)
    at = complex(next(block["X"] for block in reversed(place) if "X" in block) / 2)
    motion, z = 1, next((block["Z"] for block in reversed(place) if "Z" in block), 0.0)
    points: list[complex] = []
    kinds: list[str] = []
    for line in lines[first + 1 : last]:
        words = words_of(line)
        block = dict(words)
        for letter, number in words:
            motion = int(number) if letter == "G" and number in (0, 1, 2, 3) else motion
        z = block.get("Z", z)
        if not {"X", virtual} & set(block):
            continue
        end = complex(block.get("X", at.real * x_counts) / x_counts, block.get(virtual, at.imag))
        if motion in (2, 3):
            if "R" in block:
                chord = end - at
                height = math.sqrt(block["R"] ** 2 - abs(chord) ** 2 / 4)
                center = at + chord / 2 + 1j * chord / abs(chord) * (height if motion == 3 else -height)
            else:
                center = at + complex(block["I"], block["J"])
            turn = float(np.angle((end - center) / (at - center)))
            turn = turn % math.tau if motion == 3 else turn % math.tau - math.tau
            turn = turn or (math.tau if motion == 3 else -math.tau)
            count = max(2, math.ceil(abs(turn) * abs(at - center) / spacing))
            way = center + (at - center) * np.exp(1j * turn * np.arange(1, count + 1) / count)
        else:
            count = 20
            way = at + (end - at) * np.arange(1, count + 1) / count
        if z <= 0:
            points += [at, *way.tolist()]
            kinds.append(f"G{motion}")
        at = end
    return np.array(points) * np.exp(1j * math.radians(c_angle)), kinds


def farthest(points: Path, way: Path) -> float:
    """How far any of the points is from the nearest of the straight pieces between the points of the way [mm]."""
    start, step = way[:-1], np.diff(way)
    start, step = start[step != 0], step[step != 0]
    largest = 0.0
    for begin in range(0, len(points), 200):
        offset = points[begin : begin + 200, None] - start[None, :]
        share = np.clip((offset * np.conj(step)).real / np.abs(step) ** 2, 0, 1)
        largest = max(largest, float(np.abs(offset - share * step).min(axis=1).max()))
    return largest
