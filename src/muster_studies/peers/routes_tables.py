"""Routes without windows: team orienteering [chao1996], longest routes [he2023], many depots, one long tour."""

from __future__ import annotations

from muster_studies.instances.orienteering import BEST_SCORES
from muster_studies.instances.routing import LONGEST_ROUTES
from muster_studies.peers.contest import OWN, OWN_OTHERS
from muster_studies.peers.family import Family
from muster_studies.peers.gaps import below

_TOTAL, _MAX = "total", "max"


_SCORES = {f"orienteering-{name}": float(score) for name, score in BEST_SCORES.items()}
_LONGEST = {"eil51-3": 159.5715, **{f"routes-{name}-{robots}": most for (name, robots), most in LONGEST_ROUTES.items()}}
_DEPOTS = (
    "routes-cc64-8",
    *(f"clustered-8-120-{seed}" for seed in range(3)),
    *(f"clustered-5-150-{seed}" for seed in range(3)),
)
_TOURS = ("tour-500-0", "routes-rat783-1", "tour-1000-0")
_TOTAL_SOLVERS = (OWN, "PyVRP", "OR-Tools")
_LEAST = "reference: the least total of all plans here; the best is not known."

FAMILIES = (
    Family(
        number="orienteering",
        title="Team orienteering, more tasks than the team can do: per cent of the score below the best known",
        objective=_TOTAL,
        missions=tuple(_SCORES),
        quick="orienteering-p2.3.g",
        solvers=(OWN, *OWN_OTHERS, "PyVRP", "OR-Tools"),
        remark="orienteering-pSET.ROBOTS.LETTER: instances of Chao, Golden and Wasil; a score is a priority, a limit "
        "on a path a work capacity. reference: the greatest score known. Tasks that may be left out are optional "
        "clients with prizes to PyVRP, disjunctions with penalties to OR-Tools.",
        known=_SCORES,
        gap=below,
    ),
    Family(
        number="longest",
        title="Several robots return, objective max: per cent of the longest route above the best known",
        objective=_MAX,
        missions=tuple(_LONGEST),
        quick="eil51-3",
        solvers=(OWN, "OR-Tools"),
        remark="NAME-ROBOTS, from one depot (eil51, mtsp, rand, kroa, rat: of TSPLIB or random) or from as many as "
        "robots (md). reference: the least longest route known, of He and Hao. OR-Tools has a global span; PyVRP has "
        "nothing of the kind.",
        known=_LONGEST,
    ),
    Family(
        number="depots",
        title="Clusters of tasks, a depot for each robot, objective total: per cent above the least",
        objective=_TOTAL,
        missions=_DEPOTS,
        quick="clustered-2-12-0",
        solvers=_TOTAL_SOLVERS,
        remark="clustered-ROBOTS-TASKS-SEED: depots all over a square of 1000 m, tasks in seven clusters; cc64 has 8 "
        f"depots and 120 tasks. {_LEAST}",
        known={},
    ),
    Family(
        number="tour",
        title="One robot, one long tour, objective total: per cent above the least",
        objective=_TOTAL,
        missions=_TOURS,
        quick="tour-30-0",
        solvers=_TOTAL_SOLVERS,
        remark=f"tour-PLACES-SEED: places all over a square of 1000 m; rat783: of TSPLIB. {_LEAST}",
        known={},
    ),
)
"""The tables of the comparison."""
