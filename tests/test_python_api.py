"""What `import muster` offers: names, short texts, tables, pictures, files."""

import builtins
import re
from pathlib import Path

import pytest

import muster
from muster.mission.plan import Route, RouteStop


@pytest.fixture(scope="module")
def mission():
    return muster.load("31T-6R50")


@pytest.fixture(scope="module")
def plan(mission):
    return muster.solve(mission, "greedy")


@pytest.fixture(scope="module")
def report(mission, plan):
    return muster.simulate(mission, plan)


def test_every_name_that_is_listed_is_there_and_no_other():
    assert dir(muster) == sorted([*muster.__all__, "__version__"])
    for name in dir(muster):
        found = getattr(muster, name)
        assert name == "__version__" or found.__module__.startswith("muster"), name
    wanted = "Map Zone Camera Action Origin Tag Found Report Verdict NetworkError Simulation"
    assert set(f"{wanted} check explain export gantt missions".split()) <= set(dir(muster))


def test_every_public_name_has_help():
    for name in muster.__all__:
        assert getattr(muster, name).__doc__, name


def test_the_help_of_a_robot_tells_of_every_field():
    text = muster.Robot.__doc__
    for name in muster.Robot.__dataclass_fields__:
        assert re.search(rf"^{name} : .*(required|default)", text, re.MULTILINE), name
    assert "speed_mps : float, m/s, default 1.0" in text
    assert "position : Point, m, required" in text
    assert "heading_deg : float, degrees, default 0.0" in text
    assert "work_capacity : float | None, unit of usage, default None" in text
    assert "how it moves (holonomic or differential-drive or quadcopter or hexacopter)" in text


def test_a_wrong_name_is_answered_in_one_line_with_the_near_match(mission, plan):
    wrong = {
        "time_limt: unknown; did you mean 'time_limit'?": lambda: muster.solve(mission, time_limt=3),
        "wrold: unknown; did you mean 'world'?": lambda: muster.simulate(mission, plan, wrold="physics"),
        "Robot: postion: unknown; did you mean 'position'?": lambda: muster.Robot(id="r", postion=(0, 0)),
        "did you mean 'population_size'?": lambda: muster.solve(mission, "genetic", populaton_size=3),
        "or mavlink; did you mean 'physics'?": lambda: muster.simulate(mission, plan, world="phisics"),
    }
    for line, call in wrong.items():
        with pytest.raises(muster.ParameterError) as refusal:
            call()
        assert line in str(refusal.value)
        assert "\n" not in str(refusal.value)
    with pytest.raises(TypeError, match="missing 2 required keyword-only arguments: 'id' and 'position'"):
        muster.Robot()


@pytest.mark.parametrize(
    ("lags", "told"),
    [
        ({"b": {"after_s": 3}}, 'lags.b: {"after_s": 3}; expected a muster.Lag'),
        ({"c": muster.Lag(after_s=3)}, 'lags.c: "c"; expected one of its prerequisites'),
        (3, "lags: 3; expected a mapping from prerequisites to lags"),
    ],
)
def test_lags_are_checked_when_a_task_is_made(lags, told):
    with pytest.raises(muster.MissionError, match=re.escape(told)):
        muster.Task(id="a", position=(2, 0), prerequisites=("b",), lags=lags)


def test_texts_are_one_line_each(mission, plan, report):
    assert repr(mission) == "<Mission 31T-6R50: 6 robots, 31 tasks, total+max>"
    assert repr(plan) == "<Plan of 31T-6R50 by greedy: 27 tasks done, total+max 248.78>"
    assert repr(muster.verify(mission, plan)) == "<Verdict: valid, 27 of 31 tasks, total+max 248.78>"
    assert re.fullmatch(r"<Report: 27 tasks done, 4 lost, [\d.]+ s, total\+max [\d.]+>", repr(report))


def test_notebooks_show_when_a_team_works():
    shown = muster.solve(muster.load("collapsed-building"), iterations=200)._repr_html_()
    assert re.search(r"<td>lift-beam</td>(<td>[\d.]+</td>){3}<td>rover_\d</td>", shown)


def test_notebooks_show_tables_with_escaped_texts(mission, plan, report):
    for shown in (mission, plan, muster.verify(mission, plan), report):
        assert "<table>" in shown._repr_html_()
    assert "and 11 more" in mission._repr_html_()  # of 31 tasks 20 are shown
    strange = muster.Mission(name="<b>", robots=(muster.Robot(id="<i>", position=(0, 0)),), tasks=())
    assert "<b>" not in strange._repr_html_()
    assert "&lt;i&gt;" in strange._repr_html_()
    broken = muster.verify(mission, {"r_0": ["27", "no-such-task"]})
    assert "no-such-task" in broken._repr_html_()


