"""`python -m polarcheck`."""

from polarcheck.commands import run

run()
