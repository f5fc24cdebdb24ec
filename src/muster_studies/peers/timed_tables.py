"""The tables of comparisons in time: routes, windows and prerequisites, goods and energy.

Routes without windows are team orienteering [chao1996], longest routes [he2023], many depots and one long tour; time
windows are those of [solomon1987].
"""

from __future__ import annotations

from muster_studies.instances.charging import CHARGING_REFERENCES
from muster_studies.instances.goods import GOODS_REFERENCES
from muster_studies.instances.orienteering import BEST_SCORES
from muster_studies.instances.routing import LONGEST_ROUTES
from muster_studies.instances.solomon import REFERENCES
from muster_studies.peers.contest import OWN, OWN_OTHERS, Match
from muster_studies.peers.counted_table import Counted
from muster_studies.peers.family import family_of

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
