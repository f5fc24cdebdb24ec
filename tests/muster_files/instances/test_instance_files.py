"""Instance files of vehicle routing: each layout as a mission, known by content; and any text as a message."""

import json
from importlib.resources import as_file, files
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples

import muster
from muster.cli.main import run
from muster.mission.errors import MissionError, NotSupportedError, ParameterError
from muster.mission.model import Battery, Rules, Task
from muster_files.instances.instance_files import instance_form
from muster_files.instances.solomon import read_solomon

SOLOMON = """TINY

VEHICLE
NUMBER     CAPACITY
  3         20

CUSTOMER
CUST NO.  XCOORD.   YCOORD.    DEMAND   READY TIME  DUE DATE   SERVICE   TIME

    0      40         50          0          1       1236          0
    1      45         68         10        912        967         90
    2      45         70         12.5      825        870          0
"""
LI_LIM = """2\t20\t1
0\t40\t50\t0\t0\t1236\t0\t0\t0
1\t45\t68\t-10\t912\t967\t90\t2\t0
2\t45\t70\t10\t0\t870\t90\t0\t1
"""
ELECTRIC = """StringID   Type       x          y          demand     ReadyTime  DueDate    ServiceTime
D0         d          40.0       50.0       0.0        0.0        1236.0     0.0
S0         f          40.0       50.0       0.0        0.0        1236.0     0.0
S5         f          31.0       84.0       0.0        0.0        1236.0     0.0
C30        c          20.0       55.0       10.0       355.0      407.0      90.0
C12        c          25.0       85.0       20.0       176.0      228.0      90.0

Q Vehicle fuel tank capacity /60.0/
C Vehicle load capacity /200.0/
r fuel consumption rate /0.5/
g inverse refueling rate /4.0/
v average Velocity /2.0/
"""
CVRP = """NAME : four-k2
COMMENT : (own, Min no of trucks: 2)
TYPE : CVRP
DIMENSION : 4
EDGE_WEIGHT_TYPE : EUC_2D
CAPACITY : 9
NODE_COORD_SECTION
1 0 0
2 3 4
3 6 1
4 0 8
DEMAND_SECTION
1 0
2 4
3 5
4 6
DEPOT_SECTION
 1
 -1
EOF
"""
TIMES = """TIME_WINDOW_SECTION
1 0 90
2 10 50
3 0 60
4 0 50
SERVICE_TIME_SECTION
1 0
2 5
3 0
4 7
"""
PAIRS = """PICKUP_AND_DELIVERY_SECTION
1 0 0 90 0 0 0
2 4 0 50 5 0 4
3 5 0 50 5 0 0
4 -4 0 80 5 2 0
EOF
"""
ALL = {"solomon": SOLOMON, "li-lim": LI_LIM, "electric": ELECTRIC, "cvrp": CVRP, "times": CVRP.replace("EOF\n", TIMES)}


@pytest.fixture
def loaded(tmp_path):
    def load(text, name="tiny.txt", **flags):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return muster.load(path, **flags)

    return load


def test_solomon(loaded):
    mission = loaded(SOLOMON)
    assert mission.name == "TINY-3"
    assert mission.rules == Rules(objective="total", return_to_start=True)
    assert [robot.id for robot in mission.robots] == ["r_0", "r_1", "r_2"]
    robot = mission.robots[0]
    assert (robot.position, robot.load_capacity, robot.speed_mps) == ((40, 50), 20, 1)
    assert (robot.available_from_s, robot.available_until_s) == (1, 1236)
    first = Task(id="1", position=(45, 68), load=10, window_s=((912, 967),), duration_s=90)
    assert mission.tasks == (first, Task(id="2", position=(45, 70), load=12.5, window_s=((825, 870),)))


