#include "crowd/right_of_way.hpp"

#include <algorithm>
#include <limits>

#include "crowd/braking.hpp"

namespace muster {

namespace {

constexpr double kLimitRounding = 1e-10;  // metres
constexpr double kCreep = 5e-10;  // metres: two that push each other would come nearer by rounding in every step
constexpr double kTouch = 1e-4;   // metres by which a body may lie on a wall: paths of a map lead along it exactly
constexpr int kHalvings = 20;
constexpr double kStraight = -1.0;

}  // namespace

RightOfWay::RightOfWay(const std::vector<Vec<3>>& positions, const std::vector<Choice>& choices,
                       const AgentTree<3>& tree, double dt, double clearance)
    : positions_(positions), choices_(choices), tree_(tree), dt_(dt), clearance_(clearance) {
  for (const Choice& choice : choices) {
    const double speed = std::max(norm(choice.wanted), norm(choice.braked));
    largest_radius_ = std::max(largest_radius_, choice.radius);
    longest_stop_ = std::max(longest_stop_, Braking{dt, choice.acceleration}.distance(speed));
  }
}

double RightOfWay::share(int i) {
  if (choices_[i].stands || choices_[i].radius == 0.0) return 1.0;
  limits_.clear();
  look_at_robots(i);
  look_at_walls(i);
  if (allowed(i, 1.0)) return 1.0;
  if (!allowed(i, 0.0)) return kStraight;
  double low = 0.0, high = 1.0;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (allowed(i, middle) ? low : high) = middle;
  }
  return low;
}

void RightOfWay::look_at_robots(int i) {
  const Choice& own = choices_[i];
  const Braking braking{dt_, own.acceleration};
  const double stop = braking.distance(std::max(norm(own.wanted), norm(own.braked)));
  const double beside = own.radius + clearance_ + stop + longest_stop_;
  tree_.near(i, {std::numeric_limits<int>::max(), beside + largest_radius_}, found_);
  for (const int k : found_) {
    const Choice& other = choices_[k];
    if (other.radius == 0.0) continue;
    const Vec<3> apart = positions_[k] - positions_[i];
    const double distance = norm(apart);
    if (distance == 0.0 || distance > beside + other.radius) continue;
    const Vec<3> towards = (1.0 / distance) * apart;
    const double braked = stopping(i, own.straight, {}, towards);
    const double gap = distance - own.radius - other.radius - clearance_;
    const double left = gap - braked - stopping(k, other.straight, {}, -1.0 * towards);
    if (left < -kCreep) {  // too near to brake: another direction must not come nearer at all, `straight` brakes
      limits_.push_back({towards, 0.0, 0.0});
    } else {
      limits_.push_back({towards, braked + (other.stands ? 1.0 : 0.5) * std::max(0.0, left), kLimitRounding});
    }
  }
}

void RightOfWay::look_at_walls(int i) {
  const Choice& own = choices_[i];
  const Vec<3>& p = positions_[i];
  const auto consider = [&](const Vec<3>& closest) {
    const double distance = norm(closest - p);
    if (distance > 0.0)
      limits_.push_back(
          {(1.0 / distance) * (closest - p), std::max(0.0, distance - own.radius + kTouch), kLimitRounding});
  };
  for (const Upright& face : *own.faces) consider(face.closest(p));
  for (const Slab& slab : own.walls->slabs)
    if (slab.covers(p)) consider(slab.closest(p));
  if (std::isfinite(own.walls->ground))
    limits_.push_back({Vec<3>{{0.0, 0.0, -1.0}}, std::max(0.0, p[2] - own.walls->ground), kLimitRounding});
}

bool RightOfWay::allowed(int i, double share) const {
  const Vec<3> velocity = choices_[i].at(share);
  return std::all_of(limits_.begin(), limits_.end(), [&](const Limit& limit) {
    return stopping(i, velocity, choices_[i].after, limit.towards) <= limit.most + limit.rounding;
  });
}

double RightOfWay::stopping(int i, const Vec<3>& velocity, const Vec<3>& after, const Vec<3>& towards) const {
  const Braking braking{dt_, choices_[i].acceleration};
  const double closing = dot(velocity, towards);
  const double speed = norm(velocity) / (after == Vec<3>{} ? 1.0 : choices_[i].chord);
  const double rest = braking.distance(braking.slower(speed));
  const double share = after == Vec<3>{} ? (speed > 0.0 ? closing / speed : 0.0) : dot(after, towards);
  return std::max(0.0, closing * dt_) + rest * std::max(0.0, share);
}

}  // namespace muster
