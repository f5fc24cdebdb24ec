"""Solutions of vehicle routing: what is written, read back, and refused."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples

import muster
from muster.cli.main import run
from muster.mission.model import Mission, Robot, Rules, Station, Task
from muster.mission.plan import Plan, Route
from muster.mission.reading.plan_reader import read_plan
from muster_files.instances.sol_files import read_sol, sol_text

CLOSED = Rules(return_to_start=True, objective="total")
HOME = (0.0, 0.0)


def mission(ids, robots=3):
    team = tuple(Robot(id=f"r_{k}", position=HOME) for k in range(robots))
    return Mission(rules=CLOSED, robots=team, tasks=tuple(Task(id=name, position=(3, 4)) for name in ids))


def text_of(given, routes):
    return muster.export(given, {f"r_{k}": names for k, names in enumerate(routes)}, "sol").texts["plan.sol"]


def test_routes_and_cost():
    assert text_of(mission("123"), [["3", "1"], [], ["2"]]) == "Route #1: 3 1\nRoute #2: 2\nCost 20\n"


def test_a_cost_that_is_no_whole_number_is_written_in_full():
    given = replace(mission("1"), tasks=(Task(id="1", position=(1, 1)),))
    assert text_of(given, [["1"], [], []]).splitlines()[-1] == f"Cost {2 * 2**0.5}"


def test_nodes_from_2_on_are_customers_from_1_on():
    given = mission("234")
    assert text_of(given, [["3", "4"], ["2"], []]) == "Route #1: 2 3\nRoute #2: 1\nCost 20\n"


def test_other_ids_stand_as_they_are():
    assert text_of(mission(["C30", "C7"]), [["C7", "C30"], [], []]).startswith("Route #1: C7 C30\n")
    assert text_of(mission("135"), [["1", "3", "5"], [], []]).startswith("Route #1: 1 3 5\n")
    with pytest.raises(muster.ParameterError, match='--to sol: "a b"; expected ids without spaces'):
        text_of(mission(["a b"]), [["a b"], [], []])


def test_stations_stand_in_their_places():
    station = Station(id="S5", position=(1, 1), services=("charge",), charge_per_s=1)
    given = replace(mission("23"), stations=(station,))
    assert sol_text(given, [["2", "S5", "3"]], 12.0) == "Route #1: 1 S5 2\nCost 12\n"


@pytest.fixture
def read(tmp_path):
    def read(text, given, name="x.sol"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return read_plan(path, given)

    return read


def test_a_published_file_is_read(read):
    plan = read("Route #1: 2 3\nRoute #2: 1\nCost 27591\n", mission("234"))
    assert plan == Plan(routes=(Route("r_0", ("3", "4")), Route("r_1", ("2",)), Route("r_2", ())))


def test_other_spellings(read):
    text = "Instance name : lc101\nAuthors : X\nReference : Y\nSolution\nRoute 1 : 2 3\nroute  2: 1 \n"
    assert [route.tasks for route in read(text, mission("123"), "lc101.txt").routes] == [("2", "3"), ("1",), ()]


def test_a_plan_in_json_is_one_beside_a_mission_too(tmp_path):
    given = mission("123")
    plan = muster.solve(given, "greedy")
    plan.save(tmp_path / "plan.json")
    assert read_plan(tmp_path / "plan.json", given) == plan


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "x.sol: Route: missing; expected lines such as Route #1: 5 3 2"),
        ("Cost 3\n", "x.sol: Route: missing"),
        (
            "Route #1: 1\nRoute #2: 2\nRoute #3:\nRoute #4: 3\n",
            r"x.sol:4: Route: 3 routes; expected at most 2, the robots of the mission; --salesmen M gives",
        ),
    ],
)
def test_what_is_no_solution_of_the_mission(text, message, read):
    with pytest.raises(muster.PlanError, match=message):
        read(text, mission("123", robots=2))


def test_verify_says_what_is_wrong_with_the_routes(read):
    given = mission("123")
    verdict = muster.verify(given, read("Route #1: 1 2 9\nRoute #2: 1\n", given))
    assert {"unknown-task", "repeated-task"} <= {found.kind for found in verdict.violations}


@examples(60)
@given(st.permutations([str(k) for k in range(2, 12)]), st.sets(st.integers(1, 9), max_size=2))
def test_what_is_written_is_read_back(order, cuts):
    ends = [0, *sorted(cuts), 10]
    routes = [tuple(order[a:b]) for a, b in pairwise(ends)]
    given = mission([str(k) for k in range(2, 12)])
    plan = read_sol(Path("x.sol"), sol_text(given, routes, 1.5), given)
    assert [route.tasks for route in plan.routes if route.tasks] == routes


def test_every_verb_that_takes_a_plan_takes_a_solution(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    nodes = "1 0 0\n2 3 4\n3 6 1\n4 0 8\n"
    head = "TYPE : CVRP\nDIMENSION : 4\nEDGE_WEIGHT_TYPE : EUC_2D\nCAPACITY : 9\n"
    text = f"{head}NODE_COORD_SECTION\n{nodes}DEMAND_SECTION\n1 0\n2 4\n3 5\n4 6\n"
    Path("four.vrp").write_text(text, encoding="utf-8")
    Path("four.sol").write_text("Route #1: 1 2\nRoute #2: 3\nCost 31\n", encoding="utf-8")
    assert run(["export", "four.vrp", "four.sol", "--to", "sol"]) == 0
    assert capsys.readouterr().out == "Route #1: 1 2\nRoute #2: 3\nCost 31\n"
    for verb in (["verify", "four.vrp", "four.sol"], ["explain", "four.vrp", "four.sol", "--task", "2"]):
        assert run(verb) == 0
    assert run(["solve", "four.vrp", "--start", "four.sol", "--iterations", "5"]) == 0
    Path("four.sol").write_text("Route #1: 9\n", encoding="utf-8")
    assert run(["verify", "four.vrp", "four.sol", "--format", "json"]) == 1
