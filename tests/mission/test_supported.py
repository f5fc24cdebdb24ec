"""What this version cannot do is refused by planner and judge in the same words."""

import pytest

from muster.allocation.problem import Problem
from muster.mission.errors import NotSupportedError
from muster.mission.model import Action, Mission, Robot, Task
from muster.mission.plan import Plan
from muster.mission.source import Source
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


@pytest.mark.parametrize(
    ("mission", "field", "value"),
    [
        (
            {"tasks": (Task(id="a", position=(0, 0), action=Action(name="ground-patrol", side_m=3)),)},
            "tasks[0].action.name",
            "ground-patrol",
        ),
    ],
)
def test_what_is_not_supported_yet(mission, field, value):
    parts = {"robots": (Robot(id="r", position=(0, 0)),), "tasks": (), "source": Source("m.yaml", {(): ("m.yaml", 3)})}
    finding = refused(Mission(**(parts | mission)))
    assert (finding.file, finding.line, finding.field) == ("m.yaml", 3, field)
    assert value in finding.value
    assert finding.expected.endswith("not supported yet")


@pytest.mark.parametrize(
    ("robot", "tasks"),
    [
        ({}, [{"position": (1.7e308, 1.7e308)}]),
        ({}, [{"actuation_cost": 1.7e308}]),  # the total plus the maximum
        ({"speed_mps": 1e-300}, [{"actuation_cost": 1e10}]),
        ({"speed_mps": 1e-300, "return_to_start": True}, [{"position": (1e10, 0)}]),
        ({"efficiency": 1e-300}, [{"action": Action(name="sensor-activation", duration_s=1e10)}]),
        ({"available_from_s": 1.7e308}, [{"duration_s": 1.7e308}]),
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
