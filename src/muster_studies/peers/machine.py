"""What a comparison ran on: the machine and the versions of the solvers."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from muster.mission.errors import ParameterError
from muster_studies.effort import Effort
from muster_studies.peers.peer import Peer, missing


def machine() -> str:
    """Processor, its cores, how busy they were, and Python."""
    load = f"load average {os.getloadavg()[2]:.1f} over the last 15 minutes"
    system = f"{platform.system()}, Python {platform.python_version()}"
    return f"{_processor()}, {os.cpu_count()} cores, {load}; {system}"


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    frequencies = [float(line.split(":", 1)[1]) for line in lines if line.startswith("cpu MHz")]
    if not names:
        return platform.processor() or platform.machine()
    return names[0] + (f" at {frequencies[0] / 1000:.1f} GHz" if frequencies else "")


def versions(peers: Iterable[Peer]) -> dict[str, str]:
    """The version of each peer's distribution.

    Raises
    ------
    MissingExtraError
        if one is not installed.
    """
    found = {}
    for peer in peers:
        try:
            found[peer.distribution] = version(peer.distribution)
        except PackageNotFoundError:
            raise missing(peer.name) from None
    return found


def require_comparable(effort: Effort, peers: Iterable[Peer]) -> None:
    """Refuse iterations, which mean something else to each solver.

    Raises
    ------
    ParameterError
    MissingExtraError
        if a peer is not installed.
    """
    if effort.iterations is not None:
        raise ParameterError(f"iterations: {effort.iterations}; expected none: all solvers have the same time")
    versions(peers)


def machine_and_versions(peers: Iterable[Peer]) -> str:
    """The line about both that stands above a comparison."""
    numbers = ", ".join(f"{name} {number}" for name, number in versions(peers).items())
    return f"Machine: {machine()}. Versions: {numbers}."
