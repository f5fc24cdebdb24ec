"""What every database does: round trips, versions, states, orders. Each test runs on SQLite and on PostgreSQL."""

from datetime import UTC, datetime, timedelta
from threading import Thread

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.muster_control.store.conftest import SUMMARY

from muster.mission.errors import ParameterError
from muster_control.contract import ConflictError, NotFoundError, StoreError, User
from muster_control.store import Store
from muster_control.store.missions import slug

TEXTS = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=20)
NUMBERS = st.one_of(st.integers(-(2**53), 2**53), st.floats(allow_nan=False, allow_infinity=False))
DATA = st.dictionaries(
    st.text(max_size=8),
    st.recursive(st.one_of(st.none(), st.booleans(), NUMBERS, st.text(max_size=8)), lambda x: st.lists(x, max_size=3)),
    max_size=4,
)
EACH = settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])


def test_opened_again_it_has_what_was_written(filled, database_url):
    filled.store.log.append(filled.run, 1.0, [filled.entry(1, text="ü")], [filled.stretch(1)])
    again = Store.open(database_url)
    assert again.missions.get("Yard") == filled.store.missions.get("Yard")
    assert again.plans.get(filled.plan).plan == {"weight": 2.5, "routes": [["r", ["1"]]]}
    assert again.log.entries(filled.run) == filled.store.log.entries(filled.run)
    again.check()
    again.close()


@pytest.mark.long(keep=1)
@EACH
@given(text=TEXTS, note=TEXTS, author=TEXTS, files=st.dictionaries(TEXTS, st.binary(max_size=20), max_size=3))
def test_a_version_comes_back_as_it_was(store, text, note, author, files):
    begun = datetime.now(UTC)
    made = store.missions.create("any", text, files, SUMMARY, author, note)
    found = store.missions.get(made.mission)
    assert found == made
    assert (found.text, found.note, found.author, dict(found.files)) == (text, note, author, files)
    assert begun <= found.at <= datetime.now(UTC)
    assert found.at.tzinfo is UTC


@pytest.mark.long(keep=1)
@EACH
@given(data=DATA, arguments=DATA)
def test_plain_data_comes_back_as_it_was(filled, data, arguments):
    store = filled.store
    plan = store.plans.add(filled.mission, 1, "uploaded", "ann", data)
    assert store.plans.get(plan.id).plan == data
    job = store.jobs.add("plan", filled.mission, 1, arguments, "ann")
    assert store.jobs.get(job.id).arguments == arguments
    action = store.actions.add(User("bo", "command", "::1"), "run.event", data, filled.run)
    assert store.actions.list(filled.run, limit=1) == [action]
    seq = len(store.log.entries(filled.run)) + 1
    entry = filled.entry(seq, **{f"k{key}": value for key, value in data.items()})
    store.log.append(filled.run, 0.0, [entry])
    [kept] = store.log.entries(filled.run, after=seq - 1)
    assert (kept.data, kept.kind, kept.time_s) == (entry.data, entry.kind, entry.time_s)


@pytest.mark.parametrize("text", ["a\0b", "\ud800"])
def test_texts_that_not_every_database_can_keep_are_refused(store, text):
    with pytest.raises(ParameterError, match=r"U\+(0000|D800)"):
        store.missions.create("any", text, {}, SUMMARY, "ann")
    assert store.missions.list() == []


@pytest.mark.parametrize("value", [float("nan"), float("inf"), object()])
def test_what_json_has_no_word_for_is_refused(filled, value):
    with pytest.raises(ParameterError):
        filled.store.plans.add(filled.mission, 1, "planned", "ann", {"weight": value})


def test_ids_are_made_of_names(store):
    ids = [store.missions.create(name, "", {}, SUMMARY, "ann").mission for name in ("Mühle 1", "Mühle 1", "../x", "工")]
    assert ids == ["Muhle-1", "Muhle-1-2", "x", "mission"]
    assert store.missions.create("31T", "", {}, SUMMARY, "ann", reserved={"31T"}).mission == "31T-2"
    assert store.missions.create("31T", "", {}, SUMMARY, "muster", shipped=True).mission == "31T"
    with pytest.raises(ConflictError, match="31T is there already"):
        store.missions.create("31T", "", {}, SUMMARY, "muster", shipped=True)


@given(st.text(max_size=120))
def test_an_id_may_stand_in_an_address(name):
    assert slug(name).strip("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") == ""
    assert 1 <= len(slug(name)) <= 80
    assert not slug(name).startswith(".")


