"""What is wrong in a macro statement, in words."""

from __future__ import annotations

_TEXTS = {
    "format": "this expression cannot be read",
    "statement-format": "this macro statement cannot be read",
    "missing-open-bracket": "an opening bracket [ is missing",
    "missing-close-bracket": "a closing bracket ] is missing",
    "missing-equal": "= is missing",
    "missing-comma": "a comma is missing",
    "if-format": "IF wants [condition] and then GOTO or THEN with one macro statement",
    "while-format": "WHILE wants [condition] and then DO 1, 2 or 3",
    "too-long": "too long to be read",
    "bracket-levels": "brackets are nested too deep",
    "mixed": "NC words and a macro statement in one block",
    "loop-number": "DO and END take the numbers 1, 2 and 3",
    "word-format": "an address without a number",
    "stray-character": "a character that means nothing here",
    "zero-divide": "division by zero",
    "overflow": "the result is too large",
    "integer-overflow": "too large for a whole number",
    "negative-square-root": "square root of a negative number",
    "arc-function-beyond-one": "ASIN or ACOS of a number beyond 1",
    "logarithm-not-positive": "LN of zero or a negative number",
    "argument-out-of-range": "the function does not take this value",
    "variable-number": "there is no variable of this number",
    "read-only": "this variable cannot be written",
    "argument-address": "this address cannot hand over an argument",
    "argument-sets": "more than ten sets of I J K",
    "program-number": "no program number in P",
}


def fault_text(kind: str, source: str) -> str:
    """The fault and the characters it is about."""
    shown = " ".join(source.split())[:40]
    return f"{_TEXTS[kind]}: {shown}" if shown else _TEXTS[kind]
