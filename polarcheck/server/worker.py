"""One thread that does what takes time, so that the editor is answered meanwhile."""

from __future__ import annotations

import asyncio
import contextlib
import queue
import threading
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

Given = ParamSpec("Given")
Found = TypeVar("Found")


class Worker:
    """
    Does one thing after the other, in the order in which they were asked for.

    It is one thread alone since the tables of a program make their columns when they are asked for, and two that ask
    could wait for each other. It ends with the process, whatever it does then.
    """

    def __init__(self) -> None:
        self._wanted: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        threading.Thread(target=self._work, name="checks", daemon=True).start()

    def _work(self) -> None:
        while (wanted := self._wanted.get()) is not None:
            wanted()

    def end(self) -> None:
        """What was asked for before is still done, and nothing after it."""
        self._wanted.put(None)

    async def do(self, function: Callable[Given, Found], *given: Given.args, **named: Given.kwargs) -> Found:
        """What the function gives; where nobody waits any more when its turn comes, it is not called."""
        loop = asyncio.get_running_loop()
        future: asyncio.Future[Found] = loop.create_future()

        def tell(found: Any, error: Exception | None) -> None:
            if future.done():
                return
            if error is not None:
                future.set_exception(error)
            else:
                future.set_result(found)

        def call() -> None:
            if future.done():
                return
            found, wrong = None, None
            try:
                found = function(*given, **named)
            except Exception as error:
                wrong = error
            with contextlib.suppress(RuntimeError):  # the session has ended meanwhile
                loop.call_soon_threadsafe(tell, found, wrong)

        self._wanted.put(call)
        return await future
