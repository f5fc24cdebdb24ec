"""The last checkpoint of a run and the entries after it say all that was known when its process ended."""

import base64
import json
import math
from random import Random

import pytest
from tests.muster_control.runs.stage import performed
from tests.state.played import SAMPLES, known, site

import muster
from muster.mission.yaml_writer import plain
from muster.state.recovery import recovered_from
from muster_control.runs.log import checkpoints
from muster_control.runs.log.checkpoints import unpacked_state

BEFORE = {
    "robot_returns": [{"robot_fails": "r_0"}, {"robot_fails": "r_1"}],
    "door_opens": [{"door_closes": "a"}, {"door_closes": "b"}],
    "station_returns": [{"station_fails": "dock"}],
}


@pytest.fixture(scope="module")
def plan():
    return muster.solve(site(), "search", iterations=50, seed=1)


def asked(*events):
    return [(2.0 + k, "event", event) for k, event in enumerate(events)]


def require_recovered(mission, plan, requests, crash, most, monkeypatch):
    """Kill a run when so many entries are kept; what follows from checkpoint and log is what it knew by then."""
    monkeypatch.setattr(checkpoints, "MOST_ENTRIES", most)
    monkeypatch.setattr(checkpoints, "MOST_S", math.inf)
    seen = []
    kept = performed(mission, plan, requests, killed_after=crash, on_tick=lambda state: seen.append(known(state)))
    seq = kept.checkpoint["seq"] if kept.checkpoint else 0
    checkpoint = unpacked_state(base64.b64decode(kept.checkpoint["data"])) if kept.checkpoint else None
    assert (checkpoint is not None) == (len(kept.log) >= most)
    found = recovered_from(mission, plan, json.loads(json.dumps(kept.log[seq:])), checkpoint)
    assert known(found) == seen[-1]
    return kept


@pytest.mark.long
@pytest.mark.parametrize("most", [7, pytest.param(10_000, marks=pytest.mark.long)])
@pytest.mark.parametrize("kind", SAMPLES)
def test_each_kind_of_event_is_in_checkpoint_or_log(plan, kind, most, monkeypatch):
    mission = site()
    events = [*BEFORE.get(kind, ()), *({kind: plain(value)} for value in SAMPLES[kind])]
    kinds = set()
    for crash in (30, None):
        kept = require_recovered(mission, plan, asked(*events), crash, most, monkeypatch)
        kinds |= {entry["kind"] for entry in kept.log}
    assert kind in kinds | {"robot_silent"}  # that the monitor notices later


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(k, marks=pytest.mark.long) for k in range(2, 60))])
def test_whatever_happens_is_in_checkpoint_or_log(plan, seed, monkeypatch):
    draw = Random(seed)
    kinds = draw.choices(sorted(SAMPLES), k=draw.randrange(2, 9))
    events = [{kind: plain(draw.choice(SAMPLES[kind]))} for kind in kinds]
    require_recovered(site(), plan, asked(*events), draw.randrange(10, 90), draw.choice([5, 11, 30]), monkeypatch)
