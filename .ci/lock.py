"""
Writes .ci/lock.txt: the version and the hash of each package that polarcheck needs at run time, its extras included.

For those who audit an installation. The hashes are those of the files for Linux on x86-64 and Python 3.11, where the
job `audit` reads them; run it there: `python3.11 .ci/lock.py`. Nothing is installed.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parent.parent
#: What nobody needs who runs polarcheck.
NOT_AT_RUN_TIME = ("test", "dev")
HEADER = """\
# Made by .ci/lock.py for Linux on x86-64 and Python 3.11. To install exactly this, beside polarcheck with --no-deps:
#     pip install --require-hashes -r .ci/lock.txt
"""


def requirements() -> list[str]:
    """The requirements in pyproject.toml, those of the extras included."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    chosen = [one for extra, names in extras.items() if extra not in NOT_AT_RUN_TIME for one in names]
    return [*project["dependencies"], *chosen]


def main() -> None:
    resolve = ("install", "--dry-run", "--ignore-installed", "--only-binary", ":all:", "--quiet", "--report", "-")
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check")
    report = subprocess.run([*pip, *resolve, *requirements()], check=True, stdout=subprocess.PIPE).stdout
    lines = []
    for item in json.loads(report)["install"]:
        name = re.sub(r"[-_.]+", "-", item["metadata"]["name"]).lower()
        digest = item["download_info"]["archive_info"]["hashes"]["sha256"]
        lines.append(f"{name}=={item['metadata']['version']} --hash=sha256:{digest}\n")
    (ROOT / ".ci" / "lock.txt").write_text(HEADER + "".join(sorted(lines)), "utf-8")


if __name__ == "__main__":
    main()
