"""Writes the folder with which the author of a post begins: jobs in words and as drawings, and a manifest."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from polarcheck.foundation.errors import CertificateError, OutputError
from polarcheck.program.machines import profiles
from polarcheck.program.reading import files
from polarcheck.rewrite.certify.jobs import JOBS, Job, Outline

MANIFEST, WORDS, DRAWINGS = "post.toml", "jobs.md", "jobs"

_HEAD = """\
# The certification of a post. `polarcheck certify {manifest}` runs it; docs/certify.md says what each key means.
title = "Name and version of the post"
units = "mm"        # of the lengths in this file, whatever the units of a program

[tools.1]           # T0101 or T1 D1: the end mill of 8 mm of all jobs
radius = 4.0

[stock]             # the bar of all jobs
diameter = 30.0
"""
_TAIL = """
# A program that must fail, so that it is known that the check finds it:
# [[case]]
# name = "rapid inside the mode"
# feature = "contour"
# control = "{control}"
# program = "{control}/rapid.nc"
# findings = [{{ rule = "rapid-in-polar", block = "G0 X60." }}]    # or line = 12
"""
_WORDS = """\
# Jobs for the certification of a post

Program each job once in the CAM system, post it for each control, and save the program under the name that
`programs` in {manifest} gives for the job: {example}. Then:

    polarcheck certify {manifest}             what each program says, and whether it makes the part
    polarcheck certify {manifest} --update    once all is as it should be: writes the golden traces

All jobs: bar of 30 mm, Z0 on its face, C0 where x begins, one end mill of 8 mm as tool 1 with offset 1, radius 4 in
the offset table. Lead in and out straight and square to the contour, by more than the radius. X beside C is a
diameter or a radius as the control has it; the drawings are to scale, seen as the tool sees the face, their origin is
on the spindle axis, and x runs towards C0. They are in mm, that of the inch job is in inch.
"""


def write(folder: Path, machines: Sequence[str]) -> list[str]:
    """
    Write the suite into a folder, which is made where it is missing; return the paths that were written.

    machines: names or files of the machines of the controls. Nothing is overwritten: raises CertificateError for a
    file that is there already, before anything is written, and OutputError for what cannot be written.
    """
    contents = dict(_contents(folder, machines or [profiles.DEFAULT]))
    for path in contents:
        if os.path.lexists(path):
            raise CertificateError(
                f"{files.display_path(str(path))}: is there already, and stays as it is; name another folder"
            )
    try:
        (folder / DRAWINGS).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{files.display_path(str(folder))}: {error.strerror or error}") from None
    for path, text in contents.items():
        files.write(path, text)
    return [files.display_path(str(path)) for path in contents]


def _contents(folder: Path, machines: Sequence[str]) -> Iterator[tuple[Path, str]]:
    """Yield the path and the text of each file."""
    controls = _controls(folder, machines)
    example = f"{next(iter(controls))}/contour.nc"
    words = _WORDS.format(manifest=MANIFEST, example=example)
    yield folder / MANIFEST, _manifest(controls)
    yield folder / WORDS, words + "".join(_words(name, job) for name, job in JOBS.items())
    for name, job in JOBS.items():
        yield folder / DRAWINGS / f"{name}.dxf", dxf(job.outline, job.unit)


def _controls(folder: Path, machines: Sequence[str]) -> dict[str, str]:
    """Return the machine of each control, as the manifest names it, by the name of the control."""
    controls: dict[str, str] = {}
    for machine in machines:
        profiles.load(machine)
        is_built_in = machine in profiles.names()
        name = machine if is_built_in else Path(machine).stem
        if name in controls:
            raise CertificateError(f"--machine {machine}: there are two controls {name}")
        controls[name] = machine if is_built_in else Path(os.path.relpath(machine, folder)).as_posix()
    return controls


def _words(name: str, job: Job) -> str:
    return f"\n## {name}\n\n{job.title}. {job.task} Drawing: {DRAWINGS}/{name}.dxf.\n"


def _manifest(controls: Mapping[str, str]) -> str:
    first = next(iter(controls))
    lines = [_HEAD.format(manifest=MANIFEST)]
    for name, machine in controls.items():
        lines += [
            f"[controls.{_quoted(name)}]",
            f"machine = {_quoted(machine, always=True)}",
            f'programs = "{name}/{{feature}}.nc"',
            f'golden = "golden/{name}/{{feature}}.jsonl"',
        ]
        if name == first:
            lines.append('# not_offered = { helical = "the reason" }')
        else:
            lines += [
                f"same_path_as = {_quoted(first, always=True)}",
                '# path = "programmed"   # where this control leads the tool round corners in another way',
            ]
        lines.append("")
    for name, job in JOBS.items():
        lines += [f"[feature.{name}]", f"title = {_value(job.title)}", f"[[feature.{name}.part]]"]
        lines += [f"{key} = {_value(value)}" for key, value in job.part.items()]
        lines.append("")
    return "\n".join(lines).rstrip() + "\n" + _TAIL.format(control=first)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return _quoted(value, always=True) if isinstance(value, str) else str(value)


def _quoted(text: str, *, always: bool = False) -> str:
    """Return a text as TOML has it, a key without quotes where it needs none."""
    if not always and text.isascii() and text.replace("-", "").replace("_", "").isalnum():
        return text
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def dxf(outline: Outline, unit: float) -> str:
    """Return a drawing (DXF R12) with a closed polyline. unit: mm for each unit of the drawing."""
    pairs: list[tuple[int, object]] = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009"), (0, "ENDSEC")]
    pairs += [(0, "SECTION"), (2, "ENTITIES"), (0, "POLYLINE"), (8, "CONTOUR"), (66, 1), (70, 1)]
    pairs += [(10, 0.0), (20, 0.0), (30, 0.0)]
    for corner, bulge in outline:
        coordinates = [(10, corner.real / unit), (20, corner.imag / unit), (30, 0.0)]
        pairs += [(0, "VERTEX"), (8, "CONTOUR"), *coordinates, (42, bulge)]
    pairs += [(0, "SEQEND"), (8, "CONTOUR"), (0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code:>3}\n{f'{value:.9f}' if isinstance(value, float) else value}\n" for code, value in pairs)
