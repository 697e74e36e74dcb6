"""The protocol as this server speaks it: with its own documents."""

from __future__ import annotations

from typing import Any
from typing import Protocol as Typed

from lsprotocol import types
from pygls.exceptions import (
    JsonRpcException,
    JsonRpcInvalidRequest,
    JsonRpcServerNotInitialized,
)
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
    """
    The protocol with our own documents: those of pygls end lines where editors do not, as at U+0085.

    It refuses what is not allowed at a time of the session: pygls leaves such requests without an answer.
    """

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

    # ---- what is allowed ----

    def admit(self, message: dict[str, Any]) -> None:
        """
        Raise a JsonRpcException if a request or notification is not allowed now, or not known.

        message: a message with a method, as it was read.
        """
        method = message["method"]
        if method == types.EXIT:
            return
        if self._shutdown:
            raise JsonRpcInvalidRequest("the session is shut down")
        if (method == types.INITIALIZE) != (self._workspace is None):
            if method == types.INITIALIZE:
                raise JsonRpcInvalidRequest("the session is initialized already")
            raise JsonRpcServerNotInitialized("the session is not initialized")
        if method != types.CANCEL_REQUEST:
            self._get_handler(method)  # raises JsonRpcMethodNotFound
        if self.get_message_type(method) is None:
            message.setdefault("params", None)

    def refuse(self, error: JsonRpcException, number: int | str | None = None) -> None:
        """Answer a request with an error. number: that of the request; None if it is not known."""
        # A dict, since lsprotocol leaves out a number that is null.
        answer = {"code": error.code, "message": error.message}
        self._send_data({"jsonrpc": self.VERSION, "id": number, "error": answer})

    def report(self, error: JsonRpcException) -> None:
        """Log an error in a message that gets no answer."""
        if self._workspace is not None and not self._shutdown:
            self._server.report_server_error(error, type(error))
