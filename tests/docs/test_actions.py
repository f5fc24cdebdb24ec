"""What docs/actions.md says is so."""

import re
from pathlib import Path

import pytest

import muster
from muster.mission.action_keys import ACTION_KEYS
from muster.mission.reading.yaml_reader import parse_yaml
from muster.motion.actions import ACTIONS

TEXT = (Path(__file__).parents[2] / "docs" / "actions.md").read_text(encoding="utf-8")


def block(language):
    (found,) = re.findall(rf"```{language}\n(.*?)```", TEXT, flags=re.DOTALL)
    return found


def test_the_mission_can_be_done():
    mission = parse_yaml(block("yaml"), "actions.yaml")
    assert {task.action.name for task in mission.tasks} == set(ACTIONS)
    plan = muster.solve(mission, iterations=100)
    assert plan.complete
    assert muster.verify(mission, plan).valid


def test_the_table_has_every_action_with_its_keys():
    rows = re.findall(r"^\| `([a-z-]+)`[^|]*\|([^|]*)\|", TEXT, flags=re.MULTILINE)
    table = {name: set(re.findall(r"`([a-z_]+)`", keys)) for name, keys in rows}
    assert table == {name: {*keys.needed, *keys.optional} for name, keys in ACTION_KEYS.items()}


@pytest.fixture
def forgotten():
    """What an example registers is forgotten after it."""
    kept = set(ACTIONS)
    yield
    for name in set(ACTIONS) - kept:
        ACTIONS.remove(name)
        ACTION_KEYS.remove(name)


@pytest.mark.usefixtures("forgotten")
def test_a_new_action_takes_less_than_forty_lines(capsys):
    example = block("python")
    assert len(example.splitlines()) < 40
    exec(compile(example, "actions.md", "exec"), {"__name__": "example"})
    assert float(capsys.readouterr().out) == pytest.approx(24.42, abs=0.005)
