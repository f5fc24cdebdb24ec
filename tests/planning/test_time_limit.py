"""Allocators look at the clock, and what the time limit cuts short says so."""

import dataclasses

import numpy as np
import pytest

from muster import core
from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.auctioneer import Auctioneer
from muster.allocation.registry import allocator_of
from muster.allocation.stop import PATIENCE, Stop
from muster.cli.main import run
from muster.mission.model import Mission, Robot, Task
from muster.mission.system.clock import SystemClock, VirtualClock
from muster.model.problem import Problem
from muster.planning.budget import Budget, Pace
from muster.planning.request import Request
from muster.planning.solving import answer
from muster_studies.alternatives.ant_colony import built

CONSTRUCTIVE = ("greedy", "auction", "contract-net", "alliance", "combinatorial-auction", "bertsekas-auction")


class Ticking:
    """A clock that goes on by a second whenever somebody looks at it."""

    def __init__(self):
        self.looks = 0

    def now(self):
        self.looks += 1
        return float(self.looks)


def mission(*, team=False):
    tasks = [Task(id=str(k), position=(7.0 * k % 11, 5.0 * k % 13)) for k in range(30)]
    if team:
        tasks[0] = dataclasses.replace(tasks[0], robots_needed=2)
    robots = tuple(Robot(id=f"r{k}", position=(float(k), 0.0)) for k in range(3))
    return Mission(name="limit", robots=robots, tasks=tuple(tasks))


@pytest.mark.parametrize(
    ("name", "team"), [*((name, False) for name in CONSTRUCTIVE), ("greedy", True), ("auction", True)]
)
def test_an_allocator_that_runs_out_of_time_says_so(name, team):
    problem = Problem.compile(mission(team=team))
    some, whole = Stop(time_limit=12.0 / PATIENCE, clock=Ticking()), Stop()
    plan = allocator_of(name).solve(problem, some)
    assert plan.cut_short
    assert not plan.complete
    complete = allocator_of(name).solve(problem, whole)
    assert complete.complete
    assert not complete.cut_short


@pytest.mark.parametrize(("name", "team"), [("auction", True), ("combinatorial-auction", False)])
def test_the_book_of_an_auction_that_was_cut_short_has_its_bids(name, team):
    limit = (70.0 if team else 12.0) / PATIENCE
    plan = allocator_of(name).solve(Problem.compile(mission(team=team)), Stop(time_limit=limit, clock=Ticking()))
    bids = []
    plan.book.for_each_bid(bids.append)
    assert not plan.complete
    assert plan.book.rounds > 0
    assert {bid.round for bid in bids} == set(range(1, plan.book.rounds + 1))


def test_an_auction_announces_a_large_mission_piece_by_piece(monkeypatch):
    """So that no time limit passes while all robots look at all tasks."""
    monkeypatch.setattr("muster.allocation.auctions.auctioneer._PAIRS_AT_ONCE", 3)
    problem = Problem.compile(mission())
    cut = Stop(time_limit=12.0, clock=Ticking())
    auctioneer = Auctioneer(problem, Terms(), until=cut)
    assert 0 < np.isfinite(auctioneer.bids(0)).sum() < 30
    assert np.isfinite(Auctioneer(problem, Terms(), until=Stop()).bids(0)).all()
    assert Auctioneer(problem, Terms(), closed=range(30)).select() is None


def test_ants_build_no_more_plans_than_there_is_time_for():
    problem = Problem.compile(mission())
    assert allocator_of("ant-colony").solve(problem, Stop(time_limit=0.0, clock=Ticking())).complete
    colony = core.Colony(problem.core, 5.0, 0)
    figures, plans = built(colony, np.ones((33, 30)), 20, Stop(time_limit=2.5, clock=Ticking()))
    assert len(figures) == len(plans) == 3


def test_a_time_limit_counts_what_was_spent_before():
    spent = Stop(clock=Ticking())
    assert Budget(100.0, spent, 0).algorithm_s == pytest.approx(100.0 - 1.0)
    assert Budget(100.0, spent, 100_000).algorithm_s < 100.0 - 2.0 - 1.0
    assert Budget(1.0, spent, 0).algorithm_s == pytest.approx(0.1)  # never nothing
    assert Budget(None, spent, 0).algorithm_s is None


