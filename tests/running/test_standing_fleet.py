"""A standing fleet in the kinematic world: the bench's hour in small, the same each time, and by the command."""

import json
import re
import threading
from contextlib import closing
from dataclasses import replace

import pytest

import muster
from muster.cli.main import run
from muster.cli.tables.report import print_report
from muster.execution import Standing
from muster.running.simulation import Simulation
from muster_control.client.handles import report_from
from muster_studies.benches.standing import fleet, most_per_hour, on_duty, orders


@pytest.mark.long
def test_half_a_minute_of_twenty_robots_with_a_burst_loses_nothing():
    shift = on_duty(fleet(1), 1, 30.0, burst_at_s=10.0)
    seen = shift.orders
    assert (shift.lost, seen.open, seen.refused, seen.done) == (0, 0, 0, seen.taken)
    assert seen.taken > 40
    assert seen.until_in_route.p95_s <= 1.0
    assert seen.improved > 1
    assert seen.done_per_hour < most_per_hour(seen.taken)


@pytest.mark.long
def test_the_same_orders_are_done_in_the_same_way_each_time():
    def carried_out():
        mission = replace(fleet(2), robots=fleet(2).robots[:5])
        standing = Standing(orders=list(orders(2, 20.0)), until_s=20.0)
        with closing(Simulation(mission, muster.solve(mission, "greedy"), standing=standing)) as simulation:
            while not simulation.done:
                simulation.advance(simulation.time_s + 10.0)
            return list(simulation.events), simulation.result()

    (events, report), again = carried_out(), carried_out()
    assert report.orders.improved > 0
    assert (events, report) == again


def test_orders_from_python_come_while_it_is_on_duty():
    mission = replace(fleet(3), robots=fleet(3).robots[:3])
    with closing(Simulation(mission, muster.solve(mission, "greedy"), standing=Standing())) as simulation:
        simulation.advance(until_s=10.0)
        simulation.report(muster.Event(at_s=0, new_task=muster.Task(id="a", position=(30, 20))))
        while simulation.time_s < 80:
            simulation.advance(until_s=80.0)
        assert not simulation.done
        assert simulation.result().orders.done == 1
        report = simulation.break_off("enough")
    assert (report.tasks_done, report.tasks_lost) == (("a",), ())


FLEET = """
schema: muster/1
rules: {objective: lateness}
robots: [{id: r_0, position: [0, 0]}, {id: r_1, position: [10, 0]}]
tasks: [{id: first, position: [1, 1]}]
"""


@pytest.fixture
def files(tmp_path):
    (tmp_path / "fleet.yaml").write_text(FLEET, encoding="utf-8")
    (tmp_path / "orders.csv").write_text("at_s,id,x,y\n1,a,2,3\n2,b,9,3\n30,c,5,5\n", encoding="utf-8")
    return tmp_path


def asked(files, *options):
    return run(["simulate", str(files / "fleet.yaml"), "-q", "--iterations", "100", *options])


def test_the_command_does_orders_from_a_file_and_tells_how_fast(files, capsys):
    assert asked(files, "--orders", str(files / "orders.csv")) == 0
    said = capsys.readouterr().out
    assert "tasks done        4 of 4" in said
    assert "orders            3: 3 done" in said
    assert "in a route after  " in said


def test_the_command_stays_on_duty_until_it_is_told(files, capsys):
    orders = ("--orders", str(files / "orders.csv"), "--format", "json")
    assert asked(files, "--stay", "--until", "20", *orders) == 0
    seen = json.loads(capsys.readouterr().out)
    assert (seen["orders"]["taken"], seen["orders"]["not_taken_from_s"]) == (2, 30.0)
    assert seen["mission_time_s"] < 30
    assert asked(files, "--stay", "--until", "90", *orders) == 0
    seen = json.loads(capsys.readouterr().out)["orders"]
    assert (seen["done_per_hour"], seen["not_taken_from_s"]) == (120.0, None)


def test_the_command_says_which_orders_it_does_not_take(files, capsys):
    assert asked(files, "--orders", str(files / "orders.csv"), "--stay", "--until", "20") == 0
    said = capsys.readouterr().out
    assert "orders            2: 2 done" in said
    assert "not taken         orders from 30.00 s on, after the end of duty" in said


UNFIT = """
{"at_s": 1, "new_task": {"id": "never", "position": [900, 0], "deadline_s": 2}}
{"at_s": 2, "cancel_task": "nobody"}
{"at_s": 50, "new_task": {"id": "a", "position": [1, 2]}}
"""


def test_each_refused_and_each_lost_order_has_a_line_with_the_reason(files, capsys):
    (files / "unfit.jsonl").write_text(UNFIT, encoding="utf-8")
    assert asked(files, "--orders", str(files / "unfit.jsonl")) == 0
    said = capsys.readouterr().out
    assert re.search(r'cancel_task nobody +2\.00 +task: "nobody"; expected the id of a task that there is', said)
    assert re.search(r"never +deadline: 2 s is over", said)
    assert "earlier" not in said
    assert asked(files, "--orders", str(files / "unfit.jsonl"), "--format", "json") == 0
    data = json.loads(capsys.readouterr().out)
    assert [(one["kind"], one["id"]) for one in data["orders"]["last_refused"]] == [("cancel_task", "nobody")]
    assert [one["task"] for one in data["tasks_lost"]] == ["never"]
    assert json.loads(json.dumps(report_from(data).as_dict())) == data


def test_interrupted_it_counts_the_open_orders_among_the_tasks(files, capsys):
    mission, halt = muster.load(files / "fleet.yaml"), threading.Event()

    def halt_when_ordered(event):
        if event.kind == "new_task":
            halt.set()

    plan, standing = muster.solve(mission, "greedy"), Standing(orders=[event_of("a", 9, 9)])
    report = muster.simulate(mission, plan, standing=standing, on_event=halt_when_ordered, halt=halt)
    print_report(report.as_dict(), mission, with_tasks=False)
    said = capsys.readouterr().out
    assert "tasks done        0 of 2" in said
    assert "orders            1: 1 open" in said


def event_of(name, *place):
    return muster.Event(at_s=0.5, new_task=muster.Task(id=name, position=place))


def test_orders_that_are_not_listed_any_more_are_counted(files, capsys):
    refused = [json.dumps({"at_s": k, "cancel_task": f"r{k}"}) for k in range(23)]
    late = {"position": [900, 0], "deadline_s": 30}
    lost = [json.dumps({"at_s": 23, "new_task": {"id": f"l{k}", **late}}) for k in range(21)]
    last = json.dumps({"at_s": 95, "new_task": {"id": "a", "position": [1, 2]}})
    (files / "many.jsonl").write_text("\n".join([*refused, *lost, last]), encoding="utf-8")
    assert asked(files, "--orders", str(files / "many.jsonl")) == 0
    said = capsys.readouterr().out
    assert "refused earlier   3 orders, not listed" in said
    assert "lost earlier      1 task, not listed" in said
    assert " r2 " not in said
    assert "cancel_task r3 " in said


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--until", "3"), "until_s: 3.0; expected it together with stay"),
        (("--orders", "nowhere.csv"), "nowhere.csv: No such file or directory; expected a file to read"),
        (("--stay", "--negotiate"), "--stay given; expected it without --negotiate"),
    ],
)
def test_what_does_not_go_together_is_refused(files, capsys, options, message):
    assert run(["simulate", str(files / "fleet.yaml"), "-q", *options]) == 2
    assert message in capsys.readouterr().err
