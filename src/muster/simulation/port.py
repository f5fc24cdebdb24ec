"""The port of a simulated robot."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.frames import wrapped
from muster.motion.noise import Noise
from muster.motion.order_trajectory import STEP_S, TrajectoryMaker
from muster.motion.port import Inertial, Telemetry, Waypoint
from muster.perception.dead_reckoning import Odometry
from muster.simulation.energy import SimulatedEnergy


@dataclass(frozen=True)
class Serving:
    """A stay at a way point for which a station serves the robot: the station, order and number of the way point."""

    station: str
    order: int
    number: int
    hold_s: float


class SimulatedPort:
    """The port of one robot of a world, a `RobotPort`; `body` is the robot.

    `name_of` gives the id of the robot of a number. With `trajectories` orders become trajectories that the robot
    follows. A muted robot's telemetry stays as it last was; the robot goes on, and still receives way points.
    """

    def __init__(
        self,
        robot: Robot,
        number: int,
        crowd: core.CrowdWorld,
        noise: Noise,
        seed: int,
        trajectories: TrajectoryMaker | None = None,
        name_of: Callable[[int], str] = str,
    ) -> None:
        self.body = robot
        self._name_of = name_of
        self._trajectories = trajectories
        self.energy: SimulatedEnergy | None = None
        self._held_before_s = self._stayed_before = 0.0
        self._axes = np.array([1.0, 1.0, float(len(robot.position) == 3)])
        self._number = number
        self._crowd = crowd
        self._noise = noise
        self._seed = (seed, number)
        self._orders = 0
        self._sent: dict[int, tuple[Waypoint, ...]] = {}
        self._last_word: Telemetry | None = None
        self._said: tuple[tuple[int, int], Telemetry] | None = None  # at which step and order
        # A key of its own: what is drawn at each step does not begin with the same numbers.
        random = np.random.default_rng(np.random.SeedSequence(self._seed, spawn_key=(1,)))
        self._bias_radps = float(random.normal(0.0, noise.gyro_bias_radps)) if noise.gyro_bias_radps > 0 else 0.0

    @property
    def robot(self) -> str:
        return self.body.id

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """See `RobotPort`. A failed robot does not accept it: the order in its telemetry stays.

        Raises
        ------
        ParameterError
            if a number of a way point is not finite, it holds for less than 0 s, or is reached at no speed.
        """
        for point in waypoints:
            _check(point)
        stops = list(map(_stop, waypoints))
        self._held_before_s, self._stayed_before = self.held_s, self.stay_usage
        self._orders += 1
        self._sent = {self._orders: tuple(waypoints)}
        labelled = [bool(p.label) for p in waypoints]
        self._crowd.send(self._number, np.array(stops, dtype=np.float64).reshape(-1, 6), labelled, self._orders)
        if self._trajectories is not None and waypoints:
            made = self._trajectories.trajectory(self._crowd.told_pose(self._number), waypoints)
            self._crowd.follow(self._number, made.poses, STEP_S, made.times.tolist())
        return self._orders

    def cancel(self) -> int:
        """See `RobotPort`."""
        return self.send(())

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        return self._now() if self._last_word is None else self._last_word

    @property
    def held_s(self) -> float:
        """Seconds that it has stayed at way points, as far as they are passed."""
        return self._held_before_s + sum(point.hold_s for point in self._passed if not point.service)

    @property
    def stay_usage(self) -> float:
        """What its stays have used, with usage by distance: as orders say, else their seconds times its speed."""
        return self._stayed_before + sum(
            point.hold_s * self.body.speed_mps if point.uses is None else point.uses for point in self._passed
        )

    @property
    def serving(self) -> Serving | None:
        """The stay for which a station serves it, from when it goes to that way point; None: there is none."""
        *_, order, passed = self._crowd.report(self._number)
        points = self._sent.get(order, ())
        if passed >= len(points) or not points[passed].service:
            return None
        return Serving(points[passed].service, order, passed, points[passed].hold_s)

    def has_passed(self, serving: Serving) -> bool:
        """Whether a stay was carried out to its end."""
        *_, order, passed = self._crowd.report(self._number)
        return order == serving.order and passed > serving.number

    @property
    def true_position(self) -> tuple[float, float, float]:
        """Where it is, whatever it takes itself for."""
        x, y, z = self._crowd.positions()[self._number].tolist()
        return x, y, z

    @property
    def _passed(self) -> Sequence[Waypoint]:
        """The way points that it has passed of its last order."""
        *_, order, passed = self._crowd.report(self._number)
        return self._sent.get(order, ())[:passed]

    def odometry(self) -> Odometry:
        """What odometry counted in the last step of the world, noise included; also of a muted robot."""
        ahead, left, up, turned = self._crowd.counted(self._number)
        return Odometry(self._crowd.dt, (ahead, left, up), turned)

    def inertial(self) -> Inertial | None:
        """What the inertial unit gave in the last step, noise included; also of a muted robot."""
        return self._now().inertial

    def mute(self) -> None:
        """Freeze telemetry."""
        self._last_word = self.telemetry()

    @property
    def muted(self) -> bool:
        """Whether telemetry is frozen."""
        return self._last_word is not None

    def unmute(self) -> None:
        """Let telemetry change again."""
        self._last_word = self._said = None

    def label(self, order: int, passed: int) -> str:
        """The label of the way point with which this number of an order's way points is passed."""
        points = self._sent.get(order, ())
        return points[passed - 1].label if 0 < passed <= len(points) else ""

    def _now(self) -> Telemetry:
        """What it reports now; asked for again within a step it is the same."""
        when = (self._crowd.steps, self._orders)
        if self._said is None or self._said[0] != when:
            self._said = when, self._report()
        return self._said[1]

    def _report(self) -> Telemetry:
        share = None if self.energy is None else self.energy.look().share
        said = Telemetry(*self._crowd.report(self._number), self._felt(), share, waits_for=self._held_up_by)
        return self._disturbed(said) if self._noise.of_telemetry else said

    @property
    def _held_up_by(self) -> str:
        """Who holds it up, by the world's collision avoidance; empty where nobody does."""
        number = self._crowd.held_up_by(self._number)
        return self._name_of(number) if number >= 0 else ""

    def _felt(self) -> Inertial | None:
        return Inertial(self._crowd.dt, *self._crowd.felt(self._number)) if self._crowd.steps else None

    def _disturbed(self, said: Telemetry) -> Telemetry:
        """Telemetry with errors, which are the same within a step."""
        noise, felt = self._noise, said.inertial
        random = np.random.default_rng((*self._seed, self._crowd.steps))
        off = random.normal(0.0, [noise.position_m] * 3 + [noise.heading_rad])
        x, y, z = np.array(said.position) + off[:3] * self._axes
        if felt is not None:
            off_felt = random.normal(0.0, [noise.accelerometer_mps2] * 3 + [noise.gyro_radps])
            ahead, left, up = np.array(felt.acceleration_mps2) + off_felt[:3] * self._axes
            turning = felt.turning_radps + float(off_felt[3]) + self._bias_radps
            felt = Inertial(felt.seconds, (float(ahead), float(left), float(up)), turning)
        heading = float(wrapped(said.heading + off[3]))
        return replace(said, position=(float(x), float(y), float(z)), heading=heading, inertial=felt)


def _stop(point: Waypoint) -> tuple[float, ...]:
    """A way point as the core has it."""
    return (*point.position, math.nan if point.heading is None else point.heading, point.hold_s, point.speed_mps)


def _check(point: Waypoint) -> None:
    heading = 0.0 if point.heading is None else point.heading
    if len(point.position) != 3 or not all(map(math.isfinite, (*point.position, heading))):
        raise ParameterError(f"way point: {point.position}, heading {point.heading}; expected three finite numbers")
    if not 0 <= point.hold_s < math.inf:
        raise ParameterError(f"hold_s: {point.hold_s}; expected a number of at least 0")
    if not point.speed_mps > 0:
        raise ParameterError(f"speed_mps: {point.speed_mps}; expected a number above 0")
