"""Files of a working folder that differ from a commit, by git; nothing is changed."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from polarcheck.foundation.errors import UsageError, suggestion
from polarcheck.program.reading.files import RealPaths, display_path

if TYPE_CHECKING:
    import subprocess

_MARK = ".git"
#: The mode of a submodule in a tree or the index.
_SUBMODULE = "160000"
#: Submodules in submodules; of what lies deeper nothing is known.
_MOST_NESTED = 8
#: Options of every call: no hook and no monitor that the repository names is run.
_SAFE = (
    "--no-pager",
    "-c",
    "core.hooksPath=/dev/null",
    "-c",
    "core.fsmonitor=false",
    "-c",
    "core.untrackedCache=false",
)
#: Git sets these for its hooks (git rev-parse --local-env-vars); the programs may lie in another repository.
_OF_A_HOOK = frozenset(
    {
        "GIT_ALTERNATE_OBJECT_DIRECTORIES",
        "GIT_COMMON_DIR",
        "GIT_DIR",
        "GIT_GRAFT_FILE",
        "GIT_IMPLICIT_WORK_TREE",
        "GIT_INDEX_FILE",
        "GIT_NAMESPACE",
        "GIT_OBJECT_DIRECTORY",
        "GIT_PREFIX",
        "GIT_REPLACE_REF_BASE",
        "GIT_SHALLOW_FILE",
        "GIT_WORK_TREE",
    }
)
#: GIT_NO_LAZY_FETCH came with git 2.45; before that a fetch is started, and no protocol is allowed to it.
_ENVIRONMENT = {
    "GIT_ALLOW_PROTOCOL": "",
    "GIT_NO_LAZY_FETCH": "1",
    "GIT_OPTIONAL_LOCKS": "0",
    "GIT_TERMINAL_PROMPT": "0",
    "LC_ALL": "C",
}
#: A call of git that takes longer is ended [s].
TIME_LIMIT = 60.0
#: How long the pipes of a killed git are read for what it still wrote [s].
_AFTER_KILL = 1.0
_LONGEST = 300
#: How git 2.39 and git 2.45 say that an object is missing and was not fetched.
_NOT_FETCHED = ("promisor remote", "lazy fetching disabled")


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
        text = self._roots[here]
        self._roots.update(dict.fromkeys(passed, text))
        return text


class Reference(NamedTuple):
    """
    A commit that an option names.

    option: the option.
    name: of the commit, a branch or a tag.
    """

    option: str
    name: str

    def __str__(self) -> str:
        return f"{self.option} {self.name}"


class Difference(NamedTuple):
    """
    What differs from a commit, by absolute path; a submodule of which no more is known stands for all below it.

    paths: files, links and submodules, those that are gone included.
    former: the content that the commit holds of files, where git names it: a repository and a name in it.
    repositories: the folders that were compared: the repository, and its submodules.
    """

    paths: set[str]
    former: dict[str, tuple[str, str]]
    repositories: set[str]

    def add(self, inner: Difference) -> None:
        """Add what differs in another folder."""
        self.paths.update(inner.paths)
        self.former.update(inner.former)
        self.repositories.update(inner.repositories)


def none() -> Difference:
    """Return no difference, to which others are added."""
    return Difference(set(), {}, set())


def changed(root: str, name: str, separate: Collection[str] = ()) -> Difference:
    """
    Return how a repository differs from the point where its branch left a commit: committed since, staged or not,
    renamed (both names), deleted, and all whose changes git does not follow; its submodules, too.

    separate: repositories below it that are asked themselves.

    Runs no program that the repository names, opens no connection, and writes nothing. Raises UsageError, which names
    the option, where git is missing, cannot answer, or has no such commit.
    """
    ref = Reference("--diff-base", name)
    _require_top_level(root, ref)
    return _Comparison(root, ref, separate).with_commit(_base(root, ref))


def staged(root: str, ref: Reference) -> Difference:
    """
    Return how the next commit differs from the point where the branch left a commit; of submodules what lies there.

    There is no difference where there is no such commit yet. Raises UsageError, which names the option, where git is
    missing or cannot answer.
    """
    if not ref.name.strip() or ref.name.startswith("-"):
        return none()
    status, _, _ = _git(root, ref, "rev-parse", "--verify", "--quiet", f"{ref.name}^{{commit}}")
    return none() if status else _Comparison(root, ref).with_commit(_base(root, ref), of_index=True)


def holds_submodule(root: str, inner: str, ref: Reference) -> bool:
    """Return True if a repository is a submodule of another one around it, or lies within one."""
    return any(f"{inner}{os.sep}".startswith(f"{_path(root, name)}{os.sep}") for name in _submodules(root, ref))


def tracked(root: str, ref: Reference) -> set[str]:
    """Return the files that the next commit holds, by absolute path, those of submodules too. Raises UsageError."""
    paths: set[str] = set()
    todo = [(root, 0)]
    while todo:
        here, depth = todo.pop()
        paths.update(_path(here, name) for name in _parts(_output(here, ref, "ls-files", "-z", "--cached")))
        inner = [_path(here, name) for name in _submodules(here, ref)]
        todo += [(path, depth + 1) for path in inner if depth < _MOST_NESTED and _is_repository(path, ref)]
    return paths


class _Comparison:
    """Compares a repository and its submodules with a commit. depth: of a submodule in others."""

    def __init__(self, root: str, ref: Reference, separate: Collection[str] = (), depth: int = 0) -> None:
        self._root, self._ref, self._separate, self._depth = root, ref, separate, depth

    def with_commit(self, base: str, *, of_index: bool = False) -> Difference:
        """Return the difference. of_index: files of this repository count as they stand in the next commit."""
        # The index against the commit, then the files against the index. `git diff` would do both at once, but writes
        # the index where only the time of a file differs, with GIT_OPTIONAL_LOCKS=0 too.
        compared = ("--cached", "--raw", "-z", "--no-renames", "--ignore-submodules=none", base, "--")
        raw = _parts(_output(self._root, self._ref, "diff-index", *compared))
        staged = dict(zip(raw[1::2], (entry.removeprefix(":").split(" ") for entry in raw[::2]), strict=True))
        untracked = () if of_index else ("--others",)
        entries = _entries(_output(self._root, self._ref, "ls-files", "-z", "-v", "--stage", "--cached", *untracked))
        names = set(staged)
        former = {name: entry.content for name, entry in entries.items()}
        former |= {name: fields[2] for name, fields in staged.items()}  # zeros where there was none
        if not of_index:
            names |= {*_unfollowed(self._root, entries), *self._unstaged()}
        difference = none()
        difference.repositories.add(os.path.normcase(self._root))
        for name in [name for name, entry in entries.items() if entry.mode == _SUBMODULE]:
            fields = staged.get(name)
            inner = self._inside(name, former[name], is_new=fields is not None and fields[0] != _SUBMODULE)
            if inner is None:
                names.add(name)
                difference.repositories.add(_path(self._root, name))
            else:
                names.discard(name)
                difference.add(inner)
        for name in names:
            path = _path(self._root, name)
            if path not in self._separate or path in difference.repositories:
                difference.paths.add(path)
                if name in former:
                    difference.former[path] = self._root, former[name]
        return difference

    def _unstaged(self) -> list[str]:
        compared = ("--porcelain=v1", "--untracked-files=no", "-z", "--no-renames", "--ignore-submodules=all")
        filters = _without_filters(self._root, self._ref)
        return [entry[3:] for entry in _parts(_output(self._root, self._ref, "status", *compared, options=filters))]

    def _inside(self, name: str, base: str, *, is_new: bool) -> Difference | None:
        """
        Return how the content of a submodule differs from a commit of it; None if that is not known.

        is_new: the submodule was not there.
        """
        path = _path(self._root, name)
        if is_new or self._depth >= _MOST_NESTED or os.path.islink(path):  # noqa: PTH114
            return None
        if not os.path.lexists(os.path.join(path, _MARK)):  # noqa: PTH118
            # Git leaves the folder of a submodule empty that was never fetched.
            return none() if os.path.isdir(path) and not os.listdir(path) else None  # noqa: PTH112, PTH208
        try:
            if not _is_repository(path, self._ref):
                return None
            status, _, _ = _git(path, self._ref, "rev-parse", "--verify", "--quiet", f"{base}^{{commit}}")
            return None if status else _Comparison(path, self._ref, self._separate, self._depth + 1).with_commit(base)
        except UsageError:
            return None


class _Entry(NamedTuple):
    """A file of the index, or an untracked one, as `git ls-files -v` lists it: tag, mode, and name of its content."""

    tag: str
    mode: str = ""
    content: str = ""


def _entries(output: bytes) -> dict[str, _Entry]:
    entries = {}
    for part in _parts(output):
        if part[0] == "?":
            entries[part[2:]] = _Entry(part[0])
        else:
            fields, _, name = part[2:].partition("\t")
            mode, content, _ = fields.split(" ")
            entries[name] = _Entry(part[0], mode, content)
    return entries


def _submodules(root: str, ref: Reference) -> list[str]:
    entries = _entries(_output(root, ref, "ls-files", "-z", "-v", "--stage", "--cached"))
    return [name for name, entry in entries.items() if entry.mode == _SUBMODULE]


def _is_repository(folder: str, ref: Reference) -> bool:
    """Return True for the top folder of a repository that git reads."""
    try:
        _require_top_level(folder, ref)
    except UsageError:
        return False
    return True


def content(root: str, name: str, ref: Reference) -> bytes | None:
    """Return a content that git names in a repository, as it is kept there; None if it is not there."""
    status, output, _ = _git(root, ref, "cat-file", "blob", name)
    return None if status else output


def _path(root: str, name: str) -> str:
    """Return the absolute path of a name of git; an untracked repository has a slash at its end."""
    return os.path.normcase(os.path.join(root, *name.rstrip("/").split("/")))  # noqa: PTH118


def _parts(output: bytes) -> list[str]:
    return [os.fsdecode(part) for part in output.split(b"\0") if part]


def _unfollowed(root: str, entries: Mapping[str, _Entry]) -> list[str]:
    """Return the files in which git looks for no changes: untracked, assumed unchanged, or skipped but present."""
    return [
        name
        for name, entry in entries.items()
        if entry.tag == "?" or entry.tag.islower() or (entry.tag == "S" and os.path.lexists(os.path.join(root, name)))  # noqa: PTH118
    ]


def _require_top_level(root: str, ref: Reference) -> None:
    """Raise UsageError where git takes another folder for the top of the work tree: names would mean other files."""
    top = os.fsdecode(_output(root, ref, "rev-parse", "--show-toplevel")).rstrip("\r\n")
    try:
        is_same = os.path.samefile(top, root)  # noqa: PTH121
    except OSError:
        is_same = False
    if not is_same:
        raise UsageError(f"{ref}: {display_path(root)}: its .git belongs to the work tree {display_path(top)}")


def _without_filters(root: str, ref: Reference) -> list[str]:
    """
    Options that empty every filter of the configuration, since `git status` runs the clean filter of a changed file.

    A file that has to be compared again then counts as changed: too many files are harmless, too few are not.
    """
    status, output, said = _git(root, ref, "config", "--null", "--name-only", "--get-regexp", r"^filter\.")
    if status > 1:  # 1: no filter
        raise _refusal(ref, "config", said)
    options: list[str] = []
    for name in dict.fromkeys(key.rpartition(".")[0] for key in _parts(output)):
        if "=" in name:  # git -c would take what stands before it for the key
            raise UsageError(f"{ref}: {display_path(root)}: rename {name} in the configuration of git: = in a name")
        for setting in ("clean=", "smudge=", "process=", "required=false"):
            options += ("-c", f"{name}.{setting}")
    return options


def _base(root: str, ref: Reference) -> str:
    """The commit where the branch left REF, so that what others have changed there since does not count."""
    if not ref.name.strip() or ref.name.startswith("-"):
        raise UsageError(f"{ref.option} {ref.name!r}: expected a commit, a branch or a tag, such as main")
    status, output, said = _git(root, ref, "rev-parse", "--verify", "--quiet", f"{ref.name}^{{commit}}")
    if status:
        if _is_not_fetched(said):
            raise _refusal(ref, "rev-parse", said)
        raise UsageError(f"{ref}: {_missing(root, ref)}")
    commit = output.decode("ascii").strip()
    status, output, said = _git(root, ref, "merge-base", commit, "HEAD")
    # Without a common one, as in a shallow clone, all differences to the commit itself count: more, and none too few.
    return commit if status else output.decode("ascii").strip()


def _missing(root: str, ref: Reference) -> str:
    if _output(root, ref, "rev-parse", "--is-shallow-repository").strip() == b"true":
        return "the clone is shallow and has no such commit: fetch it (git fetch --unshallow; CI: depth 0)"
    names = _output(root, ref, "for-each-ref", "--format=%(refname:short)").decode("utf-8", "replace").split("\n")
    return f"git knows no such commit in {display_path(root)}{suggestion(ref.name, filter(None, names))}"


def _output(root: str, ref: Reference, *words: str, options: Sequence[str] = ()) -> bytes:
    """Return the output of a git command. Raises UsageError with its first message if it fails."""
    status, output, said = _git(root, ref, *words, options=options)
    if status:
        raise _refusal(ref, words[0], said)
    return output


def _refusal(ref: Reference, command: str, said: bytes) -> UsageError:
    if _is_not_fetched(said):
        lacks = "the clone is partial and lacks objects, which are not fetched here"
        return UsageError(f"{ref}: git {command}: {lacks}: if you trust it, run git diff {ref.name} first")
    lines = said.decode("utf-8", "replace").strip().split("\n")
    return UsageError(f"{ref}: git {command}: {lines[0].removeprefix('fatal: ')[:_LONGEST]}")


def _is_not_fetched(said: bytes) -> bool:
    return any(words in said.decode("utf-8", "replace") for words in _NOT_FETCHED)


def _git(root: str, ref: Reference, *words: str, options: Sequence[str] = ()) -> tuple[int, bytes, bytes]:
    """Status, output and messages of a command of git."""
    import subprocess

    program = _program(os.get_exec_path())
    if program is None:
        raise UsageError(f"{ref}: git is not installed, or not on the PATH")
    environment = {key: value for key, value in os.environ.items() if key not in _OF_A_HOOK} | _ENVIRONMENT
    try:
        process = subprocess.Popen(  # noqa: S603  a list of words, none of which git can take for an option
            [program, "-C", root, *_SAFE, *options, *words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            start_new_session=True,  # a group of its own, which is killed as a whole
        )
    except OSError as error:
        raise UsageError(f"{ref}: git: {error.strerror or error}") from None
    with process:
        try:
            output, said = process.communicate(timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            _kill(process)
            raise UsageError(f"{ref}: git {words[0]}: no answer within {TIME_LIMIT:g} s") from None
        except BaseException:
            _kill(process)
            raise
    return process.returncode, output, said


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End git with the processes that it has started."""
    import subprocess

    if sys.platform == "win32":
        # git.exe of the PATH is often a wrapper of the real one.
        command = os.path.join(os.environ.get("SYSTEMROOT", r"C:\Windows"), "System32", "taskkill.exe")  # noqa: PTH118
        with contextlib.suppress(OSError):
            subprocess.run([command, "/F", "/T", "/PID", str(process.pid)], capture_output=True, check=False)  # noqa: S603
        process.kill()
    else:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    # A process that left the group may hold the pipes open without end.
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.communicate(timeout=_AFTER_KILL)


def _program(folders: Iterable[str]) -> str | None:
    """git of the PATH; never one that lies in the folder that is checked, where Windows would look first."""
    name = "git.exe" if sys.platform == "win32" else "git"
    for folder in folders:
        path = os.path.join(folder, name)  # noqa: PTH118
        if os.path.isabs(folder) and os.path.isfile(path) and os.access(path, os.X_OK):  # noqa: PTH113, PTH117
            return path
    return None
