"""Whether a file is a program in ISO code at all, or written in the language of another machine."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Columns, Mask, cached_property
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.languages import Recognised, recognised
from polarcheck.program.reading.words import Text


class Dialect(Columns, frozen=True):
    """What is known of the language of a file; one element, the file."""

    text: Text
    machine: Machine

    @cached_property
    def recognised(self) -> Recognised | None:
        """The language of another machine, and the first place that shows it; None for a program in ISO code."""
        looks_odd = self._looks_odd()
        if not looks_odd and not self.text.blocks.is_macro.any():
            return None
        return recognised(self._own_characters(), only_macros_are_odd=not looks_odd)

    @property
    def is_other(self) -> Mask:
        """The file is written in such a language."""
        return np.array([self.recognised is not None])

    def _looks_odd(self) -> bool:
        """Something other than macros stands in the file that sound programs seldom have: most need no closer look."""
        text = self.text
        if self.machine.macro.language != "custom-macro" and text.blocks.is_macro.any():
            return True  # words of another language may be those that were taken for its own
        behind_marks = text.source.code[np.minimum(text.tape_marks + 1, len(text.source.code) - 1)]
        return bool(
            np.any(text.words.is_unreadable)
            or np.any(text.words.address == ord("E"))
            or len(text.strays)
            or len(text.prose)
            or len(text.outside)
            or np.any(behind_marks >= ord("A"))
        )

    def _own_characters(self) -> bytes:
        """The characters of the file itself, without the files that it calls."""
        source = self.text.source
        end = int(source.line_starts[source.parts[0].first_line - 1]) if source.parts else len(source.code)
        return source.code[:end].tobytes()
