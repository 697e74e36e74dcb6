"""Whether a section that this machine reads badly is one for another: by its axis, and by X in its arcs."""

from __future__ import annotations

import re

import msgspec
import numpy as np

from polarcheck.columns.modes.mode_words import ModeWords
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, cached_property
from polarcheck.program.execution.run import straight
from polarcheck.program.machines import profiles
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.profiles import Profile
from polarcheck.program.reading import source
from polarcheck.program.reading.channel_texts import channel_like
from polarcheck.program.reading.translation import stands_in, translated
from polarcheck.program.reading.words import Text, read_words
from polarcheck.rules.remedies import is_chosen
from polarcheck.rules.tables import Tables

#: More titles than this in one message help nobody.
NAMED = 3
#: Blocks that are searched for words of other controls.
_LOOKED_AT = 20


class Fit(msgspec.Struct, frozen=True):
    """Machines that read a program well, and why."""

    profiles: tuple[Profile, ...]
    reasons: tuple[str, ...]

    def text(self) -> str:
        """`Haas lathe (--machine haas-lathe): Y is the second axis there`."""
        named = [f"{profile.machine.title} (--machine {profile.name})" for profile in self.profiles[:NAMED]]
        return f"{' or '.join(named)}: {', '.join(self.reasons)}"


class OtherMachine:
    """Which other machines read the program of some tables well, and why."""

    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        self.trace: Trace = tables["trace"]

    @cached_property
    def _fit(self) -> Fit | None:
        return _find(self.tables)

    @property
    def text(self) -> str:
        """`; it reads well on ...`: which machines, and why; empty if none does, or somebody has chosen the machine."""
        if is_chosen(self.trace.machine, self.trace.job) or not self._fit:
            return ""
        return f"; it reads well on {self._fit.text()}"

    @property
    def is_in_its_language(self) -> bool:
        """The program has an axis or words that this machine does not have, and another reads it well with them."""
        has_signs = _names_other_axis(self.tables).any() or self.tables["words"].is_unreadable.any()
        return bool(has_signs and self.text)


def _find(tables: Tables) -> Fit | None:
    """
    The machines that read the program well where this one does not.

    Cheap for a program that is read well: only an axis address of other controls, words of their languages, or arcs
    that close with X read the other way make it look at other machines.
    """
    trace: Trace = tables["trace"]
    if not len(trace.mode.sections):
        return None
    is_misread = bool(np.any(_names_other_axis(tables) | tables["arcs"].x_is_misread))
    unread = _unread_lines(trace.text)
    if not is_misread and not unread:
        return None
    fitting: dict[tuple[str, ...], list[Profile]] = {}
    told = [_reads(trace.machine)]
    for profile in profiles.built_in():
        if {*profile.machine.polar.on} <= {*profile.written.control.native_words.values()}:
            continue  # its programs begin the mode by a word, for which such a code stands inside alone
        words = words_of(profile.machine, unread)
        if (not words and not is_misread) or _reads(profile.machine) in told:
            continue
        reasons = _reasons(tables, profile.machine, words)
        if reasons:
            told.append(_reads(profile.machine))
            fitting.setdefault(reasons, []).append(profile)
    if not fitting:
        return None
    reasons = max(fitting, key=len)
    return Fit(tuple(fitting[reasons]), reasons)


def _reads(machine: Machine) -> tuple[object, ...]:
    """What of a machine makes it read a program otherwise than another."""
    control, mode = machine.control, machine.polar
    switches = {*mode.on, *mode.off, machine.arcs.radius_word}
    native = {word: text for word, text in control.native_words.items() if text in switches}
    return mode.on, mode.virtual_axes, mode.x, machine.arcs.radius_word, native, control.motion_codes


def _reasons(tables: Tables, machine: Machine, words: list[str]) -> tuple[str, ...]:
    """Why the machine reads the program well; empty where it does not. words: those of its own language."""
    there = _read_by(tables, machine)
    trace: Trace = tables["trace"]
    other: Trace = there["trace"]
    own, mode = trace.machine.polar, machine.polar
    if not reads_well(there):
        return ()
    reasons = []
    if mode.virtual_axis not in own.virtual_axes and np.any(other.blocks.has(mode.virtual_axis) & other.mode.in_polar):
        reasons.append(f"{mode.virtual_axis} is the second axis of the polar plane there")
    if mode.x != own.x and np.any(tables["arcs"].x_is_misread):
        reasons.append(f"all arcs close there, where X is a {mode.x} in the polar mode")
    reasons += [f"it has {word}" for word in words[:1]]
    return tuple(reasons)


def _unread_lines(text: Text) -> str:
    """The blocks of a program with a number that the control cannot read, a line each, up to a limit."""
    blocks = np.unique(text.words.block[text.words.is_unreadable])[:_LOOKED_AT]
    return "\n".join(without_comments(text.source.line_text(int(line))) for line in text.blocks.line[blocks])


def without_comments(block: str) -> str:
    """A block without what stands in parentheses or behind a semicolon."""
    return re.sub(r"\([^)]*+\)?|;.*", " ", block)


def words_of(machine: Machine, lines: str) -> list[str]:
    """The words in some lines that a machine has in a language of its own, longer than one letter."""
    named = dict.fromkeys([*machine.control.native_words, *filter(str.isalpha, machine.macro.statements)])
    return [word for word in named if len(word) > 1 and stands_in(lines, word)]


def _names_other_axis(tables: Tables) -> Mask:
    """Rows in the mode with the address of the virtual axis of other controls."""
    trace: Trace = tables["trace"]
    words: ModeWords = tables["mode_words"]
    return trace.mode.in_polar & words.rows(words.of_other_axis)


def _switch_is_not_alone(tables: Tables) -> bool:
    """Whether a G12.1 or G13.1 shares its block with what the machine does not take there."""
    words: ModeWords = tables["mode_words"]
    return bool(np.any(words.in_rows(words.switches) & ~words.may_stand_beside_switch))


def _language(machine: Machine) -> tuple[object, ...]:
    """What of a machine makes it find other words in a text than another."""
    return machine.control.native_words, machine.control.line_comments, machine.macro.language


def reads_well(there: Tables) -> bool:
    """Whether sections of a program begin and end on the machine of the tables, and nothing in them is odd there."""
    trace: Trace = there["trace"]
    arcs = there["arcs"]
    if not len(trace.mode.sections) or not trace.mode.sections.left.all() or _names_other_axis(there).any():
        return False
    if there["words"].is_unreadable.any():
        return False
    if arcs.is_no_circle.any() or arcs.x_is_misread.any() or _switch_is_not_alone(there):
        return False
    unread = trace.run.unknown | trace.blocks.with_words(trace.blocks.words_not_followed)
    return not np.any(unread & (trace.mode.section >= 0))  # else nobody knows how it reads there


def _read_by(tables: Tables, machine: Machine) -> Tables:
    """The program as another machine reads it."""
    trace: Trace = tables["trace"]
    ours, theirs = trace.machine.control, machine.control
    if _language(trace.machine) == _language(machine):
        return Tables(trace.run, machine, trace.job)
    found = source.read_source(trace.text.source.data, trace.text.source.path)
    found = channel_like(found, trace.text.source, ours.channel_mark, ours.line_comments)
    found = translated(found, theirs.native_words, machine.macro.language)
    marks = theirs.line_comments, ours.channel_mark, ours.wait_mark
    text = read_words(found, *marks, machine.macro.language, blanks_in_numbers=theirs.blanks_in_numbers)
    return Tables(straight(text, machine.m_codes.program_end), machine, trace.job)
