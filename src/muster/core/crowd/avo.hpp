// Acceleration-velocity obstacles: [berg-snape2011], in the plane. A robot that chooses the velocity w gets to it by
// proportional control: its acceleration is (w - v) / response, and at most its limit.
#pragma once

#include <vector>

#include "crowd/agents.hpp"
#include "crowd/walls.hpp"

namespace muster {

struct AvoSettings {
  double horizon, wall_horizon;  // tau, for agents and for what stands still: seconds
  double response;               // delta, seconds
  Neighbourhood neighbourhood;
};

// The disc of relative velocities w that lead into contact at one time: with k = delta (1 - exp(-t / delta)) the way in
// t seconds is (t - k) w + k v, so its centre is (apart - k v) / (t - k) and its radius radius / (t - k).
struct AvoDisc {
  Vec<2> centre;
  double radius;
};
AvoDisc avo_disc(const Vec<2>& apart, const Vec<2>& v, double radius, double response, double time);

// The half of the velocities that an agent may choose towards another: beyond the point of the border of the obstacle
// that is nearest to the relative velocity. Parts as in `orca_space`.
HalfSpace<2> avo_space(const Vec<2>& apart, const Vec<2>& v_a, const Vec<2>& v_b, double radius,
                       const AvoSettings& settings, double dt, double yields, double spares);

// The velocity of every agent after dt seconds; `accelerations` are their limits, m/s^2.
std::vector<Vec<2>> avo_velocities(const Agents<2>& agents, const std::vector<double>& accelerations,
                                   const std::vector<Segment>& walls, const AvoSettings& settings, double dt,
                                   int threads);

}  // namespace muster
