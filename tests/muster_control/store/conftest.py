"""What the tests of the database share."""

import pytest
from tests.muster_control.databases import *  # noqa: F403 - its fixtures

from muster_control.contract import Entry, Stretch
from muster_control.store import Store

SUMMARY = {"name": "Yard", "robots": 2, "tasks": 3, "dimensions": 2}


@pytest.fixture
def store(database_url):
    opened = Store.open(database_url)
    yield opened
    opened.close()


class Filled:
    """A store with a mission, a plan and a run."""

    def __init__(self, store):
        self.store = store
        self.mission = store.missions.create("Yard", "a: 1\n", {"map.png": b"\x00\x89"}, SUMMARY, "ann").mission
        self.plan = store.plans.add(self.mission, 1, "planned", "ann", {"weight": 2.5, "routes": [["r", ["1"]]]}).id
        self.run = store.runs.add(self.mission, 1, self.plan, "kinematic", {"seed": 3}, None, "ann").id

    def entry(self, seq, kind="arrives", **data):
        return Entry(run=self.run, seq=seq, time_s=seq / 2, kind=kind, data=data)

    def stretch(self, seq, data=b"\x00\xff"):
        return Stretch(run=self.run, seq=seq, from_s=seq - 1.0, until_s=float(seq), data=data)


@pytest.fixture
def filled(store):
    return Filled(store)
