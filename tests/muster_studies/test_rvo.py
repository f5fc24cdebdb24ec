"""The study of collision avoidance: what is published, what must hold, and the pictures."""

import numpy as np
import pytest

from muster.cli.main import run as muster
from muster.motion.avoidance import Trajectories
from muster_studies.benches.avoidance import Scene
from muster_studies.effort import Effort
from muster_studies.registry import study_named
from muster_studies.rvo.runs import METHODS, Job
from muster_studies.rvo.scenarios import circle, misprints, scenarios
from muster_studies.rvo.study import Found, verdict


@pytest.fixture(scope="module")
def rvo_tables():
    report = study_named("rvo").run(Effort(seeds=1, quick=True))
    return {table.number: table for table in report.tables}


def rows(table, **wanted):
    return [record for record in table.records() if wanted.items() <= record.items()]


@pytest.mark.long
@pytest.mark.parametrize(("number", "count"), [("A.17", 4), ("A.22", 3)])
def test_all_arrive_and_none_touches(rvo_tables, number, count):
    """Least distance between centres above 0.32 m, the sum of the radii that are not inflated."""
    for method in METHODS:
        found = rows(rvo_tables[number], method=method)
        assert len(found) == count
        for record in found:
            arrived, robots = record["arrived"].split("/")
            assert arrived == robots
            assert record["least distance"] > 0.32
            assert record["least distance"] == pytest.approx(record["least gap"] + 0.32)
            assert record["mark"] == "no fault"


def test_of_the_circle_orca_alone_promises_something(rvo_tables):
    for count in (8, 32):
        (orca,) = rows(rvo_tables["circle"], robots=count, method="ORCA")
        assert (orca["arrived"], orca["contacts"], orca["mark"]) == (f"{count}/{count}", 0, "no fault")
        assert orca["least gap"] >= 0
    assert sum(record["contacts"] for record in rows(rvo_tables["circle"], method="RVO", robots=32)) > 0


@pytest.mark.long
def test_orca_on_a_circle_of_100():
    found = Found.of(Job(100, "ORCA", 0).perform())
    assert (found.arrived, found.contacts) == (100, 0)


def test_the_misprinted_goal():
    """Scenario 1 of Table A.17: run as printed, and with the goal that is meant."""
    printed, corrected, *_ = scenarios("A.17")
    assert printed.robots["r_0"]["goal"] == printed.robots["r_3"]["goal"] == [-2, 2]
    assert corrected.robots["r_0"]["goal"] == [-2, -2]
    assert {k: v for k, v in printed.robots.items() if k != "r_0"} == {
        k: v for k, v in corrected.robots.items() if k != "r_0"
    }
    (text,) = misprints("A.17")
    assert "printed -2, 2, right -2, -2" in text


def test_figures_of_table_a_18():
    crowd = next(iter(scenarios("A.22"))).crowd()
    assert set(crowd.radii) == {0.16}
    assert set(crowd.avoided_radii) == {0.21}
    assert set(crowd.max_speeds) == {0.26}


@pytest.mark.parametrize("count", [8, 250])
def test_the_circle(count):
    crowd = circle(count)
    assert np.linalg.norm(crowd.starts, axis=1) == pytest.approx(np.full(count, 200 * count / 250))
    assert (crowd.goals == -crowd.starts).all()
    neighbours = np.linalg.norm(np.diff(crowd.starts, axis=0), axis=1)
    assert neighbours.min() > 2 * 1.5


def test_verdicts():
    good, touching = Found(2, 2, 1.0, 1.0, 0.5, 0), Found(2, 2, 1.0, 1.0, -0.5, 1)
    assert verdict([good, good]) == "no fault"
    assert verdict([good, touching, Found(2, 1, 1.0, 1.0, -0.5, 2)]) == "2 of 3 touch, 1 of 3 stuck"


def test_found_of_trajectories():
    ways = Trajectories(
        dt=0.5,
        positions=np.zeros((3, 2, 2)),
        velocities=np.zeros((2, 2, 2)),
        arrivals_s=np.array([0.5, np.nan]),
        least_distances_m=np.array([2.0, 1.5]),
        least_gaps_m=np.array([1.0, 0.5]),
        contacts=(),
    )
    assert Found.of(ways) == Found(2, 1, 1.0, 1.5, 0.5, 0)


@pytest.mark.long
def test_pictures(tmp_path, capsys):
    pytest.importorskip("matplotlib")
    assert muster(["study", "rvo", "--tables", "A.22", "--seeds", "1", "--plot", str(tmp_path / "new")]) == 0
    made = sorted(path.name for path in (tmp_path / "new").iterdir())
    assert made == ["figure-A.15.png", "figure-A.16.png", "figure-A.17.png"]
    assert capsys.readouterr().err.count("drew ") == 3


def test_a_study_without_figures(capsys):
    assert muster(["study", "peers", "--plot", "pictures"]) == 2
    assert "--plot: study peers has no figures" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--figures", "A.4"], "--plot missing"),
        (["--figures", "A.4", "--tables", "A.17", "--plot", "new"], "given with --tables"),
        (["--figures", "A.3", "--plot", "new"], "figure: A.3; expected all or A.4 or "),
    ],
)
def test_refuses_figures(capsys, arguments, message):
    assert muster(["study", "rvo", *arguments]) == 2
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.out == ""


@pytest.mark.long
def test_one_figure_without_tables(tmp_path, capsys):
    pytest.importorskip("matplotlib")
    assert muster(["study", "rvo", "--figures", "A.8", "--plot", str(tmp_path)]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["figure-A.8.png"]
    assert capsys.readouterr().out == ""


def test_the_scene_of_the_bench():
    scene = Scene.random(200, 1)
    apart = np.linalg.norm(scene.positions[:, None] - scene.positions[None], axis=-1)
    assert apart[~np.eye(200, dtype=bool)].min() >= 3.0
    assert (Scene.random(200, 1).positions == scene.positions).all()
