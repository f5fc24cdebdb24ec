"""Studies of `search` beside others, by kind of mission: time, routes, prerequisites, goods and energy.

The tables of comparisons in time: routes, windows and prerequisites, goods and energy.

Routes without windows are team orienteering [chao1996], longest routes [he2023], many depots and one long tour; time
windows are those of [solomon1987].

What comparisons share whose runs have limits of their own: effort, conditions, and the lines above their tables.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.instances.charging import CHARGING_REFERENCES
from muster_studies.instances.goods import GOODS_REFERENCES
from muster_studies.instances.orienteering import BEST_SCORES
from muster_studies.instances.routing import LONGEST_ROUTES
from muster_studies.instances.solomon import REFERENCES
from muster_studies.peers.contest import OWN, OWN_OTHERS, PEERS, WAITING_PEER, Match, Result, Run, perform, undisturbed
from muster_studies.peers.counted_table import Counted
from muster_studies.peers.family import family_of
from muster_studies.peers.machine import machine_and_versions, require_comparable
from muster_studies.peers.peer import Peer
from muster_studies.peers.study import shares
from muster_studies.peers.teams_table import Teams
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.peers.waiting_table import Waiting
from muster_studies.repetition import Repetition, Reproduction, one_by_one

_CONDITIONS = "Every solver has the same processor time for each plan (VROOM: wall time, of which it often uses little)"
_ROUNDED = (
    " Whole numbers that solvers want are rounded at 1e-7 of the longest way or work so that their plans hold in truth."
)


def timed_contest(
    *,
    name: str,
    summary: str,
    document: str,
    reproductions: tuple[Reproduction[Run, Result], ...],
    peers: Sequence[Peer] = tuple(PEERS.values()),
    perform: Callable[[Run], Result] = undisturbed,
    conditions: str = _CONDITIONS,
    rounded: str = _ROUNDED,
    random: str,
    legend: tuple[str, ...] = (),
) -> Repetition[Run, Result]:
    """A study of `search` beside other solvers, one run at a time.

    Parameters
    ----------
    conditions, rounded
        how much time each solver has; how whole numbers are made for solvers.
    random
        which solvers are random, and what of the means.
    legend
        lines about the instances, between the conditions and the settings.
    """

    def remarks(effort: Effort, found: Mapping[Run, Result]) -> tuple[str, ...]:
        seeds = seeds_of(effort)
        quick = f" With --quick every limit is {QUICK_S:g} s." if effort.quick else ""
        return (
            machine_and_versions(peers),
            f"{conditions} and one thread, and runs alone; handing over the model comes on top.{quick} All plans are "
            f"judged by muster.verify in double precision.{rounded}",
            f"mean and worst are of {'seed 0' if seeds == 1 else f'seeds 0 to {seeds - 1}'}. {random}",
            *legend,
            *(f"{peer.name}: {peer.settings}." for peer in peers),
            *([shares(found.values())] if any(peer.by_wall_clock for peer in peers) else []),
        )

    return Repetition(
        name=name,
        summary=summary,
        document=document,
        reproductions=reproductions,
        perform=one_by_one(perform),
        seeds=seeds_of,
        extras=("studies",),
        check=lambda effort: require_comparable(effort, peers),
        remarks=remarks,
    )


PEERS_WITH_GOODS = ("PyVRP", "OR-Tools", "VROOM")

_SCORES = {f"orienteering-{name}": float(score) for name, score in BEST_SCORES.items()}
_LONGEST = {"eil51-3": 159.5715, **{f"routes-{name}-{robots}": most for (name, robots), most in LONGEST_ROUTES.items()}}
_LOADS = {f"loads-{name}-{robots}": distance for (name, robots), distance in REFERENCES.items()}
_WINDOWS = {f"solomon-{name}-{robots}": distance for (name, robots), distance in REFERENCES.items()}
_TRANSPORTS = (
    "transports-R1-50-0",
    "transports-R2-50-0",
    "transports-C1-50-0",
    "transports-RC1-50-0",
    "goods-lc101-10",
    "goods-lr101-19",
)
_PUBLISHED = {f"goods-{name}-{robots}": distance for (name, robots), distance in GOODS_REFERENCES.items()}
_CHARGING = {f"charging-{name}-{seed}": distance for (name, seed), distance in CHARGING_REFERENCES.items()}

ROUTES = (
    family_of("orienteering", _SCORES),
    family_of("longest", _LONGEST),
    family_of("depots"),
    family_of("tour"),
)
WINDOWS = family_of("windows", _WINDOWS)

ORDERED = Counted(
    number="ordered",
    title="Windows and prerequisites: tasks done and makespan of each solver, means over seeds",
    matches=tuple(Match(mission=f"windows-{seed}", objective="makespan") for seed in range(20)),
    solvers=(OWN, *OWN_OTHERS, "CP-SAT", "OR-Tools"),
    limit_s=2.0,
    measure="makespan [s]",
    fewer="an earlier end",
)
"""Random missions with windows and prerequisites."""

LOADS = family_of("loads", _LOADS)
CUSTOMERS = family_of("customers")
TRANSPORTS = Counted(
    number="transports",
    title="Pickups and deliveries with windows: tasks done and total distance of each solver, means over seeds",
    matches=tuple(Match(mission=name, objective="total", complete=True) for name in _TRANSPORTS),
    solvers=(OWN, *PEERS_WITH_GOODS),
    limit_s=10.0,
    measure="distance",
    fewer="a shorter distance",
    remarks=(
        "transports-FAMILY-PAIRS-SEED: in the manner of Li and Lim, two tasks a pair, made from the routes of a plan "
        "at random, whose number of routes is that of the robots: few, so that a plan for all tasks exists and is not "
        "easy to find. goods-INSTANCE-ROBOTS: of Li and Lim themselves; the best plans known do all tasks in "
        + " and ".join(f"{_PUBLISHED[name]:.2f} ({name})" for name in _TRANSPORTS[-2:])
        + ".",
    ),
)
CHARGING = family_of("charging", {**_PUBLISHED, **_CHARGING})


def peers_timed_study() -> Repetition[Run, Result]:
    """`search` beside OR-Tools, PyVRP, VROOM and published figures, one run at a time."""
    return timed_contest(
        **description("peers-timed"),
        reproductions=(WINDOWS, ORDERED, Teams()),
        random="search and PyVRP are random; the others are not, and run once.",
    )


def peers_routes_study() -> Repetition[Run, Result]:
    """`search` beside PyVRP, OR-Tools and the best values known, one run at a time."""
    return timed_contest(
        **description("peers-routes"),
        reproductions=ROUTES,
        peers=(PEERS["PyVRP"], PEERS["OR-Tools"]),
        conditions="Every solver has the same processor time for each plan",
        random="search and PyVRP are random; OR-Tools is not, and runs once. search has its default settings. mean: "
        "over the missions on which all solvers have plans that count.",
    )


def peers_waiting_study() -> Repetition[Run, Result]:
    """`search` beside CP-SAT on missions with prerequisites, one run at a time."""
    return timed_contest(
        **description("peers-waiting"),
        reproductions=(Waiting(),),
        peers=(WAITING_PEER,),
        perform=perform,
        conditions="Each solver has the processor time that its column says",
        rounded="",
        random="search is random; CP-SAT runs once. search has its default settings.",
    )


def peers_goods_study() -> Repetition[Run, Result]:
    """`search` beside PyVRP, OR-Tools, VROOM and the best values known, one run at a time."""
    return timed_contest(
        **description("peers-goods"),
        reproductions=(LOADS, CUSTOMERS, TRANSPORTS, CHARGING),
        peers=tuple(PEERS[name] for name in PEERS_WITH_GOODS),
        random="search and PyVRP are random; the others are not, and run once. search has its default settings. mean: "
        "over the missions on which all plans of all solvers do all tasks.",
    )
