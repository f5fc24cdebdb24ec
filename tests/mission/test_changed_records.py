"""Records of missions that are made from others: what stays is not checked again, and all else is as if it were."""

import dataclasses
import pkgutil
from collections.abc import Iterator
from importlib import import_module

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from tests.mission.strategies import missions

import muster.mission
from muster.mission.errors import MissionError, MusterError, ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.records import Checked, specified


def kinds_of_records() -> Iterator[type[Checked]]:
    for module in pkgutil.walk_packages(muster.mission.__path__, "muster.mission."):
        import_module(module.name)
    waiting = [Checked]
    while waiting:
        waiting += (kind := waiting.pop()).__subclasses__()
        if dataclasses.is_dataclass(kind):
            yield kind


def test_every_default_is_read_as_itself():
    """So a default need not be read when a record is made."""
    seen = 0
    for kind in kinds_of_records():
        for field in specified(kind):
            if field.default is dataclasses.MISSING or field.default is None:
                continue
            faults = []
            read = field.metadata["kind"].read(field.default, (field.name,), faults)
            assert not faults, (kind, field.name)
            assert (read, type(read)) == (field.default, type(field.default)), (kind, field.name)
            seen += 1
    assert seen > 50


@given(missions(), st.data())
def test_a_changed_record_is_the_one_that_is_made_anew(mission: Mission, data: st.DataObject):
    records = [*mission.robots, *mission.tasks]
    one = data.draw(st.sampled_from(records))
    other = data.draw(st.sampled_from([record for record in records if type(record) is type(one)]))
    names = [f.name for f in dataclasses.fields(one) if f.name != "extra"]
    values = {name: getattr(other, name) for name in data.draw(st.lists(st.sampled_from(names), max_size=4))}
    assert outcome(lambda: one.changed(**values)) == outcome(lambda: dataclasses.replace(one, **values))


@given(missions(), st.data())
def test_what_is_left_of_a_mission_is_the_one_that_is_made_anew(mission: Mission, data: st.DataObject):
    count = data.draw(st.integers(1, len(mission.robots)))
    changes = {"robots": mission.robots[:count], "tasks": (), "travel": None, "rules": mission.rules.changed()}
    made = outcome(lambda: mission.at_once(**changes))
    assume(not isinstance(made[0], type))  # it is one
    assert outcome(lambda: mission.what_is_left(**changes)) == made


def outcome(make):
    """The record with all its fields, or the error."""
    try:
        made = make()
    except MusterError as error:
        return type(error), str(error)
    return made, {f.name: getattr(made, f.name) for f in dataclasses.fields(made)}


def test_what_is_changed_is_checked():
    robot = Robot(id="r", position=(0, 0), skills=("saw",), skill_quality={"saw": 0.5})
    assert robot.changed(position=[1, 2]).position == (1.0, 2.0)
    with pytest.raises(MissionError, match=r"speed_mps: -1"):
        robot.changed(speed_mps=-1)
    with pytest.raises(MissionError, match=r"skill_quality\.saw"):
        robot.changed(skills=())
    with pytest.raises(ParameterError, match=r"Robot: spede_mps: unknown"):
        robot.changed(spede_mps=1)
    with pytest.raises(ParameterError, match=r"Task: extra: unknown"):
        Task(id="a", position=(0, 0)).changed(extra={})
