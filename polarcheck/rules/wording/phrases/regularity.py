"""Phrases of the rules about contours that are almost right."""

from __future__ import annotations

from polarcheck.columns.contour.regularity import Regularity
from polarcheck.geometry.shapes.shape import polygon_name
from polarcheck.program.execution.run import Run
from polarcheck.rules.wording.phrases.common import executed_word


def misfit(regularity: Regularity, run: Run, row: int) -> str:
    """What is wrong with the block: `X-13.524 does not fit the rest of the contour, two digits are swapped`."""
    correction = regularity.corrections[row]
    if correction.word >= 0:
        return f"{executed_word(run, correction.word)} does not fit the rest of the contour, {correction.why}"
    return f"this block does not fit the rest of the contour, {correction.why}"


def remedy(regularity: Regularity, row: int) -> str:
    """What would be right there: `with X-13.254`."""
    correction = regularity.corrections[row]
    if not correction.text:
        return "without it"
    return f"with {correction.text} in a block before it" if "a block" in correction.why else f"with {correction.text}"


def as_meant(regularity: Regularity, row: int) -> str:
    """What the contour would be: `a regular hexagon`."""
    shape = regularity.corrections[row].becomes
    if shape.is_regular:
        return f"a regular {polygon_name(shape.corners)}"
    if shape.is_turned:
        return f"the same after each {360 / shape.order:g} deg"
    return "its own mirror image"
