#include "traffic/limited_lane.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace muster {

namespace {

// Metres from the middle of a lane at which a robot is on it, and from its end at which it is at the node; as in
// Python.
constexpr double kOn = 0.05;

}  // namespace

LimitedLane::LimitedLane(Point from, Point to, int most, bool both_ways)
    : from_(from), length_(distance(from, to)), most_(most), both_ways_(both_ways) {
  if (!(length_ > 0.0)) throw std::invalid_argument("to: the place from which the lane leads");
  dx_ = (to.x - from.x) / length_;
  dy_ = (to.y - from.y) / length_;
}

LimitedLane::On LimitedLane::on(Point place) const {
  const double x = place.x - from_.x, y = place.y - from_.y;
  return {x * dx_ + y * dy_, std::abs(x * dy_ - y * dx_)};
}

bool LimitedLane::holds(Point place) const {
  const On at = on(place);
  return at.aside <= kOn && at.along > kOn && at.along < length_ - kOn;
}

bool LimitedLane::carries(Point from, Point to) const {
  const On begin = on(from), end = on(to);
  if (begin.aside > kOn || end.aside > kOn) return holds(from) || holds(to);
  const auto [first, last] = std::minmax(begin.along, end.along);
  return first < length_ - kOn && last > kOn;
}

bool LimitedLane::entered(Point from, Point to) const {
  if (holds(from) || !carries(from, to)) return false;
  const On begin = on(from);
  return both_ways_ || begin.aside > kOn || on(to).along > begin.along;
}

}  // namespace muster
