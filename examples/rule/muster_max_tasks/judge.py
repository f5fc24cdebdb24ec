"""The rule for the judge, who shares no code with whoever plans."""

from muster.verification.verdict import Violation
from muster_max_tasks import RobotKeys


class MaxTasks:
    """A route has at most `max_tasks` tasks."""

    kind, ignorable = "max-tasks", True

    def violations(self, case, route):
        done, most = len(route.steps), route.robot.keys_of(RobotKeys).max_tasks
        if most is not None and done > most:
            yield Violation(self.kind, route.robot.id, None, f"{done} in its route, at most {most}")

    def prevents(self, case, route, task):
        most, more = route.robot.keys_of(RobotKeys).max_tasks, 2 if case.is_paired(task) else 1
        if most is not None and len(route.steps) + more > most:
            return True
        others = case.mission.robots if case.needs_others(task) else ()
        return None if any(robot.keys_of(RobotKeys).max_tasks for robot in others) else False
