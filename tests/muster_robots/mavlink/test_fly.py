"""`muster fly` against simulated autopilots that run in threads, faster than time; and its refusals, each one line."""

import json
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from dataclasses import replace

import pytest

import muster
from muster.cli.exit_codes import Ending
from muster.cli.exits import BAD_INPUT, DONE, INCOMPLETE, STILL_MOVING, TASKS_LOST
from muster.cli.main import run
from muster.mission.errors import ParameterError
from muster.mission.model import Origin
from muster.planning.request import Request
from muster_robots.mavlink.autopilots import PX4
from muster_robots.mavlink.simulated.drone import SimulatedAutopilot
from muster_robots.mavlink.simulated.earth import origin_at
from muster_robots.mavlink.simulated.faults import Faults
from muster_robots.mavlink.simulated_autopilot import faults_of, serve

ORIGIN = Origin(lat_deg=35.53, lon_deg=24.06)
MISSION = """
schema: muster/1
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
robots: [{id: r_0, position: [0, 0, 0], kind: air, speed_mps: 20}]
tasks: [{id: near, position: [10, 0, 5]}]
"""


TWO = """
schema: muster/1
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
rules: {objective: max}
robots:
  - {id: r_0, position: [0, 0, 0], kind: air, speed_mps: 5}
  - {id: r_1, position: [0, 8, 0], kind: air, speed_mps: 5}
tasks: [{id: t_0, position: [90, 0, 10]}, {id: t_1, position: [90, 8, 10]}]
"""


@pytest.fixture
def mission(tmp_path):
    file = tmp_path / "m.yaml"
    file.write_text(MISSION)
    return file


@pytest.fixture
def port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@pytest.fixture
def sky(port):
    """Lets drones fly in threads, each `speed` times as fast as time goes, and speak to the port."""
    over, threads = threading.Event(), []

    def up(faults=None, *, kind=PX4, system=1, speed=8.0, origin=ORIGIN):
        made = SimulatedAutopilot(kind, origin, faults or Faults(), system=system)
        how = {"until": over.is_set, "speed": speed}
        threads.append(threading.Thread(target=serve, args=(made, ("127.0.0.1", port)), kwargs=how))
        threads[-1].start()
        return made

    yield up
    over.set()
    for thread in threads:
        thread.join()


@pytest.fixture
def drone(sky):
    return sky()


def fly(mission, port, *more):
    return run(["fly", str(mission), "--endpoint", f"r_0=udp:127.0.0.1:{port}", "--time-limit", "0.1", *more])


def test_without_arm_it_shows_and_sends_nothing(mission, port, drone, capsys):
    assert fly(mission, port) == 0
    said = capsys.readouterr()
    assert "near" in said.out
    assert "24.0601" in said.out  # 10 m to the east
    assert "nothing was sent" in said.err
    assert not drone.armed
    assert {message.get_type() for message in drone.heard} <= {"HEARTBEAT", "COMMAND_LONG"}


def test_with_arm_it_flies(mission, port, drone, capsys):
    assert fly(mission, port, "--arm", "--require-complete") == STILL_MOVING  # it hovers
    said = capsys.readouterr().err
    assert "mission" in said
    assert re.search(r"^r_0: hovers, armed; at \(1?\d\.\d\d, -?\d\.\d\d, \d\.\d\d\)$", said, re.MULTILINE)
    assert drone.armed
    assert drone.mode == PX4.hold
    assert drone.flight.place == pytest.approx((0.0, 10.0, -5.0), abs=0.05)


