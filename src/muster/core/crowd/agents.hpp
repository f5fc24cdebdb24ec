// Robots that share a place, as collision avoidance sees them.
#pragma once

#include <vector>

#include "vectors.hpp"

namespace muster {

template <int D>
struct Agents {
  std::vector<Vec<D>> positions, velocities, preferred;
  std::vector<double> radii, max_speeds, priorities;

  int size() const { return static_cast<int>(positions.size()); }

  // The part that agent i takes of avoiding agent k: half between equals, else all of it falls to the lower priority.
  // The parts of two agents add up to 1.
  double yields(int i, int k) const {
    if (priorities[i] == priorities[k]) return 0.5;
    return priorities[i] < priorities[k] ? 1.0 : 0.0;
  }
};

// Whom an agent looks at: the nearest, up to a distance between centres.
struct Neighbourhood {
  int most;
  double distance;
};

}  // namespace muster
