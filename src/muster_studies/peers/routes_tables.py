"""Routes without windows: team orienteering [chao1996], longest routes [he2023], many depots, one long tour."""

from __future__ import annotations

from muster_studies.instances.orienteering import BEST_SCORES
from muster_studies.instances.routing import LONGEST_ROUTES
from muster_studies.peers.family import family_of

_SCORES = {f"orienteering-{name}": float(score) for name, score in BEST_SCORES.items()}
_LONGEST = {"eil51-3": 159.5715, **{f"routes-{name}-{robots}": most for (name, robots), most in LONGEST_ROUTES.items()}}

FAMILIES = (
    family_of("orienteering", _SCORES),
    family_of("longest", _LONGEST),
    family_of("depots"),
    family_of("tour"),
)
"""The tables of the comparison."""
