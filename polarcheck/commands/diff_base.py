"""`--diff-base`: of the programs that are named only those that a change concerns."""

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


def narrowed(tasks: list[Task], ref: str | None, most: int, is_told: bool) -> list[Task]:
    """The tasks that are left, and on standard error how many of how many those are."""
    if ref is None:
        return tasks
    from polarcheck.batch import changes

    found = changes.since(ref, tasks, most)
    if is_told:
        say(f"--diff-base {ref}: {_how_many(tasks, found)}")
    return found


def _how_many(tasks: Sequence[Task], found: Sequence[Task]) -> str:
    if not found:
        return f"nothing to check: none of {len(tasks)} programs has changed, nor calls or is judged by what has"
    return f"{len(found)} of {len(tasks)} programs to check: changed, or calling or judged by what has"
