"""In real time a thread speaks: drones hear while nobody calls the fleet, and what ends the thread is told."""

import socket
import threading
import time

import pytest
from tests.muster_robots.mavlink.drones import ORIGIN, mission

from muster.motion.port import Waypoint
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink import MavlinkFleet
from muster_robots.mavlink.autopilots import PX4
from muster_robots.mavlink.simulated.drone import SimulatedAutopilot
from muster_robots.mavlink.simulated_autopilot import serve


@pytest.fixture
def drone():
    return SimulatedAutopilot(PX4, ORIGIN)


@pytest.fixture
def fleet(drone):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    over = threading.Event()
    flies = threading.Thread(target=serve, args=(drone, ("127.0.0.1", port)), kwargs={"until": over.is_set})
    flies.start()
    made = MavlinkFleet(mission(1), {"r_0": f"udp:127.0.0.1:{port}"}, FlightSettings(arm=True, offboard=True))
    made.connect(5.0)
    yield made
    made.close()
    over.set()
    flies.join()


def set_out(fleet, drone):
    """Until it flies."""
    fleet.ports["r_0"].send([Waypoint((80.0, 0.0, 10.0))])
    until = fleet.time_s + 20.0
    while drone.mode != PX4.guided or drone.flight.place[2] > -0.5:
        assert fleet.time_s < until
        assert fleet.advance(fleet.time_s + 0.1) == []


def test_planning_that_takes_its_time_ends_no_offboard_flight(fleet, drone):
    set_out(fleet, drone)
    time.sleep(1.5)  # the executor plans, for longer than a drone waits for words
    assert drone.mode == PX4.guided
    fleet.advance(fleet.time_s + 1.0)
    assert fleet.faults == []


def test_a_simulator_that_stood_still_has_not_lost_its_link(drone, monkeypatch):
    """The fleet's words may be on their way when it goes on; one that stays silent is noticed all the same."""
    told, turns = [], iter((0.0, 1.5, 0.0, None))
    monkeypatch.setattr(drone, "advance", lambda now: told.append(now) or [])

    def over():
        stands_s = next(turns)
        time.sleep(stands_s or 0.0)
        return stands_s is None

    serve(drone, ("127.0.0.1", 9), until=over)
    assert told == sorted(told)
    assert 0.2 <= told[-1] < 0.7


@pytest.mark.long
def test_what_ends_the_thread_is_raised_and_drones_can_be_told_to_hover_all_the_same(fleet, drone):
    set_out(fleet, drone)
    (link,) = fleet._links
    hear, errors = link.hear, [OSError("the radio burns")]

    def fail():
        link.hear = hear
        raise errors.pop()

    link.hear = fail
    with pytest.raises(OSError, match="the radio burns"):
        fleet.advance(fleet.time_s + 5.0)
    fleet.stop()
    assert fleet.faults == []
    assert drone.mode == PX4.hold
