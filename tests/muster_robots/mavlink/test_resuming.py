"""`muster fly` that was killed or interrupted: what it leaves, what is refused, `--resume` and `--recover`."""

import json
import re
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission

import muster
from muster.cli.exits import BAD_INPUT, DONE, STILL_MOVING
from muster.cli.main import run
from muster.mission.model import Origin
from muster.motion.port import Waypoint
from muster.running.journal import Journal
from muster.running.journal_file import Header, read_journal
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink import MavlinkFleet
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.simulated.drone import SimulatedAutopilot
from muster_robots.mavlink.simulated_autopilot import serve

MISSION = """
schema: muster/1
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
robots: [{id: r_0, position: [0, 0, 0], kind: air, speed_mps: 10}]
tasks: [{id: a, position: [25, 0, 5]}, {id: b, position: [60, 0, 5]}]
"""


@pytest.fixture
def file(tmp_path):
    (tmp_path / "m.yaml").write_text(MISSION)
    return tmp_path / "m.yaml"


@pytest.fixture
def port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@pytest.fixture
def drone(port):
    """A drone that flies in a thread, eight times as fast as time goes."""
    over, made = threading.Event(), SimulatedAutopilot(PX4, Origin(lat_deg=35.53, lon_deg=24.06))
    how = {"until": over.is_set, "speed": 8.0}
    thread = threading.Thread(target=serve, args=(made, ("127.0.0.1", port)), kwargs=how)
    thread.start()
    yield made
    over.set()
    thread.join()


@pytest.fixture
def call(file, port):
    return ["fly", str(file), f"--endpoint=r_0=udp:127.0.0.1:{port}", "--time-limit=0.1"]


def killed(call, drone, number):
    """A process that flies, and ends by a signal when the drone is more than 21.4 m from its start."""
    process = subprocess.Popen([sys.executable, "-m", "muster.cli", *call, "--arm"], stderr=subprocess.PIPE, text=True)
    end = time.monotonic() + 60.0
    for line in process.stderr:
        if "sets out for task b" in line or time.monotonic() > end:
            break
    process.send_signal(number)
    process.communicate(timeout=60)
    assert drone.flight.place[1] > 21.4
    assert drone.armed


@pytest.mark.long
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_it_goes_on_in_the_air_and_does_nothing_twice(number, call, drone, capsys):
    killed(call, drone, number)
    assert run([*call, "--arm"]) == STILL_MOVING
    told = capsys.readouterr().err.splitlines()
    assert re.match(r"still flying, driving or armed: r_0; land or stop them by", told[0])
    assert re.search(
        r"did not end \(1 task done\), and has left r_0: .*, armed; at .* m from its start; expected", told[2]
    )
    assert run([*call, "--resume"]) == STILL_MOVING
    assert "--resume given without --arm" in capsys.readouterr().err
    assert run([*call, "--arm", "--resume", "--at-end", "return", "--format", "json"]) == DONE
    out, err = capsys.readouterr()
    assert json.loads(out)["tasks_done"] == ["a", "b"]
    assert "has done task a" not in err
    assert err.splitlines()[-1].startswith("r_0: returned, landed, not armed")
    assert not drone.armed


@pytest.mark.long
def test_drones_that_were_to_return_do_so_though_that_is_not_asked_for_again(call, drone, capsys):
    """Muster is killed while it waits for them to land."""
    process = subprocess.Popen(
        [sys.executable, "-m", "muster.cli", *call, "--arm", "--at-end=return"], stderr=subprocess.PIPE, text=True
    )
    end = time.monotonic() + 60.0
    while drone.mode != PX4.back and time.monotonic() < end:
        time.sleep(0.02)
    process.kill()
    process.communicate(timeout=60)
    assert (drone.armed, drone.mode) == (True, PX4.back)
    assert run([*call, "--arm", "--resume"]) == DONE
    err = capsys.readouterr().err
    assert "2 tasks done; r_0 was to return" in err
    assert err.splitlines()[-1].startswith("r_0: returned, landed, not armed")
    assert not drone.armed


