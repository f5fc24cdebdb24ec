"""Which allocator plans the rest again, by the options with which a mission is planned."""

from dataclasses import replace

import pytest

import muster
from muster.allocation.algorithms.greedy import GREEDY
from muster.allocation.auctions.auction import AUCTION
from muster.allocation.auctions.market import MARKET
from muster.allocation.search.search import SEARCH
from muster.execution import Reallocation
from muster.execution.replanning.travel import travel_of
from muster.mission.errors import ParameterError
from muster.mission.model import Event
from muster.planning.options import PlanningOptions
from muster.running.replanning import reallocation_by


def replanning(**options):
    mission = muster.load("6T-2R")
    return reallocation_by(PlanningOptions(**options), travel_of(mission), seed=3)


def test_search_keeps_its_low_temperature_unless_one_is_given():
    usual = replanning()
    assert (usual.allocator, usual.parameters.hot, usual.seed, usual.fill_waiting) == (SEARCH, 1.0, 3, False)
    own = replanning(parameters={"hot": 2.5, "removed": 4.0}, rewire=True)
    assert (own.parameters.hot, own.parameters.removed, own.fill_waiting) == (2.5, 4.0, True)


def test_allocators_that_keep_fixed_tasks_plan_again_themselves_and_others_leave_that_to_search():
    assert replanning(allocator="greedy").allocator is GREEDY
    assert replanning(allocator="auction", parameters={"winner": "least-contested"}).allocator is AUCTION
    assert replanning(allocator="market").allocator is SEARCH
    with pytest.raises(ParameterError, match="market; expected one that keeps fixed tasks"):
        Reallocation(travel=travel_of(muster.load("6T-2R")), allocator=MARKET)


@pytest.mark.long
def test_a_mission_goes_on_by_the_allocator_that_planned_it():
    """The second robot's failure leaves work that greedy gives to others than search does."""
    mission = muster.load("31T-6R50")
    mission = replace(mission, events=(Event(at_s=5.0, robot_fails="r_1"),))
    plan = muster.solve(mission, "greedy")
    usage = {}
    for allocator in ("greedy", "search"):
        report = muster.simulate(mission, plan, planning=PlanningOptions(allocator=allocator), avoidance="none")
        assert report.reallocations == 1
        usage[allocator] = report.objective.flown
    assert usage["search"] == muster.simulate(mission, plan, avoidance="none").objective.flown
    assert usage["greedy"] > usage["search"] + 1.0
