"""The study of the rescue carried out: what the paper prints, and what must hold whatever the noise."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from muster.cli.main import run as muster
from muster_studies.effort import Effort
from muster_studies.registry import study_named
from muster_studies.rescue.failures import TEAMS, failing
from muster_studies.rescue.flights import Flight, repetitions
from muster_studies.rescue.metrics import METRICS, Metric, noisy
from muster_studies.rescue.scenario import undisturbed
from muster_studies.rescue.teams import ARENA, PAIRS, POINTS, RICHER, mission_of, sent, verdict_of
from muster_studies.rescue.tracking import at_same_shares, deviations, legs, track, tracks

EFFORT = Effort(seeds=2, iterations=100)


@pytest.fixture(scope="module")
def rescue_report():
    return study_named("rescue").run(EFFORT)


class OnDemand(dict):
    """The tables of the report by number, each made when a test asks for it."""

    def __missing__(self, number):
        (self[number],) = study_named("rescue").run(replace(EFFORT, tables=(number,))).tables
        return self[number]


@pytest.fixture(scope="module")
def rescue_tables():
    return OnDemand()


@pytest.fixture(scope="module")
def calm():
    return undisturbed(EFFORT).perform()


def rows(table, **wanted):
    return [record for record in table.records() if wanted.items() <= record.items()]


def test_figure_5_comes_out_among_obstacles(rescue_tables):
    own = {record["robot"]: record for record in rows(rescue_tables["Figure 5"], values="own")}
    assert {robot: set(record["survivors"]) for robot, record in own.items()} == {
        "handBot": {"survivor1", "survivor2"},
        "eyeBot": {"survivor3", "survivor5"},
        "rangeBot": {"survivor4"},
    }
    assert {(record["runs"], record["mark"]) for record in own.values()} == {("2/2", "✓")}


def test_figure_6(rescue_tables):
    """Execution by hand from Figure 3; carried out a mission takes longer than planned, by turning and speeding up."""
    execution = {"handBot": 2 * 10.2 / 0.87, "eyeBot": 2 * 1.8 / 0.92, "rangeBot": 4.8 / 0.81}
    table, totals = rescue_tables["Figure 6"], {"planned": [], "carried out": []}
    for robot, seconds in execution.items():
        (paper,) = rows(table, robot=robot, values="paper")
        assert paper["execution"] == pytest.approx(seconds)
        for values, found in totals.items():
            (record,) = rows(table, robot=robot, values=values)
            assert record["execution"] == pytest.approx(seconds, abs=0.2)
            assert record["total"] == pytest.approx(record["travel"] + record["execution"])
            late = record["execution"] - seconds
            assert record["mark"] == ("✓" if late <= 0.011 else f"execution {late:+.2f}")
            assert values == "carried out" or record["mark"] == "✓"
            found.append(record["total"])
        assert totals["planned"][-1] < totals["carried out"][-1] < 1.2 * totals["planned"][-1]
    for values, found in totals.items():
        assert rows(table, robot="mission", values=values)[0]["total"] == pytest.approx(max(found))
    assert rows(table, robot="mission", values="paper")[0]["total"] == 83.0


@pytest.mark.long
def test_figure_7(rescue_tables):
    flights = rescue_tables["Figure 7"].records()
    assert [record["flight"] for record in flights] == ["without noise", "noise, seed 0", "noise, seed 1"]
    assert len({record["reference m"] for record in flights}) == 1
    for record in flights:
        assert 0 < record["mean aside m"] < record["greatest aside m"] < 0.03
        assert record["flown m"] == pytest.approx(record["reference m"], rel=0.02)
        assert record["arrives s"] > record["reference m"] / (8.6 / 60)
    assert flights[0]["arrives s"] < min(record["arrives s"] for record in flights[1:])


@pytest.mark.long
def test_figure_8(rescue_tables):
    table = rescue_tables["Figure 8"]
    assert len(table.rows) == 3 * len(METRICS)
    for record in table.records():
        assert record["least"] <= record["mean"] <= record["most"]
        assert record["spread"] == pytest.approx((record["most"] - record["least"]) / math.sqrt(2))  # of two flights
        assert record["mark"] in ("other measure", "no contact", "")
    goals = rows(table, metric="error at the goal, m")
    assert all(record["most"] <= record["paper"] == 0.0065 for record in goals)
    assert all(record["least"] > 0.065 for record in rows(table, metric="least distance to an obstacle, m"))
    assert all(record["least"] > 0.13 for record in rows(table, metric="least distance to a robot, m"))


@pytest.mark.long
def test_of_three_robots_with_a_skill_each_tasks_are_lost(rescue_tables):
    for robot, skill in (("handBot", "gripper"), ("eyeBot", "camera"), ("rangeBot", "laser-rangefinder")):
        (record,) = rows(rescue_tables["Section 6"], team=ARENA, fails=robot)
        done, whole = map(int, record["done"].split("/"))
        assert (whole, record["lost"], record["moved"]) == (10, 10 - done, 0)
        assert record["lost"] > 0
        assert f"{record['mark']} lost: no other robot has {skill}." in rescue_tables["Section 6"].notes


@pytest.mark.long
def test_of_two_robots_a_skill_the_other_does_it_all_where_no_body_is_in_the_way(rescue_tables):
    failed = [record for record in rows(rescue_tables["Section 6"], team=POINTS) if record["fails"] != "none"]
    assert len(failed) == len(sent(POINTS, 100))
    for record in failed:
        assert (record["done"], record["lost"], record["mark"]) == ("10/10", 0, "none lost")
        assert record["re-plans"] == 2
        assert record["moved"] >= 2


@pytest.mark.long
def test_in_the_richer_mission_only_what_one_robot_alone_can_do_is_lost():
    mission = mission_of(RICHER)
    required = {task.id: set(task.requires) for task in mission.tasks}
    for robot in sent(RICHER, 100):
        others = [set(one.skills) for one in mission.robots if one.id != robot]
        for flight in failing(EFFORT, RICHER, robot):
            report = flight.perform().report
            assert len(report.tasks_done) + len(report.tasks_lost) == len(mission.tasks)
            assert not any(required[task] <= skills for task, _ in report.tasks_lost for skills in others)


@pytest.mark.long
def test_a_body_that_lies_on_a_survivor_is_what_holds_the_second_robot_up():
    """Every task that is lost though another robot has the skill has the dead body nearer than both radii."""
    mission, found = mission_of(PAIRS), 0
    places = {task.id: task.position for task in mission.tasks}
    for robot in sent(PAIRS, 100):
        index = [one.id for one in mission.robots].index(robot)
        for flight in failing(EFFORT, PAIRS, robot):
            flown = flight.perform()
            for task, reason in flown.report.tasks_lost:
                assert f"{robot} stands there" in reason
                assert math.dist(flown.positions[-1, index], places[task]) < 2 * 0.08
                found += 1
    assert found > 0


def test_a_robot_fails_at_its_share_of_the_time():
    (visits,) = (route.visits for route in verdict_of(ARENA, 100).routes if route.robot == "handBot")
    (early, late) = failing(EFFORT, ARENA, "handBot")
    assert [flight.mission.events[0].robot_fails for flight in (early, late)] == ["handBot", "handBot"]
    assert early.mission.events[0].at_s == pytest.approx(visits[-1].ends_s / 3)
    assert late.mission.events[0].at_s == pytest.approx(visits[-1].ends_s * 2 / 3)


def test_teams():
    second = {robot.id: robot for robot in mission_of(PAIRS).robots}
    for robot in mission_of(ARENA).robots:
        assert second[robot.id] == robot
        assert second[f"{robot.id}2"].skills == robot.skills
    assert {robot.radius_m for robot in mission_of(POINTS).robots} == {0.0}
    assert all(not mission_of(team).events for team in TEAMS)


@pytest.mark.long
def test_the_same_seed_flies_the_same(calm):
    again = undisturbed(EFFORT).perform()
    assert (again.positions == calm.positions).all()
    first, second = (flight.perform() for flight in noisy(EFFORT))
    assert not np.array_equal(first.positions, second.positions)


def test_reference_and_track_begin_and_end_at_the_same_places(calm):
    visits = calm.visits["handBot"]
    reference, ways = legs(ARENA, "handBot", tuple(visit.task for visit in visits)), tracks(calm, "handBot")
    assert len(reference) == len(ways) == 2
    for one, way in zip(reference, ways, strict=True):
        assert way[0] == pytest.approx(one[0], abs=2e-3)
        assert way[-1] == pytest.approx(one[-1], abs=2e-3)
        assert np.linalg.norm(np.diff(one, axis=0), axis=1).max() <= 0.01 + 1e-9
    assert sum(len(way) for way in ways) == len(track(calm, "handBot")) + 1  # the joint is in both


def test_measures_of_a_way_that_is_known():
    reference = np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]])
    way = np.array([[0.0, 0.1], [0.2, 0.1], [0.2, 0.1], [1.0, 0.1]])  # it stands for a while
    assert at_same_shares(reference, way) == pytest.approx(np.add(reference, [0, 0.1]))
    assert deviations([reference], way) == pytest.approx([0.1] * 4)


def test_marks():
    goal, obstacle, robot, error = (Metric(name, "") for name in ("goal_error", "obstacle", "robot", "mean_error"))
    assert (goal.mark([0.006, 0.0065]), goal.mark([0.0066])) == ("other measure", "other measure")
    assert (obstacle.mark([0.066]), obstacle.mark([0.07, 0.065])) == ("no contact", "contact")
    assert (robot.mark([0.131]), robot.mark([0.13])) == ("no contact", "contact")
    assert error.mark([9.0]) == ""


@pytest.mark.parametrize(
    ("effort", "count"), [(Effort(), 5), (Effort(quick=True), 2), (Effort(seeds=3, quick=True), 3)]
)
def test_repetitions(effort, count):
    """Five as in the paper, if nothing else is asked for."""
    assert repetitions(effort) == count
    assert len(noisy(effort)) == len(failing(effort, ARENA, "handBot")) == count


def test_iterations_are_the_markets():
    assert undisturbed(Effort(iterations=7)) == Flight(team=ARENA, iterations=7)


@pytest.mark.long
def test_a_line_of_the_tables_fits_120_columns(rescue_report, capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setattr(type(study_named("rescue")), "run", lambda *_: rescue_report)
    file = tmp_path / "rescue.txt"
    assert muster(["study", "rescue", "--seeds", "1", "-o", str(file)]) == 0
    assert capsys.readouterr().err == ""
    assert max(map(len, file.read_text(encoding="utf-8").splitlines())) <= 120


@pytest.mark.long
def test_json_and_pictures(tmp_path, capsys):
    pytest.importorskip("matplotlib")
    arguments = ["--tables", "Figure 7,Figure 8", "--seeds", "1", "--iterations", "100", "--format", "json"]
    arguments += ["--plot", str(tmp_path / "new")]
    assert muster(["study", "rescue", *arguments]) == 0
    out, err = capsys.readouterr()
    assert [table["number"] for table in json.loads(out)["tables"]] == ["Figure 7", "Figure 8"]
    assert err.count("drew ") == 2
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["figure-7.png", "figure-8.png"]
