"""Robots on ROS 1 as a fleet: those of a mission, and those that are discovered during it.

Three kinds of threads: ROS' own hear poses, one steers the robots, which goes on while planning takes its time, and one
looks for robots. What they share is behind one lock; to the executor's thread `advance` tells what has happened. Time
is ROS' own: that of /clock where `/use_sim_time` is set, and then robots are steered at the simulator's pace.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from muster.mission.errors import NetworkError, ParameterError
from muster.mission.model import Event, Mission, Robot
from muster.mission.value_types import shown
from muster.motion.avoidance_names import require_avoidance
from muster.motion.map_world import World, body_of
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.port import Place
from muster.perception.robot_grids import RobotGrid
from muster_robots.discovery import NAME, pose_topics, topics_in
from muster_robots.fleet_settings import Ros1Settings
from muster_robots.pose_custody import failures
from muster_robots.ros1.clock import MissionClock
from muster_robots.ros1.joining import Ros1Newcomers
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.node import SHUT_DOWN, is_ending, publish, time_of_ros
from muster_robots.ros1.port import Ros1Port
from muster_robots.ros1.robot_maps import Ros1Maps
from muster_robots.ros1.ros import TFMessage, rospy
from muster_robots.ros1.static_frames import static_frames
from muster_robots.simulated_time import Forward
from muster_robots.steering import STILL, Steering
from muster_robots.yielding import Yielding

_LOOK_S = 0.5
_HEARD_S = 0.5
"""A robot that takes velocities stands when it is silent for longer; one that has a goal finds its way itself."""
_TICK_S = 0.01
"""Real time between two looks at the clock: a simulator's may go faster than real time, or stand."""


