"""Signals and want of memory at any moment of a process, from its first import to its end."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from cases import looped

import polarcheck

GOOD = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC5.\nC-5.\nG13.1\n"
SIGNALS = [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
NO_MEMORY = "polarcheck: there is not enough memory\n"

pytestmark = [
    pytest.mark.ci,
    pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals, limits and devices"),
    pytest.mark.usefixtures("own_folder"),
]

#: Runs the command line; something happens as soon as a module is imported.
AT_IMPORT = """
import signal, sys
class Finder:
    def find_spec(self, name, path, target=None):
        if name == {module!r}:
            sys.meta_path.remove(self)
            {happens}
sys.meta_path.insert(0, Finder())
from polarcheck.__main__ import run
run()
"""
RUN = "from polarcheck.__main__ import run; run()"


def run(code: str, *arguments: str, **options: Any) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of Python code with the arguments of a command line."""
    environment = {**os.environ, "PYTHONPATH": os.fspath(Path(polarcheck.__file__).parent.parent)}
    given: dict[str, Any] = {"stdout": subprocess.PIPE, "env": environment, **options}
    process = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        **given,
        stdin=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
        timeout=120,
    )
    # On an interrupt click ends the line of a terminal that shows ^C.
    return process.returncode, process.stdout or "", process.stderr.removeprefix("\n")


def check(code: str, **options: Any) -> tuple[int, str, str]:
    Path("a.nc").write_text(GOOD)
    return run(code, "check", "a.nc", "--select", "rapid-in-polar", **options)


def heed(*handlers: Any) -> None:
    """The handlers of signals that a process begins with; a background job of a shell ignores Ctrl-C."""
    for (number, _, _), handler in zip(SIGNALS, handlers, strict=True):
        signal.signal(number, handler)


heeding = partial(heed, signal.SIG_DFL, signal.SIG_DFL)


# ---- signals ----


@pytest.mark.parametrize(
    "module",
    [
        "click",
        "polarcheck.foundation.errors",
        "polarcheck.foundation.memory",
        "polarcheck.commands.check",
        "polarcheck.files.batch",
        "numpy",
    ],
)
@pytest.mark.parametrize(("number", "status", "how"), SIGNALS)
def test_a_signal_during_any_import_ends_the_process_in_a_line(module: str, number: int, status: int, how: str) -> None:
    code = AT_IMPORT.format(module=module, happens=f"signal.raise_signal({int(number)})")
    assert check(code, preexec_fn=heeding) == (status, "", f"polarcheck: {how}\n")


@looped(("number", "status", "how"), SIGNALS)
def test_a_signal_after_the_report_ends_the_process_in_a_line(number: int, status: int, how: str) -> None:
    code = f"import atexit, signal; atexit.register(signal.raise_signal, {int(number)}); {RUN}"
    ended, report, said = check(code, preexec_fn=heeding)
    assert (ended, said) == (status, f"polarcheck: {how}\n")
    assert "1 file" in report


#: What a process still has to do when its command has ended; `first` is freed where Python itself ends the process.
LATE = """
import atexit, sys, threading, time
class Last:
    def __del__(self, write=sys.stderr.write): write("freed ")
sys.modules["last"] = Last()
atexit.register(print, "registered", file=sys.stderr, end=" ")
threading.Thread(target=lambda: (time.sleep(2), print("thread"))).start()
"""


def test_the_end_waits_for_threads_and_for_what_is_registered() -> None:
    """Without freeing objects, and with the exit code of the check; with them where something else comes last."""
    code = AT_IMPORT.format(module="numpy", happens=f"exec({LATE!r}, {{}})")
    first = "import atexit; atexit.register(print, 'last', end='');"
    for before, said in (("", "registered "), (first, "registered freed ")):
        status, report, told = run(before + code, "check", "missing.nc", "--select", "rapid-in-polar")
        assert (status, told.partition("\n")[2]) == (2, said)
        assert report.endswith("thread\n" + "last" * bool(before))


@pytest.mark.nightly
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_is_ignored_stays_so(number: int) -> None:
    ignoring = partial(heed, signal.SIG_IGN, signal.SIG_IGN)
    for module in ("click", "numpy"):
        code = AT_IMPORT.format(module=module, happens=f"signal.raise_signal({int(number)})")
        assert check(code, preexec_fn=ignoring)[::2] == (0, "")


