"""Starts a ROS master on a free port of this computer, for benches and tests."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from muster.mission.errors import MissingExtraError, NetworkError
from muster_robots.ros1.node import master_answers

_WITHIN_S = 20.0


class Master:
    """One that runs, until it is stopped; it may be started again, at the same address, and then knows nobody.

    Parameters
    ----------
    folder
        for its logs.

    Raises
    ------
    MissingExtraError
        if there is no program `rosmaster`.
    NetworkError
        if it does not answer.
    """

    def __init__(self, folder: Path) -> None:
        program = shutil.which("rosmaster")
        if program is None:
            raise MissingExtraError("ros1", "a ROS master (rosmaster)", how="apt-get install python3-rosmaster")
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.address = f"http://127.0.0.1:{port}"
        self.environment = {"ROS_MASTER_URI": self.address, "ROS_IP": "127.0.0.1", "ROS_LOG_DIR": str(folder)}
        """The environment of its nodes."""
        self._command = [program, "--core", "-p", str(port)]
        self.start()

    def start(self) -> None:
        """Begin; the constructor has done so."""
        environment = os.environ | self.environment
        quiet = subprocess.DEVNULL
        self._process = subprocess.Popen(self._command, env=environment, stdout=quiet, stderr=quiet)
        until = time.monotonic() + _WITHIN_S
        while not master_answers(self.address):
            if self._process.poll() is not None or time.monotonic() > until:
                self.stop()
                raise NetworkError(
                    f"ROS master: {self.address}: it does not answer; expected it within {_WITHIN_S:g} s"
                )
            time.sleep(0.1)

    def send_signal(self, number: int) -> None:
        """Such as SIGSTOP: it hangs."""
        self._process.send_signal(number)

    def stop(self) -> None:
        """End it at once, without notice to nodes."""
        self._process.kill()
        self._process.wait()


@contextmanager
def running_master(folder: Path) -> Iterator[Master]:
    """A master that ends with the block; errors as of `Master`."""
    master = Master(folder)
    try:
        yield master
    finally:
        master.stop()
