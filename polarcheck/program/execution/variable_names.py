"""Names in programs that stand where a control has numbers: variables, and tools that T calls."""

from __future__ import annotations

from typing import Final

from polarcheck.foundation.patterns import lazy_pattern

#: #112=: the number of a variable that custom macro sets, in the bytes of a text.
ASSIGNED: Final = lazy_pattern(rb"#[ \t]*+(\d{1,6})[ \t]*+=")
#: Variables that have a name stand above all that have a number.
FIRST_VARIABLE: Final = 20_000_000
#: The number of R0 among the variables: parameters that every program shares.
FIRST_PARAMETER: Final = 30_000_000
#: No control has more of them: R0 to R32534 at most, by machine data.
PARAMETERS: Final = 100_000
_FIRST_TOOL: Final = 2_000_000_000
#: A longer name is none of a number of a tool.
_DIGITS: Final = 9


class Names:
    """
    A number for each name, in the order in which they are met; names are told in capitals.

    variables: numbers of variables of a name. tools: numbers of tools of a name, for T. declared: names of variables
    that a program defines. effects: what statements of a name do to the path, as they were looked up.
    """

    def __init__(self) -> None:
        self.variables: dict[str, int] = {}
        self.tools: dict[str, int] = {}
        self.declared: set[str] = set()
        self.effects: dict[str, str | None] = {}

    def variable(self, name: str) -> int:
        """The number that stands for a variable."""
        return self.variables.setdefault(name.upper(), FIRST_VARIABLE + len(self.variables))

    def tool(self, name: str) -> int:
        """The number that stands for a tool; a name of digits is that number, as T="8" is T8."""
        if name.isdecimal() and len(name) < _DIGITS and name[:1] != "0":
            return int(name)
        return self.tools.setdefault(name.upper(), _FIRST_TOOL + len(self.tools))

    def declare(self, name: str) -> int:
        """The number that stands for a variable that a program defines."""
        self.declared.add(name.upper())
        return self.variable(name)

    def is_declared(self, name: str) -> bool:
        """Return True if a program defines a variable of this name."""
        return name.upper() in self.declared
