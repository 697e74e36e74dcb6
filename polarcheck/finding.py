"""What a check gives: findings, what was not evaluated, and the report (the JSON contract)."""

from __future__ import annotations

import enum
from collections.abc import Sequence
from typing import Any

import msgspec
from msgspec import UNSET, UnsetType


class Severity(enum.IntEnum):
    """How bad a finding is; a rule may give one per row, 0 where there is nothing to say."""

    NOTE = 1
    WARNING = 2
    ERROR = 3


NOTE, WARNING, ERROR = Severity.NOTE, Severity.WARNING, Severity.ERROR

#: By the names that findings and configuration have for them.
SEVERITIES = {severity.name.lower(): severity for severity in Severity}


class Edit(msgspec.Struct, frozen=True, kw_only=True):
    """Replace the characters from start to end (lines and columns from 1, end exclusive) by text."""

    line: int
    column: int
    end_line: int
    end_column: int
    text: str


class Fix(msgspec.Struct, frozen=True, kw_only=True):
    """What to write instead; safe: nothing moves otherwise than meant."""

    title: str
    safe: bool
    edits: list[Edit]


class Finding(msgspec.Struct, frozen=True, kw_only=True):
    """
    One reported fault. Lines and columns count from 1, columns in characters; end_column is behind the last one.

    follows: the findings that would not be there without this one; they count nowhere. channel: as `$2`, where the file
    has several, and this is of one of them.
    """

    rule: str
    severity: str
    message: str
    line: int
    column: int
    end_line: int
    end_column: int
    block: str
    program: str | None = None
    section_line: int | None = None
    alarm: str | None = None
    values: dict[str, Any] = {}
    count: int = 1
    source: str = ""
    fingerprint: str = ""
    fix: Fix | None = None
    follows: list[Finding] = []
    channel: str | UnsetType = UNSET

    @property
    def told(self) -> str:
        """The message; before it the channel, in a file with several."""
        return f"{self.channel}: {self.message}" if self.channel else self.message


class Undecided(Finding, frozen=True, kw_only=True):
    """A finding of which nobody can say that something is wrong: it fails no file, and leaves it unverified."""


#: What can silence a finding.
SILENCED_BY = ALLOW, BASELINE = "allow", "baseline"


class Silenced(Finding, frozen=True, kw_only=True):
    """
    A finding that somebody has answered for: it counts nowhere but as silenced.

    by: allow, a comment of the program, or baseline, a file of findings that are known. reason: the words of whoever
    silenced it, empty where none were given.
    """

    by: str
    reason: str = ""


class NotEvaluated(msgspec.Struct, frozen=True, kw_only=True):
    """
    What was not looked at, why, in how many blocks.

    matters: something could be wrong there that would be found otherwise, so that the file is unverified.
    """

    rule: str
    reason: str
    blocks: int
    matters: bool = True
    channel: str | UnsetType = UNSET


class PolarSection(msgspec.Struct, frozen=True, kw_only=True):
    """
    What the verdict rests on in one polar section.

    Lines: of its G12.1 and of its end. units: of the program there. offset: the number whose radius counts, or tool
    and edge (MILL_8/1); null for none. radius [mm] and where it comes from: command line, job, offset table,
    program, comment, none. nearest: the smallest distance of the tool center to the center of C in a cutting move
    [mm]. c_feed: highest rate of C [deg/min], its line and the limit of the machine. ramp_used: how much of a
    start-up or offset cancel its radius needs, the highest; 1 at the limit. time: of its moves at the F that
    runs, Z alone and dwells included [s]. null is not known, or not there.
    """

    line: int
    end_line: int
    units: str
    offset: int | str | None
    radius: float | None
    radius_source: str
    nearest: float | None
    c_feed: float | None
    c_feed_line: int | None
    c_feed_limit: float | None
    ramp_used: float | None
    time: float | None
    channel: str | UnsetType = UNSET


class OddSide(msgspec.Struct, frozen=True, kw_only=True):
    """A side of a part that differs from the others: the line of its block and its size [mm]."""

    line: int
    size: float


class LeftStanding(msgspec.Struct, frozen=True, kw_only=True):
    """
    What the tool leaves beside the finished part. kind: corner, rib or strip. text: the same in words. line: of the
    block with which the tool leaves it, null for corners. size: R of corners, else how high or thick it is [mm].
    count: of corners. place: [x, c], null for corners.
    """

    kind: str
    text: str
    line: int | None
    size: float
    count: int = 1
    place: tuple[float, float] | None = None


class MadeShape(msgspec.Struct, frozen=True, kw_only=True):
    """
    What a polar section makes at one or more depths.

    Lines: of its G12.1 and of its end. depths: Z of each pass [mm], in the order of the program; z: the deepest, null
    where it is not known. shape: hexagon, circle, flats, slot, contour, ...; inside: a pocket. values: its sizes [mm,
    mm2, deg], see docs/part.md. odd: sides that differ from the others. text: all of it in words. left_standing: what
    the tool does not take off. needs: why nothing, or not all, is known, and what to give; null where all is.
    """

    line: int
    end_line: int
    z: float | None
    depths: list[float]
    shape: str | None
    inside: bool
    is_regular: bool
    values: dict[str, float]
    odd: list[OddSide]
    text: str
    left_standing: list[LeftStanding] = []
    needs: str | None = None
    channel: str | UnsetType = UNSET


class PartComparison(msgspec.Struct, frozen=True, kw_only=True):
    """
    One contour beside a drawing or a shape; lengths in mm, points [x, c] with x as a radius.

    title: the name of the drawing, or the shape. section_line: of the code that begins the section. z: of the contour,
    None if unknown. line: of the block where it differs most, at: where. too_much, cut_away: by how much, at most.
    turned: the angle of a shape that may be turned in any way [deg]. text: all of it in words, in the program's units.
    """

    title: str
    section_line: int
    z: float | None
    agrees: bool
    largest: float | None
    tolerance: float | None
    too_much: float | None
    cut_away: float | None
    at: tuple[float | None, float | None]
    line: int
    turned: float | None
    text: str


class FileReport(msgspec.Struct, frozen=True, kw_only=True):
    """
    All about one file. machine: its name, as it was asked for. Verdict: pass, fail or unverified. polar_sections: what
    it rests on. looked_at: at what of the file was looked; outside polar sections text, flow and position only. part:
    what the program makes, where that was asked for; compared: its contours beside what they should be, likewise.
    """

    path: str
    machine: str = ""
    programs: list[str]
    blocks: int
    sections: int
    verdict: str
    polar_sections: list[PolarSection] = []
    findings: list[Finding]
    not_evaluated: list[NotEvaluated]
    looked_at: list[str] = []
    silenced: list[Silenced] = []
    part: list[MadeShape] | UnsetType = UNSET
    compared: list[PartComparison] | UnsetType = UNSET


class Producer(msgspec.Struct, frozen=True):
    """Who wrote the report."""

    name: str
    version: str


class Summary(msgspec.Struct, frozen=True, kw_only=True):
    """Counts over all files."""

    files: int
    errors: int
    warnings: int
    notes: int
    silenced: int
    passed: int = msgspec.field(name="pass")
    unverified: int
    fail: int


class Report(msgspec.Struct, frozen=True, kw_only=True):
    """The whole report; the JSON contract, whose number is `schema`. machine: of all files; null where they differ."""

    schema: int
    tool: Producer
    machine: str | None
    files: Sequence[FileReport]
    summary: Summary
