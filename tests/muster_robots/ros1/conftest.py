"""A real ROS master on a free port, and processes that are its nodes."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
import xmlrpc.client
from contextlib import contextmanager
from pathlib import Path

import pytest

from muster.mission.errors import MissingExtraError
from muster_robots.ros1.extra import require_rospy
from muster_robots.ros1.master import running_master

NODES = {"/muster", "/command_interface", "/system_monitor", "/mission_planner"}
"""Those of the command; the last three are processes of their own, which may be there after robots drive."""
GUARD_S = 120.0
"""No process of these tests takes so long."""
ENDLESS = ("odom", "pose", "tf", "clock")
"""The last parts of topics on which simulated robots, and their clock, go on for as long as they live."""


def own_words(err):
    """Standard error without the lines in which rospy warns of what it met on its own."""
    return "".join(line for line in err.splitlines(keepends=True) if not line.startswith("[WARN] "))


def family(process):
    """Ids of a process' children."""
    return [int(pid) for pid in Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()]


def alive(pids):
    return [pid for pid in pids if Path(f"/proc/{pid}").exists()]


class Ros:
    """Nodes under one master, each a process; all end with the test."""

    def __init__(self, master, folder):
        self.master, self.folder, self._processes, self._guards = master, folder, [], []
        self._environment = os.environ | master.environment

    def start(self, *arguments):
        started = subprocess.Popen(
            [sys.executable, *map(str, arguments)],
            env=self._environment,
            cwd=self.folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,  # so that Ctrl-C can be sent as a terminal does: to a group
        )
        self._processes.append(started)
        guard = threading.Timer(GUARD_S, started.kill)  # so that a test that waits for a line fails, and does not hang
        guard.daemon = True
        guard.start()
        self._guards.append(guard)
        return started

    def file(self, name):
        """A program of these tests."""
        return Path(__file__).with_name(name)

    def set(self, name, value):
        """A parameter of the parameter server."""
        with xmlrpc.client.ServerProxy(self.master.address) as proxy:
            proxy.setParam("/test", name, value)

    def muster(self, *arguments):
        return self.start("-m", "muster.cli", "ros", *arguments)

    def robot(self, name, x, y, *more):
        own = ("--kinematics", "differential-drive", "--speed", 3, "--yaw-rate", 6, *more)
        return self.start("-m", "muster_robots.ros1.simulated_robot", name, "--at", x, y, *own)

    def user(self):
        """One who asks in turn, as often as is wanted."""
        return User(self.start(Path(__file__).with_name("user.py")))

    def listener(self, *topics):
        """Independent of Muster: keeps each message of these TOPIC=PACKAGE/TYPE."""
        file = self.folder / "heard.jsonl"
        heard = self.start(self.file("listener.py"), file, *topics)
        while not file.exists():
            assert heard.poll() is None, heard.stderr.read()
            time.sleep(0.05)
        return Listener(heard, file)

    def close(self):
        for guard in self._guards:
            guard.cancel()
        for process in self._processes:
            process.kill()
            process.communicate()


class User:
    """A process that does as it is told; see user.py."""

    def __init__(self, process):
        self._process = process

    def do(self, **asked):
        self._process.stdin.write(json.dumps(asked) + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline()
        assert answer, self._process.stderr.read()
        return json.loads(answer)

    def call(self, service):
        """Whether it succeeded, and the message."""
        answer = self.do(call=service)
        return answer["success"], answer["message"]

    def until(self, holds, within_s=20.0, **asked):
        """Ask again until the answer is as wanted; returns it."""
        until = time.monotonic() + within_s
        while not holds(answer := self.do(**asked)):
            assert time.monotonic() < until, answer
            time.sleep(0.1)
        return answer


class Listener:
    """A process that keeps what it hears."""

    def __init__(self, process, file):
        self._process, self._file = process, file

    def heard(self):
        """All of it, by (topic, data) in order; the listener ends with that."""
        self._until_quiet()
        self._process.send_signal(signal.SIGTERM)
        self._process.communicate(timeout=10)
        return self.so_far()

    def so_far(self):
        """What it has heard up to now, in the same way, in whole lines."""
        text = self._file.read_text(encoding="utf-8")
        return [json.loads(line) for line in text[: text.rfind("\n") + 1].splitlines()]

    def _until_quiet(self, quiet_s=0.5, within_s=5.0):
        """What was said last may still be on its way to a busy listener."""
        heard, since = self._ending(), time.monotonic()
        until = since + within_s
        while time.monotonic() < min(since + quiet_s, until):
            time.sleep(0.05)
            before, heard = heard, self._ending()
            if heard != before:
                since = time.monotonic()

    def _ending(self):
        """How many words it has heard on topics that come to an end."""
        topics = (line.partition('", ')[0] for line in self._file.read_text(encoding="utf-8").splitlines())
        return sum(not topic.endswith(ENDLESS) for topic in topics)


@pytest.fixture(scope="session")
def rospy_there():
    try:
        require_rospy()
    except MissingExtraError as error:
        pytest.skip(str(error))


@contextmanager
def master_in(folder):
    try:
        with running_master(folder) as master:
            yield master
    except MissingExtraError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def shared_master(rospy_there, tmp_path_factory):
    with master_in(tmp_path_factory.mktemp("ros")) as master:
        yield master


@pytest.fixture
def ros(shared_master, tmp_path):
    nodes = Ros(shared_master, tmp_path)
    yield nodes
    nodes.close()
    with xmlrpc.client.ServerProxy(shared_master.address) as proxy:  # what users left there
        for node in ("/command_interface", "/mission_planner"):
            proxy.deleteParam("/test", node)


@contextmanager
def ros_in(folder):
    """Nodes under a master of the test's own, whose parameters it may set, and which it may stop and start again."""
    with master_in(folder) as master:
        nodes = Ros(master, folder)
        try:
            yield nodes
        finally:
            nodes.close()


@pytest.fixture
def own_ros(rospy_there, tmp_path):
    with ros_in(tmp_path) as nodes:
        yield nodes