@pytest.mark.long
def test_it_is_brought_home_with_and_without_a_journal(call, drone, capsys, tmp_path, monkeypatch):
    killed(call, drone, signal.SIGKILL)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "elsewhere"))
    assert run([*call, "--recover"]) == STILL_MOVING
    assert "--recover given without --arm; expected both" in capsys.readouterr().err
    assert run([*call, "--arm", "--recover"]) == DONE
    assert capsys.readouterr().err.splitlines()[-1].startswith("r_0: returned, landed, not armed")
    assert run([*call, "--arm", "--recover"]) == DONE
    assert not drone.armed


def test_a_drone_far_away_that_no_journal_knows_is_named(call, drone, capsys):
    drone.armed, drone.mode, drone.flight.place = True, PX4.hold, (0.0, 30.0, -5.0)
    assert run([*call, "--arm"]) == STILL_MOVING
    told = capsys.readouterr().err
    assert "r_0: hovers, armed; at (30.0" in told
    assert "or give --recover" in told
    assert run([*call, "--arm", "--resume"]) == BAD_INPUT
    assert "expected a journal" in capsys.readouterr().err


def test_a_run_goes_on_without_a_drone_that_is_not_heard_any_more(tmp_path):
    there, ends, halt = mission(2), [], threading.Event()
    sky, plan, path = Sky(there), muster.solve(there, iterations=50), tmp_path / "a.journal"
    fleet, first = sky.fleet(there), Journal.begun(path, there, Header.of(there, plan, "mavlink", ["it"]), ())

    def on_event(event):
        ends.extend([event] * (event.kind == "ends"))
        if ends:
            halt.set()

    muster.carry_out(there, plan, fleet, halt=halt, on_event=on_event, journal=first)
    first.close()
    fleet.close()
    sky.ends.pop("r_1").close()
    silent = sky.drones.pop("r_1")
    endpoints = {**sky.endpoints, "r_1": "udpout:127.0.0.1:9"}
    again = MavlinkFleet(there, endpoints, FlightSettings(arm=True), clock=sky.clock, wait=sky.wait)
    try:
        again.connect(5.0, again=True)
        second = Journal.resumed(read_journal(path), there)
        report = muster.carry_out(there, plan, again, journal=second)
        second.close()
        states = {state.robot: state.state for state in again.final_states()}
    finally:
        again.close()
        sky.close()
    assert sorted(report.tasks_done) == [task.id for task in there.tasks]
    assert {row.robot for row in report.tasks if row.task not in {end.task for end in ends}} == {"r_0"}
    assert states == {"r_0": "hovers, armed", "r_1": "not heard"}
    assert silent.armed


@pytest.mark.long
@pytest.mark.parametrize("kind", [PX4, ARDUPILOT])
@pytest.mark.parametrize("at_end", ["hold", "land"])
def test_drones_are_brought_down_whatever_they_do(kind, at_end):
    """One flies a mission that was uploaded, one is armed on the ground, one is not heard."""
    there = mission(3)
    sky = Sky(there, kind)
    fleet = sky.fleet(there)
    fleet.ports["r_0"].send([Waypoint((30.0, 0.0, 8.0)), Waypoint((200.0, 0.0, 8.0))])
    fleet.advance(fleet.time_s + 12.0)
    fleet.close()  # and the process is no more
    sky.drones["r_1"].armed, sky.drones["r_1"].mode = True, kind.ready
    sky.ends.pop("r_2").close()
    del sky.drones["r_2"]
    endpoints = {**sky.endpoints, "r_2": "udpout:127.0.0.1:9"}
    again = MavlinkFleet(there, endpoints, FlightSettings(arm=True), clock=sky.clock, wait=sky.wait)
    try:
        again.connect(5.0, again=True)
        again.recover(at_end, lambda: False)
        states = {state.robot: state for state in again.final_states()}
    finally:
        again.close()
        sky.close()
    assert not any(drone.armed for drone in sky.drones.values())
    assert not any(state.moving for state in states.values())
    assert ("returned" in states["r_0"].state) == (at_end == "hold")
    assert states["r_2"].state == "not heard"
