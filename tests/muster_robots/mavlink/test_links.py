"""Lines: several drones on one, told apart by system ids; who is answered; serial lines, by a pseudo-terminal."""

import contextlib
import os
import pty
import socket
import tty
from dataclasses import replace

import pytest
from tests.muster_robots.mavlink.drones import ORIGIN, Sky, mission

import muster
from muster.mission.errors import NetworkError, ParameterError
from muster.mission.system.clock import VirtualClock
from muster.motion.port import Waypoint
from muster.running.live import carry_out_live
from muster_robots.custody import Standing
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink import MavlinkFleet, endpoints
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.dialect import Codec
from muster_robots.mavlink.endpoints import Endpoint, endpoint_of, line_to
from muster_robots.mavlink.simulated.drone import SimulatedAutopilot
from muster_robots.mavlink.simulated.faults import Faults


class Router(Sky):
    """A sky behind one socket, as MAVProxy or a telemetry radio has it: what is said goes to all drones."""

    def __init__(self, there, kind=PX4, faults=None):
        super().__init__(there, kind, faults)
        for end in self.ends.values():
            end.close()
        self.end, self.peer = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), None
        self.end.bind(("127.0.0.1", 0))
        self.end.setblocking(False)
        self.ends = {"": self.end}

    @property
    def line(self):
        return f"udpout:127.0.0.1:{self.end.getsockname()[1]}"

    @property
    def endpoints(self):
        return {robot: f"{self.line}#{drone.system}" for robot, drone in self.drones.items()}

    def wait(self, seconds):
        self.clock.advance(seconds)
        try:
            while True:
                data, self.peer = self.end.recvfrom(65535)
                for drone in self.drones.values():
                    drone.receive(data)
        except BlockingIOError:
            pass
        for drone in self.drones.values():
            for packet in drone.advance(self.clock.now()):
                if self.peer is not None:
                    self.end.sendto(packet, self.peer)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("offboard", [False, True])
def test_three_drones_behind_one_endpoint(offboard):
    there = mission(3)
    sky = Router(there, PX4, {"r_2": Faults(refuse_arm=True)})
    fleet = sky.fleet(there, offboard=offboard)
    for robot, port in fleet.ports.items():
        here = port.telemetry().position
        assert here == pytest.approx(next(r.position for r in there.robots if r.id == robot), abs=0.05)
    report = carry_out_live(there, muster.solve(there, iterations=50), fleet)
    fleet.close()
    sky.close()
    assert len(report.tasks_done) == 6
    assert [fault.robot for fault in fleet.faults] == ["r_2"]
    assert [drone.armed for drone in sky.drones.values()] == [True, True, False]
    for drone in sky.drones.values():
        own = [m for m in drone.heard if getattr(m, "target_system", 0) == drone.system]
        assert {m.target_system for m in drone.heard if hasattr(m, "target_system")} == {1, 2, 3}
        assert any(m.get_type() == "COMMAND_LONG" and m.command == 400 for m in own)


def test_one_of_several_that_is_not_named_is_asked_for():
    there = mission(2)
    sky, one = Router(there), mission(1)
    fleet = MavlinkFleet(one, {"r_0": sky.line}, FlightSettings(), clock=sky.clock, wait=sky.wait)
    with pytest.raises(ParameterError, match=r"r_0: systems 1 and 2 on udpout:.*; expected one, or which: udpout:.*#1"):
        fleet.connect(5.0)
    fleet.close()
    fleet = MavlinkFleet(one, {"r_0": f"{sky.line}#7"}, FlightSettings(), clock=sky.clock, wait=sky.wait)
    with pytest.raises(NetworkError, match="r_0: no heartbeat within 5 s"):
        fleet.connect(5.0)
    fleet.close()
    sky.close()


