"""Small random missions for auctions without a centre, by a random number generator."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from random import Random
from typing import Any

from muster.generation.places import random_place
from muster.generation.uniform import SIDE_M
from muster.mission.model import OBJECTIVES, Lag, Mission, Robot, Rules, Task, TeamPart

SKILLS = ("camera", "gripper")
LIFT = "lift_kg"
# What robots can agree on without a centre.
_AGREED = [objective for objective in OBJECTIVES if objective != "lateness"]


def random_mission(random: Random, *, robots: int, tasks: int, once: float, free: bool = False) -> Mission:
    """Robots r_0, r_1 ... and tasks 0, 1 ... in a square; prerequisites have lower numbers.

    `once` is the share of at-most-once tasks. If `free`, any robot can do any task.
    """
    linked, skilled, limited = (random.random() < share and not free for share in (0.5, 0.3, 0.5))
    return Mission(
        rules=Rules(objective=random.choice(_AGREED), return_to_start=random.random() < 0.3),
        robots=tuple(
            Robot(
                id=f"r_{k}",
                position=random_place(random, SIDE_M),
                work_capacity=random.choice((100.0, 200.0, 300.0)) if limited and random.random() < 0.7 else None,
                skills=tuple(skill for skill in SKILLS if random.random() < 0.7),
                speed_mps=random.choice((1.0, 1.0, 2.0)),
            )
            for k in range(robots)
        ),
        tasks=tuple(
            random_task(
                random,
                str(k),
                before=[str(j) for j in range(k) if linked and random.random() < 0.12],
                skilled=skilled,
                once=random.random() < once,
            )
            for k in range(tasks)
        ),
    )


def with_times(mission: Mission, random: Random) -> Mission:
    """The mission with windows, deadlines, due times, lags, shifts, teams, relations and ways back that count."""
    rules = replace(mission.rules, objective=random.choice(OBJECTIVES))
    robots = tuple(
        replace(robot, available_until_s=random.uniform(150, 500)) if random.random() < 0.3 else robot
        for robot in mission.robots
    )
    able = tuple(replace(robot, abilities={LIFT: random.choice((1.0, 2.0))}) for robot in robots)
    timed = [_with_times(task, random) for task in mission.tasks]
    tasks = [_with_others(task, timed[:k], random) for k, task in enumerate(timed)]
    rules = replace(rules, makespan_includes_return=random.random() < 0.8)
    return replace(mission, rules=rules, robots=able, tasks=tuple(tasks))


def _with_times(task: Task, random: Random) -> Task:
    opens = random.uniform(0, 200)
    closes = random.choice((None, opens + random.uniform(20, 150)))
    lags = {
        before: Lag(after_s=random.choice((0.0, 30.0)), within_s=random.choice((None, random.uniform(60, 200))))
        for before in task.prerequisites
        if random.random() < 0.5
    }
    return replace(
        task,
        window_s=((opens, closes),) if random.random() < 0.4 else (),
        deadline_s=random.uniform(80, 400) if random.random() < 0.3 else None,
        due_s=random.uniform(20, 300) if random.random() < 0.4 else None,
        lags={before: lag for before, lag in lags.items() if lag != Lag()},
    )


def _with_others(task: Task, before: Sequence[Task], random: Random) -> Task:
    """The task for a team, or tied to one of those before it; most are left as they are."""
    ties: list[dict[str, Any]] = [
        {"robots_needed": 2},
        {"team": (TeamPart(), TeamPart(requires=(random.choice(SKILLS),)))},
        {"needs": {LIFT: 3.0}},
    ]
    alone = [other for other in before if not other.is_for_team and other.id not in task.prerequisites]
    if alone:
        other = random.choice(alone)
        ties += [{"same_robot_as": (other.id,)}, {"other_robot_than": (other.id,)}]
        if not task.prerequisites and not other.prerequisites:  # else they could wait for each other
            ties.append({"starts_with": (other.id,)})
    return replace(task, **random.choice(ties)) if random.random() < 0.3 else task


def random_task(random: Random, name: str, *, before: list[str], skilled: bool, once: bool) -> Task:
    """A task in the square."""
    return Task(
        id=name,
        position=random_place(random, SIDE_M),
        prerequisites=tuple(before),
        requires=(random.choice(SKILLS),) if skilled and random.random() < 0.3 else (),
        actuation_cost=random.choice((0.0, 5.0)),
        across_partition="at-most-once" if once else "at-least-once",
    )
