"""The report of a mission that is not carried out to its end compares the part that was carried out."""

import pytest
from tests.execution.world import World, carry_out

import muster
from muster.execution import Executor, broken_off, report_of
from muster.execution.reports.broken_off import IN_PART
from muster.mission.model import Mission, Robot, Rules, Task


def mission(objective, **robot):
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 9.0 * k), **robot) for k in range(2))
    tasks = tuple(Task(id=f"t_{k}", position=(10.0 * (k // 2 + 1), 9.0 * (k % 2)), duration_s=3.0) for k in range(8))
    return Mission(robots=robots, tasks=tasks, rules=Rules(objective=objective))


@pytest.mark.parametrize("objective", ["total", "max", "total+max", "makespan"])
@pytest.mark.parametrize("until_s", [0.0, 4.0, 11.0, 15.0, 36.0])
def test_planned_is_what_was_planned_of_the_part_that_was_carried_out(objective, until_s):
    there = mission(objective, speed_mps=1.0)
    world = World(there)
    executor = carry_out(Executor(there, muster.solve(there, "greedy"), world.ports), world, until=until_s)
    report = broken_off(report_of(executor.account), executor.account, "cancelled")
    assert not executor.done
    assert IN_PART in report.remarks
    for row in report.robots:  # who goes exactly as planned is compared with just that
        assert row.usage_planned == pytest.approx(row.usage_flown, abs=1e-6)
        assert row.usage_flown <= until_s + 1e-6
    if objective == "makespan":
        assert report.objective.planned is None
    else:
        assert report.objective.planned == pytest.approx(report.objective.flown, abs=1e-6)


def test_a_mission_that_is_over_is_compared_with_the_plan_that_it_began_with():
    there = mission("total", speed_mps=1.0)
    world = World(there)
    executor = carry_out(Executor(there, muster.solve(there, "greedy"), world.ports), world)
    report = report_of(executor.account)
    assert IN_PART not in report.remarks
    assert sum(row.usage_planned for row in report.robots) == pytest.approx(report.objective.planned)


def test_who_takes_a_longer_way_than_planned_shows_in_the_part():
    there = mission("total", speed_mps=1.0)
    world = World(there)
    executor = Executor(there, muster.solve(there, "greedy"), world.ports)

    def detour(world, _):
        if world.now < 5.0:
            world.ports["r_0"].odometry += 0.1  # it went twice as far as it got

    carry_out(executor, world, until=15.0, each=detour)
    report = broken_off(report_of(executor.account), executor.account, "cancelled")
    row = report.robots[0]
    assert row.usage_flown - row.usage_planned == pytest.approx(5.0, abs=0.2)
