"""A log's entries in words: who did what, and what followed."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.server.runs.log_lines import _DOES, _HAPPENS, line_of


@pytest.mark.parametrize(
    ("kind", "data", "line"),
    [
        ("starts", {"robot": "r_0", "task": "7"}, "r_0 begins 7"),
        ("robot_fails", {"robot": "r_0", "reason": "no battery"}, "r_0 is out: no battery"),
        ("new_task", {"task": {"id": "new-1", "position": [1, 2]}}, "task new-1 is added"),
        ("move_task", {"task": "7", "position": [1.0, 2.5]}, "task 7 is moved to 1.00, 2.50"),
        ("contact", {"robots": ["a", "b"]}, "contact: robots a b"),
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
            round="b",
            makes_room_for="o",
        )
