// How near discs or balls come to each other on their ways, between the points of time too.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "vectors.hpp"

namespace muster {

// The least distance, squared, from the origin to the line segment from a to b: what one robot sees of another.
template <int D>
double squared_to_origin(const Vec<D>& a, const Vec<D>& b) {
  const Vec<D> way = b - a;
  const double length = dot(way, way);
  const double share = length > 0.0 ? std::clamp(-dot(a, way) / length, 0.0, 1.0) : 0.0;
  const Vec<D> nearest = a + share * way;
  return dot(nearest, nearest);
}

struct Approach {
  std::vector<double> distances;              // a step: least distance between two centres
  std::vector<double> gaps;                   // a step: the same less the sum of the two radii
  std::vector<std::pair<int, int>> contacts;  // pairs that overlap by more than the tolerance at any time
};

// `positions`: steps + 1 times the n places of the robots, each of which moves straight and evenly within a step.
template <int D>
Approach closest_approach(const std::vector<Vec<D>>& positions, const std::vector<double>& radii, double tolerance);

}  // namespace muster
