"""
Shell completion: click completes commands and options, this module completes values by their metavar.

The scripts under completions/ send requests by click's environment variables. A line of the answer has up to three
fields, separated by US (0x1f):

    head, TEXT                the part of the typed word before all values, such as `--machine=`
    word, VALUE, HELP         a complete value; a blank follows
    part, VALUE, HELP         a value that goes on, such as `json:`
    files, BEGUN, ENDING      files with this beginning and, if given, this ending
    folders, BEGUN            folders with this beginning

The shell itself looks for files and folders: it knows how to write names with blanks, `~` and variables.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from copy import copy
from pathlib import Path
from typing import TYPE_CHECKING, cast

import click
from click.shell_completion import CompletionItem, ShellComplete, add_completion_class, split_arg_string

from polarcheck.commands.completion import SHELLS

_BETWEEN = "\x1f"
_PROFILE = ".toml"

if TYPE_CHECKING:
    # In click below 8.4 the class takes no type.
    Item = CompletionItem[str]
else:
    Item = CompletionItem


def _item(value: str, about: str = "", kind: str = "plain", head: str = "") -> Item:
    """Return an item; head: the part of the typed word before the value."""
    return CompletionItem(value, kind, about, head=head)


# ---- values by metavar ----


def _paths(ending: str = "", kind: str = "file") -> Values:
    """Return what completes a path."""
    return lambda begun: iter((_item(begun, ending, kind),))


def _matching(begun: str, values: Iterable[tuple[str, str]], head: str = "", end: str = "") -> Iterator[Item]:
    """
    Yield the values that begin as the word does, each given with what is said of it.

    end: of values behind which the word goes on.
    """
    kind = "part" if end else "plain"
    yield from (_item(f"{value}{end}", about, kind, head) for value, about in values if value.startswith(begun))


def _machines(begun: str) -> Iterator[Item]:
    """Yield the built-in machines, and machine files."""
    from polarcheck.program import machines

    titles = {path.stem: _title_of_machine(path) for path in Path(machines.__file__).parent.glob("*.toml")}
    yield from _matching(begun, sorted(titles.items()))
    yield from _paths(_PROFILE)(begun)


def _title_of_machine(path: Path) -> str:
    lines = path.read_text("utf-8").splitlines()
    return next((line.partition('"')[2].rpartition('"')[0] for line in lines if line.startswith("title = ")), "")


def _machines_and_verbs(begun: str) -> Iterator[Item]:
    verbs = {"check": "whether a file for a lathe is sound", "new": "a file for a lathe of your own"}
    yield from _matching(begun, verbs.items())
    yield from _machines(begun)


def _rules(begun: str) -> Iterator[Item]:
    """Yield rules and groups, for the last name of a list with commas."""
    before, comma, last = begun.rpartition(",")
    yield from _matching(last, _names_of_rules(), before + comma)


def _pages(begun: str) -> Iterator[Item]:
    verdicts = dict.fromkeys(("pass", "unverified", "fail", "unreadable"), "what this verdict means")
    yield from _matching(begun, [*_names_of_rules(), *verdicts.items()])


def _names_of_rules() -> Iterator[tuple[str, str]]:
    """
    Groups and rules with their titles, from the files: to load them all takes longer than a user waits for a word.
    """
    from polarcheck.rules.rule import rule_files

    paths = list(map(Path, rule_files()))
    for group in sorted({path.parent.name for path in paths}):
        yield group, "all rules of this group"
    for path in paths:
        text = path.read_text("utf-8").partition('"""')[2]
        yield path.stem.replace("_", "-"), text.strip().partition("\n")[0].rstrip(".")


def _levels(begun: str) -> Iterator[Item]:
    from polarcheck.files.settings.selection import LEVELS

    name, equals, level = begun.partition("=")
    if equals:
        yield from _matching(level, ((known, "") for known in LEVELS), f"{name}=")
    else:
        yield from (_item(f"{item.value}=", item.help or "", "part") for item in _rules(name))


