"""The worker thread, which runs long calls, so that the editor is served meanwhile."""

from __future__ import annotations

import asyncio
import contextlib
import queue
import threading
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


class Worker:
    """
    Runs calls one after the other, in the order of the requests.

    It is a single thread, since the columns of a program's tables are computed on first use, and two threads could wait
    for each other. It is a daemon: it ends with the process, whatever it is doing.
    """

    def __init__(self) -> None:
        self._calls: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        threading.Thread(target=self._work, name="checks", daemon=True).start()

    def _work(self) -> None:
        while (call := self._calls.get()) is not None:
            call()

    def end(self) -> None:
        """End the thread after the pending calls."""
        self._calls.put(None)

    async def do(
        self, function: Callable[Arguments, Result], *args: Arguments.args, **kwargs: Arguments.kwargs
    ) -> Result:
        """Run a function in the thread and return its result; not called if it is cancelled before its turn."""
        loop = asyncio.get_running_loop()
        future: asyncio.Future[Result] = loop.create_future()

        def finish(result: Any, error: Exception | None) -> None:
            if future.done():
                return
            if error is not None:
                future.set_exception(error)
            else:
                future.set_result(result)

        def call() -> None:
            if future.done():
                return
            result, failure = None, None
            try:
                result = function(*args, **kwargs)
            except Exception as error:
                failure = error
            with contextlib.suppress(RuntimeError):  # the session has ended meanwhile
                loop.call_soon_threadsafe(finish, result, failure)

        self._calls.put(call)
        return await future