#: Python drops an exception in a destructor, and 3.11 makes another one of an exception in `__set_name__`.
PLACES = {
    "destructor": "type('D', (), {{'__del__': lambda self: signal.raise_signal({number})}})()",
    "name": "type('C', (), {{'a': type('N', (), {{'__set_name__': lambda *_: signal.raise_signal({number})}})()}})",
}


@looped("place", PLACES)
@looped(("number", "status", "how"), SIGNALS)
def test_a_signal_is_not_lost_where_python_drops_its_exception(place: str, number: int, status: int, how: str) -> None:
    happens = f"{PLACES[place].format(number=int(number))}; import time; time.sleep(600)"
    code = AT_IMPORT.format(module="numpy", happens=happens)
    assert check(code, preexec_fn=heeding) == (status, "", f"polarcheck: {how}\n")


def test_what_else_python_drops_is_told_as_ever() -> None:
    happens = "type('D', (), {'__del__': lambda self: 1 / 0})()"
    status, _, said = check(AT_IMPORT.format(module="numpy", happens=happens))
    assert status == 0
    assert "ZeroDivisionError" in said


# ---- memory ----


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux bounds the address space")
@pytest.mark.parametrize(
    ("megabytes", "arguments"),
    [
        (50, ("part", "a.nc")),
        (80, ("init",)),
        (100, ("check", "a.nc")),
        (100, ("trace", "a.nc")),
        (110, ("check", "a.nc")),
    ],
)
def test_too_little_address_space_is_one_line(megabytes: int, arguments: tuple[str, ...]) -> None:
    import resource

    Path("a.nc").write_text(GOOD)
    most = partial(resource.setrlimit, resource.RLIMIT_AS, (megabytes * 1_024_000, megabytes * 1_024_000))
    assert run(RUN, *arguments, preexec_fn=most) == (2, "", NO_MEMORY)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux bounds the address space")
def test_too_little_data_is_one_line_and_help_needs_little() -> None:
    import resource

    most = partial(resource.setrlimit, resource.RLIMIT_DATA, (50_000_000, 50_000_000))
    assert check(RUN, preexec_fn=most) == (2, "", NO_MEMORY)
    most = partial(resource.setrlimit, resource.RLIMIT_AS, (60_000_000, 60_000_000))
    assert run(RUN, "check", "--help", preexec_fn=most)[::2] == (0, "")


@looped("module", ["click", "polarcheck.commands.part", "polarcheck.program.reading.excerpt", "numpy"])
@looped(
    "error",
    ["MemoryError", "ImportError('x.so: failed to map segment from shared object')", "OSError(12, 'Cannot allocate')"],
)
def test_want_of_memory_during_any_import_is_one_line(module: str, error: str) -> None:
    Path("a.nc").write_text(GOOD)
    code = AT_IMPORT.format(module=module, happens=f"raise {error}")
    # The module of excerpts is imported for the line itself.
    arguments = ("check", "--no-such") if module == "polarcheck.program.reading.excerpt" else ("part", "a.nc")
    assert run(code, *arguments)[0::2] == (2, NO_MEMORY)


def test_any_other_fault_of_an_import_is_not_taken_for_want_of_memory() -> None:
    code = AT_IMPORT.format(module="numpy", happens="raise ImportError('no such symbol')")
    # The fault stays: a run first looks where NumPy is, to see whether anything has changed, and goes on after a fault.
    status, _, said = check(code.replace("sys.meta_path.remove(self)", "pass"))
    assert (status, said.count("\n")) == (3, 1)
    assert "internal error: ImportError: no such symbol" in said


# ---- help ----


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize(
    ("command", "unbuffered"),
    [
        ((), ""),
        ((), "1"),
        (("check",), ""),
        (("check",), "1"),
        (("baseline", "create"), "1"),
        (("machines", "new"), ""),
    ],
)
def test_help_into_a_full_disk_is_one_line(command: tuple[str, ...], unbuffered: str) -> None:
    environment = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    with open("/dev/full", "w") as full:  # noqa: PTH123
        ended = run(RUN, *command, "--help", stdout=full, env=environment)
    assert ended == (2, "", "polarcheck: standard output: No space left on device\n")


@looped("command", [(), ("check",), ("machines", "new")])
def test_help_that_nobody_reads_is_no_fault(command: tuple[str, ...]) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    assert run(RUN, *command, "--help", stdout=writing) == (0, "", "")
    os.close(writing)
