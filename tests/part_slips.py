"""
Defects of parts, one at a time: what a program makes that is not the part of its plan.

    drawn_defect(7)     # Defect(kind, seed, plan, ...), or None where that seed makes none

A defect is made in the passes of a plan, or in the blocks of its program. It counts where tests/part_judge.py says that
the metal differs from the part by more than twice the tolerance, within what a check can know.
"""

from __future__ import annotations

import cmath
import math
import random
import re
from collections.abc import Callable
from typing import NamedTuple

from drawn_parts import FAMILIES, Draw, Pass, Plan, drawn_plan, mirrored_shape, moved
from milled_shapes import Contour, Piece
from part_judge import Judgement, is_bar_known, judged
from setter_programs import Program
from slip_words import all_words, at, block_changed, digit_wrong, factor_of, word_changed

Plant = Callable[[Plan, Draw], Program | None]


class Defect(NamedTuple):
    """A defect: the plan, the sound program, the one with the defect, and what is wrong with the metal."""

    kind: str
    seed: int
    plan: Plan
    sound: Program
    program: Program
    judgement: Judgement


# ---- contours with something wrong ----


def _joints(contour: Contour) -> list[int]:
    """The pieces that end at a corner between two lines, the closing point left out."""
    pieces = contour.pieces
    return [
        index for index in range(len(pieces) - 1) if pieces[index].center is None and pieces[index + 1].center is None
    ]


def piece_missing(contour: Contour, draw: Draw) -> Contour | None:
    """A wall is not there: the one before goes on to the end of the one behind."""
    places = _joints(contour)
    if not places:
        return None
    if not contour.closed and draw.random() < 0.5:
        return contour._replace(pieces=contour.pieces[:-1])
    index = draw.choice(places)
    return contour._replace(pieces=contour.pieces[:index] + contour.pieces[index + 1 :])


def corner_off(contour: Contour, draw: Draw, most: float = 3.0) -> Contour | None:
    places = _joints(contour)
    if not places:
        return None
    index = draw.choice(places)
    by = _size(draw, most) * draw.choice((1, -1)) * draw.choice((1, 1j))
    pieces = list(contour.pieces)
    pieces[index] = Piece(pieces[index].end + by)
    return contour._replace(pieces=tuple(pieces))


def side_off(contour: Contour, draw: Draw, most: float = 2.0) -> Contour | None:
    """One side lies elsewhere, as long as its neighbours make it."""
    by = _size(draw, most) * draw.choice((1, -1))
    if len(contour.pieces) == 1:
        way = contour.pieces[0].end - contour.start
        return moved(contour, by=1j * way / abs(way) * by)
    points = contour.points()
    places = [index for index in _joints(contour) if index + 1 in _joints(contour)]
    if contour.name in ("slot", "keyway") and draw.random() < 0.5:
        last = contour.pieces[-1]
        before = contour.pieces[-2]
        if before.center is not None or last.center is not None:
            return None
        pieces = (*contour.pieces[:-2], Piece(before.end + 1j * by), Piece(last.end + 1j * by))
        return contour._replace(pieces=pieces)
    if not places:
        return None
    index = draw.choice(places) + 1
    start, end = points[index], points[index + 1]
    way = (end - start) / abs(end - start)
    ends = []
    for corner, other in ((start, points[index - 1]), (end, points[index + 2])):
        beside = (corner - other) / abs(corner - other)
        slope = (1j * way * beside.conjugate()).real
        if abs(slope) < 0.2:
            return None
        ends.append(corner + beside * by / slope)
    changed = list(contour.pieces)
    changed[index - 1], changed[index] = Piece(ends[0]), Piece(ends[1])
    return contour._replace(pieces=tuple(changed))


def arc_off(contour: Contour, draw: Draw) -> Contour | None:
    """One arc between the same points has another radius."""
    points = contour.points()
    places = [index for index, piece in enumerate(contour.pieces) if piece.center is not None]
    if not places:
        return None
    index = draw.choice(places)
    start, piece = points[index], contour.pieces[index]
    assert piece.center is not None
    chord, spoke = piece.end - start, piece.center - start
    radius = abs(spoke) + draw.choice((1, -1)) * _size(draw, max(0.4 * abs(spoke), 0.1))
    if abs(chord) / 2 > radius - 1e-3:
        return None
    along = chord / abs(chord)
    side = math.copysign(1, (spoke * along.conjugate()).imag)
    center = start + chord / 2 + 1j * along * side * math.sqrt(radius**2 - abs(chord) ** 2 / 4)
    pieces = list(contour.pieces)
    pieces[index] = piece._replace(center=center)
    return contour._replace(pieces=tuple(pieces))


