"""Each kind of event is written and read, has its data, and changes what is known in its own function alone."""

import ast
import json
import math
from dataclasses import fields
from pathlib import Path

import pytest
from tests.state.played import NEWCOMER, known, site

from muster.mission.errors import ParameterError
from muster.mission.yaml_writer import plain
from muster.state import MissionState, OtherEvent, event_of
from muster.state.event import KINDS
from muster.state.task_ledger import Ledger

AT = {"robot": "r_0", "station": "dock", "charge": 0.5, "used": 3.0}
OF = {"robot": "r_0", "task": "t_0"}
DATA = {
    "sets_out": OF | {"used": 1.0},
    "arrives": OF | {"used": 2.0},
    "waits": OF | {"cause": "window", "words": "waits for window: opens at 9 s"},
    "starts": {"task": "pair", "robot": "r_0", "team": ["r_0", "r_1"], "used": 2.0, "from_s": 4.0},
    "ends": {
        "task": "pair",
        "robot": "r_0",
        "team": ["r_0", "r_1"],
        "used": 5.0,
        "parts": {"r_0": [1.0, 5.0], "r_1": [2.0, 6.0]},
        "usage": [3.0, 4.0],
        "arrival_usage": 2.0,
    },
    "part_ends": OF | {"usage": [1.0, 2.0]},
    "done_elsewhere": {"task": "t_0", "robots": ["r_1", "r_2"]},
    "work_broken_off": OF,
    "task_refused": OF | {"reason": "unreachable", "blocked_by": "r_1", "others": {"t_1": ["r_2"]}, "for_now": True},
    "new_task": {"task": {"id": "new", "position": [1.0, 2.0]}, "came_s": 1.0},
    "cancel_task": {"task": "pick"},
    "move_task": {"task": "t_0", "position": [5.0, 6.0], "under_way": True},
    "delay_task": {"task": "t_0", "by_s": 3.0},
    "load_lies": {"task": "pick", "robot": "r_0", "position": [1.0, 1.0], "load": {"": 1.0}},
    "window_missed": {"task": "timed", "reason": "window: closed", "next_s": None},
    "deadline_missed": {"task": "soon", "reason": "deadline: over", "next_s": None},
    "within_missed": {"task": "t_1", "reason": "prerequisite: too late", "next_s": 9.0},
    "standstill": {"task": "t_0", "waits_for": ["t_1"], "words": "waits", "given_up": "team: nobody"},
    "lost": {"task": "t_2", "reason": "left out"},
    "forgets": {"tasks": ["pick"]},
    "twice": {"task": "t_0", "robots": ["r_0", "r_1"]},
    "robot_fails": {"robot": "r_1", "reason": "its battery is empty"},
    "robot_silent": {"robot": "r_1", "goes_on": True},
    "robot_suspended": {"robot": "r_1", "reason": "pilot: mode POSCTL"},
    "robot_stuck": {"robot": "r_1", "reason": "no progress"},
    "robot_removed": {"robot": "r_1", "reason": "a person took it away"},
    "robot_moved": {"robot": "r_1", "position": [4.0, 5.0]},
    "robot_returns": {"robot": "r_1", "reason": "it moves again"},
    "robot_joins": {"robot": plain(NEWCOMER)},
    "returns": {"robot": "r_0"},
    "robot_at_end": {"robot": "r_0"},
    "no_way_to_end": {"robot": "r_0"},
    "robot_runs_low": {"robot": "r_0", "capacity": 5.0},
    "energy_low": {"robot": "r_0", "charge": 0.1, "missing": 3.0, "drain": 1.1},
    "robot_charged": {"robot": "r_0", "station": "dock"},
    "robot_sent_again": {"robot": "r_0", "reason": "no progress"},
    "robot_goes_round": {"robot": "r_0", "round": "r_1"},
    "way_closed": {"robot": "r_0", "longer_m": 3.1},
    "ground_unknown": {"cell_m": 0.05},
    "map_grows": {
        "cell_m": 0.5,
        "origin": [0.0, 0.0, 0.0],
        "size": [2, 3],
        "runs": [[0, 0, 2, 1], [1, 2, 1, 2]],
        "explored_m2": 0.5,
    },
    "robot_makes_room": {"robot": "r_0", "makes_room_for": "r_1"},
    "robot_stands_aside": {"robot": "r_0", "waits_for": "r_1"},
    "waits_in_traffic": {"robot": "r_0", "waits_for": "r_1", "position": [1.0, 2.0], "since_s": 2.0},
    "goes_on": {"robot": "r_0", "until_s": 4.0, "waited_s": {"r_1": 2.0}, "position": [1.0, 2.0]},
    "traffic_jam": {"robots": ["r_0", "r_1"], "position": [1.0, 2.0], "since_s": 2.0},
    "final_states": {"robots": [{"robot": "r_0", "moving": False, "words": "r_0: stands"}]},
    "elsewhere": {"what": "robot r_0 begins elsewhere"},
    "robots_free": {"left_out": ["t_4"]},
    "goes_to_station": AT,
    "arrives_at_station": AT,
    "waits_for_slot": AT | {"served": ["r_1"]},
    "service_begins": AT | {"services": ["unload"], "takes_s": 2.0},
    "service_ends": AT | {"unloaded": {"": 1.0}},
    "station_fails": {"station": "dock"},
    "station_returns": {"station": "dock"},
    "station_unreachable": {"station": "dock", "robot": "r_0", "reason": "unreachable"},
    "door_closes": {"door": "a"},
    "door_opens": {"door": "a"},
    "mission_begins": {"zero_s": 1e9, "starts_at": "2027-03-01T08:00", "after_s": 2.0, "places": {"r_0": [1, 2, 90]}},
    "mission_ended": {"ended_s": 5.0},
    "plan": {"routes": {"r_0": ["t_0"], "r_1": []}, "left_out": {"t_5": "why", "t_4": None}},
    "replanned": {
        "causes": [{"kind": "improved"}],
        "moved": {"t_0": ["r_0", "r_1"]},
        "forced": ["t_0"],
        "added": {"t_1": "r_0"},
        "dropped": {"t_2": "why"},
        "left_out": {"t_3": "why"},
    },
    "event_refused": {"event": {"cancel_task": "t_99"}, "reason": "task: 't_99'; expected another"},
    "resumed": {"how": "from where robots stand", "again": ["t_0"], "used": {"r_0": 7.5}},
}
"""For each kind data in which no field is as by default."""


