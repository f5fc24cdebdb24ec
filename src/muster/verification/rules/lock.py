"""A task with `only_robots` is done by one of those robots."""

from __future__ import annotations

from muster.mission.model import Mission, Robot, Task
from muster.verification.rules.pair_rule import PairRule


class Lock(PairRule):
    """The robot is one of `only_robots_j`, where these are given."""

    kind = "lock"

    def refusal(self, mission: Mission, robot: Robot, task: Task) -> str | None:
        if task.only_robots is None or robot.id in task.only_robots:
            return None
        return f"only for {', '.join(task.only_robots)}"