def wall_short(contour: Contour, draw: Draw, bar: float) -> Contour | None:
    """The last wall of an open contour ends within the bar."""
    if contour.closed:
        return None
    points = contour.points()
    start, end = points[-2], points[-1]
    way = (end - start) / abs(end - start)
    away = abs((end * way.conjugate()).imag)
    out = math.sqrt(max(bar * bar / 4 - away * away, 0.0))
    share = draw.uniform(-0.5, 0.9) * out
    middle = end - (end * way.conjugate()).real * way
    return contour._replace(pieces=(*contour.pieces[:-1], Piece(middle + way * share)))


def _size(draw: Draw, most: float) -> float:
    """Of a mistake: small ones as often as large ones [mm]."""
    return round(math.exp(draw.uniform(math.log(0.05), math.log(most))), 2)


# ---- passes with something wrong ----


def _again(plan: Plan, passes: list[Pass]) -> Program:
    return plan._replace(passes=tuple(passes)).program()


def _changed(change: Callable[[Contour, Draw], Contour | None]) -> Plant:
    """Another contour of a feature, or of one of its flats; in all its passes or without the roughing ones."""

    def plant(plan: Plan, draw: Draw) -> Program | None:
        number = draw.randrange(len(plan.features))
        feature = plan.features[number]
        angle = draw.choice(feature.angles) if draw.random() < 0.7 else None
        contour = change(feature.form.contour(), draw)
        if contour is None:
            return None
        is_every = draw.random() < 0.5

        def one(old: Pass) -> Pass:
            is_meant = old.feature == number and old.form == feature.form and angle in (None, old.angle)
            return old._replace(contour=contour) if is_meant and (is_every or not old.offset) else old

        return _again(plan, [one(old) for old in plan.passes])

    return plant


def section_missing(plan: Plan, draw: Draw) -> Program | None:
    is_known = is_bar_known(plan)  # else what roughing clears may be gone before
    places = [
        index
        for index, one in enumerate(plan.passes)
        if is_known or (not one.offset and one.form == plan.features[one.feature].form)
    ]
    if len(plan.passes) < 2 or not places:
        return None
    if plan.features[0].is_drawn and not is_bar_known(plan):
        return None  # the outermost curve may be that of the bar
    index = draw.choice(places)
    return _again(plan, [one for number, one in enumerate(plan.passes) if number != index])


def flat_missing(plan: Plan, draw: Draw) -> Program | None:
    """All passes of one flat of several; of two in one section, the second."""
    number = draw.randrange(len(plan.features))
    feature = plan.features[number]
    if feature.form.kind == "two flats":
        contour = feature.form.contour()
        short = contour._replace(pieces=contour.pieces[:-1])
        return _again(plan, [one._replace(contour=short) for one in plan.passes])
    if feature.form.kind == "d" and feature.form.values["count"] == 2:
        return _again(plan, [one._replace(form=one.form.with_values(count=1)) for one in plan.passes])
    if len(feature.angles) < 2:
        return None
    angle = draw.choice(feature.angles)
    return _again(plan, [one for one in plan.passes if one.feature != number or one.angle != angle])


def other_side(plan: Plan, draw: Draw) -> Program | None:
    """The contour of a pocket milled as a boss, or the reverse."""
    number = draw.randrange(len(plan.features))
    feature = plan.features[number]
    if feature.form.kind not in ("polygon", "rectangle", "circle"):
        return None
    form = feature.form.with_values(inside=0 if feature.is_pocket else 1)
    first = next(one for one in plan.passes if one.feature == number and one.form == feature.form)
    passes = [one for one in plan.passes if one.feature != number]
    return _again(plan, [*passes, first._replace(form=form, offset=0.0, how="ramps", depths=(feature.z,))])


def side_swapped(plan: Plan, draw: Draw) -> Program | None:
    """G41 for G42 in one section, or in all."""
    program = plan.program()
    places = [index for index in at(program, "ramp") if re.search("G4[12]", program.lines[index].text)]
    if not places:
        return None
    section = draw.choice([program.lines[index].section for index in places])
    is_every = draw.random() < 0.5
    for index in places:
        line = program.lines[index]
        if is_every or line.section == section:
            text = re.sub("G4([12])", lambda match: "G42" if match[1] == "1" else "G41", line.text)
            program = program.changed(index, text)
    return program


def side_forgotten(plan: Plan, draw: Draw) -> Program | None:
    """Neither G41 nor G42, in one section or in all; G40 is forgotten, too, or left."""
    program = plan.program()
    places = [index for index in at(program, "ramp") if re.search("G4[12]", program.lines[index].text)]
    if not places:
        return None
    section = draw.choice([program.lines[index].section for index in places])
    is_every, old = draw.random() < 0.5, "G4[012] ?" if draw.random() < 0.6 else "G4[12] ?"
    for index in at(program, "ramp", "cancel"):
        line = program.lines[index]
        if is_every or line.section == section:
            program = program.changed(index, re.sub(old, "", line.text))
    return program


