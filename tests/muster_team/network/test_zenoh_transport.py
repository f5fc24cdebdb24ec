"""Zenoh on loopback; no router is needed, nor any network but this machine's own. For a large team see test_team."""

import socket
import subprocess
import sys
from uuid import uuid4

import pytest

zenoh = pytest.importorskip("zenoh", reason="the extra `net` is not installed")

from tests.muster_team.teams import QUICK, Lossy, Team, agree  # noqa: E402

from muster.mission.errors import NetworkError, ParameterError  # noqa: E402
from muster_team.network.zenoh_transport import ZenohTransport  # noqa: E402

ANY = "tcp/127.0.0.1:0"


def endpoint():
    """An endpoint that is free."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


def transports(mission, robots, mode="peer"):
    """One for each robot; all but the first know the first alone. No other test has a mission of this name."""
    mission, hub = f"{mission} {uuid4()}", endpoint()
    made = {}
    for robot in robots:
        if not made:
            made[robot] = ZenohTransport(mission, robot, listen=(hub,))
        elif mode == "peer":
            made[robot] = ZenohTransport(mission, robot, listen=(ANY,), connect=(hub,))
        else:
            made[robot] = ZenohTransport(mission, robot, connect=(hub,))
    return made


def first_that_comes(sender, receiver, data, to=None):
    """Sessions need a moment to find each other: send until something comes."""
    for _ in range(200):
        sender.send(data, to)
        if came := receiver.receive(0.1):
            return came[0]
    return None


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("mode", ["peer", "client"])
def test_to_all_and_to_one_with_ids_of_any_letters(mode):
    names = ("r/1 *", "r$2?#", "@ü%/**")
    made = transports("a mission/with *", names, mode)
    a, b, c = (made[name] for name in names)
    assert first_that_comes(b, c, b"all") == b"all"
    assert first_that_comes(b, a, b"all") == b"all"
    while a.receive(0.3) or c.receive(0.3):
        pass
    b.send(b"for a", names[0])
    b.send(b"for c", names[2])
    assert (a.receive(10), c.receive(10)) == ([b"for a"], [b"for c"])
    assert b.receive(0) == []
    for transport in made.values():
        transport.close()
        transport.close()


def test_keys_follow_the_namespaces_of_robots():
    hub = endpoint()
    with zenoh.open(
        zenoh.Config.from_json5(f'{{listen: {{endpoints: ["{hub}"]}}, scouting: {{multicast: {{enabled: false}}}}}}')
    ) as tool:
        keys = tool.declare_subscriber("muster/lab/r_1/**")
        transport = ZenohTransport("lab", "r_1", connect=(hub,))
        heard = set()
        for _ in range(200):
            transport.send(b"x")
            transport.send(b"y", "r_2")
            transport.receive(0.05)
            while (sample := keys.try_recv()) is not None:
                heard.add(str(sample.key_expr))
            if len(heard) == 2:
                break
        transport.close()
    assert heard == {"muster/lab/r_1/auction", "muster/lab/r_1/auction/r_2"}


@pytest.mark.parametrize("left", ["open", "raising", "closed"])
def test_the_process_ends_whether_or_not_it_closes(left):
    end = {"open": "", "raising": "raise SystemExit(3)", "closed": "t.close()"}[left]
    load = "from muster_team.network.zenoh_transport import ZenohTransport"
    program = f"{load}; t = ZenohTransport('m', 'r', listen=('{ANY}',)); {end}"
    ended = subprocess.run([sys.executable, "-c", program], timeout=60, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout + ended.stderr) == (3 if left == "raising" else 0, "")


def test_a_port_in_use_is_told():
    used = endpoint()
    first = ZenohTransport("m", "r", listen=(used,))
    with pytest.raises(NetworkError, match=rf"Zenoh: {used}: .*Address already in use"):
        ZenohTransport("m", "x", listen=(used,))
    first.close()


@pytest.mark.parametrize(
    ("wrong", "expected"),
    [
        ({"connect": ("10.0.0.1",)}, "10.0.0.1: no endpoint; expected such as tcp/10.0.0.1:7447"),
        ({"listen": ("foo/10.0.0.1:1",)}, "foo/10.0.0.1:1: .*not supported"),
        ({"listen": ("tcp/no.such.host.invalid:1",)}, "no.such.host.invalid:1: .*not known"),
        ({"connect": ("tcp/127.0.0.1:1",)}, "Zenoh: tcp/127.0.0.1:1: Unable to connect"),
    ],
)
def test_an_endpoint_that_is_none_is_told_in_one_line(wrong, expected):
    with pytest.raises(NetworkError, match=expected) as error:
        ZenohTransport("m", "r", **wrong)
    assert "\n" not in str(error.value)
    assert ".rs" not in str(error.value)


def test_an_unknown_mode_is_told():
    with pytest.raises(ParameterError, match="mode: router; expected client or peer"):
        ZenohTransport("m", "r", mode="router")


@pytest.mark.parametrize("mode", ["peer", "client"])
def test_a_team_agrees(mode):
    team = Team("auction-2", bid="total")
    made = transports("auction-2", team.robots, mode)
    assert agree([team.node(robot, transport) for robot, transport in made.items()]) == team.central_routes()


@pytest.mark.long
def test_a_team_agrees_where_a_third_is_lost_and_some_comes_twice():
    team = Team("auction-2", QUICK, bid="total")
    made = transports("auction-2", team.robots)
    assert agree([team.node(r, Lossy(t, r, 0.3, 0.1)) for r, t in made.items()]) == team.central_routes()
