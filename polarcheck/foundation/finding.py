"""The report of a check: findings, what was not evaluated, verdicts. This is the JSON contract."""

from __future__ import annotations

import enum
from collections.abc import Iterable, Iterator, Mapping, Sequence

import msgspec
from msgspec import UNSET, UnsetType

#: Number of the JSON contract.
SCHEMA = 2


class Severity(enum.IntEnum):
    """The severity of a finding. A rule may return one per row; 0 is no finding."""

    NOTE = 1
    WARNING = 2
    ERROR = 3


NOTE, WARNING, ERROR = Severity.NOTE, Severity.WARNING, Severity.ERROR

#: Severities by their names in reports and configuration.
SEVERITIES = {severity.name.lower(): severity for severity in Severity}
SEVERITY_NAMES = {severity: name for name, severity in SEVERITIES.items()}

#: What a check says of a file; unreadable is one that could not be read or checked.
VERDICTS = PASS, FAIL, UNVERIFIED, UNREADABLE = "pass", "fail", "unverified", "unreadable"


class Edit(msgspec.Struct, frozen=True, kw_only=True):
    """
    Replace the characters from start to end by text. Lines and columns count from 1; the end is exclusive.

    line, column, end_line, end_column: the characters that are replaced.
    text: what stands in their place.
    """

    line: int
    column: int
    end_line: int
    end_column: int
    text: str


class Fix(msgspec.Struct, frozen=True, kw_only=True):
    """
    What to write instead.

    title: the fix in a few words.
    safe: the machine moves as the programmer meant.
    edits: replacements in the text.
    """

    title: str
    safe: bool
    edits: list[Edit]


class Finding(msgspec.Struct, frozen=True, kw_only=True):
    """
    One reported fault.

    rule, severity, message: the rule that reports it, error, warning or note, and the text for the user.
    line, column, end_line, end_column: the words at fault; from 1, columns in characters, the end exclusive.
    block: the text of the block.
    program: number or name of its program, as O0001.
    section_line: line of the G12.1 that begins its polar section.
    alarm: the alarm that this control shows; null if none is known.
    values: its numbers by fixed names in fixed units, and the codes, words and names at fault (docs/values.md).
    count: how many executed blocks or words it stands for.
    source: page of the manual.
    fingerprint: recognises the finding after other blocks have changed.
    fix: what to write instead; null if unknown.
    follows: findings that this one causes; they are not counted.
    channel: of a file with several channels, as `$2`.
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
    values: dict[str, int | float | str] = {}
    count: int = 1
    source: str = ""
    fingerprint: str = ""
    fix: Fix | None = None
    follows: list[Finding] = []
    channel: str | UnsetType = UNSET

    @property
    def full_message(self) -> str:
        """The message, behind the channel in a file with several."""
        return f"{self.channel}: {self.message}" if self.channel else self.message


def each_finding(findings: Iterable[Finding]) -> Iterator[Finding]:
    """Yield the findings, and behind each those that follow from it."""
    for finding in findings:
        yield finding
        yield from finding.follows


class Undecided(Finding, frozen=True, kw_only=True):
    """A finding that may be intended: it makes the file unverified, not failed."""


#: What can suppress a finding.
SILENCED_BY = ALLOW, BASELINE = "allow", "baseline"


class Silenced(Finding, frozen=True, kw_only=True):
    """
    A suppressed finding, counted as such only.

    by: allow (a comment of the program) or baseline (a file of known findings).
    reason: why it was suppressed; empty if no reason was given.
    """

    by: str
    reason: str = ""


#: NotEvaluated.rule of the rules that a selection keeps from running.
DESELECTED = "deselected"


class NotEvaluated(msgspec.Struct, frozen=True, kw_only=True):
    """
    A rule that could not be evaluated.

    rule: its name.
    reason: why, and what to give.
    blocks: in how many blocks.
    matters: a fault could be missed, so the file is unverified.
    channel: of a file with several channels, as `$2`.
    """

    rule: str
    reason: str
    blocks: int
    matters: bool = True
    channel: str | UnsetType = UNSET


def radius_origin(source: str) -> str:
    """The source of a radius (PolarSection.radius_source) as a reader knows it: the job is a file."""
    return "polarcheck.toml" if source == "job" else source


class PolarSection(msgspec.Struct, frozen=True, kw_only=True):
    """
    What the verdict rests on in one polar section; null is unknown or absent.

    line, end_line: of its G12.1 and of its end.
    units: inch or mm, as the program has them there.
    offset: the tool offset in force, a number or tool and edge (MILL_8/1).
    radius: of the cutter [mm].
    radius_source: command line, job, offset table, program, comment or none.
    nearest: smallest distance of the tool center to the center of C in a cutting move [mm].
    c_feed, c_feed_line, c_feed_limit: highest C rate, its line, the limit of the machine [deg/min].
    center_line: line of the first cutting move that passes through the center of C, or stops there, where C has no
        angle and no rate; absent where none does.
    ramp_used: share of a start-up or offset cancel that its radius needs, the largest of the section; 1 at the limit.
    time: of its moves at the F in force, Z moves and dwells included [s].
    time_known: where there is no time, that of the blocks of which it is known [s].
    time_not_known: why it is not known of the others, by reason, as `dwell in line 12`.
    rotary: address of the rotary axis, which all of C are rates and places of, where it is not C.
    channel: of a file with several channels, as `$2`.
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
    center_line: int | UnsetType = UNSET
    ramp_used: float | None
    time: float | None
    time_known: float | UnsetType | None = UNSET
    time_not_known: list[str] | UnsetType = UNSET
    rotary: str | UnsetType = UNSET
    channel: str | UnsetType = UNSET


