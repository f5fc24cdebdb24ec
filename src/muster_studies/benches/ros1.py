"""The bridge to ROS 1 under load: part of `muster bench`.

Fifty robots, each a process, publish odometry 20 times a second through a real ROS master, and go as they are told by
`cmd_vel`. The bridge is a process of its own, so that its processor time is its own (`ros1_load`).
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from muster.mission.errors import MusterError
from muster_robots.ros1.master import Master, running_master
from muster_studies.benches.measurement import Measurement

ROBOTS, RATE_HZ, WINDOW_S = 50, 20.0, 10.0


def ros1(runs: int) -> list[Measurement]:
    """Poses that arrive, how late, and what that costs; a window of time a run."""
    return under_load(runs, ROBOTS, WINDOW_S)


def under_load(runs: int, robots: int, window_s: float) -> list[Measurement]:
    """The same with any number of robots.

    Raises
    ------
    MissingExtraError
        if rospy or rosmaster is absent.
    MusterError
        if robots or the bridge end too early.
    """
    from muster_robots.ros1.extra import require_rospy

    require_rospy()
    with (
        tempfile.TemporaryDirectory() as folder,
        running_master(Path(folder)) as master,
        _process(master, "robots", robots, RATE_HZ),
        _process(master, "bridge", robots, runs, window_s) as bridge,
    ):
        windows = [json.loads(line) for line in bridge.stdout or ()]
        if bridge.wait() or len(windows) != runs:
            raise MusterError(f"the bridge measured {len(windows)} windows; expected {runs}")
    speeds = sum(window["driven_m"] for window in windows) / (runs * window_s)
    name = f"ROS 1, {robots} robots at {RATE_HZ:g} Hz: "
    rows = (
        ("poses heard", "poses / s", "arrived_hz", f">= {robots * RATE_HZ:.0f}", f"robots drove {speeds:.2f} m/s each"),
        ("lost", "poses", "lost", "0", f"of {robots * RATE_HZ * window_s:,.0f}"),
        ("latency, median", "ms", "median_ms", "< 10", "from the stamp until the port has it"),
        ("latency, 99 of 100", "ms", "late_ms", "< 50", ""),
        ("processor time", "CPU s / s", "processor", "< 1", "of the bridge's process, which steers all"),
    )
    return [
        Measurement.over_runs(name + what, unit, [window[key] for window in windows], aim, note)
        for what, unit, key, aim, note in rows
    ]


@contextmanager
def _process(master: Master, *arguments: object) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [sys.executable, "-m", "muster_studies.benches.ros1_load", *map(str, arguments)],
        env=os.environ | master.environment,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        yield process
    finally:
        process.terminate()
        process.communicate()
