"""The machines."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from polarcheck.api.keywords import ExecutionKeywords, PathName, options
from polarcheck.files.settings.of_programs import OfPrograms
from polarcheck.program.machines import profiles
from polarcheck.program.machines.machine import Machine


def machine(name: PathName, *, changes: Mapping[str, Any] | None = None) -> Machine:
    """
    Return a machine, merged with all that it inherits from: machine.limits.c_feed [deg/min], machine.title, ...

    An unknown number is NaN. Lengths are in mm, rates in mm/min and deg/min, accelerations in mm/s2 and deg/s2; the
    class of each table says what its keys mean, as does docs/adding_a_machine.md.

    name: of a built-in machine (`machine_names`), or the path of a TOML file.
    changes: other values by table and key, {"limits.c_feed": 3600}.

    Raises MachineError, which names the file and the key, or the nearest name of a machine; UsageError for what is no
    name.
    """
    values = {"machine": name, "changes": changes, "use_config": False}
    return OfPrograms(options("polarcheck.machine()", ExecutionKeywords, values))("").machine


def machine_names() -> list[str]:
    """Return the names of the built-in machines, in the order of the alphabet."""
    return profiles.names()