class OddSide(msgspec.Struct, frozen=True, kw_only=True):
    """
    A side of a part that differs from the others.

    line: of its block.
    size: of the side [mm].
    """

    line: int
    size: float


class LeftStanding(msgspec.Struct, frozen=True, kw_only=True):
    """
    Material that the tool leaves beside the finished part.

    kind: corner, rib or strip.
    text: the same in words.
    line: of the block that leaves it; null for corners.
    size: R of corners, else height or thickness [mm].
    count: of corners.
    place: [x, c] in the frame of the part [mm, radius]; null for corners.
    """

    kind: str
    text: str
    line: int | None
    size: float
    count: int = 1
    place: tuple[float, float] | None = None


class MadeInSection(msgspec.Struct, frozen=True, kw_only=True):
    """
    A polar section that makes a shape, or some of it.

    line, end_line: of its G12.1 and of its end.
    angle: of C at G12.1 [deg], from 0 to 360; null if unknown.
    """

    line: int
    end_line: int
    angle: float | None


class MadeShape(msgspec.Struct, frozen=True, kw_only=True):
    """
    A shape that polar sections make, at one or more depths, in the frame of the part: angles count from C0.

    line, end_line: of the G12.1 of the first section and of its end.
    sections: all sections that make it together, as flats with C between them.
    z: of the deepest pass [mm]; null if unknown.
    depths: Z of each pass [mm], in the order of the program.
    shape: hexagon, circle, flats, slot, contour, ...; null if unknown.
    inside: it is a pocket.
    is_regular: all its sides are equal.
    values: its sizes [mm, mm2, deg], see docs/part.md; where the angle of C is unknown, as the section writes it.
    odd: sides that differ from the others.
    text: the shape in words.
    left_standing: material that the tool leaves.
    needs: what is unknown, and what to give; null if nothing is.
    as_meant: numbers without a decimal point that are taken as if they had one, told at the first shape of a section;
        null if there are none.
    is_compared: false where the job asks for parts, but for none of these sections; absent where it asks for none.
    channel: of a file with several channels, as `$2`.
    """

    line: int
    end_line: int
    sections: list[MadeInSection]
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
    as_meant: str | None = None
    is_compared: bool | UnsetType = UNSET
    channel: str | UnsetType = UNSET


