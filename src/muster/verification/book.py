"""Checks the book of an auction against the routes and against itself."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from muster.mission.model import Mission
from muster.mission.plan import Plan, teams_of, tie_order
from muster.verification.agreement import agrees
from muster.verification.verdict import Violation


def _done_by(mission: Mission, plan: Plan) -> dict[str, str]:
    """For each task the robot that does it, or the names of its team as an auction writes them."""
    teams = teams_of((route.robot, route.tasks) for route in plan.routes)
    stations = {station.id for station in mission.stations}
    return {task: "+".join(team[k] for k in tie_order(team)) for task, team in teams.items() if task not in stations}


def _is_coalition(known: set[str], name: str) -> bool:
    return name in known or set(name.split("+")) <= known


def book_faults(mission: Mission, plan: Plan) -> Iterator[Violation]:
    """Find where the account of an auction contradicts the routes, or itself."""
    if plan.book is None:
        return
    robot_of = _done_by(mission, plan)
    times = Counter(award.task for award in plan.book.awards)
    known = {robot.id for robot in mission.robots}
    for award in plan.book.awards:
        bids = dict(award.bids)
        wrong = (
            (award.task not in robot_of, "won, but in no route"),
            (robot_of.get(award.task, award.robot) != award.robot, f"won by {award.robot}, but done by another"),
            (times[award.task] > 1, f"won {times[award.task]} times"),
            (not 1 <= award.round <= plan.book.rounds, f"won in round {award.round} of {plan.book.rounds}"),
            (not all(_is_coalition(known, name) for name in bids), "a bid of no robot of the mission"),
            (award.bidders < len(bids), f"{len(bids)} bids of {award.bidders} robots"),
            (not agrees(bids.get(award.robot), award.price), f"won for {award.price}, which was not the bid"),
        )
        for found, detail in wrong:
            if found:
                yield Violation("book", award.robot, award.task, detail)
