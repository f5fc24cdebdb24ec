"""A client of mission control.

```python
from muster_control.client import Client

with Client("http://127.0.0.1:8117") as control:
    job = control.plan("31T-6R50", time_limit=2)
    plan = job.wait()
    run = control.start(plan, speed=10)
    for message in run.stream():
        print(message)
```

| part | what it does |
|---|---|
| `client` | the server: jobs and runs |
| `resources` | its missions, plans and records |
| `handles` | a job and a run under way |
| `server_plan` | a plan with its number at the server |
| `uploads` | a mission as it is sent, with the files that it names |
| `connection` | requests, streams, and the server's errors as Muster's exceptions |
| `reading` | answers as dataclasses |
| `backend` | the work of the command's verbs, done by a server |
"""

from muster_control.client.client import Client
from muster_control.client.handles import RunningJob, RunningRun
from muster_control.client.server_plan import ServerPlan

__all__ = ["Client", "RunningJob", "RunningRun", "ServerPlan"]
