"""Simulated autopilots on loopback, and a clock under which they fly as fast as the processor can."""

import socket

import muster
from muster.mission.errors import MusterError
from muster.mission.model import Mission, Origin, Robot, Rules, Task
from muster.mission.system.clock import VirtualClock
from muster.running.live import carry_out_live
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink import MavlinkFleet
from muster_robots.mavlink.autopilots import PX4
from muster_robots.mavlink.simulated.drone import SimulatedAutopilot
from muster_robots.mavlink.simulated.earth import origin_at
from muster_robots.mavlink.simulated.faults import Faults

ORIGIN = Origin(lat_deg=35.53, lon_deg=24.06, alt_m=100.0)


def mission(count=1, tasks=None, **more):
    robots = tuple(
        Robot(id=f"r_{k}", position=(0.0, 6.0 * k, 0.0), kind="air", radius_m=0.3, speed_mps=5.0) for k in range(count)
    )
    tasks = tasks or tuple(Task(id=f"t_{k}", position=(20.0 + k, 4.0 * k, 10.0)) for k in range(2 * count))
    return Mission(robots=robots, tasks=tasks, **{"origin_wgs84": ORIGIN, "rules": Rules(objective="max"), **more})


class Sky:
    """The drones of a mission, each behind its own socket."""

    def __init__(self, there, kind=PX4, faults=None, fences=None, **more):
        self.clock, self.drones, self.ends, self.bytes_in = VirtualClock(), {}, {}, {}
        origin = there.origin_wgs84 or ORIGIN
        for k, robot in enumerate(there.robots):
            start = (*robot.position, 0.0)[:3]
            drone = SimulatedAutopilot(
                kind, origin_at(origin, start), (faults or {}).get(robot.id, Faults()), system=k + 1, seed=k + 1, **more
            )
            drone.fence = (fences or {}).get(robot.id, drone.fence)
            end = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            end.bind(("127.0.0.1", 0))
            end.setblocking(False)
            self.drones[robot.id], self.ends[robot.id], self.bytes_in[robot.id] = drone, end, b""

    @property
    def endpoints(self):
        return {robot: f"udpout:127.0.0.1:{end.getsockname()[1]}" for robot, end in self.ends.items()}

    def wait(self, seconds):
        self.clock.advance(2 * seconds)  # half the steps are enough
        for robot, drone in self.drones.items():
            end, peer = self.ends[robot], None
            try:
                while True:
                    data, peer = end.recvfrom(65535)
                    self.bytes_in[robot] += data
                    drone.receive(data)
            except BlockingIOError:
                pass
            said = drone.advance(self.clock.now())
            if peer is not None:
                self.peers = {**getattr(self, "peers", {}), robot: peer}
            for packet in said:
                if robot in getattr(self, "peers", {}):
                    end.sendto(packet, self.peers[robot])

    def fleet(self, there, height_m=None, **settings):
        made = MavlinkFleet(
            there,
            self.endpoints,
            FlightSettings(**{"arm": True, **settings}),
            height_m=height_m,
            clock=self.clock,
            wait=self.wait,
        )
        try:
            made.connect(5.0)
        except MusterError:
            made.close()
            raise
        return made

    def close(self):
        for end in self.ends.values():
            end.close()


def flown(there, kind=PX4, faults=None, height_m=None, **settings):
    """Carry a plan out; the report, the fleet, the sky, and what happened."""
    sky, heard = Sky(there, kind, faults), []
    fleet = sky.fleet(there, height_m, **settings)
    try:
        report = carry_out_live(there, muster.solve(there, iterations=50), fleet, on_event=heard.append)
        fleet.advance(fleet.time_s + 3.0)
    finally:
        fleet.close()
        sky.close()
    return report, fleet, sky, heard
