"""Sessions: nobody makes, changes or keeps one that is not theirs."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster_control.security.sessions import LASTS_S, Sessions, kept_secret
from muster_control.security.tokens import Holder

_ANNA = Holder("anna", "command", "0123456789abcdef" * 4)
_SECRET = b"s" * 32


def test_a_session_says_who_logged_in_but_no_token():
    sessions = Sessions(_SECRET, lambda: 100.0)
    cookie, lasts_s = sessions.begin(_ANNA)
    session = sessions.read(cookie)
    assert (session.name, session.token, session.until) == ("anna", _ANNA.digest[:16], 100.0 + LASTS_S["command"])
    assert lasts_s == LASTS_S["command"]
    assert sessions.begin(_ANNA)[0] != cookie


def test_its_time_is_over():
    now = [0.0]
    sessions = Sessions(_SECRET, lambda: now[0])
    cookie, lasts_s = sessions.begin(_ANNA)
    now[0] = lasts_s - 1
    assert sessions.read(cookie) is not None
    now[0] = lasts_s
    assert sessions.read(cookie) is None


def test_it_was_ended():
    sessions = Sessions(_SECRET)
    (first, _), (second, _) = sessions.begin(_ANNA), sessions.begin(_ANNA)
    sessions.end(sessions.read(first))
    assert sessions.read(first) is None
    assert sessions.read(second) is not None


def test_another_secret():
    assert Sessions(b"t" * 32).read(Sessions(_SECRET).begin(_ANNA)[0]) is None


@given(st.text())
def test_nothing_else_is_one(text):
    assert Sessions(_SECRET).read(text) is None


@given(st.data())
def test_none_can_be_changed(data):
    sessions = Sessions(_SECRET, lambda: 0.0)
    cookie, _ = sessions.begin(_ANNA)
    place = data.draw(st.integers(0, len(cookie) - 2))  # the very last character has bits that mean nothing
    other = data.draw(st.characters(codec="ascii").filter(lambda c: c != cookie[place]))
    changed = cookie[:place] + other + cookie[place + 1 :]
    read = sessions.read(changed)
    assert read is None or read == sessions.read(cookie)


def test_the_secret_is_kept_for_its_owner_alone(tmp_path):
    file = tmp_path / "new" / "session.key"
    secret = kept_secret(file)
    assert len(secret) == 32
    assert file.stat().st_mode & 0o777 == 0o600
    assert kept_secret(file) == secret
    file.write_bytes(b"cut")
    assert len(kept_secret(file)) == 32


def test_a_secret_that_cannot_be_kept(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        kept_secret(tmp_path / "file" / "session.key")
