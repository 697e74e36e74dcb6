"""Statements of a control's own language that move nothing, by the table of its profile."""

from __future__ import annotations

import re
from fnmatch import fnmatchcase

from polarcheck.program.machines.machine import Machine

_WORD = re.compile(r"[$A-Z_][A-Z0-9_$]*+(?:\[[^\[\]]{0,80}+\])?=?")
_INDEX = re.compile(r"\[[^\[\]]*+\]")


def is_without_effect(content: str, machine: Machine) -> bool:
    """
    The statement moves nothing and changes no path: a message, a limit of the speed, the wait for another channel.

    content: of its block, without N word and comment.
    """
    rest = content.upper()
    words = [match[0] for match in _WORD.finditer(rest)][:1]
    if not words:
        return False
    plain = _INDEX.sub("[*]", words[0])
    numbered = re.sub(r"(?<=[A-Z])\d+=", "n=", plain)
    for name, effect in machine.macro.statements.items():
        if effect == "none" and (fnmatchcase(plain, name) or numbered == name):
            return True
    return False
