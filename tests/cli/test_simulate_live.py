"""`muster simulate --foxglove`."""

import socket

import pytest

pytest.importorskip("foxglove")


def test_it_says_where_it_is_shown(folder, muster):
    code, out, err = muster("simulate", "yard.yaml", "--iterations", "10", "--foxglove", "0", "--speed", "1000")
    assert code == 0
    assert err.startswith("foxglove: ws://127.0.0.1:")
    assert "carried out" in out


def test_a_port_that_is_taken_is_one_line(folder, muster):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        code, out, err = muster("simulate", "yard.yaml", "--iterations", "10", "--foxglove", port, "-q")
    assert (code, out) == (2, "")
    assert err.startswith(f"foxglove: 127.0.0.1:{port}: ")
    assert len(err.splitlines()) == 1
