"""Drones of a simulated autopilot, in real time: paused, and found again after their server was killed."""

import socket
import subprocess
import sys
import time
from collections import Counter

import pytest
from tests.muster_control.runs.process import gone, serving, until
from tests.muster_control.runs.store import planned

from muster.mission.model import Mission, Robot, Rules, Task
from muster_control.store.store import Store

pytest.importorskip("pymavlink", reason="the extra `mavlink` is not installed")
from tests.muster_robots.mavlink.drones import ORIGIN

from muster_robots.mavlink.dialect import mavlink
from muster_robots.mavlink.simulated.earth import origin_at

ONCE = {"across_partition": "at-most-once"}


def mission():
    robots = tuple(
        Robot(id=f"r_{k}", position=(0.0, 6.0 * k, 0.0), kind="air", radius_m=0.3, speed_mps=5.0) for k in range(2)
    )
    near = tuple(Task(id=f"t_{k}", position=(4.0, 6.0 * k, 6.0)) for k in range(2))
    far = tuple(Task(id=f"u_{k}", position=(10.0, 6.0 * k, 6.0), duration_s=3.0) for k in range(1))
    once = Task(id="once", position=(10.0, 6.0, 6.0), duration_s=4.0, only_robots=("r_1",), **ONCE)
    return Mission(robots=robots, tasks=(*near, *far, once), origin_wgs84=ORIGIN, rules=Rules(objective="max"))


@pytest.fixture
def sky():
    ports, drones = [], []
    for k, robot in enumerate(mission().robots):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            ports.append(free.getsockname()[1])
        at = origin_at(ORIGIN, robot.position)
        command = [sys.executable, "-m", "muster_robots.mavlink.simulated_autopilot", "--port", str(ports[-1])]
        drones.append(
            subprocess.Popen(
                [*command, "--system", str(k + 1), "--at", f"{at.lat_deg},{at.lon_deg}"], stdout=subprocess.DEVNULL
            )
        )
    yield {f"r_{k}": f"udp:127.0.0.1:{port}" for k, port in enumerate(ports)}
    for drone in drones:
        drone.kill()
        drone.wait()


def heard(endpoint, seconds):
    """Where a drone says that it is, while nobody else listens: (lat, lon, height, speed) in 1e-7 deg, mm, cm/s."""
    said, reader = [], mavlink.MAVLink(None)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
        end.bind(("127.0.0.1", int(endpoint.rpartition(":")[2])))
        end.settimeout(10.0)
        while not said or said[-1][0] < said[0][0] + 1000 * seconds:
            told = reader.parse_buffer(end.recv(65535)) or ()
            places = (one for one in told if one.get_type() == "GLOBAL_POSITION_INT")
            said += [(one.time_boot_ms, one.lat, one.lon, one.relative_alt, one.vx) for one in places]
    return [place for _, *place in said]


@pytest.mark.long
def test_drones_stand_when_the_server_is_killed_and_what_may_be_begun_once_is(tmp_path, sky):
    """For who kills their runner alone see test_ros."""
    database = f"sqlite:///{tmp_path / 'muster.db'}"
    store = Store.open(database)
    there = mission()
    body = {"plan": planned(store, there), "world": "mavlink", "settings": {"endpoints": sky, "arm": True}}
    with serving(database, "--bridge", "mavlink") as first:
        run = first.http.post("/runs", json=body).json()["id"]

        def happened(kind):
            log = first.http.get(f"/runs/{run}/events").json()
            return {entry["data"]["task"] for entry in log if entry["kind"] == kind}

        def ask(verb):
            assert first.http.post(f"/runs/{run}/actions", json={"verb": verb}).status_code == 202
            until(lambda: store.actions.list(run=run)[0].outcome == "done")

        until(lambda: happened("ends"))
        ask("pause")
        time.sleep(1.0)
        ask("resume")
        until(lambda: "once" in happened("starts"))
        before = happened("ends")
        (runner,) = first.children("muster_control.runs.runner.main")
        first.kill()
        until(lambda: gone(runner))
    for endpoint in sky.values():
        places = heard(endpoint, 0.5)
        assert places[0][2] > 4000  # in the air
        assert all(abs(a - b) <= 50 for a, b in zip(places[0], places[-1], strict=True))  # half a metre
    with serving(database, "--bridge", "mavlink") as again:
        until(lambda: again.http.get(f"/runs/{run}").json()["state"] == "ended")
        again.end()
    found, log = store.runs.get(run), store.log.entries(run)
    store.close()
    assert (found.state, found.resumed, found.remark) == ("ended", 1, "")
    assert Counter(found.report["tasks_done"]) == dict.fromkeys(("t_0", "t_1", "u_0"), 1)
    (lost,) = found.report["tasks_lost"]
    assert lost["task"] == "once"
    assert "may be begun at most once" in lost["reason"]
    assert Counter(e.data["task"] for e in log if e.kind == "starts")["once"] == 1
    assert sum(row["usage_flown"] for row in found.report["robots"]) > 22
    (resumed,) = (entry for entry in log if entry.kind == "resumed")
    assert before
    assert not before & {entry.data["task"] for entry in log[resumed.seq :] if entry.kind in ("sets_out", "starts")}
    assert Counter(e.data["task"] for e in log if e.kind == "ends") == Counter(found.report["tasks_done"])
    assert [entry.seq for entry in log] == list(range(1, len(log) + 1))
    pause, resume = (entry for entry in log if entry.kind == "command")
    assert (pause.data["outcome"], resume.data["outcome"]) == ("done", "done")
    assert resume.time_s - pause.time_s > 0.9  # the second that it lasted: the mission's clock is the wall clock
    apart_s = (resumed.at - log[resumed.seq - 2].at).total_seconds()
    assert resumed.time_s - log[resumed.seq - 2].time_s == pytest.approx(apart_s, abs=1.0)


@pytest.mark.long
def test_drones_that_a_cancelled_run_has_left_in_the_air_are_brought_home(tmp_path, sky):
    database = f"sqlite:///{tmp_path / 'muster.db'}"
    store = Store.open(database)
    settings = {"endpoints": sky, "arm": True}
    plan = planned(store, mission())
    with serving(database, "--bridge", "mavlink") as server:

        def carried_out(**more):
            body = {"plan": plan, "world": "mavlink", "settings": {**settings, **more}}
            return server.http.post("/runs", json=body).json()["id"]

        def state(run):
            return server.http.get(f"/runs/{run}").json()["state"]

        def kinds(run):
            return {entry["kind"] for entry in server.http.get(f"/runs/{run}/events").json()}

        first = carried_out()
        until(lambda: "ends" in kinds(first))
        journals = list(tmp_path.glob("*.runs.lock-*.journal"))
        assert len(journals) == 1
        assert server.http.post(f"/runs/{first}/actions", json={"verb": "cancel"}).status_code == 202
        until(lambda: state(first) == "cancelled")
        until(lambda: not journals[0].exists())
        home = carried_out(recover=True)
        until(lambda: state(home) == "ended", 120.0)
        server.end()
    found, log = store.runs.get(home), store.log.entries(home)
    store.close()
    assert found.report["tasks_done"] == []
    assert {one["reason"] for one in found.report["tasks_lost"]} == {"not to be done: robots were brought home"}
    (states,) = (entry.data["robots"] for entry in log if entry.kind == "final_states")
    assert [(one["moving"], one["words"].split(";")[0]) for one in states] == [
        (False, f"r_{k}: returned, landed, not armed") for k in range(2)
    ]
    for endpoint in sky.values():
        assert heard(endpoint, 0.2)[-1][2] == 0