def short(plan: Plan, draw: Draw) -> Program | None:
    if not is_bar_known(plan):
        return None
    return _changed(lambda contour, draw: wall_short(contour, draw, plan.bar))(plan, draw)


def angle_wrong(plan: Plan, draw: Draw) -> Program | None:
    """One section of several, or all of a feature that says its angle."""
    if not plan.dialect.index:
        return None
    number = draw.randrange(len(plan.features))
    feature = plan.features[number]
    by = draw.choice((1, 2, 3, 5, 10, 15, 20, 30, 45, 60, 90)) * draw.choice((1, -1))
    is_relative = len(feature.angles) > 1
    if not is_relative and not feature.is_drawn and "turned" not in feature.keys:
        return None
    angle = draw.choice(feature.angles) if is_relative else None
    if is_relative and draw.random() < 0.3:
        by = -360 // len(feature.angles)
    is_meant = [one.feature == number and angle in (None, one.angle) for one in plan.passes]
    return _again(
        plan,
        [
            one._replace(angle=(one.angle + by) % 360) if meant else one
            for one, meant in zip(plan.passes, is_meant, strict=True)
        ],
    )


def pass_wrong(plan: Plan, draw: Draw) -> Program | None:
    """One depth of several mills another contour."""
    places = [
        index for index, one in enumerate(plan.passes) if len(one.depths) > 1 and one.how in ("ramps", "one ramp")
    ]
    if not places:
        return None
    index = draw.choice(places)
    one = plan.passes[index]
    change = draw.choice((corner_off, side_off, piece_missing))
    contour = change(one.form.contour(), draw)
    if contour is None:
        return None
    passes = list(plan.passes)
    passes[index] = one._replace(wrong=(draw.randrange(len(one.depths)), contour))
    return _again(plan, passes)


def radius_wrong(plan: Plan, draw: Draw) -> Program | None:
    """The path of the center was made for another cutter than the one of the job."""
    tools = sorted({one.tool for one in plan.passes if one.how == "center path"})
    if not tools:
        return None
    program = plan.program()
    tool = draw.choice(tools)
    if at(program, "offset"):
        return None  # G10 sets it
    radius = round(program.radii[tool] + draw.choice((1, -1)) * _size(draw, 0.5 * program.radii[tool]), 2)
    return program._replace(radii={**program.radii, tool: radius})


def cutter_too_small(plan: Plan, draw: Draw) -> Program | None:
    """Something is left between passes, or in the middle."""
    index = draw.randrange(len(plan.passes))
    one = plan.passes[index]
    if one.how == "center path" or not is_bar_known(plan):
        return None
    radius = round(one.radius * draw.choice((0.8, 0.6, 0.5, 0.4)), 2)
    return _again(plan, [old._replace(radius=radius) if old.tool == one.tool else old for old in plan.passes])


def too_shallow(plan: Plan, draw: Draw) -> Program | None:
    number = draw.randrange(len(plan.features))
    feature = plan.features[number]
    if "z" not in feature.keys:
        return None
    share = draw.choice((0.5, 0.8, 0.9, 0.95))

    def one(old: Pass) -> Pass:
        if old.feature != number:
            return old
        if len(old.depths) > 1:
            return old._replace(depths=old.depths[:-1])
        return old._replace(depths=(round(old.depths[0] * share, 2),))

    return _again(plan, [one(old) for old in plan.passes])


def place_wrong(plan: Plan, draw: Draw) -> Program | None:
    """A pocket, or a boss beside the center, lies elsewhere."""
    number = draw.randrange(len(plan.features))
    feature = plan.features[number]
    if not feature.form.contour().closed:
        return None
    by = _size(draw, 5.0) * cmath.rect(1, draw.choice((0, 90, 180, 270)) * math.pi / 180)

    def one(old: Pass) -> Pass:
        return old._replace(contour=moved(old.form.contour(), by=by)) if old.feature == number else old

    return _again(plan, [one(old) for old in plan.passes])


def size_wrong(plan: Plan, draw: Draw) -> Program | None:
    number = draw.randrange(len(plan.features))
    form = plan.features[number].form
    names = [name for name in ("across", "along", "diameter", "width", "length", "distance") if name in form.values]
    if not names or form.kind == "d":
        return None
    name, by = draw.choice(names), draw.choice((1, -1)) * _size(draw, 4.0)
    return _reformed(plan, number, {name: by})


