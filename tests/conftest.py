"""`pytest --accept` takes the present reports and paths as the golden ones."""

from __future__ import annotations

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--accept", action="store_true", dest="update_snapshots", help="take the present outcomes as golden ones"
    )
