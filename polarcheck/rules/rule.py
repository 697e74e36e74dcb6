"""The type of a rule, its result, and how rules are loaded. Rules are not registered: each file in rules/ is one."""

from __future__ import annotations

import functools
import marshal
import os
import re
import sys
from collections.abc import Callable, Mapping
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import MAGIC_NUMBER
from pathlib import Path
from threading import RLock
from types import CodeType, MappingProxyType, ModuleType
from typing import TYPE_CHECKING, Any, Final, Literal

import msgspec

from polarcheck.foundation.decoding import kept
from polarcheck.foundation.digest import blake2b
from polarcheck.foundation.errors import RuleError, UsageError, suggestion
from polarcheck.foundation.finding import ERROR as ERROR
from polarcheck.foundation.finding import NOTE as NOTE
from polarcheck.foundation.finding import SEVERITY_NAMES
from polarcheck.foundation.finding import WARNING as WARNING
from polarcheck.foundation.finding import Severity as Severity
from polarcheck.rules.causes import DOUBTFUL, SUBJECTS, UNIT, Doubt, subject_of
from polarcheck.rules.documented import Documented
from polarcheck.rules.tables import ARC as ARC
from polarcheck.rules.tables import C_ACCELERATION as C_ACCELERATION
from polarcheck.rules.tables import OF_CAUSE, OF_TEXT, SPANS, of_contours, only_with
from polarcheck.rules.tables import X_ACCELERATION as X_ACCELERATION
from polarcheck.rules.tables import parameters as parameters_of

if TYPE_CHECKING:
    from polarcheck.foundation.arrays import Floats, Mask, States

    #: What a value depends on: R, cutter diameter or nose type of the offset in force, a position, the rate of a move
    #: at its F, the travel of a move, or where X0 lies. checking/not_known.py says of each why it is not known.
    Need = Literal["radius", "diameter", "nose", "position", "rate", "travel", "origin"]
    Needs = tuple[Mask, dict[Need, Floats]]

FOLDER = Path(__file__).parent
#: Folders in it without rules.
_NO_GROUPS = "wording", "__pycache__"
#: Suffix of the module that fixes the findings of the rule with the same name.
REPAIR = "_repair"

