"""Robots that look while a plan is carried out: what they find becomes tasks, in both worlds."""

import math
from contextlib import closing
from dataclasses import replace
from importlib.util import find_spec

import pytest

import muster
from muster.mission.model import Action, Camera, Event, Found, Mission, MovedTask, Robot, Tag, Task, Work
from muster.running.simulation import Simulation, carry_out
from muster.simulation import Noise

WORLDS = ["kinematic", pytest.param("physics", marks=pytest.mark.skipif(not find_spec("mujoco"), reason="no MuJoCo"))]
CAMERA = Camera(fov_deg=60, tilt_deg=45, rate_hz=4)
DRONE = Robot(
    id="drone", position=(0, 0, 0), kind="air", kinematics="quadcopter", radius_m=0.3, speed_mps=1.5, camera=CAMERA,
    skills=("fly",),
)  # fmt: skip
ROVER = Robot(
    id="rover", position=(0, -2, 0), kinematics="differential-drive", radius_m=0.2, speed_mps=0.5, skills=("carry",)
)
SEARCH = Task(
    id="search",
    position=(6, 0, 0),
    requires=("fly",),
    action=Action(name="raster-search", side_m=4, height_m=3, spacing_m=2),
)
CARRY = Found(becomes=Work(requires=("carry",), duration_s=2))
TAGS = (Tag(id=4, position=(6, 1, 0)), Tag(id=9, position=(7, -1, 0), heading_deg=70))


def mission(*, tags=TAGS, found=(CARRY,), robots=(DRONE, ROVER), tasks=(SEARCH,), events=()):
    return Mission(name="test", robots=robots, tasks=tasks, tags=tags, found=found, events=events)


def flown(of, **how):
    return carry_out(of, muster.solve(of, iterations=50), **how)


def kinds(simulation, kind):
    return [event for event in simulation.events if event.kind == kind]


def simulated(of, **how):
    simulation = Simulation(of, muster.solve(of, iterations=50), **how)
    while not simulation.done:
        simulation.advance(simulation.time_s + 1)
    simulation.close()
    return simulation


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("world", WORLDS)
def test_found_becomes_done(world):
    report = flown(mission(), world=world)
    assert report.tasks_done[0] == "search"
    assert set(report.tasks_done[1:]) == {"found-4", "found-9"}
    assert report.tasks_lost == ()
    assert [row.robot for row in report.tasks[1:]] == ["rover", "rover"]
    assert {find.tag: find.task for find in report.found} == {4: "found-4", 9: "found-9"}
    assert all(find.error_m < 0.02 and find.robots == ("drone",) for find in report.found)
    assert report.remarks == ()


def test_what_is_found_happens_when_it_is_found():
    simulation = simulated(mission())
    found = {event.data["task"]: event.time_s for event in kinds(simulation, "found")}
    assert found == {find.task: find.found_s for find in simulation.camera_search.found}
    assert found == {event.data["task"]["id"]: event.time_s for event in kinds(simulation, "new_task")}


def test_what_is_found_before_its_robot_has_joined_is_refused_and_the_mission_goes_on():
    late = Found(becomes=Work(only_robots=("late",)))
    joins = Event(at_s=60.0, robot_joins=replace(ROVER, id="late"))
    simulation = simulated(mission(found=(late,), events=(joins,)))
    reasons = [event.data["reason"] for event in kinds(simulation, "event_refused")]
    assert reasons == [f'new_task: found-{tag}: "late"; expected the id of a robot' for tag in (9, 4)]
    assert simulation.result().tasks_done == ("search",)
    assert [find.task for find in simulation.camera_search.found] == [None, None]


@pytest.mark.long
def test_runs_are_the_same_by_seed():
    """For those in the physics world see tests/muster_control/runs/test_again_in_worlds.py."""
    noise = Noise(position_m=0.03, heading_rad=math.radians(1), attitude_rad=math.radians(1))
    one, same, other = (flown(mission(), noise=noise, seed=seed) for seed in (1, 1, 2))
    assert one == same
    assert one.found[0].position != other.found[0].position


@pytest.mark.long
@pytest.mark.parametrize("seeds", [2, pytest.param(6, marks=pytest.mark.long)])
def test_estimates_err_as_sure_as_they_say(seeds):
    noise = Noise(position_m=0.05, heading_rad=math.radians(1), attitude_rad=math.radians(1))
    finds = [find for seed in range(seeds) for find in flown(mission(), noise=noise, seed=seed).found]
    assert len(finds) == 2 * seeds
    share = sum((find.error_m / find.deviation_m) ** 2 for find in finds) / len(finds)
    assert 0.05 < share < 2.5  # 2 where both directions are as unsure as the worse one


def test_the_first_rule_that_fits_is_taken():
    rules = (Found(tags=(9,), becomes=Work(requires=("fly",))), CARRY)
    report = flown(mission(found=rules))
    assert {row.task: row.robot for row in report.tasks} == {"search": "drone", "found-4": "rover", "found-9": "drone"}


def test_what_no_rule_fits_is_found_and_becomes_nothing():
    report = flown(mission(found=(Found(tags=(9,), becomes=CARRY.becomes),)))
    assert {find.tag: find.task for find in report.found} == {4: None, 9: "found-9"}
    assert set(report.tasks_done) == {"search", "found-9"}


