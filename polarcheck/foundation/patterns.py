"""Regular expressions of modules, each compiled when it is first used: a small check needs few of them."""

from __future__ import annotations

import re
from typing import Any, AnyStr, cast


class _Pattern:
    """A pattern that is compiled when one of its methods or attributes is first asked for."""

    def __init__(self, text: str | bytes, flags: int) -> None:
        self._arguments = text, flags

    def __getattr__(self, name: str) -> Any:
        value = getattr(re.compile(*self._arguments), name)  # type: ignore[type-var]  # a str or bytes
        setattr(self, name, value)
        return value


def lazy_pattern(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """Return what `re.compile` returns; functions of `re` do not take it."""
    return cast("re.Pattern[AnyStr]", _Pattern(text, flags))
