"""Robots of a fleet that map the ground themselves: their maps are merged, and they are planned for by them."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from tests.running.test_live import WorldAsFleet
from tests.running.test_unknown_ground import POCKET, room

import muster
from muster.cli.main import run
from muster.mission.errors import NetworkError, ParameterError
from muster.mission.model import Event, Map, Robot
from muster.mission.yaml_writer import yaml_text
from muster.motion.grid import Grid
from muster.motion.map_world import World
from muster.motion.maps.occupancy_rules import read_grid
from muster.perception.laser import LIDAR
from muster.perception.occupancy_map import OccupancyMap, Scan
from muster.perception.robot_grids import RobotGrid
from muster.running import live
from muster.running.fleet_registry import FLEETS
from muster.running.fleet_type import ABILITIES, FleetType
from muster.running.live import Live
from muster.running.mapped_ground import MappingFleet

CELL_M = 0.07


class MappingRobots(WorldAsFleet):
    """Robots each of which maps with its lidar, in cells that are turned, and begin elsewhere, for each."""

    told = ()

    def __init__(self, mission, events=(), silent=()):
        super().__init__(mission, events)
        self._silent, self._maps, self._told_s = silent, {}, -math.inf
        self.least_m, self._truth, self.heard = math.inf, World.of(mission), 0

    def hear_maps(self):
        self.heard += 1
        self._look()

    def advance(self, until_s):
        happened = super().advance(min(until_s, self.time_s + 0.2))
        self._look()
        return happened

    def new_maps(self):
        if self.time_s < self._told_s + 0.5:
            return {}
        self._told_s = self.time_s
        return {robot: grid_of(seen) for robot, seen in self._maps.items() if robot not in self._silent}

    def robots_not_ready(self):
        return {robot: f"nothing on /{robot}/map" for robot in self._silent}

    def _look(self):
        for number, robot in enumerate(self.world.ports):
            (x, y), heading = self.world.positions[number, :2], float(self.world.headings[number])
            seen = self._maps.setdefault(robot, OccupancyMap(frame_of(number), 1.0))
            seen.see(Scan.of((float(x), float(y), heading), self.world.scan(robot, LIDAR)), LIDAR)
            self.least_m = min(self.least_m, self._truth.clearance(np.array([[x, y]]), "ground")[0])


def frame_of(number):
    return Grid(np.zeros((300, 300), dtype=bool), CELL_M, (-3.0 - number, -4.0, 0.3 * (number - 1)))


def grid_of(seen):
    return RobotGrid(replace(seen.frame, blocked=seen.occupied.copy()), seen.known & ~seen.occupied)


def flown(mission, fleet, **how):
    return muster.carry_out(mission, muster.solve(mission, "greedy"), fleet, unknown=True, **how)


@pytest.mark.long
def test_a_team_goes_by_what_its_robots_map_and_touches_nothing():
    mission = room(*POCKET, tasks=[(11.0, 4.0), (4.5, 4.0), (8.0, 1.0)], robots=2)
    fleet = MappingRobots(mission)
    assert isinstance(fleet, MappingFleet)
    report = flown(mission, fleet)
    assert set(report.tasks_done) == {"t_0", "t_1", "t_2"}
    assert fleet.least_m > 0.99 * 0.2
    assert report.ground.ways_closed > 0
    assert report.ground.driven_m is None
    assert report.ground.explored_m2 > 50


def test_what_one_robot_has_mapped_another_knows_from_the_beginning():
    """The first robot does not see the wall behind the first wall; the second stands beside it."""
    walls = ((4.0, 0.0, 0.3, 6.0), (8.0, 0.0, 0.1, 4.0))
    alone = room(*walls, tasks=[(11.0, 1.0)])
    beside = Robot(id="far", position=(7.0, 2.0), radius_m=0.2, kind="ground")
    both = replace(alone, robots=(*alone.robots, beside), tasks=(replace(alone.tasks[0], only_robots=("r_0",)),))
    nearest_m = []
    for mission in (alone, both):
        run = Live(mission, muster.solve(mission, "greedy"), MappingRobots(mission), unknown=True)
        run.look()
        state = run.executor.crew["r_0"]
        way = shapely.LineString([state.position[:2], *(point[:2] for point in state.points_left)])
        nearest_m.append(way.distance(shapely.box(8.0, 0.0, 8.1, 4.0)))
        run.stop()
    assert nearest_m[0] == 0.0
    assert nearest_m[1] > 0.1  # of the wall's width nobody knows yet


@pytest.mark.long
def test_what_maps_prove_to_be_walled_in_is_unreachable():
    walls = ((8, 2, 3, 0.3), (8, 5, 3, 0.3), (8, 2, 0.3, 3.3), (11, 2, 0.3, 3.3))
    mission = room(*walls, tasks=[(9.5, 3.5), (11.5, 7.0)])
    report = flown(mission, MappingRobots(mission))
    assert report.tasks_done == ("t_1",)
    assert "unreachable" in dict(report.tasks_lost)["t_0"]


@pytest.mark.long
def test_frontiers_of_the_merged_map_become_tasks_and_the_map_is_saved(tmp_path):
    mission, file = room((6.0, 1.0, 0.3, 7.0), tasks=[(2.0, 1.0)], robots=2), tmp_path / "merged.yaml"
    report = flown(mission, MappingRobots(mission), explore=True, save_map=file)
    assert report.ground.frontiers > 0
    assert report.ground.explored_m2 > 0.9 * (12 * 8 - 0.3 * 7)
    faults = []
    saved = read_grid(Map(ros_yaml=file.name), tmp_path, faults)
    assert faults == []
    wall = saved.to_grid(np.array([[6.02, 4.0], [3.0, 4.0]])).astype(int)
    assert [bool(saved.blocked[row, column]) for column, row in wall] == [True, False]


@pytest.fixture
def mappers(tmp_path):
    """A mission file, and the fleet `mappers` of another package, which carries it out."""
    mission = room((6.0, 1.0, 0.3, 7.0), tasks=[(2.0, 1.0)], robots=2)
    (tmp_path / "m.yaml").write_text(yaml_text(mission), encoding="utf-8")

    def opened(mission, settings, halt, again):
        fleet = MappingRobots(mission)
        fleet.stop = lambda: None
        return fleet, lambda: None

    kind = FleetType(name="mappers", open=opened, abilities=ABILITIES, claims=lambda _: ["the room"])
    FLEETS.add("mappers", kind)
    yield tmp_path
    FLEETS.remove("mappers")


def test_the_map_of_robots_of_a_registered_fleet_is_saved_by_the_command_as_from_python(mappers, capsys):
    there, built, python = muster.load(mappers / "m.yaml"), mappers / "built.yaml", mappers / "python.yaml"
    call = ["run", str(mappers / "m.yaml"), "--fleet", "mappers", "--allocator", "greedy", "--unknown"]
    assert run([*call, "-q", "--format", "json", "--save-map", str(built)]) == 0
    assert json.loads(capsys.readouterr().out)["tasks_done"] == ["t_0"]
    muster.carry_out(there, muster.solve(there, "greedy"), "mappers", unknown=True, save_map=python)
    assert built.with_suffix(".pgm").read_bytes() == python.with_suffix(".pgm").read_bytes()
    assert (World.of(replace(there, map=Map(ros_yaml=str(built)))).clearance(np.array([[6.02, 4.0]]), "ground") == 0)[0]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--save-map", "b.yaml"), 'save_map: "b.yaml"; expected it together with unknown'),
        (("--unknown", "--save-map", "b.pgm"), 'save_map: "b.pgm"; expected a file (.yaml or .yml)'),
        (("--unknown", "--save-map", "no/b.yaml"), "no/b.yaml: cannot be written"),
        (("--unknown", "--save-map", "m.yaml"), "m.yaml: given twice"),
        (("--unknown", "--save-map", "b.yaml", "--plot", "b.pgm"), "b.pgm: given twice"),
    ],
)
@pytest.mark.parametrize("verb", [("run", "--fleet", "mappers"), ("ros",), ("ros2",), ("simulate",)])
def test_a_map_that_cannot_be_saved_is_refused_before_anybody_moves(
    mappers, monkeypatch, capsys, verb, options, message
):
    monkeypatch.chdir(mappers)
    before = sorted(mappers.iterdir())
    assert run([verb[0], "m.yaml", *verb[1:], *options]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert message in err
    assert sorted(mappers.iterdir()) == before


def test_a_folder_of_the_map_that_does_not_exist_is_refused_from_python(tmp_path):
    mission = room(tasks=[(2.0, 1.0)])
    plan, file = muster.solve(mission, "greedy"), tmp_path / "no" / "b.yaml"
    with pytest.raises(ParameterError, match=r"save_map: .*b\.yaml; expected a file in a folder that exists"):
        muster.simulate(mission, plan, unknown=True, save_map=file)
    with pytest.raises(ParameterError, match=r"save_map: .*b\.yaml; expected a file in a folder that exists"):
        muster.carry_out(mission, plan, MappingRobots(mission), unknown=True, save_map=file)


def test_real_robots_have_their_report_though_the_map_cannot_be_written(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device", "b.yaml")

    monkeypatch.setattr("muster.running.team_ground.write_ros_map", full)
    mission = room(tasks=[(2.0, 1.0)])
    report = flown(mission, MappingRobots(mission), save_map=tmp_path / "b.yaml")
    assert report.tasks_done == ("t_0",)
    assert any("the map is not written: [Errno 28] No space left on device" in said for said in report.remarks)


def test_a_robot_that_joins_goes_by_the_map_and_adds_its_own():
    mission = room((6.0, 1.0, 0.3, 7.0), tasks=[(11.0, 6.0), (11.0, 2.0)])
    joins = Robot(id="new", position=(9.0, 4.0), radius_m=0.2, speed_mps=1.0)
    fleet = MappingRobots(mission, [Event(at_s=1.0, robot_joins=joins)])
    report = flown(mission, fleet)
    assert set(report.tasks_done) == {"t_0", "t_1"}
    assert fleet.least_m > 0.99 * 0.2


@pytest.mark.long
def test_robots_that_meet_do_not_become_obstacles_of_each_other():
    mission = room(tasks=[(11.0, 2.5)], robots=2)
    mission = replace(mission, tasks=(replace(mission.tasks[0], only_robots=("r_0",)),))
    stands = replace(mission.robots[1], position=(6.0, 2.2))
    mission = replace(mission, robots=(mission.robots[0], stands))
    fleet = MappingRobots(mission)
    report = flown(mission, fleet)
    assert report.tasks_done == ("t_0",)
    assert report.ground.ways_closed == 0


def test_who_tells_no_map_is_named_before_anybody_moves(monkeypatch):
    monkeypatch.setattr(live, "_WAIT_S", 0.0)
    mission = room(tasks=[(11.0, 2.5)], robots=2)
    fleet = MappingRobots(mission, silent=("r_1",))
    with pytest.raises(NetworkError, match=r"robot r_1: nothing on /r_1/map within 0 s; expected its map"):
        flown(mission, fleet)
    assert fleet.time_s == 0


def test_a_fleet_without_maps_and_robots_in_the_air_of_a_space_are_refused():
    mission = room(tasks=[(11.0, 2.5)])
    with pytest.raises(ParameterError, match="unknown: true; expected false: robots of this fleet tell no maps"):
        flown(mission, WorldAsFleet(mission))
    drone = Robot(id="uav", position=(1.0, 2.0, 0.0), kind="air", radius_m=0.2)
    space = replace(mission, robots=(drone,), tasks=(replace(mission.tasks[0], position=(11.0, 2.5, 1.0)),))
    with pytest.raises(ParameterError, match="unknown: robot uav is in the air"):
        flown(space, MappingRobots(mission))
