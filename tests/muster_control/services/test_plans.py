"""Plans: judged, explained, exported, drawn and compared, the same as by the command."""

import asyncio
import base64
import json

import pytest
from tests.muster_control.services.opened import TINY, WATCHER, WHO, told
from tests.muster_files.bay import BAY, bay_plan

import muster
from muster.cli.main import run as command
from muster.mission.errors import ParameterError
from muster_control.contract import BusyError, ForbiddenError, NotFoundError
from muster_control.work import Pool, WorkError

ROUTES = {"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["a", "b"]}, {"robot": "r_1", "tasks": []}]}
OTHER = {"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["a"]}, {"robot": "r_1", "tasks": ["b"]}]}


@pytest.fixture(scope="module")
def workers():
    """One pool for all tests of this file, and what runs them."""
    with asyncio.Runner() as runner:
        pool = Pool(workers=1, memory_mb=1024)
        yield runner, pool
        runner.run(pool.close())


@pytest.fixture
def with_services(tmp_path, workers):
    """Runs a story of the services to its end."""
    runner, pool = workers
    return lambda story: runner.run(told(tmp_path, story, pool=pool))


@pytest.fixture
def files(tmp_path):
    """The mission `tiny` and its two plans as files."""
    (tmp_path / "tiny.yaml").write_text(TINY, encoding="utf-8")
    for name, plan in (("a.json", ROUTES), ("b.json", OTHER)):
        (tmp_path / name).write_text(json.dumps(plan), encoding="utf-8")
    return tmp_path


def said(capsys, *arguments):
    """What the command prints, as data."""
    command([*map(str, arguments), "--format", "json"])
    return json.loads(capsys.readouterr().out)


def test_an_uploaded_plan_is_kept_with_the_figures_of_the_judge(with_services, files):
    async def story(services):
        entry = await services.plans.upload(WHO, "tiny", {**ROUTES, "seed": 4, "rubbish": "x" * 100})
        assert (entry.id, entry.version, entry.origin, entry.author) == (1, 1, "uploaded", "ann")
        assert entry == await services.plans.get(1)
        verdict = muster.verify(muster.load(files / "tiny.yaml"), muster.read_plan(files / "a.json"))
        assert entry.plan["objective"] == {"name": "total+max", "value": verdict.value()}
        assert (entry.plan["total_cost"], entry.plan["tasks_completed"], entry.plan["seed"]) == (9.0, 2, 4)
        assert "rubbish" not in entry.plan
        (listed,) = await services.plans.list("tiny")
        assert listed.plan["total_cost"] == 9.0
        assert "routes" not in listed.plan
        assert [action.outcome for action in services.store.actions.list()] == ["done"]

    with_services(story)


def test_an_uploaded_plan_of_another_mission_is_kept_and_judged_so(with_services):
    async def story(services):
        entry = await services.plans.upload(WHO, "tiny", {**ROUTES, "mission": "depot"})
        verdict = await services.plans.verdict(entry.id)
        assert [violation["kind"] for violation in verdict["violations"]] == ["mission"]
        assert verdict["violations"][0]["detail"] == "the plan is of depot; expected tiny, or no name"

    with_services(story)


def test_an_uploaded_plan_that_is_none_is_refused(with_services):
    async def story(services):
        with pytest.raises(
            WorkError, match=r"^plan: schema: missing; expected muster-plan/1 \(and 1 more\)$"
        ) as refused:
            await services.plans.upload(WHO, "tiny", {"routes": 3})
        assert [finding.field for finding in refused.value.findings] == ["schema", "routes"]
        with pytest.raises(NotFoundError):
            await services.plans.upload(WHO, "nowhere", ROUTES)
        with pytest.raises(ForbiddenError):
            await services.plans.upload(WATCHER, "tiny", ROUTES)
        assert await services.plans.list() == []

    with_services(story)


def test_the_verdict_is_that_of_the_command(with_services, files, capsys):
    async def story(services):
        await services.plans.upload(WHO, "tiny", ROUTES)
        answer = await services.plans.verdict(1)
        assert answer == await services.plans.verdict(1)
        return answer

    answer = with_services(story)
    printed = said(capsys, "verify", files / "tiny.yaml", files / "a.json")
    assert {key: answer[key] for key in printed} == printed
    assert answer["lines"]["r_0"]["travel"] == [[[0, 0], [1, 0], [9, 0]]]


@pytest.mark.parametrize("task", [None, "a", "c"])
def test_explanations_are_those_of_the_command(with_services, files, capsys, task):
    async def story(services):
        await services.plans.upload(WHO, "tiny", ROUTES)
        return await services.plans.explain(1, task)

    answer = with_services(story)
    words, tables = answer.pop("words"), answer.pop("tables")
    asked = () if task is None else ("--task", task)
    assert answer == said(capsys, "explain", files / "tiny.yaml", files / "a.json", *asked)
    assert tables
    assert words
    assert all(line.endswith(".") for line in words)


@pytest.mark.parametrize("ask", ["verdict", "explain"])
def test_what_is_refused_reads_nothing(with_services, monkeypatch, ask):
    async def story(services):
        async def busy(*_, **__):
            raise BusyError("64 requests wait")

        monkeypatch.setattr(services.pool, "run", busy)
        monkeypatch.setattr(services.store.plans, "get", lambda plan: pytest.fail("a plan is read"))
        with pytest.raises(BusyError):
            await getattr(services.plans, ask)(1)

    with_services(story)


def test_explanations_in_words(with_services):
    async def story(services):
        await services.plans.upload(WHO, "tiny", ROUTES)
        return [(await services.plans.explain(1, task))["words"] for task in (None, "b", "c")]

    left_out, done, missing = with_services(story)
    assert left_out == [
        "1 task is left out: c.",
        "c could be done by r_0 with this change: skill crane.",
    ]
    assert done == [
        "Task b is done by r_0, as number 2 of 2.",
        "r_0 arrives at 9.00 s and ends at 9.00 s.",
        "With r_1 the objective would be 15.00 less: 3.00.",
    ]
    assert missing[0] == "Task c is left out."
    assert "r_0 could not: skill, lacks crane." in missing
    assert missing[-1] == "Smallest change: r_0: skill crane."


def test_a_task_that_is_not_there(with_services):
    async def story(services):
        await services.plans.upload(WHO, "tiny", ROUTES)
        with pytest.raises(WorkError, match=r"^--task: z; expected the id of a task of this mission"):
            await services.plans.explain(1, "z")
        with pytest.raises(NotFoundError):
            await services.plans.explain(2)

    with_services(story)


@pytest.mark.long
def test_exports_are_those_of_the_command(with_services, tmp_path, capsys):
    (tmp_path / "bay.yaml").write_text(BAY, encoding="utf-8")
    bay_plan().save(tmp_path / "bay.json")
    inputs = tmp_path / "bay.yaml", tmp_path / "bay.json"

    async def story(services):
        services.store.missions.create("bay", BAY, {}, {"name": "bay"}, "ann")
        await services.plans.upload(WHO, "bay", bay_plan().as_dict())
        forms = ("csv", "geojson", "gpx", "kml", "json")
        answers = {form: await services.plans.export(1, form) for form in forms}
        answers["qgc"] = await services.plans.export(1, "qgc", {"firmware": "ardupilot", "altitude": 5})
        answers["sheets"] = await services.plans.export(1, "sheets", {"altitudes": ["d1=40", "d2=50,d3=60"]})
        return answers

    answers = with_services(story)
    for form in ("csv", "geojson", "gpx", "kml"):
        assert command(["export", *map(str, inputs), "--to", form]) == 0
        (file,) = answers[form].values()
        assert base64.b64decode(file).decode("utf-8") == capsys.readouterr().out
    assert json.loads(base64.b64decode(answers["json"]["bay.json"]))["routes"][0]["tasks"] == ["b", "c"]
    folder = tmp_path / "plans"
    wishes = ("--firmware", "ardupilot", "--altitude", "5", "-o", str(folder))
    assert command(["export", *map(str, inputs), "--to", "qgc", *wishes]) == 0
    written = {file.name: file.read_bytes() for file in folder.iterdir()}
    notes = capsys.readouterr().err.encode("utf-8")
    printed = tmp_path / "sheets.pdf"
    heights = ("--altitudes", "d1=40,d2=50", "--altitudes", "d3=60", "-o", str(printed))
    assert command(["export", *map(str, inputs), "--to", "sheets", *heights]) == 0
    assert base64.b64decode(answers["sheets"]["bay-sheets.pdf"]) == printed.read_bytes()
    assert base64.b64decode(answers["sheets"]["NOTES.txt"]).decode("utf-8") == capsys.readouterr().err
    assert {name: base64.b64decode(data) for name, data in answers["qgc"].items()} == {**written, "NOTES.txt": notes}


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    ("to", "options", "line"),
    [
        ("pdf", {}, 'to: "pdf"; expected qgc, geojson'),
        ("csv", {"altitude": 5}, "options: .*; expected none with csv"),
        ("xlsx", {"per_robot": True}, 'options: "per_robot"; expected altitude'),
        ("ics", {}, ".*starts_at"),
        ("qgc", {"height": 5}, 'options: "height"; expected altitude'),
        ("qgc", {"altitude": -5}, "altitude: -5; expected metres"),
        ("qgc", {"firmware": "own"}, 'firmware: "own"; expected px4 or ardupilot'),
        ("gpx", {}, ".*.*origin_wgs84"),
    ],
)
def test_an_export_that_cannot_be_is_one_line(with_services, to, options, line):
    async def story(services):
        await services.plans.upload(WHO, "tiny", ROUTES)
        with pytest.raises(WorkError, match=f"^{line}[^\n]*$"):
            await services.plans.export(1, to, options)

    with_services(story)


def test_a_plan_that_breaks_rules_is_kept_and_not_exported(with_services):
    async def story(services):
        wrong = {"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["c"]}]}
        entry = await services.plans.upload(WHO, "tiny", wrong)
        assert not (await services.plans.verdict(entry.id))["valid"]
        with pytest.raises(WorkError, match=r"^plan: skill: r_0, c, .*; expected an admissible plan"):
            await services.plans.export(entry.id, "csv")

    with_services(story)


@pytest.mark.parametrize("what", ["routes", "gantt"])
def test_pictures(with_services, what):
    async def story(services):
        await services.plans.upload(WHO, "tiny", ROUTES)
        png, svg = [await services.plans.picture(1, what, form) for form in ("png", "svg")]
        assert png.startswith(b"\x89PNG\r\n")
        assert b"<svg" in svg
        with pytest.raises(WorkError, match=r"^format: \"gif\"; expected png or svg or pdf$"):
            await services.plans.picture(1, what, "gif")

    with_services(story)


def test_two_plans_side_by_side(with_services):
    async def story(services):
        for plan in (ROUTES, OTHER):
            await services.plans.upload(WHO, "tiny", plan)
        answer = await services.plans.compare(1, 2)
        assert [head["id"] for head in answer["plans"].values()] == [1, 2]
        figures = {figure["name"]: figure for figure in answer["figures"]}
        assert figures["total_cost"] == {"name": "total_cost", "a": 9.0, "b": 2.0, "change": -7.0, "better": "b"}
        assert figures["tasks_completed"]["better"] is None
        assert figures["equality_index"]["better"] == "b"
        assert (answer["moved"], answer["same"]) == ([{"task": "b", "a": "r_0", "b": "r_1"}], 1)
        services.store.missions.create("other", TINY, {}, {"name": "tiny"}, "ann")
        await services.plans.upload(WHO, "other", ROUTES)
        with pytest.raises(ParameterError, match=r"^plan 3 is of other; expected one of tiny, as plan 1$"):
            await services.plans.compare(1, 3)

    with_services(story)


def test_the_allocators_are_asked_for_once(with_services, monkeypatch):
    async def story(services):
        first = await services.plans.allocators()
        monkeypatch.setattr(services.pool, "run", None)
        assert await services.plans.allocators() == first
        assert {"greedy", "search"} <= {allocator["name"] for allocator in first}

    with_services(story)


@pytest.mark.long
def test_looking_at_plans_does_not_wait_for_planning(with_services):
    async def story(services):
        await services.plans.upload(WHO, "tiny", ROUTES)
        jobs = [await services.jobs.ask_plan(WHO, "tiny", time_limit=300.0) for _ in range(3)]
        while services.pool.busy < 1:
            await asyncio.sleep(0.01)
        async with asyncio.timeout(30):
            assert (await services.plans.verdict(1))["valid"]
        for job in jobs:
            await services.jobs.cancel(WHO, job.id)

    with_services(story)
