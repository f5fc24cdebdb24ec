"""Tasks are done where they truly are: what robots take for done, and what the world knows of it."""

import math
from dataclasses import replace

import pytest

import muster
from muster.mission.model import Action, Camera, Found, Mission, Robot, Tag, Task, Work
from muster.motion.actions.tolerance import tolerance_m
from muster.running.simulation import Simulation, carry_out
from muster.simulation import Noise

ROVER = Robot(
    id="r", position=(0.0, 0.0), kinematics="differential-drive", radius_m=0.2, speed_mps=0.5, yaw_rate_radps=1.8
)
DRONE = Robot(id="d", position=(0, 0, 0), kind="air", speed_mps=1.0, camera=Camera(fov_deg=60, tilt_deg=45))


def far(**more):
    """A task at the end of a way on which odometry leads astray."""
    return Task(id="far", position=(8.0, 0.0), **more)


def mission(*tasks, robots=(ROVER,), **more):
    return Mission(name="test", robots=robots, tasks=tasks, **more)


def simulated(of, **how):
    simulation = Simulation(of, muster.solve(of, iterations=20), **how)
    while not simulation.done:
        simulation.advance(simulation.time_s + 10.0)
    simulation.close()
    return simulation


@pytest.mark.parametrize("seed", range(3))
def test_it_is_done_where_the_robot_truly_was(seed):
    """Distances by the world; what is beyond `within_m` is lost, and in the log, and what is within is done."""
    of = mission(Task(id="near", position=(1.0, 0.0)), far())
    simulation = simulated(of, noise=Noise(odometry=0.1), seed=seed)
    report = simulation.result()
    rows = {row.task: row for row in report.tasks}
    assert set(rows) == {"near", "far"}
    truth = math.dist(simulation.world.positions[0][:2], (8.0, 0.0))
    assert rows["far"].done_m_off == pytest.approx(truth, abs=0.01)
    for name, row in rows.items():
        assert row.within_m == 0.2
        assert (name in report.tasks_done) == (row.done_m_off <= 0.2)
        assert (name in dict(report.tasks_lost)) == (row.done_m_off > 0.2)
    off = {name for name, row in rows.items() if row.done_m_off > 0.2}
    assert {event.data["task"] for event in simulation.events if event.kind == "off_place"} == off


def test_it_says_how_far_off_and_what_was_expected():
    report = carry_out(mission(far(within_m=0.001)), muster.solve(mission(far()), iterations=20), noise=Noise(slip=0.2))
    ((name, reason),) = report.tasks_lost
    (row,) = report.tasks
    assert (name, report.tasks_done) == ("far", ())
    assert reason == f"off its place: r did it {row.done_m_off:.2f} m away; expected within 0.00 m"


def test_a_task_says_how_far_off_it_may_be():
    wide = mission(far(within_m=100.0))
    report = carry_out(wide, muster.solve(wide, iterations=20), noise=Noise(odometry=0.1, slip=0.2), seed=1)
    assert report.tasks_done == ("far",)
    assert report.tasks[0].done_m_off > 0.001


@pytest.mark.parametrize("name", ["6T-2R", "16T-3R-actions", "market-rescue-arena"])
def test_robots_that_do_not_err_do_everything_at_its_place(name):
    of = muster.load(name)
    report = carry_out(of, muster.solve(of, iterations=100))
    assert len(report.tasks_done) == len(of.tasks)
    assert all(row.done_m_off <= 0.021 for row in report.tasks)  # as near as an order comes


def test_those_of_a_team_stand_about_a_place():
    pair = mission(far(robots_needed=2), robots=(ROVER, replace(ROVER, id="s", position=(0.0, 2.0))))
    report = carry_out(pair, muster.solve(pair, iterations=20))
    assert report.tasks_done == ("far",)
    assert report.tasks[0].done_m_off < 0.021


def test_a_load_is_taken_up_where_it_is():
    """The way to the goods is long, that to the place of the task short: what counts is the farther off of both."""
    of = mission(Task(id="t", position=(8.2, 0.0), action=Action(name="delivery", pickup=(8.0, 0.0)), within_m=0.01))
    simulation = Simulation(of, muster.solve(of, iterations=20), noise=Noise(slip=0.1), seed=1)
    at_pickup = None
    while not simulation.done:
        for event in simulation.advance(simulation.time_s + 0.1):
            if event.kind == "starts":
                at_pickup = math.dist(simulation.world.positions[0][:2], (8.0, 0.0))
    assert simulation.result().tasks[0].done_m_off >= at_pickup - 1e-6 > 0.001


def test_what_was_found_elsewhere_is_done_elsewhere():
    """A rover that does not err goes to where a drone that errs takes a tag to be."""
    tag = Tag(id=4, position=(6.0, 1.0, 0.0))
    search = Task(
        id="search",
        position=(6.0, 0.0, 0.0),
        requires=("fly",),
        action=Action(name="raster-search", side_m=4, height_m=3, spacing_m=2),
    )
    robots = (replace(DRONE, skills=("fly",)), replace(ROVER, position=(0.0, -2.0, 0.0), skills=("carry",)))
    of = mission(search, robots=robots, tags=(tag,), found=(Found(becomes=Work(requires=("carry",), within_m=0.05)),))
    report = simulated(of, noise=Noise(odometry=0.05), seed=2).result()
    (find,) = report.found
    row = next(row for row in report.tasks if row.task == "found-4")
    assert row.done_m_off > 0.05
    assert "found-4" in dict(report.tasks_lost)
    assert find.task == "found-4"
    assert find.error_m > 0.05


def test_a_run_that_was_interrupted_keeps_what_was_off():
    of = mission(Task(id="near", position=(1.0, 0.0), within_m=1e-6), far(prerequisites=("near",)))
    simulation = Simulation(of, muster.solve(of, iterations=20), noise=Noise(odometry=0.1), seed=1)
    while not any(event.kind == "ends" for event in simulation.events):
        simulation.advance(simulation.time_s + 1.0)
    (row,) = simulation.snapshot()["done_at"]
    assert (row["task"], row["within_m"]) == ("near", 1e-6)
    assert row["off_m"] > 1e-6


@pytest.mark.parametrize(
    ("task", "robot", "metres"),
    [
        (far(), ROVER, 0.2),
        (far(), replace(ROVER, radius_m=0.03), 0.1),
        (far(within_m=3), ROVER, 3),
        (far(action=Action(name="stationary-observation", width_m=3)), DRONE, 1.5),
        (far(action=Action(name="raster-search", side_m=4, height_m=2, spacing_m=0.8)), DRONE, 0.4),
        (far(action=Action(name="ground-patrol", side_m=4)), ROVER, 0.2),
    ],
)
def test_tolerances_follow_from_what_is_done(task, robot, metres):
    assert tolerance_m(task, robot) == pytest.approx(metres)


def test_lanes_by_a_camera_may_be_off_by_half_of_what_one_covers():
    search = far(action=Action(name="raster-search", side_m=4, height_m=2))
    low, high = (tolerance_m(replace(search, action=replace(search.action, height_m=h)), DRONE) for h in (2, 4))
    assert high == pytest.approx(2 * low)
