"""`muster path --joint`: paths of many robots at once, step by step, on a MovingAI map or on a mission's roadmap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path as File
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from muster.cli.exits import DONE
from muster.mission.errors import ParameterError
from muster.mission.plan import json_text
from muster.mission.system.clock import ProcessorClock
from muster.mission.values.arrays import Floats

if TYPE_CHECKING:
    from muster.cli.options.common import MissionFile
    from muster.traffic.joint_instance import JointInstance
    from muster.traffic.joint_paths import JointPaths


@dataclass(frozen=True)
class Limits:
    """What ends the search; with `expansions` alone the same seed gives the same paths."""

    time_limit: float | None
    expansions: int | None
    seed: int


def run(instance: JointInstance, limits: Limits, form: str, output: File | None, plot: File | None) -> int:
    """Find joint paths, judge them, print their figures, and write them."""
    from muster.traffic.joint_path_faults import graph_faults
    from muster.traffic.joint_paths import NoJointPaths, Parameters, joint_paths

    clock = ProcessorClock()
    begin = clock.now()
    time_limit = 10.0 if limits.time_limit is None and limits.expansions is None else limits.time_limit
    found = joint_paths(
        instance.graph,
        instance.starts,
        instance.goals,
        time_limit=time_limit,
        expansions=limits.expansions,
        seed=limits.seed,
        params=Parameters(refine=True),
    )
    cpu_s = clock.now() - begin
    if isinstance(found, NoJointPaths):
        text = f"{found.reason}{'; proven' if found.proven else ''}"
        answer = {"no_paths": found.reason, "proven": found.proven}
        click.echo(json_text(answer) if form == "json" else f"no paths: {text}", nl=form != "json")
        return DONE
    ends = list(zip(instance.starts, instance.goals, strict=True))
    wrong = graph_faults(instance.graph.size, instance.edges, found.vertices.T.tolist(), ends)
    if wrong:
        raise AssertionError(f"the judge rejects these paths: {wrong[0]}")
    figures = _figures(instance, found, cpu_s, limits.seed)
    if output is not None:
        _write(output, instance, found, figures)
    if plot is not None:
        from muster.report.figures.files import save_figure
        from muster.report.maps.joint_picture import plot_joint_paths

        facts = f"{len(instance.robots)} robots, sum of costs {figures['sum_of_costs']:,}"
        save_figure(plot_joint_paths(instance.places, instance.edges, found.vertices, instance.name, facts), plot)
    if form == "json":
        click.echo(json_text(figures), nl=False)
    else:
        _print(instance, figures)
    return DONE


def of_map(file: File, scenario: File | None, agents: int | None) -> JointInstance:
    """Return the first robots of a scenario on a MovingAI map.

    Raises
    ------
    InputError
        where a file is not what it should be, with the line.
    ParameterError
        where no scenario is given, or it has fewer robots.
    """
    from muster.traffic.joint_instance import JointInstance
    from muster.traffic.joint_paths import grid_graph
    from muster.traffic.movingai import read_map, read_scenario, require_fitting

    if scenario is None:
        raise ParameterError("--joint: a map without a scenario; expected --scenario FILE (.scen)")
    blocked = read_map(file)
    ends = read_scenario(scenario)
    count = _count(agents, len(ends), f"{scenario} has")
    require_fitting(scenario, ends[:count], blocked)
    graph, numbers = grid_graph(blocked)
    rows = np.argwhere(numbers >= 0)
    edges = []
    for low, high in ((numbers[:, :-1], numbers[:, 1:]), (numbers[:-1], numbers[1:])):
        both = (low >= 0) & (high >= 0)
        edges += list(zip(low[both].tolist(), high[both].tolist(), strict=True))
    starts, goals = ([int(numbers[getattr(one, side)]) for one in ends[:count]] for side in ("start", "goal"))
    both_ways = [*edges, *((b, a) for a, b in edges)]
    names = [str(k) for k in range(count)]
    return JointInstance(file.name, graph, both_ways, rows[:, ::-1].astype(np.float64), names, starts, goals)


def of_mission(mission: MissionFile, goals: Sequence[str], agents: int | None, *, verbose: bool) -> JointInstance:
    """Return robots of a mission on its roadmap: each from the point nearest to its place to that nearest to its goal.

    Raises
    ------
    ParameterError
        where no goals are given, or two robots have the same point.
    """
    from muster.cli.verbs.path_together import goals_of
    from muster.traffic.joint_instance import JointInstance
    from muster.traffic.mission_roadmap import MissionRoadmap

    loaded = mission.load(verbose=verbose)
    if not goals:
        raise ParameterError("--joint: no goals; expected --together ROBOT=X,Y for each robot")
    wanted = goals_of(loaded, tuple(goals))
    roadmap = MissionRoadmap.of(loaded).roadmap
    names = list(wanted)[: _count(agents, len(wanted), "--together names")]
    positions = {robot.id: robot.position[:2] for robot in loaded.robots}
    starts = _nearest(roadmap.points, "start", {name: positions[name] for name in names})
    ends = _nearest(roadmap.points, "goal", {name: wanted[name] for name in names})
    return JointInstance.of_edges(loaded.name, np.asarray(roadmap.points), roadmap.edges, names, starts, ends)


def _nearest(points: Floats, side: str, places: dict[str, Any]) -> list[int]:
    """Return the point of the roadmap that is nearest to each place."""
    taken: dict[int, str] = {}
    for name, place in places.items():
        point = int(np.argmin(np.linalg.norm(points - np.asarray(place), axis=1)))
        if point in taken:
            x, y = points[point]
            raise ParameterError(
                f"--joint: the {side} of {name} and that of {taken[point]} are nearest to the same point, "
                f"({x:g}, {y:g}); expected a point of the roadmap for each"
            )
        taken[point] = name
    return list(taken)


def _count(agents: int | None, there: int, what: str) -> int:
    if agents is not None and agents > there:
        raise ParameterError(f"--agents: {agents}; expected at most {there}: {what} no more robots")
    return there if agents is None else agents


def _figures(instance: JointInstance, found: JointPaths, cpu_s: float, seed: int) -> dict[str, Any]:
    from muster.traffic.joint_paths import costs

    cost = costs(found.vertices, instance.goals)
    return {
        "agents": len(instance.robots),
        "steps": len(found.vertices) - 1,
        "sum_of_costs": cost["sum of costs"],
        "lower_bound": found.least_sum,
        "makespan": cost["makespan"],
        "sum_of_loss": cost["sum of loss"],
        "cpu_s": cpu_s,
        "expansions": found.expansions,
        "seed": seed,
    }


def _print(instance: JointInstance, figures: dict[str, Any]) -> None:
    from muster.cli.tables.table import print_table
    from muster.mission.texts.counting import counted

    shown = ("steps", "sum_of_costs", "lower_bound", "makespan", "sum_of_loss", "expansions")
    rows = [(name.replace("_", " "), f"{figures[name]:,}") for name in shown]
    print_table(("paths", "number"), [*rows, ("CPU time [s]", f"{figures['cpu_s']:.3f}")], right=("number",))
    robots = counted(figures["agents"], "robot")
    click.echo(f"{instance.name}: {robots}, seed {figures['seed']}; judged, no conflict")


def _write(file: File, instance: JointInstance, found: JointPaths, figures: dict[str, Any]) -> None:
    """Write the paths as JSON, or as the text that LaCAM and others write: a line for each step."""
    cells = instance.places[found.vertices]
    if file.suffix.lower() == ".json":
        robots = [{"robot": name, "points": cells[:, k].tolist()} for k, name in enumerate(instance.robots)]
        file.write_text(json_text(figures | {"robots": robots}))
        return
    head = {
        "agents": figures["agents"],
        "map_file": instance.name,
        "solver": "muster",
        "solved": 1,
        "soc": figures["sum_of_costs"],
        "soc_lb": figures["lower_bound"],
        "makespan": figures["makespan"],
        "sum_of_loss": figures["sum_of_loss"],
        "comp_time": round(1000 * figures["cpu_s"]),
        "seed": figures["seed"],
    }
    lines = [f"{key}={value}" for key, value in head.items()]
    lines += [f"{key}={_line(row)}" for key, row in (("starts", cells[0]), ("goals", cells[-1]))]
    lines += ["solution=", *(f"{step}:{_line(row)}" for step, row in enumerate(cells))]
    file.write_text("\n".join(lines) + "\n")


def _line(places: Floats) -> str:
    return "".join(f"({x:g},{y:g})," for x, y in places.tolist())
