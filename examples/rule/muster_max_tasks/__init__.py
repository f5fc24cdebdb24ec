"""A rule for Muster: a robot does at most so many tasks."""

from muster.mission.declared_rules import DeclaredRule
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Whole


@record
class RobotKeys(Checked):
    """What a mission says of a robot."""

    max_tasks: int | None = spec(Whole(minimum=1), "it does at most so many tasks", default=None, if_used=True)


MAX_TASKS = DeclaredRule(
    order=145,  # behind `capacity`
    planning="muster_max_tasks.planning:MaxTasks",
    judge="muster_max_tasks.judge:MaxTasks",
    robot=RobotKeys,
)
