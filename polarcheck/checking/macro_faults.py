"""What macro and flow found wrong, as a table: one element per fault, with the rule that reports it."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from polarcheck.execution.run import Run


class Faults:
    """Columns over the faults of a run."""

    def __init__(self, run: Run) -> None:
        self.run = run

    @cached_property
    def rule(self) -> NDArray[np.str_]:
        """The rule that reports each fault."""
        return np.array([fault.rule for fault in self.run.faults], np.str_)
