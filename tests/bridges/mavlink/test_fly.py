"""`muster fly` against simulated autopilots that run in threads, faster than time; and its refusals, each one line."""

import socket
import threading

import pytest

from muster.bridges.mavlink.autopilots import PX4
from muster.bridges.mavlink.simulated import faults_of, serve
from muster.bridges.mavlink.simulated_drone import Faults, SimulatedAutopilot
from muster.cli.main import run
from muster.mission.errors import ParameterError
from muster.mission.model import Origin

MISSION = """
schema: muster/1
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
robots: [{id: r_0, position: [0, 0, 0], kind: air, speed_mps: 20}]
tasks: [{id: near, position: [10, 0, 5]}]
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
def drone(port):
    made, over = SimulatedAutopilot(PX4, Origin(lat_deg=35.53, lon_deg=24.06)), threading.Event()
    thread = threading.Thread(target=serve, args=(made, ("127.0.0.1", port)), kwargs={"until": over.is_set, "speed": 4})
    thread.start()
    yield made
    over.set()
    thread.join()


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
    assert fly(mission, port, "--arm", "--require-complete") == 0
    assert "mission" in capsys.readouterr().err
    assert drone.armed
    assert drone.flight.place == pytest.approx((0.0, 10.0, -5.0), abs=0.05)


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
