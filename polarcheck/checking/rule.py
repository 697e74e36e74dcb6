"""What a rule is, what it returns, and how rules are found. Nothing is registered: a file under rules/ is a rule."""

from __future__ import annotations

import functools
import os
import re
import sys
from collections.abc import Callable, Mapping
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.checking.causes import DOUBTFUL, RESTS_ON, UNIT, UNIT_OF, Doubt, subject_of
from polarcheck.checking.documented import Documented
from polarcheck.checking.tables import OF_CAUSE, OF_TEXT, SPANS
from polarcheck.checking.tables import parameters as parameters_of
from polarcheck.errors import RuleError, UsageError, suggestion
from polarcheck.finding import ERROR as ERROR
from polarcheck.finding import NOTE as NOTE
from polarcheck.finding import WARNING as WARNING
from polarcheck.finding import Severity as Severity

if TYPE_CHECKING:
    from polarcheck.arrays import Floats as Floats
    from polarcheck.arrays import Mask as Mask
    from polarcheck.arrays import States
    from polarcheck.checking.macro_faults import Faults as Faults
    from polarcheck.checking.other_machine import OtherMachine as OtherMachine
    from polarcheck.columns.axes import PlaneAxes as PlaneAxes
    from polarcheck.columns.blocks import ExecutedBlocks as ExecutedBlocks
    from polarcheck.columns.compensation import CutterCompensation as CutterCompensation
    from polarcheck.columns.coordinates import Coordinates as Coordinates
    from polarcheck.columns.feedrate import Feedrate as Feedrate
    from polarcheck.columns.lengths import Lengths as Lengths
    from polarcheck.columns.modal import ModalStates as ModalStates
    from polarcheck.columns.mode import PolarMode as PolarMode
    from polarcheck.columns.offsets import ToolOffsets as ToolOffsets
    from polarcheck.columns.path import ProgrammedPath as ProgrammedPath
    from polarcheck.columns.sections import Sections as Sections
    from polarcheck.columns.tools import CalledTools as CalledTools
    from polarcheck.columns.trace import Trace as Trace
    from polarcheck.execution.run import Run as Run
    from polarcheck.machines.job import Job as Job
    from polarcheck.machines.machine import Machine as Machine
    from polarcheck.reading.words import Text as Text
    from polarcheck.reading.words import Words as Words
    from polarcheck.silence.allow_comments import Allows as Allows
    from polarcheck.silence.allow_comments import UnusedAllows as UnusedAllows
    from polarcheck.table.angles import Angles as Angles
    from polarcheck.table.arcs import Arcs as Arcs
    from polarcheck.table.center import Center as Center
    from polarcheck.table.coverage import Coverage as Coverage
    from polarcheck.table.deviations import Deviations as Deviations
    from polarcheck.table.dialect import Dialect as Dialect
    from polarcheck.table.entry import Entry as Entry
    from polarcheck.table.feed_ranges import FeedRanges as FeedRanges
    from polarcheck.table.feeds import Feeds as Feeds
    from polarcheck.table.infeed import Infeed as Infeed
    from polarcheck.table.mirrored import Mirrored as Mirrored
    from polarcheck.table.mode_words import ModeWords as ModeWords
    from polarcheck.table.other_mode import OtherMode as OtherMode
    from polarcheck.table.overcuts import Overcuts as Overcuts
    from polarcheck.table.procedure import Procedure as Procedure
    from polarcheck.table.ramps import Ramps as Ramps
    from polarcheck.table.senses import Senses as Senses
    from polarcheck.table.slots import Slots as Slots
    from polarcheck.table.spindles import Spindles as Spindles
    from polarcheck.table.switch_words import SwitchWords as SwitchWords
    from polarcheck.table.tool_center import ToolCenter as ToolCenter
    from polarcheck.table.travel import Travel as Travel
    from polarcheck.table.uncompensated_cuts import UncompensatedCuts as UncompensatedCuts
    from polarcheck.table.unpointed import Unpointed as Unpointed
    from polarcheck.table.written import Written as Written
else:

    def __getattr__(name: str) -> Any:
        """Rules name the types of their tables for readers; at run time they need none of them, and load none."""
        if not name[:1].isupper():
            raise AttributeError(name)
        return Any


FOLDER = Path(__file__).parent.parent / "rules"
#: A module of this ending repairs what the rule of the same name reports.
REPAIR = "_repair"