def test_versions_follow_each_other(filled):
    missions = filled.store.missions
    second = missions.save("Yard", "b", {}, {**SUMMARY, "tasks": 4}, "bo", "one more", 1)
    assert (second.version, dict(second.files)) == (2, {})
    with pytest.raises(ConflictError, match="newest version is 2, yours was made from 1"):
        missions.save("Yard", "c", {}, SUMMARY, "ann", "", 1)
    assert [(v.version, v.author, v.note) for v in missions.versions("Yard")] == [(2, "bo", "one more"), (1, "ann", "")]
    assert [v.version for v in missions.versions("Yard", limit=1)] == [2]
    assert [[v.version for v in missions.versions("Yard", before=k)] for k in (2, 1)] == [[1], []]
    assert dict(missions.get("Yard", 1).files) == {"map.png": b"\x00\x89"}
    [entry] = missions.list()
    assert (entry.version, entry.tasks, entry.changed_at) == (2, 4, second.at)


def test_a_deleted_mission_stays_for_its_plans(filled):
    missions = filled.store.missions
    missions.delete("Yard")
    assert missions.list() == []
    for call in (
        lambda: missions.get("Yard"),
        lambda: missions.delete("Yard"),
        lambda: missions.save("Yard", "", {}, SUMMARY, "ann", "", 1),
    ):
        with pytest.raises(NotFoundError, match="no mission Yard"):
            call()
    assert missions.get("Yard", 1).text == "a: 1\n"
    assert filled.store.plans.get(filled.plan).mission == "Yard"
    missions.restore("Yard")
    assert [missions.get("Yard").version, *(entry.version for entry in missions.list())] == [1, 1]
    with pytest.raises(NotFoundError, match="no mission Mill"):
        missions.restore("Mill")


def test_equal_files_are_kept_once(filled):
    from sqlalchemy import func, select

    from muster_control.store.schema import blobs

    filled.store.missions.save("Yard", "b", {"map.png": b"\x00\x89", "same.png": b"\x00\x89"}, SUMMARY, "a", "", 1)
    with filled.store.database.reading() as connection:
        assert connection.execute(select(func.count()).select_from(blobs)).scalar() == 1


def test_what_is_not_there(store):
    for call in (
        lambda: store.missions.get("x"),
        lambda: store.missions.get("x", 1),
        lambda: store.missions.versions("x"),
        lambda: store.plans.get(1),
        lambda: store.plans.add("x", 1, "planned", "a", {}),
        lambda: store.jobs.get(1),
        lambda: store.jobs.begin(1),
        lambda: store.runs.get(1),
        lambda: store.runs.set(1, state="ended"),
        lambda: store.actions.settle(1, "done"),
        lambda: store.log.append(1, 0.0, []),
    ):
        with pytest.raises(NotFoundError, match=r"^no "):
            call()
    with pytest.raises(StoreError):  # a run of a plan that is not there
        store.runs.add("x", 1, 1, "kinematic", {}, 1.0, "a")


def test_plans_are_numbered_within_their_mission_and_listed_without_their_bulk(filled):
    plan = {"weight": 1.0, "routes": [], "unassigned": [], "history": [], "book": None, "seed": 3}
    second = filled.store.plans.add("Yard", 1, "uploaded", "bo", plan)
    other = filled.store.missions.create("Other", "", {}, SUMMARY, "ann").mission
    first = filled.store.plans.add(other, 1, "planned", "bo", plan)
    assert (second.version, first.version) == (2, 1)
    assert [p.id for p in filled.store.plans.list()] == [first.id, second.id, filled.plan]
    assert [p.id for p in filled.store.plans.list(limit=1)] == [first.id]
    assert [p.id for p in filled.store.plans.list("Yard", limit=1, before=second.id)] == [filled.plan]
    assert [p.plan for p in filled.store.plans.list("Yard")] == [{"weight": 1.0, "seed": 3}, {"weight": 2.5}]
    assert second.plan == plan


def test_a_job_from_beginning_to_end(filled):
    jobs = filled.store.jobs
    job = jobs.add("plan", "Yard", 1, {"allocator": "search"}, "ann")
    assert (job.state, job.begun_at, job.progress) == ("queued", None, None)
    jobs.progress(job.id, {"share": 0.1})
    assert jobs.get(job.id).progress is None  # it had not begun
    begun = jobs.begin(job.id)
    assert (begun.state, begun.asked_at <= begun.begun_at) == ("running", True)
    with pytest.raises(ConflictError, match=f"job {job.id} is running; expected one that is queued"):
        jobs.begin(job.id)
    jobs.progress(job.id, {"share": 0.5})
    assert jobs.get(job.id).progress == {"share": 0.5}
    done = jobs.end(job.id, "done", {"plan": filled.plan})
    assert (done.state, done.result, done.error, done.begun_at <= done.ended_at) == ("done", {"plan": 1}, "", True)
    with pytest.raises(ConflictError, match="is done"):
        jobs.end(job.id, "cancelled")
    assert jobs.get(job.id) == done


