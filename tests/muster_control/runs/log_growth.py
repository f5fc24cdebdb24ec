"""`python -m tests.muster_control.runs.log_growth [ORDERS...]`: the bytes of log that an order makes.

A simulated fleet serves so many orders, as fast as it goes. Told are the entries and the bytes of the log, in all
and by order, those of plans alone, and the size of the last checkpoint.
"""

import base64
import sys
from contextlib import closing

import muster
from muster.mission.model import Mission, Robot, Rules
from muster.mission.system.clock import VirtualClock
from muster.report.record.json_messages import json_bytes
from muster.state import MissionState
from muster_control.runs.run_settings import request_of
from muster_control.runs.runner.log_recorder import LogRecorder
from muster_control.runs.runner.run_loop import RunLoop
from muster_control.runs.runner.simulated_run import SimulatedRun

ROBOTS = 6
APART_S = 2.0
"""Seconds between two orders: the fleet keeps up."""


class Sizes:
    """Counts what a run tells, and keeps none of it."""

    full = False

    def __init__(self):
        self.entries = self.bytes = self.plans = self.checkpoint = 0
        self.done = 0

    def entry(self, message):
        size = len(json_bytes(message["data"])) + len(message["kind"])
        self.entries += 1
        self.bytes += size
        self.plans += size * (message["kind"] == "plan")
        self.done += message["kind"] == "ends"

    def stretch(self, *_): ...

    def send(self, message):
        if message["type"] == "checkpoint":
            self.checkpoint = len(base64.b64decode(message["data"]))

    send_if_room = send


class Orders:
    """An inbox with an order each so many seconds of the mission's clock."""

    def __init__(self, count):
        self.count, self.next, self.world_run = count, 0, None

    def take(self, wait_s=0.0):
        k = self.next
        if k >= self.count or self.world_run.time_s < k * APART_S:
            return None
        self.next += 1
        order = {"id": f"o_{k}", "position": [(37 * k) % (5 * ROBOTS), 1.0 + k % 7]}
        return {"id": k + 1, "verb": "event", "data": {"new_task": order}, "who": "ada"}


def sizes_of(orders):
    """What the log of a fleet comes to that serves so many orders."""
    robots = tuple(Robot(id=f"r_{k}", position=(5.0 * k, 0.0), speed_mps=2.0) for k in range(ROBOTS))
    there = Mission(name="standing fleet", robots=robots, tasks=(), rules=Rules(objective="lateness"))
    sizes, inbox = Sizes(), Orders(orders)
    plan = muster.solve(there, "greedy")
    recorder = LogRecorder(there, sizes, MissionState(there))
    settings = {"stay": True, "until_s": orders * APART_S}
    request = request_of("kinematic", settings, plan)
    with closing(SimulatedRun(there, plan, request, recorder=recorder)) as inbox.world_run:
        how = {"speed": None, "starts_at": None, "ended": lambda: False, "clock": VirtualClock(step_s=1.0)}
        RunLoop(inbox.world_run, recorder, inbox, sizes, **how).run()
    assert sizes.done == orders
    return sizes


def main(*orders):
    for count in orders or (1000, 3000, 10_000):
        sizes = sizes_of(count)
        by_order = f"{sizes.bytes / count:.0f} bytes an order, {sizes.plans / count:.0f} of them in plans"
        told = f"{count} orders: {sizes.entries} entries, {sizes.bytes / 1e6:.2f} MB, {by_order}"
        sys.stdout.write(f"{told}; the last checkpoint {sizes.checkpoint / 1000:.0f} kB\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
