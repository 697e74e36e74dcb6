"""The one file of plotly that a page needs: its JavaScript."""

from __future__ import annotations

import importlib.util

from polarcheck.errors import UsageError

#: Under this name it lies beside many pages.
FILE_NAME = "plotly.min.js"


def require() -> None:
    """Raises UsageError where plotly is not installed."""
    if importlib.util.find_spec("plotly") is None:
        raise UsageError("pictures need plotly, of the extra [plot]: pip install plotly")


def library() -> str:
    """The JavaScript. Raises UsageError where plotly is not installed."""
    require()
    from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

    return str(get_plotlyjs())
