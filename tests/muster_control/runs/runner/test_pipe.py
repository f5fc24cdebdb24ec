"""The runner's side of the pipes: what a killed server leaves in them."""

import os
import threading

import pytest

from muster_control.runs.runner.pipe import Inbox


@pytest.mark.parametrize("left", ["", '{"type": "ac', '{"id": 1}'])
def test_the_end_of_the_server_is_told_even_in_the_middle_of_a_line(left):
    reading, writing = os.pipe()
    ended = threading.Event()
    with os.fdopen(reading, encoding="utf-8") as stream:
        inbox = Inbox(stream, ended.set)
        os.write(writing, b'{"id": 0}\n' + left.encode())
        os.close(writing)
        assert ended.wait(10)
        assert inbox.take(10.0) == {"id": 0}
        assert inbox.take(10.0) is None
