"""Speed of lasers in both worlds: part of `muster bench`."""

from __future__ import annotations

import time

from muster.perception.laser import Scanner
from muster.planning.loading import load
from muster.running.worlds import WORLDS, world_named
from muster.simulation import SimulatedWorld
from muster_studies.benches.measurement import Measurement

MISSIONS = ("market-rescue-arena", "floor")
SCANS = 300
_AIM = ">= 100"
"""Ten robots with scanners of ten scans a second, in real time."""


def lasers(runs: int) -> list[Measurement]:
    """Scans a second of the scanner of [market-paper], in each world, on one core.

    Raises
    ------
    MissingExtraError
        if MuJoCo is not installed.
    """
    return [_scans(mission, world, runs) for mission in MISSIONS for world in WORLDS.shipped]


def _scans(mission: str, name: str, runs: int) -> Measurement:
    world: SimulatedWorld = world_named(name)(load(mission))
    robot, scanner = next(iter(world.ports)), Scanner()
    beams = len(world.scan(robot, scanner))  # the model is made
    rates = []
    for _ in range(runs):
        begin = time.process_time()
        for _ in range(SCANS):
            world.scan(robot, scanner)
        rates.append(SCANS / (time.process_time() - begin))
    return Measurement.over_runs(f"laser, {mission}, {name}", "scans / CPU s", rates, _AIM, f"{beams} beams of 4 m")
