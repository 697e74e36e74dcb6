#!/bin/bash
# PyPI Pygments 2.21.0: its G-code lexer stops at the first thing it does not know: comments in parentheses, `G12.1`, the point of `X5.`, `N10G1X5`; the rest of the block is text.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check Pygments==2.21.0 2> /dev/null
venv/bin/python - <<'END'
from pygments.lexers import get_lexer_by_name
from pygments.token import Text

lexer = get_lexer_by_name("gcode")
blocks = {"G1 X5": "", "G12.1": "G12.1", "N10G1X5": "G1X5", "G1 X5. Z2": ". Z2", "G1 X5 (FACE)": "(FACE)", "(FACE) G1 X5": "(FACE) G1 X5", "/G1 X5": "/G1 X5"}
for block, text in blocks.items():
    seen = "".join(value for kind, value in lexer.get_tokens(block) if kind is Text).strip()
    print(f"Pygments 2.21.0, {block!r}: not colored {seen!r}")
    assert seen == text, text
END
