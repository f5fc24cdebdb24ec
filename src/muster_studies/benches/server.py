"""Mission control under load: part of `muster bench`.

A real `muster serve` with a database of its own; those who watch it and ask are other processes (`server_load`), on
the same machine, so that their work slows it down too.
"""

from __future__ import annotations

import importlib.util
import json
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

from muster.generation.uniform import uniform_mission
from muster.mission.errors import MissingExtraError, MusterError
from muster.mission.yaml_writer import yaml_text
from muster_studies.benches.measurement import Measurement

ROBOTS, TASKS, SIDE_M = 50, 500, 400.0
WATCHERS, WINDOW_S = 50, 15.0
REQUESTS = 200
_PATIENCE_S = 120.0


@dataclass(frozen=True)
class Served:
    """A server that is running."""

    address: str
    process: subprocess.Popen[bytes]
    began: float  # time.monotonic()

    def ask(self, method: str, path: str, body: Mapping[str, Any] | None = None) -> Any:
        """Ask the API; the answer's JSON.

        Raises
        ------
        MusterError
            if it is refused.
        """
        import httpx

        answer = httpx.request(method, f"{self.address}/api/v1{path}", json=body, timeout=_PATIENCE_S)
        if answer.is_error:
            raise MusterError(f"{method} {path}: {answer.status_code} {answer.text[:200]}")
        return answer.json() if answer.content else None

    def megabytes(self) -> float:
        """Memory of its processes, where what they share counts once (proportional set size)."""
        return sum(_pss_mb(process) for process in _family(self.process.pid))


@contextmanager
def serving(*options: str) -> Iterator[Served]:
    """A server on a free port, with an empty database, until it is left."""
    if importlib.util.find_spec("nicegui") is None:
        raise MissingExtraError("web", "mission control")
    with tempfile.TemporaryDirectory() as folder:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        database = f"sqlite:///{Path(folder) / 'bench.db'}"
        words = [sys.executable, "-m", "muster.cli", "serve", "-q", "--port", str(port), "--db", database, *options]
        began = time.monotonic()
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
        served = Served(f"http://127.0.0.1:{port}", process, began)
        try:
            yield served
        finally:
            process.terminate()
            process.wait()


def first_page_s(served: Served) -> float:
    """Seconds from the start of the process until the first page is there."""
    import httpx

    while time.monotonic() < served.began + _PATIENCE_S and served.process.poll() is None:
        try:
            if httpx.get(served.address, follow_redirects=True).is_success:
                return time.monotonic() - served.began
        except httpx.TransportError:
            time.sleep(0.01)
    raise MusterError("the server did not come up")


def start(runs: int) -> list[Measurement]:
    """How long until the first page, and how large a server is to which nothing happens."""
    seconds, megabytes = [], []
    for _ in range(runs):
        with serving() as served:
            seconds.append(first_page_s(served))
            time.sleep(3.0)
            megabytes.append(served.megabytes())
    return [
        Measurement.over_runs("mission control, first page", "s", seconds, "< 2", "from the start of `muster serve`"),
        Measurement.over_runs("mission control, memory when idle", "MB", megabytes, "< 150", "all its processes"),
    ]


def watched(runs: int) -> list[Measurement]:
    """A live run with many robots, watched by many; a window of time a run."""
    with serving() as served:
        first_page_s(served)
        run = _begun_run(served)
        before = served.megabytes()
        windows = _load("sockets", served.address, run, WATCHERS, runs, WINDOW_S)
        grown = served.megabytes() - before
        pages = _load("page", served.address, run, WINDOW_S) if importlib.util.find_spec("playwright") else []
        later = served.megabytes() - before
    name = f"mission control, {ROBOTS} robots at 10 Hz, {WATCHERS} watchers: "
    rows = (
        ("state, median", "ms", "median_ms", "", "from the runner's stamp until the watcher has it"),
        ("state, 95 of 100", "ms", "p95_ms", "< 250", ""),
        ("state, slowest", "ms", "slowest_ms", "", ""),
        ("states a watcher", "states / s", "states_hz", "10", ""),
    )
    found = [
        Measurement.over_runs(name + what, unit, [window[key] for window in windows], aim, note)
        for what, unit, key, aim, note in rows
    ]
    found.append(Measurement.over_runs(name + "memory grew by", "MB", [grown, later], "bounded", "all its processes"))
    if pages:
        late = [page["p95_ms"] for page in pages]
        note = f"median {pages[0]['median_ms']:.0f} ms, in headless Chromium"
        found.append(Measurement.over_runs("mission control, drawn in a page, 95 of 100", "ms", late, "< 250", note))
    return found


def _begun_run(served: Served) -> int:
    mission = uniform_mission(Random(0), robots=ROBOTS, tasks=TASKS, side_m=SIDE_M)
    made = served.ask("POST", "/missions", {"name": mission.name, "text": yaml_text(mission)})
    job = _over(served, served.ask("POST", f"/missions/{made['mission']}/plans", {"allocator": "greedy"}))
    run = served.ask("POST", "/runs", {"plan": job["result"]["plan"], "world": "kinematic", "speed": 1.0})
    return int(run["id"])


def _over(served: Served, job: Mapping[str, Any]) -> Mapping[str, Any]:
    until = time.monotonic() + _PATIENCE_S
    while job["state"] in ("queued", "running") and time.monotonic() < until:
        time.sleep(0.1)
        job = served.ask("GET", f"/jobs/{job['id']}")
    if job["state"] != "done":
        raise MusterError(f"job {job['id']} is {job['state']}: {job['error']}")
    return job


def queued(runs: int) -> list[Measurement]:
    """Many plan requests at once."""
    seconds, answers = [], []
    for _ in range(min(runs, 3)):
        with serving() as served:
            first_page_s(served)
            begin = time.monotonic()
            body = {"allocator": "search", "iterations": 500}
            jobs = [served.ask("POST", "/missions/31T-6R50/plans", body) for _ in range(REQUESTS)]
            answers.append(1000 * (time.monotonic() - begin) / REQUESTS)
            for job in jobs:
                _over(served, job)
            seconds.append(time.monotonic() - begin)
    name = f"mission control, {REQUESTS} plans asked for at once"
    return [
        Measurement.over_runs(f"{name}, all done", "s", seconds, "all", "31T-6R50, search, 500 iterations each"),
        Measurement.over_runs(f"{name}, each taken in within", "ms", answers, "", "one after the other"),
    ]


def _load(*arguments: object) -> list[dict[str, float]]:
    words = [sys.executable, "-m", "muster_studies.benches.server_load", *map(str, arguments)]
    out = subprocess.run(words, capture_output=True, text=True, check=False)
    if out.returncode:
        raise MusterError(f"{arguments[0]}: {out.stderr.strip().splitlines()[-1:]}")
    return [json.loads(line) for line in out.stdout.splitlines()]


def _family(process: int) -> list[int]:
    """A process and its descendants."""
    children: list[int] = []
    for task in Path(f"/proc/{process}/task").iterdir():
        children += map(int, (task / "children").read_text().split())
    return [process, *(member for child in children for member in _family(child))]


def _pss_mb(process: int) -> float:
    lines = Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024
