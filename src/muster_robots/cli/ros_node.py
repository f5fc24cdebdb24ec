"""One of the nodes that `muster ros` starts: `python -m muster_robots.cli.ros_node system_monitor`."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

from muster.mission.errors import MusterError

if TYPE_CHECKING:
    from muster.mission.model import Mission
    from muster.mission.plan import Plan


@click.command()
@click.option("--namespace", default="")
@click.option("--frame", default="map")
@click.option("--planning", type=json.loads, default="{}")
@click.option("--targets", default="")
@click.option("--poses", default="")
@click.argument(
    "duty", type=click.Choice(["command_interface", "system_monitor", "mission_planner", "target_localization"])
)
def command(duty: str, namespace: str, frame: str, planning: Mapping[str, Any], targets: str, poses: str) -> None:
    """Run a node until standard input ends."""
    from muster_robots.discovery import pose_topics, topics_in
    from muster_robots.ros1.node_lifetime import live

    topics = topics_in(namespace)

    def command_interface() -> object:
        from muster import load
        from muster_robots.ros1.command_interface import CommandInterface

        return CommandInterface(load, topics=topics)

    def system_monitor() -> object:
        from muster_robots.ros1.system_monitor import SystemMonitor

        return SystemMonitor(namespace=namespace, topics=topics, frame=frame, poses=pose_topics(poses))

    def mission_planner() -> object:
        from muster import load
        from muster.planning.request import request_from
        from muster.planning.solving import answer
        from muster_robots.ros1.mission_planner import MissionPlanner

        def solve(mission: Mission, options: Mapping[str, Any]) -> Plan:
            return answer(request_from(mission, options)).plan

        return MissionPlanner(load, solve, topics=topics, options=planning)

    def target_localization() -> object:
        from muster_robots.cli.ros_targets import targets_from
        from muster_robots.ros1.target_localization import TargetLocalization

        settings = targets_from(targets).settings()
        return TargetLocalization(topics=topics, frame=frame, settings=settings, poses=pose_topics(poses))

    duties: Sequence[Callable[[], object]] = (
        command_interface,
        system_monitor,
        mission_planner,
        target_localization,
    )
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
