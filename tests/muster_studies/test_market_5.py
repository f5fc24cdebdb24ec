"""The study of section 5 of the market paper: what robots see, believe and find, and what its tables say of that."""

import json
import math
from importlib.util import find_spec

import numpy as np
import pytest

from muster.cli.main import run as muster
from muster.motion.map_world import World
from muster.motion.metrics import risk_factor, trajectory_error
from muster_studies.effort import Effort
from muster_studies.market_5.arena import BEACONS, CYLINDER_RADIUS_M, CYLINDERS, SURVIVORS
from muster_studies.market_5.localisation import raw_estimates
from muster_studies.market_5.searches import ALONE, BELIEVED, FARTHEST_M, LANDMARKED, PLACES, performed, searches
from muster_studies.market_5.study import MARKET_5
from muster_studies.market_5.tracks import SHOWN, measured
from muster_studies.registry import study_named
from muster_studies.rescue.metrics import printed_goal_error_m
from muster_studies.rescue.teams import ARENA, BODY_RADIUS_M, mission_of
from muster_studies.rescue.tracking import at_same_shares, legs, tracks

if find_spec("mujoco") is None or find_spec("scipy") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)

EFFORT = Effort(seeds=2, iterations=100)
QUICK = ("--seeds", "1", "--iterations", "100")
"""What the command is given to find what is found already."""
TEAM = ("handBot", "eyeBot", "rangeBot")


def result_of(search):
    """Return the result of a search. In the physics world, which takes longer, the first seed stands for the second."""
    first, second = searches(EFFORT, ["physics"])
    return performed(first if search == second else search)


@pytest.fixture(scope="module")
def found():
    """The results of all searches: of two seeds in each world."""
    return {search: result_of(search) for search in searches(EFFORT)}


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(search, marks=[] if (search.world, search.seed) == ("kinematic", 0) else pytest.mark.long)
        for search in searches(EFFORT)
    ],
    ids=lambda search: f"{search.world}-{search.seed}",
)
def search(request):
    """Each search; the fast suite has the first one in the kinematic world."""
    return request.param


@pytest.fixture(scope="module")
def result(search):
    return result_of(search)


@pytest.fixture(scope="module")
def tables(found):
    return {table.number: table.table(EFFORT, found) for table in MARKET_5.reproductions}


def rows(table, **wanted):
    return [record for record in table.records() if wanted.items() <= record.items()]


def test_cylinders_stand_free():
    """Of obstacles, of each other, and beside where robots work: the gripper reaches no farther than 0.15 m."""
    world = World.of(mission_of(ARENA))
    assert (world.clearance(CYLINDERS[:, :2], "ground") > 2 * CYLINDER_RADIUS_M).all()
    apart = np.linalg.norm(CYLINDERS[:, None, :2] - CYLINDERS[None, :, :2], axis=2)
    assert apart[~np.eye(len(apart), dtype=bool)].min() > 4 * CYLINDER_RADIUS_M
    for task in mission_of(ARENA).tasks:
        assert math.dist(task.position, SURVIVORS[task.id]) <= 0.15 + 1e-9


@pytest.mark.long
def test_no_robot_drives_over_a_cylinder(result):
    places = result.flown[LANDMARKED].positions.reshape(-1, 1, 2)
    assert np.linalg.norm(places - CYLINDERS[:, :2], axis=2).min() > BODY_RADIUS_M + CYLINDER_RADIUS_M


def test_all_survivors_are_found_and_nothing_else(search, result):
    """But that in the physics world a robot that skids at a corner is off by centimetres until it sees a landmark."""
    table = result.found()
    assert {match.name for match in table.matches} == set(SURVIVORS)
    assert table.missed == ()
    assert len(table.extra) <= (2 if search.world == "physics" else 0)
    assert table.greatest_error_m < 0.01
    assert not result.flown[LANDMARKED].report.contacts


def test_the_team_knows_better_than_one_sighting_tells(result):
    for match in result.found().matches:
        single = [math.dist(seen.place.mean, match.truth) for seen in result.sightings(match.name)]
        assert match.error_m < np.mean(single)


def test_what_landmarks_and_team_mates_are_is_no_target(result):
    """Sightings are near survivors, but for a few in a hundred; of no landmark."""
    places = raw_estimates(result.seen).positions
    near = np.linalg.norm(places[:, None] - np.array(list(SURVIVORS.values())), axis=2).min(axis=1) <= FARTHEST_M
    assert near.mean() > 0.9
    assert np.linalg.norm(places[:, None] - np.array(BEACONS), axis=2).min() > 0.05


def test_landmarks_bring_back_whom_odometry_leads_astray(search, result):
    for robot in TEAM:
        assert result.off[robot, LANDMARKED].mean() < 0.5 * result.off[robot, ALONE].mean()
        assert result.off[robot, LANDMARKED].mean() < 0.01
        assert result.off[robot, LANDMARKED].max() < (0.06 if search.world == "physics" else 0.01)
        assert result.surprise[robot, LANDMARKED][1:].mean() / 2 < 20


@pytest.mark.long
def test_the_error_at_the_goal_is_at_most_what_is_printed(found, tables):
    """True distances of robots from the places of their survivors when their work ends."""
    places = {task.id: task.position for task in mission_of(ARENA).tasks}
    for search, one in found.items():
        flown, off = one.flown[LANDMARKED], []
        for robot, visits in flown.visits.items():
            for visit in visits:
                step = int(np.searchsorted(flown.times, visit.ends_s - 1e-6))
                off.append(math.dist(flown.positions[step, TEAM.index(robot)], places[visit.task]))
        (record,) = rows(tables["Goals"], world=search.world, seed=search.seed)
        assert record[LANDMARKED] == pytest.approx(max(off), abs=1e-3)
        assert record[LANDMARKED] <= printed_goal_error_m() < record[ALONE]
        assert (record["mark"], record["tasks"]) == ("✓", 5)


