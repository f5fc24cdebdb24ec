"""Solomon's instances with batteries and stations, in the manner of Schneider, Stenger and Goeke [schneider2014].

A battery lasts for 0.6 of the mean route of the best plan without batteries.
"""

from __future__ import annotations

from dataclasses import replace
from random import Random

from muster.generation.charging import with_batteries
from muster.mission.model import Mission
from muster_studies.instances.references import numbered
from muster_studies.instances.solomon import REFERENCES, solomon_instance

_STATIONS = 20
_SHARE_OF_ROUTE = 0.6
_ROBOTS = 2
"""So many times the robots of the plan without batteries."""

CHARGING_REFERENCES = numbered("charging")
"""By instance and seed: the total that `search` found in 150 s of processor time."""


def charging_mission(name: str, seed: int) -> Mission:
    """Solomon's instance of that name with batteries, a station at the depot and 20 at places of a seed."""
    fleet = min(robots for instance, robots in REFERENCES if instance == name)
    mission = solomon_instance(name, _ROBOTS * fleet, loads=True)
    battery = _SHARE_OF_ROUTE * REFERENCES[name, fleet] / fleet
    electric = with_batteries(mission, Random(f"charging {name} {seed}"), battery, _STATIONS)
    return replace(electric, name=f"charging-{name}-{seed}")
