"""DDS on this computer alone, in a domain of the test's own; simulated robots as processes."""

import itertools
import os
import subprocess
import sys
from zlib import crc32

import pytest

LOOPBACK = """<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><Peers><Peer address="127.0.0.1"/></Peers>
<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>30</MaxAutoParticipantIndex></Discovery>
</Domain></CycloneDDS>"""


WORKERS, DOMAINS = 8, 200
_tests = itertools.count()


@pytest.fixture
def loopback(monkeypatch):
    """Robots of a test are killed, and count as there for ten seconds: the next test is in another domain."""
    run = crc32(os.environ.get("PYTEST_XDIST_TESTRUNUID", str(os.getpid())).encode())
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    monkeypatch.setenv("CYCLONEDDS_URI", LOOPBACK)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(10 + (run + worker + WORKERS * next(_tests)) % DOMAINS))


@pytest.fixture
def start(loopback):
    """Starts Python programs; all end with the test: `start("-m", "muster.cli", "ros2", ...)`."""
    processes = []

    def started(*arguments):
        command = [sys.executable, *map(str, arguments)]
        pipe = subprocess.PIPE
        processes.append(subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True))
        return processes[-1]

    yield started
    for process in processes:
        process.kill()
        process.communicate()


@pytest.fixture
def simulated(start):
    """Starts simulated robots: `simulated("r_0", 0, 0)`."""

    def robot(name, x, y, *more):
        quick = ("--kinematics", "holonomic", "--speed", 3, "--yaw-rate", 6)
        return start("-m", "muster_robots.ros2.simulated_participant", name, "--by", "dds", "--at", x, y, *quick, *more)

    return robot
