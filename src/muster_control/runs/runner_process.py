"""A runner's process, as the server has it: started, spoken to, heard, ended."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import signal
import sys
from collections import deque
from collections.abc import AsyncIterator, Mapping
from contextlib import suppress
from typing import Any

from muster_control.work.environment import without_secrets

_LINE_BYTES = 2**28
"""The longest line that a runner says: a plan of the largest mission."""
_ENDS_WITHIN_S = 20.0
"""Seconds for a runner of real robots to tell them to stand."""

_log = logging.getLogger("muster.runs")


class RunnerProcess:
    """One runner. Made by `start`."""

    def __init__(self, process: asyncio.subprocess.Process, name: str) -> None:
        self._process, self._name = process, name
        self._last_words: deque[str] = deque(maxlen=5)
        self._listener = asyncio.create_task(self._listen())

    @classmethod
    async def start(cls, name: str, memory_mb: int) -> RunnerProcess:
        """A new process, which waits for its first line; `name` is for the log of the server."""
        process = await asyncio.create_subprocess_exec(
            sys.executable,
            "-P",
            "-m",
            "muster_control.runs.runner.main",
            str(memory_mb),
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            limit=_LINE_BYTES,
            env={**without_secrets(os.environ), "PYTHONHASHSEED": "0"},  # the same seed gives the same run
            start_new_session=True,
        )
        return cls(process, name)

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def killed(self) -> bool:
        """Whether somebody else has ended it: a person, or a system without memory."""
        return self._process.returncode == -signal.SIGKILL

    @property
    def last_words(self) -> str:
        """The last line that it wrote on its standard error."""
        return self._last_words[-1] if self._last_words else ""

    def send(self, message: Mapping[str, Any]) -> None:
        """Say something, if it still hears."""
        self.send_line(json_line(message))

    def send_line(self, line: bytes) -> None:
        """Say a line of `json_line`."""
        assert self._process.stdin is not None
        with suppress(OSError, RuntimeError):
            self._process.stdin.write(line)

    async def messages(self) -> AsyncIterator[str]:
        """The lines that it says, until it ends."""
        assert self._process.stdout is not None
        while line := await self._process.stdout.readline():
            if line.endswith(b"\n"):  # a killed process breaks off in the middle
                yield line.decode().rstrip("\n")
        await self._process.wait()
        await self._listener

    def dismiss(self) -> None:
        """Close its ears: a simulated run ends at once, real robots are told to stand first."""
        if self._process.stdin is not None:
            self._process.stdin.close()

    async def end(self) -> None:
        """Close its ears, so that it ends as it should; kill it if it does not."""
        self.dismiss()
        try:
            await asyncio.wait_for(self._process.wait(), _ENDS_WITHIN_S)
        except TimeoutError:
            self.kill()

    def kill(self) -> None:
        """End it at once."""
        with suppress(ProcessLookupError):
            self._process.kill()

    async def _listen(self) -> None:
        assert self._process.stderr is not None
        while line := await self._process.stderr.readline():
            text = line.decode(errors="replace").strip()
            if text:
                self._last_words.append(text)
                _log.warning("%s: %s", self._name, text)


def json_line(message: Mapping[str, Any]) -> bytes:
    """A message as runners hear it; of a long one another thread had better make the line."""
    return json.dumps(message, separators=(",", ":")).encode() + b"\n"
