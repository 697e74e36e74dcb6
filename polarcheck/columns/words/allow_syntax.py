"""The syntax of an allow comment: its kind, the rules it names, the reason. It accepts any text, hostile or cut off."""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Mapping, Sequence

import msgspec

from polarcheck.foundation.errors import suggestion
from polarcheck.program.reading.excerpt import shortened

ALLOW, FILE, ON, OFF = "ALLOW", "ALLOW-FILE", "ALLOW-ON", "ALLOW-OFF"
KINDS = (ALLOW, FILE, ON, OFF)
#: The word behind POLARCHECK, and the rest; a colon is tolerated, though controls read it as O.
_COMMENT = re.compile(r"[^A-Za-z0-9]*POLARCHECK[\s:]*([A-Za-z-]*)[\s:,]*(.*)", re.IGNORECASE | re.DOTALL)
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")
#: Words with which other linters suppress a finding.
_OTHER_WORDS = ("ignore", "disable", "enable", "noqa", "skip", "suppress")
#: Similarity (difflib ratio) from which a word is a misspelled rule name and not part of the reason.
_LIKE = 0.8
#: Longest name and reason in a message [characters].
_SHOWN, _REASON = 40, 200
#: Unknown names of one comment that its fault lists.
_MOST_UNKNOWN = 3
EXAMPLE = "(POLARCHECK ALLOW RAPID-IN-POLAR REASON)"


class Allow(msgspec.Struct, frozen=True):
    """
    A parsed allow comment.

    kind: one of KINDS; empty if the comment is none of them.
    names: the known rules and groups.
    reason: the text behind the names.
    fault: what is wrong with the comment; empty if nothing is.
    """

    kind: str
    names: Sequence[str] = ()
    reason: str = ""
    fault: str = ""


def grouped(groups: Mapping[str, str]) -> dict[str, frozenset[str]]:
    """The rules that each name stands for: a rule for itself, a group for all of its rules. groups: group by rule."""
    rules_of = {rule: frozenset((rule,)) for rule in groups}
    for group in sorted(set(groups.values())):
        rules_of[group] = frozenset(rule for rule, group_of_rule in groups.items() if group_of_rule == group)
    return rules_of


def read_allow(comment: str, known: Collection[str], guesses: bool = True) -> Allow:
    """
    Parse a comment that begins with POLARCHECK.

    known: the names of rules and groups.
    guesses: compare misspelled names with all known ones, which takes a millisecond.

    The first word behind ALLOW is a name, and so is each word behind a comma. Behind a blank only a word with a hyphen
    is a name: a reason may begin with the name of a group (FEED IS PROVEN) and must not suppress that group.
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
    return Allow(
        word, names, reason, "; ".join(_unknown_name(name, reason, known, guesses) for name in unknown[:_MOST_UNKNOWN])
    )


def _names(rest: str, known: Collection[str], guesses: bool) -> tuple[list[str], list[str], str]:
    """The known names and the unknown ones, each once, and the reason."""
    names: list[str] = []
    unknown: list[str] = []
    is_name = True
    while True:
        match = _NAME.match(rest)
        # POLAR-NEVER-LEFT may be cut off behind POLAR-: the hyphen stays, so that it does not become the group POLAR.
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
    """True for a known name that is cut off or misspelled."""
    if any(rule.startswith(name) for rule in known):
        return True
    return guesses and bool(difflib.get_close_matches(name, known, 1, _LIKE))


def _unknown_name(name: str, reason: str, known: Collection[str], guesses: bool) -> str:
    if not name:
        return "a name is missing behind the comma: only names stand between commas"
    if name == "all":
        return f"there is no allow for everything: name the rules, as in {EXAMPLE}"
    words = f"{'-'.join((name, *reason.lower().split()))}-"
    if with_blanks := max(
        (rule for rule in known if "-" in rule and words.startswith(f"{rule}-")), key=len, default=""
    ):
        return f"a name has hyphens: write {with_blanks.upper()}"
    near = suggestion(name, [rule.upper() for rule in known]) if guesses else ""
    near = near or "; `polarcheck rules` lists them"
    return f"there is no rule or group {shortened(name.upper(), _SHOWN)}{near}"
