"""
Mutations of a module: one small fault each, planted in the text by the syntax tree.

A comparison that takes in its edge or the other side, and for or, plus for minus, 0 for 1, a sign or a `not` dropped, a
severity for the next one, min for max, a statement left out. Not planted is what no program could show: annotations,
docstrings, the words of messages, what only type checkers read, how fast something is (caches, dtypes, buffers handed
over), one more of what a constant of the module says how many are looked at, and the last digit of a tolerance: no
number stands exactly on it.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

#: Other comparisons than the one that is written: its edge, and its opposite.
COMPARISONS = {
    "<": ("<=", ">="),
    "<=": ("<", ">"),
    ">": (">=", "<="),
    ">=": (">", "<"),
    "==": ("!=",),
    "!=": ("==",),
    "is": ("is not",),
    "is not": ("is",),
    "in": ("not in",),
    "not in": ("in",),
}
OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", "//": "*", "%": "*", "&": "|", "|": "&", "^": "&", "**": "*"}
#: By the name that is imported: the other one may not be.
SEVERITIES = {"ERROR": "ERROR.__class__.WARNING", "WARNING": "WARNING.__class__.NOTE", "NOTE": "NOTE.__class__.ERROR"}
ATTRIBUTES = {"inf": "nan", "CW": "CCW", "CCW": "CW"}
CALLS = {
    "min": "max",
    "minimum": "maximum",
    "fmin": "fmax",
    "argmin": "argmax",
    "nanmin": "nanmax",
    "any": "all",
    "floor": "ceil",
    "sin": "cos",
    "zeros": "ones",
    "append": "",
    "flatnonzero": "",
}
CALLS |= {new: old for old, new in CALLS.items() if new}
#: Of the arguments of graded(): each severity and the next lower one.
LEVELS = {"error": "warning", "warning": "note", "note": "error"}
#: A float below this is a tolerance.
TOLERANCE = 0.01
#: A whole number from here on says how much is done at once.
AT_ONCE = 50
_SYMBOLS = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
    ast.Is: "is",
    ast.IsNot: "is not",
    ast.In: "in",
    ast.NotIn: "not in",
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.FloorDiv: "//",
    ast.Mod: "%",
    ast.Pow: "**",
    ast.BitAnd: "&",
    ast.BitOr: "|",
    ast.BitXor: "^",
    ast.And: "and",
    ast.Or: "or",
}
#: Arguments that say how something is done, not what.
_MEANS = ("dtype", "copy", "out", "kind", "where", "quad_segs", "assume_unique")
_ROUNDING = ("round", "around", "isclose", "allclose")
_MESSAGES = ("RuleError", "UsageError", "ProfileError", "ValueError", "TypeError", "KeyError")


@dataclass(frozen=True)
class Mutation:
    """
    Bytes begin to end of a module replaced.

    line: where, from 1. row: that line of the source, stripped. nth: which of those alike in that line, from 1.
    """

    file: str
    line: int
    row: str
    begin: int
    end: int
    old: str
    new: str
    nth: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.line}  {self.old} -> {self.new or 'nothing'}   | {self.row}"

    def applied(self, source: bytes) -> bytes:
        """The module with this fault."""
        return source[: self.begin] + self.new.encode() + source[self.end :]


def mutations(source: bytes, file: str) -> list[Mutation]:
    """All mutations of a module, in the order of its text; source in UTF-8."""
    found = sorted(_Finder(source, file).of(ast.parse(source)), key=lambda one: (one.begin, one.end, one.new))
    alike = Counter[tuple[int, str, str]]()
    numbered = []
    for one in found:
        alike[one.line, one.old, one.new] += 1
        numbered.append(replace(one, nth=alike[one.line, one.old, one.new]))
    return numbered


def compiles(source: bytes) -> bool:
    """Whether a mutant is a module at all."""
    try:
        compile(source, "mutant", "exec", dont_inherit=True)
    except (SyntaxError, ValueError):
        return False
    return True


class _Finder:
    """Walks the tree of one module."""

    def __init__(self, source: bytes, file: str) -> None:
        self.source = source
        self.file = file
        self.rows = source.split(b"\n")
        self.body: list[ast.stmt] = []
        self.counts: set[str] = set()
        self.starts = [0]
        for row in self.rows:
            self.starts.append(self.starts[-1] + len(row) + 1)

    def of(self, node: ast.AST) -> Iterator[Mutation]:
        """The mutations of a node and of all in it."""
        if _is_about_types(node):
            return
        if isinstance(node, ast.Assign) and node in self.body and _is_number(node.value):
            return
        if isinstance(node, ast.Module):
            self.body = node.body
            self.counts = {name for one in node.body for name in _counts(one)}
        if isinstance(node, ast.Call) and _name(node.func) in (*_MESSAGES, *_ROUNDING):
            return
        yield from self._here(node)
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns", "bases", "type_params") or (name == "slice" and _is_type(node)):
                continue
            for child in value if isinstance(value, list) else [value]:
                if name == "decorator_list" and _name(child) != "rule":
                    continue
                if isinstance(child, ast.AST) and not _is_text(child):
                    yield from self.of(child)

    def _here(self, node: ast.AST) -> Iterator[Mutation]:
        match node:
            case ast.Compare():
                yield from self._comparisons(node)
            case ast.BoolOp():
                word = _SYMBOLS[type(node.op)]
                for left, right in zip(node.values, node.values[1:], strict=False):
                    yield from self._between(left, right, word, "or" if word == "and" else "and")
            case ast.BinOp() if (symbol := _SYMBOLS.get(type(node.op))) and not _has_text(node):
                yield from self._between(node.left, node.right, symbol, OPERATORS[symbol])
            case ast.AugAssign():
                yield self._dropped(node)
                symbol = _SYMBOLS[type(node.op)]
                yield from self._between(node.target, node.value, f"{symbol}=", f"{OPERATORS[symbol]}=")
            case ast.UnaryOp():
                begin = self._at(node.lineno, node.col_offset)
                yield self._replaced(begin, self._at(node.operand.lineno, node.operand.col_offset), "")
            case ast.Constant():
                yield from self._constant(node)
            case ast.Name() if node.id in SEVERITIES and isinstance(node.ctx, ast.Load):
                yield self._node(node, SEVERITIES[node.id])
            case ast.Attribute() if node.attr in ATTRIBUTES:
                end = self._at(node.end_lineno, node.end_col_offset)
                yield self._replaced(end - len(node.attr), end, ATTRIBUTES[node.attr])
            case ast.Call():
                yield from self._call(node)
            case ast.If() | ast.While() | ast.IfExp() if not isinstance(
                node.test, ast.Compare | ast.BoolOp | ast.UnaryOp
            ):
                text = self._text(node.test)
                yield self._node(node.test, f"(not ({text}))")
            case ast.Expr() if isinstance(node.value, ast.Call):
                yield self._dropped(node)
            case ast.Assign() if not isinstance(node.targets[0], ast.Name | ast.Tuple):
                yield self._dropped(node)
            case ast.Raise():
                yield self._dropped(node)
            case ast.Continue():
                yield self._node(node, "break")
            case ast.Break():
                yield self._node(node, "continue")

    def _comparisons(self, node: ast.Compare) -> Iterator[Mutation]:
        left = node.left
        for operator, right in zip(node.ops, node.comparators, strict=True):
            symbol = _SYMBOLS[type(operator)]
            edge = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}.get(symbol)
            for new in COMPARISONS[symbol]:
                if new == edge and (self._is_tolerance(left) or self._is_tolerance(right)):
                    continue
                yield from self._between(left, right, symbol, new)
            left = right

    def _constant(self, node: ast.Constant) -> Iterator[Mutation]:
        value = node.value
        if isinstance(value, bool):
            yield self._node(node, str(not value))
        elif isinstance(value, int) and value < AT_ONCE:
            yield self._node(node, {0: "1", 1: "0"}.get(value, str(value + 1)))
        elif isinstance(value, float) and (value == 0 or value >= TOLERANCE):
            yield self._node(node, {0.0: "1.0", 1.0: "0.0"}.get(value, str(value + 1)))

    def _call(self, node: ast.Call) -> Iterator[Mutation]:
        called = node.func
        name = _name(called)
        if new := CALLS.get(name):
            end = self._at(called.end_lineno, called.end_col_offset)
            yield self._replaced(end - len(name), end, new)
        if name == "graded":
            given = {keyword.arg for keyword in node.keywords}
            for keyword in node.keywords:
                if keyword.arg in LEVELS and LEVELS[keyword.arg] not in given:
                    begin = self._at(keyword.lineno, keyword.col_offset)
                    yield self._replaced(begin, begin + len(keyword.arg), LEVELS[keyword.arg])

    def _is_tolerance(self, node: ast.AST) -> bool:
        """A small number, a constant that is no count, or what is made of one; the limits of a machine are none."""
        if isinstance(node, ast.BinOp):
            return self._is_tolerance(node.left) or self._is_tolerance(node.right)
        if isinstance(node, ast.UnaryOp):
            return self._is_tolerance(node.operand)
        if isinstance(node, ast.Constant):
            return isinstance(node.value, float) and 0 < node.value < TOLERANCE
        name = _name(node)
        return "tolerance" in name or (re.fullmatch("_?[A-Z][A-Z_]+", name) is not None and name not in self.counts)

    def _dropped(self, node: ast.stmt) -> Mutation:
        return self._node(node, "pass")

    def _between(self, left: ast.AST, right: ast.AST, symbol: str, new: str) -> Iterator[Mutation]:
        """An operator: between two nodes stand besides it brackets, blanks and comments only."""
        begin = self._at(left.end_lineno, left.end_col_offset)  # type: ignore[attr-defined]
        end = self._at(right.lineno, right.col_offset)  # type: ignore[attr-defined]
        gap = re.sub(rb"#[^\n]*", lambda found: b" " * len(found[0]), self.source[begin:end])
        words = symbol.split()
        found = re.search(r"\s+".join(map(re.escape, words)).encode(), gap)
        if found:
            yield self._replaced(begin + found.start(), begin + found.end(), new)

    def _node(self, node: ast.expr | ast.stmt, new: str) -> Mutation:
        begin = self._at(node.lineno, node.col_offset)
        return self._replaced(begin, self._at(node.end_lineno, node.end_col_offset), new)

    def _text(self, node: ast.expr) -> str:
        begin = self._at(node.lineno, node.col_offset)
        return self.source[begin : self._at(node.end_lineno, node.end_col_offset)].decode()

    def _replaced(self, begin: int, end: int, new: str) -> Mutation:
        line = self.source.count(b"\n", 0, begin)
        row = self.rows[line].decode().strip()
        return Mutation(self.file, line + 1, row, begin, end, self.source[begin:end].decode(), new)

    def _at(self, line: int | None, column: int | None) -> int:
        assert line is not None
        assert column is not None
        return self.starts[line - 1] + column


def _name(node: ast.AST) -> str:
    """Of what is called or decorates, the last part."""
    if isinstance(node, ast.Call):
        return _name(node.func)
    return getattr(node, "attr", getattr(node, "id", ""))


def _is_about_types(node: ast.AST) -> bool:
    """What only type checkers read, or how something is done."""
    if isinstance(node, ast.If):
        return _name(node.test) == "TYPE_CHECKING"
    if isinstance(node, ast.Import | ast.ImportFrom | ast.Assert):
        return True
    return isinstance(node, ast.keyword) and node.arg in _MEANS


def _is_type(node: ast.AST) -> bool:
    """Whether brackets behind it are those of a type, as in NDArray[np.intp]."""
    return isinstance(node, ast.Subscript) and _name(node.value) in (
        "NDArray",
        "dict",
        "list",
        "tuple",
        "set",
        "Callable",
    )


def _is_number(node: ast.AST) -> bool:
    """A number from 2 on: how many, how far, how often something is looked at, of which one more shows nowhere."""
    return isinstance(node, ast.Constant) and isinstance(node.value, int | float) and node.value >= 2


def _is_text(node: ast.AST) -> bool:
    """A docstring, or text with values in it."""
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Constant)
    return isinstance(node, ast.JoinedStr)


def _has_text(node: ast.BinOp) -> bool:
    return any(
        isinstance(one, ast.JoinedStr) or (isinstance(one, ast.Constant) and isinstance(one.value, str))
        for one in (node.left, node.right)
    )


def _counts(node: ast.stmt) -> list[str]:
    """The names that a statement gives to whole numbers."""
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, int):
        return [_name(target) for target in node.targets]
    return []
