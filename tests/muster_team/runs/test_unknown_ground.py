"""Robots that agree without a centre, and build the map: in virtual time, and once as processes."""

from random import Random

import numpy as np
import pytest

pytest.importorskip("msgpack")
pytest.importorskip("cryptography")

from dataclasses import replace

from tests.muster_team.runs.mapping_team import MappingTeam
from tests.running.test_unknown_ground import room

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Map, Robot
from muster.motion.map_world import World

ZIGZAG = ((4.0, 1.0, 0.3, 7.0), (8.0, 0.0, 0.3, 6.0))
BOX = ((8, 2, 3, 0.3), (8, 5, 3.3, 0.3), (8, 2, 0.3, 3.3), (11, 2, 0.3, 3.3))
TASKS = [(6.0, 4.0), (10.5, 7.0), (10.5, 2.0), (2.0, 4.0)]


def is_over(team):
    idle = all(control.idle for control in team.controls.values())
    return team.world.time_s > 5 and idle and all(node.settled for node in team.net.nodes.values())


def maps_of(team):
    """The map of each robot, once all pieces have come and are entered."""
    found = []
    for ground in team.grounds.values():
        ground.look(team.world.time_s + 10)
        found.append([(seen.occupied.tobytes(), seen.known.tobytes()) for seen in ground.map.layer_maps])
    return found


def test_all_that_can_be_reached_is_done_and_nothing_is_touched():
    team = MappingTeam(room(*ZIGZAG, tasks=TASKS, robots=2))
    assert team.run(120.0, lambda: is_over(team))
    assert set(team.done()) == {"t_0", "t_1", "t_2", "t_3"}
    assert all(len(robots) == 1 for robots in team.done().values())
    assert team.least > 0.98


def test_robots_come_to_one_map_and_price_by_that_of_the_pieces_that_all_have():
    team = MappingTeam(room(*ZIGZAG, tasks=TASKS, robots=3))
    assert team.run(120.0, lambda: is_over(team))
    team.run(team.world.time_s + 3.0)
    first, *others = maps_of(team)
    assert others == [first, first]
    bases = {node.epoch.base.seen for node in team.net.nodes.values()}
    (seen,) = bases
    assert {one.robot for one in seen} == {"r_0", "r_1", "r_2"}
    tables = {node.valuer.problem.measured.table.tobytes() for node in team.net.nodes.values()}
    assert len(tables) == 1
    assert all(
        not node.notices or {n.kind for n in node.notices} <= {"back", "silent"} for node in team.net.nodes.values()
    )


def test_what_one_robot_has_seen_another_goes_by():
    """The first robot does not see the second wall, beside which the second robot stands."""
    walls = ((4.0, 0.0, 0.3, 6.0), (8.0, 0.0, 0.1, 4.0))
    mission = room(*walls, tasks=[(11.0, 1.0)])
    beside = Robot(id="far", position=(7.0, 2.0), radius_m=0.2, kind="ground")
    both = replace(mission, robots=(*mission.robots, beside), tasks=(replace(mission.tasks[0], only_robots=("r_0",)),))
    team = MappingTeam(both)
    team.run(3.0)
    ground, wall = team.grounds["r_0"], np.array([8.0, 2.0])
    assert ground._own.ground.seen.nearest_m(wall) > 0.3
    assert ground.map.ground.seen.nearest_m(wall) < 0.1


def test_a_task_that_no_robot_can_reach_is_given_back_by_all_with_the_reason():
    team = MappingTeam(room(*BOX, tasks=[(9.5, 3.5), (11.6, 7.0)], robots=2))
    assert team.run(200.0, lambda: is_over(team))
    assert set(team.done()) == {"t_1"}
    refused = {(robot, data["task"]): data["reason"] for _, robot, kind, data in team.told if kind == "task_refused"}
    assert refused[("r_0", "t_0")].startswith("unreachable")
    assert any(kind == "way_closed" for _, _, kind, _ in team.told)
    assert team.least > 0.98


def test_a_task_that_nobody_ever_owns_is_told_to_be_out_of_reach_by_all():
    """The wall that closes the room off is seen before anything is agreed by the map."""
    team = MappingTeam(room((4.0, 0.0, 0.3, 8.0), tasks=[(2.0, 4.0), (6.0, 4.0), (9.0, 4.0)], robots=2))
    assert team.run(60.0, lambda: is_over(team))
    team.run(team.world.time_s + 1.0)
    assert set(team.done()) == {"t_0"}
    told = [(robot, data["task"], data["reason"]) for _, robot, kind, data in team.told if kind == "task_refused"]
    assert {(robot, task) for robot, task, _ in told} == {(r, t) for r in ("r_0", "r_1") for t in ("t_1", "t_2")}
    assert all(reason.startswith("unreachable") for *_, reason in told)


