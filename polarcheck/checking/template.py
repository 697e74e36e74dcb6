"""Templates of messages: the names in braces and the values that they stand for."""

from __future__ import annotations

import string
from collections.abc import Callable
from typing import Any


class Template(string.Formatter):
    """Names in a template are looked up by a function, dots go to attributes."""

    def __init__(self, look_up: Callable[[str], Any]) -> None:
        self.look_up = look_up
        self.used: dict[str, Any] = {}

    def get_value(self, key: int | str, args: Any, kwargs: Any) -> Any:
        value = self.look_up(str(key))
        if hasattr(value, "data"):
            self.used[str(key)] = value.data
        elif isinstance(value, str | int | float):
            self.used[str(key)] = value
        return value
