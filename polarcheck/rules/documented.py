"""What has a function whose docstring is its manual page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec


class Documented(msgspec.Struct, frozen=True):
    """A function under the name by which reports and options know it."""

    name: str
    function: Callable[..., Any]

    @property
    def page(self) -> str:
        """The manual page: the docstring."""
        import inspect

        return inspect.getdoc(self.function) or ""

    @property
    def title(self) -> str:
        """The first line of the page, without the full stop."""
        return self.page.partition("\n")[0].rstrip(".")
