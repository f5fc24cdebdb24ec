// How near the robots of a simulated crowd come to each other, within steps too, and who holds up whom.
#include <algorithm>

#include "crowd/approach.hpp"
#include "crowd/course.hpp"
#include "crowd/crowd_world.hpp"

namespace muster {

namespace {

constexpr double kOverlap = 1e-9;  // metres: what is less is rounding
constexpr double kHardly = 0.1;    // share of its top speed below which a robot hardly gets on
constexpr double kBeside = 0.1;    // metres between two bodies that hinder each other

}  // namespace

void CrowdWorld::measure(const AgentTree<3>& tree) {
  double fastest = 0.0, largest = 0.0, farthest_behind = 0.0;
  for (const CrowdRobot& robot : robots_) {
    fastest = std::max(fastest, norm(robot.velocity));
    largest = std::max(largest, robot.body.radius);
    farthest_behind = std::max(farthest_behind, norm(robot.short_of));
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

int CrowdWorld::held_up_by(int i) const {
  const CrowdRobot& robot = robots_[i];
  if (robot.phase != Phase::going || !(robot.turned_aside || robot.braked) ||
      robot.approach >= kHardly * robot.top_speed())
    return -1;
  const double stop = Braking{settings_.dt, robot.body.acceleration}.distance(robot.top_speed());
  const Vec<3> way = robot.goal() - robot.position;
  const double far = norm(way), share = far > 0.0 ? std::min(1.0, (stop + robot.body.radius) / far) : 0.0;
  int ahead = -1, beside = -1;
  double nearest_ahead = kBeside, nearest = stop + robot.body.radius;
  for (int k = 0; k < static_cast<int>(robots_.size()); ++k) {
    const CrowdRobot& other = robots_[k];
    if (k == i || other.body.radius == 0.0) continue;
    const double both = robot.body.radius + other.body.radius;
    const double gap = norm(other.position - robot.position) - both;
    if (gap < nearest) {
      nearest = gap;
      beside = k;
    }
    if (dot(other.position - robot.position, way) <= 0.0) continue;
    const Vec<3> closest = closest_on_piece(other.position, robot.position, robot.position + share * way);
    const double clear = norm(other.position - closest) - both;
    if (clear < nearest_ahead) {
      nearest_ahead = clear;
      ahead = k;
    }
  }
  return ahead >= 0 ? ahead : beside;
}

}  // namespace muster
