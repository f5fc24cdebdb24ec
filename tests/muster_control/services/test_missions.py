"""Missions as the services has them: shipped and own ones, checked by a worker, saved, uploaded, written down."""

import asyncio
import base64
from contextlib import closing

import pytest
from hypothesis import given
from hypothesis import strategies as st

import muster
from muster.mission.errors import MissionError, MusterError, ParameterError
from muster_control.contract import ConflictError, ForbiddenError, NotFoundError, User
from muster_control.services import uploads
from muster_control.services.missions import Missions
from muster_control.services.shipped import shipped_entries, shipped_version
from muster_control.store import Store

ANN = User("ann", "command", "10.0.0.1")
FINDING = {"file": "mission.yaml", "line": 1, "field": "robots", "value": "missing", "expected": "a list"}


class Worker:
    """Stands for the pool: `bad` in a text is an error, `name: X` its name."""

    def __init__(self):
        self.asked = []

    async def run(self, task, arguments):
        self.asked.append((task, arguments))
        if task == "convert":
            return {"text": "name: converted", "needs": [], "notes": ["one", "two"]}
        if task == "edit":
            return {"text": f"name: {arguments['with'][0]}"}
        text = arguments["mission"]["text"]
        if "bad" in text:
            return {"errors": [FINDING], "impossible": [], "summary": None, "mission": None, "floor": None}
        name = text.partition("name: ")[2].splitlines()[0] if "name: " in text else arguments["mission"]["name"]
        summary = {"name": name, "robots": 1, "tasks": 2, "dimensions": 2}
        return {"errors": [], "impossible": [], "summary": summary, "mission": {}, "floor": None}


@pytest.fixture
def store(tmp_path):
    with closing(Store.open(f"sqlite:///{tmp_path}/muster.db")) as store:
        yield store


@pytest.fixture
def worker():
    return Worker()


@pytest.fixture
def missions(store, worker):
    return Missions(store, worker)


def outcomes(store):
    return [(action.verb, action.outcome) for action in reversed(store.actions.list())]


@pytest.mark.parametrize("name", shipped_entries())
def test_a_shipped_mission_is_listed_as_what_it_is(name, tmp_path):
    """What is read off its lines is what it means; and with the files beside it, it is the same mission."""
    entry, version = shipped_entries()[name], shipped_version(name)
    mission = muster.load(name)
    assert (entry.id, entry.name, entry.version, entry.shipped) == (name, mission.name, 0, True)
    assert (entry.robots, entry.tasks) == (len(mission.robots), len(mission.tasks))
    assert entry.dimensions == mission.dimensions
    for file, data in {f"{name}.yaml": version.text.encode(), **version.files}.items():
        uploads.require_file_name(file)
        (tmp_path / file).write_bytes(data)
    again = muster.load(tmp_path / f"{name}.yaml")
    assert (again.robots, again.tasks) == (mission.robots, mission.tasks)


def test_a_shipped_mission_is_stored_once_it_is_used(missions, store):
    async def story():
        assert (await missions.get("floor")).version == 0
        assert [v.version for v in await missions.versions("floor")] == [0]
        assert store.missions.list() == []
        both = await asyncio.gather(missions.stored("floor"), missions.stored("floor"))
        assert [v.version for v in both] == [1, 1]
        assert both[0].author == "muster"
        assert set(both[0].files) == {"floor-plan.png", "floor-plan.yaml"}
        assert [v.version for v in await missions.versions("floor")] == [1]
        assert (await missions.get("floor", 0)).text == both[0].text
        [entry] = [entry for entry in await missions.list() if entry.id == "floor"]
        assert (entry.version, entry.shipped, entry.robots) == (1, True, shipped_entries()["floor"].robots)
        assert len(await missions.list()) == len(shipped_entries())

    asyncio.run(story())


def test_a_shipped_mission_may_be_changed_but_not_deleted(missions, store):
    async def story():
        saved = await missions.save(ANN, "floor", "name: mine", 0, note="mine")
        assert (saved.version, saved.author, saved.note) == (2, "ann", "mine")
        assert set(saved.files) == {"floor-plan.png", "floor-plan.yaml"}
        with pytest.raises(ConflictError, match="newest version is 2"):
            await missions.save(ANN, "floor", "name: theirs", 0)
        with pytest.raises(ConflictError, match="floor comes with Muster"):
            await missions.delete(ANN, "floor")

    asyncio.run(story())
    assert [verb for verb, _ in outcomes(store)] == ["mission.save", "mission.save", "mission.delete"]


