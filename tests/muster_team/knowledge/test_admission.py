"""The entrance of statements: what no robot can mean is refused with its reason, and nothing that arrives raises."""

from dataclasses import replace

import pytest
from hypothesis import given
from tests.muster_team.messages import messages
from tests.muster_team.networks import line_mission

from muster import Task
from muster.model.problem import Problem
from muster_team.knowledge.admission import LONGEST_ORDER, MOST, admit
from muster_team.knowledge.messages import (
    Claim,
    Declaration,
    Fact,
    Heartbeat,
    Message,
    RoundBids,
    Sold,
    Stage,
)
from muster_team.knowledge.new_tasks import content_of
from muster_team.knowledge.verdicts import TAKEN, Refused
from muster_team.negotiators.participation import rules_of

RULES = rules_of(Problem.compile(line_mission(robots=3, tasks=4)))
MESSAGE = Message("r_0", 1, 1, Stage(1))
DECLARED = Declaration("r_0", 1, 1, ("r_0", "r_1"), (Claim("1", 2.0, 1),), (), 1, (1, -1))
ORDER = Fact("x", "r_0", "added", 1, content_of(Task(id="x", position=(1.0, 1.0))))


@given(messages)
def test_nothing_that_arrives_raises(message):
    assert isinstance(admit(RULES, message), Refused | type(TAKEN))


def test_what_robots_state_by_the_protocol_is_taken():
    claimed = replace(DECLARED, route=(Claim("1", 2.0, 1), Claim("x", 0, 2, True)), facts=(ORDER,))
    ready = Fact("1", "r_1", "ready", 3, b'[0,1.5,2.0,[["r_1","1"],["r_0","1"]]]')
    said = replace(
        MESSAGE,
        declarations=(DECLARED, claimed),
        bids=(RoundBids("r_1", 3, (("1", -1.0),)),),
        sales=(Sold("r_1", "2", 1.0, (("r_2", "2"),)),),
        facts=(ORDER, ready, Fact("later", "r_1", "done", 2), Fact("1", "r_1", "begun", 2, b"17")),
        heartbeats=(Heartbeat("r_0", 1, 1),),
        lacks=("r_1",),
    )
    assert admit(RULES, said) == TAKEN


@pytest.mark.parametrize(
    ("part", "reason"),
    [
        ({"sender": "zz"}, 'the robot "zz"'),
        ({"lacks": ("zz",)}, 'the robot "zz"'),
        ({"incarnation": MOST + 1}, "the number"),
        ({"stage": Stage(2**63 - 1)}, "the epoch or round"),
        ({"heartbeats": (Heartbeat("r_1", 2**60, 1),)}, "the incarnation or number"),
        ({"bids": (RoundBids("r_1", 1, (("1", float("-inf")),)),)}, "the price -inf"),
        ({"bids": (RoundBids("r_1", 1, (("", 1.0),)),)}, 'the task ""'),
        ({"sales": (Sold("r_1", "1", float("inf")),)}, "the price inf"),
        ({"sales": (Sold("r_1", "1", 1.0, (("zz", "1"),)),)}, 'the robot "zz"'),
        ({"facts": (Fact("1", "zz", "done", 1),)}, 'the robot "zz"'),
        ({"facts": (Fact("1", "r_1", "done", 2**60),)}, "the order"),
        ({"facts": (Fact("1", "r_1", "done", 1, b"x"),)}, "done with"),
        ({"facts": (Fact("1", "r_1", "begun", 1, b"soon"),)}, "begun in the incarnation"),
        ({"facts": (replace(ORDER, content=b"\0garbage"),)}, "a task as JSON"),
        ({"facts": (replace(ORDER, content=b"[" * 30_000),)}, "a task as JSON"),
        ({"facts": (replace(ORDER, content=b"{}"),)}, "id"),
        ({"facts": (replace(ORDER, content=b'{"id":"x","position":[1,1],"noise_limit":3}'),)}, "noise_limit"),
        ({"facts": (replace(ORDER, content=b" " * (LONGEST_ORDER + 1)),)}, "a task of 65537 bytes"),
        ({"facts": (replace(ORDER, task="y"),)}, 'the task "x" under the name "y"'),
        ({"facts": (replace(ORDER, kind="moved", content=b"{"),)}, "a task as JSON"),
        ({"facts": (Fact("1", "r_1", "ready", 1, b"[1,2,3]"),)}, "ready with"),
        ({"facts": (Fact("1", "r_1", "ready", 1, b'[0,1.0,NaN,[["r_1","1"]]]'),)}, "ready with"),
        ({"facts": (Fact("1", "r_1", "part", 1, b'[0,1.0,[["zz","1"]]]'),)}, "robots that there are not"),
        ({"facts": (Fact("1", "r_1", "left", 1, b"[-1]"),)}, "left with"),
        ({"declarations": (replace(DECLARED, robot="r_2"),)}, "members r_0, r_1 of"),
        ({"declarations": (replace(DECLARED, members=("r_0", "r_0")),)}, "members r_0, r_0 of"),
        ({"declarations": (replace(DECLARED, incarnations=()),)}, "0 incarnations of 2 members"),
        ({"declarations": (replace(DECLARED, rounds=2**62),)}, "the number"),
        ({"declarations": (replace(DECLARED, route=(Claim("nope", 1.0, 1),)),)}, 'a claim to "nope"'),
        ({"declarations": (replace(DECLARED, route=(Claim("1", 1.0, 1),) * 2),)}, 'a claim to "1"'),
        ({"declarations": (replace(DECLARED, facts=(Fact("1", "zz", "done", 1),)),)}, 'the robot "zz"'),
    ],
)
def test_what_no_robot_can_mean_is_refused_with_its_reason(part, reason):
    verdict = admit(RULES, replace(MESSAGE, **part))
    assert isinstance(verdict, Refused)
    assert reason in verdict.reason
