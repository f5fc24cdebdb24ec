"""A real ROS master on a free port, and processes that are its nodes."""

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client
from pathlib import Path

import pytest

from muster.bridges.ros1.extra import PACKAGES, require_rospy
from muster.mission.errors import MissingExtraError


class Ros:
    """Nodes under one master, each a process; all end with the test."""

    def __init__(self, master, folder):
        self.master, self.folder, self._processes = master, folder, []
        self._environment = os.environ | {"ROS_MASTER_URI": master, "ROS_IP": "127.0.0.1", "ROS_LOG_DIR": str(folder)}

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

    def muster(self, *arguments):
        return self.start("-m", "muster.cli", "ros", *arguments)

    def robot(self, name, x, y, *more):
        own = ("--kinematics", "differential-drive", "--speed", 3, "--yaw-rate", 6, *more)
        return self.start("-m", "muster.bridges.ros1.simulated", name, "--at", x, y, *own)

    def listener(self, *topics):
        """Independent of Muster: prints a line of JSON for each message of these topics=types."""
        heard = self.start(Path(__file__).with_name("listener.py"), *topics)
        assert heard.stdout.readline() == "ready\n", heard.stderr.read()
        return heard

    def close(self):
        for process in self._processes:
            process.kill()
            process.communicate()


def lines_of(listener):
    """What a listener heard, ended: (topic, data) in order."""
    listener.send_signal(signal.SIGTERM)
    return [json.loads(line) for line in listener.communicate(timeout=10)[0].splitlines()]


@pytest.fixture(scope="session")
def master(tmp_path_factory):
    try:
        require_rospy()
    except MissingExtraError as error:
        pytest.skip(str(error))
    program = shutil.which("rosmaster")
    if program is None:
        pytest.skip(f"no rosmaster: apt-get install python3-rosmaster {PACKAGES}")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    environment = os.environ | {"ROS_IP": "127.0.0.1", "ROS_LOG_DIR": str(tmp_path_factory.mktemp("ros"))}
    process = subprocess.Popen(
        [program, "--core", "-p", str(port)], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    address, until = f"http://127.0.0.1:{port}", time.monotonic() + 20
    while True:
        try:
            with xmlrpc.client.ServerProxy(address) as proxy:
                proxy.getPid("/test")
            break
        except OSError:
            assert process.poll() is None
            assert time.monotonic() < until, "rosmaster does not answer"
            time.sleep(0.1)
    yield address
    process.kill()
    process.wait()


@pytest.fixture
def ros(master, tmp_path):
    nodes = Ros(master, tmp_path)
    yield nodes
    nodes.close()
