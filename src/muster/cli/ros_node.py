"""One of the nodes that `muster ros` starts: `python -m muster.cli.ros_node system_monitor`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence

import click

from muster.mission.errors import MusterError


@click.command()
@click.option("--namespace", default="")
@click.option("--frame", default="map")
@click.option("--seed", type=int, default=0)
@click.option("--time-limit", type=float, default=2.0)
@click.argument("duty", type=click.Choice(["command_interface", "system_monitor", "mission_planner"]))
def command(duty: str, namespace: str, frame: str, seed: int, time_limit: float) -> None:
    """Run a node until standard input ends."""
    from muster.bridges.discovery import topics_in
    from muster.bridges.ros1.node_lifetime import live

    topics = topics_in(namespace)

    def command_interface() -> object:
        from muster import load
        from muster.bridges.ros1.command_interface import CommandInterface

        return CommandInterface(load)

    def system_monitor() -> object:
        from muster.bridges.ros1.system_monitor import SystemMonitor

        return SystemMonitor(namespace=namespace, topics=topics, frame=frame)

    def mission_planner() -> object:
        from muster import load, solve
        from muster.bridges.ros1.mission_planner import MissionPlanner

        return MissionPlanner(load, solve, topics=topics, seed=seed, time_limit=time_limit)

    duties: Sequence[Callable[[], object]] = (command_interface, system_monitor, mission_planner)
    live(duty, {do.__name__: do for do in duties}[duty])


def main() -> None:
    """Run the node; an expected failure is a line and exit code 2."""
    try:
        command.main(standalone_mode=False)
    except (MusterError, click.ClickException) as error:
        click.echo(str(error), err=True)
        sys.exit(2)


if __name__ == "__main__":
    main()
