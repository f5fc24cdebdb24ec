"""Subscribers of a run: each message is serialised once for all, and nothing is stored per subscriber.

Subscribers read at their own pace. Only the newest states and status are kept, so a slow subscriber misses some.
Entries come from a short buffer or from the log, so nobody misses any.
"""

from __future__ import annotations

import asyncio
import json
from collections import deque
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping, Sequence
from typing import Any

_REMEMBERED = 2 * 2**20
_ACTIONS = 500
_KINDS = ("run", "status", "states")
"""Kinds of messages of which only the newest counts, in the order of sending."""

Texts = Sequence[tuple[int, str]]
"""Entries as JSON, with their numbers."""


class Subscribers:
    """Of one run.

    Parameters
    ----------
    hello
        makes the first message.
    read
        reads entries after a number from the log.
    """

    def __init__(self, hello: Callable[[], Mapping[str, Any]], read: Callable[[int], Awaitable[Texts]]) -> None:
        self._hello, self._read = hello, read
        self._entries: deque[tuple[int, str]] = deque()
        self._bytes = 0
        self._newest = dict.fromkeys(_KINDS, (0, ""))
        self._actions: deque[tuple[int, str]] = deque(maxlen=_ACTIONS)
        self._said = 0
        self._changed = asyncio.Event()
        self._ready = self._ended = False
        self.seq = 0
        self.watchers = 0

    def ready(self) -> None:
        """Note that the mission is known, so that messages can begin."""
        self._ready = True
        self._notify()

    def publish(self, texts: Texts) -> None:
        """Publish the next entries."""
        for seq, text in texts:
            self._entries.append((seq, text))
            self._bytes += len(text)
            self.seq = seq
        while self._bytes > _REMEMBERED and len(self._entries) > 1:
            self._bytes -= len(self._entries.popleft()[1])
        self._notify()

    def tell(self, kind: str, text: str) -> None:
        """Publish the newest message of a kind: `run`, `status`, `states`."""
        self._said += 1
        self._newest[kind] = (self._said, text)
        self._notify()

    def newest(self, kind: str) -> str:
        """The newest message of a kind; empty if there is none."""
        return self._newest[kind][1]

    def publish_action(self, message: Mapping[str, Any]) -> None:
        """Publish the outcome of an action."""
        self._said += 1
        self._actions.append((self._said, _text({"type": "action", **message})))
        self._notify()

    def end(self) -> None:
        """Note that no more messages follow."""
        self._ended = self._ready = True
        self._notify()

    async def watch(self, after: int = 0) -> AsyncIterator[str]:
        """Yield JSON texts: a hello, the log after an entry, then what happens, until the run is over."""
        self.watchers += 1
        try:
            while not self._ready:
                await self._changed.wait()
            yield _text({"type": "hello", **self._hello(), "seq": self.seq})
            told = dict.fromkeys((*_KINDS, "action"), 0)
            told["run"], told["action"] = self._newest["run"][0], self._said
            while True:
                changed, ended = self._changed, self._ended
                while self.seq > after and (texts := await self._entries_after(after)):
                    for seq, text in texts:
                        yield text
                        after = seq
                for text in self._news(told):
                    yield text
                if ended:  # a run that was given up may lack entries
                    return
                await changed.wait()
        finally:
            self.watchers -= 1

    def _news(self, told: dict[str, int]) -> list[str]:
        """The messages after those of `told`, which is updated."""
        news = [text for said, text in self._actions if said > told["action"]]
        if self._actions:
            told["action"] = max(told["action"], self._actions[-1][0])
        for kind in _KINDS:
            said, text = self._newest[kind]
            if said > told[kind]:
                told[kind] = said
                news.append(text)
        return news

    async def _entries_after(self, after: int) -> Texts:
        first = self._entries[0][0] if self._entries else self.seq + 1
        if first > after + 1:
            return await self._read(after)
        return [(seq, text) for seq, text in list(self._entries) if seq > after]

    def _notify(self) -> None:
        changed, self._changed = self._changed, asyncio.Event()
        changed.set()


def _text(message: Mapping[str, Any]) -> str:
    return json.dumps(message, ensure_ascii=False, separators=(",", ":"))
