"""Which manager steers the traffic of a run: by the option, and by what else is asked of the run."""

from __future__ import annotations

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.motion.avoidance_names import AUTO as ANY_AVOIDANCE
from muster.motion.laws import PROFILE
from muster.motion.map_world import World
from muster.traffic.manager import TrafficManager
from muster.traffic.managers import manager_named
from muster.traffic.names import RESERVE, of_run
from muster.traffic.roadmaps.roadmap import MARGIN_M

LOOSE_MARGIN_M = 0.1
"""What robots keep between them that do not drive exactly as told, or do not know exactly where they are."""


def manager_for(
    traffic: str,
    mission: Mission,
    *,
    seed: int = 0,
    avoidance: str = ANY_AVOIDANCE,
    law: str = PROFILE,
    exact: bool = False,
    world: World | None = None,
    real: bool = False,
) -> TrafficManager | None:
    """The manager of a run's traffic; None where robots pass each other as they meet.

    `auto` leaves traffic free where a method of avoidance is asked for, or a law by which robots leave straight ways.

    Parameters
    ----------
    exact
        whether robots drive exactly as told, and know where they are.
    real
        whether they are real: each order costs them time.
    world
        of the mission, where it is at hand.

    Raises
    ------
    ParameterError
        if reservation is asked for robots that leave straight ways; and as `manager_named`.
    """
    if law != PROFILE and traffic == RESERVE:
        raise ParameterError(f"traffic: {traffic}; expected free: by law {law} robots leave straight ways")
    chosen = of_run(traffic, avoidance=avoidance, law=law)
    return manager_named(chosen, mission, seed, world=world, margin_m=MARGIN_M if exact else LOOSE_MARGIN_M, real=real)
