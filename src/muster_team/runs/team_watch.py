"""Watches the processes of a team for the report: which end, which are silent, which groups count each other alone."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from muster.execution.reports.team_report import (
    EndReport,
    RefusedOrder,
    RefusedStatements,
    SilenceReport,
    SplitReport,
    TeamReport,
)
from muster_team.processes.node import NodeStatus

RADIO_OFF, NO_ANSWER = "its radio was off", "its process did not answer"

Groups = tuple[tuple[str, ...], ...]


class TeamWatch:
    """Watches the processes of a team.

    Parameters
    ----------
    robots
        All robots, in order.
    answers_within_s
        The longest time of the mission, seconds, between two reports of a process that answers.
    """

    def __init__(self, robots: Sequence[str], answers_within_s: float) -> None:
        self._robots, self._answers_within_s = robots, answers_within_s
        self._ended: list[EndReport] = []
        self._silent: list[SilenceReport] = []
        self._splits: list[SplitReport] = []
        self._down: set[str] = set()
        self._met: set[str] = set()  # robots that have been members of an epoch with another since they started
        self._lives: dict[str, int] = {}
        self._last: dict[tuple[str, int], NodeStatus] = {}  # by robot and number of its life
        self._heard_s: dict[str, float] = {}  # when the status of a robot came that is its last one
        self._at_once: list[RefusedOrder] = []  # refused by the robots to which they were given
        self._by_team: dict[str, Sequence[RefusedOrder]] = {}  # refused by all, as each robot last reported

    def look(
        self, now_s: float, living: Collection[str], ended: Mapping[str, str], statuses: Mapping[str, NodeStatus]
    ) -> None:
        """Take in the state of the processes at a time of the mission: which live, why others ended, what they say."""
        self._look_at_ends(now_s, living, ended)
        for robot in living:
            status, key = statuses.get(robot), (robot, self._lives.get(robot, 0))
            if status is not None and status is not self._last.get(key):
                self._last[key], self._heard_s[robot] = status, now_s
        self._look_at_answers(now_s, living)
        self._look_at_groups(now_s, {robot: statuses[robot].members for robot in living if robot in statuses})

    def radio(self, robot: str, now_s: float, *, on: bool) -> None:
        """Note that the radio of a robot was switched on or off."""
        if on:
            self._end_silence(robot, now_s, RADIO_OFF)
        else:
            self._silent.append(SilenceReport(robot=robot, from_s=now_s, until_s=None, why=RADIO_OFF))

    def refused_at_once(self, robot: str, reason: str) -> None:
        """Note that a robot refused an order that an operator gave it."""
        self._at_once.append(RefusedOrder(robot=robot, task="", reason=reason))

    def refused_by_team(self, robot: str, orders: Sequence[RefusedOrder]) -> None:
        """Note all orders that do not count, as a robot knows."""
        self._by_team[robot] = orders

    def report(self) -> TeamReport:
        """What was seen so far."""
        counts: dict[tuple[str, str, str], int] = {}
        for (robot, _), status in self._last.items():
            for (sender, reason), count in status.not_admitted.items():
                counts[robot, sender, reason] = counts.get((robot, sender, reason), 0) + count
        by_team = dict.fromkeys(order for orders in self._by_team.values() for order in orders)
        return TeamReport(
            ended=tuple(self._ended),
            silent=tuple(self._silent),
            splits=tuple(self._splits),
            refused_statements=tuple(
                RefusedStatements(robot=robot, sender=sender, reason=reason, count=count)
                for (robot, sender, reason), count in sorted(counts.items())
            ),
            refused_orders=(*self._at_once, *by_team),
        )

    def _look_at_ends(self, now_s: float, living: Collection[str], ended: Mapping[str, str]) -> None:
        for robot in sorted(self._down.intersection(living)):
            self._down.discard(robot)
            self._lives[robot] = self._lives.get(robot, 0) + 1
            self._heard_s.pop(robot, None)
        for robot, why in ended.items():
            if robot not in self._down:
                self._down.add(robot)
                self._met.discard(robot)
                self._ended.append(EndReport(robot=robot, at_s=now_s, why=why))
                for cause in (RADIO_OFF, NO_ANSWER):
                    self._end_silence(robot, now_s, cause)

    def _look_at_answers(self, now_s: float, living: Collection[str]) -> None:
        for robot in living:
            heard_s = self._heard_s.get(robot, now_s)
            if now_s - heard_s <= self._answers_within_s:
                self._end_silence(robot, now_s, NO_ANSWER)
            elif not self._is_silent(robot, NO_ANSWER):
                self._silent.append(SilenceReport(robot=robot, from_s=heard_s, until_s=None, why=NO_ANSWER))

    def _is_silent(self, robot: str, why: str) -> bool:
        return any((s.robot, s.why, s.until_s) == (robot, why, None) for s in self._silent)

    def _end_silence(self, robot: str, now_s: float, why: str) -> None:
        for k, silence in enumerate(self._silent):
            if (silence.robot, silence.why, silence.until_s) == (robot, why, None):
                self._silent[k] = replace(silence, until_s=now_s)

    def _look_at_groups(self, now_s: float, members: Mapping[str, Collection[str]]) -> None:
        groups = _groups([robot for robot in self._robots if robot in members], members)
        self._met.update(robot for group in groups if len(group) > 1 for robot in group)
        met = [tuple(robot for robot in group if robot in self._met) for group in groups]
        groups = tuple(group for group in met if group)
        before = self._splits[-1] if self._splits and self._splits[-1].until_s is None else None
        if before is not None and before.groups != groups:
            self._splits[-1] = replace(before, until_s=now_s)
        if len(groups) > 1 and (before is None or before.groups != groups):
            self._splits.append(SplitReport(groups=groups, from_s=now_s, until_s=None))


def _groups(robots: Sequence[str], members: Mapping[str, Collection[str]]) -> Groups:
    """Robots that count each other as members, if need be through others, in order."""
    groups: list[tuple[str, ...]] = []
    left = list(robots)
    while left:
        group, ahead = {left[0]}, [left[0]]
        while ahead:
            one = ahead.pop()
            near = [r for r in left if r not in group and r in members[one] and one in members[r]]
            group.update(near)
            ahead += near
        groups.append(tuple(robot for robot in left if robot in group))
        left = [robot for robot in left if robot not in group]
    return tuple(groups)
