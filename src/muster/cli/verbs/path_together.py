"""`muster path --together`: paths of several robots that share a map, in space and time."""

from __future__ import annotations

from typing import Any

import click

from muster.cli.exits import DONE
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import json_text
from muster.mission.texts.near_matches import did_you_mean


def run(mission: Mission, told: tuple[str, ...], cell: float | None, window: int | None, seed: int, form: str) -> int:
    """Find and print the paths of the robots named by `told`, ROBOT=X,Y each."""
    from muster.motion.map_world import World
    from muster.traffic.shared_paths import shared_paths
    from muster.traffic.space_time import NotTogether, Parameters

    if mission.map is None:
        raise ParameterError("--together: the mission has no map; expected one")
    goals = goals_of(mission, told)
    robots = {robot.id: robot for robot in mission.robots if robot.id in goals}
    kinds = {robot.kind for robot in robots.values()}
    if len(kinds) > 1:
        raise ParameterError(f"--together: robots of kinds {', '.join(sorted(kinds))}; expected one kind")
    radius = max(robot.radius_m for robot in robots.values())
    found = shared_paths(
        World.of(mission).free_space(radius, kinds.pop()),
        {name: (robots[name].position, goal) for name, goal in goals.items()},
        radius_m=radius,
        speed_mps=min(robot.speed_mps for robot in robots.values()),
        cell_m=cell,
        seed=seed,
        params=Parameters(window=window),
    )
    if isinstance(found, NotTogether):
        text = f"{found.robot}: {found.reason}"
        click.echo(json_text({"no_paths": text}) if form == "json" else f"no paths: {text}", nl=form != "json")
    elif form == "json":
        click.echo(json_text(_answer(found)), nl=False)
    else:
        _print(mission, found)
    return DONE


def goals_of(mission: Mission, told: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """Return the goal of each robot that ROBOT=X,Y names, metres in the map frame."""
    found: dict[str, tuple[float, float]] = {}
    known = [robot.id for robot in mission.robots]
    for text in told:
        name, _, place = text.partition("=")
        if name not in known:
            raise ParameterError(f"--together: {name!r}; expected a robot of the mission{did_you_mean(name, known)}")
        try:
            x, y = map(float, place.split(","))
        except ValueError:
            raise ParameterError(f"--together: {text!r}; expected ROBOT=X,Y, metres in the map frame") from None
        found[name] = (x, y)
    return found


def _answer(found: Any) -> dict[str, Any]:
    figures = zip(found.robots, found.lengths_m(), found.arrivals_s(), strict=True)
    least = found.least_distance_m()
    return {
        "cell_m": found.cell_m,
        "neighbours": found.neighbours,
        "least_distance_m": least if len(found.robots) > 1 else None,
        "times_s": found.times_s.tolist(),
        "robots": [
            {"robot": robot, "length_m": length, "arrives_s": arrives, "points": found.positions[:, k].tolist()}
            for k, (robot, length, arrives) in enumerate(figures)
        ],
    }


def _print(mission: Mission, found: Any) -> None:
    from muster.cli.tables.table import print_table

    rows = [
        (robot, f"{length:.2f}", f"{arrives:.2f}")
        for robot, length, arrives in zip(found.robots, found.lengths_m(), found.arrivals_s(), strict=True)
    ]
    print_table(("robot", "length [m]", "arrives [s]"), rows, right=("length [m]", "arrives [s]"))
    least = f", centres {found.least_distance_m():.3f} m apart at least" if len(rows) > 1 else ""
    click.echo(f"{mission.name}: cells of {found.cell_m:g} m, {found.neighbours} neighbours{least}")
