"""Whether robots that are at their ends can close others out of theirs: in free traffic nobody makes room then."""

from __future__ import annotations

import math
from collections import deque

from muster.mission.model import Mission
from muster.motion.actions import TaskMotion, plan
from muster.traffic.names import drives

Place = tuple[float, float]


def can_close_out(mission: Mission) -> bool:
    """Whether robots at rest, one fewer than drive, can stand in a ring around a place where one more is to end.

    Walls are not looked at.
    """
    robots = [robot for robot in mission.all_robots if drives(robot)]
    if len(robots) < 2 or not mission.tasks:
        return False
    gap_m = 4 * max(robot.radius_m for robot in robots)  # between two at rest, through which none of them gets
    ends = _ends(mission)
    middle = tuple(sum(values) / len(values) for values in zip(*ends, strict=True))
    beside = {end: [other for other in ends if 0 < math.dist(end, other) < gap_m] for end in ends}
    inner_first = sorted(ends, key=lambda end: math.dist(end, middle))
    return any(_is_closed_in(end, beside, len(robots) - 1, gap_m) for end in inner_first)


def _ends(mission: Mission) -> list[Place]:
    """Where robots that drive may come to rest: at an end of their own, or where their last task leaves them."""
    ends: set[Place] = set()
    for robot in filter(drives, mission.all_robots):
        end = robot.place_at_end(mission.rules)
        if end is not None:
            ends.add((end[0], end[1]))
            continue
        for task in mission.tasks:
            if task.only_robots is None or robot.id in task.only_robots:
                motion = plan(task, robot)
                if isinstance(motion, TaskMotion):
                    ends.add((motion.exit[0], motion.exit[1]))
    return sorted(ends)


def _is_closed_in(place: Place, beside: dict[Place, list[Place]], most: int, gap_m: float) -> bool:
    """Whether at most so many of the other places make a closed ring around one."""
    near = [other for other in beside if 0 < math.dist(place, other) < most * gap_m / 2]
    return any(
        _ring_from(start, place, beside, most)
        for start in near
        if any(_crosses(place, start, other) for other in beside[start])
    )


def _ring_from(start: Place, place: Place, beside: dict[Place, list[Place]], most: int) -> bool:
    """Whether a ring of at most so many goes through a start: it crosses a ray from the place oddly often."""
    steps = {(start, False): 0}
    queue = deque(steps)
    while queue:
        at, odd = node = queue.popleft()
        if node == (start, True):
            return True
        if steps[node] < most:
            for other in beside[at]:
                after = (other, odd != _crosses(place, at, other))
                if other != place and after not in steps:
                    steps[after] = steps[node] + 1
                    queue.append(after)
    return False


def _crosses(place: Place, a: Place, b: Place) -> bool:
    """Whether the way from a to b crosses the ray from the place along the x axis."""
    if (a[1] > place[1]) == (b[1] > place[1]):
        return False
    return a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > place[0]
