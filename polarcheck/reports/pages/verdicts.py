"""The pages on the verdicts, which `polarcheck explain` shows: those of verdicts.txt, each below a line of = signs."""

from __future__ import annotations

from pathlib import Path

_ALSO = {"passed": "pass", "failed": "fail", "not evaluated": "unverified"}
_BEFORE_PAGE = "=" * 100 + "\n"


def page(word: str) -> str:
    """Return the page of a verdict, all for `verdict`, empty for any other word. Case and hyphens are ignored."""
    plain = " ".join(word.lower().replace("-", " ").replace("_", " ").split())
    _, *texts = Path(__file__).with_suffix(".txt").read_text("utf-8").split(_BEFORE_PAGE)
    pages = {text.partition(":")[0]: _headed(text) for text in texts}
    return "\n\n".join(pages.values()) if plain in ("verdict", "verdicts") else pages.get(_ALSO.get(plain, plain), "")


def _headed(text: str) -> str:
    title, _, rest = text.partition("\n")
    return f"{title}\n{'=' * len(title)}\n{rest}"
