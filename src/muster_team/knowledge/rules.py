"""The rules of a mission that what robots agree on has to respect, and the same with the tasks that were added."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from muster.mission.model import Task
from muster_team.knowledge.messages import Fact
from muster_team.knowledge.new_tasks import task_of


def _always_fits(contents: tuple[bytes, ...]) -> str:
    return ""


@dataclass(frozen=True)
class Rules:
    """The rules of the mission that a base has to respect.

    Parameters
    ----------
    robots, tasks
        all ids, in tie order: robots and tasks that come first win ties.
    prerequisites
        of each task; empty where they are ignored.
    once
        tasks that must not be begun twice, whatever happens to the network.
    linked
        whether prerequisites of added tasks count.
    teams
        tasks that several robots may own, as a team.
    joint
        tasks that several robots begin at the same moment: those of teams, and those tied by `starts_with`.
    tied
        whether teams, and whether `starts_with`, of added tasks count.
    misfit
        says why the mission with these added and moved tasks, as `new_tasks.content_of` writes them, is none that
        robots can agree on; empty: it is one.
    """

    robots: Mapping[str, int]
    tasks: Mapping[str, int]
    prerequisites: Mapping[str, Sequence[str]]
    once: frozenset[str] = frozenset()
    linked: bool = True
    teams: frozenset[str] = frozenset()
    joint: frozenset[str] = frozenset()
    tied: tuple[bool, bool] = (True, True)
    misfit: Callable[[tuple[bytes, ...]], str] = _always_fits

    @property
    def majority(self) -> int:
        """The size of a majority: any two groups of this many robots of the mission have one in common."""
        return len(self.robots) // 2 + 1

    def with_added(self, added: Sequence[Fact]) -> Rules:
        """The rules with these added tasks; a task that has moved belongs to the mission anyway."""
        tasks = [task_of(fact.content) for fact in added if fact.task not in self.tasks]
        if not tasks:
            return self
        return replace(
            self,
            tasks={**self.tasks, **{task.id: k for k, task in enumerate(tasks, len(self.tasks))}},
            prerequisites={**self.prerequisites, **{t.id: t.prerequisites if self.linked else () for t in tasks}},
            once=self.once | {task.id for task in tasks if task.across_partition == "at-most-once"},
            teams=self.teams | teams_among(tasks, self.tied),
            joint=self.joint | joint_among(tasks, self.tied),
        )


def teams_among(tasks: Iterable[Task], tied: tuple[bool, bool]) -> frozenset[str]:
    """The tasks that several robots may own; `tied` is as in `Rules`."""
    return frozenset(task.id for task in tasks if tied[0] and task.is_for_team)


def joint_among(tasks: Iterable[Task], tied: tuple[bool, bool]) -> frozenset[str]:
    """The tasks that several robots begin at the same moment; `tied` is as in `Rules`."""
    tasks = list(tasks)
    linked = {name for task in tasks if tied[1] and task.starts_with for name in (task.id, *task.starts_with)}
    return teams_among(tasks, tied) | linked
