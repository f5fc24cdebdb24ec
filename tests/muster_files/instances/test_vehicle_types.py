"""Instance files of several depots, sites and kinds of vehicles; remarks, zeros and exact distances in them."""

from pathlib import Path

import pytest
from tests.raw_counts import raw_count

import muster
from muster.mission.errors import MissionError
from muster.planning.loading import load_noted

CASES = Path(__file__).parents[2] / "data" / "cases" / "import"
NODES = """NAME : own
COMMENT : first
COMMENT : second
TYPE : {kind}
DIMENSION : 4
EDGE_WEIGHT_TYPE : EUC_2D
VEHICLES : 2
{head}
NODE_COORD_SECTION
# a remark
0001 0 0
0002 100 0
0003 10 0
0004 90 0.5
DEMAND_SECTION
1 0
2 0
3 4
4 5
TIME_WINDOW_SECTION
1 0 500
2 10 400
3 0 500
4 0 500
{sections}
DEPOT_SECTION
01
2
-1
EOF
after the end
"""
DEPOTS = "VEHICLES_DEPOT_SECTION\n1 1\n2 0002"
CAPACITY = "CAPACITY : 10"


def write(folder, kind="MDVRPTW", head=CAPACITY, sections=DEPOTS):
    file = folder / "own.vrp"
    file.write_text(NODES.format(kind=kind, head=head, sections=sections), encoding="utf-8")
    return file


def refusal(file, **flags):
    with pytest.raises(MissionError) as error:
        muster.load(file, **flags)
    return str(error.value)


def assert_complete(found, file):
    assert raw_count(file) == found.ledger.read + found.ledger.passed_over


def test_vehicles_start_at_their_depots_within_their_hours(tmp_path):
    found = load_noted(write(tmp_path))
    first, second = found.mission.robots
    assert (first.position, second.position) == ((0, 0), (100, 0))
    assert (second.available_from_s, second.available_until_s) == (10, 400)
    assert [task.id for task in found.mission.tasks] == ["3", "4"]
    assert found.mission.travel is None
    assert found.mission.rules.return_to_start
    assert_complete(found, tmp_path / "own.vrp")
    lost = {row.kind: (row.said, row.count) for row in found.ledger.not_read}
    assert lost["COMMENT"] == ("is a text for people", 2)
    assert lost["remark"] == ("is a text for people", 1)
    assert lost["line"] == ("stands after EOF", 1)


def test_a_keyword_that_nobody_knows_is_named(tmp_path):
    found = load_noted(write(tmp_path, head=f"{CAPACITY}\nSPEED_LIMIT : 3"))
    assert any("SPEED_LIMIT" in line for line in found.said)
    twice = refusal(write(tmp_path, head=f"{CAPACITY}\n{CAPACITY}"))
    assert "CAPACITY: for the second time; expected each keyword once" in twice


def test_customers_are_served_by_the_vehicles_that_may(tmp_path):
    sections = f"{DEPOTS}\nVEHICLES_ALLOWED_CLIENTS_SECTION\n1 3\n2 3 004 -1"
    mission = muster.load(write(tmp_path, "SDVRPTW", sections=sections))
    assert [task.only_robots for task in mission.tasks] == [("r_0", "r_1"), ("r_1",)]
    plan = muster.solve(mission, iterations=100, seed=1)
    assert {route.robot: route.tasks for route in plan.routes}["r_1"].count("4") == 1


def test_vehicles_have_their_own_capacities_and_limits(tmp_path):
    sections = f"{DEPOTS}\nCAPACITY_SECTION\n1 4\n2 9\nVEHICLES_MAX_DISTANCE_SECTION\n1 50\n2 60"
    mission = muster.load(write(tmp_path, "HFVRPTW", head="", sections=sections))
    assert [(robot.load_capacity, robot.work_capacity) for robot in mission.robots] == [(4, 50), (9, 60)]