def corners_wrong(plan: Plan, draw: Draw) -> Program | None:
    """All corner radii, or chamfers, have another size."""
    number = draw.randrange(len(plan.features))
    form = plan.features[number].form
    if "small" not in form.values:
        return None
    small = form.values["small"]
    by = draw.choice((1, -1)) * _size(draw, max(0.5 * small, 0.2))
    if form.values.get("inside"):
        by = abs(by)
    return _reformed(plan, number, {"small": by})


def _reformed(plan: Plan, number: int, changes: dict[str, float]) -> Program:
    def one(old: Pass) -> Pass:
        if old.feature != number:
            return old
        values = {name: old.form.values[name] + by for name, by in changes.items() if name in old.form.values}
        return old._replace(form=old.form.with_values(**values))

    return _again(plan, [one(old) for old in plan.passes])


def mirror_image(plan: Plan, draw: Draw) -> Program | None:
    number = draw.randrange(len(plan.features))
    feature = plan.features[number]
    if not feature.is_drawn and "turned" not in feature.keys:
        return None

    def one(old: Pass) -> Pass:
        return old._replace(contour=mirrored_shape(old.form.contour())) if old.feature == number else old

    return _again(plan, [one(old) for old in plan.passes])


def unit_wrong(plan: Plan, draw: Draw) -> Program | None:
    """G20 for G21, or the reverse; the job says its unit."""
    program, dialect = plan.program(), plan.dialect
    if not plan.units or not dialect.inch or not dialect.metric:
        return None
    old, new = (dialect.inch, dialect.metric) if plan.inch else (dialect.metric, dialect.inch)
    places = [index for index, line in enumerate(program.lines) if old in line.text]
    return program.changed(places[0], program.lines[places[0]].text.replace(old, new)) if places else None


def _text(plant: Callable[[Program, Draw], Program | None]) -> Plant:
    return lambda plan, draw: plant(plan.program(), draw)


KINDS: dict[str, Plant] = {
    "wall missing": _changed(piece_missing),
    "section missing": section_missing,
    "flat missing": flat_missing,
    "boss for pocket": other_side,
    "G41 for G42": side_swapped,
    "G42 forgotten": side_forgotten,
    "flat short": short,
    "side off": _changed(side_off),
    "angle wrong": angle_wrong,
    "one pass wrong": pass_wrong,
    "R wrong": radius_wrong,
    "cutter too small": cutter_too_small,
    "corner off": _changed(corner_off),
    "arc off": _changed(arc_off),
    "corners wrong": corners_wrong,
    "size wrong": size_wrong,
    "too shallow": too_shallow,
    "place wrong": place_wrong,
    "mirror image": mirror_image,
    "X as the other": _text(all_words("X")),
    "one X as the other": _text(word_changed("X", factor_of(0.5), "contour")),
    "digit wrong": _text(word_changed("XC", digit_wrong, "contour")),
    "block missing": _text(block_changed(".+", "", "contour")),
    "way through the part": _text(word_changed("X", factor_of(0.5), "ramp", "approach", "cancel")),
    "unit wrong": unit_wrong,
}


def drawn_sound(seed: int, family: str = "", machine: str = "") -> tuple[Plan, Program]:
    """A plan and its program, which the judge finds to be the part."""
    family = family or FAMILIES[seed % len(FAMILIES)]
    for number in range(60):
        plan = drawn_plan(seed + 100_003 * number, family, machine)
        program = plan.program()
        judgement = judged(plan, program, 0.7 * plan.allowed)
        if not judgement.events and not judgement.differs and not _is_at_center(plan):
            return plan, program
    raise RuntimeError(f"no sound program of {family} with seed {seed}")


def _is_at_center(plan: Plan) -> bool:
    """Whether a cutter comes to a pocket at the center, where C turns at once."""
    for one in plan.passes:
        contour = one.cut(True).contour
        if contour.is_pocket and contour.start.real - one.radius - 0.75 < 0.6:
            return True
    return False


def drawn_defect(seed: int, kinds: tuple[str, ...] = tuple(KINDS), machine: str = "") -> Defect | None:
    """The defect whose turn it is, in the first sound program in which it can be made and matters."""
    kind = kinds[seed % len(kinds)]
    draw = random.Random(f"defect {seed} {kind}")  # noqa: S311 - programs that can be written again
    for _ in range(60):
        plan, sound = drawn_sound(draw.randrange(10**6), draw.choice(FAMILIES), machine)
        try:
            program = KINDS[kind](plan, draw)
            if program is None or (program.text() == sound.text() and program.radii == sound.radii):
                continue
            judgement = judged(plan, program, 2 * plan.allowed)
        except (ValueError, ZeroDivisionError, OverflowError, SyntaxError, IndexError, AssertionError):
            continue
        if judgement.differs:
            return Defect(kind, seed, plan, sound, program, judgement)
    return None
