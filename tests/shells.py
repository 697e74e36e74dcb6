"""Real shells, driven as by somebody who types: a line, the tabulator, and what the line holds then."""

from __future__ import annotations

import os
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

from test_cli import IMPORTED_FROM

#: How a shell is started without what its user has set up, and what readies it.
COMMANDS = {
    "bash": ("--norc", "--noprofile", "-i"),
    "zsh": ("-f", "-i"),
    "fish": ("--no-config", "-i"),
}
SETS_UP = {
    "bash": "bind 'set enable-bracketed-paste off'; eval \"$(polarcheck completion bash)\"",
    "zsh": 'bindkey -e; autoload -U compinit; compinit -u -D; eval "$(polarcheck completion zsh)"',
    "fish": "polarcheck completion fish | source",
}
PATIENCE = 60.0
BEGIN, END = "\x01", "\x05"


def is_there(shell: str) -> bool:
    return shutil.which(shell) is not None and shutil.which("setsid") is not None


def put_command(folder: Path) -> None:
    """A command `polarcheck` in a folder, as an installation makes one."""
    folder.mkdir(exist_ok=True)
    script = folder / "polarcheck"
    script.write_text(f'#!/bin/sh\nPYTHONPATH={IMPORTED_FROM} exec {sys.executable} -m polarcheck "$@"\n')
    script.chmod(0o755)


class Typed:
    """A shell on a terminal of its own."""

    def __init__(self, shell: str, commands: Path, home: Path) -> None:
        import pty

        self._ours, theirs = pty.openpty()
        environment = {
            "PATH": f"{commands}:{os.environ['PATH']}",
            "HOME": os.fspath(home),
            "TERM": "dumb",
            "LC_ALL": "C.UTF-8",
        }
        self._process = subprocess.Popen(
            ["setsid", "--ctty", shell, *COMMANDS[shell]], stdin=theirs, stdout=theirs, stderr=theirs, env=environment
        )
        os.close(theirs)
        # Quotes part the word, so that the echo of the line is not taken for its outcome.
        self._run(SETS_UP[shell], "ready")

    def _run(self, line: str, word: str) -> str:
        os.write(self._ours, f"{line}; echo {word[:2]}''{word[2:]}\n".encode())
        return self._until(word)

    def _until(self, word: str) -> str:
        seen, until = "", time.monotonic() + PATIENCE
        while word not in seen:
            assert time.monotonic() < until, seen
            if select.select([self._ours], [], [], 1.0)[0]:
                seen += os.read(self._ours, 65536).decode(errors="replace")
        return seen

    def words(self, line: str) -> list[str]:
        """The words of the line after the tabulator, as the shell hands them to a command."""
        outcome = Path("words")
        outcome.unlink(missing_ok=True)
        keys = f"{line}\t{BEGIN}told {END}\n"
        os.write(self._ours, keys.encode())
        until = time.monotonic() + PATIENCE
        while not outcome.exists() or not outcome.read_text().endswith("\n\n"):
            assert time.monotonic() < until, self._seen()
            time.sleep(0.02)
        return outcome.read_text().removesuffix("\n\n").split("\n")

    def _seen(self) -> str:
        return os.read(self._ours, 65536).decode(errors="replace") if select.select([self._ours], [], [], 1)[0] else ""

    def close(self) -> None:
        self._process.kill()
        self._process.wait()
        os.close(self._ours)


def put_told(folder: Path) -> None:
    """A command that writes the words that it is given into a file, a line each."""
    script = folder / "told"
    script.write_text('#!/bin/sh\nprintf \'%s\\n\' "$@" "" > words.new; mv words.new words\n')
    script.chmod(0o755)
