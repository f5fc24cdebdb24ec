// How near the robots of a simulated crowd come to each other, within steps too.
#include <algorithm>

#include "approach.hpp"
#include "crowd_world.hpp"

namespace muster {

namespace {

constexpr double kOverlap = 1e-9;  // metres: what is less is rounding

}  // namespace

void CrowdWorld::measure(const AgentTree<3>& tree) {
  double fastest = 0.0, largest = 0.0, farthest_behind = 0.0;
  for (const CrowdRobot& robot : robots_) {
    fastest = std::max(fastest, norm(robot.velocity));
    largest = std::max(largest, robot.body.radius);
    farthest_behind = std::max(farthest_behind, norm(robot.lag));
  }
  std::vector<int> near;
  for (int i = 0; i < static_cast<int>(robots_.size()); ++i) {
    const CrowdRobot& robot = robots_[i];
    if (!robot.under_way()) continue;
    if (std::isinf(least_distance_)) {
      tree.near(i, {1, least_distance_}, near);
      for (const int k : near) measure(i, k);
    }
    const double reach =
        std::max(least_distance_, robot.body.radius + largest) + 2.0 * (settings_.dt * fastest + farthest_behind);
    tree.near(i, {std::numeric_limits<int>::max(), reach}, near);
    for (const int k : near)
      if (i < k || !robots_[k].under_way()) measure(i, k);
  }
}

void CrowdWorld::measure(int i, int k) {
  const Vec<3> apart = places_before_[k] - places_before_[i], after = robots_[k].place() - robots_[i].place();
  const double distance = std::sqrt(squared_to_origin(apart, after));
  least_distance_ = std::min(least_distance_, distance);
  if (distance >= robots_[i].body.radius + robots_[k].body.radius - kOverlap) return;
  const std::pair pair(std::min(i, k), std::max(i, k));
  const auto [contact, first] = contacts_.try_emplace(pair, CrowdContact{time(), distance});
  contact->second.distance = std::min(contact->second.distance, distance);
}

}  // namespace muster