@pytest.mark.parametrize("name", ["C101", "C201", "R101", "R201", "RC101"])
def test_the_solomon_files_that_ship(name):
    with as_file(files("muster_studies.instances") / "solomon_instances" / f"{name}.txt") as path:
        mission = muster.load(path)
        assert mission == read_solomon(path, 25)
    assert mission.name == f"{name}-25"
    assert [task.id for task in mission.tasks] == [str(k) for k in range(1, 101)]
    assert all(task.load > 0 and task.duration_s > 0 and len(task.window_s) == 1 for task in mission.tasks)


def test_a_file_of_a_thousand_customers(loaded):
    rows = "".join(f"{k} {k % 50} {k // 50} {k % 7} {k} {k + 900} 10\n" for k in range(1, 1001))
    head = SOLOMON.partition("    1      45")[0].replace("TINY", "C1_10_1").replace("  3  ", "  250  ")
    mission = loaded(head + rows)
    assert (mission.name, len(mission.robots), len(mission.tasks)) == ("C1_10_1-250", 250, 1000)
    assert mission.tasks[6].load is None  # nothing is asked for


def test_li_and_lim(loaded):
    mission = loaded(LI_LIM)
    assert mission.name == "tiny-2"
    assert [robot.load_capacity for robot in mission.robots] == [20, 20]
    delivery, pickup = mission.tasks
    assert delivery == Task(id="1", position=(45, 68), delivers="2", window_s=((912, 967),), duration_s=90)
    assert pickup == Task(id="2", position=(45, 70), load=10, window_s=((0, 870),), duration_s=90)


def test_electric_vehicles(loaded):
    mission = loaded(ELECTRIC)
    assert mission.name == "tiny-2"  # as many robots as customers
    robot = mission.robots[0]
    assert (robot.load_capacity, robot.speed_mps, robot.battery) == (200, 2, Battery(capacity=120))
    assert [station.id for station in mission.stations] == ["S0", "S5"]
    station = mission.stations[1]
    assert (station.position, station.services, station.slots) == ((31, 84), ("charge",), 2)
    assert (station.charge_per_s, station.partial) == (0.5, False)  # 1 / 4 of energy a second, 2 m for each
    assert mission.tasks[0] == Task(id="C30", position=(20, 55), load=10, window_s=((355, 407),), duration_s=90)
    assert [station.slots for station in loaded(ELECTRIC, salesmen=7).stations] == [7, 7]


def test_capacitated_routing_has_the_lengths_of_tsplib(loaded):
    mission = loaded(CVRP, "four.vrp")
    assert mission.name == "four-k2-3"  # 1.3 * 15 / 9 + 3 are more than customers
    assert [task.load for task in mission.tasks] == [4, 5, 6]
    assert [robot.load_capacity for robot in mission.robots] == [9] * 3
    assert mission.rules == Rules(objective="total", return_to_start=True, travel="matrix")
    verdict = muster.verify(mission, {"r_0": ["2", "3"], "r_1": ["4"]})
    assert verdict.total_cost == 5 + 4 + 6 + 8 + 8  # sqrt(18) = 4.2, sqrt(37) = 6.1
    assert loaded(CVRP, "four.txt", salesmen=2).name == "four-k2-2"


def test_the_fleet_of_a_capacitated_file():
    """A third more than the demand fills, and three; one a customer at most."""
    head, _, _ = CVRP.partition("NODE")
    rows = range(1, 41)
    nodes = "".join(f"{k} {k} {k % 5}\n" for k in rows)
    demands = "".join(f"{k} {int(k > 1)}\n" for k in rows)
    text = f"{head.replace(': 4', ': 40')}NODE_COORD_SECTION\n{nodes}DEMAND_SECTION\n{demands}"
    path = Path("forty.vrp")
    path.write_text(text, encoding="utf-8")
    assert len(muster.load(path).robots) == 9  # 1.3 * 39 / 9 = 5.6
    path.write_text(text.replace("CAPACITY", "VEHICLES : 6\nCAPACITY"), encoding="utf-8")
    assert len(muster.load(path).robots) == 6
    assert len(muster.load(path, salesmen=4).robots) == 4


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_routing_with_times_is_real_valued(loaded):
    mission = loaded(ALL["times"].replace("CVRP", "VRPTW"), "four.vrp")
    assert mission.rules.travel is None
    assert len(mission.robots) == 3
    assert {(robot.available_from_s, robot.available_until_s) for robot in mission.robots} == {(0, 90)}
    assert mission.tasks[0] == Task(id="2", position=(3, 4), load=4, window_s=((10, 50),), duration_s=5)
    assert mission.tasks[1].duration_s is None


