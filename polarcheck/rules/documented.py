"""What has a function whose docstring is its manual page."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import msgspec


@functools.cache  # each finding of a rule names the source that the page cites
def _page_of(function: Callable[..., Any]) -> str:
    import inspect

    return inspect.getdoc(function) or ""


class Documented(msgspec.Struct, frozen=True):
    """A function under the name by which reports and options know it."""

    name: str
    function: Callable[..., Any]

    @property
    def page(self) -> str:
        """The manual page: the docstring."""
        return _page_of(self.function)

    @property
    def title(self) -> str:
        """The first line of the page, without the full stop."""
        return self.page.partition("\n")[0].rstrip(".")
