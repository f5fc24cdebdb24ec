"""Hosts and origins: which are ours, and what other sites' pages can do."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster_control.security.origins import Hosts, is_loopback
from muster_control.settings import Settings

_LOCAL = Hosts.of(Settings())
_BEYOND = Hosts.of(Settings(host="0.0.0.0", public_origins=("https://Control.Example.org:443",)))


@pytest.mark.parametrize(
    "host", ["localhost", "LOCALHOST:1", "127.0.0.1:8117", "[::1]:8117", "127.1.2.3", "[::ffff:127.0.0.1]"]
)
def test_names_of_this_machine(host):
    assert _LOCAL.why_not_host(host) is None


@pytest.mark.parametrize(
    "host",
    [
        "", "evil.example", "localhost.evil.example", "evil.example:8117", "10.0.0.1", "[::2]", "localhost:",
        "localhost:x", "localhost:8117:8117", "user@localhost", "localhost/", " localhost", "127.0.0.1.nip.io",
        "0.0.0.0", "2130706433", "localhost\n", "[::1", "::1", "testserver",
    ],
)  # fmt: skip
def test_other_names(host):
    assert "is not this server" in _LOCAL.why_not_host(host)


def test_names_of_a_server_for_others():
    for host in ("10.0.0.1:8117", "[fe80::1]", "control.example.org", "localhost"):
        assert _BEYOND.why_not_host(host) is None
    for host in ("evil.example", "control.example.org.evil.example"):
        assert _BEYOND.why_not_host(host) is not None


@pytest.mark.parametrize("host", ["127.0.0.1", "127.9.9.9", "::1", "localhost"])
def test_loopback(host):
    assert is_loopback(host)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "10.0.0.1", "robot", "", "localhost.evil.example"])
def test_beyond_loopback(host):
    assert not is_loopback(host)


def _why_not(hosts=_LOCAL, *, host="localhost:8117", scheme="http", changes=True, by_cookie=False, **headers):
    given = {name.replace("_", "-"): value for name, value in headers.items()}
    return hosts.why_not_origin({"host": host, **given}, scheme, changes=changes, by_cookie=by_cookie)


def test_our_own_pages():
    assert _why_not(origin="http://localhost:8117") is None
    assert _why_not(origin="https://localhost:8117", scheme="https") is None
    assert _why_not(_BEYOND, host="10.0.0.1", origin="https://control.example.org") is None
    assert _why_not(sec_fetch_site="same-origin", by_cookie=True) is None
    assert _why_not(sec_fetch_site="none", by_cookie=True) is None  # typed by hand


@given(st.sampled_from([True, False]), st.sampled_from([True, False]))
def test_pages_of_others(changes, by_cookie):
    for origin in (
        "https://evil.example",
        "null",
        "http://localhost",
        "http://localhost:3000",
        "https://localhost:8117",
        "",
    ):
        assert _why_not(origin=origin, changes=changes, by_cookie=by_cookie) is not None


def test_requests_of_other_sites_without_an_origin():
    for site in ("cross-site", "same-site"):
        assert _why_not(sec_fetch_site=site) is not None
        assert _why_not(sec_fetch_site=site, changes=False, sec_fetch_mode="no-cors") is not None
        frame = {"sec_fetch_mode": "navigate", "sec_fetch_dest": "iframe"}
        assert _why_not(sec_fetch_site=site, changes=False, **frame) is not None
        link = {"sec_fetch_mode": "navigate", "sec_fetch_dest": "document"}
        assert _why_not(sec_fetch_site=site, changes=False, **link) is None  # somebody followed a link
        assert _why_not(sec_fetch_site=site, changes=True, **link) is not None


def test_programs_send_no_origin():
    assert _why_not() is None
    assert _why_not(by_cookie=True, changes=False) is None
    assert "expected Origin" in _why_not(by_cookie=True)


def test_through_a_proxy_with_tls_only_pages_of_the_public_origin():
    for origin, ours in (("https://control.example.org", True), ("http://control.example.org", False)):
        said = _BEYOND.why_not_origin(
            {"host": "control.example.org", "origin": origin}, "http", changes=True, by_cookie=True
        )
        assert (said is None) == ours
