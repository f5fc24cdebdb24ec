#include "approach.hpp"

#include <algorithm>
#include <limits>

namespace muster {

namespace {

// The least distance, squared, from the origin to the line segment from a to b: what one robot sees of another.
template <int D>
double squared_to_origin(const Vec<D>& a, const Vec<D>& b) {
  const Vec<D> way = b - a;
  const double length = dot(way, way);
  const double share = length > 0.0 ? std::clamp(-dot(a, way) / length, 0.0, 1.0) : 0.0;
  const Vec<D> nearest = a + share * way;
  return dot(nearest, nearest);
}

}  // namespace

template <int D>
Approach closest_approach(const std::vector<Vec<D>>& positions, const std::vector<double>& radii, double tolerance) {
  const std::size_t n = radii.size();
  if (n == 0) return {};
  const std::size_t steps = positions.size() / n - 1;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Approach found{std::vector<double>(steps, kNone), std::vector<double>(steps, kNone), {}};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i + 1; k < n; ++k) {
      double least = kNone;
      for (std::size_t step = 0; step < steps; ++step) {
        const std::size_t before = step * n, after = before + n;
        const double distance = std::sqrt(squared_to_origin(positions[before + k] - positions[before + i],
                                                            positions[after + k] - positions[after + i]));
        found.distances[step] = std::min(found.distances[step], distance);
        found.gaps[step] = std::min(found.gaps[step], distance - radii[i] - radii[k]);
        least = std::min(least, distance);
      }
      if (least < radii[i] + radii[k] - tolerance) found.contacts.emplace_back(i, k);
    }
  }
  return found;
}

template Approach closest_approach(const std::vector<Vec<2>>&, const std::vector<double>&, double);
template Approach closest_approach(const std::vector<Vec<3>>&, const std::vector<double>&, double);

}  // namespace muster
