"""
Write a lathe program as a CAM post would: turning, then long polar sections with cutter compensation.

    python benchmarks/generate.py --blocks 200000 --seed 1 -o polar.nc

The same blocks and seed give the same bytes. Every line but the two with % is one block.

The part is a stepped shaft. The turning roughs it from the bar parallel to its profile and finishes it; then each
step gets a lobed contour with drafted walls, milled on the front in many passes, each a little deeper and a little
larger. The contours lie between 15 and 40 mm from the center, and none stands out over the one below it, so no pass
cuts a finished step.

Offset table for this program: T0404 to T1212 are end mills of 4 mm diameter that point at the face, R 2.0 and T 0.
T0101 to T0303 turn without compensation. X is a diameter, C and R are radius values, G-code system A, millimeters.
M33 runs the live tool; M35 selects the C axis and stops the live tool.

N counts to 99999 and starts again, since many controls take five digits. No block is the target of a jump.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

FEWEST_BLOCKS = 1000
MOST_STEPS = 25
LONGEST_SECTION = 100_000
"""Blocks of a polar section; a step that needs more has several, one below the other."""
PASS_BLOCKS = 397
SECTION_FRAME, PASS_FRAME = 18, 3
"""Blocks of a polar section beside its passes, and of a pass beside its contour."""

CUTTER_RADIUS, CLEARANCE = 2.0, 2.0
STEP_LENGTH, CONTOUR_DEPTH = 4.0, 3.8
"""The contour ends above the shoulder of its step: the end mill never touches it."""
LOBE_HEIGHT, DRAFT, TURNED_ALLOWANCE = 2.4, 0.08, 0.5
"""Height, draft and allowance together stay below the cutter diameter: one pass around leaves nothing standing."""

POSITIONING = "F1000."
ARC_SHARE = 0.135
ARC_LENGTH = 3
"""How many line blocks an arc block is as long as."""
FLATTEST_ARC, SMALLEST_INSIDE_RADIUS = 150.0, 6.0


@dataclass(frozen=True, slots=True)
class Contour:
    """
    A round with lobes, `radius(t) = mean + sum of height * cos(count * t)`. Lengths in mm, t in radians.

    It is largest at t = 0, where the tool comes on and leaves: the contour is convex there, so the end of the last
    block cannot cut into the first one.
    """

    mean: float
    waves: tuple[tuple[int, float], ...]

    def radius(self, t: float) -> float:
        """Distance from the center at the angle `t`."""
        return self.mean + sum(height * math.cos(count * t) for count, height in self.waves)

    def curvature(self, t: float) -> float:
        """1 / radius of curvature [1/mm] at the angle `t`, negative on an inside curve: (r² + 2r'² - rr'') / s'³."""
        r = self.radius(t)
        r1 = sum(-height * count * math.sin(count * t) for count, height in self.waves)
        r2 = sum(-height * count**2 * math.cos(count * t) for count, height in self.waves)
        return float((r * r + 2 * r1 * r1 - r * r2) / (r * r + r1 * r1) ** 1.5)


@dataclass(frozen=True, slots=True)
class Step:
    """One step of the shaft: the contour at its top, and the diameter and the Z of its top as turned [mm]."""

    contour: Contour
    diameter: float
    top: float


def shaft(rng: random.Random, count: int) -> list[Step]:
    """The steps from the front backwards: groups of five share their lobes, each group outside the one before."""
    steps = []
    waves: tuple[tuple[int, float], ...] = ()
    for number in range(count):
        smallest = 15.0 + 5.0 * (number // 5) + 0.5 * (number % 5)
        if number % 5 == 0:
            waves = lobes(rng, smallest)
        largest = smallest + LOBE_HEIGHT + DRAFT * CONTOUR_DEPTH
        contour = Contour(smallest + LOBE_HEIGHT / 2, waves)
        steps.append(Step(contour, 2 * (largest + TURNED_ALLOWANCE), -STEP_LENGTH * number))
    return steps


def lobes(rng: random.Random, smallest: float) -> tuple[tuple[int, float], ...]:
    """Two waves whose inside curves take the cutter with room to spare, `smallest` mm or more from the center."""
    while True:
        count, share, height = pick(rng, range(3, 8)), pick(rng, range(7, 10)) / 10, LOBE_HEIGHT / 2
        waves = ((count, share * height), (count + pick(rng, (1, 2)), (1 - share) * height))
        contour = Contour(smallest + height, waves)
        if min(contour.curvature(math.radians(degree)) for degree in range(360)) > -1 / SMALLEST_INSIDE_RADIUS:
            return waves


def pick(rng: random.Random, choices: Sequence[int]) -> int:
    """One of the choices, by random() alone: the method whose values stay the same in every Python."""
    return choices[int(rng.random() * len(choices))]


def word(address: str, value: float) -> str:
    """A word with a decimal point and no more digits than the least increment of 0.001 mm has."""
    # Adding 0.0 turns -0.0, which would be written X-0., into 0.0.
    return address + f"{round(value, 3) + 0.0:.3f}".rstrip("0")


def turning(steps: list[Step], bar: float) -> Iterator[str]:
    """Facing, roughing 0.25 mm deep at a time, semi-finishing and finishing, from a bar of diameter `bar`."""
    yield "G50 S2500"
    yield from ("T0101 (ROUGH OD)", "G99", "G96 S180 M3", "M8")
    yield from (f"G0 {word('X', bar + 4)} Z0.", "G1 X-1.6 F0.2", "G0 Z2.")
    for number in range(math.ceil((bar - steps[0].diameter) / 0.5), 1, -1):
        yield from profile(steps, bar, 0.25 * number, "F0.3")
    yield from ("M9", "G28 U0 W0", "M1")
    yield from ("T0202 (SEMI-FINISH OD)", "G96 S220 M3", "M8")
    yield from profile(steps, bar, 0.25, "F0.2")
    yield from ("M9", "G28 U0 W0", "M1")
    yield from ("T0303 (FINISH OD)", "G96 S250 M3", "M8")
    yield from profile(steps, bar, 0.0, "F0.1")
    yield from ("M9", "G28 U0 W0", "M1")


def profile(steps: list[Step], bar: float, allowance: float, feed: str) -> Iterator[str]:
    """One cut along the shaft, `allowance` mm outside its profile, until it runs out of the bar; back to the front."""
    shift = 2 * allowance
    yield f"G0 {word('X', steps[0].diameter + shift - 0.4)} Z2."
    yield f"G1 Z0. {feed}"
    for step, following in zip(steps, [*steps[1:], None], strict=True):
        diameter, bottom = step.diameter + shift, step.top - STEP_LENGTH
        yield f"G3 {word('X', diameter)} {word('Z', step.top - 0.2)} R0.2"
        yield f"G1 {word('Z', bottom + 1)}"
        yield f"G1 {word('X', diameter - 0.4)} {word('Z', bottom + 0.8)}"
        yield f"G1 {word('Z', bottom + 0.2)}"
        yield f"G2 {word('X', diameter)} {word('Z', bottom)} R0.2"
        if following is None or following.diameter + shift - 0.4 > bar:
            break
        yield f"G1 {word('X', following.diameter + shift - 0.4)}"
    yield f"G1 {word('X', bar + 4)}"
    yield "G0 Z2."


def polar_section(
    rng: random.Random, number: int, step: Step, bar: float, passes: list[tuple[float, int]]
) -> Iterator[str]:
    """One milling tool, from its call to the reference point; `passes` are the depth [mm] and the blocks of each."""
    side = ("G42", "G41")[number % 2]
    feed = pick(rng, range(140, 241, 10))
    tool = 4 + number % 9
    yield f"T{tool:02}{tool:02} (END MILL D4 R2)"
    yield from ("M5", "M35", "G28 H0", "G97 S2000 M33", "M8", "G98", "G0 Z5.")
    # X = part OD + cutter diameter + clearance, as the builder's guide to G12.1 asks; here the part is still a bar.
    yield f"G0 {word('X', bar + 2 * CUTTER_RADIUS + CLEARANCE)} C0"
    yield "G12.1"
    ramp = word("X", step.diameter + 2 * CUTTER_RADIUS + CLEARANCE)
    yield f"G1 {ramp} {POSITIONING}"
    for depth, blocks in passes:
        contour = Contour(step.contour.mean + DRAFT * depth, step.contour.waves)
        yield f"G1 {word('Z', step.top - depth)}"
        yield f"G1 {side} {word('X', 2 * contour.radius(0.0))} F{feed}."
        yield from around(contour, blocks, side, feed)
        yield f"G1 G40 {ramp} {POSITIONING}"
    yield "G13.1"
    yield from ("G99", "G0 Z5. M35", f"G0 {word('X', bar + 20)}", "M9", "G28 U0 W0", "M1")


def around(contour: Contour, blocks: int, side: str, feed: int) -> Iterator[str]:
    """
    Once around the contour in `blocks` blocks, back to its start; the tool is outside.

    Where the contour lies nearer to the center than its mean, the cutter takes a thicker chip and F is lower.
    """
    # Outside is to the right of a counter-clockwise path and to the left of a clockwise one.
    sense = 1 if side == "G42" else -1
    arcs = round(blocks * ARC_SHARE)
    due = [(number * arcs + blocks // 2) // blocks for number in range(blocks + 1)]
    unit = sense * math.tau / (blocks + (ARC_LENGTH - 1) * arcs)
    t, x, c, in_force = 0.0, word("X", 2 * contour.radius(0.0)), "C0.", feed
    for number in range(blocks):
        sweep = unit * (ARC_LENGTH if due[number + 1] > due[number] else 1)
        middle, t = t + sweep / 2, t + sweep if number + 1 < blocks else 0.0
        curvature = contour.curvature(middle) * sense
        arc = due[number + 1] > due[number] and abs(curvature) * FLATTEST_ARC > 1
        words = ["G1" if not arc else "G3" if curvature > 0 else "G2"]
        before = x, c
        x, c = word("X", 2 * contour.radius(t) * math.cos(t)), word("C", contour.radius(t) * math.sin(t))
        words += [new for new, old in zip((x, c), before, strict=True) if new != old]
        if arc:
            words.append(word("R", 1 / abs(curvature)))
        wanted = feed if contour.radius(middle) > contour.mean else round(0.75 * feed)
        if wanted != in_force:
            words.append(f"F{wanted}.")
            in_force = wanted
        yield " ".join(words)


def program(blocks: int = 200_000, seed: int = 1) -> bytes:
    """The program in ASCII with exactly `blocks` blocks; ValueError below 1,000, where no whole part fits."""
    if blocks < FEWEST_BLOCKS:
        raise ValueError(f"{blocks} blocks: at least {FEWEST_BLOCKS} are needed")
    rng = random.Random(seed)  # noqa: S311 - a program that can be written again, not a secret
    steps = shaft(rng, min(max(blocks // 8000, 2), MOST_STEPS))
    bar = steps[-1].diameter + 3.0
    text = [f"O0001 (LOBED SHAFT, {len(steps)} STEPS)", "G18 G21 G40", "G28 U0 W0", *turning(steps, bar)]
    # No pass is parted, so that a section can be longer than the others by one.
    sections = math.ceil(blocks / (len(steps) * (LONGEST_SECTION - 2 * PASS_BLOCKS)))
    left = blocks - len(text) - len(steps) * sections * SECTION_FRAME
    passes = max(len(steps), round(left / (PASS_BLOCKS + PASS_FRAME)))
    contour_blocks = shares(left - passes * PASS_FRAME, passes)
    for number, (step, count) in enumerate(zip(steps, shares(passes, len(steps)), strict=True)):
        whole = [(CONTOUR_DEPTH * done / count, contour_blocks.pop()) for done in range(1, count + 1)]
        for part, size in enumerate(shares(count, sections)):
            own, whole = whole[:size], whole[size:]
            text += polar_section(rng, number * sections + part, step, bar, own)
    text[-1] = "M30"
    numbered = [f"N{number % 99999 + 1} {block}" for number, block in enumerate(text[1:])]
    return "\n".join(["%", text[0], *numbered, "%", ""]).encode("ascii")


def shares(total: int, count: int) -> list[int]:
    """`total` in `count` whole parts as equal as can be."""
    return [(total + i) // count for i in range(count)]


def main() -> None:
    """Write the program to a file or to standard output."""
    parser = argparse.ArgumentParser(description="Write a CAM-like lathe program with polar sections.")
    parser.add_argument("--blocks", type=int, default=200_000, help="number of blocks (default: 200000)")
    parser.add_argument("--seed", type=int, default=1, help="another seed, another part (default: 1)")
    parser.add_argument("-o", "--output", type=Path, help="file to write (default: standard output)")
    options = parser.parse_args()
    try:
        data = program(options.blocks, options.seed)
    except ValueError as error:
        parser.error(str(error))
    if options.output:
        options.output.write_bytes(data)
    else:
        sys.stdout.buffer.write(data)


if __name__ == "__main__":
    main()
