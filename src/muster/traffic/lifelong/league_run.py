"""A run of robots with headings that carry out tasks without end, by the rules of the League of Robot Runners.

The core assigns tasks and decides moves: operations of several actions by priority inheritance, improved by large
neighbourhood search ([yukhnevich2025]). The work of a step is limited by numbers, so that one seed gives one run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from muster import core
from muster.mission.system.clock import Clock, SystemClock
from muster.mission.values.ranges import require_counts
from muster.traffic.lifelong.league_instance import LeagueInstance

CHECKS = 1_000_000
"""Operations that are checked in a step, about: samples of moves are made until then."""


@dataclass(frozen=True, eq=False)
class LeagueRun:
    """What came of a run.

    Parameters
    ----------
    instance : LeagueInstance
        What was run.
    actions : list[str]
        Of each robot, a letter for each step: F forward, R clockwise, C counter-clockwise, W wait.
    revealed : list[int]
        Of each task that was revealed, the step. Task k has the cells of `instance.tasks[k % len(instance.tasks)]`.
    assignments : list[tuple[int, int, int]]
        (step, robot, task), whenever a robot gets another task before a step; -1 for none.
    events : list[tuple[int, int, int, int]]
        (step, robot, task, number of its cells visited), whenever a robot visits a cell of its task.
    busy_steps : list[int]
        Of each robot, the number of steps in which it had a task.
    finished : int
        The number of tasks that are finished.
    impossible : int
        The number of revealed tasks that no robot can finish: no way leads to all their cells.
    seconds : list[float]
        How long each step took to plan.
    """

    instance: LeagueInstance
    actions: list[str]
    revealed: list[int]
    assignments: list[tuple[int, int, int]]
    events: list[tuple[int, int, int, int]]
    busy_steps: list[int]
    finished: int
    impossible: int
    seconds: list[float] = field(default_factory=list)

    @property
    def steps(self) -> int:
        """The number of steps that were taken."""
        return len(self.seconds)


def run_league(
    instance: LeagueInstance,
    steps: int,
    *,
    checks: int = CHECKS,
    seed: int = 0,
    clock: Clock | None = None,
    progress: Callable[[int, int], bool] | None = None,
) -> LeagueRun:
    """Run an instance for a number of steps.

    Parameters
    ----------
    instance : LeagueInstance
        Robots and tasks.
    steps : int
        The number of steps, at least 1.
    checks : int
        Operations that are checked in a step, about, at least 0; one sample of moves is made in any case.
    seed : int
        Of what is random; the same seed gives the same run.
    clock : Clock, optional
        Measures the steps; by default real time.
    progress : Callable[[int, int], bool], optional
        Called after each step with the number of steps and of finished tasks; the run ends early if it returns False.

    Raises
    ------
    ParameterError
        if a number is too small.
    """
    require_counts(1, steps=steps)
    require_counts(0, checks=checks, seed=seed)
    clock = clock or SystemClock()
    errands = core.LifelongErrands(
        instance.blocked, instance.starts, instance.tasks, revealed=instance.revealed, checks=checks, seed=seed
    )
    seconds = []
    for step in range(1, steps + 1):
        begin = clock.now()
        errands.advance()
        seconds.append(clock.now() - begin)
        if progress is not None and not progress(step, errands.finished):
            break
    return LeagueRun(
        instance,
        errands.actions,
        errands.revealed,
        errands.assignments,
        errands.events,
        errands.busy_steps,
        errands.finished,
        errands.impossible,
        seconds,
    )
