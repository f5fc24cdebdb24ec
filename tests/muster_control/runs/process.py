"""`muster serve` as a process of its own: asked over its API, killed, and started again on the same database."""

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import contextmanager, suppress
from pathlib import Path

import httpx

WITHIN_S = 60.0


class Serving:
    """A server's process, which answers at `url`."""

    def __init__(self, database, *options, log=None):
        command = [sys.executable, "-m", "muster.cli", "serve", "--port", "0", "--db", database, "--workers", "1"]
        self._log = Path(log or os.devnull).open("ab")  # noqa: SIM115 - as long as the process lives
        self.process = subprocess.Popen([*command, *options], stdout=subprocess.PIPE, stderr=self._log, text=True)
        guard = threading.Timer(WITHIN_S, self.process.kill)
        guard.start()
        said = self.process.stdout.readline()
        guard.cancel()
        assert said.startswith("mission control: "), f"it ended with {self.process.wait()}"
        self.url = said.removeprefix("mission control: ").strip().rstrip("/")
        self.http = httpx.Client(base_url=f"{self.url}/api/v1", timeout=30)

    def kill(self):
        """kill -9."""
        self.process.kill()
        self._gone()

    def end(self):
        """As a service is ended."""
        self.process.send_signal(signal.SIGTERM)
        assert self.process.wait(WITHIN_S) == 0
        self._gone()

    def children(self, module):
        """The processes that it has started which run a module, the oldest first."""
        return [pid for pid, command in children(self.process.pid) if module in command]

    def _gone(self):
        self.process.wait()
        self.process.stdout.close()
        self.http.close()
        self._log.close()


@contextmanager
def serving(database, *options):
    """A server as long as it is needed."""
    server = Serving(database, *options)
    try:
        yield server
    finally:
        if server.process.poll() is None:
            server.kill()


def kill(pid):
    """kill -9; whether there was such a process."""
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


def gone(pid):
    """Whether a process has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def until(holds, within_s=WITHIN_S):
    """Wait for what holds; returns what is true of it."""
    end = time.monotonic() + within_s
    while not (found := holds()):
        assert time.monotonic() < end, "it did not come about"
        time.sleep(0.02)
    return found


def children(parent):
    """The processes that a process has started, with their commands, the oldest first."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            if int(stat.read_text().rpartition(")")[2].split()[1]) == parent:
                command = stat.with_name("cmdline").read_bytes().decode(errors="replace").split("\0")
                found.append((int(stat.parent.name), command))
    return sorted(found)
