"""What holds today when a member of the team states well-formed things that are not so, and then falls silent.

No other robot ends, the rest agree without it, no task has two owners, and a task that comes later has one.
"""

from dataclasses import replace

import pytest

pytest.importorskip("msgpack", reason="the extra `net` is not installed")

from tests.muster_team.networks import agree, line_mission, network, owners

from muster import Task
from muster_team.knowledge.effects import Outgoing
from muster_team.knowledge.messages import Claim, Fact, Heartbeat, Message, RoundBids, Sold, Stage
from muster_team.knowledge.new_tasks import content_of
from muster_team.negotiators.negotiator import Negotiator
from muster_team.network.codec import Codec

MISSION = line_mission(robots=5, tasks=15)
TASKS = [task.id for task in MISSION.tasks]
LARGEST = 2**63 - 1
CODEC = Codec([robot.id for robot in MISSION.robots], TASKS)


class Liar(Negotiator):
    """Sends once, in place of what it would say, what `lie` makes of its own message."""

    lie = None

    def tick(self, now):
        said = super().tick(now)
        if self.lie is None:
            return said
        message = self.lie(Message(self.robot, self.incarnation, 10**6, self.stage))
        self.lie = None
        return [Outgoing(CODEC.decode(CODEC.encode(message)))]


def team():
    def make(robot, *rest, **more):
        return (Liar if robot == "r_4" else Negotiator)(robot, *rest, **more)

    net = network(MISSION, make=make, delay_s=0.02)
    net.start()
    return net


def told(net, lie):
    """The team some time after the lie, without its author, and with one task more."""
    author = net.nodes["r_4"]
    author.lie = lie
    net.run(net.now + 1)
    assert author.lie is None
    net.crash("r_4")
    net.nodes["r_0"].announce(Task(id="new", position=(1.0, 1.0)))
    agree(net, 60)
    return {task: len(robots) for task, robots in owners(net).items()}


def added(name, **keys):
    return Fact(name, "r_4", "added", 5, content_of(Task(id=name, position=(1.0, 1.0), **keys)))


@pytest.mark.parametrize(
    ("facts", "unowned"),
    [
        ([added("x", prerequisites=("nowhere",))], []),
        ([added("x", prerequisites=("x",))], []),
        ([added("x", robots_needed=9)], []),
        ([Fact("nowhere", "r_4", "done", 3), Fact("nowhere", "r_4", "cancelled", 4)], []),
        ([Fact(task, "r_4", "done", k) for k, task in enumerate(TASKS, 1)], TASKS),
        ([Fact(task, "r_4", "cancelled", k) for k, task in enumerate(TASKS, 1)], TASKS),
    ],
)
def test_facts_that_are_not_so_are_known_to_all_and_end_nobody(facts, unowned):
    net = team()
    agree(net)
    owned = told(net, lambda own: replace(own, facts=tuple(facts)))
    assert all(node.facts >= set(facts) for node in net.nodes.values())
    assert owned == dict.fromkeys(["new", *(task for task in TASKS if task not in unowned)], 1)


@pytest.mark.parametrize(
    "claims",
    [
        [Claim(task, 0.0, 1, begun=True) for task in TASKS],
        [Claim(task, float("-inf"), 1) for task in TASKS],
        [Claim("3", -9.0, 1)] * 3,
    ],
)
@pytest.mark.parametrize("changes", [{}, {"rounds": LARGEST}, {"members": ("r_0", "nobody")}])
def test_claims_to_all_tasks_are_void_once_their_author_is_gone(claims, changes):
    net = team()
    agree(net)

    def lie(own):
        epoch = own.stage.epoch + 1
        said = replace(net.nodes["r_4"].epoch.own, epoch=epoch, route=tuple(claims), **changes)
        return replace(own, declarations=(said,), stage=Stage(epoch))

    assert told(net, lie) == dict.fromkeys(["new", *TASKS], 1)


@pytest.mark.parametrize(
    "changes",
    [
        {"stage": Stage(1000)},
        {"heartbeats": (Heartbeat("nobody", 2, 1),)},
        {"lacks": ("nobody",), "unheard": ("nobody",), "agreed": ("nobody",)},
        {"known": 12345},
    ],
)
def test_progress_and_robots_that_there_are_not_hold_up_nobody(changes):
    net = team()
    agree(net)
    assert told(net, lambda own: replace(own, **changes)) == dict.fromkeys(["new", *TASKS], 1)


@pytest.mark.parametrize(
    "changes",
    [
        lambda own: {"bids": (RoundBids("r_4", own.stage.round, (("3", float("-inf")),)),)},
        lambda own: {"sales": (Sold("r_4", "14", 0.0), Sold("r_4", "3", 0.0))},
        lambda own: {"stage": replace(own.stage, ended=True)},
    ],
)
def test_other_results_of_past_rounds_second_bids_and_an_end_too_early_change_nothing_for_the_others(changes):
    net = team()
    assert net.run(1.0, lambda: net.nodes["r_4"].stage.round >= 3)
    assert told(net, lambda own: replace(own, **changes(own))) == dict.fromkeys(["new", *TASKS], 1)
