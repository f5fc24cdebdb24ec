"""A log's entries in words: who did what, and what followed."""

from dataclasses import fields
from string import Formatter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.events import Event
from muster.mission.records import specified
from muster.state.event import KINDS
from muster.state.task_events import Starts
from muster.state.words import _DOES, ALARM, CHANGE, DETAIL, SAYS, line_of, mark_of

AT_DOCK = {"robot": "r_0", "station": "dock"}


@pytest.mark.parametrize(
    ("kind", "data", "line"),
    [
        ("starts", {"robot": "r_0", "task": "7"}, "r_0 begins task 7"),
        ("robot_fails", {"robot": "r_0", "reason": "no battery"}, "r_0 is out: no battery"),
        ("way_closed", {"robot": "r_0"}, "an obstacle is in the way of r_0, which has no other"),
        (
            "way_closed",
            {"robot": "r_0", "longer_m": 3.1},
            "an obstacle is in the way of r_0, which goes round it, 3.10 m longer",
        ),
        ("map_grows", {"explored_m2": 12.5}, "the map grows: 12.50 m2 explored"),
        ("new_task", {"task": {"id": "new-1", "position": [1, 2]}}, "task new-1 is added"),
        ("move_task", {"task": "7", "position": [1.0, 2.5]}, "task 7 is moved to 1.00, 2.50"),
        ("contact", {"robots": ["a", "b"]}, "a, b touch each other"),
        ("of no kind", {"robots": ["a", "b"], "much": 1.5}, "of no kind: robots a, b, much 1.50"),
        (
            "task_refused",
            {"robot": "a", "task": "7", "reason": "skill: lift", "others": {"8": ["b", "c"]}},
            "a cannot do task 7: skill: lift; nor can b, c do 8",
        ),
        (
            "standstill",
            {"task": "7", "words": "waits for 6", "given_up": "window: closes"},
            "no robot gets on: task 7 waits for 6; it is given up: window: closes",
        ),
        (
            "event_refused",
            {"event": {"at_s": 3, "cancel_task": "x"}, "reason": "no such task"},
            "refused: cancels task x: no such task",
        ),
        (
            "load_lies",
            {"task": "7", "robot": "a", "position": [1.0, 2.0], "load": {}},
            "what task 7 took on lies at 1.00, 2.00, where a failed",
        ),
        ("goes_on", {"robot": "a", "waited_s": {"b": 2.0}}, "a goes on, after 2.0 s for b"),
        ("lost", {"task": "7", "reason": "no robot takes part"}, "task 7 is lost: no robot takes part"),
        ("lost", {"task": "7", "reason": "cancelled at 40.4 s"}, "task 7 is not done: cancelled at 40.4 s"),
        ("goes_to_station", {**AT_DOCK, "charge": 0.5}, "r_0 goes to [dock] (50 % in its battery)"),
        ("arrives_at_station", AT_DOCK, "r_0 is at [dock]"),
        ("waits_for_slot", {**AT_DOCK, "served": ["r_1"]}, "r_0 waits for a slot at [dock]: r_1 is served there"),
        (
            "service_begins",
            {**AT_DOCK, "services": ["charge"], "takes_s": 58.62, "charge": 0.478},
            "r_0 is served at [dock]: charge, 58.6 s (48 % in its battery)",
        ),
        ("service_ends", {**AT_DOCK, "unloaded": {"kg": 3.0}}, "r_0 has been served at [dock]: unloaded kg 3.00"),
        (
            "plan",
            {
                "stations": ["dock"],
                "plan": {
                    "routes": [
                        {"robot": "a", "tasks": ["dock", "1", "dock", "2"]},
                        {"robot": "b", "tasks": ["bin", "3"], "stops": [{"station": "bin"}, {"task": "3"}]},
                    ]
                },
            },
            "plan: 3 tasks, 2 robots",
        ),
        (
            "report",
            {
                "tasks_done": ["1", "2"],
                "tasks_lost": [{"task": "7", "reason": "cancelled at 4 s"}, {"task": "8", "reason": "skill"}],
                "mission_time_s": 9.0,
            },
            "report: 2 tasks done, 1 lost, 1 cancelled, 9.0 s",
        ),
    ],
)
def test_what_happens(kind, data, line):
    assert line_of(kind, data) == line


