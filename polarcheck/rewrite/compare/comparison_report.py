"""The result of a comparison of two revisions, as JSON has it."""

from __future__ import annotations

import msgspec

#: The same but for block numbers, spaces and comments; the same but for its words; not so; nobody knows.
VERDICTS = SAME_WORDS, SAME_METAL, DIFFERS, NOT_COMPARED = "same words", "same metal", "differs", "not compared"
#: What has become of a section.
CHANGES = ("same", "changed", "moved", "missing", "added", "not compared")
#: What is compared, in the words of the report.
COMPARED = (
    "the path of the tool center in sections on the part, with Z",
    "the moves outside of sections: X, Z, C, and arcs in their plane",
    "rapid traverse and F along the paths",
    "where a coordinate has a decimal point in one revision alone",
    "the state at the beginning of sections: tool, offset, R, C, spindle, live tool, S, plane",
    "tools, S, M codes, cycles, dwells and other G codes in their order, and where they stand on the path",
)
NEVER_COMPARED = (
    "comments, block numbers and the head of the program",
    "how macro statements compute what is compared",
)


class Difference(msgspec.Struct, frozen=True):
    """
    Something that differs.

    what: path, depth, feed, point, order, place, section, or a state: tool, offset, radius, c_angle, spindle,
    live_tool, speed, plane.
    old, new: its values, null where there is none; unit: mm, mm/min, mm/rev, deg, rev/min, empty for words.
    old_line, new_line: lines of the files, null where there is none. way: over this length [mm], null for none.
    """

    what: str
    text: str
    old: float | str | None = None
    new: float | str | None = None
    unit: str = ""
    old_line: int | None = None
    new_line: int | None = None
    way: float | None = None


class Side(msgspec.Struct, frozen=True):
    """A section in one revision: lines, least Z [mm], time [s], highest rate of C [deg/min]; null is not known."""

    line: int
    end_line: int
    depth: float | None
    time: float | None
    c_feed: float | None


class SectionPair(msgspec.Struct, frozen=True):
    """
    A polar section in both revisions; null where it is missing.

    change: same, changed, moved, missing, added, or not compared. deviation: the largest of the path [mm], null where
    it was not measured. is_exact: that number is exact; else it is no more than that.
    """

    old: Side | None
    new: Side | None
    change: str
    deviation: float | None
    is_exact: bool
    differences: list[Difference]


class NotCompared(msgspec.Struct, frozen=True):
    """Something that was not compared. matters: no verdict can be given without it."""

    reason: str
    matters: bool = True


class Program(msgspec.Struct, frozen=True):
    """One of the two files: path, machine, number of executed blocks and of polar sections."""

    path: str
    machine: str
    blocks: int
    sections: int


class Comparison(msgspec.Struct, frozen=True):
    """
    Two revisions compared.

    verdict: same words, same metal, differs, or not compared. tolerance: of lengths [mm].
    deviation: the largest of all paths that were compared [mm]; null where none was. is_exact: as in SectionPair.
    sections: in the order of the old revision, then those that were added. outside: what differs outside of sections.
    """

    old: Program
    new: Program
    verdict: str
    tolerance: float
    deviation: float | None
    is_exact: bool
    sections: list[SectionPair]
    outside: list[Difference]
    not_compared: list[NotCompared]
    compared: tuple[str, ...] = COMPARED
    never_compared: tuple[str, ...] = NEVER_COMPARED


class ComparisonReport(msgspec.Struct, frozen=True):
    """
    The JSON document of `polarcheck compare`.

    schema: its version. files: a comparison for each pair of files. only_old, only_new: programs of two folders that
    the other one does not have.
    """

    schema: int
    tool: dict[str, str]
    files: list[Comparison]
    only_old: list[str] = []
    only_new: list[str] = []
