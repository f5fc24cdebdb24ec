"""A session that is spoken to, message by message, in the words of a drone."""

from muster.mission.model import Origin, Robot
from muster.motion.port import Waypoint
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink.autopilots import PX4
from muster_robots.mavlink.dialect import mavlink
from muster_robots.mavlink.drone import Drone
from muster_robots.mavlink.fence import no_fence
from muster_robots.mavlink.frames import GlobalFrame
from muster_robots.mavlink.session import Session
from muster_robots.mavlink.telemetry import DroneTelemetry

ORIGIN = Origin(lat_deg=47.0, lon_deg=8.0, alt_m=400.0)
M = mavlink


def from_drone(message):
    message._header.srcSystem, message._header.srcComponent = 7, 1
    return message


def heartbeat(kind=PX4, mode=None, armed=False, **more):
    known = M.MAV_AUTOPILOT_PX4 if kind is PX4 else M.MAV_AUTOPILOT_ARDUPILOTMEGA
    base = 1 | (128 if armed else 0)
    fields = {"type": 2, "autopilot": known, "custom_mode": kind.ready if mode is None else mode, **more}
    return from_drone(
        M.MAVLink_heartbeat_message(
            fields["type"], fields["autopilot"], base, fields["custom_mode"], more.get("state", 4), 3
        )
    )


def position(above=0.0, lat=470000000, lon=80000000):
    return from_drone(M.MAVLink_global_position_int_message(0, lat, lon, 450000, round(above * 1000), 0, 0, 0, 0))


def ack(command, result):
    return from_drone(M.MAVLink_command_ack_message(command, result))


def request(seq):
    return from_drone(M.MAVLink_mission_request_int_message(255, 190, seq))


def mission_ack(result=0):
    return from_drone(M.MAVLink_mission_ack_message(255, 190, result))


class Talk:
    """A session that is spoken to, at times that only grow."""

    def __init__(self, kind=PX4, **settings):
        robot = Robot(id="r_0", position=(0.0, 0.0, 0.0), kind="air", speed_mps=4.0)
        telemetry = DroneTelemetry((0.0, 0.0, 0.0), GlobalFrame(ORIGIN, (0.0, 0.0, 0.0)))
        self.session = Session(Drone(robot, telemetry, FlightSettings(**{"arm": True, **settings}), None), no_fence)
        self.session.drone.limits.is_read = True  # as a fleet has it before the first order
        self.kind, self.now = kind, 0.0
        self.say(heartbeat(kind), position())

    def say(self, *messages):
        """What is answered at once, heartbeats and requests for telemetry left out."""
        for message in messages:
            self.session.hear(message, self.now)
        return self.taken()

    def beats(self, count=2, **more):
        """What it is told while it sends heartbeats, one a second, all alike."""
        said = []
        for _ in range(count):
            self.now += 1.0
            said += self.say(heartbeat(self.kind, **more), position(above=8.0))
            self.session.tick(self.now)
        return said + self.taken()

    def after(self, seconds):
        self.now += seconds
        self.session.tick(self.now)
        return self.taken()

    def taken(self):
        quiet = ("HEARTBEAT",)
        said = [m for m in self.session.take() if m.get_type() not in quiet]
        return [m for m in said if getattr(m, "command", None) != M.MAV_CMD_SET_MESSAGE_INTERVAL]

    def fly(self, *places, hold_s=0.0):
        self.session.follow([Waypoint(place, hold_s=hold_s) for place in places], self.now)
        return self.taken()

    def arming(self, *places):
        """Until it is asked to arm; what it is told then."""
        for seq in range(self.fly(*places)[0].count):
            self.say(request(seq))
        return self.say(mission_ack())

    def flying(self, *places):
        """Until a mission of these places is under way."""
        first = self.arming(*places)
        if first[0].get_type() == "COMMAND_LONG":
            first = self.say(heartbeat(self.kind, armed=True))
        self.say(from_drone(M.MAVLink_mission_current_message(first[0].seq)))
        assert self.say(heartbeat(self.kind, self.kind.mission, armed=True), position(above=8.0)) == []


HOLD, DISARM, START = (M.MAV_CMD_DO_SET_MODE, M.MAV_CMD_COMPONENT_ARM_DISARM, M.MAV_CMD_MISSION_START)


def commands(messages):
    return [(m.command, m.param1) for m in messages if m.get_type() == "COMMAND_LONG"]
