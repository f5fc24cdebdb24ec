"""Batteries stated by time or length: what they are in the unit of usage; no drone flies longer than it can."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples

from muster import MissionError, solve, verify
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.yaml_writer import yaml_text

MISSION = """\
schema: muster/1
rules: {{{rules}}}
robots: [{{id: r, position: [0, 0], speed_mps: 10, {robot}}}]
tasks: [{{id: a, position: [100, 0]}}, {{id: b, position: [0, 50], {task}}}]
{more}
"""
AIR = "kind: air"


def mission(robot, rules="", task="", more=""):
    return parse_yaml(MISSION.format(robot=robot, rules=rules, task=task, more=more), "m.yaml")


@pytest.mark.parametrize(
    ("robot", "rules", "capacity"),
    [
        ("endurance_s: 600", "usage: time", 600),
        ("range_m: 5000", "usage: time", 500),
        ("endurance_s: 600, range_m: 5000", "usage: time", 500),
        ("endurance_s: 400, range_m: 5000", "usage: time", 400),
        ("range_m: 5000", "", 5000),
        ("endurance_s: 600", "", 6000),
        ("endurance_s: 600, range_m: 5000", "", 5000),
        ("endurance_s: 600, acceleration_mps2: 1", "timing: constant", 6000),
        ("endurance_s: 600, acceleration_mps2: 1", "usage: time", 600),
    ],
)
@pytest.mark.parametrize("kind", ["air", "ground"])
def test_what_a_time_or_a_length_is_in_the_unit_of_usage(robot, rules, capacity, kind):
    found = mission(f"{robot}, kind: {kind}", rules)
    assert found.robots[0].battery.capacity == capacity
    assert parse_yaml(yaml_text(found), "again.yaml") == found


@pytest.mark.parametrize(
    ("robot", "task", "more", "reason"),
    [
        ("endurance_s: 600, acceleration_mps2: 1", "", "", "with acceleration_mps2 travel takes longer"),
        ("endurance_s: 600, kind: air, climb_mps: 1", "", "", "with climb_mps travel takes longer"),
        ("endurance_s: 600", "duration_s: 60", "", "work with a duration_s draws nothing from a battery in metres"),
        ("range_m: 6000, kind: air", "duration_s: 60", "", "work with a duration_s draws nothing from a battery"),
        (
            "endurance_s: 600",
            "",
            "lanes: {nodes: {n: [0, 0], m: [100, 0]}, edges: [{from: n, to: m, speed_mps: 1}]}",
            "lanes with a speed_mps take longer",
        ),
    ],
)
def test_what_metres_do_not_count_needs_usage_in_time(robot, task, more, reason):
    with pytest.raises(MissionError, match=reason) as caught:
        mission(robot, "", task, more)
    assert "rules: {usage: time} beside it" in str(caught.value)
    assert mission(robot, "usage: time", task, more).robots[0].battery.capacity == 600


@pytest.mark.parametrize(
    ("robot", "message"),
    [
        ("endurance_s: 0", r"endurance_s: 0; expected a finite number, above 0"),
        ("range_m: far", r'range_m: "far"; expected a finite number, above 0'),
        ("endurance_s: 600, battery: {capacity: 5}", "battery or endurance_s, not both"),
        ("endurance: 600", "unknown key; expected a known key; did you mean 'endurance_s'"),
    ],
)
def test_what_is_no_time_or_length(robot, message):
    with pytest.raises(MissionError, match=message):
        mission(robot, "usage: time")


DOCK = "stations: [{id: dock, position: [0, 0], services: [swap]}]"


@pytest.mark.parametrize("task", ["window_s: [900, 1000]", "prerequisites: [a]"])
def test_a_drone_that_waits_flies(task):
    found = mission(f"endurance_s: 600, available_from_s: 100, {AIR}", "usage: time", task)
    assert found.robots[0].available_until_s == 700
    ends = mission(f"endurance_s: 600, available_until_s: 300, {AIR}", "usage: time", task)
    assert ends.robots[0].available_until_s == 300
    assert mission("endurance_s: 600", "usage: time", task).robots[0].available_until_s is None
    with pytest.raises(
        MissionError, match=r"endurance_s: 600.0; expected battery: \{capacity: ...\}, with room for wait"
    ):
        mission(f"endurance_s: 600, {AIR}", "usage: time", task, DOCK)
    assert mission(f"endurance_s: 600, {AIR}", "usage: time", "", DOCK).robots[0].battery.capacity == 600


robots = st.tuples(st.sampled_from(["endurance_s", "range_m"]), st.integers(5, 60), st.integers(1, 12))
tasks = st.lists(
    st.tuples(
        st.integers(-200, 200),
        st.integers(-200, 200),
        st.sampled_from(["", "duration_s: 7", "actuation_cost: 20", "window_s: [20, 40]", "prerequisites: ['0']"]),
    ),
    min_size=1,
    max_size=5,
)


@examples(40)
@given(robots, tasks, st.sampled_from(["usage: time", "", "return_to_start: true, usage: time"]))
def test_no_drone_flies_longer_or_farther_than_it_can(robot, tasks, rules):
    key, amount, speed = robot
    amount *= speed if key == "range_m" else 1
    lines = [f"{{id: '{k}', position: [{x}, {y}], {more if k else ''}}}" for k, (x, y, more) in enumerate(tasks)]
    one = f"{{id: r, position: [0, 0], kind: air, {key}: {amount}, speed_mps: {speed}}}"
    text = f"schema: muster/1\nrules: {{{rules}}}\nrobots: [{one}]\ntasks: [{', '.join(lines)}]\n"
    try:
        found = parse_yaml(text, "m.yaml")
    except MissionError as error:
        assert "rules: {usage: time} beside it" in str(error)  # noqa: PT017
        return
    verdict = verify(found, solve(found, iterations=50, seed=1))
    assert verdict.valid
    (route,) = verdict.routes
    if route.stops:
        ends = route.stops[-1].ends_s if route.back_s is None else route.back_s
        longest = amount / speed if key == "range_m" else amount
        assert ends - route.leaves_s <= longest + 1e-6