def test_jobs_go_on_after_a_restart(filled):
    jobs = filled.store.jobs
    ids = [jobs.add("plan", "Yard", 1, {}, "ann").id for _ in range(4)]
    jobs.begin(ids[0])
    jobs.progress(ids[0], {"share": 0.5})
    jobs.end(ids[2], "cancelled")
    queued = jobs.requeue()
    assert [(job.id, job.state, job.progress, job.begun_at) for job in queued] == [
        (i, "queued", None, None) for i in (ids[0], ids[1], ids[3])
    ]
    assert [job.id for job in jobs.list("cancelled")] == [ids[2]]
    assert [job.id for job in jobs.list(limit=2)] == [ids[3], ids[2]]
    filled.store.missions.create("Other", "", {}, SUMMARY, "ann")
    other = jobs.add("plan", "Other", 1, {}, "ann").id
    assert [job.id for job in jobs.list(mission="Other")] == [other]
    assert [job.id for job in jobs.list("queued", "Yard", 1)] == [ids[3]]


def test_a_run_from_beginning_to_end(filled):
    runs = filled.store.runs
    run = runs.get(filled.run)
    assert (run.state, run.speed, run.time_s, run.settings, run.ended_at) == ("starting", None, 0.0, {"seed": 3}, None)
    assert isinstance(run.time_s, float)
    assert runs.set(run.id, state="running", speed=2.0, resumed=1).speed == 2.0
    assert [r.id for r in runs.unfinished()] == [run.id]
    assert runs.list(over=True) == []
    ended = runs.set(run.id, state="ended")
    assert ended.ended_at >= run.at
    assert runs.unfinished() == []
    with pytest.raises(ConflictError, match="is over: ended"):
        runs.set(run.id, state="running")
    assert runs.set(run.id, remark="kept").ended_at == ended.ended_at
    at = datetime(2026, 1, 1, 13, tzinfo=UTC)
    assert runs.set(run.id, ended_at=at).ended_at == at
    with pytest.raises(TypeError, match="plan"):
        runs.set(run.id, plan=2)
    assert runs.list() == runs.list(over=True) == [runs.get(run.id)]


def test_times_of_other_zones_are_the_same_moment(filled):
    from datetime import timezone

    at = datetime(2026, 1, 1, 13, 30, 0, 123456, tzinfo=timezone(timedelta(hours=5, minutes=45)))
    assert filled.store.runs.set(filled.run, ended_at=at).ended_at == at
    with pytest.raises(ParameterError, match="zone"):
        filled.store.runs.set(filled.run, ended_at=datetime(2026, 1, 1))


def test_actions(filled):
    actions = filled.store.actions
    who = User("bo", "command", "10.0.0.1")
    kept = [actions.add(who, "run.pause", {"n": n}, filled.run) for n in range(3)]
    login = actions.add(who, "login", {})
    assert (kept[0].who, kept[0].role, kept[0].address, kept[0].outcome) == ("bo", "command", "10.0.0.1", "")
    actions.settle(kept[1].id, "done", 12.5)
    assert [a.id for a in actions.unsettled(filled.run)] == [kept[0].id, kept[2].id]
    assert [a.id for a in actions.list()] == [login.id, *(a.id for a in reversed(kept))]
    assert [a.id for a in actions.list(filled.run, limit=1, before=kept[2].id)] == [kept[1].id]
    [settled] = actions.list(filled.run, limit=1, before=kept[2].id)
    assert (settled.outcome, settled.applied_s) == ("done", 12.5)


def test_who_saves_at_once_loses_nothing(filled):
    """Of many who save from the same version one succeeds; all plans get numbers of their own."""
    outcomes, versions = [], []

    def save(name):
        try:
            filled.store.missions.save("Yard", name, {"f": b"new"}, SUMMARY, name, "", 1)
            outcomes.append(name)
        except ConflictError:
            pass
        versions.append(filled.store.plans.add("Yard", 1, "planned", name, {"by": name}).version)

    threads = [Thread(target=save, args=(f"user {k}",)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(outcomes) == 1
    assert filled.store.missions.get("Yard").author == outcomes[0]
    assert sorted(versions) == list(range(2, 10))