def test_what_nobody_can_do_is_lost_with_the_reason():
    report = flown(mission(found=(Found(becomes=Work(requires=("dig",))),)))
    assert report.tasks_done == ("search",)
    assert {task for task, _ in report.tasks_lost} == {"found-4", "found-9"}
    assert all("skill" in reason for _, reason in report.tasks_lost)


def test_no_tag_seen_at_all_is_said_and_the_mission_goes_on():
    report = flown(mission(tags=(Tag(id=4, position=(40, 40, 0)),)))
    assert report.found == ()
    assert report.remarks == ("no point of interest: no tag was seen",)
    assert report.tasks_done == ("search",)


def test_a_tag_twice_is_said_and_becomes_two_tasks():
    report = flown(mission(tags=(Tag(id=4, position=(6, 0.6, 0)), Tag(id=4, position=(6, -0.6, 0)))))
    assert set(report.tasks_done) == {"search", "found-4", "found-4-2"}
    assert "tag 4 is at 2 places" in report.remarks
    assert sum("twice in one image" in remark for remark in report.remarks) == 1  # once, of many images


def test_a_robot_that_failed_sees_nothing():
    broken = mission(events=(Event(at_s=0.5, robot_fails="drone"),))
    assert flown(broken).found == ()


@pytest.mark.parametrize(("unheard", "looked"), [((), 1), (("drone",), 0)])
def test_of_who_cannot_tell_what_it_sees_nobody_hears(unheard, looked):
    of, looks = mission(), []
    with closing(Simulation(of, muster.solve(of, iterations=50), on_look=looks.append)) as simulation:
        assert list(simulation.camera_search.look(0.0, unheard)) == []
        assert simulation.camera_search.due_s == 0.25
    assert len(looks) == looked


def test_a_robot_that_joins_looks_too():
    second = replace(DRONE, id="second", position=(2.0, 0.0, 3.0))
    base = mission(robots=(ROVER,), tasks=(replace(SEARCH, position=(30, 0, 0)),), found=())
    report = flown(replace(base, events=(Event(at_s=1, robot_joins=second),)))
    assert {find.tag for find in report.found} == {4, 9}
    assert {robot for find in report.found for robot in find.robots} == {"second"}


def test_names_that_are_taken_are_not_given_again():
    taken = Task(id="found-4", position=(1, 0, 0), requires=("carry",))
    assert "found-4'" in flown(mission(tasks=(SEARCH, taken))).tasks_done


def test_new_tasks_come_while_the_drone_still_searches():
    simulation = simulated(mission())
    (ends,) = [h.time_s for h in kinds(simulation, "ends") if h.data["task"] == "search"]
    assert kinds(simulation, "found")[0].time_s < ends
    assert kinds(simulation, "new_task")[0].time_s == kinds(simulation, "found")[0].time_s


def test_a_find_elsewhere_moves_its_task():
    """The world says so here: its telemetry is far off at first."""
    simulation = Simulation(mission(), muster.solve(mission(), iterations=50))
    camera_search = simulation.camera_search
    while not kinds(simulation, "new_task"):
        simulation.advance(simulation.time_s + 1)
    task = kinds(simulation, "new_task")[0].data["task"]
    tag = int(task["id"].removeprefix("found-"))
    (find,) = [find for find in camera_search.search.finds if find.tag == tag]
    moved = replace(find, point=replace(find.point, position=find.point.position + 0.5))
    event = camera_search.tasks.event(moved, simulation.time_s)
    assert event.move_task == MovedTask(task=task["id"], position=(*(round(p, 4) for p in moved.point.position), 0.0))


def test_plans_know_nothing_of_tags():
    with_tags, without = mission(), mission(tags=(), found=())
    plans = [muster.solve(of, iterations=50) for of in (with_tags, without)]
    assert plans[0].routes == plans[1].routes


def test_without_tags_nobody_looks():
    simulation = Simulation(mission(tags=()), muster.solve(mission(tags=()), iterations=50))
    assert simulation.camera_search is None


def test_every_look_is_told():
    looks = []
    report = flown(mission(), on_look=looks.append)
    assert len(looks) == pytest.approx(4 * report.mission_time_s, abs=3)
    assert {look.robot for look in looks} == {"drone"}
    assert all(look.image is None for look in looks)


def test_tags_that_were_seen_too_rarely_are_named():
    """The drone passes by at once: one look at 4 Hz."""
    brief = replace(DRONE, camera=Camera(fov_deg=60, tilt_deg=45, rate_hz=0.01), position=(0, 0, 3))
    there = mission(robots=(brief, ROVER), tags=(Tag(id=4, position=(4, 0, 0)),))
    report = flown(there)
    assert report.found == ()
    assert report.remarks == ("no point of interest: seen, but too rarely or from too far, tag 4",)


@pytest.mark.parametrize("delay_s", [0.2, 0.6])
def test_images_that_are_late_put_tags_ahead_of_where_they_are(delay_s):
    """Estimates of a tag are off along the lanes, most of them by the delay times the speed."""
    late = simulated(mission(found=()), noise=Noise(camera_delay_s=delay_s))
    raw = late.camera_search.search.raw
    off = sorted(abs(raw.positions[raw.tags == 4][:, 0] - TAGS[0].position[0]))
    assert len(off) > 3
    assert off[len(off) // 2] == pytest.approx(delay_s * DRONE.speed_mps, abs=0.05)