#: What the elements of a mask can stand for (places.PLACES finds where each stands).
OVER = (
    "rows",
    "words",
    "sections",
    "comments",
    "strays",
    "foreign",
    "prose",
    "dots",
    "outside",
    "programs",
    "faults",
    "files",
    "allows",
)


class Hits(msgspec.Struct, frozen=True):
    """
    What a rule has found, where a mask alone does not say it all.

    mask: bool per element of what the rule is `over`. severity: one for all of them, or one per element, where it is
    not the rule's own. at: bool per executed word, the words at fault, where the rule's own `at` cannot name them.
    values: for the message, by name: a column with a value per element, or one value for all. follows: by
    span of the rule's own `follows`, bool per element, those to which it applies, where it does not to all.
    undecided: bool per element, those of which nobody can say that something is wrong: they leave the file unverified.
    """

    mask: Mask
    severity: Severity | States | None = None
    at: Mask | None = None
    values: Mapping[str, Any] = {}
    follows: Mapping[str, Mask] = {}
    undecided: Mask | None = None


def graded(
    *,
    error: Mask | None = None,
    warning: Mask | None = None,
    note: Mask | None = None,
    at: Mask | None = None,
    values: Mapping[str, Any] | None = None,
    follows: Mapping[str, Mask] | None = None,
    undecided: Mask | None = None,
) -> Hits:
    """Hits of several severities: of an element that stands in more than one mask the highest counts."""
    import numpy as np

    given = [(level, mask) for level, mask in ((NOTE, note), (WARNING, warning), (ERROR, error)) if mask is not None]
    severity = np.zeros(len(given[0][1]), np.int16)
    for level, mask in given:
        severity[mask] = level
    return Hits(severity > 0, severity, at, values or {}, follows or {}, undecided)


class Rule(Documented, frozen=True):
    """
    One rule: its function and what is said about it.

    parameters: the tables that the function compares, by name. over: what the elements of the mask stand for.
    at: of the words at fault the addresses, or the lists of the machine that their codes stand in (rapid, line), "on"
    and "off" for the codes of the mode; the whole block if empty or if the block has none of them.
    needs: columns, as in `compensation.radius`, without which the rule cannot say anything where the column `where`
    holds.
    once: what is one cause, so that one finding stands for all of it (SPANS): a section, a program, an F word.
    subject: what it judges (causes.RESTS_ON); "" for words and states, which no finding makes doubtful.
    doubts: what its finding makes doubtful, and within which span; what rests on that is listed under it.
    follows: by span the rules that say the same thing first, so that this finding is listed under theirs.
    worst: of those that one finding stands for, the one with the highest value of this column is reported.
    is_advice: off where neither the machine nor the user names a severity for it.
    """

    group: str
    severity: Severity
    message: str
    over: str
    at: tuple[str, ...]
    needs: tuple[str, ...]
    where: str
    once: str
    subject: str
    doubts: tuple[Doubt, ...]
    follows: Mapping[str, tuple[str, ...]]
    worst: str
    is_advice: bool
    parameters: tuple[str, ...]

    def __reduce__(self) -> tuple[Callable[[str], Rule], tuple[str]]:
        """Another process finds it by its name: its function cannot be sent, whose name means the rule itself."""
        return _named, (self.name,)

    @property
    def of_text(self) -> bool:
        """Whether it hangs on the text alone, and not on how the program runs."""
        return OF_TEXT.issuperset(self.parameters)

    def level(self, severities: Mapping[str, str]) -> str:
        """error, warning, note or off, where a machine and a job name these severities by rule."""
        return severities.get(self.name, "off" if self.is_advice else self.severity.name.lower())

    def hits(self, tables: Mapping[str, Any]) -> Hits:
        """What the rule finds in some tables."""
        found = self.function(*(tables[name] for name in self.parameters))
        return found if isinstance(found, Hits) else Hits(found)

    def causes(self, rules: Mapping[str, Rule]) -> dict[str, list[str]]:
        """
        By span the names of those of `rules` from which its findings follow, the narrowest spans first.

        An infeed cycle runs the contour of its section as a whole, so that a doubt anywhere in the section counts.
        """
        causes = {span: [*names] for span, names in self.follows.items()}
        rests_on = RESTS_ON.get(self.subject, ())
        for other in rules.values():
            for what, span in other.doubts:
                is_peer = other.subject == self.subject and span not in OF_CAUSE
                is_named = any(self.name in names for names in other.follows.values())  # it follows this one
                if what in rests_on and not is_peer and not is_named:
                    reach = UNIT_OF[self.subject] if span == UNIT or self.subject == "infeed" else span
                    causes.setdefault(reach, []).append(other.name)
        return {span: causes[span] for span in SPANS if span in causes}

    @property
    def source(self) -> str:
        """What the page names as its source."""
        found = re.search(r"^Source: (.*?)(?:\n\n|\Z)", self.page, re.MULTILINE | re.DOTALL)
        return " ".join(found[1].split()) if found else ""