DURATIONS = f"{DEPOTS}\nVEHICLES_MAX_DURATION_SECTION\n1 9\n2 9"
COSTS = f"{DEPOTS}\nVEHICLES_FIXED_COST_SECTION\n1 9\n2 9"


@pytest.mark.parametrize(
    ("kind", "head", "sections", "said"),
    [
        ("MDVRPTW", CAPACITY, "", 'DEPOT_SECTION: "2"; expected one depot, then -1; or a VEHICLES_DEPOT_SECTION'),
        ("SDVRPTW", CAPACITY, DEPOTS, "TYPE: SDVRPTW; expected a VEHICLES_ALLOWED_CLIENTS_SECTION"),
        ("HFVRP", "", DEPOTS, "TYPE: HFVRP; expected a CAPACITY_SECTION"),
        ("MDVRPTW", CAPACITY, "VEHICLES_DEPOT_SECTION\n1 1\n2 3", 'VEHICLES_DEPOT_SECTION: "3"; expected a depot'),
        ("MDVRPTW", CAPACITY, "VEHICLES_DEPOT_SECTION\n1 1", "1 lines; expected a line for each vehicle, from 1 to 2"),
        ("MDVRPTW", CAPACITY, "VEHICLES_DEPOT_SECTION\n1 1\n3 2", '"3 2"; expected a line for each vehicle'),
        ("MDVRPTW", CAPACITY, f"{DEPOTS}\nCAPACITY_SECTION\n1 4\n2 none", '"2 none"; expected the number of a vehicle'),
        ("SDVRPTW", CAPACITY, f"{DEPOTS}\nVEHICLES_ALLOWED_CLIENTS_SECTION\n1 3\n2 3", "no vehicle for customer 4"),
        ("MDVRPTW", CAPACITY, DURATIONS, "no longest duration beside time windows"),
        ("MDVRPTW", CAPACITY, COSTS, "VEHICLES_FIXED_COST_SECTION: not supported"),
        (
            "MDVRPTW",
            f"{CAPACITY}\nVEHICLES_MAX_DURATION : 90",
            DEPOTS,
            ": 90; expected no longest duration beside time",
        ),
        ("MDVRPTW", f"{CAPACITY}\nVEHICLES_FIXED_COST : 90", DEPOTS, "VEHICLES_FIXED_COST: not supported; expected"),
    ],
)
def test_what_a_mission_cannot_say_is_refused(kind, head, sections, said, tmp_path):
    assert said in refusal(write(tmp_path, kind, head, sections))


def test_a_fleet_of_unlike_vehicles_is_as_large_as_the_file_says(tmp_path):
    told = refusal(write(tmp_path), salesmen=3)
    assert "salesmen: 3; expected 2, as each vehicle of the file has values of its own" in told


def test_limits_of_all_vehicles_are_those_of_robots(tmp_path):
    head = f"{CAPACITY}\nVEHICLES_MAX_DISTANCE : 70\nVEHICLES_MAX_DURATION : 500"
    assert [robot.work_capacity for robot in muster.load(write(tmp_path, head=head)).robots] == [70, 70]


@pytest.mark.parametrize("name", ["comment.vrp", "two-depots.vrp"])
def test_instances_of_others_are_read(name):
    found = load_noted(CASES / name)
    assert_complete(found, CASES / name)
    plan = muster.solve(found.mission, iterations=100, seed=1)
    assert muster.verify(found.mission, plan).valid
    assert not plan.unassigned


@pytest.mark.parametrize("remark", ["# x : 3", "// DIMENSION : 9", "% x", "! x", "; x"])
def test_remarks_of_any_kind_are_passed_over(remark, tmp_path):
    text = (CASES / "comment.vrp").read_text(encoding="utf-8").replace("# a remark", remark)
    (tmp_path / "a.vrp").write_text(text.replace("2 10 0", "2 10 0 # here").replace(": 10", ": 10 // each"), "utf-8")
    found = load_noted(tmp_path / "a.vrp")
    assert [(task.id, task.load) for task in found.mission.tasks] == [("2", 4), ("3", 5), ("4", 6)]
    assert found.mission.robots[0].load_capacity == 10
    assert_complete(found, tmp_path / "a.vrp")


