"""
A program of a plan as files: the program, polarcheck.toml with what it is run with and what it should make, drawings.

    write(folder, plan, program)
    report = check(folder)      # as `polarcheck check` says it, in that folder
"""

from __future__ import annotations

import cmath
import contextlib
import json
import logging
import math
from pathlib import Path
from typing import Any

import ezdxf
from click.testing import CliRunner
from drawn_parts import Feature, Plan, moved
from milled_shapes import Contour
from setter_programs import Program

from polarcheck.commands import main

PROGRAM = "O1000.NC"
#: Keys of [[part]] that are lengths.
_LENGTHS = ("across_flats", "across_corners", "diameter", "width", "length", "distance", "corner_radius", "chamfer")
_LENGTHS += ("center", "z", "tolerance")
#: Of $INSUNITS.
_UNITS = {"mm": 4, "inch": 1, "": 0}


def write(folder: Path, plan: Plan, program: Program, head: str = "") -> None:
    """Write the files; head: comment lines of polarcheck.toml."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / PROGRAM).write_text(program.text())
    (folder / "polarcheck.toml").write_text(head + job_text(plan, program))
    for name in {feature.keys["drawing"] for feature in plan.features if feature.is_drawn}:
        draw_file(folder / name, [one for one in plan.features if one.keys.get("drawing") == name], plan)


def check(folder: Path) -> dict[str, Any]:
    """The report of the program in a folder."""
    with contextlib.chdir(folder):
        result = CliRunner().invoke(
            main, ["check", "--format", "json", "--set", "limits.c_feed=36000", "--max-seconds", "100", PROGRAM]
        )
    try:
        report: dict[str, Any] = json.loads(result.stdout)["files"][0]
    except ValueError:
        crash = {"rule": "crash", "severity": "error", "line": 0, "message": result.output + repr(result.exception)}
        return {"findings": [crash], "not_evaluated": []}
    return report


def job_text(plan: Plan, program: Program) -> str:
    """polarcheck.toml of a program."""
    scale = 25.4 if plan.units == "inch" or (not plan.units and plan.inch) else 1.0
    lines = [f'machine = "{program.machine}"']
    lines += [f'units = "{plan.units}"'] if plan.units else []
    for offset, radius in sorted(program.radii.items()):
        lines += ["", f"[tools.{offset}]", f"radius = {_plain(radius / scale)}", "nose = 0"]
    if program.stock:
        lines += ["", "[stock]", f"diameter = {_plain(program.stock / scale)}"]
    names: set[str] = set()
    for feature in plan.features:
        if feature.keys.get("drawing") in names:
            continue
        names |= {feature.keys["drawing"]} if feature.is_drawn else set()
        keys = dict(feature.keys)
        if not math.isnan(plan.tolerance):
            keys["tolerance"] = plan.tolerance
        lines += ["", "[[part]]", *(f"{key} = {_value(key, value, scale)}" for key, value in keys.items())]
    return "\n".join(lines) + "\n"


def _value(key: str, value: Any, scale: float) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(_value(key, one, scale) for one in value)}]"
    if isinstance(value, int) and key in ("sides", "count", "section"):
        return str(value)
    return _plain(value / scale if key in _LENGTHS else value)


def _plain(value: float) -> str:
    text = f"{value:.6f}".rstrip("0")
    return text + "0" if text.endswith(".") else text


def draw_file(path: Path, features: list[Feature], plan: Plan) -> None:
    """A DXF file with the contours, in the units of the job or those of the program."""
    logging.getLogger("ezdxf").setLevel(logging.ERROR)
    document = ezdxf.new("R2010" if plan.units else "R12")
    if plan.units:
        document.header["$INSUNITS"] = _UNITS[plan.units]
    scale = 25.4 if plan.units == "inch" or (not plan.units and plan.inch) else 1.0
    space = document.modelspace()
    for feature in features:
        for angle in feature.angles:
            _draw(space, moved(feature.form.contour(), math.radians(angle)), 1 / scale, plan.seed % 3)
    document.saveas(path)


def _draw(space: Any, contour: Contour, scale: float, way: int) -> None:
    """Lines and arcs, or a polyline."""
    points = [point * scale for point in contour.points()]
    if way == 0 and all(piece.center is None for piece in contour.pieces):
        pairs = [(point.real, point.imag) for point in (points[:-1] if contour.closed else points)]
        space.add_polyline2d(pairs, close=contour.closed)
        return
    for start, piece in zip(points, contour.pieces, strict=False):
        end = piece.end * scale
        if piece.center is None:
            space.add_line((start.real, start.imag), (end.real, end.imag))
            continue
        center = piece.center * scale
        first, last = (math.degrees(cmath.phase(point - center)) for point in (start, end))
        if not piece.ccw:
            first, last = last, first
        space.add_arc((center.real, center.imag), abs(start - center), first, last)
