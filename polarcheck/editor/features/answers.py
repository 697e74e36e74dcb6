"""Features whose answer is one function of a document or of its analysis: a row of ANSWERS each."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from lsprotocol import types
from pygls.capabilities import get_capability
from pygls.exceptions import JsonRpcException

from polarcheck.foundation.errors import PolarcheckError

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server

#: RequestFailed of the protocol: the editor shows the message.
_FAILED = -32803


class Answer(NamedTuple):
    """
    A feature.

    method: of the protocol.
    function: what finds the answer, MODULE:FUNCTION in editor/; it is imported late. It takes the document, or the
    analysis, and what `arguments` returns of the server, the parameters of the request, and the document.
    of: document (open), any (a file beside those that are open, too) or analysis (the document as it is checked).
    is_list: the answer where there is no such document is an empty list, else none.
    options: what the server says of the feature at the beginning.
    """

    method: str
    function: str
    arguments: Callable[[Server, Any, Any], tuple[Any, ...]] = lambda server, params, subject: ()
    of: str = "document"
    is_list: bool = True
    options: Any = None


def _position(server: Server, params: Any, document: Any) -> tuple[Any, ...]:
    return params.position, server.documents.workspace(document)


def _item(server: Server, params: Any, document: Any) -> tuple[Any, ...]:
    return params.item.data, server.documents.workspace(document)


def _with_declaration(server: Server, params: Any, document: Any) -> tuple[Any, ...]:
    return *_position(server, params, document), params.context.include_declaration


def _most_ranges(server: Server, params: Any, document: Any) -> tuple[Any, ...]:
    return (get_capability(server.client_capabilities, "text_document.folding_range.range_limit"),)


def _format_of_hover(server: Server, params: Any, analysis: Any) -> tuple[Any, ...]:
    formats = get_capability(server.client_capabilities, "text_document.hover.content_format", ())
    return params.position, types.MarkupKind.Markdown in formats


def _new_name(server: Server, params: Any, document: Any) -> tuple[Any, ...]:
    return params.position, params.new_name, server.documents.workspace(document), server


ANSWERS = (
    Answer(types.TEXT_DOCUMENT_HOVER, "hover_text:hover", _format_of_hover, "analysis", False),
    Answer(types.TEXT_DOCUMENT_REFERENCES, "structure.reference_search:references", _with_declaration),
    Answer(
        types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT,
        "structure.reference_search:highlights",
        lambda server, params, document: (params.position,),
    ),
    Answer(types.TEXT_DOCUMENT_FOLDING_RANGE, "structure.folding:folding_ranges", _most_ranges),
    Answer(types.TEXT_DOCUMENT_FORMATTING, "structure.spacing:formatted"),
    Answer(
        types.TEXT_DOCUMENT_RANGE_FORMATTING,
        "structure.spacing:formatted",
        lambda server, params, document: (params.range,),
    ),
    Answer(types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY, "structure.call_tree:prepare", _position),
    Answer(types.CALL_HIERARCHY_INCOMING_CALLS, "structure.call_tree:incoming", _item, "any"),
    Answer(types.CALL_HIERARCHY_OUTGOING_CALLS, "structure.call_tree:outgoing", _item, "any"),
    Answer(types.TEXT_DOCUMENT_PREPARE_RENAME, "structure.renaming:prepare", _position, is_list=False),
    Answer(
        types.TEXT_DOCUMENT_RENAME,
        "workspace_edits:renamed",
        _new_name,
        is_list=False,
        options=types.RenameOptions(prepare_provider=True),
    ),
)


def register(server: Server) -> None:
    """Register the features."""
    for answer in ANSWERS:
        _register(server, answer)


def _register(server: Server, answer: Answer) -> None:
    async def respond(params: Any) -> Any:
        def find(subject: Any) -> Any:
            module, _, name = answer.function.partition(":")
            function = getattr(importlib.import_module(f"polarcheck.editor.{module}"), name)
            return function(subject, *answer.arguments(server, params, subject))

        none: list[Any] | None = [] if answer.is_list else None
        uri = params.item.uri if answer.of == "any" else params.text_document.uri
        try:
            if answer.of == "analysis":
                return await server.ask(uri, find, none, soon=True)
            ask = server.documents.ask_of_any if answer.of == "any" else server.documents.ask
            return await ask(uri, find, none)
        except PolarcheckError as error:
            raise JsonRpcException(str(error), _FAILED) from None

    server.feature(answer.method, answer.options)(respond)