@pytest.mark.parametrize("depot", ["1", "0001", "01"])
def test_zeros_before_the_number_of_a_node_say_nothing(depot):
    mission = muster.load(CASES / "zeros.tsp", salesmen=1, depot=depot)
    assert [task.id for task in mission.tasks] == ["2", "3", "4"]


@pytest.mark.parametrize(("suffix", "kind"), [("tsp", "TSP"), ("vrp", "CVRP")])
def test_exact_distances_are_not_rounded(suffix, kind, tmp_path):
    file = tmp_path / f"own.{suffix}"
    file.write_text(
        f"NAME : own\nTYPE : {kind}\nDIMENSION : 3\nEDGE_WEIGHT_TYPE : EXACT_2D\nCAPACITY : 9\nNODE_COORD_SECTION\n"
        "1 0 0\n2 0.5 0.5\n3 1 1\nEOF\n",
        encoding="utf-8",
    )
    mission = muster.load(file, salesmen=1)
    plan = muster.solve(mission, iterations=50, seed=1)
    assert muster.verify(mission, plan).total_cost == pytest.approx(2 * 2**0.5)


CORDEAU = """6 2 2 2
0 9
0 20
1 10 0 3 4 1 2 1 2 0 500
2 90 0 5 6 1 1 1 10 400
3 0 0 0 0 0 0 0 1000
4 100 0 0 0 0 0 5 900
"""
"""Depots 3 and 4 with two vehicles each; customer 2 is served from the second depot alone (code 1: the right bit)."""


def test_the_layout_of_cordeau_has_depots_with_vehicles(tmp_path):
    file = tmp_path / "pr.txt"
    file.write_text(CORDEAU, encoding="utf-8")
    found = load_noted(file)
    robots, tasks = found.mission.robots, found.mission.tasks
    assert [(r.position, r.load_capacity, r.available_from_s) for r in robots] == [
        *[((0, 0), 9, 0)] * 2,
        *[((100, 0), 20, 5)] * 2,
    ]
    assert [(t.id, t.duration_s, t.load, t.only_robots) for t in tasks] == [
        ("1", 3, 4, None),
        ("2", 5, 6, ("r_2", "r_3")),
    ]
    assert muster.verify(found.mission, muster.solve(found.mission, iterations=100, seed=1)).valid
    assert_complete(found, file)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (CORDEAU.replace("6 2 2 2", "1 2 2 2"), "type: 1; expected one of 0, 2, 3, 4, 6, 7: no periods of days"),
        (CORDEAU.replace("0 9", "300 9", 1), ":2: longest duration: 300; expected 0, or the depot's whole window"),
        (CORDEAU.replace("1 10 0 3 4 1 2", "1 10 0 3 4 2 2"), ":4: frequency: 2; expected 1: one visit"),
        (CORDEAU.replace("4 100 0 0 0 0 0 5 900\n", ""), "3 nodes; expected 4 with the depots"),
        (CORDEAU.replace("0 500", "500"), ":4: node: "),
    ],
)
def test_what_is_wrong_in_the_layout_of_cordeau_is_refused(text, said, tmp_path):
    file = tmp_path / "pr.txt"
    file.write_text(text, encoding="utf-8")
    assert said in refusal(file)


def test_kinds_of_vehicles_in_the_layout_of_cordeau(tmp_path):
    file = tmp_path / "sd.txt"
    file.write_text("3 1 2 2\n50 9\n60 20\n0 0 0 0 0 0 0\n1 5 0 1 2 1 1 2\n2 9 0 1 2 1 2 1 2\n", encoding="utf-8")
    mission = muster.load(file)
    assert [(r.load_capacity, r.available_until_s) for r in mission.robots] == [(9, 50), (20, 60)]
    assert [task.only_robots for task in mission.tasks] == [("r_0",), None]
