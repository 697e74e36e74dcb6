"""`plot --serve`: serves the pages of programs, and makes them anew whenever a file changes that they depend on."""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from collections.abc import Generator, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from polarcheck.commands import picturing, running, watching
from polarcheck.commands.options import all_of, option
from polarcheck.commands.output import bug_lines, say_lines, show
from polarcheck.foundation.errors import PolarcheckError, UsageError
from polarcheck.program.reading.files import size, write

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Outcome, Task
    from polarcheck.files.settings.of_programs import Options
    from polarcheck.foundation.finding import FileReport
    from polarcheck.reports import Background
    from polarcheck.view.page_server import Site
    from polarcheck.view.picture_data import Drawn

#: The length of a version.
_DIGITS = 16
#: The name of the file with the first page.
_FIRST_FILE = "first.html"
#: The name of the first page: that of the only program, or the index page.
_FIRST = ""


#: The options of serving.
options = all_of(
    option("--serve", is_flag=True, help="Serve the page to this machine alone, anew after each change, until Ctrl-C."),
    option(
        "--port", type=click.IntRange(0, 65535), metavar="N",
        help="With --serve, the port on 127.0.0.1; 0, the default, takes a free one.",
    ),
    option("--open", "opens", is_flag=True, help="With --serve, show the page in the browser."),
)  # fmt: skip


class Wish(NamedTuple):
    """
    What is served, and how.

    paths: programs and folders.
    applies: the options that apply to programs.
    extensions: of the programs in folders.
    most: bytes of a program.
    workers: processes for the first run, 0 for as many as pay.
    port: 0 for a free one.
    opens: show the page in the browser.
    debug: show tracebacks of bugs.
    """

    paths: Sequence[str]
    applies: Options
    extensions: Sequence[str]
    most: int
    workers: int
    port: int
    opens: bool
    debug: bool


def refuse(serve: bool, paths: Sequence[str], options: dict[str, object], serving: dict[str, bool]) -> None:
    """
    Raise UsageError for options that do not go together.

    options: options that are for one page, by their names.
    serving: options that need --serve, by their names.
    """
    if serve:
        watching.refuse(paths, options, "--serve")
        return
    for name, is_given in serving.items():
        if is_given:
            raise UsageError(f"{name}: only with --serve")


def serve(wish: Wish) -> int:
    """
    Serve until Ctrl-C; return the exit code.

    Raises OutputError if the port is taken; UsageError or Exit if there is nothing to serve.
    """
    from polarcheck.view.page_server import Server, Site

    site = Site()
    server = Server(site, wish.port, lambda error: say_lines(bug_lines(error, wish.debug)))
    with tempfile.TemporaryDirectory(prefix="polarcheck-", ignore_cleanup_errors=True) as folder, server:
        rounds = _Rounds(wish, site, Path(folder))

        def run(seen: watching.Seen) -> int:
            status = rounds.run(seen)
            if site.get(_FIRST) is None:
                raise click.exceptions.Exit(status)
            if not server.answers:
                # Processes are started before threads are: a fork copies locks, but no thread that would free them.
                server.start()
                show(f"{server.address}\n")
                if wish.opens:
                    import webbrowser

                    webbrowser.open(server.address)
            return status

        return watching.repeatedly(run, wish.paths, clears=False)


