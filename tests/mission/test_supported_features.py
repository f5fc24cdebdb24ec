"""What this version cannot do is refused by planner and judge in the same words."""

import pytest

import muster
from muster.mission.errors import NotSupportedError
from muster.mission.lanes import Lane, Lanes
from muster.mission.model import Action, Mission, Robot, Rules, Station, Task, TravelTable
from muster.mission.plan import Plan
from muster.mission.source import Source
from muster.model.problem import Problem
from muster.verification import verify


def refusal(function, *arguments):
    """The one finding with which the function refuses its arguments."""
    with pytest.raises(NotSupportedError) as caught:
        function(*arguments)
    (finding,) = caught.value.findings
    return finding


def refused(mission):
    """The finding of planner and judge."""
    finding = refusal(Problem.compile, mission)
    assert refusal(verify, mission, Plan(routes=())) == finding
    return finding


def mission_of(tasks, **values):
    source = Source("m.yaml", {(): ("m.yaml", 3)})
    return Mission(robots=(Robot(id="r", position=(0, 0), type="t"),), tasks=tasks, source=source, **values)


def test_travel_tables_do_not_know_where_actions_begin():
    task = Task(id="a", position=(0, 0), action=Action(name="ground-patrol", side_m=3))
    table = TravelTable(("r", "a"), ((0.0, 1.0), (1.0, 0.0)))
    tabled = {"rules": Rules(travel="matrix"), "travel": {"t": "t.csv"}, "travel_tables": {"t": table}}
    assert str(refused(mission_of((task,), **tabled))) == (
        'm.yaml:3: tasks[0].action.name: "ground-patrol"; '
        "expected an action without geometry: travel tables know the places of robots and tasks alone"
    )


def test_a_raster_of_very_many_lanes():
    action = Action(name="raster-search", side_m=10, height_m=2, spacing_m=1e-9)
    finding = refused(mission_of((Task(id="a", position=(0, 0), action=action),)))
    assert (finding.field, finding.value) == ("tasks[0].action.spacing_m", "1e-09")
    assert finding.expected == "at least side_m / 10000: 0.001"


@pytest.mark.parametrize(
    ("robot", "tasks"),
    [
        ({}, [{"position": (1.7e308, 1.7e308)}]),
        ({}, [{"actuation_cost": 1.7e308}]),  # the total plus the maximum
        ({"speed_mps": 1e-300}, [{"actuation_cost": 1e10}]),
        ({"speed_mps": 1e-300, "return_to_start": True}, [{"position": (1e10, 0)}]),
        ({"efficiency": 1e-300}, [{"action": Action(name="sensor-activation", duration_s=1e10)}]),
        ({"available_from_s": 1.7e308}, [{"duration_s": 1.7e308}]),
        ({}, [{"action": Action(name="ground-patrol", side_m=1e151)}]),
        ({}, [{"action": Action(name="delivery", pickup=(1.7e308, 0))}]),
        ({}, [{"priority": 1.7e308}, {"priority": 1.7e308}]),
    ],
)
def test_numbers_whose_sums_may_overflow(robot, tasks):
    mission = Mission(
        robots=(Robot(id="r", position=(0, 0), **robot),),
        tasks=tuple(Task(**({"id": str(k), "position": (0, 0)} | task)) for k, task in enumerate(tasks)),
    )
    assert str(refused(mission)).endswith(
        "numbers too large or too small; expected numbers whose sums are below 1.8e308"
    )


def test_nodes_of_lanes_too_far_away_are_refused():
    lanes = Lanes(nodes={"a": (0, 0), "b": (1, -1e300)}, edges=(Lane(start="a", end="b"),))
    assert refused(mission_of((Task(id="a", position=(0, 0)),), lanes=lanes)).value == "numbers too large or too small"


def test_an_action_may_take_no_time(tmp_path):
    file = tmp_path / "mission.yaml"
    file.write_text(
        "schema: muster/1\nname: m\nrobots: [{id: r_0, position: [0, 0]}]\n"
        "tasks: [{id: a, position: [1, 0], action: {name: sensor-activation, duration_s: 0}}]\n",
        encoding="utf-8",
    )
    assert muster.load(file).tasks[0].action.duration_s == 0


FURTHER = (
    ({"shifts_s": ((0, 5), (9, 20))}, {}, {}),
    ({"longest_duty_s": 30}, {}, {}),
    ({}, {"delivers": "a", "longest_aboard_s": 9}, {}),
    ({}, {"either_or": "a"}, {}),
    ({}, {}, {"only_robots": ("r",)}),
)


def with_rule(robot, task, station):
    """A mission with a key of a rule that not all parts have known from the beginning."""
    return Mission(
        robots=(Robot(id="r", position=(0, 0), **robot),),
        tasks=(Task(id="a", position=(1, 0), load=1), Task(id="b", position=(2, 0), **task)),
        stations=(Station(id="dock", position=(3, 0), services=("unload",), **station),),
        source=Source("m.yaml", {(): ("m.yaml", 3)}),
    )


@pytest.mark.parametrize(("robot", "task", "station"), FURTHER)
def test_rules_that_runs_know_are_carried_out(robot, task, station):
    mission = with_rule(robot, task, station)
    plan = muster.solve(mission, "search", iterations=20)
    assert len(muster.simulate(mission, plan).tasks_done) == plan.tasks_completed > 0


@pytest.mark.parametrize(("robot", "task", "station"), FURTHER)
def test_rules_that_planning_knows_are_planned(robot, task, station):
    mission = with_rule(robot, task, station)
    assert verify(mission, muster.solve(mission, "search", iterations=20)).valid


@pytest.mark.parametrize(("robot", "task", "station"), FURTHER)
def test_a_mission_with_such_a_rule_is_written_and_read(robot, task, station, tmp_path):
    mission = with_rule(robot, task, station)
    mission.save(tmp_path / "m.yaml")
    text = (tmp_path / "m.yaml").read_text()
    assert "available" not in text
    again = muster.load(tmp_path / "m.yaml")
    assert (again.robots, again.tasks, again.stations) == (mission.robots, mission.tasks, mission.stations)
