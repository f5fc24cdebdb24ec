"""Speed of collision avoidance, beside RVO2 through its binding pyrvo: part of `muster bench`."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np

from muster.mission.system.extras import needs_extra
from muster.mission.values.arrays import Floats
from muster.motion.avoidance import Agents, Orca
from muster.motion.avoidance.orca import Parameters
from muster_studies.benches.measurement import Measurement

RADIUS_M, TOP_SPEED_MPS, SPACING_M, DT_S = 1.5, 2.0, 4.5, 0.25
HORIZON_S, NEIGHBOURS, DISTANCE_M = 10.0, 10, 15.0
STEPS = 20
"""Of one run; the median of them counts, so that one that was interrupted does not."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Robots on a jittered grid of 4.5 m, half of the ground covered, with random preferred directions."""

    positions: Floats
    preferred: Floats

    @classmethod
    def random(cls, count: int, seed: int) -> Scene:
        """A random scene."""
        random, side = np.random.default_rng(seed), int(np.ceil(np.sqrt(count)))
        grid = SPACING_M * np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)[:count]
        jitter = 0.5 * (SPACING_M - 2 * RADIUS_M)
        angles = random.uniform(0, 2 * np.pi, count)
        preferred = 0.75 * TOP_SPEED_MPS * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return cls(grid + random.uniform(-jitter, jitter, grid.shape), preferred)


def muster_ms(scene: Scene, keep_apart: bool = True) -> float:
    """Milliseconds of processor time of a step of ORCA, with the conversion of all arrays; the median of some steps."""
    parameters = Parameters(
        horizon_s=HORIZON_S,
        wall_horizon_s=HORIZON_S,
        most_neighbours=NEIGHBOURS,
        neighbour_distance_m=DISTANCE_M,
        keep_apart=keep_apart,
    )
    count, method = len(scene.positions), Orca(parameters)
    radii, speeds = np.full(count, RADIUS_M), np.full(count, TOP_SPEED_MPS)
    positions, velocities, found = scene.positions, np.zeros_like(scene.positions), []
    for _ in range(STEPS):
        begin = time.process_time()
        agents = Agents(
            positions=positions, velocities=velocities, preferred=scene.preferred, radii=radii, max_speeds=speeds
        )
        velocities = method.velocities(agents, dt=DT_S)
        found.append(1000 * (time.process_time() - begin))
        positions = positions + DT_S * velocities
    return statistics.median(found)


def rvo2_ms(scene: Scene) -> float:
    """Milliseconds of processor time of a step of RVO2, in C++ alone; the median of some steps.

    Raises
    ------
    MissingExtraError
        if pyrvo is not installed.
    """
    simulator = rvo2(scene)
    found = []
    for _ in range(STEPS):
        begin = time.process_time()
        simulator.do_step()
        found.append(1000 * (time.process_time() - begin))
    return statistics.median(found)


def rvo2(scene: Scene) -> Any:
    """A simulator of RVO2 with the scene's robots."""
    with needs_extra("studies", "comparing with RVO2"):
        import pyrvo
    simulator = pyrvo.RVOSimulator(DT_S, DISTANCE_M, NEIGHBOURS, HORIZON_S, HORIZON_S, RADIUS_M, TOP_SPEED_MPS)
    for (x, y), (vx, vy) in zip(scene.positions, scene.preferred, strict=True):
        agent = simulator.add_agent((x, y))
        simulator.set_agent_pref_velocity(agent, (vx, vy))
    return simulator


def compared(count: int, runs: int) -> dict[str, list[float]]:
    """By program milliseconds of processor time of a step, for scenes with the seeds 0 to runs - 1.

    RVO2 is left out where pyrvo is not installed.
    """
    programs: dict[str, Callable[[Scene], float]] = {
        "Muster": muster_ms,
        "Muster, without keep_apart": lambda scene: muster_ms(scene, keep_apart=False),
        "RVO2": rvo2_ms,
    }
    if find_spec("pyrvo") is None:
        del programs["RVO2"]
    scenes = [Scene.random(count, seed) for seed in range(runs)]
    times: dict[str, list[float]] = {name: [] for name in programs}
    for scene in scenes:
        for name, program in programs.items():
            times[name].append(program(scene))
    return times


def avoidance(runs: int) -> list[Measurement]:
    """A step of ORCA for many robots, beside RVO2 in the same run."""
    found = []
    for count, aim in ((1_000, "< 10"), (10_000, "< 150")):
        times = compared(count, runs)
        for program, milliseconds in times.items():
            name, ours = f"ORCA step, {count:,} robots, {program}", program != "RVO2"
            note = _beside(milliseconds, times.get("RVO2")) if ours else ""
            found.append(Measurement.over_runs(name, "CPU ms", milliseconds, aim if ours else "", note))
    return found


def _beside(milliseconds: list[float], rvo2: list[float] | None) -> str:
    if rvo2 is None:
        return "beside RVO2 with: pip install 'muster-robotics[studies]'"
    return f"{statistics.median(milliseconds) / statistics.median(rvo2):.2f} of the time of RVO2"
