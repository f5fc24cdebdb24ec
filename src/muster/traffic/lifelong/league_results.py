"""The output file of the League of Robot Runners, and the figures of a run."""

from __future__ import annotations

import statistics
from collections import defaultdict
from typing import Any

from muster.traffic.lifelong.league_run import LeagueRun

_HEADING = "E"
"""All robots head east at first."""


def figures_of(run: LeagueRun) -> dict[str, Any]:
    """Return the figures of a run: counts, and seconds of planning a step."""
    return {
        "robots": len(run.actions),
        "steps": run.steps,
        "tasks_finished": run.finished,
        "tasks_revealed": len(run.revealed),
        "tasks_impossible": run.impossible,
        "tasks_per_step": run.finished / run.steps,
        "sum_of_costs": sum(run.busy_steps),
        "makespan": max(run.busy_steps),
        "greatest_step_s": max(run.seconds),
        "mean_step_s": statistics.mean(run.seconds),
    }


def league_output(run: LeagueRun) -> dict[str, Any]:
    """Return the object that the league writes as JSON: its fields, in its order."""
    width = run.instance.blocked.shape[1]
    paths = [",".join(actions) for actions in run.actions]
    schedule = _schedules(run)
    tasks = []
    for number, step in enumerate(run.revealed):
        cells = run.instance.tasks[number % len(run.instance.tasks)]
        tasks.append([number, step, [value for cell in cells for value in divmod(cell, width)]])
    return {
        "actionModel": "MAPF_T",
        "AllValid": "Yes",
        "teamSize": len(run.actions),
        "start": [[*divmod(cell, width), _HEADING] for cell in run.instance.starts],
        "numTaskFinished": run.finished,
        "sumOfCost": sum(run.busy_steps),
        "makespan": max(run.busy_steps),
        "actualPaths": paths,
        "plannerPaths": paths,
        "plannerTimes": run.seconds,
        "errors": [],
        "actualSchedule": schedule,
        "plannerSchedule": schedule,
        "scheduleErrors": [],
        "events": [list(event) for event in run.events],
        "tasks": tasks,
    }


def _schedules(run: LeagueRun) -> list[str]:
    """Return for each robot `step:task`, whenever it gets another task."""
    entries: dict[int, list[str]] = defaultdict(list)
    for step, robot, task in run.assignments:
        entries[robot].append(f"{step}:{task}")
    return [",".join(entries[robot]) for robot in range(len(run.actions))]
