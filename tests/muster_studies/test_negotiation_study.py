"""`muster study negotiation`: what is counted, and that loss costs messages, never the plan."""

import json

import pytest

pytest.importorskip("msgpack", reason="the extra `net` is not installed")

from muster.cli.main import run as muster
from muster.model.problem import Problem
from muster_studies.effort import Effort
from muster_studies.negotiation.study import AuctionRun, Cost, hold
from muster_team.negotiators.methods import METHODS


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("method", METHODS)
def test_loss_costs_messages_and_never_the_plan(method):
    lossless, lossy = (hold(AuctionRun(method, 6, loss, 1)) for loss in (0.0, 0.3))
    assert lossless.gap == lossy.gap
    assert lossless.repairs == 0
    assert (lossy.news, lossy.rounds) == (lossless.news, lossless.rounds)
    assert lossy.repairs > 0
    assert lossy.bytes > lossless.bytes > 0


def test_an_auction_has_a_round_a_task_and_a_bid_a_robot_a_round():
    talk = AuctionRun("auction", 6, 0.0, 2)
    said, tasks = hold(talk), len(talk.mission.tasks)
    assert (said.rounds, said.news) == (tasks, 6 * (tasks + 2))  # one declaration, and a last round without bids
    assert Problem.compile(talk.mission).objective == "total+max"


def test_large_teams_are_tried_with_few_seeds():
    jobs = list(Cost().jobs(Effort()))
    assert sum(talk.robots == 100 for talk in jobs) == 4
    assert sum(talk.robots == 5 for talk in jobs) == 40


@pytest.mark.long
def test_the_command(tmp_path, capsys):
    pytest.importorskip("matplotlib")
    arguments = ["study", "negotiation", "--quick", "--seeds", "1", "--format", "json", "--plot", str(tmp_path)]
    assert muster(arguments) == 0
    (table,) = json.loads(capsys.readouterr().out)["tables"]
    assert {row["method"] for row in table["rows"]} == set(METHODS)
    assert all(row["gap %"] >= -1 for row in table["rows"])
    assert (tmp_path / "negotiation.png").stat().st_size > 10_000