class Ros1Fleet:
    """A `Fleet` over the topics of robots; this process is a node by then (`become_node`).

    Parameters
    ----------
    mission
        its robots are looked for by their ids: robot `r_0` at `/r_0/odom`, or `/r_0/pose`.
    settings
        how they are reached and steered.
    clock
        the mission's; by default by ROS' time.
    on_pose
        is told each message that gave a pose, and whose, when telemetry has it; from ROS' own threads.

    Raises
    ------
    ParameterError
        if a robot's id is no name for ROS, or a number is out of range.
    """

    def __init__(
        self,
        mission: Mission,
        settings: Ros1Settings | None = None,
        *,
        clock: MissionClock | None = None,
        on_pose: Callable[[str, Any], None] | None = None,
    ) -> None:
        how = settings or Ros1Settings()
        require_avoidance(how.avoidance, mission.dimensions)
        self._now = time_of_ros()
        self.clock = clock or MissionClock(self._now)
        self.simulated_time = isinstance(self._now, Forward)
        self.limits, self._custody_limits = how.limits, how.custody_limits
        self._drive, self._arrival_m, self._interval_s = how.drive, how.arrival_m, 1 / how.rate_hz
        self.topics = topics_in(how.namespace)
        """The namespace of a robot's topics, such as `/r_0`."""
        self._pose_topic = pose_topics(how.poses)
        self._flat = mission.dimensions == 2
        self._frame = MapFrame(how.frame)
        self._steering = Steering(interval_s=self._interval_s, space=not self._flat, avoidance=how.avoidance)
        self._yielding = Yielding(arrival_m=how.arrival_m, may_go=_free_ways(mission))
        self._on_pose = on_pose
        self._lock = threading.RLock()
        self._news = threading.Event()
        self._closed = threading.Event()
        self._failure: Exception | None = None  # of the thread that steers
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self._static = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
        if frames := static_frames(mission, self.topics, frame=self._frame.name, odometry=how.odometry):
            publish(self._static, TFMessage(frames))
        self._maps, self._hears_maps = Ros1Maps(self._frame), False
        self._ports: dict[str, Ros1Port] = {}
        self._events: list[Event] = []
        for robot in mission.robots:
            self._ports[robot.id] = self._reached(robot)
        self._newcomers = Ros1Newcomers(how.namespace, self._ports, self._reached, flat=self._flat)
        tasks: list[Callable[[], None]] = [self._steer_on] + ([] if how.known_only else [self._look_on])
        self._threads = [threading.Thread(target=task, daemon=True) for task in tasks]
        for thread in self._threads:
            thread.start()

    @property
    def ports(self) -> Mapping[str, Ros1Port]:
        """See `Fleet`."""
        return self._ports

    @property
    def time_s(self) -> float:
        """See `Fleet`. It stands still while the fleet pauses; the mission's clock does so for a simulator's alone."""
        return self.clock.time_s

    def advance(self, until_s: float) -> Sequence[Event]:
        """See `Fleet`.

        Raises
        ------
        NetworkError
            if ROS has shut this node down.
        Exception
            whatever ended the thread that steers.
        """
        real_until = time.monotonic() + until_s - self.time_s
        while self.time_s < until_s and time.monotonic() < real_until and not self._news.wait(_TICK_S):
            pass
        self._news.clear()
        if rospy.is_shutdown():
            raise NetworkError(SHUT_DOWN)
        self._require_steered()
        with self._lock:
            events, self._events = self._events, []
            custodies = [port.custody for port in self._ports.values()]
            return events + failures(custodies, self.clock.unpaused_s, self.time_s)

    def report(self, event: Event) -> None:
        """Add an event from elsewhere to those that `advance` returns."""
        with self._lock:
            self._events.append(event)
        self._news.set()

    @property
    def paused(self) -> bool:
        """Whether robots stand because somebody wants that."""
        return self.clock.paused

    def pause(self) -> None:
        """Robots stand, and the fleet's clock too, until `resume`."""
        with self._lock:
            self.clock.pause()
            self._tell_all(Ros1Port.stand)

    def resume(self) -> None:
        """Robots go on."""
        with self._lock:
            self.clock.resume()

    def robots_not_ready(self) -> dict[str, str]:
        """Robots of the mission that cannot be driven yet: what is missing, and what is expected.

        Raises
        ------
        Exception
            whatever ended the thread that steers.
        """
        self._require_steered()
        if isinstance(self._now, Forward) and not self._now.has_begun:
            return dict.fromkeys(self._all(), "/use_sim_time is set, and nothing is on /clock")
        missing = {name: missing for name, port in self._all().items() if (missing := port.missing)}
        without_map = {name: why for name in self._all() if (why := self._maps.missing(name))}
        return without_map | missing

    def hear_maps(self) -> None:
        """See `MappingFleet`."""
        with self._lock:
            self._hears_maps = True
            for robot in self._ports:
                self._maps.listen(robot, self.topics(robot))

    def new_maps(self) -> Mapping[str, RobotGrid]:
        """See `MappingFleet`."""
        return self._maps.new()

    def stop(self) -> None:
        """See `Fleet`. A node that ROS has shut down cannot tell anybody: robots stand by their own drivers then.

        Raises
        ------
        NetworkError
            if robots could not be told, with their names; all others were.
        """
        if not rospy.is_shutdown():
            self._tell_all(Ros1Port.cancel)

    def fall_silent(self) -> None:
        """Say no more, without a word to the ROS master. What was said last has time to arrive."""
        self._closed.wait(0.2)
        self._closed.set()
        for thread in self._threads:
            thread.join(timeout=2.0)

    def close(self) -> None:
        """See `Fleet`."""
        self.fall_silent()
        for port in self._all().values():
            port.close()
        self._newcomers.close()
        self._maps.close()
        self._frame.close()
        self._tf.unregister()
        self._static.unregister()

    def _reached(self, robot: Robot) -> Ros1Port:
        if not NAME.fullmatch(robot.id):
            raise ParameterError(f"robot {shown(robot.id)}; expected a name for ROS: a letter, then letters, digits, _")
        return Ros1Port(
            robot,
            self.topics(robot.id),
            drive=self._drive,
            frame=self._frame,
            flat=self._flat,
            arrival_m=self._arrival_m,
            lock=self._lock,
            clock=self.clock,
            pose_topic=self._pose_topic(robot.id),
            on_pass=self._news.set,
            on_pose=self._on_pose,
            limits=self._custody_limits,
        )

    def _all(self) -> dict[str, Ros1Port]:
        """The ports as they are now; robots may join meanwhile."""
        with self._lock:
            return dict(self._ports)

    def _tell_all(self, tell: Callable[[Ros1Port], object]) -> None:
        """Send to every robot, even if sending to others fails."""
        deaf: dict[str, Exception] = {}
        for name, port in self._all().items():
            try:
                tell(port)
            except Exception as error:  # rospy raises whatever the network does
                deaf[name] = error
        if deaf:
            why = ", ".join(f"{name} ({error})" for name, error in deaf.items())
            raise NetworkError(f"not told to stand: {why}; expected the network to reach all robots")

    def _require_steered(self) -> None:
        if self._failure is not None:
            raise self._failure

    def _steer_on(self) -> None:
        """Send velocities to the robots at each interval; on an error they stop, and `advance` raises it."""
        due_s, turn = self.clock.unpaused_s, 0
        try:
            while not self._closed.wait(min(_TICK_S, max(0.0, due_s - self.clock.unpaused_s))):
                now = self.clock.unpaused_s
                if now < due_s or rospy.is_shutdown():
                    continue
                due_s, turn = max(due_s + self._interval_s, now), turn + 1
                with self._lock:
                    self._steer()
                    frames = [frame for port in self._ports.values() for frame in port.frames()] if turn % 2 else []
                if frames:
                    publish(self._tf, TFMessage(frames))
        except Exception as error:
            if not (self._closed.is_set() or is_ending()):
                self._failure = error
                self._news.set()
                with suppress(NetworkError):  # who could be told stands
                    self._tell_all(Ros1Port.stand)

    def _steer(self) -> None:
        within_s = _HEARD_S if self._drive == "cmd_vel" else math.inf
        steered_robots = [port.steered(within_s=within_s, paused=self.clock.paused) for port in self._ports.values()]
        present = [steered for steered in steered_robots if steered is not None]
        team = self._yielding.arranged(self.clock.unpaused_s, present)
        told = self._steering.velocities(team) if self._drive == "cmd_vel" else {}
        for steered in team:
            self._ports[steered.robot.id].speak(steered, told.get(steered.robot.id, STILL))

    def _look_on(self) -> None:
        """Look for unknown robots, again and again; robots whose position is known join."""
        while not self._closed.wait(_LOOK_S):
            for port in self._newcomers.look():
                with self._lock:
                    self._ports[port.robot] = port
                    if self._hears_maps:
                        self._maps.listen(port.robot, self.topics(port.robot))
                self.report(Event(at_s=self.time_s, robot_joins=port.body))


def _free_ways(mission: Mission) -> Callable[[Robot, Place, Place], bool]:
    """Whether the mission's map lets a robot go straight from a place to another."""
    if mission.map is None:
        return lambda *_: True
    robot_paths, d = RobotPaths(World.of(mission)), mission.dimensions
    for robot in mission.robots:
        robot_paths.clear(
            body_of(robot), [robot.position]
        )  # looks at the map for this body now, not while robots are steered
    return lambda robot, here, there: robot_paths.clear(body_of(robot), [here[:d], there[:d]])
