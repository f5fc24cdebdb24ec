"""A request that starts work and whose answer does not arrive is sent again, with the same key."""

import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from muster.mission.errors import NetworkError
from muster_control.client.connection import Connection


@pytest.fixture
def flaky(monkeypatch):
    """The URL of a server that breaks its first connections off, how many of them, and the keys that it was sent."""
    monkeypatch.setattr("muster_control.client.connection._PAUSE_S", 0.01)
    keys, breaks = [], [2]

    class Flaky(BaseHTTPRequestHandler):
        def do_POST(self):
            self.rfile.read(int(self.headers["content-length"]))
            keys.append(self.headers["idempotency-key"])
            if len(keys) <= breaks[0]:
                self.connection.close()
                return
            self.send_response(201)
            self.send_header("content-length", "2")
            self.end_headers()
            self.wfile.write(b"{}")

        def log_message(self, *_):
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Flaky) as server:
        threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}", breaks, keys
        server.shutdown()


def test_it_is_sent_again_with_the_same_key(flaky):
    url, _, keys = flaky
    connection = Connection(url, None, 10.0)
    assert connection.post_once("/runs", {"plan": 1}) == {}
    assert len(keys) == 3
    assert len(set(keys)) == 1
    connection.post_once("/runs", {"plan": 1})
    assert len(set(keys)) == 2  # another request has another key
    connection.close()


def test_not_for_ever(flaky):
    url, breaks, keys = flaky
    breaks[0] = 99
    connection = Connection(url, None, 10.0)
    with pytest.raises(NetworkError, match="cannot be reached"):
        connection.post_once("/runs", {"plan": 1})
    assert len(keys) == 3
    connection.close()


def test_others_are_sent_once(flaky):
    url, _, keys = flaky
    connection = Connection(url, None, 10.0)
    with pytest.raises(NetworkError):
        connection.post("/missions", {"text": ""})
    assert keys == [None]
    connection.close()
