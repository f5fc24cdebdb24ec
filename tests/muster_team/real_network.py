"""A network in user space: network namespaces whose Ethernet frames all go through this program, which may lose them.

Loss, delay, jitter and cuts on every kernel, without netem. Needs root, iproute2 and /dev/net/tun. Run as a program, it
is the switch: it makes the namespaces, does what lines of JSON on its standard input say, and removes the namespaces
when the input ends, for whatever reason.
"""

import fcntl
import heapq
import json
import os
import random
import select
import shutil
import signal
import struct
import subprocess
import sys
import time

_TUNSETIFF, _TAP, _NO_PACKET_INFO = 0x400454CA, 0x0002, 0x1000
_MAC = b"\x02\x00\x00\x00\x77"  # locally administered; the port's number follows
_FRAME = 2048


def why_not():
    """Why there can be no such network here; None if there can."""
    if os.geteuid() != 0:
        return "needs root, for network namespaces"
    if shutil.which("ip") is None:
        return "needs iproute2"
    if not os.access("/dev/net/tun", os.R_OK | os.W_OK):
        return "needs /dev/net/tun"
    name = f"muster{os.getpid()}"
    if subprocess.run(["ip", "netns", "add", name], capture_output=True, check=False).returncode:
        return "may not make network namespaces"
    subprocess.run(["ip", "netns", "del", name], check=True)
    return None


class RealNetwork:
    """Hosts 1 to n, each in a namespace of its own. A context manager: leaving it removes them."""

    def __init__(self, hosts, *, loss=0.0, delay_s=0.0, jitter_s=0.0, seed=0):
        self.hosts = hosts
        self._conditions = {"loss": loss, "delay_s": delay_s, "jitter_s": jitter_s, "groups": None}
        self._seed = seed
        self._started = []

    def __enter__(self):
        arguments = [str(os.getpid()), str(self.hosts), str(self._seed)]
        self._switch = subprocess.Popen(
            [sys.executable, __file__, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        if self._switch.stdout.readline() != "ready\n":
            self.__exit__()
            raise OSError("the switch did not start")
        self._say(**self._conditions)
        return self

    def __exit__(self, *_):
        for process in self._started:
            process.kill()
            process.wait()
        self._switch.stdin.close()
        try:
            self._switch.wait(10)
        except subprocess.TimeoutExpired:
            self._switch.kill()
            self._switch.wait()
        self._switch.stdout.close()
        _remove(os.getpid(), self.hosts)

    def address(self, host):
        return f"10.77.0.{host}"

    def start(self, host, *command, **how):
        """A process on a host."""
        process = subprocess.Popen(["ip", "netns", "exec", _name(os.getpid(), host), *command], **how)
        self._started.append(process)
        return process

    def cut(self, *groups):
        """Only hosts of one group reach each other."""
        self._say(groups=groups)

    def heal(self):
        self._say(groups=None)

    def _say(self, **what):
        self._switch.stdin.write(json.dumps(what) + "\n")
        self._switch.stdin.flush()


def _name(owner, host):
    return f"muster{owner}h{host}"


def _ip(words, check=True):
    subprocess.run(["ip", *words.split()], check=check, capture_output=True)


def _remove(owner, hosts):
    for host in range(1, hosts + 1):
        _ip(f"netns del {_name(owner, host)}", check=False)


def _plugged_in(owner, host):
    """A host's cable: what is written to it the host receives."""
    cable = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    device, name = f"mu{owner % 100_000}t{host}", _name(owner, host)
    fcntl.ioctl(cable, _TUNSETIFF, struct.pack("16sH", device.encode(), _TAP | _NO_PACKET_INFO))
    _ip(f"netns add {name}")
    _ip(f"link set {device} netns {name}")
    for words in (
        "link set {device} name eth0",
        f"link set eth0 address 02:00:00:00:77:{host:02x}",
        f"addr add 10.77.0.{host}/24 dev eth0",
        "link set eth0 up",
        "link set lo up",
        "route add 224.0.0.0/4 dev eth0",
    ):
        _ip(f"-n {name} " + words.format(device=device))
    return cable


class _Switch:
    """Carries frames from cable to cable, as well as the conditions let it."""

    def __init__(self, cables, seed):
        self._cables, self._random = cables, random.Random(seed)
        self._late, self._count = [], 0
        self.conditions = {"loss": 0.0, "delay_s": 0.0, "jitter_s": 0.0, "groups": None}

    def run(self):
        poll = select.epoll()
        for descriptor in (*self._cables, sys.stdin.fileno()):
            poll.register(descriptor, select.EPOLLIN)
        while True:
            wait_s = max(0.0, self._late[0][0] - time.monotonic()) if self._late else None
            for descriptor, _ in poll.poll(wait_s):
                if descriptor == sys.stdin.fileno():
                    line = sys.stdin.buffer.raw.readline()
                    if not line:
                        return
                    self.conditions.update(json.loads(line))
                else:
                    self._take(self._cables.index(descriptor))
            self._deliver()

    def _take(self, sender):
        while True:
            try:
                frame = os.read(self._cables[sender], _FRAME)
            except BlockingIOError:
                return
            to_one = frame[:5] == _MAC and 0 < frame[5] <= len(self._cables)
            for receiver in (frame[5] - 1,) if to_one else range(len(self._cables)):
                lost = self._random.random() < self.conditions["loss"]
                if receiver != sender and not lost and self._side(sender) == self._side(receiver):
                    late_s = self.conditions["delay_s"] + self._random.uniform(0, self.conditions["jitter_s"])
                    self._count += 1
                    heapq.heappush(self._late, (time.monotonic() + late_s, self._count, receiver, frame))

    def _side(self, cable):
        groups = self.conditions["groups"]
        return 0 if groups is None else next((k for k, group in enumerate(groups) if cable + 1 in group), -1)

    def _deliver(self):
        while self._late and self._late[0][0] <= time.monotonic():
            *_, receiver, frame = heapq.heappop(self._late)
            try:
                os.write(self._cables[receiver], frame)
            except OSError:
                continue  # its queue is full: lost, as on a real switch


def main():
    owner, hosts, seed = map(int, sys.argv[1:])
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the starter, whose end this notices
    try:
        cables = [_plugged_in(owner, host) for host in range(1, hosts + 1)]
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        _Switch(cables, seed).run()
    finally:
        _remove(owner, hosts)


if __name__ == "__main__":
    main()
