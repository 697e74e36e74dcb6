"""The names of semantic colors; apart from what finds them: the editor needs them as it starts."""

from __future__ import annotations

from lsprotocol import types

#: The kinds of tokens, which are those of the protocol, so that every theme has colors for them.
KINDS = (
    *("function", "method", "property", "number", "variable", "comment", "label", "keyword", "namespace"),
    *("string", "operator", "parameter", "enumMember"),
)
#: skipped: in a block that block skip leaves out. readonly: a variable of the control.
MODIFIERS = ("declaration", "skipped", "readonly")
LEGEND = types.SemanticTokensLegend(list(KINDS), list(MODIFIERS))
