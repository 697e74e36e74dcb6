"""`python -m polarcheck`."""

from polarcheck.cli import run

run()
