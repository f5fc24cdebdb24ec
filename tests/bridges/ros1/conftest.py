"""A real ROS master on a free port, and processes that are its nodes."""

import json
import os
import signal
import subprocess
import sys
import time
import xmlrpc.client
from pathlib import Path

import pytest

from muster.bridges.ros1.extra import require_rospy
from muster.bridges.ros1.master import running_master
from muster.mission.errors import MissingExtraError


class Ros:
    """Nodes under one master, each a process; all end with the test."""

    def __init__(self, master, folder):
        self.master, self.folder, self._processes = master, folder, []
        self._environment = os.environ | master.environment

    def start(self, *arguments):
        started = subprocess.Popen(
            [sys.executable, *map(str, arguments)],
            env=self._environment,
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._processes.append(started)
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
        return self.start("-m", "muster.bridges.ros1.simulated", name, "--at", x, y, *own)

    def call(self, *asked):
        """Calls services, and publishes tasks, in turn; prints what services answer."""
        return self.start(self.file("caller.py"), *asked)

    def listener(self, *topics):
        """Independent of Muster: keeps each message of these TOPIC=PACKAGE/TYPE."""
        file = self.folder / "heard.jsonl"
        heard = self.start(self.file("listener.py"), file, *topics)
        while not file.exists():
            assert heard.poll() is None, heard.stderr.read()
            time.sleep(0.05)
        return Listener(heard, file)

    def close(self):
        for process in self._processes:
            process.kill()
            process.communicate()


class Listener:
    """A process that keeps what it hears."""

    def __init__(self, process, file):
        self._process, self._file = process, file

    def heard(self):
        """All of it, by (topic, data) in order; the listener ends with that."""
        self._process.send_signal(signal.SIGTERM)
        self._process.communicate(timeout=10)
        return [json.loads(line) for line in self._file.read_text(encoding="utf-8").splitlines()]


@pytest.fixture(scope="session")
def rospy_found():
    try:
        require_rospy()
    except MissingExtraError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def shared_master(rospy_found, tmp_path_factory):
    try:
        with running_master(tmp_path_factory.mktemp("ros")) as running:
            yield running
    except MissingExtraError as error:
        pytest.skip(str(error))


@pytest.fixture
def master(rospy_found, tmp_path):
    """One of the test's own, which it may set parameters of, stop, and start again."""
    try:
        with running_master(tmp_path) as running:
            yield running
    except MissingExtraError as error:
        pytest.skip(str(error))


@pytest.fixture
def ros(shared_master, tmp_path):
    nodes = Ros(shared_master, tmp_path)
    yield nodes
    nodes.close()


@pytest.fixture
def own_ros(master, tmp_path):
    """Nodes under a master of the test's own."""
    nodes = Ros(master, tmp_path)
    yield nodes
    nodes.close()
