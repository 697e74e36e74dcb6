"""The rules of a long program in turn: a table is forgotten behind its last reader, which bounds memory."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from polarcheck.checking.engine import Engine
from polarcheck.rules.rule import Rule
from polarcheck.rules.tables import TABLES, made_from

#: The tables that what a report says beside its findings is read from.
READ: dict[str, tuple[str, ...]] = {
    "sections": ("dynamics", "center", "ramps"),
    "stock": ("bar",),
    "less_regular": ("regularity",),
    "unexecuted": ("bar", "infeed", "mode_words", "other_mode", "unknown_words"),
}


def read_in_turn(engine: Engine, missing: Callable[[Rule], object], read: Callable[[str], object]) -> None:
    """
    Run the rules in the order of their tables, and forget each table behind its last reader.

    The tables of executed blocks stay, and those of rules that fire, which findings read. What is read again in spite
    of that, as by a picture of the program, is made again.

    missing: asks what a rule could not evaluate. read: reads one of READ.
    """
    parameters = {rule: engine.rules[rule].parameters for rule in engine.rules} | READ
    reads = {reader: frozenset[str]().union(*map(made_from, names)) for reader, names in parameters.items()}
    number = {name: number for number, name in enumerate(TABLES)}
    remaining = Counter(name for names in reads.values() for name in names)
    stays = set(made_from("trace"))
    last_table = {reader: max(map(number.__getitem__, names), default=-1) for reader, names in reads.items()}
    for reader in sorted(reads, key=last_table.__getitem__):
        if last_table[reader] >= number["tool_center"]:
            # From here on positions are read, and hardly any word.
            engine.tables["blocks"].forget("word")
            engine.tables["lengths"].forget("length")
        if reader in READ:
            read(reader)
        else:
            rule = engine.rules[reader]
            missing(rule)
            if engine.hits(rule).mask.any():
                stays |= reads[reader]
        remaining.subtract(reads[reader])
        for name in reads[reader] - stays:
            if not remaining[name]:
                engine.tables.forget(name)
