// Hybrid reciprocal velocity obstacles: [snape2011]; velocities are chosen as by ClearPath [guy2009], as
// there.
#pragma once

#include <vector>

#include "crowd/agents.hpp"
#include "crowd/walls.hpp"

namespace muster {

// The velocities apex + s left + t right with s, t > 0; left and right are unit vectors.
struct Cone {
  Vec<2> apex, left, right;

  bool holds(const Vec<2>& v) const;
};

// HRVO of an agent with velocity v_a against another with v_b, `apart` = p_b - p_a; `radius` is the sum of radii. One
// side is that of the reciprocal velocity obstacle, on the side on which v_a is; the other, on which it should not
// pass, that of the velocity obstacle. With `yields` 1 it is the whole velocity obstacle.
Cone hybrid_obstacle(const Vec<2>& apart, const Vec<2>& v_a, const Vec<2>& v_b, double radius, double dt,
                     double yields);

struct HrvoSettings {
  double wall_horizon;  // seconds
  Neighbourhood neighbourhood;
};

// The new velocity of every agent.
std::vector<Vec<2>> hrvo_velocities(const Agents<2>& agents, const std::vector<Segment>& walls,
                                    const HrvoSettings& settings, double dt, int threads);

}  // namespace muster
