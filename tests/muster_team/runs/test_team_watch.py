"""What the report says of processes: ends, silence, splits, and what was refused."""

from collections import Counter
from types import SimpleNamespace

import pytest

from muster.execution.reports.team_report import (
    EndReport,
    RefusedOrder,
    RefusedStatements,
    SilenceReport,
    SplitReport,
    TeamReport,
)
from muster_team.runs.team_watch import NO_ANSWER, RADIO_OFF, TeamWatch

ROBOTS = ["a", "b", "c"]


class Team:
    """A team that is looked at each second."""

    def __init__(self):
        self.watch, self.now_s = TeamWatch(ROBOTS, 4.0), 0.0
        self.ended, self.stopped, self.statuses, self.refused = {}, set(), {}, {}

    def goes_on(self, for_s, *groups):
        """Robots of a group count each other as members."""
        for _ in range(for_s):
            self.now_s += 1.0
            for group in groups:
                for robot in set(group) - self.stopped:
                    members = tuple(sorted(group))
                    refused = Counter(self.refused.get(robot, {}))
                    self.statuses[robot] = SimpleNamespace(members=members, not_admitted=refused)
            living = [robot for robot in ROBOTS if robot not in self.ended]
            self.watch.look(self.now_s, living, self.ended, self.statuses)

    @property
    def report(self):
        return self.watch.report()


@pytest.fixture
def team():
    team = Team()
    team.goes_on(3, "abc")
    return team


def test_where_nothing_happens_nothing_is_said(team):
    assert team.report == TeamReport()


def test_a_process_that_ends_is_said_each_time_and_is_no_split(team):
    team.ended["b"] = "killed by SIGKILL"
    team.goes_on(5, "ac")
    del team.ended["b"], team.statuses["b"]
    team.goes_on(1, "ac", "b")  # it has just started
    team.goes_on(1, "abc")
    team.ended["b"] = "ended with exit code 2"
    team.goes_on(1, "ac")
    assert team.report.ended == (
        EndReport(robot="b", at_s=4.0, why="killed by SIGKILL"),
        EndReport(robot="b", at_s=11.0, why="ended with exit code 2"),
    )
    assert team.report.splits == ()


def test_a_radio_that_is_off_makes_a_split_until_all_have_met_again(team):
    team.watch.radio("a", team.now_s, on=False)
    team.goes_on(4, "abc")
    team.goes_on(2, "a", "bc")
    team.watch.radio("a", team.now_s, on=True)
    team.goes_on(1, "a", "bc")
    team.goes_on(1, "abc")
    assert team.report.silent == (SilenceReport(robot="a", from_s=3.0, until_s=9.0, why=RADIO_OFF),)
    assert team.report.splits == (SplitReport(groups=(("a",), ("b", "c")), from_s=8.0, until_s=11.0),)


def test_groups_that_change_are_another_split_and_one_that_lasts_has_no_end(team):
    team.goes_on(2, "a", "bc")
    team.goes_on(2, "a", "b", "c")
    assert [(split.groups, split.until_s) for split in team.report.splits] == [
        ((("a",), ("b", "c")), 6.0),
        ((("a",), ("b",), ("c",)), None),
    ]


def test_a_process_that_does_not_answer_is_silent_from_its_last_word(team):
    team.stopped.add("c")
    team.goes_on(4, "abc")
    assert not team.report.silent
    team.goes_on(2, "ab")
    assert team.report.silent == (SilenceReport(robot="c", from_s=3.0, until_s=None, why=NO_ANSWER),)
    assert [split.groups for split in team.report.splits] == [(("a", "b"), ("c",))]
    team.stopped.clear()
    team.goes_on(1, "abc")
    assert team.report.silent == (SilenceReport(robot="c", from_s=3.0, until_s=10.0, why=NO_ANSWER),)


def test_refusals_of_all_lives_of_a_robot_are_counted_by_sender_and_reason(team):
    team.refused["a"] = {("b", "an epoch"): 2, ("c", "a name"): 1}
    team.goes_on(2, "abc")
    team.ended["a"] = "killed by SIGKILL"
    team.goes_on(1, "bc")
    del team.ended["a"], team.statuses["a"]
    team.refused["a"] = {("b", "an epoch"): 3}
    team.goes_on(2, "abc")
    assert team.report.refused_statements == (
        RefusedStatements(robot="a", sender="b", reason="an epoch", count=5),
        RefusedStatements(robot="a", sender="c", reason="a name", count=1),
    )


def test_an_order_that_all_refuse_is_said_once(team):
    order = RefusedOrder(robot="b", task="x", reason="there is a task")
    for robot in ROBOTS:
        team.watch.refused_by_team(robot, (order,))
    team.watch.refused_at_once("c", "new task: y")
    assert team.report.refused_orders == (RefusedOrder(robot="c", task="", reason="new task: y"), order)