@pytest.mark.parametrize("seed", [1, *(pytest.param(k, marks=pytest.mark.long) for k in range(2, 12))])
def test_maps_that_are_lost_late_and_garbled_end_nobody(seed):
    team, random = MappingTeam(room(*ZIGZAG, tasks=TASKS, robots=3), seed=seed, loss=0.3, delay_s=0.3), Random(seed)

    def garbled(data):
        if random.random() < 0.2:
            return bytes(random.randrange(256) for _ in range(random.randrange(40)))
        return data

    team.garbles = garbled
    assert team.run(240.0, lambda: is_over(team))
    assert set(team.done()) == {"t_0", "t_1", "t_2", "t_3"}
    assert team.net.counts["malformed"] > 0
    assert team.least > 0.98


def test_a_piece_that_is_none_counts_for_nothing_with_all_robots():
    team = MappingTeam(room(*ZIGZAG, tasks=TASKS, robots=2))
    team.run(2.0)
    team.grounds["r_1"].link.add([b"no piece", b""])
    assert team.run(120.0, lambda: is_over(team))
    assert set(team.done()) == {"t_0", "t_1", "t_2", "t_3"}
    team.run(team.world.time_s + 3.0)
    first, second = maps_of(team)
    assert first == second


def test_a_robot_that_is_cut_off_goes_by_its_own_map_and_shares_it_when_it_is_heard_again():
    team = MappingTeam(room(*ZIGZAG, tasks=TASKS, robots=2))
    team.run(2.0)
    team.net.cut({"r_0"}, {"r_1"})
    team.run(40.0)
    theirs = {robot: ground.link.reach for robot, ground in team.grounds.items()}
    assert theirs["r_0"] != theirs["r_1"]
    team.net.heal()
    assert team.run(200.0, lambda: is_over(team))
    team.run(team.world.time_s + 10.0)
    assert team.grounds["r_0"].link.reach == team.grounds["r_1"].link.reach
    assert set(team.done()) == {"t_0", "t_1", "t_2", "t_3"}


def test_a_robot_that_starts_again_gets_its_map_from_the_others():
    team = MappingTeam(room(*ZIGZAG, tasks=TASKS, robots=2))
    team.run(6.0)
    team.crash("r_0")
    team.run(20.0)
    team.restart("r_0")
    assert team.run(240.0, lambda: is_over(team))
    team.run(team.world.time_s + 20.0)
    reach = team.grounds["r_0"].link.reach
    assert [(one.robot, one.life) for one in reach] == [("r_0", 1), ("r_0", 2), ("r_1", 1)]
    first, second = maps_of(team)
    assert first == second
    assert set(team.done()) == {"t_0", "t_1", "t_2", "t_3"}


def test_as_processes_with_a_report_by_the_true_map_and_a_map_that_is_saved(tmp_path):
    mission = room((4.0, 1.0, 0.3, 7.0), tasks=[(6.0, 6.0), (2.0, 4.0)], robots=2)
    mission = replace(mission, tasks=tuple(replace(task, duration_s=4.0) for task in mission.tasks))
    told, file = [], tmp_path / "built.yaml"
    report = muster.simulate(mission, muster.Negotiation(), unknown=True, speed=4, save_map=file, on_event=told.append)
    assert set(report.tasks_done) == {"t_0", "t_1"}, report.tasks_lost
    assert report.contacts == 0
    assert report.ground.explored_m2 > 30
    assert report.ground.with_map_m <= report.ground.driven_m < 2 * report.ground.with_map_m
    kinds = [event.kind for event in told]
    assert kinds[0] == "ground_unknown"
    assert "map_grows" in kinds
    built = World.of(replace(mission, map=Map(ros_yaml=str(file))))
    assert (built.clearance([(4.05, 4.0), (2.0, 4.0)], "ground") > 0).tolist() == [False, True]


def test_what_robots_cannot_do_without_a_centre_is_refused():
    mission = room(tasks=[(6.0, 6.0)])
    with pytest.raises(ParameterError, match="explore: true; expected a plan"):
        muster.simulate(mission, muster.Negotiation(), unknown=True, explore=True)
    with pytest.raises(ParameterError, match="unknown: mission 6T-2R has no map"):
        muster.simulate(muster.load("6T-2R"), muster.Negotiation(), unknown=True)
    with pytest.raises(ParameterError, match=r"unknown: robot .* is in the air; expected robots on the ground"):
        muster.simulate(muster.load("yard"), muster.Negotiation(), unknown=True)
