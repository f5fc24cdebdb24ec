"""The options of `muster auction`, in groups; the verb gets each group's values under their names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS
from muster.cli.options.common import Finite

Verb = TypeVar("Verb", bound=Callable[..., Any])
_FILE = click.Path(path_type=Path)
_SECONDS = Finite(0, 1e6)
_SHARE = Finite(0, 0.99)


def _group(*options: Callable[[Any], Any]) -> Callable[[Verb], Verb]:
    def add(verb: Verb) -> Verb:
        for option in reversed(options):
            verb = option(verb)
        return verb

    return add


terms_options = _group(
    click.option("--bid", type=click.Choice(BIDS), help="What robots bid.  [default: the objective]"),
    click.option("--placement", type=click.Choice(PLACEMENTS), help="Where a task goes in a route.  [default: insert]"),
    click.option("--winner", type=click.Choice(WINNERS), help="Which bid wins.  [default: lowest]"),
    click.option(
        "--set",
        "settings",
        multiple=True,
        metavar="NAME=VALUE",
        help="battery_weight, suitability_weight, quality_weight.",
    ),
)

result_options = _group(
    click.option("-o", "--output", type=_FILE, metavar="FILE", help="Write the plan."),
    click.option("--book", type=_FILE, metavar="FILE", help="Write every bid (.csv)."),
    click.option("--plot", type=_FILE, metavar="FILE", help="Draw the routes (.png, .svg, .pdf)."),
    click.option("--gantt", type=_FILE, metavar="FILE", help="Draw the time chart (.png, .svg, .pdf)."),
    click.option("--views", type=_FILE, metavar="DIR", help="Write what each robot knows: <robot>.json, a plan."),
)

robot_options = _group(
    click.option("--robot", metavar="NAME", help="Be this robot alone; the others run elsewhere."),
    click.option("--key-file", type=_FILE, metavar="FILE", help="The team's key; needed with --robot."),
    click.option(
        "--robot-key", type=_FILE, metavar="FILE", help="This robot's own key, beside the team's; with --roster."
    ),
    click.option("--roster", type=_FILE, metavar="FILE", help="The public keys of all robots (.json)."),
    click.option(
        "--revocations", type=_FILE, metavar="FILE", help="Orders of --revoke, a line each, also those added later."
    ),
    click.option(
        "--revoke",
        metavar="NAME",
        help="Print the order that revokes this robot's key, signed by --robot-key, and do nothing else.",
    ),
    click.option(
        "--listen", metavar="ADDRESS", help="HOST:PORT to be reached at (Zenoh: an endpoint).  [default: 0.0.0.0:7783]"
    ),
    click.option(
        "--connect", metavar="LIST", help="The others: ROBOT=HOST:PORT,... (Zenoh: endpoints as tcp/HOST:PORT,...)."
    ),
    click.option("--multicast", metavar="GROUP:PORT", help="Reach the others by a multicast group, without --connect."),
    click.option("--wait", type=_SECONDS, default=20.0, show_default=True, metavar="S", help="For the whole team."),
    click.option(
        "--linger",
        type=_SECONDS,
        default=5.0,
        show_default=True,
        metavar="S",
        help="Stay when all agree, to tell others.",
    ),
    click.option(
        "--memory", type=_FILE, metavar="FILE", help="Remember what the robot owns, for when it starts again."
    ),
)

simulation_options = _group(
    click.option(
        "--simulate-network",
        "network_seed",
        type=click.IntRange(min=0),
        metavar="SEED",
        help="No processes: a network in memory, on a virtual clock.",
    ),
    click.option("--loss", type=_SHARE, metavar="P", help="Share of messages lost, there.  [default: 0]"),
    click.option("--duplication", type=_SHARE, metavar="P", help="Share of messages sent twice, there.  [default: 0]"),
    click.option("--delay", type=_SECONDS, metavar="S", help="Delay of messages, there.  [default: 0.001]"),
    click.option("--jitter", type=_SECONDS, metavar="S", help="Added to the delay, evenly.  [default: 0]"),
    click.option("--crashes", type=click.IntRange(min=0), metavar="N", help="Robots that crash on the way, there."),
    click.option("--cut", type=_SECONDS, metavar="S", help="Cut the team in two for so long, there."),
)