def test_service_that_takes_as_long_everywhere_and_a_longest_route(loaded):
    mission = loaded(CVRP.replace("CAPACITY", "DISTANCE : 33\nSERVICE_TIME : 6\nCAPACITY"), "four.vrp")
    assert mission.rules.travel is None
    assert [task.duration_s for task in mission.tasks] == [6, 6, 6]
    assert [robot.available_until_s for robot in mission.robots] == [33] * 3
    windows = CVRP.replace("CAPACITY", "DISTANCE : 33\nCAPACITY").replace("EOF\n", TIMES)
    assert [robot.work_capacity for robot in loaded(windows, "four.vrp").robots] == [33] * 3


def test_pickup_and_delivery(loaded):
    text = CVRP.partition("DEMAND_SECTION")[0].replace("CVRP", "PDPTW") + PAIRS
    mission = loaded(text, "four.vrp")
    assert [(task.load, task.delivers) for task in mission.tasks] == [(4, None), (5, None), (None, "2")]
    assert mission.robots[0].available_until_s == 90


def test_the_depot_may_be_any_node(loaded):
    text = CVRP.replace(" 1\n -1", " 3\n -1").replace("1 0\n2", "1 3\n2").replace("3 5\n", "3 0\n")
    mission = loaded(text, "four.vrp")
    assert mission.robots[0].position == (6, 1)
    assert [(task.id, task.load) for task in mission.tasks] == [("1", 3), ("2", 4), ("4", 6)]
    assert muster.verify(mission, {"r_0": ["1", "4"]}).total_cost == 6 + 8 + 9


@pytest.mark.parametrize("name", ["x", "x.txt", "x.vrp", "x.tsp", "x.dat"])
@pytest.mark.parametrize("text", [CVRP, ALL["times"]])
def test_vrplib_is_known_by_its_type(name, text, loaded):
    assert len(loaded(text, name).tasks) == 3


@pytest.mark.parametrize("name", ["x", "x.txt", "x.dat"])
@pytest.mark.parametrize("kind", ["solomon", "li-lim", "electric"])
def test_layouts_are_known_by_their_first_lines(name, kind, loaded):
    for text in (ALL[kind], "\ufeff" + ALL[kind], ALL[kind].replace("\n", "\r\n")):
        assert len(loaded(text, name).tasks) == 2


def test_tsplib_is_known_by_its_type(loaded):
    text = CVRP.replace("CVRP", "TSP").replace("CAPACITY : 9\n", "").partition("DEMAND")[0]
    assert len(loaded(text, "four.txt", salesmen=2).tasks) == 3
    with pytest.raises(ParameterError, match=r"--salesmen missing; expected with a \.tsp file"):
        loaded(text, "four.txt")


def test_what_is_no_instance_is_yaml(tmp_path):
    for name in ("x.txt", "x.yaml", "none.txt"):
        path = tmp_path / name
        if name != "none.txt":
            path.write_text("schema: muster/1\n", encoding="utf-8")
        assert instance_form(path) is None
        with pytest.raises(MissionError):
            muster.load(path)


@pytest.mark.parametrize("kind", ALL)
def test_flags_that_these_files_do_not_have(kind, loaded):
    with pytest.raises(ParameterError, match="--depot given; expected no --depot with this kind of mission"):
        loaded(ALL[kind], salesmen=2, depot="1")
    with pytest.raises(ParameterError, match="--robots given"):
        loaded(ALL[kind], robots="r.csv")
    with pytest.raises(MissionError, match="salesmen: 0; expected a whole number from 1 to 100000"):
        loaded(ALL[kind], salesmen=0)


