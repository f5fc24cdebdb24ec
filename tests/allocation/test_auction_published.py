"""The auction against the printed tables of the auction thesis, bid by bid; the market against its paper."""

from itertools import product
from statistics import fmean

import pytest

import muster
from muster.allocation.allocator import make_parameters
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.library import as_corrected, mission_names, published
from muster.mission.errors import ParameterError
from muster.model.problem import Problem
from muster.verification.travel import Travel

PLACEMENTS = ("append", "insert")
WINNERS = ("lowest", "least-contested")
BIDS = ("total", "max", "average", "average-as-printed", "total+max", "makespan")

# Tables 5.2, 5.3, 5.5, 5.7, 5.9, 5.11 and 5.13: the bids of firefly0 and of firefly1 for task1 to task6.
ROUNDS = [
    ([4.6, 5.8, 5.1, 2.4, 5.4, 1.7], [6.4, 7.1, 5.8, 3.7, 4.6, 1.7]),
    ([5.1, 6.7, 5.7, 2.2, 3.7, -1], [6.4, 7.1, 5.8, 3.7, 4.6, -1]),
    ([3, 6.6, 6.3, -1, 4.6, -1], [6.4, 7.1, 5.8, -1, 4.6, -1]),
    ([-1, 6.4, 7, -1, 7.3, -1], [-1, 7.1, 5.8, -1, 4.6, -1]),
    ([-1, 6.4, 7, -1, -1, -1], [-1, 10, 9, -1, -1, -1]),
    ([-1, -1, 2, -1, -1, -1], [-1, -1, 9, -1, -1, -1]),
]
# Tables 5.4, 5.6, ..., 5.14: what the two submit; the winner.
SUBMITTED = [
    (("task6", 1.7), ("task6", 1.7), "firefly0"),
    (("task4", 2.2), ("task4", 3.7), "firefly0"),
    (("task1", 3), ("task5", 4.6), "firefly0"),
    (("task2", 6.4), ("task5", 4.6), "firefly1"),
    (("task2", 6.4), ("task3", 9), "firefly0"),
    (("task3", 2), ("task3", 9), "firefly0"),
]
NO_BID = -1

# Tables 5.18 to 5.20: tasks of firefly0 to firefly4.
MINI_SUM = [[1, 5], [16, 15, 0, 4, 6, 9, 10, 14, 7, 17, 13, 19, 11], [3, 8, 2, 18, 12], [], []]
MINI_MAX = [[1, 19, 11, 10], [16, 14, 7, 17, 13], [3, 8, 2, 18], [15, 0, 9, 6, 4], [5, 12]]
MINI_AVE = [[1, 19, 13], [16, 14, 7, 17], [3, 8, 2, 18, 12], [15, 0, 9, 6, 4], [5, 11, 10]]

BEST_KNOWN_S = 242.955  # of market-rescue-20


def auction(name, **terms):
    mission = muster.load(name)
    plan = muster.solve(mission, "auction", **terms)
    assert muster.verify(mission, plan).valid
    return plan


def paths(plan):
    return [[int(task.removeprefix("task")) for task in route.tasks] for route in plan.routes]


def digit(bid):
    return f"{bid:.1f}"


@pytest.fixture(scope="module")
def scenario_1():
    return auction("auction-1", bid="total", placement="append", winner="lowest")


@pytest.mark.parametrize("number", range(1, 7))
def test_bids_of_a_round(scenario_1, number):
    bids = {(bid.robot, bid.task): bid.bid for bid in scenario_1.book.bids if bid.round == number}
    for robot, printed in zip(("firefly0", "firefly1"), ROUNDS[number - 1], strict=True):
        for k, there in enumerate(printed, 1):
            assert digit(bids.get((robot, f"task{k}"), NO_BID)) == digit(there), (robot, k)


@pytest.mark.parametrize("number", range(1, 7))
def test_submitted_bids_and_winner_of_a_round(scenario_1, number):
    *printed, winner = SUBMITTED[number - 1]
    submitted = dict(zip(("firefly0", "firefly1"), printed, strict=True))
    sold, price = submitted[winner]
    for robot, (task, there) in submitted.items():
        bids = [bid for bid in scenario_1.book.bids if (bid.round, bid.robot) == (number, robot)]
        lowest = min(bids, key=lambda bid: bid.bid)
        assert (lowest.task, digit(lowest.bid)) == (task, digit(there))
        assert lowest.winner == (winner if task == sold else None)
    award = scenario_1.book.awards[number - 1]
    assert (award.round, award.robot, award.task, digit(award.price)) == (number, winner, sold, digit(price))


def test_the_tie_of_round_1_is_exact(scenario_1):
    first = {bid.robot: bid.bid for bid in scenario_1.book.bids if (bid.round, bid.task) == (1, "task6")}
    assert first["firefly0"] == first["firefly1"]


