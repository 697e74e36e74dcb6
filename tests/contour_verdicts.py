"""
Programs of the generator before polarcheck and before the reference, and where the two disagree.

    comparison = compare(program_of(7))
    assert not comparison.disagreement, comparison.says
"""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import shapely  # type: ignore[import-untyped]
from contour_families import Program, Twin, program_of
from part_reference import Verdict, judge

from polarcheck.checking import check
from polarcheck.foundation.finding import Finding
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job, Stock, Tool
from polarcheck.rules.rule import load_all

#: Errors that say that the part is cut into.
GOUGES = frozenset(
    {
        "overcut",
        "start-up-sweeps-contour",
        "slot-narrower-than-cutter",
        "side-of-compensation-mirrored",
        "interference",
    }
)
#: Errors that say what the control objects to.
ALARMS = frozenset(
    {
        "interference",
        "inside-arc-smaller-than-radius",
        "no-offset-intersection",
        "movement-missing-in-offset-mode",
        "arc-center-on-path",
        "start-up-shorter-than-radius",
        "cancel-shorter-than-radius",
        "start-up-on-arc",
        "cancel-on-arc",
    }
)
#: Depths [mm]: up to the first nothing is cut, from the second on it has to be said; how exact it has to be.
SOUND, UNSOUND, EXACT = 0.004, 0.02, 0.01
#: Share of R within which a ramp is neither long enough nor too short.
SHORT = 0.002


class Comparison(NamedTuple):
    """
    One program before both. judged: sound, unsound, alarm, undecided.

    disagreement: "" or one of KINDS. other: errors that are about something else. says: all of it in a line.
    """

    program: Program
    judged: str
    disagreement: str
    other: tuple[str, ...]
    says: str


#: Disagreements, and those that are only told, of programs that ask for another part.
KINDS = ("false error", "missed", "missed, other loop", "missed alarm", "wrong depth")
TOLD = ("missed, block through part", "missed, wrong side")


def compare(program: Program, stock: bool = True) -> Comparison:
    """A program before both. stock: polarcheck knows the bar, where there is one."""
    findings = found_in(program, stock)
    errors = [finding for finding in findings if finding.severity == "error"]
    names = {finding.rule for finding in errors}
    verdict = judge(program.text, program.radius, program.part)
    least = most = verdict
    if program.bar is not None and not stock:
        well_inside = program.part.intersection(shapely.Point(0, 0).buffer(0.45 * program.bar, quad_segs=90))
        least = judge(program.text, program.radius, well_inside)
        most = judge(program.text, program.radius, program.wide)
    judged = class_of(verdict, least.depth, max(most.depth, verdict.depth))
    disagreement = ""
    if judged == "sound" and names & (GOUGES | ALARMS):
        disagreement = "false error"
    elif judged == "alarm" and not names & (GOUGES | ALARMS):
        disagreement = "missed alarm"
    elif judged == "unsound" and not names & GOUGES:
        disagreement = "missed"
        if verdict.through:
            disagreement = "missed, block through part"
        elif verdict.wrong_side:
            disagreement = "missed, wrong side"
        elif verdict.other_loop:
            disagreement = "missed, other loop"
    elif judged == "unsound" and not (verdict.through or verdict.wrong_side) and stock:
        disagreement = "wrong depth" if _depth_differs(errors, verdict) else ""
    other = tuple(sorted(names - GOUGES - ALARMS))
    said = "; ".join(f"line {one.line} {one.rule} {one.values.get('depth', '')}" for one in errors) or "nothing"
    return Comparison(program, judged, disagreement, other, f"reference: {judged} {_told(verdict)}; polarcheck: {said}")


def class_of(verdict: Verdict, least: float, most: float) -> str:
    """What a program is, if its depth lies between these."""
    if verdict.alarms or verdict.short_ramp > SHORT:
        return "alarm"
    if verdict.short_ramp > -SHORT:
        return "undecided"
    return "sound" if most <= SOUND else "unsound" if least > UNSOUND else "undecided"


def compare_seed(seed: int, family: str = "") -> list[Comparison]:
    """The program of a seed and, for some that are sound, its twins; every other bar is known."""
    stock = seed % 26 < 13 or seed % 3 == 0
    first = compare(program_of(seed, family=family), stock)
    found = [first]
    if first.judged == "sound" and seed % 5 == 0:
        for twin in twins_of(seed):
            found.append(compare(program_of(seed, twin, family), stock))
    return found


def twins_of(seed: int) -> tuple[Twin, ...]:
    """Forms of the same program: turned, mirrored with G41 for G42, in inch, incremental."""
    return Twin(turn=0.1 + seed % 60 / 10), Twin(mirror=True), Twin(inch=True), Twin(incremental=True)


def found_in(program: Program, stock: bool) -> list[Finding]:
    """The findings of polarcheck, those that follow from others included."""
    bar = Stock(diameter=program.bar) if stock and program.bar is not None else Stock()
    job = Job(units="mm", tools={"1": Tool(radius=program.radius, nose=0)}, stock=bar)
    report = check.check_file(program.text.encode(), _lathe(), job, _rules())
    found = list(report.findings)
    for finding in found:
        found += finding.follows
    return found


@functools.cache
def _lathe() -> Any:
    return profiles.load(profiles.DEFAULT).machine


@functools.cache
def _rules() -> Any:
    return list(load_all().values())


def _depth_differs(errors: list[Finding], verdict: Verdict) -> bool:
    """A sweep is not told beside an overcut of its loop, so it is compared where it is told alone."""
    names = {finding.rule for finding in errors}
    if not names & (GOUGES | ALARMS) <= {"overcut", "start-up-sweeps-contour"}:
        return False
    told = {
        name: max((float(str(one.values["depth"])) for one in errors if one.rule == name), default=0.0)
        for name in ("overcut", "start-up-sweeps-contour")
    }
    meant = verdict.contour if told["overcut"] else verdict.depth
    return abs((told["overcut"] or told["start-up-sweeps-contour"]) - meant) > EXACT


def _told(verdict: Verdict) -> str:
    if verdict.alarms:
        return ", ".join(f"{name} in line {lines}" for name, lines in verdict.alarms.items())
    marks = [name for name in ("through", "wrong_side", "other_loop") if getattr(verdict, name)]
    place = f"X{2 * verdict.place.real:.3f} C{verdict.place.imag:.3f}"
    depths = f"contour {verdict.contour:.4f} ramps {verdict.ramps:.4f} line {verdict.line} at {place}"
    return " ".join([depths, f"short ramp {verdict.short_ramp:.3f}", *marks])