@pytest.mark.long
def test_notebooks_show_pictures_of_figures_that_pyplot_does_not_know(mission, plan):
    for axes in (muster.plot(mission, plan), muster.gantt(mission, plan)):
        assert axes._repr_png_().startswith(b"\x89PNG")


def test_data_frames(mission, plan, report):
    pytest.importorskip("pandas")
    assert list(mission.to_frame().id) == [task.id for task in mission.tasks]
    assert list(mission.to_frame("robots").id) == [robot.id for robot in mission.robots]
    with pytest.raises(muster.ParameterError, match="of: maps; expected tasks, robots or stations"):
        mission.to_frame("maps")
    stops = plan.to_frame()
    assert list(stops.columns) == ["robot", "place", "task", "arrive_s", "begin_s", "end_s"]
    for route in plan.routes:
        assert tuple(stops[stops.robot == route.robot].sort_values("place").task) == route.tasks
    visits = muster.verify(mission, plan).to_frame()
    assert visits.ends_s.max() == plan.makespan_s
    assert dict(zip(report.to_frame().task, report.to_frame().ends_s, strict=True)) == report.ends_s
    empty = muster.Plan(routes=()).to_frame()
    assert list(empty.columns) == ["robot", "place", "task"]


def test_a_data_frame_has_no_times_of_stops_that_are_not_the_routes_tasks():
    pytest.importorskip("pandas")
    stop = RouteStop("b", 1.0, 2.0, 3.0)
    for stops in ((stop,), (stop, stop, stop)):
        frame = muster.Plan(routes=(Route("r", ("a", "b"), stops=stops),)).to_frame()
        assert frame.task.tolist() == ["a", "b"]
        assert frame.begin_s.isna().all()


def test_without_pandas_a_data_frame_says_what_to_install(plan, monkeypatch):
    really = builtins.__import__

    def without_pandas(name, *rest, **others):
        if name == "pandas":
            raise ImportError(name)
        return really(name, *rest, **others)

    monkeypatch.setattr(builtins, "__import__", without_pandas)
    with pytest.raises(muster.MissingExtraError, match=r"pip install 'muster-robotics\[frames\]'"):
        plan.to_frame()


def test_a_mapping_is_judged_as_its_plan_is(mission, plan):
    routes = {route.robot: route.tasks for route in plan.routes}
    assert muster.verify(mission, routes).value() == plan.objective_value
    assert muster.verify(mission, plan.as_dict()) == muster.verify(mission, plan)
    with pytest.raises(muster.ParameterError, match="plan: 3; expected a Plan, or a mapping"):
        muster.verify(mission, 3)
    with pytest.raises(muster.PlanError, match=r"routes\[0\].tasks: \"27\"; expected a list of ids"):
        muster.verify(mission, {"r_0": "27"})


def test_a_mapping_is_explained_and_exported_as_its_plan_is(mission, plan):
    plain = plan.as_dict()
    assert muster.explain(mission, plain, "27").as_dict() == muster.explain(mission, plan, "27").as_dict()
    assert muster.export(mission, plain, "csv") == muster.export(mission, plan, "csv")


@pytest.mark.parametrize("wrong", [3, None, "plan.json"])
def test_what_is_no_plan_is_refused(mission, wrong):
    for use in (muster.explain, muster.verify, muster.gantt, lambda m, p: muster.export(m, p, "csv")):
        with pytest.raises(muster.ParameterError, match=r"plan: .*; expected a Plan, or a mapping"):
            use(mission, wrong)


@pytest.mark.parametrize("wrong", [3, None, True, b"capacity"])
def test_what_names_no_rules_cannot_be_ignored(mission, plan, wrong):
    for use in (muster.explain, muster.verify, muster.simulate):
        with pytest.raises(muster.ParameterError, match=r"ignore: .*; expected a list of prerequisite, "):
            use(mission, plan, ignore=wrong)


def test_an_explanation_is_short_in_the_shell(mission, plan):
    for explanation in (muster.explain(mission, plan), muster.explain(mission, plan, "27")):
        assert "Problem(" not in repr(explanation)


