"""What a check gives: findings, what was not evaluated, and the report (the JSON contract)."""

from __future__ import annotations

import enum
from typing import Any

import msgspec


class Severity(enum.IntEnum):
    """How bad a finding is; a rule may give one per row, 0 where there is nothing to say."""

    NOTE = 1
    WARNING = 2
    ERROR = 3


NOTE, WARNING, ERROR = Severity.NOTE, Severity.WARNING, Severity.ERROR


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
    """One reported fault. Lines and columns count from 1, columns in characters; end_column is behind the last one."""

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


class NotEvaluated(msgspec.Struct, frozen=True, kw_only=True):
    """What was not looked at, why, in how many blocks."""

    rule: str
    reason: str
    blocks: int


class FileReport(msgspec.Struct, frozen=True, kw_only=True):
    """All about one file. Verdict: pass, fail or unverified."""

    path: str
    programs: list[str]
    blocks: int
    sections: int
    verdict: str
    findings: list[Finding]
    not_evaluated: list[NotEvaluated]


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


class Report(msgspec.Struct, frozen=True, kw_only=True):
    """The whole report; the JSON contract, whose number is `schema`."""

    schema: int
    tool: Producer
    machine: str
    files: list[FileReport]
    summary: Summary
