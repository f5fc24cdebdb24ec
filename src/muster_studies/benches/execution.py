"""Speed of re-planning during execution: part of `muster bench`.

Twenty robots are under way to a hundred tasks at random places; after a while the one that has most left to do fails.
The same rest planned by greedy, the work under way kept, is the measure of how good the new plan is.
"""

from __future__ import annotations

import time
from dataclasses import replace
from random import Random

from muster.allocation.algorithms.greedy import GREEDY
from muster.allocation.stop import Stop
from muster.execution import Executor, Reallocation, Revision, travel_of
from muster.execution.replanning.remaining_problem import RemainingMission, remaining_problem
from muster.generation.uniform import uniform_mission
from muster.mission.model import Event, Mission, Rules
from muster.mission.plan import Plan, Route
from muster.planning.judging import verify
from muster.planning.solve import solve
from muster.simulation import KinematicWorld
from muster_studies.benches.measurement import Measurement

ROBOTS, TASKS, SIDE_M, FAILS_S = 20, 100, 200.0, 60.0


def scene(seed: int, stability: int | None) -> Mission:
    """Robots and tasks at random places of a square."""
    mission = uniform_mission(Random(seed), robots=ROBOTS, tasks=TASKS, side_m=SIDE_M)
    return replace(
        mission,
        rules=Rules(stability=stability),
        robots=tuple(replace(robot, radius_m=0.3) for robot in mission.robots),
        tasks=tuple(replace(task, duration_s=5.0) for task in mission.tasks),
    )


class _Timed:
    """A re-allocation that records its problem, its answer, and its time in seconds."""

    def __init__(self, replan: Reallocation) -> None:
        self._replan = replan
        self.rest: RemainingMission
        self.revision: Revision
        self.seconds = 0.0

    def __call__(self, rest: RemainingMission) -> Revision:
        begin = time.perf_counter()
        self.rest, self.revision = rest, self._replan(rest)
        self.seconds = time.perf_counter() - begin
        return self.revision


def after_a_failure(seed: int, stability: int | None) -> tuple[float, float, float]:
    """Seconds that re-allocation took; and the objective of its plan, and of greedy's for the same rest."""
    mission = scene(seed, stability)
    travel = travel_of(mission)
    timed = _Timed(Reallocation(travel=travel, seed=seed))
    world = KinematicWorld(mission, seed=seed, avoidance="orca")
    executor = Executor(mission, solve(mission, iterations=3000, seed=seed), world.ports, replan=timed)
    while world.time_s < FAILS_S:
        executor.tick(world.time_s)
        world.advance(min(FAILS_S, world.time_s + 0.5))
    executor.tick(world.time_s)
    executor.report(Event(at_s=0, robot_fails=max(executor.crew.values(), key=lambda hand: len(hand.route)).robot.id))
    executor.tick(world.time_s)
    problem = remaining_problem(timed.rest, travel).problem.ready()
    begun = {robot.id: [problem.tasks[j].id for j in problem.beginning(i)] for i, robot in enumerate(problem.robots)}
    routes = tuple(Route(name, (*begun[name], *tasks)) for name, tasks in timed.revision.routes.items())
    plans = Plan(objective=problem.objective, routes=routes), GREEDY.solve(problem, Stop())
    ours, greedy = (verify(problem.mission, plan).value() for plan in plans)
    assert ours is not None
    assert greedy is not None
    return timed.seconds, ours, greedy


def reallocation(runs: int) -> list[Measurement]:
    """After one failure, with the mission's usual stability and with any."""
    found = []
    for stability, what in ((3, "stability 3"), (None, "any may change robot")):
        outcomes = [after_a_failure(seed, stability) for seed in range(runs)]
        gain = sum(ours / greedy - 1 for _, ours, greedy in outcomes) / runs
        worse = sum(ours >= greedy for _, ours, greedy in outcomes)
        note = f"objective {100 * gain:+.1f} % against greedy, {worse} of {runs} not better"
        name = f"planning again after a failure, {ROBOTS} robots, {TASKS} tasks, {what}"
        found.append(Measurement.over_runs(name, "s", [seconds for seconds, *_ in outcomes], "< 0.2", note))
    return found