def test_each_kind_has_an_example_in_which_no_field_is_as_by_default():
    assert DATA.keys() == KINDS.keys()
    for kind, data in DATA.items():
        left = {f.name for f in fields(KINDS[kind])} - data.keys() - {"time_s"}
        assert left <= {"plan", "reason", "charge"}, kind


@pytest.mark.parametrize("kind", DATA)
def test_an_event_that_is_written_and_read_is_the_same(kind):
    event = event_of(3.0, kind, DATA[kind])
    written = json.loads(json.dumps(event.data))
    assert event_of(3.0, kind, written) == event
    assert written == json.loads(json.dumps(DATA[kind]))


@pytest.mark.parametrize("kind", DATA)
def test_data_that_are_none_of_its_kind_are_refused(kind):
    field, value = next(iter(DATA[kind].items()))
    wrong = {**DATA[kind], field: 7 if isinstance(value, str | list | dict) else "seven"}
    with pytest.raises(ParameterError, match=f"event {kind} at 3 s: Expected .* at `\\$.{field}"):
        event_of(3.0, kind, wrong)


def test_an_event_of_another_kind_changes_nothing():
    state, event = MissionState(site()), event_of(2.0, "blinks", {"robot": "r_0"})
    assert isinstance(event, OtherEvent)
    state.apply(event_of(2.0, "robot_at_end", {"robot": "r_0"}))
    before = known(state)
    state.apply(event)
    assert known(state) == before


@pytest.mark.parametrize("kind", DATA)
def test_a_checkpoint_keeps_what_an_event_has_changed(kind):
    """After all kinds, this one last."""
    from muster.state import checkpoint_of, restored

    state = MissionState(site())
    for name in (*(name for name in DATA if name not in (kind, "new_task", "robot_joins", "forgets")), kind):
        state.apply(event_of(3.0, name, DATA[name]))
    again = restored(site(), json.loads(json.dumps(checkpoint_of(state))))
    assert known(again) == known(state)
    kept = vars(state).keys() - {"mission", "_forgets"}
    assert all(str(getattr(again, name)) == str(getattr(state, name)) for name in kept - {"ledger", "robots", "doors"})


def test_times_are_not_numbers_until_an_event_happens():
    event = KINDS["door_closes"](door="a")
    assert math.isnan(event.time_s)
    assert event.at(3.0) == event_of(3.0, "door_closes", {"door": "a"})


CHANGES = {name for name in vars(Ledger) if not name.startswith("_")} & {
    *("add", "begin", "arrive", "break_off", "expire", "give_up", "end", "lose", "refuse", "try_again", "move"),
    *("delay", "reopen", "withdraw", "retire"),
}
LEDGERS = ("ledger", "_ledger", "goods", "_goods", "orders", "traffic_account", "state", "_known", "known")
MUTATORS = {"update", "pop", "setdefault", "append", "clear", "discard", "remove"}


def _changes_state(node):
    """Whether a node of a syntax tree changes the ledger of tasks by a method of it, or an entry of what it holds."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        of = node.func.value
        named = of.attr if isinstance(of, ast.Attribute) else of.id if isinstance(of, ast.Name) else ""
        if node.func.attr in CHANGES and named in LEDGERS:
            return True
        holder = of.value if isinstance(of, ast.Attribute) else None
        return node.func.attr in MUTATORS and isinstance(holder, ast.Attribute) and holder.attr in LEDGERS
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AugAssign) else []
    for target in targets:
        entry = target.value if isinstance(target, ast.Subscript) else target
        holder = entry.value if isinstance(entry, ast.Attribute) else None
        if isinstance(holder, ast.Attribute) and holder.attr in LEDGERS:
            return True
    return False


def test_nothing_but_events_changes_what_is_known():
    source = Path(__file__).parents[2] / "src" / "muster"
    found = [
        f"{file.relative_to(source)}:{node.lineno}"
        for room in ("execution", "running", "server/runs", "report")
        for file in (source / room).rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text()))
        if _changes_state(node)
    ]
    assert found == []
