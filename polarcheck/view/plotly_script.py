"""The JavaScript of plotly, the only part of it that a page needs."""

from __future__ import annotations

import importlib.util

from polarcheck.foundation.errors import UsageError

#: The name of the file beside the pages of many programs.
FILE_NAME = "plotly.min.js"


def require() -> None:
    """Raise UsageError if plotly is not installed."""
    if importlib.util.find_spec("plotly") is None:
        raise UsageError("pictures need plotly, of the extra [plot]: pip install plotly")


def library() -> str:
    """Return the JavaScript. Raises UsageError if plotly is not installed."""
    require()
    from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

    return str(get_plotlyjs())