def test_the_tables_here_are_those_of_the_library():
    tables = published("auction-1")["tables"].values()
    for number, bids in enumerate(ROUNDS, 1):
        there = {}
        for table in tables:
            there |= table.get("bids", {}) if table.get("round") == number else {}
        for robot, printed in zip(("firefly0", "firefly1"), bids, strict=True):
            assert there[robot] == {f"task{k}": bid for k, bid in enumerate(printed, 1) if bid != NO_BID}
    tables = as_corrected(published("auction-2"))["tables"]
    for number, here in (("5.18", MINI_SUM), ("5.19", MINI_MAX), ("5.20", MINI_AVE)):
        routes = tables[number]["plans"][0]["routes"].values()
        assert [route["tasks"] for route in routes] == [[f"task{k}" for k in path] for path in here]


def test_table_5_15(scenario_1):
    assert paths(scenario_1) == [[6, 4, 1, 2, 3], [5]]
    assert scenario_1.book.rounds == 6


@pytest.mark.parametrize(
    ("bid", "placement", "there"),
    [
        ("total", "insert", MINI_SUM),
        ("max", "append", MINI_MAX),
        ("max", "insert", MINI_MAX),
        ("average-as-printed", "append", MINI_AVE),
        ("average-as-printed", "insert", MINI_AVE),
    ],
)
def test_tables_5_18_to_5_20(bid, placement, there):
    assert paths(auction("auction-2-as-run", bid=bid, placement=placement, winner="lowest")) == there


@pytest.mark.parametrize("placement", PLACEMENTS)
@pytest.mark.parametrize("winner", WINNERS)
def test_the_bid_of_the_literature_does_not_give_table_5_20(placement, winner):
    assert paths(auction("auction-2-as-run", bid="average", placement=placement, winner=winner)) != MINI_AVE


@pytest.mark.parametrize(("bid", "there"), [("total", MINI_SUM), ("max", MINI_MAX), ("average-as-printed", MINI_AVE)])
@pytest.mark.parametrize("placement", PLACEMENTS)
def test_with_task0_as_printed_none_comes_out(bid, there, placement):
    assert paths(auction("auction-2", bid=bid, placement=placement, winner="lowest")) != there


@pytest.mark.parametrize("seed", range(5))
def test_market_gives_figure_5(seed):
    mission = muster.load("market-rescue")
    plan = muster.solve(mission, "market", seed=seed, iterations=20)
    assert muster.verify(mission, plan).valid
    there = published("market-rescue")["tables"]["Figure 5"]["plans"][0]["routes"]
    assert {r.robot: sorted(r.tasks) for r in plan.routes} == {r: sorted(route["tasks"]) for r, route in there.items()}


@pytest.mark.long
def test_market_comes_near_the_best_known_plan_of_20_survivors():
    mission = muster.load("market-rescue-20")
    seconds = []
    for seed in range(5):
        verdict = muster.verify(mission, muster.solve(mission, "market", seed=seed, iterations=500))
        assert verdict.valid
        assert verdict.tasks_completed == 20
        seconds.append(verdict.max_usage)
    assert min(seconds) <= 1.001 * BEST_KNOWN_S
    assert fmean(seconds) <= 1.03 * BEST_KNOWN_S


def admissible(problem, allocator, stop, **params):
    plan = ALLOCATORS[allocator].solve(problem, stop, params=make_parameters(ALLOCATORS[allocator], params))
    verdict = muster.verify(problem.mission, plan)
    assert verdict.violations == ()
    assert plan.objective_value == pytest.approx(verdict.value(), rel=max(1e-9, Travel(problem.mission).tolerance))


OTHERS = ("berlin52", "eil51", "eil76", "collapsed-building", "warehouse")  # files of other kinds; teams; relations
SHIPPED = [name for name in mission_names() if name not in OTHERS]
WITH_MAPS = ("depot", "floor", "warehouse-charging", "yard")  # they take ten times as long as the others


def case(*values):
    """Return the parameters of a test of a shipped mission, whose name comes last."""
    return pytest.param(*values, marks=pytest.mark.long if values[-1] in WITH_MAPS else ())


@pytest.mark.long(keep=9)
@pytest.mark.parametrize(("number", "name"), [case(*numbered) for numbered in enumerate(SHIPPED)])
def test_auctions_of_every_kind_are_admissible(number, name):
    """Three kinds for each mission: of any eight missions, every kind there is."""
    problem = Problem.compile(muster.load(name))
    bids = [bid for bid in BIDS if bid != "average-as-printed"] if problem.core.is_timed else BIDS
    for bid, placement, winner in [*product(bids, PLACEMENTS, WINNERS)][number % 8 :: 8]:
        admissible(problem, "auction", Stop(), bid=bid, placement=placement, winner=winner)


@pytest.mark.parametrize("name", [case(name) for name in SHIPPED])
def test_markets_are_admissible_or_refused(name):
    problem = Problem.compile(muster.load(name))
    if not problem.asked.keys() <= ALLOCATORS["market"].can:
        with pytest.raises(ParameterError, match="market cannot do"):
            admissible(problem, "market", Stop(iterations=3))
        return
    for bid in ({}, {"bid": "total"}):
        admissible(problem, "market", Stop(iterations=3), **bid, annealing_steps=300)
