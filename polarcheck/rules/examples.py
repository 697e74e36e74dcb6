"""The Bad and Good programs of a manual page: what a rule shows its readers, and its test."""

from __future__ import annotations

import re

import msgspec

#: An option of a heading: commas stand in the braces of a table alone.
_OPTION = r", (machine|tool|set) ([^\n,:=]+(?:[:=](?:[^\n,{]|\{[^{}\n]*+\})*)?)"
_HEADING = re.compile(rf"^(Bad|Good)((?:{_OPTION})*):$", re.MULTILINE)
_EXPECT = re.compile(r"\(expect: ([a-z0-9, -]+)\)")


class Example(msgspec.Struct, frozen=True):
    """
    A program of a manual page and what must be said of it.

    `Bad, machine turning-center, tool 8:radius=9.5, set limits.c_feed=3600:` heads a program for that machine, tool and
    value. expected: (line, rule) for each `(expect: rule)` in it, which is no part of the program.
    """

    good: bool
    machine: str
    tools: tuple[str, ...]
    settings: tuple[str, ...]
    program: str
    expected: tuple[tuple[int, str], ...]


def options_of(heading: str) -> list[tuple[str, str]]:
    """The kind and the value of each option in a heading: `, machine haas-lathe, tool 8:radius=4`."""
    return [(found[1], found[2]) for found in re.finditer(_OPTION, heading)]


def examples(page: str) -> list[Example]:
    """The Bad and Good programs of a manual page, in order."""
    found = []
    for match in _HEADING.finditer(page):
        body = []
        for line in page[match.end() :].lstrip("\n").split("\n"):
            if line and not line.startswith("    "):
                break
            body.append(line[4:])
        text = "\n".join(body).rstrip("\n") + "\n"
        expected = [
            (number, name.strip())
            for number, line in enumerate(text.split("\n"), 1)
            for match_ in _EXPECT.finditer(line)
            for name in match_[1].split(",")
        ]
        options = options_of(match[2])
        program = re.sub(r"(?<![ \t])[ \t]*+\(expect: [^()\n]*+\)[ \t]*+$", "", text, flags=re.MULTILINE)
        found.append(
            Example(
                match[1] == "Good",
                next((value for key, value in options if key == "machine"), ""),
                tuple(value for key, value in options if key == "tool"),
                tuple(value for key, value in options if key == "set"),
                program,
                tuple(expected),
            )
        )
    return found
