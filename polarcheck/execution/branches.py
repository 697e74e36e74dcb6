"""What an execution does at structures (IF .. ELSE .. ENDIF, FOR, LOOP) and at parts of a program that run again."""

from __future__ import annotations

from polarcheck.arrays import Mask
from polarcheck.execution.calls import Calls
from polarcheck.execution.expression import Expression, decide, evaluate
from polarcheck.execution.programs import Program, Search
from polarcheck.execution.statement import Statement
from polarcheck.execution.structures import Structures


class Branches(Calls):
    """The attributes are those of execute.Execution."""

    visited: Mask

    def structure(self, statement: Statement, block: int) -> int:
        """A statement that begins, parts or ends a structure; gives the block to go on with."""
        found = self.listing.structures(block)
        match statement.structure:
            case "IF":
                if self.decided(statement.condition, block):
                    return block + 1
                return self.behind(found.other.get(block, found.end.get(block, block)))
            case "ELSE":
                return self.behind(found.end.get(block, block))
            case "WHILE":
                if self.is_unknown(statement.condition):
                    self.remark("condition-unknown", block)
                    return block + 1  # run once
                is_on = self.decided(statement.condition, block)
                return block + 1 if is_on else self.behind(found.end.get(block, block))
            case "FOR":
                self.count(statement, on=False)
                is_on = self.goes_round(statement, block)
                return block + 1 if is_on else self.behind(found.end.get(block, block))
            case "ENDWHILE" | "ENDFOR" | "ENDLOOP" | "UNTIL":
                return self.end_of_loop(statement, block, found)
        return block + 1

    def behind(self, block: int) -> int:
        """The block behind a keyword that is reached without the blocks before it."""
        self.visited[block] = True
        return block + 1

    def end_of_loop(self, statement: Statement, block: int, found: Structures) -> int:
        """Back to the head of a loop, or on behind its end."""
        head = found.head.get(block)
        if head is None:
            return block + 1
        begin = self.listing.statement(head)
        if statement.structure == "UNTIL" and (
            self.decided(statement.condition, block) or self.is_unknown(statement.condition)
        ):
            return block + 1
        if begin.structure == "FOR":
            self.count(begin, on=True)
            if not self.goes_round(begin, block):
                return block + 1
        if begin.structure == "WHILE":
            if self.is_unknown(begin.condition):
                return block + 1
            self.goes_back(block)
            return head
        self.goes_back(block)
        return head + 1

    def is_unknown(self, condition: Expression | None) -> bool:
        """Whether nobody knows if a condition holds, or it could not be read."""
        return condition is None or decide(condition, self.variables, self.listing.arithmetic)[0] is None

    def decided(self, condition: Expression | None, block: int) -> bool:
        """Whether a condition holds; an unknown one counts as not, and is said."""
        if condition is None:
            return False
        result, fault = decide(condition, self.variables, self.listing.arithmetic)
        self.found(fault, block)
        if result is None:
            self.remark("condition-unknown", block)
        return bool(result)

    def goes_round(self, statement: Statement, block: int) -> bool:
        """Whether a FOR runs its blocks; where its limits are not known, once."""
        if not self.is_unknown(statement.condition):
            return self.decided(statement.condition, block)
        self.remark("condition-unknown", block)
        return statement.structure == "FOR" and self.listing.statement(block) is statement

    def count(self, statement: Statement, *, on: bool) -> None:
        """The variable of a FOR takes its first value, or goes on to the next one."""
        arithmetic = self.listing.arithmetic
        if statement.target is None or statement.value is None:
            return
        number, _ = evaluate(statement.target, self.variables, arithmetic)
        if number is None or not self.variables.exists(number):
            return
        value = self.variables.value(number) if on else evaluate(statement.value, self.variables, arithmetic)[0]
        self.variables.write(number, (value or 0.0) + on)
        self.changes += 1

    # ---- parts that run again ----

    def run_again(self, statement: Statement, block: int) -> int:
        """REPEAT of what stands between labels: as a call of that part of the program."""
        program = self.listing.programs.around(block)
        begin = self.label(program, statement.label, block)
        if begin is None:
            self.fault("label-not-found", block, statement, label=statement.label, where="beside")
            return block + 1
        end = self.end_of_part(program, statement, begin, block)
        if end is None:
            self.remark("not-simulated", block, name=f"{statement.label} behind REPEAT")
            self.rows.mark_unknown()
            return block + 1
        times = 1
        if statement.value is not None:
            value, fault = evaluate(statement.value, self.variables, self.listing.arithmetic)
            self.found(fault, block)
            if value != value:
                self.remark("condition-unknown", block)
            else:
                times = max(round(value or 0), 0)
        if times > self.asked.max_blocks:
            self.fault("too-many-repeats", block, statement, repeats=times, limit=self.asked.max_blocks)
        part = Program(program.number, program.name, begin, end, program.has_head, program.file)
        levels = len(self.stack)
        goes_on = self.call(part, block + 1, times, None, statement, block)
        if len(self.stack) > levels:
            self.stack[-1].is_part = True
        return goes_on

    def label(self, program: Program, label: str, block: int) -> int | None:
        """A label before a block, else behind it."""
        found = self.listing.programs.labelled(program, label, block, Search.BACKWARD)
        return found if found is not None else self.listing.programs.labelled(program, label, block, Search.FORWARD)

    def end_of_part(self, program: Program, statement: Statement, begin: int, block: int) -> int | None:
        """The block behind a part that begins at a label; None where it has no end."""
        if statement.until == statement.label:
            return begin + 1
        wanted = statement.until or "ENDLABEL"
        last = self.listing.programs.labelled(program, wanted, begin, Search.FORWARD)
        if last is not None and (statement.until or begin > block or last < block):
            return last + 1
        return block if begin < block and not statement.until else None

    def leave_parts(self, target: int) -> None:
        """A jump out of parts that run again: they are over."""
        while self.stack[-1].is_part and not self.stack[-1].program.first <= target < self.stack[-1].program.end:
            self.stack.pop()
