"""Limits: rates, sockets, bodies."""

import asyncio

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster_control.security.limits import Buckets, LimitedBody, SocketLimit, network_of
from muster_control.security.refusal import RefusalError


@given(st.lists(st.floats(0, 2), max_size=60))
def test_never_more_than_the_burst_and_the_rate(pauses):
    now, taken = [0.0], 0
    buckets = Buckets(2.0, 5.0, clock=lambda: now[0])
    for pause in pauses:
        now[0] += pause
        wait_s = buckets.take("a")
        taken += wait_s == 0
        assert (wait_s == 0) or 0 < wait_s <= 0.5
    assert taken <= 5 + 2.0 * now[0]


def test_after_the_wait_there_is_one():
    now = [0.0]
    buckets = Buckets(0.5, 1.0, clock=lambda: now[0])
    assert buckets.take("a") == 0
    assert buckets.take("b") == 0
    assert buckets.take("a") == buckets.take("a") == 2.0
    now[0] += 2.0
    assert buckets.take("a") == 0


def test_a_flood_of_keys_takes_no_memory():
    buckets = Buckets(1.0, 1.0, most=10)
    for key in range(1000):
        buckets.take(str(key))
    assert len(buckets._levels) == 10


def test_a_person_has_many_addresses_of_ipv6():
    assert network_of("2001:db8::1") == network_of("2001:db8::ffff:1") != network_of("2001:db8:0:1::1")
    assert network_of("::ffff:10.0.0.1") == network_of("10.0.0.1") != network_of("10.0.0.2")
    assert network_of("no address") == "no address"


def test_places():
    sockets = SocketLimit(3, 2)
    with sockets.place("10.0.0.1"), sockets.place("10.0.0.1"):
        with pytest.raises(RefusalError) as raised, sockets.place("10.0.0.1"):
            pass
        assert (raised.value.status_code, raised.value.headers) == (429, {"retry-after": "5"})
        with sockets.place("10.0.0.2"), pytest.raises(RefusalError), sockets.place("10.0.0.3"):
            pass
        assert sockets.taken == 2
    assert sockets.taken == 0


def _body(pieces, most, clock=lambda: 0.0):
    left = list(pieces)

    async def receive():
        body = left.pop(0)
        return {"type": "http.request", "body": body, "more_body": bool(left)}

    return LimitedBody(receive, most, clock)


async def _read(body):
    read = b""
    while True:
        message = await body.receive()
        read += message["body"]
        if not message["more_body"]:
            return read


@given(st.lists(st.binary(max_size=9), min_size=1))
def test_a_body_is_read_up_to_its_limit(pieces):
    whole = b"".join(pieces)
    assert asyncio.run(_read(_body(pieces, len(whole)))) == whole
    if whole:
        body = _body(pieces, len(whole) - 1)
        with pytest.raises(RefusalError) as raised:
            asyncio.run(_read(body))
        assert raised.value.status_code == 413
        assert body.refused is raised.value


@pytest.mark.parametrize(
    ("length", "status"), [("11", 413), ("9" * 5000, 413), ("-1", 400), ("1e1", 400), ("²", 400), ("", 400)]
)
def test_what_content_length_says(length, status):
    with pytest.raises(RefusalError) as raised:
        _body([b""], 10).require_announced(length)
    assert raised.value.status_code == status


def test_a_body_that_fits_is_announced():
    for length in (None, "0", "10"):
        _body([b""], 10).require_announced(length)


def test_a_body_that_trickles():
    now = iter([0.0] + [float(second) for second in range(1000)])
    with pytest.raises(RefusalError) as raised:
        asyncio.run(_read(_body([b"x"] * 500, 10**6, lambda: next(now))))
    assert raised.value.status_code == 408
    assert next(now) < 30