def rule(
    severity: Severity,
    message: str,
    *,
    over: str = "rows",
    at: tuple[str, ...] = (),
    needs: tuple[str, ...] = (),
    where: str = "mode.in_polar",
    once: str = "",
    subject: str | None = None,
    doubts: tuple[Doubt, ...] = (),
    follows: Mapping[str, tuple[str, ...]] = MappingProxyType({}),
    worst: str = "",
    is_advice: bool = False,
) -> Callable[[Callable[..., Any]], Rule]:
    """Make a rule of a function; see Rule. Its parameters name the tables that it compares."""

    def make(function: Callable[..., Any]) -> Rule:
        group = function.__module__.split(".")[-2]
        name = function.__name__.replace("_", "-")
        if over not in OVER:
            raise RuleError(f"rule {name}: over={over!r}: expected one of {', '.join(OVER)}")
        spans = {*follows, *([once] if once else []), *(span for _, span in doubts if span != UNIT)}
        if unknown := spans - set(SPANS):
            raise RuleError(f"rule {name}: {unknown.pop()!r}: expected one of {', '.join(SPANS)}")
        if unknown := {what for what, _ in doubts} - DOUBTFUL:
            raise RuleError(f"rule {name}: {unknown.pop()!r}: expected one of {', '.join(sorted(DOUBTFUL))}")
        if subject and subject not in RESTS_ON:
            raise RuleError(f"rule {name}: {subject!r}: expected one of {', '.join(RESTS_ON)}")
        parameters = parameters_of(function)
        judged = subject_of(parameters) if subject is None else subject
        return Rule(
            name,
            function,
            group,
            severity,
            message,
            over,
            at,
            needs,
            where,
            once,
            judged,
            doubts,
            follows,
            worst,
            is_advice,
            parameters,
        )

    return make


def rule_files() -> list[str]:
    """The files that hold a rule, sorted; as texts, because sorting 135 Path objects takes 3 ms."""
    others = "__init__.py", f"{REPAIR}.py"
    return sorted(path for path in map(str, FOLDER.glob("*/*.py")) if not path.endswith(others))


@functools.cache
def load_all() -> dict[str, Rule]:
    """
    All rules by name, in order of group and name.

    Raises RuleError for a file under rules/ that holds no rule of its own name.
    """
    rules = {}
    for path in rule_files():
        group, stem = path.removesuffix(".py").split(os.sep)[-2:]  # noqa: PTH206
        found = getattr(_module(f"polarcheck.rules.{group}.{stem}", path), stem, None)
        if not isinstance(found, Rule):
            raise RuleError(f"rules/{group}/{stem}.py: no rule named {stem}")
        rules[found.name] = found
    return rules


def _module(name: str, path: str) -> ModuleType:
    """The module in a file. That is known already: to look for each of so many takes as long as to load it."""
    if name in sys.modules:
        return sys.modules[name]
    spec = spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise RuleError(f"{path}: no Python module")
    module = sys.modules[name] = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _named(name: str) -> Rule:
    return load_all()[name]


def find(name: str, rules: dict[str, Rule]) -> list[Rule]:
    """
    The rules of a name or of a group (polar, feed, ...), in any case, with - or _.

    Raises UsageError with the nearest name for an unknown one.
    """
    wanted = name.strip().lower().replace("_", "-").rstrip("/")
    if wanted == "all":
        return list(rules.values())
    found = [rule for rule in rules.values() if wanted in (rule.name, rule.group)]
    if not found:
        known = [*rules, *{rule.group for rule in rules.values()}]
        near = suggestion(wanted, known) or "; `polarcheck rules` lists them"
        raise UsageError(f"unknown rule {name!r}{near}")
    return found