class PartComparison(msgspec.Struct, frozen=True, kw_only=True):
    """
    A contour compared with a drawing or a shape; lengths in mm.

    title: name of the drawing, or the shape.
    section_line: of the code that begins the section.
    z: of the contour; null if unknown.
    agrees: no difference is larger than the tolerance.
    largest: largest difference.
    tolerance: of the comparison.
    too_much, cut_away: most material that is left on the part, and that is missing.
    at: [x, c] of the largest difference as its section writes it, x as a radius; null where nothing differs.
    line: of the block there.
    turned: angle of a shape whose angle is not compared [deg].
    angle_not_compared: why it is not; null where it is, and where the shape has none.
    text: the comparison in words, in the units of the program.
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
    angle_not_compared: str | None
    text: str


class KnownStock(msgspec.Struct, frozen=True, kw_only=True):
    """
    The bar that rules about the metal rest on; null is unknown.

    diameter: within which there is material for certain [mm]; across flats of a hexagon.
    largest: diameter outside which there is none for certain [mm].
    bore: inside diameter, 0 for none [mm].
    face: Z of the face [mm].
    source: job, turning, comment or none, of the diameter.
    line, end_line: of the blocks that turn it, or of the comment.
    face_line, face_end_line: of the blocks that face it.
    """

    diameter: float | None
    largest: float | None
    bore: float | None
    face: float | None
    source: str
    line: int | None
    end_line: int | None
    face_line: int | None
    face_end_line: int | None


#: What `Outline.cuts` has of a finding: Z [mm], and F in mm/min and mm/rev.
LOWEST_Z, FASTEST, FASTEST_PER_REVOLUTION = "lowest_z", "fastest_f", "fastest_f_per_revolution"


class Outline(msgspec.Struct, frozen=True):
    """
    The blocks of a file in short, by which a baseline finds its places again.

    hashes: one per block that says something, in their order; renumbered and respaced blocks have the same.
    of: only hashes that are a multiple of this are listed, 1 for all.
    place_of_line: for lines of findings, and of the sections that they stand in, the index of the hash of the block
    there, or of the last one that is listed before it, -1 for none. Lines without a block, as of a comment, are absent.
    cuts: by `key`, for findings of rules that are `gouges`, the lowest Z and the highest F of their blocks, if known.
    lines: by `key`, for findings that a program has once, all lines that they stand for.
    """

    hashes: list[int]
    of: int
    place_of_line: dict[int, int]
    cuts: dict[str, dict[str, float]] = {}
    lines: dict[str, list[int]] = {}

    @staticmethod
    def key(finding: Finding) -> str:
        """Return the key of a finding in `cuts`."""
        return f"{finding.rule}:{finding.line}:{finding.column}"


class Decided(msgspec.Struct, frozen=True, kw_only=True):
    """
    The settings that decided a verdict and the exit code, as the user has written them.

    machine: name or file of the lathe.
    changes: values of it that the command line changes, as `limits.c_feed=3600`.
    select, ignore: rules, groups and alarms; an empty `select` is all.
    severities: error, warning, note or off by rule, group or alarm.
    inline: allow comments of programs are respected.
    fail_on: the lowest severity with which the check ends with 1, or never.
    max_warnings: with more warnings than this the check ends with 1; null for no such limit.
    strict: with an unverified file the check ends with 1.
    baseline: the file of known findings; null without one.
    configuration: the files of settings that were read, the nearest first, and those of the lathe.
    sources: by the name of a value that the user has set, where that is: an option, a variable of the environment, or a
        file.
    reasons: by the name of a value of a job file that switches rules off, its reason.
    """

    machine: str | None = None
    changes: Sequence[str] | None = []
    select: Sequence[str] | None = []
    ignore: Sequence[str] | None = []
    severities: Mapping[str, str] | None = {}
    inline: bool | None = True
    fail_on: str | None = "warning"
    max_warnings: int | None = None
    strict: bool | None = False
    baseline: str | None = None
    configuration: Sequence[str] | None = []
    sources: Mapping[str, str] | None = {}
    reasons: Mapping[str, str] | None = {}


class RunSettings(Decided, frozen=True, kw_only=True):
    """
    The settings that all files of a run share.

    version: of this program.
    differing: values in which the files differ, which are null here; each file has its `settings` then.
    diff_base: the commit since which a file must have changed to be checked; null where all are.
    """

    version: str = ""
    differing: list[str] = []
    diff_base: str | None = None


class Interrupted(msgspec.Struct, frozen=True, kw_only=True):
    """
    A run that did not reach its end.

    reason: why.
    checked, planned: how many files were reported, and how many there were to check.
    next_path: the first file that was not.
    """

    reason: str
    checked: int
    planned: int
    next_path: str | None = None


class FileReport(msgspec.Struct, frozen=True, kw_only=True):
    """
    The report of one file.

    path: of the file, as it was named or found.
    machine: its id: the name of a built-in machine, or the file name of a machine file, without `.toml`.
    machine_file: the path of the machine file, as given; absent for a built-in machine.
    programs: numbers or names of its programs.
    blocks, sections: executed blocks and polar sections.
    verdict: pass, fail, unverified or unreadable.
    reason: why a file is unreadable: it could not be read, or not be checked to its end.
    sha256: of the bytes of the file; null if they could not be read.
    profile_sha256: of the machine with all that inherits and changes it: two files with the same were judged alike.
    doubtful: keys of the profile that nobody is sure of, and that the result rests on: codes that the file writes, axes
        and compensation of its sections; `polarcheck machines NAME` says why.
    doubtful_parameters: of these keys, the control parameter by which the control itself decides.
    settings: what decided for this file, where the files of the run have different settings.
    polar_sections: what the verdict rests on.
    findings: the reported faults, sorted by line.
    not_evaluated: rules without a result.
    looked_at: aspects that were checked; outside polar sections these are text, flow and position.
    silenced: suppressed findings.
    stock: the bar before milling, if anything is known of it.
    makes: in one line what the only section makes, for text; not part of the JSON contract.
    outline: its blocks in short, for a baseline; not part of the JSON contract.
    part: what the program makes, if requested.
    compared: its contours compared with those asked for, if requested.
    """

    path: str
    machine: str = ""
    machine_file: str | UnsetType = UNSET
    programs: list[str]
    blocks: int
    sections: int
    verdict: str
    reason: str | UnsetType = UNSET
    sha256: str | None = None
    profile_sha256: str = ""
    doubtful: list[str] = []
    doubtful_parameters: dict[str, str] | UnsetType = UNSET
    settings: Decided | UnsetType = UNSET
    polar_sections: list[PolarSection] = []
    findings: list[Finding]
    not_evaluated: list[NotEvaluated]
    looked_at: list[str] = []
    silenced: list[Silenced] = []
    stock: KnownStock | None = None
    makes: str | UnsetType = UNSET
    outline: Outline | UnsetType = UNSET
    part: list[MadeShape] | UnsetType = UNSET
    compared: list[PartComparison] | UnsetType = UNSET

    @property
    def passed(self) -> bool:
        """True if the verdict is pass: all that matters was looked at, and nothing is wrong."""
        return self.verdict == PASS


class Producer(msgspec.Struct, frozen=True):
    """
    What wrote the report.

    name: polarcheck.
    version: of it.
    """

    name: str
    version: str


class NotRead(msgspec.Struct, frozen=True):
    """
    Files of walked folders that may be NC programs by their look, and were not read.

    ending: with its point, in lower case; empty for files without ending.
    files: their number.
    first: the path of the first of them.
    """

    ending: str
    files: int
    first: str


class Summary(msgspec.Struct, frozen=True, kw_only=True):
    """
    Counts over all files.

    files: that were reported.
    errors, warnings, notes: findings, without those that follow from another one.
    silenced: suppressed findings.
    pass, unverified, fail, unreadable: files by verdict.
    not_read: of the folders that were walked, by ending.
    excluded: programs that patterns exclude; in folders of more than 50,000 entries there may be more.
    """

    files: int
    errors: int
    warnings: int
    notes: int
    silenced: int
    passed: int = msgspec.field(name="pass")
    unverified: int
    fail: int
    unreadable: int
    not_read: list[NotRead] = []
    excluded: int = 0


class Assumed(msgspec.Struct, frozen=True, kw_only=True):
    """
    What --unsafe-fixes has written into a file before its check, and the program does not say: the result rests on it.

    path, line: of the file as it is checked; the line counts from 1.
    block: the block there, as it is written now.
    rule: the rule whose finding was fixed.
    title: the fix in a few words.
    """

    path: str
    line: int
    block: str
    rule: str
    title: str


class Report(msgspec.Struct, frozen=True, kw_only=True):
    """
    The report over all files.

    schema: number of the JSON contract.
    tool: what wrote the report.
    machine: of all files; null if they differ.
    settings: what decided the verdicts and the exit code.
    interrupted: why the run ended before its last file; absent where it did not.
    assumed: what --unsafe-fixes has written into the files before; absent where it has written nothing.
    files: the files, in the order in which they were named.
    summary: counts over all files.
    """

    schema: int
    tool: Producer
    machine: str | None
    settings: RunSettings = RunSettings()
    interrupted: Interrupted | UnsetType = UNSET
    assumed: list[Assumed] | UnsetType = UNSET
    files: Sequence[FileReport]
    summary: Summary

    @property
    def passed(self) -> bool:
        """True if all files have passed, and the run has reached its end; False if there is no file."""
        return bool(self.files) and self.interrupted is UNSET and all(file.passed for file in self.files)
