"""Options of what is silenced: allow comments of programs."""

from __future__ import annotations

from polarcheck.commands.options import option

inline = option("--inline/--no-inline", default=None, help="Whether the allow comments of programs are heeded.")