def test_at_the_beginning_all_places_are_the_same(result):
    starts = [result.flown[place].positions[0] for place in PLACES]
    assert starts[1] == pytest.approx(starts[0], abs=5e-3)  # the first scan is taken in
    assert starts[2] == pytest.approx(starts[0], abs=1e-9)


@pytest.mark.long
def test_the_same_seed_finds_the_same(found):
    """Errors are those of the same sensors in both worlds, so the faster one is flown again."""
    first, second = searches(EFFORT, ["kinematic"])
    again, before, other = first.perform(), found[first], found[second]
    assert np.array_equal(again.flown[BELIEVED].positions, before.flown[BELIEVED].positions)
    assert [one.place.mean.tolist() for one in again.seen] == [one.place.mean.tolist() for one in before.seen]
    assert [one.place.mean.tolist() for one in other.seen] != [one.place.mean.tolist() for one in before.seen]


@pytest.mark.long
def test_figure_8_is_of_equations_7_and_8(found, tables):
    """The table's mean of one robot, by hand from the flights: (7) over the points of the reference, and (8)."""
    world = World.of(mission_of(ARENA))
    for place in PLACES:
        errors, risks = [], []
        for search, one in found.items():
            if search.world != "physics":
                continue
            reference = legs(ARENA, "rangeBot", ("survivor4",))
            (way,) = tracks(one.flown[place], "rangeBot")
            matched = at_same_shares(reference[0], way)
            errors.append(trajectory_error(reference[0], matched).mean)
            risks.append(risk_factor(world.clearance(matched, "ground")))
        of_robot = {"world": "physics", "robot": "rangeBot"}
        (error,) = rows(tables["Figure 8"], metric="mean error on the way (7), m", **of_robot)
        (risk,) = rows(tables["Figure 8"], metric="risk factor (8), 1/m", **of_robot)
        assert error[place] == pytest.approx(np.mean(errors))
        assert risk[place] == pytest.approx(np.mean(risks))


@pytest.mark.long
def test_figure_8_beside_what_is_printed(found, tables):
    table = tables["Figure 8"]
    assert len(table.rows) == 2 * len(SHOWN) * len(TEAM)
    for record in rows(table, metric="error at the goal, m"):
        assert (record["paper"], record["mark"]) == (printed_goal_error_m(), "✓")
        assert record[LANDMARKED] < record[ALONE]
    assert all(record["mark"] == "no contact" for record in rows(table, metric="least distance to an obstacle, m"))
    (goal,) = (metric for metric in SHOWN if metric.name == "goal_error")
    values = measured([found[search] for search in searches(EFFORT, ["kinematic"])], goal, "eyeBot", ALONE)
    (record,) = rows(table, world="kinematic", metric=goal.label, robot="eyeBot")
    assert (record[ALONE], record[f"{ALONE} ±"]) == pytest.approx((np.mean(values), np.std(values, ddof=1)))


@pytest.mark.long
def test_figure_7(found, tables):
    records = tables["Figure 7"].records()
    assert [(record["world"], record["seed"]) for record in records] == [
        ("kinematic", 0),
        ("kinematic", 1),
        ("physics", 0),
        ("physics", 1),
    ]
    for record in records:
        assert record["survivor"] == "survivor4"
        assert record["sightings"] > 20
        assert record["rangeBot m"] < record["each m"] < 0.01


@pytest.mark.long
def test_targets(tables):
    table = tables["Targets"]
    for world in ("kinematic", "physics"):
        own = [record for record in rows(table, world=world) if record["survivor"] in SURVIVORS]
        assert [record["found"] for record in own] == ["2/2"] * 5
        assert all(record["team m"] <= record["team most m"] < record["each m"] for record in own)
        assert rows(table, world=world, survivor="none of them")[0]["found"] == "0"


@pytest.mark.long
def test_localisation(tables):
    for record in tables["Localisation"].records():
        assert record["better"] == "2/2"
        assert record["landmarks mean m"] < 0.01 < record["alone most m"]


@pytest.mark.long
def test_it_is_a_study_and_says_what_the_paper_does_not_print(capsys, monkeypatch, tmp_path):
    pytest.importorskip("matplotlib")
    monkeypatch.setenv("COLUMNS", "120")
    assert study_named("market-5").tables == ("Figure 7", "Figure 8", "Goals", "Targets", "Localisation")
    text, folder = tmp_path / "study.txt", tmp_path / "pictures"
    assert muster(["study", "market-5", *QUICK, "-o", str(text), "--plot", str(folder)]) == 0
    words = " ".join(text.read_text(encoding="utf-8").split())
    assert "it prints no number" in words
    assert "steer by odometry and laser landmarks" in words
    assert max(map(len, text.read_text(encoding="utf-8").splitlines())) <= 124  # Figure 8 has nine columns
    assert sorted(path.name for path in folder.iterdir()) == ["figure-4.png", "figure-7.png", "figure-8.png"]


@pytest.mark.long
def test_json(capsys):
    assert muster(["study", "market-5", *QUICK, "--tables", "Targets", "--format", "json"]) == 0
    (table,) = json.loads(capsys.readouterr().out)["tables"]
    assert [row["survivor"] for row in table["rows"]] == [*SURVIVORS, "none of them"] * 2