def test_two_drones_that_call_one_port_are_each_answered_where_they_are():
    there, clock, heard = mission(2), VirtualClock(), {1: b"", 2: b""}
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    drones = [SimulatedAutopilot(PX4, ORIGIN, system=system) for system in (1, 2)]
    ends = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in drones]

    def wait(seconds):
        clock.advance(seconds)
        for drone, end in zip(drones, ends, strict=True):
            for packet in drone.advance(clock.now()):
                end.sendto(packet, ("127.0.0.1", port))
            try:
                while True:
                    heard[drone.system] += end.recv(65535, socket.MSG_DONTWAIT)
            except BlockingIOError:
                pass

    endpoints = {f"r_{k}": f"udp:127.0.0.1:{port}#{k + 1}" for k in range(2)}
    fleet = MavlinkFleet(there, endpoints, FlightSettings(), clock=clock, wait=wait)
    fleet.connect(5.0)
    fleet.advance(fleet.time_s + 2.0)
    fleet.close()
    for system, end in zip(heard, ends, strict=True):
        asked = [m.target_system for m in messages(heard[system]) if hasattr(m, "target_system")]
        assert set(asked) == {system}
        end.close()


def messages(data):
    return list(Codec().parse(data))


def test_endpoints_by_name():
    assert endpoint_of("udp:0.0.0.0:14550#2") == Endpoint("udp:0.0.0.0:14550", 2)
    assert endpoint_of("serial:/dev/ttyUSB0:57600") == Endpoint("serial:/dev/ttyUSB0:57600", None)
    for wrong in ("udp:h:1#", "udp:h:1#0", "udp:h:1#255", "udp:h:1#x", "udp:h:1#-1"):
        with pytest.raises(ParameterError, match="expected a system id from 1 to 254 after #"):
            endpoint_of(wrong)


@pytest.mark.parametrize("pair", [("", ""), ("#1", ""), ("", "#1"), ("#1", "#1")])
def test_two_robots_on_one_line_need_a_system_id_each(pair):
    endpoints = {f"r_{k}": f"udpout:127.0.0.1:9{number}" for k, number in enumerate(pair)}
    with pytest.raises(ParameterError, match=r"of r_0 and r_1; expected a system id for each: udpout:127.0.0.1:9#1"):
        MavlinkFleet(mission(2), endpoints)


@pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
def test_a_drone_on_a_serial_line(kind):
    """The autopilot's end of a pseudo-terminal; the other is a serial device to Muster."""
    there, clock = mission(1), VirtualClock()
    ours, theirs = pty.openpty()
    tty.setraw(ours)
    tty.setraw(theirs)
    os.set_blocking(ours, False)
    drone = SimulatedAutopilot(kind, ORIGIN)

    def wait(seconds):
        clock.advance(seconds)
        with contextlib.suppress(BlockingIOError):
            drone.receive(os.read(ours, 65535))
        for packet in drone.advance(clock.now()):
            os.write(ours, packet)

    fleet = MavlinkFleet(
        there, {"r_0": f"serial:{os.ttyname(theirs)}:115200"}, FlightSettings(arm=True), clock=clock, wait=wait
    )
    fleet.connect(5.0)
    report = carry_out_live(there, muster.solve(there, iterations=50), fleet)
    assert len(report.tasks_done) == 2
    assert fleet.faults == []
    os.close(ours)  # unplugged
    drone.receive = lambda data: None
    fleet._wait = clock.advance
    fleet.advance(fleet.time_s + 20.0)
    assert fleet.sessions["r_0"].custody.standing is Standing.SILENT
    assert fleet.ports["r_0"].telemetry().time_s < fleet.time_s - 19.0
    fleet.close()
    os.close(theirs)


