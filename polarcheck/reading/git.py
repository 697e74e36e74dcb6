"""What git says of a working folder: which files differ from a commit. It is asked, and changes nothing."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable

from polarcheck.errors import UsageError, suggestion
from polarcheck.reading.files import RealPaths, shown

_MARK = ".git"
#: No monitor of the repository is run for the answer.
_CAREFULLY = ("-c", "core.fsmonitor=false", "-c", "core.untrackedCache=false")
#: A hook is told in which repository it runs; the programs may lie in another.
_OF_A_HOOK = ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX")
_LONGEST = 300


class Repositories:
    """The repository of a folder, each looked for once."""

    def __init__(self, real: RealPaths) -> None:
        self._real = real
        self._roots: dict[str, str | None] = {}

    def root(self, folder: str) -> str | None:
        """The real path of the folder that holds .git, at this one or above; None where there is none."""
        return self.root_above(self._real.folder(folder or os.curdir))

    def root_above(self, folder: str) -> str | None:
        """The same for an absolute path, as it is written."""
        passed: list[str] = []
        here = folder
        while here not in self._roots:
            passed.append(here)
            outer = os.path.dirname(here)  # noqa: PTH120  long paths of pathlib are slow
            if os.path.lexists(os.path.join(here, _MARK)):  # noqa: PTH118
                self._roots[here] = here
            elif outer == here:
                self._roots[here] = None
            else:
                here = outer
        found = self._roots[here]
        self._roots.update(dict.fromkeys(passed, found))
        return found


def changed(root: str, ref: str) -> set[str]:
    """
    The files of a repository that differ from where its branch has left a commit, by absolute path: committed since,
    staged or not, renamed (both names), deleted, and all that git does not keep, of which it cannot tell.

    Raises UsageError, with the name of the option, where git is missing or has no such commit.
    """
    base = _base(root, ref)
    compared = ("--name-only", "--no-renames", "--no-ext-diff", "--no-textconv", "--no-color", "-z")
    differing = _asked(root, ref, "diff", *compared, base, "--")
    unknown = _asked(root, ref, "ls-files", "--others", "-z")
    names = [os.fsdecode(name) for name in (differing + unknown).split(b"\0") if name]
    return {os.path.normcase(os.path.join(root, *name.split("/"))) for name in names}  # noqa: PTH118


def _base(root: str, ref: str) -> str:
    """Where the branch has left the commit, so that what others have changed there since is none of its changes."""
    if not ref.strip() or ref.startswith("-"):
        raise UsageError(f"--diff-base {ref!r}: expected a commit, a branch or a tag, such as main")
    status, found, _ = _git(root, ref, "rev-parse", "--verify", "--quiet", f"{ref}^{{commit}}")
    if status:
        raise UsageError(f"--diff-base {ref}: {_missing(root, ref)}")
    commit = found.decode("ascii").strip()
    status, found, _ = _git(root, ref, "merge-base", commit, "HEAD")
    # Without a common one, as in a shallow clone, all differences to the commit itself count: more, and none too few.
    return commit if status else found.decode("ascii").strip()


def _missing(root: str, ref: str) -> str:
    if _asked(root, ref, "rev-parse", "--is-shallow-repository").strip() == b"true":
        return "the clone is shallow and has no such commit: fetch it (git fetch --unshallow; CI: depth 0)"
    names = _asked(root, ref, "for-each-ref", "--format=%(refname:short)").decode("utf-8", "replace").split("\n")
    return f"git knows no such commit in {shown(root)}{suggestion(ref, filter(None, names))}"


def _asked(root: str, ref: str, *words: str) -> bytes:
    status, found, said = _git(root, ref, *words)
    if status:
        lines = said.decode("utf-8", "replace").strip().split("\n")
        raise UsageError(f"--diff-base {ref}: git {words[0]}: {lines[0].removeprefix('fatal: ')[:_LONGEST]}")
    return found


def _git(root: str, ref: str, *words: str) -> tuple[int, bytes, bytes]:
    """Status, output and messages of a command of git."""
    import subprocess

    program = _program(os.get_exec_path())
    if program is None:
        raise UsageError(f"--diff-base {ref}: git is not installed, or not on the PATH")
    environment = {key: value for key, value in os.environ.items() if key not in _OF_A_HOOK}
    environment |= {"GIT_OPTIONAL_LOCKS": "0", "GIT_TERMINAL_PROMPT": "0", "LC_ALL": "C"}
    try:
        done = subprocess.run(  # noqa: S603  a list of words, none of which git can take for an option
            [program, "-C", root, *_CAREFULLY, *words],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            env=environment,
            check=False,
        )
    except OSError as error:
        raise UsageError(f"--diff-base {ref}: git: {error.strerror or error}") from None
    return done.returncode, done.stdout, done.stderr


def _program(folders: Iterable[str]) -> str | None:
    """git of the PATH; never one that lies in the folder that is checked, where Windows would look first."""
    name = "git.exe" if sys.platform == "win32" else "git"
    for folder in folders:
        path = os.path.join(folder, name)  # noqa: PTH118
        if os.path.isabs(folder) and os.path.isfile(path) and os.access(path, os.X_OK):  # noqa: PTH113, PTH117
            return path
    return None
