"""The other kind of run: robots with bodies in the kinematic world, on crowded places, over a map now and then."""

from dataclasses import replace
from math import dist
from random import Random

from muster.motion.port import Place
from muster.simulation import KinematicWorld
from tests.disturbances.missions import disturbed_mission

RADIUS = 0.3
GRID = 2.0
OUTSIDE = 18.0  # metres north, where robots join: those who are in the mission do not go there


class Bodies:
    """The kinematic world, and what the script of a mission does to its robots."""

    def __init__(self, mission, avoidance, seed):
        self._world = KinematicWorld(mission, avoidance=avoidance, seed=seed)
        self._script = sorted(mission.events, key=lambda event: event.at_s)
        self.ports = self._world.ports
        self.broken = set()

    @property
    def now(self):
        return self._world.time_s

    @property
    def contacts(self):
        return self._world.contacts

    def position(self, robot) -> Place:
        return self.ports[robot].telemetry().position

    def beside_broken(self, robot):
        """Whether a broken robot truly stands close to a robot, wherever it was last heard."""
        places = dict(zip(self.ports, self._world.positions.tolist(), strict=True))
        return any(dist(places[robot], places[other]) < 4 * RADIUS for other in self.broken)

    def step(self, dt):
        """Go on, at most to where a robot is done with something."""
        self._world.advance(self.now + dt)
        while self._script and self._script[0].at_s <= self.now + 1e-9:
            self._befalls(self._script.pop(0))

    def _befalls(self, event):
        world = self._world
        if event.robot_joins is not None:
            world.join(event.robot_joins)
        elif event.robot_fails in self.ports:
            self.broken.add(event.robot_fails)
            world.fail(event.robot_fails)
        elif event.robot_silent in self.ports:
            world.silence(event.robot_silent)
        elif event.robot_returns in self.ports:
            self.broken.discard(event.robot_returns)
            world.recover(event.robot_returns)


def bodily_mission(seed):
    """A disturbed mission of robots with bodies, and how they avoid each other. In space all are drones.

    In three of four without a map places lie on a coarse grid, so that robots stand where others have to work.
    """
    random, mission = Random(f"bodies {seed}"), disturbed_mission(seed)
    crowded = mission.map is None and random.random() < 0.75
    moved = _on_grid if crowded else lambda place: place
    tasks = tuple(_task_at(task, moved) for task in mission.tasks)
    events = tuple(_event_at(event, moved, k, random) for k, event in enumerate(mission.events))
    robots = []
    for robot in mission.robots:
        placed = replace(robot, position=_free(robot.position, robots), end_position=moved(robot.end_position))
        robots.append(_with_body(placed, random))
    avoidance = "orca" if mission.dimensions == 3 else random.choice(("orca", "orca", "rvo", "hrvo"))
    return replace(mission, robots=tuple(robots), tasks=tasks, events=events), avoidance


def _on_grid(place):
    """Half as far from the middle, on the grid."""
    return place and tuple(round(c / 2 / GRID) * GRID for c in place)


def _task_at(task, moved):
    if len(task.position) == 3:  # those of a task that is moved could lie below the ground
        return replace(task, position=moved(task.position), entry=None, exit=None)
    return replace(task, position=moved(task.position), entry=moved(task.entry), exit=moved(task.exit))


def _event_at(event, moved, k, random):
    if event.new_task is not None:
        return replace(event, new_task=_task_at(event.new_task, moved))
    if event.move_task is not None:
        return replace(event, move_task=replace(event.move_task, position=moved(event.move_task.position)))
    if event.robot_joins is not None:
        outside = (2.0 * k - 8, OUTSIDE, *event.robot_joins.position[2:])
        return replace(event, robot_joins=_with_body(replace(event.robot_joins, position=outside), random))
    return event


def _free(place, robots):
    """The place, or one north of it where nobody stands."""
    while any(dist(place, robot.position) < 3 * RADIUS for robot in robots):
        place = (place[0], place[1] + 1, *place[2:])
    return place


def _with_body(robot, random):
    robot = replace(robot, kind="air") if len(robot.position) == 3 else robot
    kinematics = "quadcopter" if robot.kind == "air" else random.choice(("holonomic", "differential-drive"))
    acceleration = random.choice((None, 1.0))
    return replace(robot, radius_m=RADIUS, kinematics=kinematics, acceleration_mps2=acceleration)
