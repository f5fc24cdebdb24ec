#include "crowd/approach.hpp"

#include <limits>

namespace muster {

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
