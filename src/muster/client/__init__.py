"""A server of mission control seen from Python.

```python
from muster.client import Client

with Client("http://127.0.0.1:8117") as control:
    job = control.plan("31T-6R50", time_limit=2)
    plan = job.wait()
    run = control.start(plan, speed=10)
    for message in run.stream():
        print(message)
```

| part | what it does |
|---|---|
| `client` | the server, its missions, plans and records |
| `handles` | a job and a run that can be followed |
| `connection` | requests, streams, and the server's errors as Muster's exceptions |
| `reading` | answers as the words of `muster.exchange.mission_control` |
"""

from muster.client.client import Client
from muster.client.handles import RunningJob, RunningRun

__all__ = ["Client", "RunningJob", "RunningRun"]
