"""
Rename N numbers, labels, variables and programs.

What would make the program another one is refused, with the reason: a name that is there already, a jump or a variable
whose number is computed, a number that its word cannot hold.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from lsprotocol import types

from polarcheck.editor.structure.document import Document
from polarcheck.editor.structure.mention import Into, Kind, Mention, Role
from polarcheck.editor.structure.reference_search import by_document
from polarcheck.editor.structure.uses import Owner, Use, Uses
from polarcheck.editor.structure.workspace import Workspace
from polarcheck.foundation.errors import PolarcheckError
from polarcheck.program.execution.macro import ARGUMENTS, VariableKind
from polarcheck.program.execution.macro_tokens import in_capitals
from polarcheck.program.execution.task_tokens import SEQUENCE_NAME
from polarcheck.program.reading.excerpt import shortened, visible

#: The longest new name that a message shows [characters].
_SHOWN = 40
#: A number with or without its letter, a label of a user task, and any other name.
_TYPED = re.compile(r"(N|#|O|R|VC?)?\s{0,4}([0-9]{1,8})", re.IGNORECASE | re.ASCII)
_NAME = re.compile(r"[A-Z_][A-Z_][A-Z0-9_]{0,30}", re.IGNORECASE | re.ASCII)
_KINDS = {
    VariableKind.LOCAL: "local",
    VariableKind.COMMON: "common",
    VariableKind.RETAINED: "retained",
    VariableKind.SYSTEM: "system",
    VariableKind.CLOCK: "system",
    VariableKind.READ_ONLY: "system",
    VariableKind.VACANT: "always vacant",
}


class RenameError(PolarcheckError):
    """A name that cannot be changed, or not to this one: the reason in one line."""


def prepare(
    document: Document, position: types.Position, workspace: Workspace
) -> types.PrepareRenamePlaceholder | None:
    """Return the characters that a rename replaces; None where nothing has a name. Raises RenameError."""
    uses = Uses(document, workspace)
    use = uses.at(document.text.character_of(position))
    if use is None:
        return None
    _refuse_system(uses, use)
    mention = use.mention
    return types.PrepareRenamePlaceholder(document.range(mention.start, mention.end), mention.written)


def rename(
    document: Document, position: types.Position, new_name: str, workspace: Workspace
) -> dict[str, list[types.TextEdit]]:
    """Return the edits of a rename by the URI of their document. Raises RenameError."""
    uses = Uses(document, workspace)
    use = uses.at(document.text.character_of(position))
    if use is None:
        raise RenameError("there is no N number, label, variable or program here")
    _refuse_system(uses, use)
    renaming = _Renaming(uses, use, new_name.strip())
    edits = renaming.edits()
    if not workspace.is_complete and use.mention.kind in (Kind.PROGRAM, Kind.VARIABLE):
        raise RenameError("not all files of the workspace could be looked at: open a smaller folder")
    return edits


def _refuse_system(uses: Uses, use: Use) -> None:
    if use.mention.kind is not Kind.VARIABLE:
        return
    kind = uses.kind_of(use)
    if kind not in (VariableKind.LOCAL, VariableKind.COMMON, VariableKind.RETAINED):
        reason = _KINDS.get(kind, "the control has none of this number")
        raise RenameError(f"{use.mention.shown} is no variable of programs: {reason}")


class _Renaming:
    """One rename; new: the name as the user has typed it."""

    def __init__(self, uses: Uses, use: Use, new: str) -> None:
        self.uses, self.use, self.mention, self.new = uses, use, use.mention, new

    def edits(self) -> dict[str, list[types.TextEdit]]:
        """Check the new name, and return the edits."""
        key = {
            Kind.SEQUENCE: self._number,
            Kind.LABEL: self._label,
            Kind.VARIABLE: self._variable,
            Kind.PROGRAM: self._program,
        }[self.mention.kind]()
        if key in self.mention.keys and self.mention.kind is not Kind.PROGRAM:
            return {}
        same = self.uses.same(self.use)
        if self.mention.kind is not Kind.PROGRAM or key not in self.mention.keys:
            self._check(key, same)
        return {
            uri: [
                types.TextEdit(
                    user.owner.document.range(user.mention.start, user.mention.end), self._written(user, key)
                )
                for user in of_document
            ]
            for uri, of_document in by_document(same).items()
        }

    # ---- the new name ----

    def _wrong(self, expected: str) -> RenameError:
        return RenameError(f"{visible(shortened(self.new, _SHOWN))!r}: expected {expected}")

    def _digits(self, letters: str, example: str) -> int:
        match = _TYPED.fullmatch(self.new)
        if match is None or (match[1] or letters).upper() != letters:
            raise self._wrong(f"a number of up to eight digits, as {example}")
        return int(match[2])

    def _number(self) -> int | str:
        return self._digits("N", "N100")

    def _label(self) -> int | str:
        is_task = self.use.owner.mentions.listing.macro.language == "user-task"
        if not (SEQUENCE_NAME if is_task else _NAME).fullmatch(in_capitals(self.new)):
            raise self._wrong("N and up to four letters and digits, as NLAP1" if is_task else "a name, as ENDE")
        return self.new.upper()

    def _variable(self) -> int | str:
        name = self.mention.name
        if isinstance(name, int):
            return self._digits("#", "#100")
        numbered = re.fullmatch(r"(R|VC?)\d+", name)
        if numbered:
            return f"{numbered[1]}{self._digits(numbered[1], name)}"
        if not _NAME.fullmatch(self.new):
            raise self._wrong("a name that begins with two letters, as WIDTH")
        return self.new.upper()

    def _program(self) -> int | str:
        if isinstance(self.mention.name, int):
            number = self._digits("O", "O1234")
            if number == 0:
                raise self._wrong("a number from 1 on, as O1234")
            return number
        if not re.fullmatch(r"[A-Z_][A-Z0-9_+.-]{1,30}", self.new.strip("<>"), re.IGNORECASE | re.ASCII):
            raise self._wrong("a name of letters and digits, as FLANGE")
        return self.new.strip("<>").upper()

    # ---- what stands against it ----

    def _check(self, key: int | str, same: list[Use]) -> None:
        check = {
            Kind.SEQUENCE: self._check_number,
            Kind.LABEL: self._check_there,
            Kind.VARIABLE: self._check_variable,
            Kind.PROGRAM: self._check_program,
        }[self.mention.kind]
        check(key, same)

    def _line(self, owner: Owner, block: int) -> str:
        """Return a place as messages name it: line 5, or line 5 of O2.NC."""
        line = int(owner.mentions.listing.text.blocks.line[block])
        inside = owner.document is self.uses.document
        return f"line {line}" if inside else f"line {line} of {visible(owner.document.path.name)}"

    def _renamed(self, key: int | str) -> Mention:
        return self.mention._replace(keys=(key,))

    def _refuse_computed(self, owners: Iterable[Owner], kind: Kind, what: str, into: Into = Into.OWN) -> None:
        for owner in owners:
            for computed in owner.mentions.computed:
                inside = owner.program.first <= computed.block < owner.program.end
                if computed.kind is kind and computed.into is into and inside:
                    raise RenameError(f"{self._line(owner, computed.block)} {what}: it may be {self.mention.shown}")

    def _check_there(self, key: int | str, same: list[Use]) -> None:
        owners = {mention.owner.key: mention.owner for mention in same}
        for owner in owners.values():
            for mention in owner.all:
                if mention.kind is self.mention.kind and key in mention.keys:
                    text = self._renamed(key).shown
                    raise RenameError(f"{text} is there already, in {self._line(owner, mention.block)}")

    def _check_number(self, key: int | str, same: list[Use]) -> None:
        targets = self.uses.targets(self.use)
        what = "computes the number that it goes to"
        self._refuse_computed(targets, Kind.SEQUENCE, what)
        for target in targets:
            self._refuse_computed(self.uses.callees(target), Kind.SEQUENCE, what, Into.CALLER)
            self._refuse_computed(self.uses.callers(target), Kind.SEQUENCE, what, Into.CALLED)
        self._check_there(key, [Use(target, self.mention) for target in targets])
        keys = {target.key for target in targets}
        for user in same:
            if user.mention.into is not Into.OWN:
                rivals = [target for target in self.uses.targets(user) if target.key not in keys]
                if rivals:
                    location = self._line(user.owner, user.mention.block)
                    elsewhere = self._line(rivals[0], rivals[0].program.first)
                    raise RenameError(f"{location} means N{self.mention.name} of the program in {elsewhere}, too")

    def _check_variable(self, key: int | str, same: list[Use]) -> None:
        scope = self.uses.scope(self.use)
        self._refuse_computed(scope, Kind.VARIABLE, "computes the number of a variable")
        before = self.uses.kind_of(self.use)
        after = self.use.owner.mentions.variable_kind(self._renamed(key))
        if after is not before:
            text, kind = self._renamed(key).shown, _KINDS.get(after, "none of this control")
            raise RenameError(f"{self.mention.shown} is {_KINDS[before]}, {text} is {kind}")
        hidden = self.uses.scope(Use(self.use.owner, self._renamed(key)))
        self._check_there(key, [Use(owner, self.mention) for owner in (*scope, *hidden)])
        if before is VariableKind.LOCAL and isinstance(key, int):
            self._check_arguments(scope, key)

    def _check_arguments(self, scope: list[Owner], key: int) -> None:
        """Refuse variables that a macro call gives a value by an address."""
        letters = {number: letter for letter, number in ARGUMENTS.items()}
        for owner in scope:
            for call in self.uses.calls_of([owner]):
                macro = call.owner.mentions.listing.macro
                if call.mention.code not in macro.macro_call_codes:
                    continue
                statement = call.owner.mentions.listing.statement(call.mention.block)
                addresses = {word.address for word in statement.words}
                for number in (int(self.mention.name), key):
                    letter = letters.get(number)
                    repeats = number > max(ARGUMENTS.values()) or (letter or "") in "IJK"
                    if letter in addresses or (repeats and addresses & set("IJK")):
                        location = self._line(call.owner, call.mention.block)
                        value = f"#{number} its value by {letter or 'I, J, K'}"
                        raise RenameError(f"{location} gives {value}: change the call first")

    def _check_program(self, key: int | str, users: list[Use]) -> None:
        probe = self._renamed(key)
        for owner in self.uses.defining(key):
            raise RenameError(f"{probe.shown} is there already, in {self._line(owner, owner.program.first)}")
        self._refuse_computed(self.uses.owners(self.uses.document), Kind.PROGRAM, "computes the program that it calls")
        same = {owner.key: owner for name in self.mention.keys for owner in self.uses.defining(name)}
        if len(same) > 1:
            second = list(same.values())[1]
            location = self._line(second, second.program.first)
            raise RenameError(f"{self.mention.shown} is in {location}, too: it is not known which of them is called")
        for user in users:
            width = len(str(key))
            is_call = user.mention.role is Role.REFERS and isinstance(key, int)
            macro = user.owner.mentions.listing.macro
            if is_call and macro.repeats_in_p and user.mention.code in macro.subprogram_calls and width > 4:
                location = self._line(user.owner, user.mention.block)
                raise RenameError(
                    f"{location}: P has the repeats before the last four digits, so expected four at most"
                )

    # ---- as it is written ----

    def _written(self, use: Use, key: int | str) -> str:
        """Return the new name as a place writes it: with as many digits where it has zeros before it."""
        mention = use.mention
        if isinstance(key, str):
            match = re.fullmatch(r"(R|VC?)(\d+)", key)
            return key if match and not mention.written.isdigit() else self.new.strip("<>")
        digits = re.search(r"\d+", mention.written)
        written = digits[0] if digits else ""
        width = 4 if mention.has_repeats else len(written) if written.startswith("0") else 0
        number = f"{key:0{width}d}" if width else str(key)
        return f"#{number}" if mention.kind is Kind.VARIABLE else number
