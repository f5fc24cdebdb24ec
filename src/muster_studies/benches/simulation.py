"""Speed of the kinematic world, beside IR-SIM in the same run: part of `muster bench`.

The scene is a ring swap: robots on a circle go to the opposite side all at once. IR-SIM (package `ir-sim`, which pyrvo
brings along in the extra `studies`) runs it without a window, with its own reciprocal velocity obstacles.
"""

from __future__ import annotations

import contextlib
import logging
import math
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import yaml

from muster.mission.model import Mission, Robot
from muster.mission.system.extras import needs_extra
from muster.motion.port import Waypoint
from muster.simulation import KinematicWorld
from muster_studies.benches.measurement import Measurement

RADIUS_M, SPEED_MPS, DT_S, SPACING_M = 0.3, 1.0, 0.1, 1.9
"""The spacing is that of neighbours on the circle."""
LIMIT_S = 1_000.0
UNIT = "x real time"
COMPARED_S = 20.0
"""For so long both run where they are compared: 50 robots meet in the middle after 15 s."""


def ring(count: int) -> list[tuple[float, float]]:
    """Places on the circle, metres; the opposite of each is its negative."""
    radius = max(5.0, count * SPACING_M / (2 * math.pi))
    angles = [2 * math.pi * k / count for k in range(count)]
    return [(radius * math.cos(a), radius * math.sin(a)) for a in angles]


def swapped(count: int, seed: int, limit_s: float = LIMIT_S) -> tuple[float, float, KinematicWorld]:
    """Simulated seconds until all have arrived, but at most the limit; processor seconds; and the world."""
    places = ring(count)
    robots = (
        Robot(id=f"r_{k}", position=place, radius_m=RADIUS_M, speed_mps=SPEED_MPS) for k, place in enumerate(places)
    )
    world = KinematicWorld(Mission(robots=tuple(robots), tasks=()), seed=seed, dt_s=DT_S, avoidance="orca")
    for k, (x, y) in enumerate(places):
        world.ports[f"r_{k}"].send([Waypoint((-x, -y, 0.0))])
    left = count
    begin = time.process_time()
    while left and world.time_s < limit_s - DT_S / 2:
        left -= len(world.advance(limit_s))
    return world.time_s, time.process_time() - begin, world


def ir_sim_rate(count: int) -> float:
    """Simulated seconds per processor second of IR-SIM at the beginning of the same scene.

    Raises
    ------
    MissingExtraError
        if IR-SIM is not installed.
    """
    os.environ["MPLBACKEND"] = "Agg"  # no window
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    # It tells about windows that it cannot open.
    with needs_extra("studies", "the comparison with IR-SIM"), contextlib.redirect_stdout(sys.stderr):
        import irsim
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "ring.yaml"
        scene.write_text(yaml.safe_dump(_their_scene(count)), encoding="utf-8")
        world: Any = irsim.make(str(scene), headless=True, disable_all_plot=True, log_level="ERROR")
        begin = time.process_time()
        for _ in range(round(COMPARED_S / DT_S)):
            world.step()
        seconds = time.process_time() - begin
        world.end(0)
    return COMPARED_S / seconds


def _their_scene(count: int) -> dict[str, Any]:
    places = ring(count)
    side = 2.5 * max(x for x, _ in places)
    return {
        "world": {"height": side, "width": side, "offset": [-side / 2, -side / 2], "step_time": DT_S},
        "robot": [
            {
                "number": count,
                "distribution": {"name": "manual"},
                "kinematics": {"name": "omni"},
                "shape": {"name": "circle", "radius": RADIUS_M},
                "state": [[x, y, 0.0] for x, y in places],
                "goal": [[-x, -y, 0.0] for x, y in places],
                "vel_max": [SPEED_MPS, SPEED_MPS],
                "vel_min": [-SPEED_MPS, -SPEED_MPS],
                "behavior": [{"name": "rvo", "vxmax": SPEED_MPS, "vymax": SPEED_MPS, "acce": 10.0}],
            }
        ],
    }


def simulation(runs: int) -> list[Measurement]:
    """Times real time of a ring swap until all have arrived, on one core, a seed a run."""
    found = []
    for count, aim in ((6, ">= 1000"), (50, ">= 100"), (1_000, ">= 1")):
        ways = [swapped(count, seed) for seed in range(min(runs, 3) if count > 50 else runs)]
        rates = [simulated / seconds for simulated, seconds, _ in ways]
        contacts = sum(len(world.contacts) for _, _, world in ways)
        last = statistics.median(simulated for simulated, _, _ in ways)
        found.append(
            Measurement.over_runs(
                f"ring swap, {count:,} robots", UNIT, rates, aim, f"{last:.0f} s long, {contacts} contacts"
            )
        )
    return found + _compared(min(runs, 3))


def _compared(runs: int) -> list[Measurement]:
    """Both in the first seconds of the swap of 50, one after the other."""
    theirs, ours = [], []
    for seed in range(runs):
        theirs.append(ir_sim_rate(50))
        simulated, seconds, _ = swapped(50, seed, COMPARED_S)
        ours.append(simulated / seconds)
    name, ratio = f"{COMPARED_S:.0f} s of ring swap, 50 robots", statistics.median(ours) / statistics.median(theirs)
    return [
        Measurement.over_runs(f"{name}, Muster", UNIT, ours, "", f"{ratio:,.0f} times as fast as IR-SIM"),
        Measurement.over_runs(f"{name}, IR-SIM", UNIT, theirs, ""),
    ]
