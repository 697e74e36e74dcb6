"""
Every regular expression of the package, and how its cost grows on the texts that are hardest for it.

The texts are made from the parts of a pattern: what its first parts match, then one or two characters repeated, then a
character that no part takes.
"""

from __future__ import annotations

import ast
import importlib
import itertools
import re
import sys
import time
from collections import deque
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from polarcheck.foundation import patterns

PACKAGE = Path(__file__).parent.parent / "polarcheck"
#: Methods that begin at one place; all others try every place of a text.
ANCHORED = {"match", "fullmatch"}
#: Functions of `re` that take a pattern.
_TAKES_PATTERN = {"compile", "search", "match", "fullmatch", "split", "findall", "finditer", "sub", "subn"}

AnyPattern = re.Pattern[str] | re.Pattern[bytes]


class Used(NamedTuple):
    """A pattern, the module and line that it stands in, and the methods that are called on it."""

    pattern: AnyPattern
    place: str
    methods: frozenset[str]


class Site(NamedTuple):
    """A call of a function of `re` in a module."""

    module: str
    function: str
    call: ast.Call

    @property
    def place(self) -> str:
        return f"{self.module}:{self.call.lineno}"

    def spans(self, line: int) -> bool:
        """Whether the call stands in this line, or goes over it."""
        return self.call.lineno <= line <= (self.call.end_lineno or self.call.lineno)


def sites() -> list[Site]:
    """Every call of the package that makes or uses a pattern by the module `re`."""
    hits = []
    for path in sorted(PACKAGE.rglob("*.py")):
        name = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            if isinstance(node.func, ast.Name) and node.func.id == "lazy_pattern":
                hits.append(Site(name, "compile", node))
            elif (
                isinstance(node.func, ast.Attribute)
                and isinstance(node.func.value, ast.Name)
                and node.func.value.id == "re"
                and node.func.attr in _TAKES_PATTERN
                and name != patterns.__name__
            ):
                hits.append(Site(name, node.func.attr, node))
    return hits


def constant_patterns() -> tuple[list[Used], list[Site]]:
    """The patterns that the constants of their modules settle, and the calls whose patterns are built at run time."""
    used, built = [], []
    for site in sites():
        module = importlib.import_module(site.module)
        try:
            pattern = _evaluated(site, module)
        except NameError:
            built.append(site)
            continue
        methods = {site.function} if site.function != "compile" else _methods(module, pattern)
        used.append(Used(pattern, site.place, frozenset(methods)))
    return used, built


def _evaluated(site: Site, module: ModuleType) -> AnyPattern:
    """The pattern of a call, from the constants of its module."""
    position = {"compile": 1, "sub": 4, "subn": 4, "split": 3}.get(site.function, 2)
    flags = [word.value for word in site.call.keywords if word.arg == "flags"] + site.call.args[position : position + 1]
    source = ast.Call(site.call.func, [site.call.args[0], *flags], [])
    source.func = ast.Attribute(ast.Name("re", ast.Load()), "compile", ast.Load())
    expression = ast.fix_missing_locations(ast.Expression(source))
    return eval(compile(expression, site.place, "eval"), {"re": re} | vars(module))  # type: ignore[no-any-return]  # noqa: S307


def _methods(module: ModuleType, pattern: AnyPattern) -> set[str]:
    """The methods called on a constant of a module; all of them where it is used in another way."""
    # Not by identity: `re` forgets patterns that it has compiled, and makes equal ones again.
    names = {name for name, value in constants(module).items() if value == pattern}
    tree = ast.parse(Path(module.__file__ or "").read_text("utf-8"))
    loads = [node for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)]
    of_name = [node for node in loads if node.id in names]
    uses = [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in names
    ]
    if of_name and len(uses) == len(of_name):
        return {node.attr for node in uses}
    return methods_of_others(module.__name__)


def constants(module: ModuleType) -> dict[str, AnyPattern]:
    """The patterns of a module by their names, compiled or not."""
    values = {name: value for name, value in vars(module).items() if isinstance(value, re.Pattern)}
    lazy = {name: value for name, value in vars(module).items() if isinstance(value, patterns._Pattern)}
    return values | {name: re.compile(*value._arguments) for name, value in lazy.items()}  # type: ignore[arg-type]


def methods_of_others(module_name: str) -> set[str]:
    """The methods that a module calls on patterns that are no constants of it: on parts of a tuple, on local names."""
    module = importlib.import_module(module_name)
    tree = ast.parse(Path(module.__file__ or "").read_text("utf-8"))
    known = constants(module).keys() | {"re"}
    called = {
        node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and not (isinstance(node.value, ast.Name) and node.value.id in known)
    }
    return called & (_TAKES_PATTERN - {"compile", "split"}) or {"search", "fullmatch"}


