// Optimal reciprocal collision avoidance: [berg2011], in the plane, and in space by the same formulas.
#pragma once

#include <vector>

#include "crowd/agents.hpp"
#include "crowd/linear_program.hpp"
#include "crowd/walls.hpp"

namespace muster {

struct OrcaSettings {
  double horizon, wall_horizon;  // tau, for agents and for what stands still: seconds
  Neighbourhood neighbourhood;
  bool apart;  // whether no agent may use more than half of the gap to another in a step, whatever else
};

// ORCA of an agent with velocity v_a towards another with v_b, `apart` = p_b - p_a: velocities with which neither
// touches the other for `horizon`, if the other keeps to its own half of the bargain; `radius` is the sum of radii. Of
// what has to be changed the agent takes the part `yields`; where there is room to spare it uses the part `spares`.
template <int D>
HalfSpace<D> orca_space(const Vec<D>& apart, const Vec<D>& v_a, const Vec<D>& v_b, double radius, double horizon,
                        double dt, double yields, double spares);

// The new velocity of every agent.
template <int D>
std::vector<Vec<D>> orca_velocities(const Agents<D>& agents, const std::vector<Wall<D>>& walls,
                                    const OrcaSettings& settings, double dt, int threads);

// The same where each agent has walls of its own and some have made up their minds: those that are not `choosing` keep
// their velocities, and the others all of the room there is.
template <int D>
std::vector<Vec<D>> orca_velocities(const Agents<D>& agents, const std::vector<std::vector<Wall<D>>>& walls,
                                    const std::vector<char>& choosing, const OrcaSettings& settings, double dt);

}  // namespace muster
