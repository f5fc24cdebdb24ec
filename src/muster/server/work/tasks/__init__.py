"""What workers can do: a file a task, each with a `run`, imported by the workers alone.

`run(arguments, report)` gets plain data and gives plain data; `report` takes the progress, also plain. What is wrong
with the arguments it says by a MusterError. One that can end early with what it has gets a Stop besides.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Task:
    """Where a task is, and how long it may take.

    Parameters
    ----------
    module
        whose `run` does it.
    limit_s
        after which its worker is killed; None: whoever asks says so.
    long
        whether it may take minutes; then it waits for its turn apart from work that somebody sits and waits for.
    stoppable
        whether its `run` takes a Stop, which is interrupted when it is to end with what it has.
    """

    module: str
    limit_s: float | None = 60.0
    long: bool = False
    stoppable: bool = False


_HERE = "muster.server.work.tasks"

TASKS: Mapping[str, Task] = MappingProxyType(
    {
        "allocators": Task(f"{_HERE}.allocators"),
        "check": Task(f"{_HERE}.check", 20.0),
        "check_request": Task(f"{_HERE}.check_request", 20.0),
        "convert": Task(f"{_HERE}.convert", 20.0),
        "edit": Task(f"{_HERE}.edit", 20.0),
        "explain": Task(f"{_HERE}.explain", 120.0),
        "export": Task(f"{_HERE}.export", 120.0),
        "floor_plan": Task(f"{_HERE}.floor_plan", 20.0),
        "judge": Task(f"{_HERE}.judge"),
        "picture": Task(f"{_HERE}.picture"),
        "plan": Task(f"{_HERE}.plan", None, long=True, stoppable=True),
        "read_mission": Task(f"{_HERE}.read_mission", 20.0),
        "record": Task("muster.server.runs.recording", 120.0),
        "upload_plan": Task(f"{_HERE}.upload_plan"),
    }
)
