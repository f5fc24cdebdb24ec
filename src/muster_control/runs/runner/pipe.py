"""A runner's side of its pipes: JSON lines in both directions, each in a thread, so that no robot waits for a pipe."""

from __future__ import annotations

import base64
import json
import queue
import threading
from collections.abc import Callable, Mapping
from typing import IO, Any

_ROOM = 2000
"""Lines that may wait to be written before a simulated run waits too."""


class Inbox:
    """Messages of the server; one `None` at their end.

    Parameters
    ----------
    on_end
        called by the reading thread when the server is gone.
    """

    def __init__(self, stream: IO[str], on_end: Callable[[], None]) -> None:
        self._lines: queue.SimpleQueue[Mapping[str, Any] | None] = queue.SimpleQueue()
        self._stream, self._on_end = stream, on_end
        threading.Thread(target=self._read, daemon=True).start()

    def take(self, wait_s: float | None = 0.0) -> Mapping[str, Any] | None:
        """The next message; None if there is none within `wait_s` seconds. With `wait_s` None it waits for ever."""
        try:
            return self._lines.get(timeout=wait_s) if wait_s is None or wait_s > 0 else self._lines.get_nowait()
        except queue.Empty:
            return None

    def _read(self) -> None:
        for line in self._stream:
            if line.endswith("\n"):  # a killed server leaves half a line
                self._lines.put(json.loads(line))
        self._on_end()
        self._lines.put(None)


class Outbox:
    """Messages to the server. States are left out while many messages wait; entries and tracks never are."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream
        self._lines: queue.Queue[str | None] = queue.Queue()
        self._writer = threading.Thread(target=self._write, daemon=True)
        self._writer.start()

    def send(self, message: Mapping[str, Any]) -> None:
        """Send a message that must arrive."""
        self._lines.put(_text(message))

    def send_if_room(self, message: Mapping[str, Any]) -> None:
        """Send a message that is soon out of date, unless many messages wait."""
        if self._lines.qsize() < _ROOM:
            self.send(message)

    def entry(self, message: Mapping[str, Any]) -> None:
        """See `log_recorder.Out`."""
        self.send(message)

    def stretch(self, from_s: float, until_s: float, data: bytes) -> None:
        """See `log_recorder.Out`."""
        said = {"type": "stretch", "from_s": from_s, "until_s": until_s}
        self.send(said | {"data": base64.b64encode(data).decode()})

    @property
    def full(self) -> bool:
        """Whether too many messages wait."""
        return self._lines.qsize() >= _ROOM

    def close(self) -> None:
        """Wait until all is written."""
        self._lines.put(None)
        self._writer.join()

    def _write(self) -> None:
        try:
            while (line := self._lines.get()) is not None:
                self._stream.write(line)
                if self._lines.empty():
                    self._stream.flush()
            self._stream.flush()
        except OSError:  # the server is gone, and the inbox says so
            return


def _text(message: Mapping[str, Any]) -> str:
    return json.dumps(message, ensure_ascii=False, allow_nan=False, separators=(",", ":")) + "\n"
