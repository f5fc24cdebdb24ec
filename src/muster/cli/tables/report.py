"""Tables of the report of a run."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from typing import Any

import click

from muster.cli.tables.table import number, print_table
from muster.cli.tables.team import print_team
from muster.mission.model import Mission, Tag
from muster.mission.texts.counting import counted

_NEAR_M = 1.0
"""What was found farther from a tag is another one of its id."""
_SHOWN_S = 0.01  # by which waiting differs in what is printed
_MOST_HELD_UP = 5
"""Rows of waiting in traffic that are printed."""
_CAUSES = {
    "traffic": "other robots",
    "slot": "slots at stations",
    "prerequisite": "prerequisites",
    "window": "time windows",
    "lag": "lags",
    "team": "teams",
    "start": "tasks that begin together",
    "dependant": "dependants",
}
"""Causes of waiting, as the table has them."""
_OVER = {
    "deadlines_missed_s": "deadline missed",
    "within_exceeded_s": "begun too late",
    "shifts_exceeded_s": "after its shift",
}
"""Figures of the report by task or robot, in seconds, and their names."""
Report = Mapping[str, Any]
"""As `muster.execution.Report.as_dict` makes it, or as a record has it: what an older or other program wrote may lack
all but the ids."""


def print_report(report: Report, mission: Mission, *, with_tasks: bool) -> None:
    """Print the usage of robots beside the plan, figures, tasks lost, and with `with_tasks` each task done."""
    unit = "s" if mission.rules.usage == "time" else "m"
    columns: tuple[str, ...] = ("robot", f"planned [{unit}]", f"flown [{unit}]", "difference")
    rows: list[tuple[str, ...]] = [(row["robot"], *_usage(row)) for row in report.get("robots", ())]
    if any(row.get("charge") is not None for row in report.get("robots", ())):
        columns = (*columns, "battery")
        rows = [(*row, _charge(of)) for row, of in zip(rows, report["robots"], strict=True)]
    if any(robot.battery for robot in mission.all_robots):
        columns = (*columns, "least", f"charged [{unit}]", "visits", "waited [s]")
        rows = [(*row, *_at_stations(of)) for row, of in zip(rows, report["robots"], strict=True)]
    print_table(columns, rows, title=f"{mission.name}: {_how(report)}", right=columns[1:])
    _print_figures(report, mission, unit)
    _print_ground(report.get("ground"))
    _print_orders(report.get("orders"))
    _print_lateness(report)
    _print_traffic(report)
    if report.get("reallocations"):
        of_tasks = "; of tasks by the one in force then" if with_tasks else ""
        click.echo(f"planned           of robots: by the plan that the mission began with{of_tasks}")
    if with_tasks:
        _print_tasks(report, unit)
    _print_refused(report.get("orders"))
    _print_lost(report)
    for task, robots in report.get("done_twice", {}).items():
        click.echo(f"{'done twice':<17} {task}, by {', '.join(robots)}")
    print_team(report.get("team"))
    _print_found(report, mission)
    for remark in report.get("remarks", ()):
        click.echo(f"{'remark':<17} {remark}")


def _charge(row: Mapping[str, Any]) -> str:
    return "-" if row.get("charge") is None else f"{100 * row['charge']:.1f} %"


def _at_stations(row: Mapping[str, Any]) -> tuple[str, ...]:
    """The least level of a robot's battery, what was added to it, how often, and for how long the robot waited."""
    least = row.get("least_charge")
    return (
        "-" if least is None else f"{100 * least:.1f} %",
        number(row.get("charged", 0.0)),
        str(row.get("station_visits", 0)),
        number(row.get("slot_wait_s", 0.0)),
    )


def _how(report: Report) -> str:
    remarks = report.get("remarks", ())
    return "interrupted" if any(remark.startswith("interrupted") for remark in remarks) else "carried out"


