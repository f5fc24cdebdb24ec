"""A real server in a thread of the test's process: on loopback, with a database of its own."""

import asyncio
import threading
import time
from contextlib import contextmanager

import uvicorn

from muster_control.app import make_app
from muster_control.serving import PatientProtocol, listening
from muster_control.settings import Settings


@contextmanager
def served(folder, **others):
    """Its URL; `folder` holds its database, `others` are Settings."""
    database = f"sqlite:///{folder / 'muster.db'}"
    given = {"workers": 1, "requests_per_s": 1e6, "port": 0, "database": database}
    settings = Settings(**given | others)
    app = make_app(settings)
    socket = listening("127.0.0.1", 0)
    config = uvicorn.Config(
        app,
        http=PatientProtocol,
        ws="websockets-sansio",
        lifespan="on",
        log_config=None,
        timeout_graceful_shutdown=3,
    )
    server = uvicorn.Server(config)
    thread = threading.Thread(target=asyncio.run, args=(server.serve(sockets=[socket]),))
    thread.start()
    try:
        while not server.started:
            assert thread.is_alive(), "the server did not start"
            thread.join(0.01)
        yield f"http://127.0.0.1:{socket.getsockname()[1]}"
    finally:
        server.should_exit = True
        thread.join()
        socket.close()


def after(http, path, *states):
    """Return what the server tells of a job or run once its state is none of these.

    Asked without a pause, the server spends its time on answers instead of on the job.
    """
    while (seen := http.get(path).json())["state"] in states:
        time.sleep(0.02)
    return seen


def plan_of(http, mission, **how):
    """Have a mission planned; the id of the plan."""
    job = http.post(f"/missions/{mission}/plans", json={"iterations": 20, **how})
    assert job.status_code == 202, job.text
    where = job.headers["location"].removeprefix("/api/v1")
    seen = after(http, where, "queued", "running")
    assert seen["state"] == "done", seen["error"]
    return seen["result"]["plan"]
