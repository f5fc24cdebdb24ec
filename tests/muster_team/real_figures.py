"""How long real robots take to agree over a network that loses, delays and is cut: `make network-figures`.

Each robot is a `muster auction --robot` in a network namespace of its own, with 50 ms each way. Seconds to agreement
count from when the last robot has said that all are there; after a cut, from when it heals.
"""

import argparse
import sys
import tempfile
import threading
import time
from pathlib import Path
from random import Random
from subprocess import DEVNULL, PIPE

from tests.muster_team.real_network import RealNetwork, why_not

from muster.generation.uniform import uniform_mission
from muster.mission.yaml_writer import yaml_text
from muster_team.network.keys import new_key, write_key

LOSSES = (0.0, 0.1, 0.3, 0.5)
DELAY_S, CUT_S, CUT_LOSS = 0.05, 15.0, 0.3
GUARD_S = 120.0


class Talk:
    """What robots say on standard error, and when."""

    def __init__(self, network, robots, folder, *options):
        peers = ",".join(f"r_{k}={network.address(k + 1)}:7783" for k in range(robots))
        command = [sys.executable, "-m", "muster.cli", "auction", "field.yaml", "--key-file", "key", "--connect", peers]
        self.robots = robots
        self._said = [[] for _ in range(robots)]
        for k in range(robots):
            process = network.start(
                k + 1,
                *command,
                "--robot",
                f"r_{k}",
                "-o",
                f"{k}.json",
                *options,
                cwd=folder,
                stdout=DEVNULL,
                stderr=PIPE,
                text=True,
            )
            threading.Thread(target=self._listen, args=(k, process.stderr), daemon=True).start()

    def _listen(self, robot, stream):
        for line in stream:
            self._said[robot].append((time.monotonic(), line))

    def wait(self, words, since_s=0.0):
        """When each robot has said these words first, at this time or later."""
        until_s = time.monotonic() + GUARD_S
        while True:
            found = [next((t for t, line in said if words in line and t >= since_s), None) for said in self._said]
            if None not in found:
                return found
            if time.monotonic() > until_s:
                missing = [f"r_{k}" for k, at in enumerate(found) if at is None]
                raise TimeoutError(f"{', '.join(missing)}: nothing like {words!r} within {GUARD_S:g} s")
            time.sleep(0.02)

    def all_there_s(self):
        """When the last robot had heard of all others."""
        until_s = time.monotonic() + GUARD_S
        while time.monotonic() < until_s:
            there = [[t for t, line in said if line.rstrip().endswith(" is there")] for said in self._said]
            if all(len(times) >= self.robots - 1 for times in there):
                return max(times[self.robots - 2] for times in there)
            time.sleep(0.02)
        raise TimeoutError("robots do not hear of each other")


def to_agree(robots, folder, loss, seed):
    """Seconds until all robots know that all agree."""
    with RealNetwork(robots, loss=loss, delay_s=DELAY_S, seed=seed) as network:
        talk = Talk(network, robots, folder, "--linger", "3", "--wait", "60")
        there_s = talk.all_there_s()
        return max(talk.wait(f"all {robots} agree")) - there_s


def to_agree_after_a_cut(robots, folder, seed):
    """Seconds until all robots know that all agree, from when a cut has healed."""
    with RealNetwork(robots, loss=CUT_LOSS, delay_s=DELAY_S, seed=seed) as network:
        talk = Talk(network, robots, folder, "--linger", "60", "--wait", "60", "--time-limit", "120")
        talk.wait(f"all {robots} agree")
        network.cut(list(range(1, robots // 2 + 1)), list(range(robots // 2 + 1, robots + 1)))
        time.sleep(CUT_S)
        network.heal()
        healed_s = time.monotonic()
        return max(talk.wait(f"all {robots} agree", healed_s)) - healed_s


def say(line):
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", type=int, default=8)
    parser.add_argument("--tasks", type=int, default=20)
    parser.add_argument("--runs", type=int, default=3)
    asked = parser.parse_args()
    if (obstacle := why_not()) is not None:
        sys.exit(f"no network namespaces here: {obstacle}")
    say(f"{asked.robots} robots, {asked.tasks} tasks, {DELAY_S * 1000:g} ms each way, {asked.runs} runs; seconds")
    with tempfile.TemporaryDirectory() as folder:
        write_key(Path(folder) / "key", new_key())
        rows = [
            (f"loss {loss:.0%}", lambda seed, loss=loss: to_agree(asked.robots, folder, loss, seed)) for loss in LOSSES
        ]
        cut = f"a cut of {CUT_S:g} s has healed, loss {CUT_LOSS:.0%}"
        rows.append((cut, lambda seed: to_agree_after_a_cut(asked.robots, folder, seed)))
        for name, measured in rows:
            found = []
            for seed in range(asked.runs):
                mission = uniform_mission(Random(seed), robots=asked.robots, tasks=asked.tasks)
                (Path(folder) / "field.yaml").write_text(yaml_text(mission), encoding="utf-8")
                found.append(measured(seed))
            found.sort()
            say(
                f"{name}: median {found[len(found) // 2]:.2f}, least {found[0]:.2f}, most {found[-1]:.2f}",
            )


if __name__ == "__main__":
    main()