#: The subject of a rule that is taken from the tables that it compares.
OF_TABLES: Final = "tables"
#: Kinds of elements that a mask can have (places.PLACES locates each).
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
    The result of a rule that returns more than a mask.

    mask: True where the rule fires; an element is what the rule is `over` (elements).
    severity: one value, or a column (elements); None for the default severity of the rule.
    at: the words at fault, where `at` of the rule cannot name them (executed words).
    values: values for the message, by name: a column (elements), or one value for all.
    follows: by span, the elements to which `follows` of the rule applies (elements); without an entry, all of them.
    undecided: hits that may be intended: they make the file unverified, not failed (elements).
    worst: the column whose highest value selects the hit to report, where one finding covers several (elements).
    """

    mask: Mask
    severity: Severity | States | None = None
    at: Mask | None = None
    values: Mapping[str, Any] = {}
    follows: Mapping[str, Mask] = {}
    undecided: Mask | None = None
    worst: Floats | None = None


def graded(
    *,
    error: Mask | None = None,
    warning: Mask | None = None,
    note: Mask | None = None,
    at: Mask | None = None,
    values: Mapping[str, Any] | None = None,
    follows: Mapping[str, Mask] | None = None,
    undecided: Mask | None = None,
    worst: Floats | None = None,
) -> Hits:
    """Combine masks of several severities into Hits; an element in more than one mask gets the highest severity."""
    import numpy as np

    given = [(level, mask) for level, mask in ((NOTE, note), (WARNING, warning), (ERROR, error)) if mask is not None]
    severity = np.zeros(len(given[0][1]), np.int16)
    for level, mask in given:
        severity[mask] = int(level)
    return Hits(severity > 0, severity, at, values or {}, follows or {}, undecided, worst)


class Rule(Documented, frozen=True):
    """
    One rule: its function and its attributes.

    group: the folder in rules/ that the rule is in.
    severity: the default severity.
    message: the template of the message (rules/message.py).
    over: the kind of element in the mask: rows, words, sections, ... (OVER).
    at: the words at fault: their addresses, the machine's lists of their codes (rapid, line), or "on" and "off" for the
    codes of the mode. The whole block is at fault if `at` is empty or the block has none of them.
    once: the span with one finding for all its hits (SPANS): a section, a program, an F word.
    subject: the quantity that the rule judges (causes.SUBJECTS), by default that of its tables; "" for words and
    states, which never become doubtful.
    doubts: the quantities that a finding makes doubtful, each with its span. Findings that rest on them are listed
    under this one.
    follows: by span, the rules that report the same fault first. This finding is then listed under theirs.
    values: the names of the values of a finding (rules/vocabulary.py), found as those of the message are.
    is_advice: the rule is off unless the machine or the user names a severity for it.
    worse: the values of the message that grow where the fault grows worse; behind a minus those of which less is worse,
    and with a colon between them two whose distance counts (position:limit).
    is_symptom: the finding says what goes wrong, and not which word is: checking/explanations.py searches that.
    gouges: the tool cuts where it must not, so that the fault grows with the depth and F of its blocks.
    only_with: what a program or its machine must have for the rule to find anything, beside what its tables need
    (Maker.only_with); elsewhere it is not run.
    parameters: the names of the tables that the function compares.
    companion: returns a function in the file of the rule by its name, None for none. Their parameters name tables.
    `details(hit, ...)` returns what message and values name beside Hits.values and properties of Hit (rules/hit.py).
    `needs(...)` returns where the rule judges, and columns by what they depend on (Need): the rule is not evaluated
    where one of them is not known.
    """

    severity: Severity
    message: str
    over: str = "rows"
    at: tuple[str, ...] = ()
    once: str = ""
    subject: str = OF_TABLES
    doubts: tuple[Doubt, ...] = ()
    follows: Mapping[str, tuple[str, ...]] = MappingProxyType({})
    values: tuple[str, ...] = ()
    is_advice: bool = False
    worse: tuple[str, ...] = ()
    is_symptom: bool = False
    gouges: bool = False
    group: str = ""
    only_with: tuple[str, ...] = ()
    parameters: tuple[str, ...] = ()
    companion: Callable[[str], Any] = MappingProxyType[str, Any]({}).get

    def __call__(self, function: Callable[..., Any]) -> Rule:
        """Return the rule of this function."""
        name, group = function.__name__.replace("_", "-"), function.__module__.split(".")[-2]
        if self.over not in OVER:
            raise RuleError(f"rule {name}: over={self.over!r}: expected one of {', '.join(OVER)}")
        spans = (*self.follows, *([self.once] if self.once else ()), *(at for _, at in self.doubts if at != UNIT))
        for span in spans:
            if span not in SPANS:
                raise RuleError(f"rule {name}: {span!r}: expected one of {', '.join(SPANS)}")
        for what, _ in self.doubts:
            if what not in DOUBTFUL:
                raise RuleError(f"rule {name}: {what!r}: expected one of {', '.join(sorted(DOUBTFUL))}")
        parameters = parameters_of(function)
        subject = subject_of(parameters) if self.subject == OF_TABLES else self.subject
        if subject and subject not in SUBJECTS:
            raise RuleError(f"rule {name}: {subject!r}: expected one of {', '.join(SUBJECTS)}")
        companion = getattr(function, "__globals__").get  # noqa: B009 - mypy knows it of no Callable
        return msgspec.structs.replace(
            self,
            name=name,
            function=function,
            group=group,
            subject=subject,
            only_with=(*only_with(parameters), *self.only_with),
            parameters=parameters,
            companion=companion,
        )

    def __reduce__(self) -> tuple[Callable[[str], Rule], tuple[str]]:
        """Pickle by name: the function cannot be pickled, since its name in the module refers to the rule."""
        return _rule_by_name, (self.name,)

    @property
    def of_text(self) -> bool:
        """True if the rule depends on the text only, not on how the program runs."""
        return OF_TEXT.issuperset(self.parameters)

    @property
    def of_contours(self) -> bool:
        """True if the rule judges contours as wholes, or the metal that they leave: one point says nothing of them."""
        return self.subject in ("side", "outline", "compensation", "metal", "infeed") or of_contours(self.parameters)

    def level(self, severities: Mapping[str, str]) -> str:
        """Return error, warning, note or off, by the severities that the machine and the job set per rule."""
        return severities.get(self.name) or ("off" if self.is_advice else SEVERITY_NAMES[self.severity])

    def hits(self, tables: Mapping[str, Any]) -> Hits:
        """Run the rule on these tables."""
        result = self.function(*map(tables.__getitem__, self.parameters))
        return result if isinstance(result, Hits) else Hits(result)

    def causes(self, rules: Mapping[str, Rule]) -> dict[str, list[str]]:
        """
        Return by span the names of the rules from which findings of this rule follow, the narrowest span first.

        An infeed cycle runs the whole contour of its section, so a doubt anywhere in the section counts.
        """
        causes = {span: [*names] for span, names in self.follows.items()}
        unit, rests_on = SUBJECTS.get(self.subject, ("", ()))
        for other in rules.values():
            for what, span in other.doubts:
                is_peer = other.subject == self.subject and span not in OF_CAUSE
                # The other rule follows this one, and not only one in a row above.
                is_named = any(self.name in names for at, names in other.follows.items() if at not in OF_CAUSE)
                if what in rests_on and not is_peer and not is_named:
                    reach = unit if span == UNIT or self.subject == "infeed" else span
                    causes.setdefault(reach, []).append(other.name)
        return {span: causes[span] for span in SPANS if span in causes}

    @property
    def source(self) -> str:
        """Return the source that the documentation of the rule cites."""
        return _source(self.page)


@functools.cache
def _source(page: str) -> str:
    match = re.search(r"^Source: (.*?)(?:\n\n|\Z)", page, re.MULTILINE | re.DOTALL)
    return " ".join(match[1].split()) if match else ""


#: Decorates a function as a rule, with attributes of Rule. Its parameters name the tables that it compares.
rule = functools.partial(Rule, "", parameters_of)


def rule_files() -> list[str]:
    """Return the paths of all rule files, sorted. They are strings, because sorting 135 Path objects takes 3 ms."""
    with os.scandir(FOLDER) as entries:
        groups = [group.path for group in entries if "." not in group.name and group.name not in _NO_GROUPS]
    paths = [file.path for group in groups for file in os.scandir(group)]
    other_files = "__init__.py", f"{REPAIR}.py"
    return sorted(path for path in paths if path.endswith(".py") and not path.endswith(other_files))


#: Two threads that load the rules at the same time would find modules that are not complete yet.
_LOADING = RLock()


@functools.cache
def load_all() -> dict[str, Rule]:
    """
    Load all rules; returns them by name, in order of group and name.

    Raises RuleError for a file in rules/ that defines no rule with the name of the file.
    """
    rules = {}
    with _LOADING:
        paths = rule_files()
        for path, code in zip(paths, _codes(paths), strict=True):
            group, stem = path.removesuffix(".py").split(os.sep)[-2:]  # noqa: PTH206
            loaded = getattr(_module(f"polarcheck.rules.{group}.{stem}", path, code), stem, None)
            if not isinstance(loaded, Rule):
                raise RuleError(f"rules/{group}/{stem}.py: no rule named {stem}")
            rules[loaded.name] = loaded
    return rules


def _codes(paths: list[str]) -> list[CodeType]:
    """Return the compiled files, kept in one: opening each takes longer than running it."""
    states = ((path, os.stat(path)) for path in paths)  # noqa: PTH116
    state = "".join(f"{path} {status.st_size} {status.st_mtime_ns}\n" for path, status in states)
    digest = blake2b(MAGIC_NUMBER + state.encode("utf-8", "surrogateescape"), digest_size=16).digest()
    return kept(Path(__file__), digest, lambda: [_compiled(path) for path in paths], marshal.dumps, marshal.loads)


def _compiled(path: str) -> CodeType:
    code = SourceFileLoader(path, path).get_code(path)
    assert code is not None
    return code


def _module(name: str, path: str, code: CodeType) -> ModuleType:
    """Run the compiled module of this file, without searching for it: the search takes as long as the loading."""
    if name in sys.modules:
        return sys.modules[name]
    loader = SourceFileLoader(name, path)
    module = sys.modules[name] = ModuleType(name)
    module.__file__, module.__loader__, module.__package__ = path, loader, name.rpartition(".")[0]
    module.__spec__ = ModuleSpec(name, loader, origin=path)
    exec(code, module.__dict__)  # noqa: S102  as the loader does
    return module


def _rule_by_name(name: str) -> Rule:
    return load_all()[name]


def find(name: str, rules: dict[str, Rule]) -> list[Rule]:
    """
    Return the rules of this name or group (polar, feed, ...). Case is ignored, and _ is read as -.

    Raises UsageError for an unknown name; the message suggests the nearest one.
    """
    wanted = name.strip().lower().replace("_", "-").rstrip("/")
    if wanted == "all":
        return list(rules.values())
    matches = [rule for rule in rules.values() if wanted in (rule.name, rule.group)]
    if not matches:
        known = [*rules, *{rule.group for rule in rules.values()}]
        near = suggestion(wanted, known) or "; `polarcheck rules` lists them"
        raise UsageError(f"unknown rule {name!r}{near}")
    return matches
