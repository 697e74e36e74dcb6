"""
Converts programs in the styles of posts for all other controls, runs both on a simulated lathe, and counts results.

    python benchmarks/conversions.py [--count 100] [--to okuma-osp] [--write docs/convert.md]

The programs are those of tests/post_styles.py, the lathe is tests/simulated_lathe.py, which shares no module with the
package. --write puts the tables into a page, between its two marks. Whatever is wrong is named on standard error.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from post_styles import Drawn, programs  # noqa: E402
from simulated_conversions import (  # noqa: E402
    EQUAL,
    NEEDLESS,
    REFUSED,
    TO_DECIDE,
    WRONG,
    Conversion,
    conversion,
)
from simulated_lathe import CONTROLS  # noqa: E402

BEGIN, END = "<!-- matrix: begin -->", "<!-- matrix: end -->"
_COLUMNS = (EQUAL, TO_DECIDE, REFUSED, NEEDLESS, WRONG)
Result = tuple[Drawn, str, Conversion]


def _converted(program: Drawn, targets: Sequence[str]) -> list[Result]:
    return [(program, target, conversion(program, target)) for target in targets if target != program.machine]


def tables(results: Sequence[Result]) -> list[str]:
    """Return tables in Markdown: what came of the conversions to each control, and why programs are refused."""
    lines = ["| to | " + " | ".join(_COLUMNS) + " |", "|---" + "|---:" * len(_COLUMNS) + "|"]
    for target in [*dict.fromkeys(target for _, target, _ in results), "**all**"]:
        counts = Counter(result.what for _, name, result in results if target in (name, "**all**"))
        lines.append(f"| {target} | " + " | ".join(str(counts[column]) for column in _COLUMNS) + " |")
    reasons = Counter(result.why[0] for _, _, result in results if result.what == REFUSED)
    lines += ["", "| conversions | true reason |", "|---:|---|"]
    return [*lines, *(f"| {count} | {reason} |" for reason, count in reasons.most_common())]


def main() -> None:
    """Convert, and print or write the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--to", dest="targets", action="append")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--write", type=Path)
    chosen = parser.parse_args()
    targets = chosen.targets or [name for name in CONTROLS if name != "fanuc"]
    with ProcessPoolExecutor(chosen.jobs) as executor:
        of_programs = executor.map(partial(_converted, targets=targets), programs(chosen.count))
        results = [result for of_program in of_programs for result in of_program]
    lines = [f"{chosen.count} programs, {len(results)} conversions:", "", *tables(results)]
    if chosen.write is None:
        print("\n".join(lines))
    else:
        page = chosen.write.read_text(encoding="utf-8")
        before, _, rest = page.partition(BEGIN)
        behind = rest.partition(END)[2]
        chosen.write.write_text("\n".join([before + BEGIN, "", *lines, "", END + behind]), encoding="utf-8")
    for program, target, result in results:
        if result.what in (NEEDLESS, WRONG):
            print(f"{program.name}: {program.machine} -> {target}: {result.what}: {result.why[0]}", file=sys.stderr)


if __name__ == "__main__":
    main()
