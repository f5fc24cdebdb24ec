"""What watchers of a run are told: each thing serialised once for all, and no memory a watcher.

Watchers take what there is at their own pace. Of states and status there is only the newest, so who is slow misses
some; entries are taken from a short memory, or read from the log again, so nobody misses any.
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
"""Of which only the newest counts, in the order in which they are told."""

Texts = Sequence[tuple[int, str]]
"""Entries as JSON, with their numbers."""


class Feed:
    """Of one run.

    Parameters
    ----------
    hello
        makes the first message.
    read
        reads entries beyond a number again.
    """

    def __init__(self, hello: Callable[[], Mapping[str, Any]], read: Callable[[int], Awaitable[Texts]]) -> None:
        self._hello, self._read = hello, read
        self._entries: deque[tuple[int, str]] = deque()
        self._bytes = 0
        self._newest = dict.fromkeys(_KINDS, (0, ""))
        self._actions: deque[tuple[int, str]] = deque(maxlen=_ACTIONS)
        self._said = 0
        self._bell = asyncio.Event()
        self._ready = self._ended = False
        self.seq = 0
        self.watchers = 0

    def ready(self) -> None:
        """From now on it is known what the run is about."""
        self._ready = True
        self._ring()

    def publish(self, texts: Texts) -> None:
        """Entries, which follow those before."""
        for seq, text in texts:
            self._entries.append((seq, text))
            self._bytes += len(text)
            self.seq = seq
        while self._bytes > _REMEMBERED and len(self._entries) > 1:
            self._bytes -= len(self._entries.popleft()[1])
        self._ring()

    def tell(self, kind: str, text: str) -> None:
        """The newest of a kind: `run`, `status`, `states`."""
        self._said += 1
        self._newest[kind] = (self._said, text)
        self._ring()

    def newest(self, kind: str) -> str:
        """The newest of a kind; empty: none yet."""
        return self._newest[kind][1]

    def tell_action(self, message: Mapping[str, Any]) -> None:
        """What came of an action."""
        self._said += 1
        self._actions.append((self._said, _text({"type": "action", **message})))
        self._ring()

    def end(self) -> None:
        """Nothing more comes."""
        self._ended = self._ready = True
        self._ring()

    async def watch(self, after: int = 0) -> AsyncIterator[str]:
        """JSON texts: a hello, the log after an entry, then what happens, until the run is over."""
        self.watchers += 1
        try:
            while not self._ready:
                await self._bell.wait()
            yield _text({"type": "hello", **self._hello(), "seq": self.seq})
            told = dict.fromkeys((*_KINDS, "action"), 0)
            told["run"], told["action"] = self._newest["run"][0], self._said
            while True:
                bell, ended = self._bell, self._ended
                while self.seq > after and (texts := await self._entries_after(after)):
                    for seq, text in texts:
                        yield text
                        after = seq
                for text in self._news(told):
                    yield text
                if ended:  # all that can be read is told: of a run that was given up some entries are nowhere
                    return
                await bell.wait()
        finally:
            self.watchers -= 1

    def _news(self, told: dict[str, int]) -> list[str]:
        """What is newer than what was told; `told` is brought up to it."""
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

    def _ring(self) -> None:
        bell, self._bell = self._bell, asyncio.Event()
        bell.set()


def _text(message: Mapping[str, Any]) -> str:
    return json.dumps(message, ensure_ascii=False, separators=(",", ":"))