def _print_figures(report: Report, mission: Mission, unit: str) -> None:
    forgotten = report.get("tasks_forgotten", {})
    done = len(report.get("tasks_done", ())) + forgotten.get("done", 0)
    lost = len(report.get("tasks_lost", ())) + forgotten.get("lost", 0) + forgotten.get("cancelled", 0)
    came = (report.get("orders") or {}).get("taken", 0)
    came -= (report.get("ground") or {}).get("frontiers_seen", 0)
    known = max(done + lost, len(mission.tasks) + came)  # more than these two if it was interrupted
    for name, value in (
        ("mission time", f"{number(report.get('mission_time_s'))} s"),
        ("tasks done", f"{done} of {known}"),
        ("objective", _objective(report.get("objective"), unit)),
        ("waiting", _waiting(report)),
        ("least distance", _nearness(report)),
        ("planned again", counted(report.get("reallocations", 0), "time")),
    ):
        click.echo(f"{name:<17} {value}")


def _print_ground(ground: Report | None) -> None:
    """Print what robots without a map found out, and their ways beside those with it."""
    if not ground:
        return
    driven, known = ground.get("driven_m"), ground.get("with_map_m")
    ratio = f", {driven / known:.2f} times" if driven and known else ""
    frontiers = f", {counted(ground['frontiers'], 'frontier')} as tasks" if ground.get("frontiers") else ""
    click.echo(f"{'explored':<17} {number(ground.get('explored_m2'))} m2{frontiers}")
    if driven is not None:
        click.echo(f"{'ways':<17} {number(driven)} m, with the map {number(known)} m{ratio}")


def _print_orders(orders: Report | None) -> None:
    """Print what became of tasks that came while the mission was carried out, and how fast."""
    if not orders:
        return
    fates = {name: orders.get(name, 0) for name in ("done", "open", "cancelled", "lost", "refused")}
    came_to = ", ".join(f"{count} {name}" for name, count in fates.items() if count)
    rows = {
        "orders": f"{orders['taken']}: {came_to or 'none done'}; {orders['done_per_hour']:g} done an hour",
        "not taken": _not_taken(orders),
        "in a route after": _seconds(orders["until_in_route"]) if orders["taken"] else "",
        "done after": _seconds(orders["until_done"]) if orders["done"] else "",
        "clock behind by": _seconds(orders["clock_lag"]) if orders.get("clock_lag") else "",
    }
    for name, value in rows.items():
        if value:
            click.echo(f"{name:<17} {value}")


def _print_refused(orders: Report | None) -> None:
    """Print each order that did not fit, and why."""
    if not orders or not orders.get("refused"):
        return
    rows = [
        (f"{row.get('kind', 'order')} {row['id']}", number(row.get("at_s")), str(row.get("reason", "-")))
        for row in orders.get("last_refused", ())
    ]
    if rows:
        print_table(("order refused", "at [s]", "reason"), rows, right=("at [s]",))
    if more := orders["refused"] - len(rows):
        click.echo(f"{'refused earlier':<17} {counted(more, 'order')}, not listed")


def _print_lost(report: Report) -> None:
    """Print each task that was lost, and why."""
    rows = [(row["task"], str(row.get("reason", "-"))) for row in report.get("tasks_lost", ())]
    if rows:
        print_table(("task lost", "reason"), rows)
    if more := report.get("tasks_forgotten", {}).get("lost", 0):
        click.echo(f"{'lost earlier':<17} {counted(more, 'task')}, not listed")


def _not_taken(orders: Report) -> str:
    """From when on orders were not taken, if there were any."""
    from_s = orders.get("not_taken_from_s")
    return "" if from_s is None else f"orders from {number(from_s)} s on, after the end of duty"


def _seconds(figures: Report) -> str:
    """What half of all, 95 % of them, and the longest took."""
    median, p95, most = (number(figures[key]) for key in ("median_s", "p95_s", "most_s"))
    return f"{median} s (median), {p95} s (95 %), {most} s (at most)"


def _waiting(report: Report) -> str:
    """For how long robots waited, and why, where time windows, lags or teams made them wait."""
    total, causes = report.get("waiting_s"), report.get("waiting_by_cause_s", {})
    by_cause = ", ".join(f"{number(seconds)} s for {_CAUSES.get(cause, cause)}" for cause, seconds in causes.items())
    if not by_cause:
        return f"{number(total)} s"
    # Causes are known of tasks that were not done, too.
    in_vain = sum(causes.values()) - (total or 0.0) > _SHOWN_S
    return f"{number(total)} s at tasks done; at all: {by_cause}" if in_vain else f"{number(total)} s ({by_cause})"


