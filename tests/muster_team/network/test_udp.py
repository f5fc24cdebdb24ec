"""Datagrams on loopback. For a large team see test_team."""

import socket

import pytest

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from tests.muster_team.teams import QUICK, Lossy, Team, agree

from muster.mission.errors import NetworkError, ParameterError
from muster_team.network.udp import UdpTransport

HERE = "127.0.0.1"


def transports(robots, host=HERE):
    """One for each robot, on ports that are free."""
    made = {robot: UdpTransport((host, 0), {}) for robot in robots}
    ports = {robot: transport.address for robot, transport in made.items()}
    for transport in made.values():
        transport.close()
    return {r: UdpTransport(ports[r], {other: ports[other] for other in robots if other != r}) for r in robots}


@pytest.fixture
def three():
    made = transports("abc")
    yield made
    for transport in made.values():
        transport.close()


def test_to_all_and_to_one(three):
    three["a"].send(b"all")
    three["a"].send(b"one", "b")
    assert three["b"].receive(10) + three["b"].receive(0) == [b"all", b"one"]
    assert three["c"].receive(10) == [b"all"]
    assert three["a"].receive(0) == []
    assert (three["a"].datagrams, three["a"].bytes_sent) == (3, 9)


def test_to_one_that_is_not_known_is_to_all(three):
    three["a"].send(b"x", "newcomer")
    assert [three[robot].receive(10) for robot in "bc"] == [[b"x"], [b"x"]]


def test_a_burst_comes_at_once(three):
    for k in range(200):
        three["a"].send(bytes((k,)), "b")
    came = []
    while len(came) < 200 and (more := three["b"].receive(10)):
        came += more
    assert came == [bytes((k,)) for k in range(200)]


def test_more_than_one_link_takes_arrives_too(three):
    three["a"].send(bytes(50_000), "b")
    assert three["b"].receive(10) == [bytes(50_000)]
    with pytest.raises(NetworkError, match="70000 bytes; expected at most 65507"):
        three["a"].send(bytes(70_000), "b")


def test_what_is_lost_here_is_counted():
    made = transports("ab")
    made["b"]._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    for _ in range(100):
        made["a"].send(bytes(1000), "b")
    came = made["b"].receive(10)
    assert 0 < len(came) < 100
    assert made["b"].lost_here == 100 - len(came)
    for transport in made.values():
        transport.close()
    assert made["b"].lost_here >= 100 - len(came)
    made["a"].send(b"x")
    assert made["a"].lost_here == 1


def test_a_peer_that_is_not_there_is_no_error():
    gone = UdpTransport((HERE, 0), {})
    address = gone.address
    gone.close()
    transport = UdpTransport((HERE, 0), {"gone": address})
    for _ in range(3):
        transport.send(b"x")
        assert transport.receive(0.01) == []
    transport.close()
    transport.close()


def test_over_ipv6():
    try:
        made = transports("ab", "::1")
    except NetworkError:
        pytest.skip("this machine has no IPv6")
    made["a"].send(b"x")
    assert made["b"].receive(10) == [b"x"]
    for transport in made.values():
        transport.close()


def test_a_port_in_use_is_told(three):
    host, port = three["a"].address
    with pytest.raises(NetworkError, match=f"{host}:{port}: Address already in use; expected a free port"):
        UdpTransport((host, port), {})


@pytest.mark.parametrize(
    ("bind", "peer", "expected"),
    [
        (("203.0.113.9", 0), (HERE, 1), "203.0.113.9:0: Cannot assign requested address; expected a free port"),
        ((HERE, 0), ("no.such.host.invalid", 7783), "no.such.host.invalid:7783: unknown host; expected a name or"),
        ((HERE, 0), ("::1", 7783), "::1:7783: unknown host; expected a name or address of IPv4"),
        ((HERE, 0), (HERE, 70_000), "70000: no such port; expected 0 to 65535"),
        ((HERE, 0), ("a..b", 1), "a..b:1: unknown host"),
    ],
)
def test_an_address_that_is_none_is_told_in_one_line(bind, peer, expected):
    with pytest.raises(NetworkError, match=expected) as error:
        UdpTransport(bind, {"r_1": peer})
    assert "\n" not in str(error.value)


def test_a_group_that_is_none_is_told():
    with pytest.raises(ParameterError, match=r"group: 10.0.0.1; expected 224.0.0.0 to 239.255.255.255"):
        UdpTransport.multicast(("10.0.0.1", 7783))
    with pytest.raises(ParameterError, match="hops: 0; expected 1 to 255"):
        UdpTransport.multicast(hops=0)
    with pytest.raises(NetworkError, match=r"on 203.0.113.9: .*; expected a network that carries multicast"):
        UdpTransport.multicast(interface="203.0.113.9")


def group():
    """A port that is free, of a group that nobody uses."""
    spare = UdpTransport((HERE, 0), {})
    port = spare.address[1]
    spare.close()
    return ("239.255.77.84", port)


def multicast(robots):
    where = group()
    try:
        return {robot: UdpTransport.multicast(where, robot=robot, interface=HERE) for robot in robots}
    except NetworkError as error:
        pytest.skip(f"no multicast here: {error}")


def test_in_a_group_each_takes_what_is_for_all_and_for_itself():
    made = multicast("abc")
    for transport in made.values():
        transport.send(b"all")
    made["a"].send(b"one", "b")
    made["a"].send(b"", "c")
    came = {robot: [] for robot in made}
    for robot, expected in (("a", 3), ("b", 4), ("c", 4)):
        while len(came[robot]) < expected and (more := made[robot].receive(10)):
            came[robot] += more
    assert came == {"a": [b"all"] * 3, "b": [b"all"] * 3 + [b"one"], "c": [b"all"] * 3 + [b""]}
    for transport in made.values():
        transport.close()


def test_two_robots_agree():
    team = Team("auction-1", bid="total")
    nodes = [team.node(r, transport) for r, transport in transports(team.robots).items()]
    assert agree(nodes) == team.central_routes()
    assert all(not node.status().refused for node in nodes)


def test_a_group_agrees():
    team = Team("auction-2", bid="total")
    nodes = [team.node(robot, transport) for robot, transport in multicast(team.robots).items()]
    assert agree(nodes) == team.central_routes()


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(3))
def test_they_agree_where_a_third_is_lost_and_some_comes_twice(seed):
    team = Team("auction-2", QUICK, bid="total")
    nodes = [team.node(r, Lossy(t, f"{seed} {r}", 0.3, 0.1)) for r, t in transports(team.robots).items()]
    assert agree(nodes) == team.central_routes()
    assert sum(node.status().refused["replayed"] for node in nodes) > 0
