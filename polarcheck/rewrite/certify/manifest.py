"""The manifest of a post, post.toml: features, controls, and the cases that each feature has on each control."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from polarcheck.program.machines.job import OfPrograms
from polarcheck.program.machines.part_keys import Part
from polarcheck.program.machines.value_types import EXPECTED, KeyedError

#: The features of a post that the matrix lists unless the manifest has a list of its own.
FEATURES = (
    *("contour", "pocket", "arcs-by-radius", "arcs-by-center", "arc-above-180", "helical", "compensation-left"),
    *("compensation-right", "several-depths", "indexing", "inch", "incremental", "canned-end"),
)
#: Keys of a job that a case has in another way, with that way.
DECIDED = {
    "fail_on": "verdict says what is expected of a case",
    "strict": "verdict says what is expected of a case; --strict concerns the matrix",
    "select": "all rules run; findings says which of them are expected",
    "ignore": "all rules run; findings says which of them are expected",
}
#: The place of the feature in `programs` and `golden` of a control.
PLACE = "{feature}"

Verdict = Literal["pass", "fail", "unverified"]
#: A name of a feature or a control stands in file names and in a table.
Name = Annotated[
    str,
    msgspec.Meta(
        pattern=r"^[^\W_][\w .+()-]{0,59}$", extra={EXPECTED: "a name of letters, digits, blanks and - . + ( )"}
    ),
]
Tolerance = Annotated[float, msgspec.Meta(gt=0, le=100)]


class ExpectedFinding(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    A finding that a program must have.

    rule: its name.
    line: of the block, from 1; None for any.
    block: the words of the block without its number, as an alternative to the line; None for any.
    """

    rule: Annotated[str, msgspec.Meta(description="name of the rule")]
    line: Annotated[int, msgspec.Meta(ge=1, description="line of the block, from 1; else any")] | None = None
    block: (
        Annotated[str, msgspec.Meta(description="words of the block without N, which outlast a renumbering")] | None
    ) = None

    def __post_init__(self) -> None:
        if self.line is not None and self.block is not None:
            raise KeyedError("block", "a finding has a line or a block, not both")


class Conditions(OfPrograms, frozen=True, kw_only=True):
    """
    How programs are read and run, with the keys of a job, and what they make.

    config: a job file that applies below these values.
    part: what the programs must make.
    tolerance: how far a path may be from its golden trace, or from the path of another case [mm].
    path: which path is compared: that of the tool center, or the programmed one.
    """

    config: Annotated[str, msgspec.Meta(description="job file whose values apply where none are given here")] | None = (
        None
    )
    part: Annotated[list[Part], msgspec.Meta(description="what the programs must make, as in polarcheck.toml")] = (
        msgspec.field(default_factory=list)
    )
    tolerance: Annotated[Tolerance | None, msgspec.Meta(description="between two paths [mm]; 0.01 unless given")] = None
    path: (
        Annotated[Literal["tool", "programmed"], msgspec.Meta(description="which path is compared; tool unless given")]
        | None
    ) = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for key, reason in DECIDED.items():
            if getattr(self, key) != _DEFAULTS[key]:
                raise KeyedError(key, f"no key of a manifest: {reason}")
        _refuse_files(self.part)


def _refuse_files(parts: list[Part]) -> None:
    """Raise KeyedError for a part that names files: where it stands says which programs must make it."""
    for number, part in enumerate(parts, 1):
        if part.files:
            raise KeyedError(f"part.{number}.files", "no key of a manifest: a part is for the cases of its table")


class Feature(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    A feature of a post.

    title: what it is, in words.
    part: what the programs of all controls must make; lengths in the units of the manifest, else of each program.
    """

    title: str = ""
    part: Annotated[list[Part], msgspec.Meta(description="what the programs of all controls must make")] = (
        msgspec.field(default_factory=list)
    )

    def __post_init__(self) -> None:
        _refuse_files(self.part)


class Control(Conditions, frozen=True, kw_only=True):
    """
    A control that the post serves: a column of the matrix.

    programs: file of the program of each feature, with {feature} in its name.
    golden: file of its golden trace, likewise.
    same_path_as: another control, whose case of the same feature has the same path.
    not_offered: features that the post does not offer here, each with the reason.
    """

    programs: Annotated[str, msgspec.Meta(description="of each feature: lathe-7/{feature}.nc")] | None = None
    golden: (
        Annotated[str, msgspec.Meta(description="golden trace of each feature: golden/lathe-7/{feature}.jsonl")] | None
    ) = None
    same_path_as: Annotated[str, msgspec.Meta(description="control that makes the same paths")] | None = None
    not_offered: Annotated[dict[str, str], msgspec.Meta(description="reason, by feature")] = msgspec.field(
        default_factory=dict
    )


class Case(Conditions, frozen=True, kw_only=True):
    """
    A program with what is expected of it.

    name: unique; else feature/control.
    feature, control: the row and the column of the matrix.
    program: file, relative to the manifest.
    verdict: expected; else fail where findings are expected, pass where none are.
    findings: all that it must have of warnings and errors; notes need not be listed.
    golden: file of the golden trace, relative to the manifest.
    same_path_as: name of a case that has the same path.
    """

    name: str = ""
    feature: Name
    control: Name
    program: Annotated[str, msgspec.Meta(description="file, relative to the manifest")]
    verdict: Verdict | None = None
    findings: list[ExpectedFinding] = msgspec.field(default_factory=list)
    golden: str | None = None
    same_path_as: str | None = None

    @property
    def title(self) -> str:
        """The name, as other cases refer to it."""
        return self.name or f"{self.feature}/{self.control}"

    @property
    def expected(self) -> str:
        """The expected verdict."""
        return self.verdict or ("fail" if self.findings else "pass")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.verdict == "fail" and not self.findings:
            raise KeyedError("verdict", 'expected findings beside "fail": which rules, and in which lines')


class Manifest(Conditions, frozen=True, kw_only=True):
    """
    A manifest.

    title: name and version of the post.
    features: rows of the matrix, in this order; the standard ones unless given.
    feature: what is said of features, by name.
    controls: columns of the matrix, by name, in their order.
    case: the cases.
    """

    title: Annotated[str, msgspec.Meta(description="name and version of the post")] = ""
    features: Annotated[list[Name], msgspec.Meta(description="rows of the matrix; the standard ones unless given")] = (
        msgspec.field(default_factory=lambda: [*FEATURES])
    )
    feature: Annotated[dict[Name, Feature], msgspec.Meta(description="title and part of features, by name")] = (
        msgspec.field(default_factory=dict)
    )
    controls: Annotated[dict[Name, Control], msgspec.Meta(description="columns of the matrix, by name")] = (
        msgspec.field(default_factory=dict)
    )
    case: Annotated[list[Case], msgspec.Meta(description="programs with what is expected of them")] = msgspec.field(
        default_factory=list
    )


_DEFAULTS = {
    field.name: [] if field.name in ("select", "ignore") else field.default
    for field in msgspec.structs.fields(OfPrograms)
}
