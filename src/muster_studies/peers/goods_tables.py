"""Missions with goods and energy: loads and windows, transports, charging."""

from __future__ import annotations

from muster_studies.instances.charging import CHARGING_REFERENCES
from muster_studies.instances.goods import GOODS_REFERENCES
from muster_studies.instances.solomon import REFERENCES
from muster_studies.peers.contest import OWN, Match
from muster_studies.peers.counted_table import Counted
from muster_studies.peers.family import Family

PEERS_WITH_GOODS = ("PyVRP", "OR-Tools", "VROOM")
_SOLVERS = (OWN, *PEERS_WITH_GOODS)
_TOTAL = "total"

_LOADS = {f"loads-{name}-{robots}": distance for (name, robots), distance in REFERENCES.items()}
_CUSTOMERS = tuple(f"customers-{family}-200-0" for family in ("R1", "R2", "C1", "C2", "RC1", "RC2"))
_TRANSPORTS = (
    "transports-R1-50-0",
    "transports-R2-50-0",
    "transports-C1-50-0",
    "transports-RC1-50-0",
    "goods-lc101-10",
    "goods-lr101-19",
)
_PUBLISHED = {f"goods-{name}-{robots}": distance for (name, robots), distance in GOODS_REFERENCES.items()}
_ELECTRIC = ("goods-c101C5-2", "goods-r105C5-2", "goods-c101_21-12")
_CHARGING = {f"charging-{name}-{seed}": distance for (name, seed), distance in CHARGING_REFERENCES.items()}

LOADS = Family(
    number="loads",
    title="Windows and loads, Solomon's instances, total distance: per cent above the best known",
    objective=_TOTAL,
    missions=tuple(_LOADS),
    quick="loads-C101-10",
    solvers=_SOLVERS,
    remark="loads-INSTANCE-ROBOTS: with the demands as loads. reference: the distance of the best plan known with so "
    "many robots.",
    known=_LOADS,
    complete=True,
)
CUSTOMERS = Family(
    number="customers",
    title="Windows and loads, 200 customers, total distance: per cent above the least",
    objective=_TOTAL,
    missions=_CUSTOMERS,
    quick="customers-R1-20-0",
    solvers=_SOLVERS,
    remark="customers-FAMILY-CUSTOMERS-SEED: in the manner of Gehring and Homberger, on 140 m x 140 m; places at "
    "random (R), in clusters (C) or half of both (RC); a short day and vehicles of 200 (1), or a long day and vehicles "
    "of 1,000 (2); windows of 10 to 120 s, four times as long on a long day, a quarter of them all day; a robot for "
    "each four customers. reference: the least total of all plans here; the best is not known. Two of the missions "
    "have 60 s too.",
    known={},
    limits_s=(20.0, 60.0),
    only={60.0: ("customers-R1-200-0", "customers-RC1-200-0")},
    complete=True,
)
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
CHARGING = Family(
    number="charging",
    title="Batteries, charging stations, windows and loads, total distance: per cent above the reference",
    objective=_TOTAL,
    missions=(*_ELECTRIC, *_CHARGING),
    quick=_ELECTRIC[0],
    solvers=(OWN,),
    remark="goods-INSTANCE-ROBOTS: of Schneider, Stenger and Goeke; reference: the distance of the best plan known. "
    "charging-INSTANCE-SEED: Solomon's, in their manner, with 21 stations, a battery for 0.6 of the mean route, and "
    "charges until it is full; reference: what one run of 150 s found. PyVRP, OR-Tools' "
    "routing library and VROOM have no charging stations; what might be made of OR-Tools' dimensions is not tried. "
    "Solomon's have 60 s too.",
    known={**_PUBLISHED, **_CHARGING},
    limits_s=(10.0, 60.0),
    only={60.0: tuple(_CHARGING)},
)
