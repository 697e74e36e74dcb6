"""The words of an allow comment: what it does, which rules it names, the reason; hostile or cut off, it is read."""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Mapping, Sequence

import msgspec

from polarcheck.errors import suggestion
from polarcheck.reading.excerpt import shortened

ALLOW, FILE, ON, OFF = "ALLOW", "ALLOW-FILE", "ALLOW-ON", "ALLOW-OFF"
KINDS = (ALLOW, FILE, ON, OFF)
#: The first word of a comment, and what follows; a colon is tolerated, though controls read it as O.
_COMMENT = re.compile(r"[^A-Za-z0-9]*POLARCHECK[\s:]*([A-Za-z-]*)[\s:,]*(.*)", re.IGNORECASE | re.DOTALL)
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")
#: Words of other checkers for the same.
_OTHER_WORDS = ("ignore", "disable", "enable", "noqa", "skip", "suppress")
#: How like a known name a word behind the names is that is no word of a reason.
_LIKE = 0.8
_SHOWN, _REASON = 40, 200
#: Unknown names of a comment that are told.
_NAMED = 3
EXAMPLE = "(POLARCHECK ALLOW RAPID-IN-POLAR REASON)"


class Allow(msgspec.Struct, frozen=True):
    """
    What a comment allows. kind: of KINDS, empty for none of them. names: known rules and groups. fault: what is wrong,
    empty where nothing is.
    """

    kind: str
    names: Sequence[str] = ()
    reason: str = ""
    fault: str = ""


def grouped(groups: Mapping[str, str]) -> dict[str, frozenset[str]]:
    """The rules by what can be allowed: each by its own name, and those of a group by that. groups: group by rule."""
    found = {rule: frozenset((rule,)) for rule in groups}
    for group in sorted(set(groups.values())):
        found[group] = frozenset(rule for rule, its in groups.items() if its == group)
    return found


def read_allow(comment: str, known: Collection[str], guesses: bool = True) -> Allow:
    """
    What a comment says that begins with POLARCHECK; known: the names of rules and groups.

    guesses: whether misspelled names are compared with all others, which takes a millisecond.

    The first word behind ALLOW is a name, and each behind a comma; behind a blank only what is spelled as a rule is,
    with a hyphen: a reason may begin with the name of a group (FEED IS PROVEN), and must not silence it.
    """
    match = _COMMENT.match(comment.rstrip(" \t\r\n)"))
    word = match[1].strip("-").upper() if match else ""
    if match is None or word not in KINDS:
        is_meant = word.lower() in _OTHER_WORDS or difflib.get_close_matches(word, KINDS, 1, _LIKE)
        near = suggestion(word, KINDS) or "; did you mean ALLOW?"
        return Allow("", fault=f"POLARCHECK {shortened(word, _SHOWN)} says nothing{near}" if is_meant else "")
    names, unknown, reason = _names(match[2], known, guesses)
    if not names and not unknown and word != OFF:
        return Allow(word, fault=f"no rule is named, and there is no allow for everything: write {EXAMPLE}")
    return Allow(word, names, reason, "; ".join(_said(name, known, guesses) for name in unknown[:_NAMED]))


def _names(rest: str, known: Collection[str], guesses: bool) -> tuple[list[str], list[str], str]:
    """The known names, each once, those that are none, and the reason."""
    names: list[str] = []
    unknown: list[str] = []
    is_name = True
    while True:
        match = _NAME.match(rest)
        # What a cut has left of POLAR-NEVER-LEFT must not become the group POLAR: the hyphen at its end stays.
        name = match[0].lower().replace("_", "-") if match else ""
        if not is_name and not ("-" in name and (name in known or _is_like(name, known, guesses))):
            break
        if match is None:
            unknown += [""] if names or unknown else []
            break
        (names if name in known else unknown).append(name)
        rest = rest[match.end() :].lstrip()
        is_name = rest.startswith(",")
        rest = rest.lstrip(" \t,")
    return list(dict.fromkeys(names)), list(dict.fromkeys(unknown)), _reason(rest)


def _reason(text: str) -> str:
    return shortened(" ".join(text.lstrip(" \t:;,.-=").split()), _REASON)


def _is_like(name: str, known: Collection[str], guesses: bool) -> bool:
    """A name that is cut off or misspelled."""
    if any(one.startswith(name) for one in known):
        return True
    return guesses and bool(difflib.get_close_matches(name, known, 1, _LIKE))


def _said(name: str, known: Collection[str], guesses: bool) -> str:
    if not name:
        return "a name is missing behind the comma: only names stand between commas"
    if name == "all":
        return f"there is no allow for everything: name the rules, as in {EXAMPLE}"
    near = suggestion(name, [one.upper() for one in known]) if guesses else ""
    near = near or "; `polarcheck rules` lists them"
    return f"there is no rule or group {shortened(name.upper(), _SHOWN)}{near}"
