"""Planning and other long work, in worker processes with limits on memory and time.

The server calls a `Pool`, whose processes (`worker`) do `tasks` one at a time. They exchange JSON lines: a request
`{"task", "arguments"}`, then any number of `{"progress"}` and one `{"done"}` or `{"failed"}`. A line `{"stop": true}`
(`StopRequest`) ends the running task with its best result so far.
"""

from muster_control.work.errors import OutOfMemory, TimedOut, WorkerDied, WorkError
from muster_control.work.pool import Pool
from muster_control.work.stop_request import StopRequest

__all__ = ["OutOfMemory", "Pool", "StopRequest", "TimedOut", "WorkError", "WorkerDied"]