def test_on_a_busy_machine_more_time_is_kept_for_judging(monkeypatch):
    free = Budget(100.0, Stop(), 100_000)
    assert Budget(100.0, Stop(), 100_000, slowness=3.0).algorithm_s < free.algorithm_s - 10.0
    wall, worked = iter((0.0, 6.0)), iter((1.0, 3.0))
    monkeypatch.setattr("time.monotonic", lambda: next(wall))
    monkeypatch.setattr("time.process_time", lambda: next(worked))
    assert Pace().slowness == 3.0


def test_an_exact_proof_shares_the_time_limit_with_the_algorithm():
    budget = Budget(100.0, Stop(), 0, proof_follows=True)
    assert budget.algorithm_s == pytest.approx(50.0, rel=0.01)
    assert budget.proof_s == pytest.approx(100.0, rel=0.01)


def test_time_that_has_gone_by_before_counts():
    stop = Stop(time_limit=5.0, clock=VirtualClock(start_s=100.0), began_s=97.0)
    assert (stop.elapsed_s, stop.time_left_s, stop.due()) == (3.0, 2.0, False)
    assert Stop(time_limit=5.0, clock=VirtualClock(start_s=100.0), began_s=95.0).due()


def test_the_time_limit_counts_from_when_the_command_began(tmp_path, capsys):
    began_s, plan = SystemClock().now() - 100.0, str(tmp_path / "plan.json")
    assert run(["solve", "6T-2R", "-a", "auction", "--time-limit", "50", "-o", plan], began_s) == 0
    assert "time limit: 50 s, all took 1" in capsys.readouterr().err
    explain = ["explain", "6T-2R", plan, "--task", "0", "--format", "json", "--time-limit", "50"]
    for began, cut_short in ((began_s, "true"), (None, "false")):
        assert run(explain, began) == 0
        assert f'"cut_short": {cut_short}' in capsys.readouterr().out


def test_what_keeps_its_time_limit_says_nothing_of_it(capsys):
    assert run(["solve", "6T-2R", "-a", "greedy", "--time-limit", "1000"]) == 0
    assert capsys.readouterr().err == ""


def test_an_interrupted_plan_is_judged_and_cut_short():
    interrupt = Stop()
    interrupt.interrupt()
    solution = answer(Request(mission=mission(), allocator="auction"), interrupt=interrupt)
    assert solution.plan.cut_short
    assert not solution.plan.complete
    assert solution.verdict.valid


@pytest.mark.parametrize(
    ("name", "team"),
    [
        *((name, False) for name in (*CONSTRUCTIVE, "search", "market", "genetic", "greedy+hill-climbing")),
        *((name, True) for name in ("greedy", "auction", "search", "genetic", "greedy+hill-climbing")),
    ],
)
def test_a_first_plan_is_worth_ten_times_the_limit(name, team):
    """The limit itself passes at the third look at the clock."""
    allocator, problem = allocator_of(name), Problem.compile(mission(team=team))
    stop = Stop(time_limit=3.0, clock=Ticking(), first_plan_s=1e6)
    plan = allocator.solve(problem, stop)
    assert (plan.complete, plan.cut_short) == (True, False)


def test_a_quick_bound_without_time_holds_and_says_that_it_was_cut_short():
    late = answer(Request(mission=mission(), allocator="search", time_limit=0.0, bound="quick"))
    usual = answer(Request(mission=mission(), allocator="search", iterations=10, bound="quick"))
    assert late.plan.lower_bound <= usual.plan.lower_bound
    assert "cut short by the time limit" in late.why
    assert "cut short" not in usual.why


@pytest.mark.parametrize("name", ["combinatorial-auction", "bertsekas-auction", "contract-net", "auction"])
def test_the_book_of_a_whole_auction_ends(name):
    """To tell every bid the auction is held again, and stopped in the round in which nothing is left."""
    plan = allocator_of(name).solve(Problem.compile(mission()), Stop())
    bids = []
    plan.book.for_each_bid(bids.append)
    assert max(bid.round for bid in bids) == plan.book.rounds == 30
