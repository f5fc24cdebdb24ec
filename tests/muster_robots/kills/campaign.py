"""`python -m tests.muster_robots.kills [KILLS] [--first SEED]`: Muster is killed while it commands robots.

A run with robots behind a plug-in, MAVLink or ROS 2, all simulated, is killed at a random operation: in the middle of
a line of its journal, before or after a sync, before or after an order, or between. Time passes, in which robots do
what they were told last. Then the run goes on by its journal, and is killed again; or robots are brought home. In the
end each task was done once, no order for it came after that, each robot is named, and each that is armed.
"""

import threading
from collections import Counter
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from unittest import mock

from tests.muster_robots.kills.mortal import Killed, MortalFile, MortalFleet, Reaper
from tests.muster_robots.kills.worlds import WORLDS, states_of

import muster
from muster.running import journal as journals
from muster.running.bring_home import bring_home
from muster.running.carry_out import carried_out
from muster.running.journal import Journal, interrupted_run, left_behind
from muster.running.journal_file import Header, read_journal
from muster.running.observed_run import ObservedRun
from muster.running.run_request import OPEN_FLEET

KILLS_A_RUN = 5
OPERATIONS = (3, 30, 300, 1500)
"""How many operations, at most, a life lasts: deaths at the beginning are as frequent as later ones."""


class Round:
    """A run that is killed some times; `kills` and `ends` say how often, and how it ended."""

    def __init__(self, seed, folder, world=None):
        self.draw = Random(seed)
        self.world = (world or WORLDS[seed % len(WORLDS)])(self.draw)
        self.path = Path(folder) / f"{seed}.journal"
        self.plan = muster.solve(self.world.mission, "greedy")
        self.counted = Counter()

    def go(self):
        """All of it; returns what was counted."""
        try:
            for _ in range(self.draw.randint(1, KILLS_A_RUN)):
                life = Reaper(self.draw, self.draw.randrange(self.draw.choice(OPERATIONS)), power_cut=self._cut())
                if not self._lives(life):
                    self.counted["kills"] += 1
                    self._look_at_what_is_left()
                    self.world.pass_time(self.draw.choice([0.1, 3.0, 20.0]))
            if self.draw.random() < 0.3:
                self._bring_home()
            assert self._lives(Reaper(self.draw)) or self._over
            self._judge()
        finally:
            self.world.close()
        self.counted[self.world.name] += self.counted["kills"]
        return self.counted

    def _cut(self):
        return self.draw.random() < 0.5

    @property
    def _over(self):
        return self.path.exists() and read_journal(self.path).ended

    def _lives(self, reaper):
        """Begin or go on; returns whether the run came to its end."""
        if self._over:
            return True
        fleet = self.world.opened(again=self.path.exists())
        mortal = MortalFleet(fleet, reaper)

        def file(path, header, whole_bytes=0):
            return MortalFile(reaper, path, header, whole_bytes)

        try:
            with mock.patch.object(journals, "JournalFile", file):
                journal = self._journal()
            request = ObservedRun(world=OPEN_FLEET, wall=self.world.clock, journal=journal)
            report = carried_out(self.world.mission, self.plan, mortal, request)
            journal.end(states_of(self.world, fleet))
            journal.close()
        except Killed:
            return False
        finally:
            fleet.close()
        assert sorted(report.tasks_done) == sorted(task.id for task in self.world.mission.tasks), report.tasks_lost
        return True

    def _journal(self):
        mission = self.world.mission
        if not self.path.exists():
            header = Header.of(mission, self.plan, self.world.name, [self.world.name])
            return Journal.begun(self.path, mission, header, ())
        before = read_journal(self.path)
        before.require_of(mission, self.world.name, [self.world.name])
        before.require_under_way()
        return Journal.resumed(before, mission)

    def _look_at_what_is_left(self):
        """Who begins anew is told of each robot that is armed."""
        if not self.path.exists():
            return
        fleet = self.world.opened(again=True)
        states = states_of(self.world, fleet)
        armed = self.world.armed if self.world.flies else set()
        assert {one.robot for one in states} == {robot.id for robot in self.world.mission.robots}
        assert armed <= {one.robot for one in states if one.moving}
        before = interrupted_run(self.path)
        if before is not None:
            told = left_behind(before, self.world.mission, states)
            assert armed <= {line.split(":")[0] for line in told}
        fleet.close()

    def _bring_home(self):
        """Everyone comes home and down; then the run goes on all the same."""
        fleet = self.world.opened(again=True)
        journal = None if self._over else self._journal()
        lost = bring_home(self.world.mission, fleet, threading.Event(), journal=journal, wall=self.world.clock)
        states = states_of(self.world, fleet)
        assert lost == {}
        starts = {robot.id: robot.position for robot in self.world.mission.robots}
        for one in states:
            away_m = sum((a - b) ** 2 for a, b in zip(one.position[:2], starts[one.robot][:2], strict=True)) ** 0.5
            assert away_m < 3.0 if self.world.flies else away_m < 0.6, one
            assert not one.moving, one
        if self.world.flies:
            assert self.world.armed == set()
        if journal is not None:
            journal.close()
        fleet.close()
        self.counted["brought home"] += 1

    def _judge(self):
        entries = read_journal(self.path).entries
        done = [entry["data"]["task"] for entry in entries if entry["kind"] == "ends"]
        assert sorted(done) == sorted(task.id for task in self.world.mission.tasks)
        over = set()
        for entry in entries:
            if entry["kind"] == "ends":
                over.add(entry["data"]["task"])
            elif entry["kind"] == "order":
                assert not over.intersection(entry["data"]["for"]), entry
        if self.world.flies:
            fleet = self.world.opened(again=True)
            assert self.world.armed == {one.robot for one in states_of(self.world, fleet) if one.moving}
            fleet.close()
        self.counted["runs"] += 1
        self.counted["tasks"] += len(done)


def killed(kills, first=0, world=None, tell=lambda counted: None):
    """Rounds until so many kills have been; returns what was counted."""
    counted, seed = Counter(), first
    with TemporaryDirectory() as folder:
        while counted["kills"] < kills:
            try:
                counted += Round(seed, folder, world).go()
            except BaseException as error:
                error.add_note(f"seed {seed}")
                raise
            seed += 1
            tell(counted)
    return counted
