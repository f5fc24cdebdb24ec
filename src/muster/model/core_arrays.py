"""The plan model as the arrays that the core takes; what is empty binds nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Bools, Floats
from muster.model.parts import Meter, Service
from muster.model.plan_model import PlanModel
from muster.model.rules import Question
from muster.motion.leg_times import LegTimes

_NONE = np.empty(0)


def core_arrays(problem: Question, profiles: Sequence[LegTimes]) -> dict[str, Any]:
    """The keyword arguments of `core.Problem` that are about times, crews, goods and energy."""
    model = problem.model
    return {
        "openings": model.openings if model.parts.openings else [],
        "ends_by": _limits(model.ends_by),
        "due": _limits(model.due),
        "over_by": _limits(model.over_by),
        "lasts_most": _limits(model.lasts_most),
        "spans": [model.spans(i) for i in range(model.robots)] if model.parts.spans else [],
        "least_stops": model.least_stops if model.parts.least_stops else np.empty(0, dtype=np.int32),
        **_gaps(model),
        **_crews(model, problem.kinds),
        **_meters(model),
        "energy": model.energy if model.parts.energy else _NONE,
        "energy_at_start": model.energy_at_start if model.parts.energy else _NONE,
        "stations": [_station(station) for station in model.stations],
        "calls": _calls(model, len(model.stations)),
        "over": np.isin(np.arange(model.tasks), list(model.parts.over)) if model.parts.over else _NONE.astype(np.bool_),
        **_profiles(profiles),
        "makespan_includes_return": problem.mission.rules.makespan_includes_return,
    }


def _limits(latest: Floats) -> Floats:
    return latest if np.isfinite(latest).any() else _NONE


def _gaps(model: PlanModel) -> dict[str, Floats]:
    """Parallel to the tasks that others are done after, task by task."""
    gaps = [gap[1:] for j in range(model.tasks) for gap in model.gaps(j)]
    least, most = np.array(gaps).reshape(-1, 2).T
    return {"gap_least": least if least.any() else _NONE, "gap_most": _limits(most)}


def _crews(model: PlanModel, kinds: npt.NDArray[np.int32]) -> dict[str, Any]:
    tasks, alone = range(model.tasks), len(model.units) == model.tasks
    first_of_kind = np.unique(kinds, return_index=True)[1]
    names = sorted({name for j in tasks for name in model.sums(j)})
    nobody = np.zeros(model.robots)
    able = {name: who for j in tasks for name, (_, who) in model.sums(j).items()}
    return {
        "unit": np.array([] if alone else model.unit, dtype=np.int32),
        "exclusive": model.exclusive if model.parts.exclusive else [],
        "same_crew": model.same_crew if model.parts.same_crew else [],
        "apart": model.apart if model.parts.apart else [],
        "parts": [
            [(count, fits[first_of_kind].tolist()) for count, fits in model.seats(j)] if model.has_seats(j) else []
            for j in tasks
        ]
        if model.with_teams
        else [],
        "abilities": np.array([able[name] for name in names]).T if names else _NONE,
        "needs": np.array([[model.sums(j).get(name, (0.0, nobody))[0] for name in names] for j in tasks])
        if names
        else _NONE,
    }


def _meters(model: PlanModel) -> dict[str, Any]:
    def columns(of: Callable[[Meter], Floats]) -> Floats:
        """Return (tasks or robots, meters)."""
        return np.array([of(meter) for meter in model.meters]).T if model.meters else _NONE

    delivers = bool(model.parts.taken_on_by)
    return {
        "meters": len(model.meters),
        "load": columns(lambda meter: meter.change),
        "pending": columns(lambda meter: meter.pending),
        "pickup": np.array(model.pickups if delivers and model.meters else [], dtype=np.int32),
        "most_aboard": columns(lambda meter: meter.most),
        "aboard_at_start": columns(lambda meter: meter.at_start),
        "pending_at_start": columns(lambda meter: meter.pending_at_start),
    }


def _calls(model: PlanModel, stations: int) -> Bools:
    if not model.parts.no_calls:
        return np.empty(0, dtype=np.bool_)
    return np.array([[model.may_call(i, k) for k in range(stations)] for i in range(model.robots)], dtype=np.bool_)


def _station(station: Service) -> tuple[float, float, bool, bool, int]:
    refill = station.refill
    if refill is None or refill.rate is None:
        return 0.0, -1.0 if refill is None else refill.whole_s, station.unloads, True, station.slots
    return refill.rate, -1.0, station.unloads, refill.partial, station.slots


def _profiles(profiles: Sequence[LegTimes]) -> dict[str, Any]:
    if all(profile.is_constant for profile in profiles):
        return {"acceleration": _NONE, "climb": _NONE, "turn": _NONE, "over_map": False}
    return {
        "acceleration": np.array([profile.acceleration_mps2 for profile in profiles]),
        "climb": np.array([profile.climb_mps for profile in profiles]),
        "turn": np.array([profile.turn_s for profile in profiles]),
        "over_map": any(profile.over_map for profile in profiles),
    }