def _print_lateness(report: Report) -> None:
    """Print what was not in time."""
    if report.get("lateness_s"):
        click.echo(f"{'late':<17} {number(report['lateness_s'])} s after due times, in all")
    for key, words in _OVER.items():
        for name, seconds in report.get(key, {}).items():
            click.echo(f"{words:<17} {name}, by {number(seconds)} s")
    rows = [(row["task"], number(row.get("at_s")), str(row.get("reason", "-"))) for row in report.get("missed", ())]
    if rows:
        print_table(("task not begun in time", "at [s]", "reason"), rows, right=("at [s]",))


def _print_traffic(report: Report) -> None:
    """Print who held up whom in traffic, the longest waiting first."""
    found = report.get("traffic", ())
    rows = [
        (
            row["robot"],
            row["waits_for"],
            number(row.get("waiting_s")),
            str(row.get("times", "-")),
            number(row.get("longest_s")),
            ", ".join(number(value) for value in row.get("position", ())[:2]),
        )
        for row in found[:_MOST_HELD_UP]
    ]
    if rows:
        columns = ("waits in traffic", "for", "waited [s]", "times", "longest [s]", "there at [m]")
        print_table(columns, rows, right=columns[2:5])
    if len(found) > len(rows):
        click.echo(f"{'in traffic':<17} and {counted(len(found) - len(rows), 'more pair')} of robots")


def _nearness(report: Report) -> str:
    """The least distance between robots, where it was measured."""
    least, contacts = report.get("min_distance_m"), report.get("contacts")
    distance = "-" if least is None else f"{number(least)} m"
    return "not measured" if contacts is None else f"{distance}, {counted(contacts, 'contact')}"


def _print_found(report: Report, mission: Mission) -> None:
    """Print which tags cameras found, and which they did not."""
    found = [row for row in report.get("found", ()) if "tag" in row and len(row.get("position", ())) >= 2]
    if found:
        columns = ("tag", "x [m]", "y [m]", "sure to [m]", "off by [m]", "seen", "by", "found [s]", "became")
        rows = [
            (
                str(row["tag"]),
                *(number(value) for value in row["position"][:2]),
                *("-" if row.get(key) is None else f"{row[key]:.3f}" for key in ("sure_to_m", "error_m")),
                counted(row.get("sightings", 0), "time"),
                ", ".join(row.get("robots", ())),
                number(row.get("found_s")),
                row.get("task") or "-",
            )
            for row in found
        ]
        print_table(columns, rows, title="found by cameras", right=columns[1:6])
    alone = {tag: count == 1 for tag, count in Counter(tag.id for tag in mission.tags).items()}
    missed = [str(tag.id) for tag in mission.tags if not any(_is(row, tag, alone[tag.id]) for row in found)]
    if missed:
        click.echo(f"{'not found':<17} {counted(len(missed), 'tag')}: {', '.join(missed)}")


def _is(row: Report, tag: Tag, is_alone: bool) -> bool:
    """Whether a finding is this tag: the only one of its id, or the one that is there."""
    return bool(row["tag"] == tag.id and (is_alone or math.dist(row["position"][:2], tag.position[:2]) < _NEAR_M))


def _objective(objective: Report | None, unit: str) -> str:
    if objective is None:
        return "-"
    unit = "s" if objective["name"] in ("makespan", "lateness") else unit
    planned, flown = (number(objective[key]) for key in ("planned", "flown"))
    return f"{flown} {unit}, planned {planned} {unit}  ({objective['name']})"


def _print_tasks(report: Report, unit: str) -> None:
    usages = (f"planned [{unit}]", f"flown [{unit}]", "difference")
    columns = ("task", "robot", "starts [s]", "ends [s]", *usages, "waited [s]")
    starts, ends = report.get("starts_s", {}), report.get("ends_s", {})
    rows = [
        (
            row["task"],
            ", ".join(row.get("team", ())) or row["robot"],
            number(starts.get(row["task"])),
            number(ends.get(row["task"])),
            *_usage(row),
            number(row["waiting_s"]),
        )
        for row in report.get("tasks", ())
    ]
    print_table(columns, rows, right=columns[2:])


def _usage(row: Report) -> tuple[str, str, str]:
    planned, flown = row["usage_planned"], row["usage_flown"]
    return number(planned), number(flown), f"{100 * (flown / planned - 1):+.1f} %" if planned > 0 else "-"
