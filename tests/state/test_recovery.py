"""A run whose process is killed knows afterwards all that it knew before: its state is the fold of its log."""

import random

import pytest
from tests.state.campaign import trial
from tests.state.played import NEWCOMER, SAMPLES, Played, event, known, site

import muster
from muster.mission.events import Event
from muster.mission.records import specified


def test_each_kind_of_event_has_a_sample():
    assert SAMPLES.keys() == {field.name for field in specified(Event)} - {"at_s"}


@pytest.fixture(scope="module")
def plan():
    return muster.solve(site(), "search", iterations=50, seed=1)


@pytest.mark.long(keep=4)
@pytest.mark.parametrize("kind", SAMPLES)
@pytest.mark.parametrize("then_s", [3.0, 12.0, 30.0])
def test_what_an_event_has_changed_is_known_after_a_crash(plan, kind, then_s):
    for value in SAMPLES[kind]:
        run = Played(site(), plan)
        run.go_to(2.0)
        for earlier in (("door_closes", "a"), ("station_fails", "dock")) if kind.endswith(("opens", "returns")) else ():
            run.report(event(*earlier))
        run.report(event(kind, value))
        run.go_to(then_s)
        assert known(run.recovered) == known(run.executor.state)


@pytest.mark.parametrize(
    "seed", [*range(20), 58, 198, *(pytest.param(k, marks=pytest.mark.long) for k in range(200, 400))]
)
def test_whatever_has_happened_is_known_after_a_crash(plan, seed):
    draw = random.Random(seed)
    run = Played(site([Event(at_s=15.0, cancel_task="t_0"), Event(at_s=500.0, cancel_task="t_1")]), plan)
    for point in run.world.ports.values():
        point.refuses = draw.choice([(), ((3.0, 8.0, 0.0),), ((2.0, 2.0, 0.0), (13.0, 8.0, 0.0))])
    for _ in range(draw.randrange(1, 7)):
        run.go_to(run.world.now + draw.choice([0.5, 2.0, 7.0, 15.0]))
        kind = draw.choice(sorted(SAMPLES))
        run.report(event(kind, draw.choice(SAMPLES[kind])))
    run.go_to(run.world.now + draw.choice([0.0, 1.0, 10.0]))
    assert known(run.recovered) == known(run.executor.state)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(3))
def test_a_checkpoint_after_any_entry_and_what_follows_is_as_good_as_the_whole_log(plan, seed):
    draw = random.Random(seed)
    run = Played(site(), plan)
    for _ in range(5):
        run.go_to(run.world.now + draw.choice([0.5, 2.0, 7.0]))
        kind = draw.choice(sorted(SAMPLES))
        run.report(event(kind, draw.choice(SAMPLES[kind])))
    run.go_to(run.world.now + 5.0)
    for entries in range(1, len(run.log.entries) + 1):
        assert known(run.recovered_by(entries)) == known(run.executor.state)


@pytest.mark.parametrize("seed", [*range(6), 705, *(pytest.param(k, marks=pytest.mark.long) for k in range(6, 60))])
def test_random_runs_that_are_killed_again_and_again(seed):
    report = trial(seed)
    assert report.failures == []


def test_events_of_the_mission_file_that_fell_into_the_time_without_a_process_happen(plan):
    run = Played(site([Event(at_s=5.0, station_fails="dock"), Event(at_s=50.0, cancel_task="t_1")]), plan)
    run.go_to(3.0)
    for _ in range(20):
        run.world.step(0.5)
    run.kill()
    executor = run.executor
    assert executor.now_s == 13.0
    assert executor.stations.failed == {"dock"}
    assert executor._script.next_s == 50.0


def test_a_robot_that_joined_and_cannot_be_reached_is_known_again_when_it_joins_again(plan):
    run = Played(site(), plan)
    run.report(event("robot_joins", NEWCOMER))
    run.go_to(5.0)
    run.report(event("robot_fails", "r_9"))
    port = run.world.ports.pop("r_9")
    before = run.executor.state.robots["r_9"]
    run.kill()
    executor = run.executor
    assert "r_9" not in executor.crew
    run.world.ports["r_9"] = port
    executor.report(Event(at_s=0, robot_joins=NEWCOMER))
    assert executor.crew["r_9"].out == "robot_fails"
    assert executor.state.robots["r_9"].out_s == before.out_s