@pytest.mark.parametrize(
    ("verb", "data", "deed"),
    [
        ("pause", {}, "pauses the run"),
        ("speed", {"speed": 2.0}, "sets the speed to 2 times"),
        ("speed", {"speed": None}, "lets it go as fast as it goes"),
        ("event", {"new_task": {"id": "new-1", "position": [1, 2]}}, "adds task new-1"),
        ("event", {"robot_fails": "d_1"}, "takes d_1 out"),
        ("event", {"robot_returns": "d_1"}, "brings d_1 back"),
        ("event", {"delay_task": {"task": "7", "by_s": 3}}, "delays task 7 by 3 s"),
    ],
)
def test_who_did_what(verb, data, deed):
    said = {"who": "anna", "verb": verb, "data": data}
    assert line_of("command", {**said, "outcome": "done"}) == f"anna {deed}"
    assert line_of("command", {**said, "outcome": "no such"}) == f"anna {deed}; refused: no such"


def test_why_it_was_planned_again_and_what_nobody_can_do():
    data = {
        "causes": [{"kind": "robot_fails", "robot": "r_1"}, {"kind": "new_task", "task": {"id": "n"}}],
        "moved": {"3": ["r_1", "r_0"]},
        "forced": ["3"],
        "added": {},
        "dropped": {"4": "skill: lift (r_0)"},
        "left_out": {"n": "unreachable (r_0)"},
    }
    assert line_of("replanned", data) == (
        "replanned, as r_1 is out, task n is added: 3 from r_1 to r_0; given up: 4 (skill: lift (r_0)); "
        "nobody can do: n (unreachable (r_0))"
    )


@given(
    st.sampled_from(sorted(kind for kind, says in SAYS.items() if isinstance(says, str))) | st.text(),
    st.dictionaries(
        st.sampled_from(["task", "robot", "position", "reason"]), st.none() | st.text() | st.lists(st.text())
    ),
)
def test_whatever_was_asked_for_has_words(kind, data):
    """A command that is refused may hold anything, and is in the log."""
    assert isinstance(line_of(kind if isinstance(SAYS.get(kind), str) else "no such kind", data), str)
    assert line_of("command", {"who": "ada", "verb": "event", "data": {kind: data}, "outcome": "no"}).startswith("ada ")
    assert line_of("command", {"who": "ada", "verb": "event", "data": {kind: None}, "outcome": "no"}).startswith("ada ")


def test_words_name_only_fields_that_the_event_has():
    for kind, cls in KINDS.items():
        if isinstance(SAYS[kind], str):
            used = {name for _, name, _, _ in Formatter().parse(SAYS[kind]) if name}
            assert used <= {field.name for field in fields(cls)}, kind


def test_each_event_of_a_mission_file_has_words_for_who_had_it_happen():
    assert {field.name for field in specified(Event)} - {"at_s"} <= _DOES.keys()
    for kind, words in _DOES.items():
        used = {name for _, name, _, _ in Formatter().parse(words) if name}
        assert used <= {field.name for field in fields(KINDS[kind])} if kind in KINDS else not used, kind


@pytest.mark.parametrize(
    ("kind", "data", "mark"),
    [
        ("lost", {"task": "7", "reason": "no robot takes part"}, ALARM),
        ("lost", {"task": "7", "reason": "cancelled at 4 s"}, ""),
        ("window_missed", {"task": "7", "reason": "window: closed at 3 s", "next_s": None}, ALARM),
        ("window_missed", {"task": "7", "reason": "window: closed at 3 s", "next_s": 9.0}, ""),
        ("replanned", {"moved": {"7": ["a", "b"]}, "dropped": {}, "left_out": {}}, CHANGE),
        ("replanned", {"moved": {}, "dropped": {"7": "skill"}, "left_out": {}}, ALARM),
        ("part_ends", {"task": "7", "robot": "a", "usage": [1, 1]}, DETAIL),
        ("contact", {"robots": ["a", "b"]}, ALARM),
        ("command", {"verb": "pause"}, CHANGE),
        ("of no kind", {}, ""),
    ],
)
def test_a_mark_says_who_should_look(kind, data, mark):
    assert mark_of(kind, data) == mark


def test_an_event_is_printed_as_its_time_and_words():
    assert str(Starts(time_s=3.25, task="7", robot="r_0")) == "3.2 s: r_0 begins task 7"
    assert str(Starts(task="7", robot="r_0")) == "r_0 begins task 7"
