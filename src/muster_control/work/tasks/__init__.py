"""The tasks of workers, one module per task, imported by workers only.

`run(arguments, report)` takes and returns plain data; `report` takes progress as plain data. A MusterError says what is
wrong with the arguments. A stoppable task also takes a Stop.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Task:
    """A task of workers.

    Parameters
    ----------
    module
        with the function `run`.
    limit_s
        seconds after which its worker is killed; None: the caller says.
    long
        whether it may take minutes; long tasks wait apart from tasks that a person waits for.
    stoppable
        whether its `run` takes a Stop, which ends it early.
    """

    module: str
    limit_s: float | None = 60.0
    long: bool = False
    stoppable: bool = False


_HERE = "muster_control.work.tasks"

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
        "record": Task("muster_control.runs.records.recording", 120.0),
        "upload_plan": Task(f"{_HERE}.upload_plan"),
    }
)
