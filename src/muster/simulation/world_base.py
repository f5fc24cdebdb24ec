"""What all simulated worlds share: the core's crowd (`core/crowd/`) chooses robots' velocities in each step.

The crowd has way points, collision avoidance, limits of speed, yaw rate and acceleration, and a right of way that
leaves every robot room to brake.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, Unpack

import numpy as np

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.mission_parts import positions
from muster.mission.model import Mission, Robot
from muster.mission.texts.near_matches import did_you_mean
from muster.motion.avoidance_names import AUTO, method_for
from muster.motion.frames import rotation
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import kinematics_named, limits_of, turning_radius_of
from muster.motion.laws import PROFILE, THESIS, TRAJECTORY, require_law
from muster.motion.limits import Limits
from muster.motion.map_world import Body, World, body_of
from muster.motion.noise import NO_NOISE, Noise
from muster.motion.order_trajectory import TrajectoryMaker
from muster.motion.paths.robot_paths import RobotPaths
from muster.perception.laser import NO_DISCS, Scanner
from muster.perception.sphere_scanner import Slab, SphereScan, SphereScanner
from muster.simulation.energy import GivenEnergy
from muster.simulation.port import SimulatedPort
from muster.simulation.station_service import LOOK_S
from muster.simulation.walls import faces_and_slabs, things_in_air
from muster.simulation.world import Contact, Observer, SimulatedWorld, WaypointPassed, standing
from muster.simulation.world_energy import WorldEnergy

NEIGHBOURS = 10
FLIGHT_M = 1.5
"""How high drones fly in a mission in the plane."""
MARGIN = 0.05
"""By this share of its radius avoidance enlarges a robot that faces its way, since such a robot answers late."""
WALL_HORIZON_S = 0.3
CORNER_M = 0.02
"""By how much a robot may miss a way point past which it goes on."""
Event = tuple[float, int, int, int, bool]
"""Time, robot, order, way points passed, whether all; as `core.CrowdWorld.advance` gives it."""
Faces = tuple[Floats, list[Slab]]
"""As `faces_and_slabs` gives them."""
OF_THE_THESIS = ("quadcopter", "differential-drive")
"""The kinematics for which [tcf-thesis] has control laws."""
_AWAY_M = 1e7
"""A robot that was taken away is so far from all others, and from any other like it."""
_NO_FACES = np.empty((0, 6))
_SLICE = 10_000
"""Steps between checks for Ctrl-C."""
_LOOKS_EVERY_M = 0.05
"""Of the way on which a robot comes to a stand: so near to each other are the places that may hold a door open."""


class WorldBase(SimulatedWorld, ABC):
    """Robots of a mission that move; deterministic by seed. Subclasses say how bodies follow their velocities.

    Robots start at their positions in the mission and stand until they get way points. Where travel is by the map its
    walls are there.

    Parameters
    ----------
    mission
        its robots and its map are used.
    seed
        of noise, and of the detours that robots try when they block each other.
    dt_s
        seconds a step; velocities are constant within one.
    noise
        see `Noise`.
    avoidance
        `auto`, the method that gets all done soonest; `orca`, in the plane `rvo`, `hrvo` or `avo` too; or `none`:
        robots drive through each other and through walls.
    law
        how robots come to the velocity that they want: `profile`, speeds and turns on the spot as fast as the limits
        allow; `thesis`, quadcopters and differential drives by (4.9)-(4.16) and (4.21)-(4.25) of [tcf-thesis];
        `trajectory`, along smooth curves with velocities, which a controller follows ([market-paper], section 3.2.3).
    horizon_s
        lookahead of avoidance.
    arrival_m
        the distance from a way point at which a robot that cannot get nearer has arrived; undisturbed ones go to 1 mm.
    observer, observe_s
        called at the beginning and then at each step, or at most this often; costs time.
    snapshot
        of the world that this one continues, with the same robots in the same order; see `snapshot`.
    energy
        see `GivenEnergy`.

    Raises
    ------
    ParameterError
        if a number is out of range.
    MissionError, MissingExtraError
        as `World.of`, with a map.
    """

    _turned_rad = 1e-9
    """The error of a heading at which a robot has turned to it."""
    _clearance_m = 0.0
    """The gap that the right of way leaves between robots that follow their velocities less exactly."""

    def __init__(
        self,
        mission: Mission,
        *,
        seed: int = 0,
        dt_s: float = 0.1,
        noise: Noise = NO_NOISE,
        avoidance: str = AUTO,
        law: str = "profile",
        horizon_s: float = 2.0,
        arrival_m: float = 0.02,
        observer: Observer | None = None,
        observe_s: float = 0.0,
        snapshot: Mapping[str, Any] | None = None,
        **energy: Unpack[GivenEnergy],
    ) -> None:
        require_law(law)
        _require(seed, dt_s=dt_s, horizon_s=horizon_s, arrival_m=arrival_m)
        self._map = World.of_travel(mission) if mission.has_ways_by_map else None
        self._dimensions = mission.dimensions
        self._lowest_m = _lowest(mission)
        self._dt_s = dt_s
        self._law = law
        self._paths: RobotPaths | None = None
        self._noise = noise
        self._seed = seed
        self._observer = observer
        self._observed_steps = max(1, round(observe_s / dt_s))
        self._crowd = core.CrowdWorld(
            dt=dt_s,
            avoidance=method_for(avoidance, mission.dimensions),
            space=mission.dimensions == 3,
            horizon=horizon_s,
            wall_horizon=max(WALL_HORIZON_S, dt_s),
            neighbours=NEIGHBOURS,
            clearance=self._clearance_m,
            margin=MARGIN,
            arrival=arrival_m,
            corner=CORNER_M,
            heading=self._turned_rad,
            velocity_noise=noise.velocity,
            slip=noise.slip,
            odometry_noise=noise.odometry,
            seed=seed,
        )
        if snapshot is not None:
            self._crowd.resume(math.ceil(snapshot["time_s"] / dt_s - 1e-6), [])
        self._energy = WorldEnergy(mission, self._crowd, self._drained_by, snapshot, **energy)
        self._walls: dict[tuple[Body, frozenset[str]], int] = {}
        self._faces: dict[tuple[Body, frozenset[str]], Faces] = {}
        self._things: Faces | None = None
        self._doors_to_close = self._doors_closed
        self._numbers: dict[str, int] = {}
        self._robots: list[Robot] = []
        self._ports: dict[str, SimulatedPort] = {}
        self._failed: set[str] = set()
        self._removed: dict[str, tuple[float, ...]] = {}  # by robot where it was taken away from
        self._before: Mapping[str, Any] = snapshot or {"least_m": None, "contacts": (), "distances_m": {}}
        for robot in mission.robots:
            self.join(robot if snapshot is None else standing(robot, snapshot))
        if snapshot is not None:
            self._resume(snapshot)
        self._observe()

    @property
    def time_s(self) -> float:
        return self._crowd.time

    @property
    def dt_s(self) -> float:
        return self._dt_s

    @property
    def noise(self) -> Noise:
        return self._noise

    @property
    def ports(self) -> Mapping[str, SimulatedPort]:
        return MappingProxyType(self._ports)

    def step(self) -> tuple[WaypointPassed, ...]:
        return self._advance(self.time_s + self._dt_s)

    def advance(self, until_s: float) -> tuple[WaypointPassed, ...]:
        stride = self._observed_steps if self._observer is not None else _SLICE
        if self._energy.limited:
            stride = min(stride, max(1, round(LOOK_S / self._dt_s)))
        while self.time_s + self._dt_s <= until_s + 1e-6 * self._dt_s:
            target = min(until_s, (self._crowd.steps // stride + 1) * stride * self._dt_s)
            passed = self._advance(target)
            if passed:
                return passed
        return ()

    def join(self, robot: Robot) -> SimulatedPort:
        if robot.id in self._numbers:
            raise ParameterError(f"robot {robot.id}: it is in the world; expected a new id")
        if len(robot.position) != self._dimensions:
            raise ParameterError(f"robot {robot.id}: {robot.position}; expected {self._dimensions} coordinates")
        limits, kinematics = self._limits(robot), kinematics_named(robot.kinematics)
        x, y, z = (*robot.position, 0.0)[:3]
        thesis = self._law == THESIS and robot.kinematics == "quadcopter"
        climbs = robot.kind == "air" and not thesis and limits.climb_mps is not None
        number = self._crowd.add(
            (x, y, z),
            math.radians(robot.heading_deg),
            radius=robot.radius_m,
            speed=limits.speed_mps,
            yaw_rate=limits.yaw_rate_radps,
            acceleration=limits.acceleration_mps2,
            priority=robot.avoidance_priority,
            faces_its_way=kinematics.faces_its_way,
            flies=robot.kind == "air",
            walls=self._walls_for(body_of(robot)),
            law=self._law_of(robot),
            climb=limits.climb if thesis else 0.0,
            climb_rate=limits.climb if climbs else math.inf,
        )
        self._numbers[robot.id] = number
        self._robots.append(robot)
        trajectories = self._trajectories_of(robot)
        port = SimulatedPort(robot, number, self._crowd, self._noise, self._seed, trajectories, self._name_of)
        self._ports[robot.id] = port
        self._energy.begin(robot, number, port)
        return port

    def snapshot(self) -> dict[str, Any]:
        """Return plain data from which a world is made whose bodies stand, move and hold energy as they do here.

        Faults of robots, contacts and the clock are in it. What is random begins anew by the seed, and so does what a
        station has given to a robot that it serves.
        """
        poses, motions = np.column_stack([self._crowd.positions(), self.headings]), self._crowd.motions()
        for robot, place in self._removed.items():
            poses[self._number(robot), :3] = place
        return {
            "time_s": self.time_s,
            "robots": dict(zip(self._numbers, np.hstack([poses, motions]).tolist(), strict=True)),
            "distances_m": dict(self.distances_m),
            **self._energy.snapshot(),
            "failed": sorted(self._failed),
            "removed": sorted(self._removed),
            "muted": [name for name, port in self._ports.items() if port.muted],
            "least_m": self.min_distance_m,
            "contacts": [[one.time_s, *one.robots, one.least_distance_m] for one in self.contacts],
        }

    def _resume(self, snapshot: Mapping[str, Any]) -> None:
        motions = [snapshot["robots"][robot][4:] for robot in self._numbers]
        self._crowd.resume(self._crowd.steps, motions)
        for robot in snapshot["failed"]:
            self.fail(robot, silent=False)
        for robot in snapshot["muted"]:
            self.silence(robot)
        for robot in snapshot.get("removed", ()):
            self.remove(robot)

    def fail(self, robot: str, *, silent: bool = True) -> None:
        self._crowd.fail(self._number(robot))
        self._failed.add(robot)
        if silent:
            self._ports[robot].mute()

    def remove(self, robot: str) -> None:
        number = self._number(robot)
        if robot in self._removed:
            return
        self.fail(robot)
        self._removed[robot] = tuple(self._crowd.positions()[number].tolist())
        self._put(number, (_AWAY_M, _AWAY_M * (1 + number), self._removed[robot][2]))

    def place(self, robot: str, position: tuple[float, ...]) -> None:
        number = self._number(robot)
        height = float(self._crowd.positions()[number, 2])
        self._put(number, (*position, height)[:3] if len(position) == 2 else position)

    def _put(self, number: int, place: tuple[float, ...]) -> None:
        x, y, z = place
        self._crowd.place(number, (x, y, z))

    def recover(self, robot: str) -> None:
        if robot in self._removed:
            self._put(self._number(robot), self._removed.pop(robot))
        self._crowd.recover(self._number(robot))
        self._failed.discard(robot)
        self._ports[robot].unmute()
        self._energy.recover(robot)

    def silence(self, robot: str) -> None:
        self._number(robot)
        self._ports[robot].mute()

    def unsilence(self, robot: str) -> None:
        self._number(robot)
        self._ports[robot].unmute()

    def slow(self, robot: str, factor: float) -> None:
        if not 0 < factor <= 1:
            raise ParameterError(f"factor: {factor}; expected above 0 to 1")
        self._crowd.slow(self._number(robot), factor)

    def close(self, doors: Collection[str]) -> None:
        self._doors_to_close = frozenset(doors)
        self._turn_doors()

    @property
    def _doors_closed(self) -> frozenset[str]:
        return frozenset() if self._map is None else self._map.closed

    def _turn_doors(self) -> None:
        """Open and close doors as asked; those that robots are in, or cannot stop before, stay open for now."""
        if self._map is None:
            return
        bodies = [
            (body_of(robot), place)
            for robot, at, velocity in zip(self._robots, self.positions, self.velocities, strict=True)
            if robot.id not in self._removed
            for place in self._until_it_stands(robot, at, velocity)
        ]
        closing = self._doors_to_close - self._map.closed
        closed = self._doors_to_close - {door for door in closing if self._map.holds_open(door, bodies)}
        if closed == self._map.closed:
            return
        self._map, self._paths = self._map.with_closed(closed), None
        for number, robot in enumerate(self._robots):
            self._crowd.set_walls(number, self._walls_for(body_of(robot)))

    def _until_it_stands(self, robot: Robot, at: Floats, velocity: Floats) -> Iterator[Floats]:
        """Where a robot is and passes, if it stops at once."""
        speed_mps = float(np.linalg.norm(velocity))
        ahead = velocity * (self._crowd.dt + speed_mps / (2 * self._limits(robot).acceleration_mps2))
        pieces = math.ceil(float(np.linalg.norm(ahead)) / _LOOKS_EVERY_M)
        return (at + share * ahead for share in np.linspace(0.0, 1.0, pieces + 1))

    def leave_to_traffic(self, robot: str) -> None:
        self._crowd.leave_to_traffic(self._number(robot))

    def believe(self, robot: str, pose: Floats, spread_m: float) -> None:
        x, y, z, heading = map(float, pose)
        self._crowd.believe(self._number(robot), (x, y, z), heading, spread_m)

    @property
    def positions(self) -> Floats:
        found: Floats = self._crowd.positions()
        found[[self._numbers[robot] for robot in self._removed]] = math.nan
        return found

    @property
    def headings(self) -> Floats:
        found: Floats = self._crowd.headings()
        return found

    @property
    def frames(self) -> Floats:
        above = FLIGHT_M if self._dimensions == 2 else 0.0
        flies = np.array([robot.kind == "air" for robot in self._robots], dtype=np.float64)
        return np.asarray(self.positions + above * flies[:, None] * (0.0, 0.0, 1.0))

    @property
    def axes(self) -> Floats:
        return rotation(0.0, 0.0, self.headings)

    @property
    def ground_m(self) -> float:
        return self._lowest_m if self._dimensions == 3 else 0.0

    @property
    def velocities(self) -> Floats:
        found: Floats = self._crowd.velocities()
        return found

    @property
    def distances_m(self) -> Mapping[str, float]:
        before = self._before["distances_m"]
        return {name: before.get(name, 0.0) + float(self._crowd.travelled()[k]) for name, k in self._numbers.items()}

    @property
    def min_distance_m(self) -> float | None:
        before = self._before["least_m"]
        least = min(self._crowd.least_distance, math.inf if before is None else before)
        return None if math.isinf(least) else least

    @property
    def contacts(self) -> tuple[Contact, ...]:
        ids = list(self._numbers)
        found = {(a, b): Contact(time, (a, b), least) for time, a, b, least in self._before["contacts"]}
        for a, b, time, least in self._crowd.contacts():
            one = found.setdefault((ids[a], ids[b]), Contact(time, (ids[a], ids[b]), least))
            found[one.robots] = replace(one, least_distance_m=min(least, one.least_distance_m))
        return tuple(found.values())

    @property
    def tracking_error_m(self) -> tuple[float, float] | None:
        """By how much robots were off their trajectories, on average and at most; None where none followed one."""
        errors = [self._crowd.tracking_errors(number) for number in self._numbers.values()]
        steps = sum(count for _, _, count in errors)
        return (sum(total for total, _, _ in errors) / steps, max(most for _, most, _ in errors)) if steps else None

    def idle(self, robot: str) -> bool:
        return not self._crowd.busy(self._number(robot))

    @abstractmethod
    def scan(self, robot: str, scanner: Scanner, cylinders: Floats = NO_DISCS, height_m: float | None = None) -> Floats:
        """See `SimulatedWorld`."""

    def scan_space(self, robot: str, scanner: SphereScanner) -> SphereScan:
        """See `SimulatedWorld`. Other robots are balls of their radius."""
        if self._things is None:
            self._things = (_NO_FACES, []) if self._map is None else things_in_air(self._map)
        number, places = self._number(robot), self.positions
        radii = np.array([other.radius_m for other in self._robots])
        balls = np.delete(np.column_stack([places, radii]), number, axis=0)
        faces, slabs = self._things
        heading = float(self.headings[number])
        return scanner.scan(places[number], heading, faces, slabs, self.ground_m, balls)

    @abstractmethod
    def _go_on(self, until_s: float) -> list[Event]:
        """Step until a time, or until a way point is passed."""

    def _drained_by(self, robot: Robot, number: int, port: SimulatedPort) -> Callable[[], float]:
        """What tells the share of a full store that a robot of the mission without one has drained: here by usage."""
        return self._energy.drained_by_usage(robot, number, port)

    def _limits(self, robot: Robot) -> Limits:
        return limits_of(robot)

    def _law_of(self, robot: Robot) -> str:
        """The law of one robot: that of the thesis is for quadcopters and differential drives."""
        return PROFILE if self._law == THESIS and robot.kinematics not in OF_THE_THESIS else self._law

    def _trajectories_of(self, robot: Robot) -> TrajectoryMaker | None:
        """What makes trajectories of a robot's orders, where robots follow such."""
        if self._law != TRAJECTORY:
            return None
        if self._map is not None and self._paths is None:
            self._paths = RobotPaths(self._map)
        paths, body = self._paths, body_of(robot)
        return TrajectoryMaker(
            limits=self._limits(robot),
            faces_its_way=kinematics_named(robot.kinematics).faces_its_way,
            radius_m=turning_radius_of(robot),
            clear=(lambda _: True) if paths is None else (lambda points: paths.clear(body, points)),
            dimensions=self._dimensions,
        )

    def _advance(self, until_s: float) -> tuple[WaypointPassed, ...]:
        if self._doors_to_close != self._doors_closed:
            self._turn_doors()
        ids = list(self._numbers)
        passed = []
        begin_s, before = self.time_s, self._energy.look()
        for time, number, order, count, idle in self._go_on(until_s):
            label = self._ports[ids[number]].label(order, count)
            passed.append(WaypointPassed(time, ids[number], order, count, label, idle))
        for number in self._energy.emptied_since(before, self.time_s - begin_s):
            self._crowd.fail(number)
        if self._crowd.steps % self._observed_steps == 0:
            self._observe()
        return tuple(passed)

    def _observe(self) -> None:
        if self._observer is not None:
            self._observer(self.time_s, self.positions, self.headings, self.velocities)

    def _name_of(self, number: int) -> str:
        return self._robots[number].id

    def _number(self, robot: str) -> int:
        if robot not in self._numbers:
            known = list(self._numbers)
            raise ParameterError(f"robot {robot}: not in the world; expected one of it{did_you_mean(robot, known)}")
        return self._numbers[robot]

    def _walls_for(self, body: Body) -> int:
        """The number of the set of walls that stop this body; equal bodies have the same set."""
        key = (body, self._doors_closed)
        if key not in self._walls:
            faces, slabs = self._faces_for(body)
            ground = self._lowest_m if body.kind == "air" else -math.inf
            self._walls[key] = self._crowd.add_walls(faces, slabs, ground)
        return self._walls[key]

    def _faces_for(self, body: Body) -> Faces:
        """What stops this body: upright faces, and zones with a height."""
        key = (body, self._doors_closed)
        if key not in self._faces:
            self._faces[key] = (_NO_FACES, []) if self._map is None else faces_and_slabs(self._map, body)
        return self._faces[key]


def _lowest(mission: Mission) -> float:
    """Where the ground is: 0, or the lowest place of a mission in space; -inf in the plane."""
    if mission.dimensions == 2:
        return -math.inf
    return min(0.0, *(place[2] for _, place in positions(mission) if len(place) == 3))


def _require(seed: int, **numbers: float) -> None:
    if not 0 <= seed < 2**64:
        raise ParameterError(f"seed: {seed}; expected 0 to 2^64 - 1")
    for name, number in numbers.items():
        if not 0 < number < math.inf:
            raise ParameterError(f"{name}: {number}; expected a finite number above 0")
