"""Missions with goods and energy: loads and windows, transports, charging."""

from __future__ import annotations

from muster_studies.instances.charging import CHARGING_REFERENCES
from muster_studies.instances.goods import GOODS_REFERENCES
from muster_studies.instances.solomon import REFERENCES
from muster_studies.peers.contest import OWN, Match
from muster_studies.peers.counted_table import Counted
from muster_studies.peers.family import family_of

PEERS_WITH_GOODS = ("PyVRP", "OR-Tools", "VROOM")
_SOLVERS = (OWN, *PEERS_WITH_GOODS)
_TOTAL = "total"

_LOADS = {f"loads-{name}-{robots}": distance for (name, robots), distance in REFERENCES.items()}
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

LOADS = family_of("loads", _LOADS)
CUSTOMERS = family_of("customers")
TRANSPORTS = Counted(
    number="transports",
    title="Pickups and deliveries with windows: tasks done and total distance of each solver, means over seeds",
    matches=tuple(Match(mission=name, objective=_TOTAL, complete=True) for name in _TRANSPORTS),
    solvers=_SOLVERS,
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
