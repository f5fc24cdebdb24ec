"""A mission shown live: what a client of Foxglove's WebSocket protocol (foxglove.sdk.v1) is told."""

import json
import struct
from contextlib import contextmanager

import numpy as np
import pytest
from tests.report.voyages import carry_out

import muster
from muster.mission.errors import MissingExtraError, NetworkError
from muster.report.live import FoxgloveServer
from muster.report.record.schemas import SCHEMAS, TOPICS

pytest.importorskip("foxglove")
client = pytest.importorskip("websockets.sync.client")


class Viewer:
    """Connects, takes the channels in, and subscribes to topics."""

    def __init__(self, socket, *topics):
        self.socket, self.channels = socket, {}
        while len(self.channels) < len(TOPICS):
            told = json.loads(self.socket.recv(timeout=5))
            self.channels |= {channel["topic"]: channel for channel in told.get("channels", ())}
        self.topics = dict(enumerate(topics))
        wishes = [{"id": k, "channelId": self.channels[topic]["id"]} for k, topic in self.topics.items()]
        self.socket.send(json.dumps({"op": "subscribe", "subscriptions": wishes}))

    def hear(self, topic):
        """The next message of a topic: seconds, data."""
        while True:
            told = self.socket.recv(timeout=5)
            if isinstance(told, bytes) and told[0] == 1:
                number, time = struct.unpack_from("<IQ", told, 1)
                if self.topics[number] == topic:
                    return time * 1e-9, json.loads(told[13:])


@contextmanager
def viewing(server, *topics):
    with client.connect(server.address, subprotocols=["foxglove.sdk.v1"], max_size=None) as socket:
        yield Viewer(socket, *topics)


@pytest.fixture
def mission():
    return muster.load("11T-2R")


def until_asked(server, *topics):
    """Wait until the server knows of whoever subscribes."""
    import time

    for _ in range(500):
        if set(topics) <= server._asked:
            return
        time.sleep(0.01)
    raise AssertionError(f"nobody asked for {topics}")


def test_topics_and_schemas_are_those_of_a_record(mission):
    with FoxgloveServer(mission, 0) as server, viewing(server) as viewer:
        channels = viewer.channels
    assert server.address.startswith("ws://127.0.0.1:")
    assert {topic: channel["schemaName"] for topic, channel in channels.items()} == TOPICS
    assert {channel["encoding"] for channel in channels.values()} == {"json"}
    assert all(json.loads(channel["schema"]) == SCHEMAS[channel["schemaName"]] for channel in channels.values())


def test_who_connects_late_is_told_what_holds(mission):
    topics = ("/scene", "/muster/plan", "/muster/state")
    with FoxgloveServer(mission, 0) as server:
        carry_out(mission, muster.solve(mission, "greedy"), server, until=5.0)
        with viewing(server, *topics) as viewer:
            until_asked(server, *topics)
            server.on_step(6.0, np.array([[1.5, 2.0, 0.0], [3.0, 4.0, 0.0]]), np.zeros(2), np.zeros((2, 3)))
            _is_told_what_holds(viewer, mission)


def _is_told_what_holds(viewer, mission):
    assert viewer.hear("/muster/plan")[1]["plan"]["allocator"] == "greedy"
    names = {entity["id"] for entity in viewer.hear("/scene")[1]["entities"]}
    assert {f"task/{task.id}" for task in mission.tasks} <= names
    assert {"robot/r_0", "robot/r_1", "route/r_0", "route/r_1"} <= names
    time, state = viewer.hear("/muster/state")
    assert time == state["time_s"] == 6.0
    assert state["robots"]["r_0"]["x"] == 1.5


def test_who_watches_is_told_the_report_before_the_server_closes(mission):
    with FoxgloveServer(mission, 0) as server, viewing(server, "/muster/state", "/muster/report") as viewer:
        until_asked(server, "/muster/state", "/muster/report")
        for k in range(300):
            server.on_step(0.1 * k, np.zeros((2, 3)), np.zeros(2), np.zeros((2, 3)))
        server.on_report({"mission_time_s": 30.0, "tasks_done": [], "tasks_lost": []})
        server.close()
        assert viewer.hear("/muster/report")[1]["report"]["mission_time_s"] == 30.0


def test_a_port_that_is_taken_and_an_address_of_others(mission):
    with FoxgloveServer(mission, 0) as server:
        port = int(server.address.rpartition(":")[2])
        with pytest.raises(NetworkError, match=f"foxglove: 127.0.0.1:{port}: .*in use.*expected a free port"):
            FoxgloveServer(mission, port)
    with pytest.raises(NetworkError, match=r"foxglove: 203\.0\.113\.9:0: "):
        FoxgloveServer(mission, 0, host="203.0.113.9")


def test_without_the_extra(mission, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "foxglove", None)
    with pytest.raises(MissingExtraError, match=r"muster-robotics\[foxglove\]"):
        FoxgloveServer(mission, 0)


def test_a_simulation_tells_its_observers(mission):
    heard = []

    class Ear:
        def __getattr__(self, name):
            return lambda *what: heard.append(name)

    muster.simulate(mission, muster.solve(mission, "greedy"), observers=[Ear()])
    assert {"on_plan", "on_step", "on_event", "on_report"} <= set(heard)
