"""The protocol as this server speaks it: with its own documents."""

from __future__ import annotations

from typing import Any
from typing import Protocol as Typed

from lsprotocol import types
from pygls.protocol import LanguageServerProtocol, lsp_method


class Documents(Typed):
    """What takes the documents of the editor."""

    def opened(self, document: types.TextDocumentItem) -> None:
        """Handle an opened document."""

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """Handle a changed document."""

    def closed(self, uri: str) -> None:
        """Handle a closed document."""


class Protocol(LanguageServerProtocol):
    """The protocol with our own documents: those of pygls end lines where editors do not, as at U+0085."""

    @property
    def _documents(self) -> Documents:
        server: Any = self._server
        documents: Documents = server
        return documents

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> None:
        """Handle an opened document."""
        self._documents.opened(params.text_document)

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> None:
        """Handle a changed document."""
        self._documents.changed(params)

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> None:
        """Handle a closed document."""
        self._documents.closed(params.text_document.uri)
