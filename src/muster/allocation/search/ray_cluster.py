"""Improves parts of a team on a Ray cluster (extra `ray`). No other module uses Ray.

A part is a task of Ray's on one CPU. Ctrl-C, or the end of the time, cancels what is still at work: Ray then sends the
worker the signal that Ctrl-C sends, on which it returns the best it has. A worker that dies is replaced once; where
that does not help, or the cluster's head is lost, parts keep the routes they had, and a warning says so.
"""

from __future__ import annotations

import logging
import os
import signal
import socket
import subprocess
import sys
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any

from muster.allocation.search.workers import Job, Offer
from muster.allocation.stop import Stop
from muster.mission.errors import MissingExtraError, MusterError, ParameterError
from muster.mission.system.extras import needs_extra
from muster.mission.system.interrupts import on_ctrl_c

EXPECTED = "local, auto, HOST:PORT of the head from a machine of the cluster, or ray://HOST:PORT from any other"

_ATTEMPTS = 3
_LONGEST_TO_REACH_S = 5.0
_LONGEST_TO_ANSWER_S = 20.0  # Ray's own check has to start first
_LONGEST_TO_RETURN_S = 3.0  # after a job was told to end
_LOOK_EVERY_S = 0.1
_LOCAL_STORE = 100_000_000  # bytes of shared memory, where Ray would take a third of the machine's

_ENVIRONMENT = {
    "RAY_DEDUP_LOGS_SKIP_REGEX": ".*",  # Ray prints what goes wrong in the cluster, and to standard output
    "RAY_gcs_rpc_server_reconnect_timeout_s": "86400",  # after which Ray ends the process that has lost the head
    "RAY_USAGE_STATS_ENABLED": "0",  # a cluster of ours tells nobody of its use
}
"""What Ray reads when it is imported."""

_log = logging.getLogger(__name__)


@contextmanager
def joined(address: str) -> Iterator[Cluster]:
    """The cluster at an address while the block lasts.

    Parameters
    ----------
    address
        `local`: a cluster of this machine's cores, for as long as it is needed; `auto`: the one that this process has
        joined, or that runs on this machine; `HOST:PORT` of a head, on a machine of its cluster; `ray://HOST:PORT` of
        a head's client server, from anywhere.

    Raises
    ------
    MissingExtraError
        if Ray is not installed.
    ParameterError
        if no cluster is there, or it has no CPU.
    """
    for name, value in _ENVIRONMENT.items():
        os.environ.setdefault(name, value)
    with needs_extra("ray", "working on a Ray cluster"):
        import ray
    if ray.is_initialized():
        if address != "auto":
            raise ParameterError(f"ray: {address}, in a process that has joined a cluster; expected auto")
        yield Cluster(address, _cpus(address), None, _work())
        return
    _require_answer(address)
    with _handler_of_sigterm_kept():
        try:
            _join(address)
            yield Cluster(address, _cpus(address), _head(address), _work())
        finally:
            ray.shutdown()


def _join(address: str) -> None:
    """Join, more than once if need be.

    What speaks for Ray to those outside starts a process for each of them by a fork beside threads of gRPC, and that
    process may be dead at once (Ray 2.60); the next one may live. A head that was started with
    GRPC_ENABLE_FORK_SUPPORT=0 in its environment does not have this fault.
    """
    import ray

    try:
        for _ in range(_ATTEMPTS - 1):
            with suppress(ConnectionAbortedError):
                _init(address)
                return
        _init(address)
    except ImportError:
        raise MissingExtraError("ray", "joining a Ray cluster from outside") from None
    except (OSError, RuntimeError, ValueError, ray.exceptions.RayError) as error:
        raise _no_cluster(address, str(error)) from error


def _init(address: str) -> None:
    """Quietly: what Ray has to say is in its own log files."""
    import ray

    options: dict[str, Any] = {"log_to_driver": False, "logging_level": logging.ERROR}
    if address == "local":
        options |= {"include_dashboard": False, "object_store_memory": _LOCAL_STORE}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ray.init(address=address, **options)


def _work() -> Any:
    """The task of Ray's that does a job."""
    import ray

    return ray.remote(num_cpus=1, max_retries=1)(_done_by_worker)


