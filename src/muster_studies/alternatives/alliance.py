"""ALLIANCE-like allocation: robots whose motivation grows until they take a task, in the time of the mission.

The motivations of [parker1998], as reviewed by [auction-thesis], section 3.2: a free robot grows impatient to do each
task that it can do, the faster the sooner it would be done with it, and takes the first whose threshold is reached.
While another robot is at the task it grows impatient slowly, by `patience`; when it then reaches the threshold and
would be done sooner, it takes the task over, and the other acquiesces if it has been at it for `acquiescence` of the
time that it needs. A robot at a task is not motivated for others; when a robot begins a task, the motivation of all
others for it begins anew.

Deterministic, and no plan is ever improved: it shows what such a team does by itself. The plan is what the robots have
done in the end; what a robot spent on a task that was taken over is not in it. At most a few events a task, each of
which looks at all robots and tasks: about m n^2 steps in NumPy.
"""

from __future__ import annotations

from dataclasses import dataclass

from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.stop import Stop
from muster.mission.values.ranges import require_within
from muster.model.problem import Problem
from muster_studies.alternatives.motivation import Team


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of motivation.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    patience: float = 4.0  # how much slower motivation grows while another robot is at the task
    acquiescence: float = 0.5

    def __post_init__(self) -> None:
        require_within(1, 1e6, patience=self.patience)
        require_within(0, 1, acquiescence=self.acquiescence)


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Event by event, until all that robots can do is done; they go on from the ends of a start plan's routes."""
    team = Team(problem, params.patience, start or [[] for _ in problem.robots])
    while True:
        willing = team.next_willing(params.acquiescence)
        ending = team.next_end()
        if willing is None and ending is None:
            break
        if stop.due():
            stop.cut()
            break
        if ending is not None and (willing is None or team.ends[ending] <= willing[0]):
            team.finish(ending)
        elif willing is not None:
            team.begin(*willing)
    team.finish_all()
    stop.improved(*problem.value(team.routes))
    return Outcome(team.routes)


ALLIANCE = Allocator(
    name="alliance",
    summary="robots that grow impatient to do tasks, and acquiesce; reviewed in the auction thesis",
    anytime=False,
    parameters=Parameters,
    algorithm=allocate,
)
