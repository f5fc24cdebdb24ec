"""Robots that outlive the process which commands them: behind a plug-in, MAVLink and ROS 2, all in simulated time."""

from tests.muster_robots.mavlink.drones import ORIGIN, Sky
from tests.muster_robots.ros2.bus import STEP_S, Bus

from muster.execution.final_state import final_states_of
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.system.clock import VirtualClock
from muster.simulation import KinematicWorld
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink import MavlinkFleet
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.ros2.fleet import Ros2Fleet
from muster_robots.ros2.simulated_participant import SimulatedRobot
from muster_robots.simulated_program import Wanted


def drawn(draw, *, z=None, **body):
    """A mission of a few robots and tasks with a prerequisite, and now and then a task that may be begun once."""
    count = draw.randint(1, 3)
    robots = tuple(
        Robot(id=f"r_{k}", position=(0.0, 6.0 * k, *(() if z is None else (0.0,))), radius_m=0.2, **body)
        for k in range(count)
    )

    def task(k):
        place = (draw.uniform(3, 25), draw.uniform(-5, 20), *(() if z is None else (z,)))
        before = (f"t_{k - 1}",) if k % 3 == 2 else ()
        return Task(id=f"t_{k}", position=place, actuation_cost=draw.choice([0.0, 2.0, 8.0]), prerequisites=before)

    tasks = tuple(task(k) for k in range(draw.randint(2, 6)))
    more = {} if z is None else {"origin_wgs84": ORIGIN}
    return Mission(robots=robots, tasks=tasks, rules=Rules(objective=draw.choice(["max", "total"])), **more)


class PlugIn:
    """A fleet of another package, which declares nothing: a simulated world."""

    name, flies = "plug-in", False

    def __init__(self, draw):
        self.mission = drawn(draw)
        self._world = KinematicWorld(self.mission)
        self.clock = VirtualClock()

    def opened(self, *, again):
        return WorldFleet(self._world, self.clock)

    def pass_time(self, seconds):
        self._world.advance(self._world.time_s + seconds)
        self.clock.advance(seconds)

    def close(self):
        pass


class WorldFleet:
    """The ports of a world; who opens it anew finds numbers of orders that go on."""

    def __init__(self, world, clock):
        self._world, self._clock = world, clock
        self.ports = world.ports

    @property
    def time_s(self):
        return self._world.time_s

    def advance(self, until_s):
        before = self._world.time_s
        self._world.advance(max(until_s, before + self._world.dt_s))
        self._clock.advance(self._world.time_s - before)
        return ()

    def stop(self):
        for port in self.ports.values():
            port.cancel()

    def close(self):
        pass


class Mavlink:
    """Drones behind simulated autopilots, PX4-like or ArduPilot-like."""

    name, flies = "mavlink", True

    def __init__(self, draw):
        self.mission = drawn(draw, z=draw.choice([5.0, 9.0]), kind="air", speed_mps=5.0)
        self.sky = Sky(self.mission, draw.choice([PX4, ARDUPILOT]))
        self.clock = self.sky.clock
        self._offboard = draw.random() < 0.3

    def opened(self, *, again):
        settings = FlightSettings(arm=True, offboard=self._offboard)
        made = MavlinkFleet(self.mission, self.sky.endpoints, settings, clock=self.clock, wait=self.sky.wait)
        try:
            made.connect(5.0, again=again)
        except BaseException:
            made.close()
            raise
        return made

    def pass_time(self, seconds):
        until = self.clock.now() + seconds
        while self.clock.now() < until:
            self.sky.wait(0.02)

    @property
    def armed(self):
        """By the autopilots themselves."""
        return {name for name, drone in self.sky.drones.items() if drone.armed}

    def close(self):
        self.sky.close()


class Ros2:
    """Muster's simulated participants on a bus in this process."""

    name, flies = "ros2", False

    def __init__(self, draw):
        self.mission = drawn(draw, speed_mps=draw.choice([0.8, 2.0]), kinematics="holonomic")
        self.bus = Bus()
        self.clock = self.bus.clock
        for robot in self.mission.robots:
            body = Wanted(robot, "", 1 / STEP_S, {})
            self.bus.robots.append(SimulatedRobot(body, self.bus.participant()))

    def opened(self, *, again):
        fleet = Ros2Fleet(self.mission, middleware=self.bus.participant(moves=True), clock=self.clock)
        while fleet.robots_not_ready():
            fleet.advance(fleet.time_s + 0.1)
        return fleet

    def pass_time(self, seconds):
        self.bus.go_on(seconds)

    def close(self):
        pass


WORLDS = (PlugIn, Mavlink, Ros2)


def states_of(world, fleet):
    """Where robots are, by Muster."""
    return final_states_of(fleet, world.mission)