def _head(address: str) -> str | None:
    """HOST:PORT that is reachable as long as the cluster exists; None where it is not known."""
    import ray

    if address.startswith("ray://"):
        return address.removeprefix("ray://")
    if ray.util.client.ray.is_connected():  # type: ignore[no-untyped-call]  # RAY_ADDRESS says what `auto` is
        return None
    return str(ray.get_runtime_context().gcs_address)


def _touch(place: str) -> None:
    """Raises OSError where nothing listens at HOST:PORT."""
    host, _, port = place.rpartition(":")
    socket.create_connection((host.strip("[]"), int(port)), _LONGEST_TO_REACH_S).close()


def _require_answer(address: str) -> None:
    """Ask whether there is a cluster, as Ray itself would wait for minutes, and at last end the process."""
    if address in ("local", "auto"):
        return
    scheme, slashes, place = address.rpartition("://")
    host, _, port = place.rpartition(":")
    if (slashes and scheme != "ray") or not host or not port.isdigit() or not 0 < int(port) < 2**16:
        raise ParameterError(f"ray: {address}; expected {EXPECTED}")
    try:
        _touch(place)
    except OSError as error:
        raise _no_cluster(address, error.strerror or str(error)) from None
    if scheme == "ray":
        return
    check = [sys.executable, "-m", "ray.scripts.scripts", "health-check", "--address", place]
    try:
        subprocess.run(check, timeout=_LONGEST_TO_ANSWER_S, capture_output=True, check=True)
    except subprocess.SubprocessError:
        raise _no_cluster(address, "what is there is not the head of a Ray cluster of this version") from None


def _no_cluster(address: str, why: str) -> ParameterError:
    return ParameterError(f"ray: {address}: no cluster ({' '.join(why.split())}); expected {EXPECTED}")


def _cpus(address: str) -> int:
    import ray

    resources: dict[str, float] = ray.cluster_resources()  # type: ignore[no-untyped-call]
    cpus = int(resources.get("CPU", 0))
    if cpus < 1:
        raise ParameterError(f"ray: {address}: a cluster without a CPU; expected one or more")
    return cpus


@contextmanager
def _handler_of_sigterm_kept() -> Iterator[None]:
    """Ray puts its own in its place, and leaves it there."""
    before = signal.getsignal(signal.SIGTERM)
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, before)


@dataclass(frozen=True)
class Cluster:
    """The workers of a Ray cluster, one on each of its CPUs."""

    address: str
    count: int
    head: str | None
    work: Any

    def map(self, jobs: Sequence[Job], stop: Stop) -> Iterator[Offer | None]:
        try:
            return iter(self._offers(jobs, stop))
        except OSError as error:
            _log.warning("ray: %s: the head was lost (%s); all parts keep the routes they had", self.address, error)
            return iter([None] * len(jobs))

    def _offers(self, jobs: Sequence[Job], stop: Stop) -> list[Offer | None]:
        """Raises OSError if the head is lost."""
        import ray

        self._look()
        if stop.due():
            return [None] * len(jobs)
        offers = [self.work.remote(job) for job in jobs]
        waiting = list(offers)
        try:
            while waiting and not stop.due():
                _, waiting = ray.wait(waiting, num_returns=len(waiting), timeout=_LOOK_EVERY_S)
                self._look()
        finally:
            with suppress(OSError):
                for offer in waiting:
                    ray.cancel(offer)
        returned, late = ray.wait(offers, num_returns=len(offers), timeout=_LONGEST_TO_RETURN_S)
        if late:
            _log.warning("ray: of %d parts nothing came back in time; they keep the routes they had", len(late))
        return [self._got(offer) if offer in returned else None for offer in offers]

    def _look(self) -> None:
        if self.head is not None:
            _touch(self.head)

    def _got(self, offer: Any) -> Offer | None:
        import ray

        try:
            got: Offer = ray.get(offer)
        except ray.exceptions.TaskCancelledError:  # before it had begun
            return None
        except ray.exceptions.RayTaskError as error:
            *_, last = str(error).strip().splitlines()
            expected = "Muster of this version on every machine"
            raise MusterError(f"ray: {self.address}: a worker fails ({last}); expected {expected}") from error
        except ray.exceptions.RayError as error:
            _log.warning("ray: a worker was lost (%s); its part keeps the routes it had", type(error).__name__)
            return None
        return got


def _done_by_worker(job: Job) -> Offer:
    """The work of a worker: the job, until a request to end."""
    whole = Stop()

    with on_ctrl_c(whole.interrupt):
        return job.done(whole)
