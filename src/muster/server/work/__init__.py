"""Planning and other long work, in processes of their own with limits on memory and time.

The server asks a `Pool`; the pool keeps processes (`worker`) that do `tasks` one at a time. They speak JSON lines:
`{"task", "arguments"}` one way, any number of `{"progress"}` and one `{"done"}` or `{"failed"}` the other. A line
`{"stop": true}` (`StopRequest`) asks what is under way to end with what it has.
"""

from muster.server.work.errors import OutOfMemory, TimedOut, WorkerDied, WorkError
from muster.server.work.pool import Pool
from muster.server.work.stop_request import StopRequest

__all__ = ["OutOfMemory", "Pool", "StopRequest", "TimedOut", "WorkError", "WorkerDied"]
