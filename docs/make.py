"""
Writes the pages of docs/ that are generated: from the rules, the machine files, the types of the report, and a program.

    python docs/make.py

It also removes the pages of rules and machines that no longer exist.
"""

from __future__ import annotations

from pathlib import Path

from generators import controls, machine_pages, one_block, report_fields, rule_pages, values, written_sections

from polarcheck.program.reading import files
from polarcheck.rules.rule import load_all

#: Folders below docs/ that hold nothing else.
FOLDERS = ("rules", "machines")


def pages() -> dict[str, str]:
    """Return the text of every page by its path below docs/."""
    rules = load_all()
    return {
        "controls.md": controls.text(),
        "convert.md": written_sections.page(),
        "one_block.md": one_block.page(),
        "values.md": values.text(rules),
        "report_fields.md": report_fields.text(),
        **dict(rule_pages.pages(rules)),
        **dict(machine_pages.pages()),
    }


def write(folder: Path) -> None:
    """Write all pages. Raises OutputError where one cannot be written."""
    texts = pages()
    for name, text in texts.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        files.write(path, text)
    for name in FOLDERS:
        for path in (folder / name).rglob("*.md"):
            if path.relative_to(folder).as_posix() not in texts:
                path.unlink()


if __name__ == "__main__":
    write(Path(__file__).parent)
