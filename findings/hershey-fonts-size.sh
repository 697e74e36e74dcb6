#!/bin/bash
# PyPI hershey-fonts 2.1.0, letters of strokes for engraving: normalize_rendering(10), "size set to" 10, gives capitals that are 7.5 high and stand 2.5 above y = 0: the size is that of capitals and descenders together.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check hershey-fonts==2.1.0 2> /dev/null
python/bin/python - <<'END'
from HersheyFonts import HersheyFonts

font = HersheyFonts()
font.load_default_font("futural")
font.normalize_rendering(10)
print("hershey-fonts 2.1.0, size 10: lowest and highest y")
for letter, seen in (("H", (2.5, 10)), ("p", (0, 7.5))):
    heights = [y for line in font.lines_for_text(letter) for _, y in line]
    found = (round(min(heights), 3), round(max(heights), 3))
    print(letter, found)
    assert found == seen, "changed"
END
