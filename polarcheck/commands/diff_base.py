"""`--diff-base`, `--with-callers`: restrict the check to programs that a change concerns."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from polarcheck.commands.options import option
from polarcheck.commands.output import say
from polarcheck.foundation.errors import UsageError

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Task
    from polarcheck.files.changes import LookedFor

diff_base = option(
    "--diff-base", metavar="REF",
    help="Only programs that have changed since this commit of git, or call or are judged by what has.",
)  # fmt: skip


with_callers = option(
    "--with-callers", "with_callers", is_flag=True,
    help="PATHs are changed files of any kind, as a hook names them: check the programs of this folder "
    "that have changed, or call or are judged by what has.",
)  # fmt: skip
#: Pre-commit sets it where it compares two commits: before the first of them files may have been there.
_FROM = "PRE_COMMIT_FROM_REF"


def changed_files(paths: Sequence[str], options: Mapping[str, object]) -> Sequence[str]:
    """
    Return the changed files of --with-callers; others: the options that exclude it.

    Raises UsageError for a folder, standard input, and a file outside of the current folder.
    """
    for name, value in options.items():
        if value:
            raise UsageError(f"--with-callers: not with {name}, which chooses programs, too")
    here = os.path.join(os.path.realpath(os.curdir), "")  # noqa: PTH118
    for path in paths:
        if path == "-" or os.path.isdir(path):  # noqa: PTH112
            raise UsageError(f"--with-callers: {path}: expected the names of changed files")
        folder = os.path.realpath(os.path.dirname(path) or os.curdir)  # noqa: PTH120
        if not os.path.join(folder, "").startswith(here):  # noqa: PTH118
            raise UsageError(f"--with-callers: {path}: lies outside of the current folder, whose programs are checked")
    return paths


def narrowed(
    tasks: list[Task],
    looked_for: LookedFor,
    ref: str | None,
    names: Sequence[str] | None,
    max_size: int,
    is_reported: bool,
) -> list[Task]:
    """
    Return the tasks of concerned programs.

    looked_for: returns the paths by which the job files of a program were looked for. ref: of --diff-base. names: the
    changed files of --with-callers. is_reported: write their number to standard error.
    """
    if ref is None and names is None:
        return tasks
    from polarcheck.files import changes

    if ref is not None:
        title, concerned = f"--diff-base {ref}", changes.since(ref, tasks, looked_for, max_size)
    else:
        title, before = "--with-callers", os.environ.get(_FROM, "HEAD")
        concerned = changes.by_files(names or (), tasks, looked_for, title, before, max_size)
    if is_reported:
        say(f"{title}: {_how_many(tasks, concerned)}")
    return concerned


def _how_many(tasks: Sequence[Task], concerned: Sequence[Task]) -> str:
    if not concerned:
        return f"nothing to check: none of {len(tasks)} programs has changed, nor calls or is judged by what has"
    return f"{len(concerned)} of {len(tasks)} programs to check: changed, or calling or judged by what has"
