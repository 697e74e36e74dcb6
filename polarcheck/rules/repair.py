"""
The fix of a finding: what to write instead, as edits of the text.

Nothing is registered: rules/<group>/<rule>_repair.py repairs what the rule beside it reports.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Iterator

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.finding import Edit, Fix
from polarcheck.program.reading.source import Source
from polarcheck.rules import places
from polarcheck.rules.documented import Documented
from polarcheck.rules.editing import Replace
from polarcheck.rules.places import PLACES, Place
from polarcheck.rules.rule import FOLDER, REPAIR, Hits, Rule
from polarcheck.rules.tables import Tables, called

#: A block that runs more often is not looked at each time, and has no fix.
_MOST_RUNS = 1000
#: What of the path of the tool center a fix may change in the lines that it edits; the way also of the move before.
CHANGES = FEED, Z, WAY = "feed", "z", "way"


class Mended(msgspec.Struct, frozen=True):
    """What to write instead at one place; safe: no axis moves otherwise than written."""

    title: str
    safe: bool
    edits: tuple[Replace, ...]


class Repair(Documented, frozen=True):
    """
    How the findings of one rule are mended; its page says what is written, why it is safe or not, and shows programs
    before and after.

    function: takes by their names the tables that it needs, and place, row, index, at and count as phrases do, and
    `hit`, the mask of the rule; gives a Mended, or None where nobody can say what to write. changes: what of the path
    of the tool center differs in the lines that it edits (CHANGES); nothing does elsewhere.
    """

    changes: tuple[str, ...]


def repair(*changes: str) -> Callable[[Callable[..., Mended | None]], Repair]:
    """Make a Repair of a function; see there."""

    def make(function: Callable[..., Mended | None]) -> Repair:
        return Repair(function.__name__.replace("_", "-"), function, changes)

    return make


@functools.cache
def repairs() -> dict[str, str]:
    """The modules of the repairs by the names of their rules, in order; none is loaded."""
    modules = {path.stem.removesuffix(REPAIR): path for path in FOLDER.glob(f"*/*{REPAIR}.py")}
    return {
        rule.replace("_", "-"): f"polarcheck.rules.{path.parent.name}.{path.stem}"
        for rule, path in sorted(modules.items())
    }


def repair_of(name: str) -> Repair | None:
    """How the findings of a rule are mended; None where nothing is known for it."""
    module = repairs().get(name)
    if module is None:
        return None
    repair_of_rule: Repair = getattr(importlib.import_module(module), name.replace("-", "_"))
    return repair_of_rule


def fix_of(rule: Rule, hits: Hits, tables: Tables, place: Place, count: int) -> Fix | None:
    """
    The fix of a finding; None where there is none, or where the runs of its block do not agree about it.

    count: how many elements the finding stands for.
    """
    way = repair_of(rule.name)
    if way is None:
        return None
    trace: Trace = tables["trace"]
    mended = _mended(way, rule, hits, tables, place, count)
    if mended is None:
        return None
    for other in _other_runs(rule, tables, place):
        if other is None or not hits.mask[other.index]:
            return None
        if _mended(way, rule, hits, tables, other, count) != mended:
            return None
    source = trace.text.source
    own = int(source.line_starts[source.parts[0].first_line - 1]) if source.parts else len(source.code)
    if any(end > own for _, end, _ in mended.edits):
        return None  # in a called program of another file
    return Fix(title=mended.title, safe=mended.safe, edits=[_edit(source, *one) for one in sorted(mended.edits)])


def _mended(way: Repair, rule: Rule, hits: Hits, tables: Tables, place: Place, count: int) -> Mended | None:
    at: list[int] = []
    if rule.over in ("rows", "sections"):
        at = places.words_at_fault(tables, place.row, rule.at, hits.at)
    given = {"place": place, "row": place.row, "index": place.index, "at": at, "count": count, "hit": hits.mask}
    found: Mended | None = called(way.function, tables, given)
    return found if found is None or found.edits else None


def _other_runs(rule: Rule, tables: Tables, place: Place) -> Iterator[Place | None]:
    """The elements of the same block that other rows make; None where they are too many."""
    if rule.over not in ("rows", "sections"):
        return
    own = np.flatnonzero(places.blocks(rule.over, tables) == place.block)
    if len(own) > _MOST_RUNS:
        yield None
        return
    for index in own.tolist():
        if index != place.index:
            yield PLACES[rule.over](tables, index)


def _edit(source: Source, start: int, end: int, text: str) -> Edit:
    line, end_line = source.line_of(start), source.line_of(end)
    return Edit(
        line=line,
        column=start - int(source.line_starts[line - 1]) + 1,
        end_line=end_line,
        end_column=end - int(source.line_starts[end_line - 1]) + 1,
        text=text,
    )