@pytest.mark.parametrize("kind", ["solomon", "li-lim", "electric"])
def test_a_mission_is_saved_as_yaml(kind, loaded, tmp_path):
    mission = loaded(ALL[kind])
    mission.save(tmp_path / "again.yaml")
    assert muster.load(tmp_path / "again.yaml") == mission


@pytest.mark.parametrize("layout", ["vrp", "atsp"])
def test_a_mission_with_a_table_is_saved_beside_its_instance(layout, loaded, tmp_path):
    matrix = "EDGE_WEIGHT_TYPE: EXPLICIT\nEDGE_WEIGHT_FORMAT: FULL_MATRIX\nEDGE_WEIGHT_SECTION\n9 1 2\n3 9 4\n5 6 9\n"
    text = CVRP if layout == "vrp" else f"TYPE: ATSP\nDIMENSION: 3\n{matrix}"
    mission = loaded(text, f"three.{layout}", salesmen=2)
    (tmp_path / "plans").mkdir()
    mission.save(tmp_path / "plans" / "again.yaml")
    again = muster.load(tmp_path / "plans" / "again.yaml")
    assert again.travel == {"vehicle": f"../three.{layout}"}
    assert (again.tasks, again.robots, again.travel_tables) == (mission.tasks, mission.robots, mission.travel_tables)
    assert muster.verify(again, muster.solve(mission, "greedy")).valid
    file = tmp_path / "plans" / "again.yaml"
    kept = [line for line in file.read_text(encoding="utf-8").splitlines() if "{id: 3," not in line]
    file.write_text("\n".join(kept), encoding="utf-8")
    with pytest.raises(MissionError, match=r"2 nodes that are no tasks of the mission; expected one, where the robots"):
        muster.load(file)


scraps = st.sampled_from(
    [
        "",
        "0",
        "-1",
        "1e400",
        "nan",
        "2.5",
        "9" * 30,
        "x",
        "\n",
        "/",
        ":",
        "EOF",
        "VEHICLE\n",
        "\nDEPOT_SECTION\n",
        "²",
        "\x00",
    ]
)


@examples(150)
@given(
    text=st.sampled_from(sorted(ALL.values())),
    changes=st.lists(st.tuples(st.floats(0, 1), scraps, st.integers(0, 6)), max_size=4),
    suffix=st.sampled_from(["txt", "vrp", "tsp"]),
)
def test_a_changed_file_is_read_or_told(folder, text, changes, suffix):
    for share, scrap, length in changes:
        at = int(share * len(text))
        text = text[:at] + scrap + text[at + length :]
    read_or_told(folder / f"changed.{suffix}", text)


@examples(60)
@given(
    head=st.sampled_from(
        ["", "TYPE: TSP\n", "TYPE: CVRP\n", "VEHICLE\n", "StringID Type\n", "1 2 3\n1 2 3 4 5 6 7 8 9\n"]
    ),
    text=st.text(max_size=80),
)
def test_any_text_is_read_or_told(folder, head, text):
    read_or_told(folder / "any.txt", head + text)


def read_or_told(path, text):
    path.write_bytes(text.encode("utf-8", errors="surrogatepass"))
    salesmen = 2 if path.suffix == ".tsp" or "TYPE: TSP" in text else None
    files = {str(path)}
    try:
        assert muster.load(path, salesmen=salesmen).robots
    except (MissionError, NotSupportedError) as error:
        files |= {finding.file for finding in error.findings}
    except ParameterError:
        pass  # TSPLIB without --salesmen
    assert files == {str(path)}


def test_findings_are_json_too(tmp_path, capsys):
    path = tmp_path / "tiny.txt"
    path.write_text(SOLOMON.replace("912", "9x2"), encoding="utf-8")
    assert run(["check", str(path), "--format", "json"]) == 2
    (error,) = json.loads(capsys.readouterr().out)["errors"]
    assert (error["line"], error["field"]) == (11, "CUSTOMER")
