"""The listing of a file and of the files that it calls: all that is known of their blocks before one of them runs."""

from __future__ import annotations

import bisect
import functools
from collections.abc import Iterable, Sequence

import numpy as np

from polarcheck.program.execution.arithmetic import Arithmetic
from polarcheck.program.execution.custom_macro import read_statement
from polarcheck.program.execution.macro import Variables, called_program
from polarcheck.program.execution.programs import Program, ProgramName, block_text, find_programs, first_blocks, turns
from polarcheck.program.execution.statement import Kind, Statement, Word
from polarcheck.program.execution.structures import Structures, find_loops, find_structures
from polarcheck.program.execution.variable_names import Names
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.joining import joined
from polarcheck.program.reading.words import Text

#: Bound of the words of a block, and of the steps of an expression.
_SIZE = 5_000
_COMPUTED = ProgramName(None, None)


class Listing:
    """
    The text, the programs and the statements, each read once and shared by all runs.

    files: the text of the file itself, then of each called one. text: of all, one behind the other. programs: of all.
    found: the calls for which a file was found, and its index in files. stops: the blocks at which the flow can turn.
    """

    def __init__(
        self, files: Sequence[Text], machine: Machine, found_files: dict[ProgramName, int] | None = None
    ) -> None:
        self.files = list(files)
        self.found = found_files or {}
        self.machine = machine
        self.macro = machine.macro
        self.ends = frozenset(machine.m_codes.program_end)
        self.arithmetic = Arithmetic(self.macro.signed_angles, self.macro.largest_number)
        self.text = joined(self.files)
        self.programs = find_programs(self.text)
        self.first_blocks = [*first_blocks(self.text), len(self.text.blocks)]
        self._flow_codes, self._call_codes = self.macro.flow_codes, self.macro.call_codes
        self.stops: list[int] = np.flatnonzero(turns(self.text, self._flow_codes | self.ends)).tolist()
        self.names = Names()
        self._statements: dict[int, Statement] = {}
        self._loops: dict[int, Structures] = {}
        self._lowest: dict[int, tuple[list[int], list[int]]] = {}
        self._structures: dict[int, Structures] = {}
        self._calls: dict[int, dict[ProgramName, bool]] = {}
        self._nothing_known = Variables(self.macro)
        self._nothing_known.forget()

    def with_files(self, files: dict[ProgramName, Text]) -> Listing:
        """The listing with more called files behind it, each once; what was read of the others is kept."""
        texts = [*self.files]
        index = {id(text): number for number, text in enumerate(texts)}
        indices = {}
        for called, text in files.items():
            if id(text) not in index:
                index[id(text)] = len(texts)
                texts.append(text)
            indices[called] = index[id(text)]
        grown = Listing(texts, self.machine, self.found | indices)
        grown._statements, grown._loops, grown._calls = self._statements, self._loops, self._calls
        grown.names = self.names
        return grown

    def statement(self, block: int) -> Statement:
        """The statement of a block."""
        if block not in self._statements:
            self._statements[block] = self._read_statement(block)
        return self._statements[block]

    def _read_statement(self, block: int) -> Statement:
        text, macro = block_text(self.text, block), self.macro
        read_macro = functools.partial(
            read_statement,
            calls=self._flow_codes,
            loops=macro.loop_numbers,
            levels=macro.bracket_levels,
            size=_SIZE,
            names=self.machine.control.named_axes,
        )
        if macro.language == "custom-macro" or not self.text.blocks.is_macro[block]:
            return read_macro(text)
        if macro.language == "high-level":
            from polarcheck.program.execution.high_level import read_high_level  # few files need it

            return read_high_level(text, self.machine, self.names, read_macro)
        from polarcheck.program.execution.user_task import read_user_task  # few files need it

        return read_user_task(text, self.machine, self.names)

    def turns_at(self, block: int) -> bool:
        """Return True if the flow can turn at a block."""
        index = bisect.bisect_left(self.stops, block)
        return index < len(self.stops) and self.stops[index] == block

    def macro_statements(self, program: Program) -> list[tuple[int, Statement]]:
        """The macro statements of a program with their blocks, in order."""
        low, high = (bisect.bisect_left(self.stops, block) for block in (program.first, program.end))
        is_macro = self.text.blocks.is_macro
        return [(block, self.statement(block)) for block in self.stops[low:high] if is_macro[block]]

    def runs_down(self, block: int) -> bool:
        """Return True if from a block on its program calls nothing, computes no code and jumps to blocks below it."""
        program = self.programs.around(block)
        if program.first not in self._lowest:
            self._lowest[program.first] = self._lowest_targets(program)
        stops, lowest = self._lowest[program.first]
        return lowest[bisect.bisect_left(stops, block)] > block

    def _lowest_targets(self, program: Program) -> tuple[list[int], list[int]]:
        """
        Return the last stops of a program, and the lowest block that it may go on at from each of them on.

        That is the end of the program where nothing jumps, -1 where something may lead anywhere; above the first of the
        stops something does. Of the blocks behind the last stop the end is the last number.
        """
        low, high = (bisect.bisect_left(self.stops, limit) for limit in (program.first, program.end))
        stops, lowest = [], [program.end]
        for stop in reversed(self.stops[low:high]):
            stops.append(stop)
            lowest.append(min(lowest[-1], self._lowest_target(self.statement(stop), program)))
            if lowest[-1] < 0:
                break
        return stops[::-1], lowest[::-1]

    def _lowest_target(self, statement: Statement, program: Program) -> int:
        """Return the block that a statement jumps to, the end of the program for none; -1 if it may lead anywhere."""
        parts = (*statement.more, *filter(None, (statement.then,)))
        of_parts = min((self._lowest_target(part, program) for part in parts), default=program.end)
        return min(of_parts, self._target(statement, program))

    def _target(self, statement: Statement, program: Program) -> int:
        match statement.kind:
            case Kind.GOTO | Kind.IF_GOTO:
                steps = statement.jump.steps if statement.jump is not None else ()
                blocks = self.programs.labels(program).get(statement.label, [])
                if [step.name for step in steps] == ["number"]:
                    blocks = self.programs.targets(program).get(round(steps[0].number), [])
                return blocks[0] if len(blocks) else -1
            case Kind.NC:
                codes = [word for word in statement.words if word.address in ("G", "M")]
                runs_on = not any(word.written is None or self._switches_on(word) for word in codes)
            case Kind.CALL:
                is_return = statement.call in self.macro.program_returns
                runs_on = is_return and not any(word.address == "P" for word in statement.words)
            case Kind.STRUCTURE:
                runs_on = statement.structure in ("IF", "ELSE", "ENDIF")
            case _:
                runs_on = statement.kind in (Kind.ASSIGN, Kind.OUTPUT, Kind.IF_THEN)
        return program.end if runs_on else -1

    def _switches_on(self, word: Word) -> bool:
        (step, *_) = word.value.steps
        return f"{word.address}{step.number:g}" in self.machine.polar.on

    def loops(self, program: Program) -> Structures:
        """The loops of a program."""
        if program.first not in self._loops:
            self._loops[program.first] = find_loops(self.macro_statements(program), self.macro.loop_levels)
        return self._loops[program.first]

    def structures(self, block: int) -> Structures:
        """The structures of the program in which a block stands."""
        program = self.programs.around(block)
        if program.first not in self._structures:
            self._structures[program.first] = find_structures(self.macro_statements(program))
        return self._structures[program.first]

    def procedure(self, program: Program) -> Statement | None:
        """The statement with which a program of a name begins, None where it has none."""
        index = bisect.bisect_left(self.stops, program.first)
        block = self.stops[index] if index < len(self.stops) else program.end
        if block >= program.end or not self.text.blocks.is_macro[block]:
            return None
        statement = self.statement(block)
        return statement if statement.kind is Kind.PROCEDURE else None

    def calls(self, file: int) -> tuple[ProgramName, ...]:
        """The programs that the calls of a file name literally, whether they are run or not; each once, in order."""
        return tuple(self._calls_of(file))

    def named_by(self, files: Iterable[int], *, by_number_only: bool) -> set[int | str]:
        """
        The numbers and names (Program.keys) of the programs that some of the files name literally.

        by_number_only: without those named by <NAME>, or in a block with macro.
        """
        calls = [call for file in files for call in self._calls_of(file).items()]
        chosen = [called for called, is_plain in calls if not by_number_only or (is_plain and called.name is None)]
        return {key for called in chosen for key in called.keys}

    def _calls_of(self, file: int) -> dict[ProgramName, bool]:
        """The same calls, and whether a block without macro has each."""
        if file not in self._calls:
            calls = self._calls[file] = {}
            blocks = np.flatnonzero(turns(self.files[file], self._call_codes)) + self.first_blocks[file]
            for block in blocks.tolist():
                called = self.called_in(block)
                if called is not None:
                    calls[called] = calls.get(called, False) or not self.text.blocks.is_macro[block]
        return self._calls[file]

    def computes_calls(self, file: int) -> bool:
        """Return True if a file has a call whose program is computed."""
        blocks = np.flatnonzero(turns(self.files[file], self._call_codes)) + self.first_blocks[file]
        return any(self._call_in(block) == _COMPUTED for block in blocks.tolist())

    def called_in(self, block: int) -> ProgramName | None:
        """The program that a block calls, where it names it literally."""
        called = self._call_in(block)
        return None if called == _COMPUTED else called

    def _call_in(self, block: int) -> ProgramName | None:
        """The program that a block calls, of which number and name may be computed; None without a call."""
        statement = self.statement(block)
        parts = (statement if statement.then is None else statement.then, *statement.more)
        call = next((part for part in parts if part.call in self._call_codes), None)
        if call is None:
            return None
        return called_program(call, self._nothing_known, self.macro, self.arithmetic).program
