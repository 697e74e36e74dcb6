"""Phrases of the rules about metal that comes out otherwise."""

from __future__ import annotations

from polarcheck.checking.phrases.passes import forgotten_arc as forgotten_arc
from polarcheck.checking.phrases.passes import needed_arc as needed_arc
from polarcheck.checking.phrases.passes import words_of_arc as words_of_arc
from polarcheck.checking.phrases.passes import written_arc as written_arc
