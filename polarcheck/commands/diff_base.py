"""`--diff-base`: restricts the check to programs that a change in git concerns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from polarcheck.commands.options import option
from polarcheck.commands.output import say

if TYPE_CHECKING:
    from polarcheck.batch.tasks import Task

diff_base = option(
    "--diff-base", metavar="REF",
    help="Only programs that have changed since this commit of git, or call or are judged by what has.",
)  # fmt: skip


def narrowed(tasks: list[Task], ref: str | None, max_size: int, is_reported: bool) -> list[Task]:
    """Return the tasks of concerned programs; is_reported: write their number to standard error."""
    if ref is None:
        return tasks
    from polarcheck.batch import changes

    concerned = changes.since(ref, tasks, max_size)
    if is_reported:
        say(f"--diff-base {ref}: {_how_many(tasks, concerned)}")
    return concerned


def _how_many(tasks: Sequence[Task], concerned: Sequence[Task]) -> str:
    if not concerned:
        return f"nothing to check: none of {len(tasks)} programs has changed, nor calls or is judged by what has"
    return f"{len(concerned)} of {len(tasks)} programs to check: changed, or calling or judged by what has"
