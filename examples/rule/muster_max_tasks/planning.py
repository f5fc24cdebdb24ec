"""The rule for whoever plans: a meter that grows by one with each task."""

import math
from dataclasses import asdict, dataclass, replace

from muster.model.parts import Meter
from muster.model.rules import Change, Rule
from muster_max_tasks import RobotKeys


@dataclass(frozen=True)
class MoreTasks(Change):
    """A greater number of tasks of a robot: `enough` instead of `now`."""

    now: int
    enough: int | None

    plain = property(asdict)
    short = property(lambda self: f"max_tasks {self.enough} instead of {self.now}")

    def robot(self, robot):
        return replace(robot, extra={**robot.extra, "max_tasks": self.enough})

    def narrowed(self, found):
        return replace(self, enough=found.tasks) if found.tasks > self.now else None


class MaxTasks(Rule):
    """A route has at most `max_tasks` tasks; a team's task counts for each of its members."""

    word, key = "max-tasks", "max_tasks"
    lifted_late = of_a_route = of_the_team = True

    def compile(self, problem, parts):
        most = [robot.keys_of(RobotKeys).max_tasks or math.inf for robot in problem.robots]
        if min(most) < math.inf:
            parts.meter(Meter.count("tasks", problem.amounts(lambda task: 1), most))

    def lifted(self, problem, i, j, done):
        most = problem.robots[i].keys_of(RobotKeys).max_tasks
        return None if most is None else MoreTasks(most, None)