class Built(NamedTuple):
    """A pattern that was compiled at run time, and the line of the package that asked for it."""

    pattern: AnyPattern
    module: str
    line: int


def recorded(call: Callable[[], object]) -> list[Built]:
    """The patterns that the package compiles, or finds compiled, during a call."""
    hits: list[Built] = []
    compile_pattern = re._compile  # type: ignore[attr-defined]

    def record(pattern: Any, flags: Any) -> AnyPattern:
        compiled: AnyPattern = compile_pattern(pattern, flags)
        caller = sys._getframe(2)
        hits.append(Built(compiled, caller.f_globals.get("__name__", ""), caller.f_lineno))
        return compiled

    re._compile = record  # type: ignore[attr-defined]
    try:
        call()
    finally:
        re._compile = compile_pattern  # type: ignore[attr-defined]
    return hits


_MARKS = " \t\n\r\0!\"#$%&'()*+,-./:;<=>?@[\\]^_`{|}~\x96\xa0\xd8\xe9\x01"
_CANDIDATES = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz" + _MARKS
#: So many kinds of characters are told apart in one pattern, and so many texts are taken for one part of it.
_KINDS, _SAMPLES = 4, 3
#: More repeats than this are as many as there may be.
_ENDLESS = 64


def _children(argument: Any) -> Iterator[Any]:
    """The patterns within an argument of an operation."""
    if isinstance(argument, re._parser.SubPattern):  # type: ignore[attr-defined]
        yield argument
    elif isinstance(argument, tuple | list):
        for part in argument:
            yield from _children(part)


def _repeats(tree: Any) -> bool:
    """Whether some part of a pattern is repeated without end, or so often that it may as well be."""
    return any(
        (str(operation).endswith("REPEAT") and argument[1] > _ENDLESS) or any(map(_repeats, _children(argument)))
        for operation, argument in tree
    )


class Parts:
    """
    A pattern taken apart.

    alphabet: one character for each set of classes that it is in; repeated: those of them that repeated parts match;
    other: one that no part matches.
    """

    def __init__(self, pattern: AnyPattern) -> None:
        self._is_text = isinstance(pattern.pattern, str)
        self._flags = pattern.flags & (re.IGNORECASE | re.ASCII | re.UNICODE | re.DOTALL)
        self.tree = re._parser.parse(pattern.pattern, pattern.flags & ~re.DEBUG)  # type: ignore[attr-defined]
        self._atoms: dict[str, AnyPattern] = {}
        self._repeated: set[str] = set()
        self._collect(self.tree, False)
        kinds: dict[tuple[bool, ...], str] = {}
        for one in _CANDIDATES:
            kinds.setdefault(tuple(bool(atom.match(self._encoded(one))) for atom in self._atoms.values()), one)
        self.other = kinds.pop((False,) * len(self._atoms), "\x01")
        self.alphabet = [one for kind, one in sorted(kinds.items(), key=lambda item: -sum(item[0]))]
        repeated = [self._atoms[key] for key in self._repeated]
        self.repeated = [one for one in self.alphabet if any(atom.match(self._encoded(one)) for atom in repeated)]

    def _encoded(self, text: str) -> Any:
        return text if self._is_text else text.encode("latin-1")

    def _collect(self, tree: Any, is_repeated: bool) -> None:
        for operation, argument in tree:
            if self._is_atom(str(operation)):
                self._atom(operation, argument)
                self._repeated |= {f"{operation} {argument}"} if is_repeated else set()
            is_endless = str(operation).endswith("REPEAT") and argument[1] > _ENDLESS
            for child in _children(argument):
                self._collect(child, is_repeated or is_endless)

    @staticmethod
    def _is_atom(operation: str) -> bool:
        return operation in ("LITERAL", "NOT_LITERAL", "IN", "ANY")

    def _atom(self, operation: Any, argument: Any) -> AnyPattern:
        """A pattern of one character."""
        key = f"{operation} {argument}"
        if key not in self._atoms:
            tree = re._parser.parse(self._encoded(""), self._flags)  # type: ignore[attr-defined]
            tree.append((operation, argument))
            self._atoms[key] = re._compiler.compile(tree, self._flags)  # type: ignore[attr-defined]
        return self._atoms[key]

    def samples(self, tree: Any) -> list[str]:
        """Texts that a part matches, in most cases; the shortest, and with each repeat once."""
        texts = [""]
        for operation, argument in tree:
            texts = [a + b for a in texts for b in self._of_part(str(operation), operation, argument)][:_SAMPLES]
        return texts

    def _of_part(self, name: str, operation: Any, argument: Any) -> list[str]:
        if self._is_atom(name):
            atom = self._atom(operation, argument)
            return [one for one in (*self.alphabet, *_CANDIDATES) if atom.match(self._encoded(one))][:_SAMPLES] or [""]
        if name == "BRANCH":
            return [text for branch in argument[1] for text in self.samples(branch)[:1]][: 2 * _SAMPLES]
        if name.endswith("REPEAT"):
            return [text * max(1, min(argument[0], 8)) for text in self.samples(argument[2])]
        if name in ("ASSERT", "ASSERT_NOT", "AT", "GROUPREF"):
            return [""]
        inner = list(_children(argument))
        return self.samples(inner[-1]) if inner else [""]

    def beginnings(self, tree: Any | None = None) -> Iterator[str]:
        """What the first parts match, for each number of parts, of those within groups and repeats too."""
        before = [""]
        for operation, argument in self.tree if tree is None else tree:
            for child in filter(_repeats, _children(argument)):
                yield from (before[0] + text for text in self.beginnings(child))
            before = [a + b for a in before for b in self._of_part(str(operation), operation, argument)][:_SAMPLES]
            yield from before


