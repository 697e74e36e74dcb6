"""
What the server offers: a module per feature, each with a function `register`, which takes the server.

They import late what finds the answers: an editor waits for the answer to its first message, which needs none of it.
"""

from __future__ import annotations

import importlib
import pkgutil
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server


def register(server: Server) -> None:
    """Register all features as methods of the protocol; adding one is adding a module."""
    for module in pkgutil.iter_modules(__path__):
        importlib.import_module(f"{__name__}.{module.name}").register(server)
