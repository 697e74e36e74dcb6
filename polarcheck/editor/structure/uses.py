"""Which mentions name the same: by program, by calls between programs, over files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from lsprotocol import types

from polarcheck.editor.structure.document import Document
from polarcheck.editor.structure.mention import Into, Kind, Mention, Role
from polarcheck.editor.structure.mentions import Mentions, mentions_of
from polarcheck.editor.structure.workspace import Workspace, naming, writing
from polarcheck.program.execution.macro import VariableKind
from polarcheck.program.execution.programs import Program, ProgramName

#: Variables that every program shares: beside those that call each other, all of the workspace count.
_SHARED = (VariableKind.RETAINED, VariableKind.SYSTEM, VariableKind.CLOCK, VariableKind.READ_ONLY)
#: The most programs that are followed along their calls.
_MOST = 500


class Owner(NamedTuple):
    """A program of a document; first: its first block."""

    document: Document
    mentions: Mentions
    program: Program

    @property
    def key(self) -> tuple[str, str, int]:
        """What tells it from others."""
        return self.document.uri, self.mentions.listing.text.source.channel, self.program.first

    @property
    def all(self) -> list[Mention]:
        """Its mentions."""
        return self.mentions.of_program(self.program)

    @property
    def calls(self) -> list[Mention]:
        """Those that call a program."""
        return [mention for mention in self.all if mention.kind is Kind.PROGRAM and mention.role is Role.REFERS]


class Use(NamedTuple):
    """A mention of a document."""

    owner: Owner
    mention: Mention

    @property
    def key(self) -> tuple[str, int, int]:
        """What tells it from others; channels share what stands before them."""
        return self.owner.document.uri, self.mention.start, self.mention.end


class Uses:
    """The names of a document and of the files around it; made for one request."""

    def __init__(self, document: Document, workspace: Workspace) -> None:
        self.document, self.workspace = document, workspace
        self._resolved: dict[tuple[str, str, ProgramName], list[Owner]] = {}
        self._callers: dict[tuple[str, str, int], list[Owner]] = {}

    def owners(self, document: Document) -> list[Owner]:
        """Return the programs of a document."""
        return document.cached(
            "owners",
            lambda: [
                Owner(document, mentions, program)
                for mentions in mentions_of(document)
                for program in mentions.listing.programs.programs
            ],
        )

    def _named(self, document: Document, called: ProgramName) -> list[Owner]:
        """Return the programs of a document that have one of the names of a call."""
        return [
            Owner(document, mentions, program)
            for mentions in mentions_of(document)
            for program in mentions.listing.programs.named(called)
        ]

    def _calls(self, document: Document) -> list[Use]:
        """Return the calls of a document."""
        return document.cached(
            "calls",
            lambda: [Use(owner, mention) for owner in self.owners(document) for mention in owner.calls],
        )

    def owners_at(self, position: types.Position) -> list[Owner]:
        """Return the programs at a position of the document, that of the first channel first."""
        return [
            owner
            for owner in self.owners(self.document)
            for listing, block in self.document.at(position)
            if owner.mentions.listing is listing and owner.program.first <= block < owner.program.end
        ]

    def at(self, character: int) -> Use | None:
        """Return the mention at a character of the document; of several channels the first that has one."""
        for mentions in mentions_of(self.document):
            mention = mentions.at(character)
            if mention is not None:
                program = mentions.listing.programs.around(mention.block)
                return Use(Owner(self.document, mentions, program), mention)
        return None

    def same(self, use: Use) -> list[Use]:
        """Return all mentions that name the same, in the order of the files."""
        find = {
            Kind.SEQUENCE: self._numbers,
            Kind.LABEL: self._in_program,
            Kind.VARIABLE: self._variables,
            Kind.PROGRAM: self._programs,
        }[use.mention.kind]
        by_key = {same.key: same for same in find(use)}
        return [by_key[key] for key in sorted(by_key, key=lambda key: (key[0] != self.document.uri, key))]

    # ---- N numbers and labels ----

    def _in_program(self, use: Use) -> Iterator[Use]:
        yield from _with_keys([use.owner], use.mention)

    def targets(self, use: Use) -> list[Owner]:
        """Return the programs in which the N number of a mention stands, or should stand."""
        mention, owner = use.mention, use.owner
        if mention.into is Into.CALLED and mention.called is not None:
            return self.resolved(owner, mention.called)
        if mention.into is Into.CALLER:
            callers = [caller for caller in self.callers(owner) if _defines(caller, mention)]
            return callers or [owner]
        return [owner]

    def _numbers(self, use: Use) -> Iterator[Use]:
        for target in self.targets(use):
            yield from (user for user in _with_keys([target], use.mention) if user.mention.into is Into.OWN)
            for called in self.callees(target):
                for user in _with_keys([called], use.mention):
                    if user.mention.into is Into.CALLER:
                        yield user
            if target.mentions.listing.macro.sequence_word:
                for caller in self.callers(target):
                    for user in _with_keys([caller], use.mention):
                        if user.mention.into is Into.CALLED and target.key in {t.key for t in self.targets(user)}:
                            yield user
            if not self.callers(target):
                # M99 P in a main program goes to a block of its own.
                yield from (user for user in _with_keys([target], use.mention) if user.mention.into is Into.CALLER)
        yield use

    # ---- calls ----

    def resolved(self, caller: Owner, called: ProgramName) -> list[Owner]:
        """Return the programs that a call can mean: of its file, of the folders of subprograms, of the workspace."""
        key = caller.document.uri, caller.mentions.listing.text.source.channel, called
        if key not in self._resolved:
            self._resolved[key] = self._resolve(caller, called)
        return self._resolved[key]

    def _resolve(self, caller: Owner, called: ProgramName) -> list[Owner]:
        of_document = self._named(caller.document, called)
        same_channel = [owner for owner in of_document if owner.mentions is caller.mentions]
        if of_document:
            return same_channel or of_document
        places = self.workspace.called, self._naming_in, self.workspace.of_file_name
        for documents in (search(caller.document, called) for search in places):
            # A file that names no program of that name is that program from its head on.
            resolved = [
                owner for document in documents for owner in self._named(document, called) or self.owners(document)[:1]
            ]
            if resolved:
                return resolved
        return []

    def _naming_in(self, caller: Document, called: ProgramName) -> Iterator[Document]:
        return self._naming(called.keys)

    def _naming(self, keys: Sequence[int | str]) -> Iterator[Document]:
        return (
            document
            for document in self.workspace.matching(naming(keys))
            if any(owner.program.has_head and set(owner.program.keys) & set(keys) for owner in self.owners(document))
        )

    def defining(self, key: int | str) -> list[Owner]:
        """Return the programs of a number or name in the document and the workspace."""
        keys = ProgramName(key, None).keys if isinstance(key, int) else ProgramName(None, key).keys
        return [
            owner
            for document in [self.document, *self._naming(keys)]
            for owner in self.owners(document)
            if set(owner.program.keys) & set(keys)
        ]

    def callees(self, owner: Owner) -> list[Owner]:
        """Return the programs that a program calls."""
        names = {mention.keys: called_name(mention) for mention in owner.calls}
        return _once(callee for called in names.values() for callee in self.resolved(owner, called))

    def callers(self, owner: Owner) -> list[Owner]:
        """Return the programs that call a program."""
        if owner.key not in self._callers:
            self._callers[owner.key] = _once(use.owner for use in self.calls_of([owner]))
        return self._callers[owner.key]

    def calls_of(self, called: Sequence[Owner]) -> list[Use]:
        """Return the calls of programs."""
        keys = list(dict.fromkeys(key for owner in called for key in _keys(owner)))
        called_keys = {owner.key for owner in called}
        if not keys:
            return []
        return [
            use
            for document in self.workspace.matching(naming(keys))
            for use in self._calls(document)
            if set(use.mention.keys) & set(keys)
            if called_keys & {callee.key for callee in self.resolved(use.owner, called_name(use.mention))}
        ]

    def _programs(self, use: Use) -> Iterator[Use]:
        targets = (
            [use.owner] if use.mention.role is Role.DEFINES else self.resolved(use.owner, called_name(use.mention))
        )
        for owner in targets:
            for mention in owner.all:
                if mention.role is Role.DEFINES and mention.kind is Kind.PROGRAM:
                    yield Use(owner, mention)
        yield from self.calls_of(targets)
        if not targets:  # a program that nobody knows: its calls
            yield from (
                Use(owner, mention)
                for document in self.workspace.matching(naming(use.mention.keys))
                for owner in self.owners(document)
                for mention in owner.all
                if mention.kind is Kind.PROGRAM and set(mention.keys) & set(use.mention.keys)
            )

    # ---- variables ----

    def kind_of(self, use: Use) -> VariableKind:
        """Return the kind of the variable of a mention."""
        return use.owner.mentions.variable_kind(use.mention)

    def scope(self, use: Use) -> list[Owner]:
        """
        Return the programs that share a variable.

        A local one is shared with programs that M98 calls, which get no variables of their own; a common one with all
        that call each other; one that outlives the power-off with all of the workspace.
        """
        kind = self.kind_of(use)
        if kind in _SHARED:
            pattern = writing(use.mention.name)
            return [owner for document in self.workspace.matching(pattern) for owner in self.owners(document)]
        is_local = kind is VariableKind.LOCAL
        if is_local and use.owner.mentions.listing.macro.language != "custom-macro":
            return [use.owner]
        return self._connected(use.owner, subprograms_only=is_local)

    def _connected(self, owner: Owner, *, subprograms_only: bool) -> list[Owner]:
        connected = {owner.key: owner}
        stack = [owner]
        while stack and len(connected) < _MOST and self.workspace.has_time():
            last = stack.pop()
            codes = set(last.mentions.listing.macro.subprogram_calls)
            calls = [mention for mention in last.calls if not subprograms_only or mention.code in codes]
            near = [called for mention in calls for called in self.resolved(last, called_name(mention))]
            near += [
                use.owner
                for use in self.calls_of([last])
                if not subprograms_only or use.mention.code in use.owner.mentions.listing.macro.subprogram_calls
            ]
            for neighbor in near:
                if neighbor.key not in connected:
                    connected[neighbor.key] = neighbor
                    stack.append(neighbor)
        return list(connected.values())

    def _variables(self, use: Use) -> Iterator[Use]:
        yield from _with_keys(self.scope(use), use.mention)


def _with_keys(owners: Iterable[Owner], pattern: Mention) -> Iterator[Use]:
    """Yield the mentions of the same kind and name in programs."""
    for owner in owners:
        for mention in owner.all:
            if mention.kind is pattern.kind and mention.keys == pattern.keys:
                yield Use(owner, mention)


def _defines(owner: Owner, pattern: Mention) -> bool:
    return any(user.mention.role is Role.DEFINES for user in _with_keys([owner], pattern))


def called_name(mention: Mention) -> ProgramName:
    """Return the name by which a block calls a program."""
    name = mention.name
    return (
        ProgramName(name, None)
        if isinstance(name, int) and len(mention.keys) == 1
        else ProgramName(None, str(mention.keys[0]))
    )


def _keys(owner: Owner) -> list[int | str]:
    """Return what a program is called by; one without a head by the name of its file."""
    if owner.program.keys or owner.program.has_head:
        keys = list(owner.program.keys)
        return [*keys, *(f"O{key}" for key in keys if isinstance(key, int))]
    stem = owner.document.path.stem.upper()
    digits = re.fullmatch(r"O?0*(\d{1,8})", stem)
    return [int(digits[1])] if digits else [stem]


def _once(owners: Iterable[Owner]) -> list[Owner]:
    return list({owner.key: owner for owner in owners}.values())
