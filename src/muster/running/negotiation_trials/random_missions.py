"""Small random missions for auctions without a centre, by a random number generator."""

from __future__ import annotations

from random import Random

from muster.mission.model import OBJECTIVES, Mission, Robot, Rules, Task

SIDE_M = 100.0
SKILLS = ("camera", "gripper")
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
                position=random_place(random),
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


def random_task(random: Random, name: str, *, before: list[str], skilled: bool, once: bool) -> Task:
    """A task in the square."""
    return Task(
        id=name,
        position=random_place(random),
        prerequisites=tuple(before),
        requires=(random.choice(SKILLS),) if skilled and random.random() < 0.3 else (),
        actuation_cost=random.choice((0.0, 5.0)),
        across_partition="at-most-once" if once else "at-least-once",
    )


def random_place(random: Random, side_m: float = SIDE_M) -> tuple[float, float]:
    """A place in a square of that side, metres."""
    return random.uniform(0, side_m), random.uniform(0, side_m)