class _Rounds:
    """
    Makes the pages, at first of all programs, then of those that have changed.

    count: the number of runs until now.
    """

    def __init__(self, wish: Wish, site: Site, folder: Path) -> None:
        self._wish, self._site, self._folder = wish, site, folder
        self._pages = _Pages(site, folder)
        self._titles: list[str] = []
        self.count = 0

    def run(self, seen: watching.Seen) -> int:
        """
        Make the pages once; return the exit code of the run.

        Raises PolarcheckError for a broken job file; UsageError or Exit if the first run has nothing to serve.
        """
        self.count += 1
        try:
            return self._run(seen)
        except PolarcheckError as error:
            for name in self._site.names():
                self._pages.keep(name, str(error))
            raise

    def _run(self, seen: watching.Seen) -> int:
        from polarcheck import reports
        from polarcheck.commands import reporting, signals
        from polarcheck.files.batch import tasks as batch
        from polarcheck.files.settings.of_programs import OfPrograms
        from polarcheck.rules import rule
        from polarcheck.view.picture_index import page_names

        faults = running.Faults(self._wish.debug)
        tasks = running.planned(self._wish.paths, OfPrograms(self._wish.applies), self._wish.extensions, faults)
        if self.count == 1 and not tasks:
            if status := faults.report():
                raise click.exceptions.Exit(status)
            raise UsageError("--serve: there is no program to serve")
        present = {task.title for task in tasks}
        tasks = [task for task in tasks if not (task.title in self._titles and _is_empty(task))]
        self._titles += [task.title for task in tasks if task.title not in self._titles]
        is_one = len(self._titles) == 1 and not any(Path(path).is_dir() for path in self._wish.paths)
        names = [_FIRST] if is_one else page_names(self._titles)
        background = reporting.background(reports.Background(rules=rule.load_all()), tasks)
        self._pages.begin(background)
        self._pages.names = dict(zip(self._titles, names, strict=True))
        with seen.outcomes(tasks, self._outcomes) as outcomes:
            checked = batch.gather(outcomes, faults.failures.append, faults.bug)
        if checked.stopped is not None:
            return signals.exit_status(checked.stopped)[0]
        if self.count == 1:
            running.warn_unused(self._wish.applies.tools, checked.called)
        read = {report.path: report for report in checked.files}
        for title, name in self._pages.names.items():
            if title not in read:
                why = f"{title}: the program is {'empty' if title in present else 'not there'}"
                self._pages.keep(name, faults.failures[0] if faults.failures else why)
        if not is_one:
            self._pages.put_index(checked.files)
        return faults.report()

    @contextlib.contextmanager
    def _outcomes(self, tasks: Sequence[Task]) -> Iterator[Generator[Outcome, None, None]]:
        """Yield a generator of outcomes without their drawings, whose pages are put on the site."""
        from polarcheck.files.batch import batch_run

        workers = self._wish.workers if self.count == 1 else 1
        with batch_run.outcomes(tasks, self._wish.most, workers) as outcomes:
            yield self._pages.split(outcomes)


class _Pages(picturing.Pictures):
    """
    Puts the page of each program on the site; the pages lie in a folder, so that memory does not grow.

    names: of the pages, by the program.
    """

    def __init__(self, site: Site, folder: Path) -> None:
        super().__init__()
        self.names: dict[str, str] = {}
        self._site, self._folder = site, folder

    def begin(self, background: Background) -> None:
        """Prepare for a run, and put plotly on the site."""
        from polarcheck.view.page_server import Served
        from polarcheck.view.plotly_script import FILE_NAME, library

        self._background = background
        if self._site.get(FILE_NAME) is None:
            data = library().encode()
            self._site.put(FILE_NAME, Served(lambda: data, "text/javascript; charset=utf-8", ""))

    def store(self, outcome: Outcome, drawn: Drawn) -> None:
        """Put the page of a program on the site."""
        import msgspec

        from polarcheck.view.page import page
        from polarcheck.view.page_data import picture
        from polarcheck.view.plotly_script import FILE_NAME

        report = outcome.report
        assert report is not None
        pictured = picture(report, self._background._replace(drawn={report.path: drawn}))
        version = hashlib.sha256(msgspec.json.encode(pictured)).hexdigest()[:_DIGITS]
        self._put(
            self.names[report.path], page([pictured], script_path=FILE_NAME, version=version, sources="'self'"), version
        )

    def miss(self, report: FileReport) -> None:
        """Keep the page of a program that could not be read or checked."""
        self.keep(self.names[report.path], f"{report.path}: {report.reason}")

    def keep(self, name: str, reason: str) -> None:
        """Say on a page why it is that of an earlier state."""
        from polarcheck.program.reading.excerpt import visible

        self._site.notice(name, f"{visible(reason)}. This is the last state that could be read.")

    def put_index(self, reports: Sequence[FileReport]) -> None:
        """Put the index page on the site."""
        from polarcheck.view.picture_index import entry, index

        entries = [
            entry(report, self.names[report.path] if self._site.get(self.names[report.path]) else "")
            for report in reports
        ]
        version = hashlib.sha256(repr(entries).encode()).hexdigest()[:_DIGITS]
        self._put(_FIRST, index(entries, version=version), version)

    def _put(self, name: str, text: str, version: str) -> None:
        from polarcheck.view.page_server import Served

        path = self._folder / (name or _FIRST_FILE)
        write(path, text)
        self._site.put(name, Served(path.read_bytes, "text/html; charset=utf-8", version))


def _is_empty(task: Task) -> bool:
    """Return True for a program that is empty, as one is for a moment while it is written."""
    return os.path.exists(task.path) and not size(task.path)  # noqa: PTH110  Path.exists raises for some names
