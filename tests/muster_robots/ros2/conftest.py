"""DDS on this computer alone, in a domain of this process' own; simulated robots as processes."""

import os
import subprocess
import sys

import pytest

LOOPBACK = """<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><Peers><Peer address="127.0.0.1"/></Peers>
<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>30</MaxAutoParticipantIndex></Discovery>
</Domain></CycloneDDS>"""


@pytest.fixture
def loopback(monkeypatch):
    monkeypatch.setenv("CYCLONEDDS_URI", LOOPBACK)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(10 + os.getpid() % 200))


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
