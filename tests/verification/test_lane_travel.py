"""The planner's travel along lanes is the judge's own, for random lanes, robots, places and maps."""

import math

import pytest
from hypothesis import assume, given, settings
from tests.motion.lane_missions import missions

from muster.mission.errors import MissionError
from muster.model.problem import Problem
from muster.motion.leg_times import LegTimes
from muster.verification.measure import leg_between
from muster.verification.travel import Travel, place_of_start, place_of_task


def assert_judged_alike(mission):
    try:
        problem = Problem.compile(mission).ready()
    except MissionError:  # a robot stands where it is joined to no lane, or in the box
        assume(False)
    travel, tasks = Travel(mission), range(len(problem.tasks))
    for i, robot in enumerate(problem.robots):
        rows = [problem.start(i), *tasks]
        metres, seconds = problem.metres(i, rows, tasks), problem.travel_seconds(i, rows, tasks)
        times = LegTimes.in_mission(robot, mission)
        begins = [place_of_start(robot), *(place_of_task(task) for task in problem.tasks)]
        for row, begin in enumerate(begins):
            for j, task in enumerate(problem.tasks):
                leg = leg_between(travel, robot, begin, place_of_task(task), times, in_time=True)
                if not leg.exists or travel.work_metres(robot, task) is None:
                    assert math.isinf(metres[row, j])
                    assert math.isinf(seconds[row, j])
                else:
                    judged = travel.metres(robot, begin, place_of_task(task))
                    tolerance = max(1e-9, 2 * travel.tolerance)
                    assert metres[row, j] == pytest.approx(judged, rel=tolerance, abs=1e-9)
                    assert seconds[row, j] == pytest.approx(leg.seconds, rel=tolerance, abs=1e-9)


@settings(max_examples=60)
@given(mission=missions())
def test_lengths_and_times_along_lanes_are_the_judges_own(mission):
    assert_judged_alike(mission)


@pytest.mark.long
@settings(max_examples=30)
@given(mission=missions(with_map=True))
def test_so_are_they_on_a_map(mission):
    assert_judged_alike(mission)
