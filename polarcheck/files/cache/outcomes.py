"""Outcomes that are taken from a cache, and those that go into it."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from typing import Any

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.files.batch.tasks import Basis, Outcome, Task
from polarcheck.files.cache import digests, repeats
from polarcheck.files.cache.code_digest import code_digest
from polarcheck.files.cache.store import NAME, Store, folder_key, user_key
from polarcheck.foundation import record
from polarcheck.foundation.bounded import read_file
from polarcheck.foundation.decoding import msgpack_decoder
from polarcheck.foundation.digest import blake2b
from polarcheck.foundation.finding import FileReport, Finding, Undecided
from polarcheck.foundation.record import LookUp
from polarcheck.program.reading import files

#: New entries are written once so many files of the cache have some: of a run that is killed little is lost.
_AT_A_TIME = 256
#: Yields the outcomes of tasks.
Check = Callable[[Sequence[Task]], AbstractContextManager[Generator[Outcome, None, None]]]


class _Entry(msgspec.Struct, frozen=True, array_like=True):
    """
    An outcome as it is kept.

    basis: what it rests on.
    report, lines, called, failed: fields of the outcome.
    undecided: numbers of the findings that are Undecided, in the order of `_in_order`.
    """

    basis: Basis
    report: FileReport
    undecided: list[int]
    lines: dict[int, str]
    called: list[str]
    failed: bool


class Cache:
    """
    The outcomes of earlier runs.

    An outcome is used again where the code, all settings, the title and the content of the program are the same, and
    each called program that was looked for is found, or missing, as before.
    """

    def __init__(self, most: int, folder: str | None = None) -> None:
        """most: bytes of a program. folder: of the cache, instead of one beside each job file."""
        #: True while each outcome comes from the cache, or has gone into it.
        self._is_whole = True
        self._most = most
        self._folder = folder
        self._key = user_key() if folder is None else folder_key(folder)
        self._stores: dict[str, Store] = {}
        self._of_settings: dict[int, tuple[Settings, Store | None, bytes]] = {}
        self._libraries: dict[int, _Library] = {}

    @contextmanager
    def outcomes(self, tasks: Sequence[Task], check: Check) -> Iterator[Generator[Outcome, None, None]]:
        """Yield a generator of the outcomes, in order; only those that are not cached are checked."""
        merged = self._merged(tasks, check)
        try:
            yield merged
        finally:
            merged.close()

    def _merged(self, tasks: Sequence[Task], check: Check) -> Generator[Outcome, None, None]:
        if self._key is None:
            self._is_whole = False
            with check(tasks) as fresh:
                yield from fresh
            return
        slots = [self._slot(task) for task in tasks]
        entries = [self._known(task, *slot) if slot else None for task, slot in zip(tasks, slots, strict=True)]
        with check([task for task, entry in zip(tasks, entries, strict=True) if entry is None]) as fresh:
            try:
                for task, slot, entry in zip(tasks, slots, entries, strict=True):
                    if entry is not None:
                        yield _outcome(entry)
                        continue
                    outcome = next(fresh)
                    # After an interrupt the outcomes that are finished come without those that are missing.
                    if slot is not None and outcome.report is not None and outcome.report.path == task.title:
                        self._keep(outcome, *slot)
                    else:
                        self._is_whole = False
                    yield outcome
            finally:
                self._write(-1)

    def keep_run(self, paths: Sequence[str], status: int) -> None:
        """
        Let the run that ends now be repeated, if each of its outcomes is in the cache.

        paths: the arguments of the command line. status: the exit code.
        """
        if self._is_whole and all(map(os.path.isfile, paths)):
            repeats.keep(status)

    def _slot(self, task: Task) -> tuple[Store, bytes] | None:
        """Return where the outcome of a task is kept; None for standard input, pipes and settings without a digest."""
        if task.named or files.is_standard_input(task.path):
            return None
        _, store, digest = self._settings(task.settings)
        try:
            if store is None or not stat.S_ISREG(os.stat(task.path).st_mode):  # noqa: PTH116
                return None
        except (OSError, ValueError):
            return None
        title = task.title.encode("utf-8", "surrogatepass")
        return store, blake2b(digest + title, digest_size=digests.SIZE).digest()

    def _settings(self, settings: Settings) -> tuple[Settings, Store | None, bytes]:
        """Return settings with their store, if they have one, and their digest; the first keeps their id in use."""
        if id(settings) not in self._of_settings:
            try:
                digest = digests.of_settings(settings)
            except digests.NoDigestError:
                self._of_settings[id(settings)] = settings, None, b""
            else:
                self._of_settings[id(settings)] = settings, self._store(settings), digest
        return self._of_settings[id(settings)]

    def _store(self, settings: Settings) -> Store:
        folder = self._folder
        if folder is None:
            parent = os.path.dirname(settings.job_file) if settings.job_file is not None else ""  # noqa: PTH120
            folder = os.path.join(parent, NAME)  # noqa: PTH118
        if folder not in self._stores:
            assert self._key is not None
            self._stores[folder] = Store(folder, code_digest(), self._key, links=self._folder is not None)
        return self._stores[folder]

    def _known(self, task: Task, store: Store, digest: bytes) -> bytes | None:
        """Return the entry of a task if it still holds."""
        data = store.get(digest)
        if data is None:
            return None
        try:
            entry = msgpack_decoder(_Entry).decode(data)
            if record.digest(read_file(task.path, self._most, "")) != entry.basis.content:
                return None
        except (OSError, ValueError):
            return None
        if not all(self._holds(task.settings, look_up) for look_up in entry.basis.look_ups):
            return None
        store.use(digest)
        return data

    def _holds(self, settings: Settings, before: LookUp) -> bool:
        """Return True if a called program is found, or missing, as before."""
        if id(settings) not in self._libraries:
            self._libraries[id(settings)] = _Library(settings)
        return self._libraries[id(settings)].look_up(before.number, before.name) == before

    def _keep(self, outcome: Outcome, store: Store, digest: bytes) -> None:
        data = _encoded(outcome)
        if data is None:
            self._is_whole = False
        else:
            store.put(digest, data)
            self._write(_AT_A_TIME)

    def _write(self, least: int) -> None:
        for store in self._stores.values():
            if store.waiting > least:
                store.write()


class _Library:
    """The folders of called programs of some settings; each program is looked for once."""

    def __init__(self, settings: Settings) -> None:
        from polarcheck.program.execution.called_programs import Library  # few files call others

        self._library = Library(settings.job.run.subprograms, settings.machine)
        self._known: dict[tuple[int | None, str | None], LookUp] = {}

    def look_up(self, number: int | None, name: str | None) -> LookUp:
        from polarcheck.program.execution.programs import ProgramName

        called = ProgramName(number, name)
        if called not in self._known:
            with record.recorded() as read:
                self._library.places(called)
            self._known[called] = read.look_ups[0]
        return self._known[called]


def _encoded(outcome: Outcome) -> bytes | None:
    """Return the bytes of an outcome that is read back from them as it is; None for any other."""
    report, basis = outcome.report, outcome.basis
    if report is None or basis is None or basis.content is None or type(report) is not FileReport:
        return None
    undecided = [number for number, finding in enumerate(_in_order(report)) if isinstance(finding, Undecided)]
    entry = _Entry(basis, report, undecided, dict(outcome.lines), sorted(outcome.called), outcome.failed)
    try:
        data = msgspec.msgpack.encode(entry)
        return data if _outcome(data) == outcome else None
    except (TypeError, ValueError):  # text that is no Unicode, values of other types
        return None


def _outcome(data: bytes) -> Outcome:
    entry = msgpack_decoder(_Entry).decode(data)
    report = entry.report
    if entry.undecided:
        report = _with_undecided(report, frozenset(entry.undecided))
    return Outcome(report, entry.lines, frozenset(entry.called), entry.failed, basis=entry.basis)


def _in_order(report: FileReport) -> Iterator[Finding]:
    """Yield all findings, those that follow from others behind these."""
    stack: list[Finding] = list(reversed(report.findings))
    while stack:
        finding = stack.pop()
        yield finding
        stack += reversed(finding.follows)


def _with_undecided(report: FileReport, numbers: frozenset[int]) -> FileReport:
    """Return the report with the findings of these numbers as Undecided."""
    count = iter(range(2**62))

    def typed(finding: Finding) -> Finding:
        is_undecided = next(count) in numbers
        fields: dict[str, Any] = {name: getattr(finding, name) for name in Finding.__struct_fields__}
        fields["follows"] = [typed(follower) for follower in finding.follows]
        return (Undecided if is_undecided else Finding)(**fields)

    return msgspec.structs.replace(report, findings=[typed(finding) for finding in report.findings])