@pytest.mark.parametrize("apart_m", [6.0, 0.0], ids=["by their places", "by their clocks"])
def test_two_autopilots_with_one_system_id_are_noticed_before_anything_is_ordered(apart_m):
    there = mission(2)
    sky = Router(there)
    one, other = sky.drones.values()
    other.system = one.system
    other._codec = Codec(one.system, 1)
    if not apart_m:
        other.origin = one.origin
        advance = other.advance
        other.advance = lambda now: advance(now + 30.0)  # it was switched on earlier
    alone = replace(there, robots=there.robots[:1])
    fleet = MavlinkFleet(alone, {"r_0": sky.line}, FlightSettings(arm=True), clock=sky.clock, wait=sky.wait)
    with pytest.raises(ParameterError, match=r"r_0: two autopilots with the system id 1 on udpout:.*; expected an id"):
        fleet.connect(5.0)
    fleet.close()
    sky.close()
    assert not any(message.get_type().startswith("MISSION") for message in one.heard)


class Served(Sky):
    """A drone that is served over TCP, one caller at a time."""

    def __init__(self, there):
        super().__init__(there)
        for end in self.ends.values():
            end.close()
        self.server, self.caller = socket.create_server(("127.0.0.1", 0)), None
        self.server.setblocking(False)
        self.ends = {"": self.server}

    @property
    def endpoints(self):
        return {"r_0": f"tcp:127.0.0.1:{self.server.getsockname()[1]}"}

    def hang_up(self):
        self.caller.close()
        self.caller = None

    def wait(self, seconds):
        self.clock.advance(seconds)
        with contextlib.suppress(BlockingIOError):
            self.caller, _ = self.server.accept()
            self.caller.setblocking(False)
        said = self.drones["r_0"].advance(self.clock.now())
        if self.caller is not None:
            with contextlib.suppress(BlockingIOError):
                self.drones["r_0"].receive(self.caller.recv(65535))
            for packet in said:
                self.caller.send(packet)


def test_a_drone_over_tcp_flies_on_when_the_connection_was_lost(monkeypatch):
    monkeypatch.setattr(endpoints, "_CALL_AGAIN_S", 0.1)
    there = mission(1)
    sky = Served(there)
    fleet = sky.fleet(there)
    fleet.ports["r_0"].send([Waypoint((40.0, 0.0, 10.0))])
    fleet.advance(fleet.time_s + 5.0)
    sky.hang_up()
    report = carry_out_live(there, muster.solve(there, iterations=50), fleet)
    fleet.close()
    sky.hang_up()
    sky.close()
    assert len(report.tasks_done) == 2
    assert fleet.faults == []


def test_a_drone_over_tcp_that_is_not_there_is_said_in_a_line():
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    with pytest.raises(NetworkError, match=rf"tcp:127.0.0.1:{port}: .*; expected an address at which MAVLink"):
        line_to(f"tcp:127.0.0.1:{port}")


def test_a_serial_line_that_takes_nothing_keeps_the_newest_in_whole_packets():
    ours, theirs = pty.openpty()
    tty.setraw(ours)
    tty.setraw(theirs)
    line, codec, count = line_to(f"serial:{os.ttyname(theirs)}:115200"), Codec(), 5000
    for k in range(count):
        line.write(codec.pack(codec.make.mission_current_encode(k)), None)
    assert sum(map(len, line._unsent)) <= 4096
    os.set_blocking(ours, False)
    data, last = b"", codec.pack(codec.make.mission_current_encode(count))
    for _ in range(50):
        with contextlib.suppress(BlockingIOError):
            data += os.read(ours, 65535)
        line.write(last, None)
    line.close()
    os.close(ours)
    os.close(theirs)
    heard = [message.seq for message in messages(data)]
    assert sum(len(message.get_msgbuf()) for message in messages(data)) == len(data)  # nothing is cut
    assert heard == sorted(heard)
    assert heard[-1] == count
    assert len(heard) < count / 2
    assert set(range(count - 100, count)) <= set(heard)


def test_a_serial_line_that_is_none_is_said_in_a_line():
    with pytest.raises(NetworkError, match=r"serial:/dev/nothing-here: .*expected a serial device"):
        line_to("serial:/dev/nothing-here")