def _in_doubt(begun: str) -> Iterator[Item]:
    from polarcheck.rewrite.convert.doubtful_values import KEYS

    yield from _matching(begun, ((key, "") for key in KEYS))


def _outputs(begun: str) -> Iterator[Item]:
    """Yield formats, then files; a drive letter after the format belongs to the file."""
    from polarcheck.reports import formats

    form, colon, path = begun.partition(":")
    if colon:
        yield _item(path, kind="file", head=f"{form}:")
    else:
        yield from _matching(form, ((known, "a report in a file") for known in formats()), end=":")


def _keys(begun: str) -> Iterator[Item]:
    """Yield TABLE.KEY= of a machine."""
    import msgspec

    from polarcheck.program.machines.machine import Machine, meanings

    for field in msgspec.structs.fields(Machine):
        if isinstance(field.type, type) and issubclass(field.type, msgspec.Struct):
            keys = ((f"{field.name}.{key}", about) for key, about in meanings(field.type).items())
            yield from _matching(begun, keys, end="=")


def _tool(begun: str) -> Iterator[Item]:
    """Yield N:KEY= after the number of an offset and other keys."""
    number, colon, values = begun.rpartition(":")
    before, comma, key = values.rpartition(",")
    if colon and "=" not in key:
        yield from _matching(key, (("radius", ""), ("nose", "")), f"{number}:{before}{comma}", "=")


def _encodings(begun: str) -> Iterator[Item]:
    encodings = {
        "utf-8": "",
        "utf-16": "",
        "cp1252": "Western Europe",
        "cp1250": "Central Europe",
        "cp1251": "Cyrillic",
        "shift_jis": "Japanese",
        "gb18030": "Chinese",
        "euc_kr": "Korean",
    }
    yield from _matching(begun, encodings.items())


def _nothing(begun: str) -> Iterator[Item]:
    yield from ()


Values = Callable[[str], Iterator[Item]]

#: The completion of the values of options, by their metavar; options of click's own types need none.
OPTIONS: dict[str, Values] = {
    "EXT": _nothing,
    "FILE": _paths(),
    "FILE.dxf": _paths(".dxf"),
    "FOLDER": _paths(kind="dir"),
    "FORMAT:FILE": _outputs,
    "KEY": _in_doubt,
    "KEY=VALUE": _keys,
    "LAYER": _nothing,
    "LENGTH": _nothing,
    "N": _nothing,
    "N:KEY=VALUE": _tool,
    "NAME": _encodings,
    "NAME|FILE": _machines,
    "PATH": _paths(),
    "PATTERN": _paths(),
    "REF": _nothing,
    "RULE": _rules,
    "RULE=LEVEL": _levels,
    "SIZE": _nothing,
    "TEXT": _nothing,
    "tcp://HOST:PORT": _nothing,
}
#: The same for arguments.
ARGUMENTS: dict[str, Values] = {
    "FILE": _paths(),
    "FOLDER": _paths(kind="dir"),
    "LATHE": _paths(_PROFILE),
    "NAME": _machines_and_verbs,
    "OLD NEW": _paths(),
    "PATH": _paths(),
    "RULE": _pages,
}


def metavar(parameter: click.Parameter) -> str:
    """Return the name of a value in the help, without the marks for optional and repeated values."""
    written = parameter.metavar or (parameter.name or "").upper()
    return written.strip("[]").removesuffix("...").strip("[]")


class _Named(click.types.StringParamType):
    """The type of a value with a known metavar; it only completes."""

    name = "named"

    def __init__(self, values: Values) -> None:
        self._values = values

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[Item]:
        return list(self._values(incomplete))


def _named(command: click.Command) -> click.Command:
    """Return a copy of a command in which each value has the type of its metavar."""
    copied = copy(command)
    copied.params = [_named_value(parameter) for parameter in command.params]
    if isinstance(command, click.Group) and isinstance(copied, click.Group):
        copied.commands = cast("dict[str, click.Command]", _NamedCommands(command.commands))
    return copied


