"""Actions by name: all that missions may name are there, and others can be added."""

from dataclasses import dataclass, fields

import pytest

from muster import Robot, Task
from muster.mission.action_keys import ACTION_KEYS, ActionKeys
from muster.mission.errors import MissionError, ParameterError
from muster.mission.model import Action
from muster.motion.actions import ACTIONS, along, plan, register


@dataclass(frozen=True)
class There:
    name: str = "there-and-back"
    keys: ActionKeys = ActionKeys(needed=("side_m",))

    def plan(self, task, robot):
        x, y = task.position
        return along(task, robot, [(x, y), (x + task.action.side_m, y), (x, y)])


@pytest.fixture
def there():
    """Registered for the time of a test."""
    register(There())
    yield There()
    ACTIONS.remove("there-and-back")
    ACTION_KEYS.remove("there-and-back")


def test_every_word_of_missions_has_an_action():
    assert list(ACTIONS) == list(ACTION_KEYS)
    assert all(action.name == name and action.keys is ACTION_KEYS[name] for name, action in ACTIONS.items())


def test_keys_are_fields():
    known = {field.name for field in fields(Action)}
    assert all({*keys.needed, *keys.optional} <= known for keys in ACTION_KEYS.values())


def test_a_registered_action_is_one_like_any_other(there):
    action = Action(name="there-and-back", side_m=3)
    doing = plan(Task(id="t", position=(1, 2), action=action), Robot(id="r", position=(0, 0)))
    assert (doing.points, doing.cost_m) == (((1, 2), (4, 2), (1, 2)), 6)
    with pytest.raises(MissionError, match="side_m: missing; expected a value: there-and-back needs side_m"):
        Action(name="there-and-back")
    with pytest.raises(MissionError, match="no typed cost beside there-and-back"):
        Task(id="t", position=(1, 2), action=action, actuation_cost=3)


def test_an_action_that_is_not_registered_is_unknown():
    with pytest.raises(MissionError, match="there-and-back"):
        Action(name="there-and-back", side_m=3)


def test_a_name_is_taken_once(there):
    with pytest.raises(ParameterError, match="action: there-and-back; expected a name that no action has yet"):
        register(there)


def test_keys_must_be_those_of_missions():
    with pytest.raises(
        ParameterError, match="action there-and-back: key sides; expected keys of area, cross_holes, duration_s"
    ):
        register(There(keys=ActionKeys(needed=("sides",))))
    assert "there-and-back" not in ACTIONS
