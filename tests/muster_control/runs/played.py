"""Runners that are played: a test says what each of them says, and hears what it is told."""

import asyncio
import json

from muster_control.runs import run_session as session


def entry(seq, kind, time_s=0.0, **data):
    return {"type": "entry", "seq": seq, "time_s": time_s, "kind": kind, "data": data, "line": ""}


TICK = json.dumps({"type": "tick", "bodies": None}, separators=(",", ":"))
PLAN = entry(1, "plan", plan={"routes": []}, lines={})
REPORT = {"tasks_done": [], "tasks_lost": [], "mission_time_s": 0.0}


def play(monkeypatch, script):
    """From now on runners say what `script(runner, begin)` yields; returns the list in which all that start are."""
    started = []

    class RunnerProcess:
        pid, killed, last_words = 0, False, "played"

        def __init__(self):
            self.told, self.gone = asyncio.Queue(), asyncio.Event()
            started.append(self)

        @classmethod
        async def start(cls, name, memory_mb):
            return cls()

        def send(self, message):
            self.told.put_nowait(message)

        def send_line(self, line):
            self.send(json.loads(line))

        async def messages(self):
            async for message in script(self, await self.told.get()):
                yield json.dumps(message, separators=(",", ":"))
                if message["type"] == "entry" and message.pop("whole", True):
                    yield TICK

        def dismiss(self):
            self.gone.set()

        async def end(self):
            self.gone.set()

        kill = dismiss

    monkeypatch.setattr(session, "RunnerProcess", RunnerProcess)
    return started
