from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import pytest

from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.plan import Plan, Route
from muster.verification import Verdict, verify

if find_spec("matplotlib") is None:
    collect_ignore = ["test_files.py", "test_floor.py", "test_fonts.py", "test_gantt.py", "test_routes.py"]


@pytest.fixture
def mission() -> Mission:
    """Two robots whose legs are 3-4-5 triangles; `c` waits for `d`, `e` is left out by `plan`, `idle` has no tasks."""
    return Mission(
        name="harbour",
        rules=Rules(objective="total"),
        robots=(
            Robot(id="ada", position=(0, 0), work_capacity=40),
            Robot(id="bob", position=(10, 0), return_to_start=True),
            Robot(id="idle", position=(20, 20)),
        ),
        tasks=(
            Task(id="a", position=(3, 4), actuation_cost=2),
            Task(id="b", position=(3, 10), prerequisites=("a",)),
            Task(id="c", position=(11, 10), actuation_cost=1, prerequisites=("d",)),
            Task(id="d", position=(10, 20), actuation_cost=12),
            Task(id="e", position=(0, 20)),
        ),
    )


@pytest.fixture
def plan() -> Plan:
    """`ada`: 5 m to a, 6 m to b, 8 m to c at 21 s, where it waits for d until 32 s; `bob`: 20 m to d and back."""
    return Plan(allocator="greedy", routes=(Route("ada", ("a", "b", "c")), Route("bob", ("d",))))


@pytest.fixture
def verdict(mission: Mission, plan: Plan) -> Verdict:
    return verify(mission, plan)


@pytest.fixture
def drawn() -> Callable[[Any, str], list[Any]]:
    """The artists of an axes whose group id is `name` or begins with `name-`, in the order of drawing."""

    def find(ax: Any, name: str) -> list[Any]:
        return [artist for artist in ax.get_children() if f"{artist.get_gid()}-".startswith(f"{name}-")]

    return find


@pytest.fixture
def crowd() -> Callable[..., tuple[Mission, Plan]]:
    """A mission of many tasks on a grid and its plan: robot k does tasks k, k + robots, ..."""

    def make(tasks: int, robots: int, **rules: Any) -> tuple[Mission, Plan]:
        mission = Mission(
            name="crowd",
            rules=Rules(**rules),
            robots=[Robot(id=f"r_{k}", position=(k, -5)) for k in range(robots)],
            tasks=[Task(id=f"t{k}", position=(k % 100, k // 100)) for k in range(tasks)],
        )
        routes = [Route(f"r_{k}", tuple(f"t{t}" for t in range(k, tasks, robots))) for k in range(robots)]
        return mission, Plan(routes=tuple(routes))

    return make