#: Of a pattern with more cases, as one of many words of a language, every second or third is tried.
_CASES = 1500


class Case(NamedTuple):
    """Texts of any length: a beginning, what is repeated behind it, and an end."""

    begin: str
    pump: str
    end: str

    def text(self, size: int, is_text: bool) -> Any:
        text = self.begin + self.pump * size + self.end
        return text if is_text else text.encode("latin-1")


def hostile_cases(pattern: AnyPattern) -> list[Case]:
    parts = Parts(pattern)
    first = list(dict.fromkeys(filter(None, parts.beginnings())))
    few = parts.repeated[:_KINDS]
    few += [a + b for a, b in itertools.permutations(few, 2)]
    pumps = [*parts.repeated, *first, *few, *(text + one for text in first for one in few)]
    cases = [("", pump) for pump in pumps] + [(begin, one) for begin in first for one in parts.repeated]
    cases = list(dict.fromkeys(cases))
    chosen = cases[:: len(cases) // _CASES + 1]
    return [Case(begin, pump, end) for begin, pump in chosen for end in ("", parts.other)]


#: Work that grows with the text takes 16 times as long for 16 times the text; n**1.3 is the most that passes.
FACTOR, _POWER = 16, 1.3
MOST = FACTOR**_POWER
#: More than the cube of the text: twice the text might not end.
_BEYOND = FACTOR**3
#: Repeats of a pump, from few, where an exponential pattern still ends, to many, where a quadratic one shows.
SIZES = (3, 6, 12, 24, 48, 96, 192, 768)
#: Shorter times say nothing [s]. A linear pattern takes that at the largest sizes only.
_TELLING = 1e-4
_FEW = 24


def growth(pattern: AnyPattern, method: str, case: Case) -> float:
    """
    How many times more work 16 times the text is, at the first size where that is too much; 0 where it never is.

    It must be too much for twice that text as well: a limit such as {1000,} is reached at one size.
    """

    def took(size: int, repeats: int = 5) -> float:
        return _seconds(pattern, method, case.text(size, isinstance(pattern.pattern, str)), repeats)

    once: dict[int, float] = {}
    for size in SIZES:
        once[size] = now = took(size, 1)
        if now < _TELLING or now < MOST * once.get(size // FACTOR, 0.0):
            continue
        ratio = took(size, 3) / took(size // FACTOR)
        if ratio > MOST and (size <= _FEW or ratio > _BEYOND or took(2 * size, 3) / took(size) > 2**_POWER):
            return ratio
    return 0.0


#: What a thread takes alone, where that is told finely: other processes may take any share of a machine.
_clock = time.thread_time if time.get_clock_info("thread_time").resolution < 1e-5 else time.perf_counter


def _seconds(pattern: AnyPattern, method: str, text: Any, repeats: int) -> float:
    """The shortest time of several uses of a pattern; one that replaces or splits searches on behind each match."""
    times = []
    for _ in range(repeats):
        begin = _clock()
        if method in ANCHORED:
            getattr(pattern, method)(text)
        else:
            deque(pattern.finditer(text), 0)
        times.append(_clock() - begin)
    return max(min(times), 1e-7)


def worst(pattern: AnyPattern, methods: Collection[str]) -> str:
    """The first case that costs more than its length, in words; empty where none does."""
    kinds = {method if method in ANCHORED else "finditer" for method in methods}
    for case in hostile_cases(pattern):
        for method in sorted(kinds):
            ratio = growth(pattern, method, case)
            # On a busy machine one measurement may say anything.
            if ratio and all(growth(pattern, method, case) for _ in range(3)):
                return f"{method} of {case}: {ratio:.1f} times the work for {FACTOR} times the text"
    return ""
