"""
Whether programs that are checked in pieces get the reports of the same programs as one table.

    python benchmarks/pieces.py FILE... [--machine fanuc] [--size 300] [--near 6] [--tool 1:radius=2]

Each file is cut into pieces far smaller than a check would make them: of about `size` characters, each beginning with
`near` blocks of those before it beside what is in force. Prints the files whose reports differ, and how many could be
cut at all; ends with 1 if any differs.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from in_pieces import in_pieces
from programs import report_of

from polarcheck.machines import profiles


def main() -> int:
    """Compare and print; 1 where any report differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--machine", default=profiles.DEFAULT)
    parser.add_argument("--size", type=int, default=300)
    parser.add_argument("--near", type=int, default=6)
    parser.add_argument("--tool", action="append", default=[])
    asked = parser.parse_args()
    told = Counter[str]()
    for path in asked.files:
        data = path.read_bytes()
        found = in_pieces(data, asked.machine, *asked.tool, size=asked.size, near=asked.near)
        agrees = found is None or found == report_of(data, asked.machine, *asked.tool)
        told["one table" if found is None else "agree" if agrees else "DIFFER"] += 1
        if not agrees:
            print(f"{path}: the pieces differ from one table")
    print(", ".join(f"{count} {what}" for what, count in told.items()))
    return int(told["DIFFER"] > 0)


if __name__ == "__main__":
    sys.exit(main())