def until(condition, within_s=20.0):
    """Wait for something that a drone does."""
    end = time.monotonic() + within_s
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.fixture
def flying(mission, port):
    """`muster fly --arm` of two drones on one port, in a process of its own."""
    mission.write_text(TWO)
    both = [f"--endpoint=r_{k}=udp:127.0.0.1:{port}#{k + 1}" for k in range(2)]
    command = [sys.executable, "-m", "muster.cli", "fly", str(mission), *both, "--time-limit", "0.1", "--arm"]
    made = []

    def start(*more):
        made.append(subprocess.Popen([*command, *more], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
        return made[-1]

    yield start
    for process in made:
        process.kill()
        process.communicate()


def two(sky, faults=None, speed=3.0):
    return [sky(faults, system=k + 1, speed=speed, origin=origin_at(ORIGIN, (0.0, 8.0 * k, 0.0))) for k in range(2)]


@pytest.mark.long
@pytest.mark.parametrize("more", [(), pytest.param(("--offboard",), marks=pytest.mark.long)])
def test_ctrl_c_in_flight_lets_drones_hover(sky, flying, more):
    drones = two(sky, speed=1.0 if more else 3.0)
    process = flying(*more)
    until(lambda: all(drone.flight.place[2] < -2.0 for drone in drones))
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    places = [drone.flight.place for drone in drones]
    assert process.returncode == STILL_MOVING  # which counts more than that it was interrupted
    assert Ending.STILL_MOVING.words in err
    assert Ending.INTERRUPTED.words in err
    assert "still flying, driving or armed: r_0, r_1; land or stop them" in err
    assert re.search(r"interrupted at \d+\.\d s of the mission; drones were told to hover", err)
    assert "Traceback" not in err
    assert [line.split(";")[0] for line in err.splitlines()[-2:]] == [f"r_{k}: hovers, armed" for k in range(2)]
    assert "0 of 2" in out
    time.sleep(0.5)
    assert [drone.flight.place for drone in drones] == places
    assert all(drone.armed and drone.mode == PX4.hold for drone in drones)


@pytest.mark.long
def test_ctrl_c_while_drones_arm_leaves_none_armed(sky, flying):
    drones = two(sky, Faults(slow_arm_s=4.0))
    process = flying()
    until(lambda: all(asked_to_arm(drone) for drone in drones))
    assert not any(drone.armed for drone in drones)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=30) == 130
    time.sleep(1.5)  # so long arming takes
    assert not any(drone.armed or drone.flight.flies for drone in drones)


def hovering(drone):
    """A drone that is in the air, where somebody else has left it."""
    drone.armed, drone.mode, drone.flight.place = True, PX4.hold, (0.0, 0.0, -5.0)
    return drone


def test_a_refusal_before_take_off_tells_of_a_drone_that_is_in_the_air(mission, port, sky, capsys):
    hovering(sky(origin=origin_at(ORIGIN, (500.0, 0.0, 0.0))))
    assert fly(mission, port, "--arm") == STILL_MOVING
    said = capsys.readouterr().err.splitlines()
    assert re.match(r"still flying, driving or armed: r_0; land or stop them by", said[0])
    assert re.match(r"r_0: hovers, armed; at \(500\.\d\d, -?0\.\d\d, [45]\.\d\d\)$", said[1])
    assert re.match(r"r_0: stands 500\.\d m from its start in the mission; expected", said[2])


def test_a_refusal_before_anything_was_heard_listens_for_drones_that_are_armed(mission, port, sky, capsys):
    hovering(sky())
    timed = MISSION.replace("position: [10, 0, 5]", "position: [10, 0, 5], window_s: [0, 600]")
    mission.write_text(timed + "starts_at: 2026-11-01T09:00\n")
    assert fly(mission, port, "--arm") == STILL_MOVING
    said = capsys.readouterr().err.splitlines()
    assert "r_0: hovers, armed" in said[1]
    assert "expected a start that is not over" in said[2]


def test_without_arm_it_says_which_drones_are_armed(mission, port, sky, capsys):
    hovering(sky())
    assert fly(mission, port) == STILL_MOVING
    said = capsys.readouterr()
    assert "near" in said.out
    assert "r_0: hovers, armed" in said.err.splitlines()[-1]


def heartbeats(drone):
    """How many heartbeats of Muster a drone has heard; there is one a second."""
    return sum(message.get_type() == "HEARTBEAT" for message in drone.heard)


@pytest.mark.long
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_before_take_off_tells_of_a_drone_that_is_in_the_air(sky, flying, number):
    drone = hovering(sky(system=1))  # and one is missing: `fly` waits for it
    process = flying("--wait", "60")
    until(lambda: heartbeats(drone) > 1, within_s=60)  # it has said where it is since the first
    process.send_signal(number)
    _, err = process.communicate(timeout=30)
    assert process.returncode == STILL_MOVING
    assert [line.split(";")[0] for line in err.split("\n") if line][-2:] == ["r_0: hovers, armed", "interrupted"]
    assert "Traceback" not in err


def test_a_mission_whose_time_is_over_is_refused_or_shifted(mission, port, drone, capsys):
    timed = MISSION.replace("position: [10, 0, 5]", "position: [10, 0, 5], window_s: [0, 600]")
    mission.write_text(timed + "starts_at: 2026-11-01T09:00\n")
    assert fly(mission, port, "--arm") == BAD_INPUT
    (line,) = capsys.readouterr().err.splitlines()
    assert Ending.REFUSED.words in line
    assert re.search(
        r"starts_at 2026-11-01T09:00 was \d+\.\d days ago, and the time for task near is over; expected", line
    )
    assert not drone.flight.flies
    assert not drone.armed
    assert fly(mission, port, "--arm", "--starts", "now", "--at-end", "land", "--format", "json") == DONE
    assert json.loads(capsys.readouterr().out)["tasks_done"] == ["near"]


@pytest.mark.long
@pytest.mark.parametrize("given", [False, True])
def test_a_plan_that_was_cut_short_is_not_flown_unless_told(mission, port, drone, capsys, monkeypatch, tmp_path, given):
    from muster.planning import solving

    whole, file = solving.answer, tmp_path / "plan.json"

    def cut(request, *more, **how):
        solution = whole(request, *more, **how)
        return replace(solution, plan=replace(solution.plan, cut_short=True))

    monkeypatch.setattr(solving, "answer", cut)
    cut(Request(mission=muster.load(mission), time_limit=0.1)).plan.save(file)
    plan = ["--plan", str(file)] if given else []
    assert fly(mission, port, "--arm", *plan) == INCOMPLETE
    said = (
        "planning was cut short: 1 of 1 tasks are planned; nothing was started; expected more time (--time-limit), or"
    )
    assert said in (err := capsys.readouterr().err)
    assert Ending.CUT_SHORT.words in err
    assert not drone.armed
    assert fly(mission, port, "--arm", "--accept-partial", "--at-end", "land", *plan) == DONE


def asked_to_arm(drone):
    return any(m.get_type() == "COMMAND_LONG" and m.command == 400 and m.param1 == 1 for m in list(drone.heard))


@pytest.mark.parametrize(
    ("end", "mode", "more"),
    [
        ("return", PX4.back, ()),
        ("land", PX4.land, ()),
        pytest.param("hold", PX4.hold, ("--offboard",), marks=pytest.mark.long),
    ],
)
def test_what_drones_do_at_the_end(mission, port, sky, end, mode, more, capsys):
    drone = sky(speed=1.0 if more else 8.0)
    how = ("--arm", "--quiet", "--format", "json", "--at-end", end, *more)
    assert fly(mission, port, *how) == (STILL_MOVING if end == "hold" else DONE)
    assert drone.mode == mode  # the command has waited for that
    state = {"hold": "hovers, armed", "return": "returned, landed, not armed", "land": "landed, not armed"}[end]
    said = capsys.readouterr()
    assert said.err.startswith(f"r_0: {state}; at (")
    report = json.loads(said.out)
    assert (report["tasks_done"], report["tasks_lost"]) == (["near"], [])
    _, east, down = drone.flight.place
    assert east == pytest.approx(0.0 if end == "return" else 10.0, abs=1.0)
    assert down == pytest.approx(-5.0 if end == "hold" else 0.0, abs=1.0)
    assert drone.armed == (end == "hold")


def test_a_height_for_a_mission_in_the_plane(mission, port, drone, capsys):
    mission.write_text(MISSION.replace("[0, 0, 0]", "[0, 0]").replace("[10, 0, 5]", "[10, 0]"))
    assert fly(mission, port, "--arm") == 2
    assert capsys.readouterr().err.strip() == "no height; expected a height for a mission in the plane (--height)"
    assert fly(mission, port, "--arm", "--height", "7") == STILL_MOVING
    assert drone.flight.place == pytest.approx((0.0, 10.0, -7.0), abs=0.05)
    mission.write_text(MISSION)
    assert fly(mission, port, "--arm", "--height", "7") == 2


def test_what_would_be_sent_as_json(mission, port, drone, capsys):
    assert fly(mission, port, "--format", "json") == 0
    (line,) = json.loads(capsys.readouterr().out)["would_send"]
    assert (line["robot"], line["task"], line["hold_s"]) == ("r_0", "near", 0.0)
    assert (line["lat_deg"], line["lon_deg"]) == pytest.approx((35.53, 24.0601103), abs=1e-6)
    assert line["above_home_m"] == pytest.approx(5.0, abs=1e-3)


def test_a_drone_that_fails_is_named_with_its_reason_and_its_task_is_lost(mission, port, sky, capsys):
    sky(Faults(refuse_arm=True))
    assert fly(mission, port, "--arm", "--require-complete") == TASKS_LOST
    said = capsys.readouterr()
    reason = "arm refused: MAV_CMD_COMPONENT_ARM_DISARM: MAV_RESULT_DENIED (PreArm: compass not healthy)"
    assert re.search(rf"\d s  r_0 is out: {re.escape(reason)}", said.err)
    assert f"r_0: {reason}" in said.err
    assert f"1 task {Ending.TASKS_LOST.words}: near" in said.err
    assert "near" in said.out


@pytest.mark.long
def test_a_drone_whose_motors_stop_has_crashed_and_loses_its_task(mission, port, sky, capsys):
    mission.write_text(MISSION.replace("[10, 0, 5]", "[400, 0, 30]"))
    drone = sky(Faults(disarm_at_s=6.0))
    assert fly(mission, port, "--arm", "--at-end", "return") == TASKS_LOST
    said = capsys.readouterr().err
    assert re.search(r"^r_0: crashed: its motors stopped \d+\.\d m above its start; not armed; at", said, re.MULTILINE)
    assert "Disarmed by external command" in said
    assert not drone.armed


def test_nobody_there(mission, port, capsys):
    assert fly(mission, port, "--wait", "0.2") == 2
    assert capsys.readouterr().err.strip() == "r_0: no heartbeat within 0.2 s; expected a drone at its endpoint"


def test_no_origin(mission, port, capsys):
    mission.write_text(MISSION.replace("origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}", ""))
    assert fly(mission, port) == 2
    assert "no origin_wgs84; expected one" in capsys.readouterr().err


def test_an_endpoint_without_a_robot(mission, capsys):
    assert run(["fly", str(mission), "--endpoint", "udp:127.0.0.1:14550"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_faults_by_name():
    assert faults_of("refuse_arm,loss=0.5,reject_item=2") == Faults(refuse_arm=True, loss=0.5, reject_item=2)
    for wrong in ("nonsense", "loss", "loss=x", "refuse_arm=1"):
        with pytest.raises(ParameterError, match="--faults"):
            faults_of(wrong)


CROSSING = """
schema: muster/1
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
robots:
  - {id: r_0, position: [0, 0, 0], kind: air, speed_mps: 5, radius_m: 0.5, skills: [a]}
  - {id: r_1, position: [50, 50, 0], kind: air, speed_mps: 5, radius_m: 0.5, skills: [b]}
tasks:
  - {id: t_0, position: [50, 50, 0], requires: [a]}
  - {id: t_1, position: [0, 0, 0], requires: [b]}
"""


@pytest.mark.parametrize("apart", [False, True])
def test_drones_that_would_meet_are_told_of(tmp_path, port, capsys, apart):
    text = CROSSING.replace("position: [50, 50, 0], kind", "position: [50, 50, 20], kind") if apart else CROSSING
    text = text.replace("position: [0, 0, 0], requires", "position: [0, 0, 20], requires") if apart else text
    (tmp_path / "m.yaml").write_text(text)
    ends = [arg for k in range(2) for arg in ("--endpoint", f"r_{k}=udp:127.0.0.1:{port}#{k + 1}")]
    assert run(["fly", str(tmp_path / "m.yaml"), *ends, "--wait", "0.1", "--time-limit", "0.1"]) == 2
    *told, error = capsys.readouterr().err.splitlines()
    assert "no heartbeat" in error
    meeting = r"warning: r_0 and r_1: 0\.00 m apart at 7\.1 s of the schedule; expected at least 1\.00 m"
    assert [bool(re.fullmatch(meeting, line)) for line in told] == ([] if apart else [True])


ZONE = """
schema: muster/1
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
robots: [{id: r_0, position: [0, 0, 0], kind: air, speed_mps: 20, radius_m: 0.5}]
tasks: [{id: behind, position: [40, 0, 10]}]
map:
  boundary: [[-50, -50], [100, -50], [100, 50], [-50, 50]]
  zones: [{polygon: [[15, -30], [25, -30], [25, 10], [15, 10]], forbidden_to: [air]}]
"""


def test_ways_around_zones_are_shown_before_anything_flies(tmp_path, sky, port, capsys):
    (tmp_path / "m.yaml").write_text(ZONE)
    sky()
    how = ("--endpoint", f"r_0=udp:127.0.0.1:{port}", "--time-limit", "0.1", "--format", "json")
    assert run(["fly", str(tmp_path / "m.yaml"), *how]) == 0
    rows = json.loads(capsys.readouterr().out)["would_send"]
    assert len(rows) >= 3
    norths = [(row["lat_deg"] - 35.53) * 111_000 for row in rows]
    assert max(norths[:-1]) > 10.4  # around the zone's corner, with room for the body
    assert norths[-1] == pytest.approx(0, abs=0.1)