def test_own_missions(missions, store, worker):
    async def story():
        made = await missions.create(ANN, "name: Mine\n", {"map.png": b"\x89"})
        assert (made.mission, made.version, made.author) == ("Mine", 1, "ann")
        assert worker.asked[0][1]["mission"]["files"] == {"map.png": base64.b64encode(b"\x89").decode()}
        named = await missions.create(ANN, "name: Mine\n", name="31T-6R50")  # which a shipped mission has
        assert named.mission == "31T-6R50-2"
        saved = await missions.save(ANN, "Mine", "name: Mine too\n", 1)
        assert dict(saved.files) == {"map.png": b"\x89"}
        assert dict((await missions.save(ANN, "Mine", "name: x\n", 2, {})).files) == {}
        assert [entry.id for entry in (await missions.list())[:2]] == ["Mine", "31T-6R50-2"]
        await missions.delete(ANN, "Mine")
        with pytest.raises(NotFoundError):
            await missions.get("Mine")
        await missions.restore(ANN, "Mine")
        assert (await missions.get("Mine")).version == 3
        await missions.delete(ANN, "Mine")

    asyncio.run(story())
    assert {outcome for _, outcome in outcomes(store)} == {"done"}
    [first] = store.actions.list(limit=1)
    assert (first.who, first.role, first.address, first.data) == ("ann", "command", "10.0.0.1", {"mission": "Mine"})


def test_what_is_wrong_is_not_stored(missions, store):
    async def story():
        with pytest.raises(MissionError) as error:
            await missions.create(ANN, "bad\n")
        assert [finding.as_dict() for finding in error.value.findings] == [FINDING]
        assert (await missions.check("bad", {}))["errors"] == [FINDING]

    asyncio.run(story())
    assert store.missions.list() == []
    assert outcomes(store) == [("mission.create", "mission.yaml:1: robots: missing; expected a list")]


def test_who_may_only_watch(missions, store):
    bo = User("bo", "watch")
    for call in (
        lambda: missions.create(bo, "name: x"),
        lambda: missions.save(bo, "floor", "name: x", 0),
        lambda: missions.delete(bo, "floor"),
        lambda: missions.upload(bo, "x.yaml", b"name: x"),
    ):
        with pytest.raises(ForbiddenError, match="bo may only watch"):
            asyncio.run(call())
    assert (store.missions.list(), store.actions.list()) == ([], [])


def test_uploads(missions, worker):
    async def story():
        assert (await missions.upload(ANN, "Some yard.yaml", b"\xef\xbb\xbfrobots: []")).mission == "Some-yard"
        converted = await missions.upload(ANN, "tasks.csv", b"id,x\n")
        assert (converted.text, converted.note) == ("name: converted", "one\ntwo")
        assert worker.asked[-2] == ("convert", {"name": "tasks.csv", "files": {"tasks.csv": "aWQseAo="}})
        await missions.upload(ANN, "t.csv", b"", {"r.csv": b"r"}, robots="r.csv")
        files = {"r.csv": "cg==", "t.csv": ""}
        assert worker.asked[-2] == ("convert", {"name": "t.csv", "files": files, "robots": "r.csv"})
        with_map = await missions.upload(ANN, "m.yaml", b"name: m", {"map.png": b"1"})
        assert dict(with_map.files) == {"map.png": b"1"}
        named = await missions.upload(ANN, "n.yaml", b"name: n\ntravel: {ground: t.csv}", {"t.csv": b"1"})
        assert dict(named.files) == {"t.csv": b"1"}
        called = await missions.upload(ANN, "tasks.csv", b"id,x\n", name="South yard")
        assert (called.mission, called.text) == ("South-yard", "name: South yard")
        await missions.upload(ANN, "team.yaml", b"name: m", {"panels.csv": b""})
        files = {"panels.csv": "", "team.yaml": "bmFtZTogbQ=="}
        assert worker.asked[-2] == ("convert", {"name": "team.yaml", "files": files, "site": ["panels.csv"]})
        for name, data, words in (
            ("x.yaml", b"a\n\xff", r"x.yaml:2: byte 2 is not UTF-8"),
            ("x.exe", b"", "no mission; expected a name that ends in .yaml"),
            ("../x.yaml", b"", "no folders"),
        ):
            with pytest.raises(MusterError, match=words):
                await missions.upload(ANN, name, data)

    asyncio.run(story())


@pytest.mark.parametrize(
    "name",
    ["", ".", "..", "../x", "a/b", "a\\b", ".hidden", "a\0", "a\n", "x" * 121, "a.", "a ", "-rf", "C:x", "\u202ea"],
)
def test_names_that_files_may_not_have(missions, worker, name):
    with pytest.raises(ParameterError, match="no folders"):
        asyncio.run(missions.check("", {name: b""}))
    assert worker.asked == []


@given(st.text(max_size=130))
def test_a_name_that_is_taken_stays_in_its_folder(name):
    try:
        uploads.require_file_name(name)
    except ParameterError:
        return
    assert not set(name) & set('/\\\0:*?"<>|\n')
    assert not name.startswith(".")
    assert name.isprintable()


def test_what_is_too_large(missions, worker, monkeypatch):
    monkeypatch.setattr(uploads, "LARGEST_FILES", 10)
    monkeypatch.setattr(uploads, "LONGEST_TEXT", 10)
    monkeypatch.setattr(uploads, "MOST_FILES", 3)
    for text, files in (("x" * 11, {}), ("", {"a": b"123456", "b": b"12345"}), ("", dict.fromkeys("abcd", b""))):
        with pytest.raises(ParameterError, match="expected at most"):
            asyncio.run(missions.create(ANN, text, files))
    assert worker.asked == []
