"""Marks in settings files the faults that keep programs from being checked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis
    from polarcheck.editor.buffers import Buffer
    from polarcheck.editor.server_session import Server


def register(server: Server) -> None:
    """Register the feature."""
    #: By program (URI): the settings file at fault and the mark in it. Several programs may share one.
    marks: dict[str, tuple[str, types.Diagnostic]] = {}

    def publish(uri: str) -> None:
        diagnostics: list[types.Diagnostic] = []
        for file, mark in marks.values():
            if file == uri and mark not in diagnostics:
                diagnostics.append(mark)
        server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, diagnostics))

    def update(program: str, mark: tuple[str, types.Diagnostic] | None) -> None:
        before = marks.pop(program, None)
        if mark is not None:
            marks[program] = mark
        if mark != before:
            for uri in {file for file, _ in filter(None, (before, mark))}:
                publish(uri)

    def checked(buffer: Buffer, analysis: Analysis) -> None:
        from polarcheck.editor.settings_fault import broken

        update(buffer.uri, broken(analysis.error, analysis.read) if analysis.error else None)

    server.published.append(checked)
    server.gone.append(lambda uri: update(uri, None))
