"""A log's entries in words: who did what, and what followed."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.server.runs.log_lines import _DOES, _HAPPENS, line_of

AT_DOCK = {"robot": "r_0", "station": "dock"}


@pytest.mark.parametrize(
    ("kind", "data", "line"),
    [
        ("starts", {"robot": "r_0", "task": "7"}, "r_0 begins 7"),
        ("robot_fails", {"robot": "r_0", "reason": "no battery"}, "r_0 is out: no battery"),
        ("new_task", {"task": {"id": "new-1", "position": [1, 2]}}, "task new-1 is added"),
        ("move_task", {"task": "7", "position": [1.0, 2.5]}, "task 7 is moved to 1.00, 2.50"),
        ("contact", {"robots": ["a", "b"]}, "contact: robots a b"),
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
    st.sampled_from(sorted(_HAPPENS)) | st.text(),
    st.dictionaries(
        st.sampled_from(["task", "robot", "position", "reason"]), st.none() | st.text() | st.lists(st.text())
    ),
)
def test_whatever_was_asked_for_has_words(kind, data):
    """A command that is refused may hold anything, and is in the log."""
    assert isinstance(line_of(kind if kind in _HAPPENS else "lost", data), str)
    assert line_of("command", {"who": "ada", "verb": "event", "data": {kind: data}, "outcome": "no"}).startswith("ada ")
    assert line_of("command", {"who": "ada", "verb": "event", "data": {kind: None}, "outcome": "no"}).startswith("ada ")


def test_words_name_only_what_there_is():
    for words in (*_HAPPENS.values(), *_DOES.values()):
        assert "?" not in words.format(
            robot="r",
            task="t",
            position="p",
            by_s="1",
            words="w",
            waits_for="o",
            robots="q",
            door="d",
            station="s",
            round="b",
            makes_room_for="o",
        )
