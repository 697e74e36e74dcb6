"""What an extension shows beside the text: the page with the picture, and the verdict of each check."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis
    from polarcheck.editor.buffers import Buffer
    from polarcheck.editor.server_session import Server

#: Requests and a notification of our own.
PICTURE, LIBRARY, VERDICT = "polarcheck/picture", "polarcheck/library", "polarcheck/verdict"


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(PICTURE)
    async def picture(params: Any) -> dict[str, str]:
        from polarcheck.editor import picture_view

        uri, address, sources = (
            picture_view.text_of(params, "uri"),
            picture_view.text_of(params, "library", ""),
            picture_view.text_of(params, "sources", ""),
        )
        buffer = server.buffers.open.get(uri)
        if buffer is None:
            raise picture_view.RequestFailed("the program is not open in the editor")

        def draw(analysis: Analysis) -> str:
            return picture_view.picture(
                analysis, server.folders_of(analysis.path), lambda: buffer.judged is not analysis, address, sources
            )

        html = await server.ask(uri, draw, None)
        if html is None:
            raise picture_view.Changed("the program has been closed")
        return {"html": html}

    @server.feature(LIBRARY)
    def library(params: Any) -> dict[str, str]:
        from polarcheck.editor import picture_view

        return {"path": picture_view.library()}

    def publish(buffer: Buffer, analysis: Analysis) -> None:
        from polarcheck.editor import picture_view

        extras = picture_view.member(server.client_capabilities.experimental, "polarcheck")
        if picture_view.member(extras, "verdict") is True:
            server.protocol.notify(VERDICT, picture_view.verdict(analysis, buffer.uri, buffer.version))

    server.published.append(publish)
