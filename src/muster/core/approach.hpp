// How near discs or balls come to each other on their ways, between the points of time too.
#pragma once

#include <utility>
#include <vector>

#include "vectors.hpp"

namespace muster {

struct Approach {
  std::vector<double> distances;              // a step: least distance between two centres
  std::vector<double> gaps;                   // a step: the same less the sum of the two radii
  std::vector<std::pair<int, int>> contacts;  // pairs that overlap by more than the tolerance at any time
};

// `positions`: steps + 1 times the n places of the robots, each of which moves straight and evenly within a step.
template <int D>
Approach closest_approach(const std::vector<Vec<D>>& positions, const std::vector<double>& radii, double tolerance);

}  // namespace muster