def test_a_saved_mission_is_read_back(mission, tmp_path):
    mission.save(tmp_path / "copy.yaml")
    assert muster.load(tmp_path / "copy.yaml") == mission
    with pytest.raises(OSError, match="no-such-folder"):
        mission.save(tmp_path / "no-such-folder" / "copy.yaml")


def test_a_saved_mission_finds_its_files_from_where_it_is_saved(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    (tmp_path / "a" / "t.csv").write_text("place,r,x\nr,0,5\nx,5,0\n")
    (tmp_path / "a" / "m.yaml").write_text(
        "schema: muster/1\nrules: {travel: matrix}\ntravel: {car: t.csv}\n"
        "robots: [{id: r, type: car, position: [0, 0]}]\ntasks: [{id: x, position: [3, 4]}]\n"
    )
    first = muster.load(tmp_path / "a" / "m.yaml")
    first.save(tmp_path / "b" / "m.yaml")
    again = muster.load(tmp_path / "b" / "m.yaml")
    assert again.travel == {"car": str(Path("..") / "a" / "t.csv")}
    assert again.travel_tables == first.travel_tables


def test_check_and_explain(mission, plan):
    found = muster.check(mission, time_limit=None)
    assert (found.impossible, found.together.unknown) == ((), True)
    left_out = [item.task for item in plan.unassigned]
    assert left_out
    assert [item.task for item in muster.explain(mission, plan).unassigned] == left_out
    task = plan.routes[0].tasks[0]
    assert muster.explain(mission, plan, task).robot == plan.routes[0].robot
    with pytest.raises(muster.PlanError, match="unknown-task"):
        muster.explain(mission, muster.Plan(routes=(muster.Route("r_0", ("nowhere",)),)))


def test_the_shipped_missions_are_listed_with_their_sizes(mission):
    by_name = {summary.name: summary for summary in muster.missions()}
    assert (by_name["31T-6R50"].robots, by_name["31T-6R50"].tasks) == (len(mission.robots), len(mission.tasks))


def test_a_plan_is_exported_to_texts_and_files(tmp_path, mission, plan):
    files = muster.export(mission, plan, "csv", tmp_path / "plan.csv")
    assert (tmp_path / "plan.csv").read_text(encoding="utf-8") == files.texts["plan.csv"]
    assert files.texts["plan.csv"].count("\n") > len(plan.routes)
    with pytest.raises(muster.ParameterError, match=r"format: cvs; expected qgc, .*did you mean 'csv'"):
        muster.export(mission, plan, "cvs")
    with pytest.raises(muster.ParameterError, match="to csv: altitude: unknown; expected none"):
        muster.export(mission, plan, "csv", altitude=3.0)
    with pytest.raises(muster.MissionError, match="origin_wgs84"):
        muster.export(mission, plan, "kml")


def test_plan_files_for_drones_are_written_into_a_folder(tmp_path):
    pytest.importorskip("pymap3d")
    drone = muster.Robot(id="d", position=(0.0, 0.0), kind="air")
    origin = muster.Origin(lat_deg=35.5, lon_deg=24.0)
    task = muster.Task(id="t", position=(30.0, 0.0))
    mission = muster.Mission(origin_wgs84=origin, robots=(drone,), tasks=(task,))
    plan = muster.solve(mission, "greedy")
    files = muster.export(mission, plan, "qgc", tmp_path / "plans", altitude=10.0)
    assert [path.name for path in (tmp_path / "plans").iterdir()] == ["d.plan"] == list(files.texts)
    with pytest.raises(muster.ParameterError, match="to qgc: altitud: unknown; did you mean 'altitude'"):
        muster.export(mission, plan, "qgc", altitud=10.0)


@pytest.mark.long
def test_sheets_are_bytes_and_have_options(tmp_path, mission, plan):
    files = muster.export(mission, plan, "sheets", tmp_path / "sheets.pdf")
    assert (tmp_path / "sheets.pdf").read_bytes() == files.contents["sheets.pdf"] == files.encoded["sheets.pdf"]
    assert files.texts == {}
    muster.export(mission, plan, "sheets", tmp_path / "all", per_robot=True)
    busy = {f"{route.robot}.pdf" for route in plan.routes if route.tasks}
    assert {path.name for path in (tmp_path / "all").iterdir()} == busy
    with pytest.raises(muster.ParameterError, match="altitude_step: -1; expected metres, from 0 to 10000"):
        muster.export(mission, plan, "sheets", altitude_step=-1)
