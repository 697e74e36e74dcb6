"""How bad a finding is: the numbers that can grow worse, and what is worse now than a baseline knows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from msgspec import UnsetType

from polarcheck.files.baselines.baseline_file import Entry, Location
from polarcheck.foundation.errors import counted
from polarcheck.foundation.finding import FASTEST, FASTEST_PER_REVOLUTION, LOWEST_Z, SEVERITIES, Finding, Outline
from polarcheck.rules.rule import Rule, load_all

#: A number that has grown by no more is the same: neighbouring blocks change a distance by what a post rounds.
_SHARE = 0.02
#: The same of small numbers, the last digit that messages show of a length [mm, deg, deg/min].
_ROUNDING = 0.001
#: The same of Z, which is no size but counts from an origin: the last digit of an inch program [mm].
_ROUNDING_OF_Z = 0.003
#: Before the name of a number of which less is worse, and between two names whose distance counts (Rule.worse).
LESS, _FROM = "-", ":"
#: The numbers of rules that are `gouges`, with the same sign.
_OF_CUTS = (f"{LESS}{LOWEST_Z}", FASTEST, FASTEST_PER_REVOLUTION)
#: The last words of a name in messages.
_WORDS = {"z": "Z", LOWEST_Z: "Z", FASTEST: "F", FASTEST_PER_REVOLUTION: "F per revolution"}


def values_of(finding: Finding, outline: Outline | UnsetType) -> dict[str, float]:
    """Return the numbers of a finding that can grow worse; those of findings that follow behind their rule."""
    return {name: value for name, value in _numbers(finding, outline).items() if value is not None}


def _numbers(finding: Finding, outline: Outline | UnsetType) -> dict[str, float | None]:
    rules = load_all()
    values = dict(_of_rule(finding, outline, rules))
    for follower in finding.follows:
        for name, value in _of_rule(follower, outline, rules):
            whole = f"{follower.rule}.{name}"
            if whole not in values or _is_worse(_signed(whole, finding), values[whole], value, 0, 0):
                values[whole] = value
    return values


def blocks_of(finding: Finding) -> int:
    """Return how many blocks a finding stands for; 0 where its count is of repeats of one block."""
    rule = load_all().get(finding.rule)
    return finding.count if rule is not None and rule.once else 0


def growth(entry: Entry, location: Location, finding: Finding, outline: Outline | UnsetType) -> list[str]:
    """Return in words what of a known finding is worse now; empty if nothing is."""
    return [*dict.fromkeys((*_of_kind(entry, finding), *_of_numbers(location, finding, outline)))]


def _of_kind(entry: Entry, finding: Finding) -> Iterator[str]:
    if SEVERITIES[finding.severity] > SEVERITIES[entry.severity]:
        yield f"known as {entry.severity}, now {finding.severity}"
    new = {follower.rule for follower in finding.follows} - {*entry.follows}
    if new:
        yield f"now with {', '.join(sorted(new))}"


def _of_numbers(location: Location, finding: Finding, outline: Outline | UnsetType) -> Iterator[str]:
    blocks = blocks_of(finding)
    if location.blocks and blocks > location.blocks:
        yield f"known in {counted(location.blocks, 'block')}, now in {blocks}"
    now = _numbers(finding, outline)
    for name, value in location.values.items():
        if name not in now:
            continue
        rule, _, last = name.rpartition(".")
        is_z = last == LOWEST_Z
        signed = _signed(name, finding)
        if _is_worse(signed, value, now[name], 0 if is_z else _SHARE, _ROUNDING_OF_Z if is_z else _ROUNDING):
            words = _WORDS.get(last, last.replace("_", " ").replace(_FROM, " off "))
            words = f"{rule}.{words}" if rule else words
            yield f"known with {words}{' by' * (_FROM in name)} {_quantity(value)}, now {_quantity(now[name])}"


def _of_rule(
    finding: Finding, outline: Outline | UnsetType, rules: Mapping[str, Rule]
) -> Iterator[tuple[str, float | None]]:
    """Yield the numbers with which a finding of its rule grows worse; without a value where it is not known."""
    rule = rules.get(finding.rule)
    for signed in rule.worse if rule is not None else ():
        name = signed.removeprefix(LESS)
        values = [finding.values.get(part) for part in name.split(_FROM)]
        numbers = [value for value in values if isinstance(value, int | float)]
        if len(numbers) < len(values):
            yield name, None
        else:
            yield name, numbers[0] if len(numbers) == 1 else abs(numbers[0] - numbers[1])
    if rule is not None and rule.gouges and isinstance(outline, Outline):
        cuts = outline.cuts.get(Outline.key(finding), {})
        for signed in _OF_CUTS:
            name = signed.removeprefix(LESS)
            yield name, cuts.get(name)


def _signed(name: str, finding: Finding) -> str:
    """Return a name with the sign that its rule gives it."""
    rule, _, last = name.rpartition(".")
    signed: Iterable[str] = (*load_all()[rule or finding.rule].worse, *_OF_CUTS)
    return f"{LESS}{last}" if f"{LESS}{last}" in signed else last


def _is_worse(signed: str, before: float | None, now: float | None, share: float, rounding: float) -> bool:
    """Return True for a number that is worse by more than the tolerance, which counts do not have; None is worst."""
    if before is None or now is None:
        return before is not None
    if isinstance(now, int):
        share = 0
    grown = before - now if signed.startswith(LESS) else now - before
    return grown > share * abs(before) + rounding


def _quantity(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3f}".rstrip("0").rstrip(".")
