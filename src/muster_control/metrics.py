"""`/metrics` for Prometheus: requests, jobs, runs, robots, the database, and how good plans are."""

from __future__ import annotations

import asyncio
import json
import resource
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, get_args

from prometheus_client import CollectorRegistry, Histogram
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4, generate_latest
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from muster_control.contract import JobState, RunState, StoreError
from muster_control.security.guard import CompletedRequest, GuardState
from muster_control.services.services import Services
from muster_control.store.statistics import Statistics, statistics

_SECONDS = (0.005, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)
_APPEND_S = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
_OWN_PATHS = ("/healthz", "/login", "/logout", "/metrics")
_METHODS = ("GET", "HEAD", "POST", "PUT", "DELETE")


class Metrics:
    """The metrics of a server."""

    def __init__(self, services_of: Callable[[], Services | None], guard_state: GuardState) -> None:
        self._desk_of = services_of
        self._shield = guard_state
        self._registry = CollectorRegistry()
        self._requests = Histogram(
            "muster_request_seconds",
            "How long requests took to answer.",
            ("method", "route", "status"),
            buckets=_SECONDS,
            registry=self._registry,
        )
        self._appends = Histogram(
            "muster_log_append_seconds",
            "How long it took to write the log of a run.",
            buckets=_APPEND_S,
            registry=self._registry,
        )
        self._registry.register(self)

    def observe(self, completed: CompletedRequest) -> None:
        """Count a completed request; WebSockets are counted while they are open."""
        if completed.scope["type"] != "http":
            return
        method = completed.scope["method"]
        labels = (method if method in _METHODS else "other", _route(completed), f"{completed.status // 100}xx")
        self._requests.labels(*labels).observe(completed.seconds)

    def appended(self, seconds: float) -> None:
        """Count a write of a run's log."""
        self._appends.observe(seconds)

    def route(self) -> Route:
        async def metrics(_: Request) -> Response:
            text = await asyncio.to_thread(generate_latest, self._registry)
            return Response(text, media_type=CONTENT_TYPE_PLAIN_0_0_4)

        return Route("/metrics", metrics, methods=["GET"], include_in_schema=False)

    def collect(self) -> Iterator[Metric]:
        """Metrics that are read on request; called by the registry in a separate thread."""
        yield _gauge("muster_websockets", "WebSockets that are open.", self._shield.sockets.taken)
        yield _gauge("muster_memory_bytes", "Memory of the server process (RSS).", _memory_bytes())
        services = self._desk_of()
        if services is None:
            return
        yield _gauge("muster_workers_busy", "Pieces of work under way in worker processes.", services.pool.busy)
        yield _gauge("muster_work_waiting", "Pieces of work that wait for a worker process.", services.pool.waiting)
        yield _gauge("muster_watchers", "WebSockets that watch a run.", services.runs.watchers)
        yield _by("muster_robots", "Robots of runs under way, by what they do.", "activity", _activities(services))
        try:
            found = statistics(services.store)
        except StoreError:
            found = None  # counted below; the other metrics are still valid
        if found is not None:
            yield from _of_database(found)
        yield CounterMetricFamily(
            "muster_store_failures", "Times the database failed.", value=services.store.database.failures
        )


def _of_database(found: Statistics) -> Iterator[Metric]:
    yield _by("muster_jobs", "Jobs by state.", "state", {**dict.fromkeys(get_args(JobState), 0), **found.jobs})
    states = dict.fromkeys((state for state in get_args(RunState) if state != "resuming"), 0)  # which no database has
    yield _by("muster_runs", "Runs by state.", "state", {**states, **found.runs})
    means = (
        ("muster_job_seconds_mean", "How long the newest 20 jobs took.", found.job_s),
        ("muster_plan_gap_mean", "(objective - bound) / objective of the newest 20 plans made here.", found.gap),
        ("muster_run_flown_mean", "Measured objective over the planned one, of the newest 20 runs.", found.flown),
    )
    for name, what, value in means:
        if value is not None:
            yield _gauge(name, what, value)


def _gauge(name: str, what: str, value: float) -> Metric:
    return GaugeMetricFamily(name, what, value=value)


def _by(name: str, what: str, label: str, values: Mapping[str, int]) -> Metric:
    family = GaugeMetricFamily(name, what, labels=[label])
    for key, value in values.items():
        family.add_metric([key], value)
    return family


def _activities(services: Services) -> Counter[str]:
    """How many robots of runs under way have which activity, by the newest status."""
    activities: Counter[str] = Counter()
    for text in services.runs.statuses():
        activities.update(map(_activity, json.loads(text)["robots"].values()))
    return activities


def _activity(robot: Mapping[str, Any]) -> str:
    """What a robot does, without the station at which it does that."""
    activity: str = robot["activity"]
    station = robot.get("station", "")
    return activity.removesuffix(f" at {station}").removesuffix(f" to {station}") if station else activity


def _route(completed: CompletedRequest) -> str:
    """The template of the path: few values, whatever clients ask for."""
    route = completed.scope.get("route")
    path = getattr(route, "path_format", None) or getattr(route, "path", None)
    if path is None:
        return completed.path if completed.path in _OWN_PATHS else "other"
    return f"{completed.scope.get('root_path', '')}{path}"


def _memory_bytes() -> int:
    resident = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
    return int(resident) * resource.getpagesize()
