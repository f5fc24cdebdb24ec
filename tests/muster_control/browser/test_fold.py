"""The fold of events of the live page (`mission_state.js`) knows after each event what `muster.state` knows."""

import random
from base64 import b64encode
from importlib.resources import files

import pytest
from tests.state.drawn_events import Drawn, tied_site
from tests.state.played import SAMPLES, Played, event, site
from tests.state.test_recovery import plan  # noqa: F401 - a fixture

from muster.mission.events import Event
from muster.mission.reading.plan_reader import plan_from
from muster.mission.yaml_writer import plain
from muster.state import MissionState, event_of
from muster.state.event import KINDS
from muster.state.robots import OUT
from muster.state.run_events import PlanAdopted


def module_of(package, *path, imported=("\0", "")):
    """A script as an address that modules are imported from, with the name of a module in it replaced."""
    script = files(package).joinpath(*path).read_text(encoding="utf-8").replace(*imported)
    return "data:text/javascript;base64," + b64encode(script.encode()).decode()


EXPLORED = module_of("muster.report.page", "modules", "explored.js")
MODULE = module_of(
    "muster_control.pages.live", "js", "mission_state.js", imported=("muster-record/explored.js", EXPLORED)
)
NOT_SHOWN = {
    *(
        "sets_out",
        "arrives",
        "waits",
        "part_ends",
        "standstill",
        "returns",
        "robot_at_end",
        "no_way_to_end",
    ),
    *("robot_runs_low", "energy_low", "robot_charged", "robot_sent_again", "robot_goes_round", "robot_makes_room"),
    *("robot_stands_aside", "waits_in_traffic", "goes_on", "traffic_jam", "final_states", "elsewhere", "robots_free"),
    *("goes_to_station", "arrives_at_station", "waits_for_slot", "service_begins", "service_ends", "event_refused"),
    "way_closed",
}
"""Kinds of events that change nothing of the state that pages show."""
FOLD = """async ([script, mission, entries]) => {
  const { MissionState } = await import(script);
  const state = new MissionState(mission);
  const sorted = (map, of = (one) => one) => Object.fromEntries([...map].map(([id, one]) => [id, of(one)]).sort());
  return [null, ...entries].map((entry) => {
    if (entry) state.apply(entry);
    return JSON.stringify({
      robots: sorted(state.robots, ({ out, route, home }) => ({ out, route, home })),
      tasks: sorted(state.tasks, ({ state, place, robots }) => ({ state, place, robots })),
      doors: [...state.closedDoors].sort(), failed: [...state.failedStations].sort(),
      cut_off: [...state.cutOffStations].sort(), left_out: sorted(state.leftOut), refusals: sorted(state.refusals),
      missed: sorted(state.missed, ({ reason, next }) => [reason, next]),
      lying: [...state.lying.keys()].sort(), delays: sorted(state.delays),
      explored: state.explored && { cell: state.explored.cell, origin: state.explored.origin, rows: state.explored.rows,
        area: state.explored.area },
      twice: sorted(state.doneTwice), forgotten: state.forgotten, replanned: state.replanned, ended: state.ended,
    });
  }).map(JSON.parse);
}"""


def known(state):
    """What pages show of a state."""
    ledger = state.ledger
    return plain(
        {
            "robots": {
                name: {"out": one.out, "route": state.routes.get(name, ()), "home": three(one.robot.position)}
                for name, one in state.robots.items()
            },
            "tasks": {
                name: {"state": state.stage(name), "place": three(task.position), "robots": ledger.teams.get(name, ())}
                for name, task in state.tasks.items()
            },
            "doors": sorted(state.doors.closed),
            "failed": sorted(state.failed_stations),
            "cut_off": sorted(state.cut_off_stations),
            "left_out": state.left_out,
            "refusals": {task: why for task, why in ledger.refusals.items() if why},
            "missed": {one.task: [one.reason, one.next_s] for one in ledger.missed},
            "lying": sorted(task for task in state.goods.lying if task not in ledger.ends_s),
            "delays": ledger.delays_s,
            "explored": None if state.explored is None else explored(state.explored),
            "twice": state.done_twice,
            "forgotten": {how: getattr(ledger.retired, how) for how in ("done", "lost", "cancelled")},
            "replanned": state.replanned,
            "ended": state.ended_s,
        }
    )


def explored(chart):
    return {"cell": chart.cell_m, "origin": chart.origin, "rows": chart.rows, "area": chart.explored_m2}


def three(position):
    return [*position, 0.0][:3]


@pytest.fixture(scope="module")
def page(chromium):
    page = chromium.new_page()
    yield page
    page.close()


@pytest.fixture(scope="module")
def both(page):
    """Applies entries to both folds, and compares after each."""

    def compare(mission, entries):
        state = MissionState(mission)
        seen = page.evaluate(FOLD, [MODULE, plain(mission), entries])
        assert seen[0] == known(state)
        for entry, after in zip(entries, seen[1:], strict=True):
            state.apply(event_of(entry["time_s"], entry["kind"], entry["data"]))
            assert after == known(state), entry
        return state

    return compare


def test_each_kind_of_event_changes_something_or_is_named_as_not_shown(page):
    kinds = set(page.evaluate("async (script) => (await import(script)).KINDS", MODULE))
    assert kinds.isdisjoint(NOT_SHOWN)
    assert kinds | NOT_SHOWN == set(KINDS)


@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.long) for k in range(1, 40))])
def test_both_know_the_same_after_each_event_of_a_run(both, plan, seed):  # noqa: F811
    draw = random.Random(seed)
    run = Played(site([Event(at_s=9.0, new_task=SAMPLES["new_task"][0])]), plan)
    for point in run.world.ports.values():
        point.refuses = draw.choice([(), ((3.0, 8.0, 0.0),), ((2.0, 2.0, 0.0), (13.0, 8.0, 0.0))])
    for _ in range(6):
        run.go_to(run.world.now + draw.choice([0.5, 2.0, 7.0, 15.0]))
        kind = draw.choice(sorted(SAMPLES))
        run.report(event(kind, draw.choice(SAMPLES[kind])))
    run.go_to(run.world.now + 60.0)
    assert len(run.log.entries) > 20
    state = both(run.mission, run.log.entries)
    assert {"done", "open"} & set(state.stages.values())
    both(run.mission, list(differences(run.mission, run.log.entries)))


def differences(mission, entries):
    """The same entries with what plans change in place of whole plans."""
    state = MissionState(mission)
    for entry in entries:
        made = event_of(entry["time_s"], entry["kind"], entry["data"])
        if entry["kind"] == "plan":
            made = PlanAdopted.of(plan_from(entry["data"]["plan"], "the test"), state).at(entry["time_s"])
        yield {**entry, "data": plain(made.data)}
        state.apply(made)


@pytest.mark.long
@pytest.mark.parametrize("seed", [*range(3), *(pytest.param(k, marks=pytest.mark.long) for k in range(3, 100))])
def test_both_know_the_same_after_events_in_any_order(both, plan, seed):  # noqa: F811
    both(tied_site(), list(Drawn(seed, plan).entries(300)))


@pytest.mark.long
def test_random_events_are_of_all_kinds(plan):  # noqa: F811
    assert {entry["kind"] for seed in range(18) for entry in Drawn(seed, plan).entries(300)} == set(KINDS)


@pytest.mark.long
def test_a_robot_that_is_out_is_known_by_the_kinds_of_python():
    assert OUT.keys() == {kind for kind, made in KINDS.items() if issubclass(made, KINDS["robot_fails"].__mro__[1])}
