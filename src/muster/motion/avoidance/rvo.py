"""RVO: reciprocal velocity obstacles as in [tcf-thesis], appendix A3.2, with its symbols; in the plane.

A robot tries velocities of several magnitudes M and directions phi_new = 0, n, 2n ... 2 pi (A.9). One is suitable if it
lies in the velocity obstacle (A.5) of no other robot; the suitable one nearest to the ideal velocity v_id is taken
(A.15), or where none is suitable, the one of least VSF = w / t_c + |v - v_id| (A.16) to (A.20).

The thesis leaves open V_min, the number of magnitudes and w; they are parameters. Read otherwise than printed:

- Below (A.12) and in (A.13) left and right boundary are the wrong way round: with phi_l = theta_ik + theta_R of (A.5) a
  velocity is unsuitable if phi_r <= phi_delta <= phi_l.
- 0.5 (phi_l + phi_r) of (A.19) is theta_ik only where the angles do not pass pi; here it is theta_ik always, and
  differences of angles are taken the short way round.
- Figures A.7 to A.9 show v_opt = v_id where the way is free, though v_id is in general not in V_new: it is tried too.
- t_c is that of the obstacle that is hit first. Where inflated discs overlap, t_c (A.18) is not above 0; 1 ms then.
- 2 R_i is R_i + R_k, for robots of different sizes.

The thesis knows neither walls nor priorities. Velocities that would reach a wall within the horizon come after all
others. Of two robots the one with the lower priority alone gives way, with its apex at the other's velocity; the other
one does not look at it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_counts, require_finite_positive
from muster.motion.avoidance.agents import NO_OBSTACLES, Agents, Obstacles
from muster.motion.avoidance.parameters import CommonParameters


@dataclass(frozen=True, kw_only=True)
class Parameters(CommonParameters):
    """The parameters of RVO; n is the thesis'. Its robots consider all others. See `CommonParameters` for the rest.

    Parameters
    ----------
    v_min_mps
        M_1, the least magnitude tried; V_max is the robot's maximum speed.
    magnitudes
        how many magnitudes, evenly from M_1 to V_max.
    n_rad
        n, the step of the direction.
    w_m
        w, the weighting factor of (A.17).
    ideal
        whether v_id is tried as well.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    v_min_mps: float = 0.0
    magnitudes: int = 6
    n_rad: float = 0.1
    w_m: float = 1.0
    ideal: bool = True
    most_neighbours: int = 1000
    neighbour_distance_m: float = math.inf

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 <= self.v_min_mps < math.inf:
            raise ParameterError(f"v_min_mps: {self.v_min_mps}; expected at least 0")
        if not 1e-3 <= self.n_rad <= math.pi:
            raise ParameterError(f"n_rad: {self.n_rad}; expected 0.001 to pi")
        require_finite_positive(w_m=self.w_m)
        require_counts(1, magnitudes=self.magnitudes)


@dataclass(frozen=True)
class Rvo:
    """Reciprocal velocity obstacles of [tcf-thesis], 2-D."""

    params: Parameters = field(default_factory=Parameters)
    name: ClassVar[str] = "RVO"

    def velocities(self, agents: Agents, obstacles: Obstacles = NO_OBSTACLES, dt: float = 0.25) -> Floats:
        """See `Method`; robots in the plane only."""
        require_finite_positive(dt=dt)
        p = self.params
        chosen: Floats = core.rvo(
            agents.in_plane(),
            obstacles.still(2),
            dt,
            v_min=p.v_min_mps,
            magnitudes=p.magnitudes,
            n=p.n_rad,
            w=p.w_m,
            ideal=p.ideal,
            **p.for_core(),
        )
        return chosen
