"""Measures of the rules about the text."""

from __future__ import annotations

from polarcheck.columns.words.written import Written


def characters_counted(written: Written, index: int) -> int:
    """How many characters of the line are foreign."""
    return int(written.foreign_count[index])


def digits_written(written: Written, index: int) -> int:
    """How many digits a number has."""
    return int(written.long_number_digits[index])


def code_count(written: Written, index: int) -> int:
    """How often an unknown code stands in the file."""
    return int(written.unknown_code_count[index])