def _named_value(parameter: click.Parameter) -> click.Parameter:
    values = (OPTIONS if isinstance(parameter, click.Option) else ARGUMENTS).get(metavar(parameter))
    if values is None or isinstance(parameter.type, click.Choice):
        return parameter
    copied = copy(parameter)
    copied.type = _Named(values)
    return copied


class _NamedCommands(Mapping[str, click.Command]):
    """The same for the commands of a group, each imported on first use."""

    def __init__(self, commands: Mapping[str, click.Command]) -> None:
        self._commands = commands

    def __getitem__(self, name: str) -> click.Command:
        return _named(self._commands[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._commands)

    def __len__(self) -> int:
        return len(self._commands)


# ---- requests and answers of the shells ----


class _Shell(ShellComplete):
    """
    A shell.

    COMP_WORDS holds the words before the one that is completed, a line each; POLARCHECK_WORD holds that one.
    """

    source_template = ""

    def get_completion_args(self) -> tuple[list[str], str]:
        """Return the complete words after the command, and the word that is completed."""
        return os.environ.get("COMP_WORDS", "").split("\n")[1:], self.word()

    def word(self) -> str:
        """Return the typed part of the word that is completed, without the quotes of the shell."""
        return os.environ.get("POLARCHECK_WORD", "")

    def stays(self, head: str) -> str:
        """Return the part of the head that values must begin with in this shell."""
        return head

    def complete(self) -> str:
        """Return the answer."""
        arguments, word = self.get_completion_args()
        self.cli = _named(self.cli)
        lead = word[: word.index("=") + 1] if word.startswith("--") and "=" in word else ""
        lines: list[str] = []
        for item in self.get_completions(arguments, word):
            head = self.stays(lead + (item.head or ""))
            if not lines and head:
                lines.append(_BETWEEN.join(("head", head)))
            lines.append(_BETWEEN.join(_fields(item)))
        return "\n".join(lines)


def _fields(item: Item) -> tuple[str, ...]:
    about = " ".join((item.help or "").split())
    if item.type in ("file", "dir"):
        return ("files", item.value, about) if item.type == "file" else ("folders", item.value)
    return ("part" if item.type == "part" else "word", item.value, about)


class _Bash(_Shell):
    """bash, which also splits words at = and :, and completes the part after the last of these."""

    name = "bash"

    def get_completion_args(self) -> tuple[list[str], str]:
        """Return the complete words after the command, and the word at the cursor."""
        line = os.environ.get("COMP_WORDS", "")
        words = split_arg_string(line)
        is_new = line != line.rstrip() and not _ends_inside_a_word(line)
        return (words[1:], "") if is_new else (words[1:-1], words[-1] if len(words) > 1 else "")

    def stays(self, head: str) -> str:
        """Return the part of the head after the last character at which bash splits words."""
        line, breaks = os.environ.get("COMP_WORDS", ""), os.environ.get("POLARCHECK_BREAKS", "")
        if _open_quote(line):
            return head
        return head[max((head.rfind(mark) for mark in breaks if mark in "=:"), default=-1) + 1 :]


def _open_quote(line: str) -> str:
    """Return the quote that is open at the end of a line; empty if none is."""
    quote, escaped = "", False
    for character in line:
        if escaped:
            escaped = False
        elif character == "\\" and quote != "'":
            escaped = True
        elif quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
    return quote or ("\\" if escaped else "")


def _ends_inside_a_word(line: str) -> bool:
    """Return True if the blank at the end of a line belongs to a word, by a quote or a backslash before it."""
    return bool(_open_quote(line) or _open_quote(line[:-1]) == "\\")


class _Fish(_Shell):
    """fish, which passes the word as typed, with its quotes."""

    name = "fish"

    def word(self) -> str:
        """Return the word that is completed, without quotes."""
        words = split_arg_string(super().word())
        return words[0] if words else ""


class _Zsh(_Shell):
    name = "zsh"


class _PowerShell(_Shell):
    name = "powershell"


def register() -> None:
    """Register these shells with click."""
    for shell in (_Bash, _Zsh, _Fish, _PowerShell):
        assert shell.name in SHELLS
        add_completion_class(shell)
