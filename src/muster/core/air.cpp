#include "air.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace muster {

namespace {

Point minus(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
Point along(Point a, Point b, double t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
Point flat(Spot p) { return {p.x, p.y}; }

double distance_to_side(Point p, Point a, Point b) {
  const Point d = minus(b, a);
  const double square = dot(d, d), t = square > 0.0 ? std::clamp(dot(minus(p, a), d) / square, 0.0, 1.0) : 0.0;
  return distance(p, along(a, b, t));
}

// A ring that does not cut itself is convex then.
bool turns_left_only(const std::vector<Point>& ring) {
  const std::size_t count = ring.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Point at = ring[(k + 1) % count];
    if (cross(minus(at, ring[k]), minus(ring[(k + 2) % count], at)) < 0.0) return false;
  }
  return true;
}

template <class Visit>
void for_sides(const std::vector<std::vector<Point>>& rings, Visit visit) {
  for (const auto& ring : rings) {
    for (std::size_t k = 0; k < ring.size(); ++k) visit(ring[k], ring[(k + 1) % ring.size()]);
  }
}

}  // namespace

Rings::Rings(std::vector<std::vector<Point>> rings) : rings_(std::move(rings)) {
  constexpr double far = std::numeric_limits<double>::infinity();
  low_ = {far, far};
  high_ = {-far, -far};
  for_sides(rings_, [&](Point p, Point) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  });
  convex_ = rings_.size() == 1 && turns_left_only(rings_.front());
}

bool Rings::inside(Point p) const {
  bool in = false;
  for_sides(rings_, [&](Point a, Point b) {
    if ((a.y > p.y) != (b.y > p.y) && (cross(minus(b, a), minus(p, a)) > 0.0) == (b.y > a.y)) in = !in;
  });
  return in;
}

double Rings::distance_to_border(Point p) const {
  double least = std::numeric_limits<double>::infinity();
  for_sides(rings_, [&](Point a, Point b) { least = std::min(least, distance_to_side(p, a, b)); });
  return least;
}

// Whether the line through a in this direction runs beside the box around all, and no nearer than `off` lengths.
bool Rings::beside(Point a, Point d, double off) const {
  const double middle = cross(d, minus({(low_.x + high_.x) / 2, (low_.y + high_.y) / 2}, a));
  const double half = (std::abs(d.x) * (high_.y - low_.y) + std::abs(d.y) * (high_.x - low_.x)) / 2;
  return std::abs(middle) > half + off;
}

// The border cuts the piece; the middle of each part says where the part is.
bool Rings::enters(Point a, Point b, double from, double to, bool inner) const {
  const Point first = along(a, b, from), last = along(a, b, to), d = minus(b, a);
  if (inner && (std::max(first.x, last.x) < low_.x || std::min(first.x, last.x) > high_.x ||
                std::max(first.y, last.y) < low_.y || std::min(first.y, last.y) > high_.y)) {
    return false;
  }
  const double length = std::sqrt(dot(d, d));
  if (inner && beside(a, d, Air::kTouch * length)) return false;
  // What joins two points of a convex whole is in it.
  const auto in = [&](Point p) { return inside(p) || distance_to_border(p) <= Air::kTouch; };
  if (!inner && convex_ && in(first) && in(last)) return false;
  const auto is_there = [&](Point p) { return inside(p) == inner && distance_to_border(p) > Air::kTouch; };
  if (length * (to - from) <= Air::kTouch) return is_there(along(a, b, (from + to) / 2));
  std::vector<double> cuts{from, to};
  const auto cut = [&](double t) {
    if (t > from && t < to) cuts.push_back(t);
  };
  for_sides(rings_, [&](Point p, Point q) {
    const double at = cross(d, minus(p, a)), next = cross(d, minus(q, a));
    const double near = Air::kTouch * length;
    if ((at > near && next > near) || (at < -near && next < -near)) return;
    if (std::abs(at) <= near) cut(dot(minus(p, a), d) / (length * length));
    if (std::abs(next) <= near) cut(dot(minus(q, a), d) / (length * length));
    if (at * next < 0.0) cut(dot(minus(along(p, q, at / (at - next)), a), d) / (length * length));
  });
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t k = 1; k < cuts.size(); ++k) {
    if ((cuts[k] - cuts[k - 1]) * length > Air::kTouch && is_there(along(a, b, (cuts[k] + cuts[k - 1]) / 2)))
      return true;
  }
  return false;
}

bool AirEdge::taut(Spot direction) const {
  if (upright) {
    const double one = cross(flat(direction), inward), other = cross(flat(direction), other_wall);
    return one * other >= -1e-12;
  }
  const double in = dot(flat(direction), inward), out = top ? direction.z : -direction.z;
  return in * out >= -1e-12;
}

Air::Air(Rings region, std::vector<PrismShape> prisms, double lowest, double top)
    : region_(std::move(region)), prisms_(std::move(prisms)), lowest_(lowest) {
  add_upright(region_, lowest, std::max(top, lowest), false);
  for (const PrismShape& prism : prisms_) {
    const double from = std::max(prism.floor, lowest);
    if (prism.ceiling <= from) continue;
    add_upright(prism.base, from, std::isfinite(prism.ceiling) ? prism.ceiling : std::max(top, from), true);
    if (std::isfinite(prism.ceiling)) add_level(prism, prism.ceiling, true);
    if (prism.floor > lowest) add_level(prism, prism.floor, false);
  }
}

// Rings have the inside of their polygon on the left, so an obstacle inside is convex at a turn to the left.
void Air::add_upright(const Rings& rings, double from, double to, bool obstacle_inside) {
  for (const auto& ring : rings.rings()) {
    const std::size_t count = ring.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Point at = ring[k], back = minus(ring[(k + count - 1) % count], at), on = minus(ring[(k + 1) % count], at);
      const double turn = cross(on, back);
      if (obstacle_inside ? turn <= 0.0 : turn >= 0.0) continue;
      AirEdge edge{
          .from = {at.x, at.y, from}, .to = {at.x, at.y, to}, .upright = true, .inward = back, .other_wall = on};
      edges_.push_back(edge);
    }
  }
}

void Air::add_level(const PrismShape& prism, double z, bool top) {
  for_sides(prism.base.rings(), [&](Point a, Point b) {
    const double length = distance(a, b);
    if (length == 0.0) return;
    const Point inward{-(b.y - a.y) / length, (b.x - a.x) / length};
    edges_.push_back({.from = {a.x, a.y, z}, .to = {b.x, b.y, z}, .top = top, .inward = inward, .other_wall = {}});
  });
}

bool Air::free(Spot p) const {
  if (p.z < lowest_ - kTouch) return false;
  if (!region_.inside(flat(p)) && region_.distance_to_border(flat(p)) > kTouch) return false;
  return std::none_of(prisms_.begin(), prisms_.end(), [&](const PrismShape& prism) {
    return p.z > prism.floor + kTouch && p.z < prism.ceiling - kTouch && prism.base.inside(flat(p)) &&
           prism.base.distance_to_border(flat(p)) > kTouch;
  });
}

bool Air::sees(Spot a, Spot b, std::size_t& blocker) const {
  if (std::min(a.z, b.z) < lowest_ - kTouch) return false;
  if (blocker < prisms_.size() && blocks(prisms_[blocker], a, b)) return false;
  if (region_.enters(flat(a), flat(b), 0.0, 1.0, false)) return false;
  for (std::size_t k = 0; k < prisms_.size(); ++k) {
    if (k == blocker || !blocks(prisms_[k], a, b)) continue;
    blocker = k;
    return false;
  }
  return true;
}

bool Air::blocks(const PrismShape& prism, Spot a, Spot b) {
  // The part of the piece at the height of the prism.
  double from = 0.0, to = 1.0;
  const double low = prism.floor + kTouch, high = prism.ceiling - kTouch, rise = b.z - a.z;
  if (std::max(a.z, b.z) <= low || std::min(a.z, b.z) >= high) return false;
  if (rise != 0.0) {
    from = std::max(from, ((rise > 0.0 ? low : high) - a.z) / rise);
    to = std::min(to, ((rise > 0.0 ? high : low) - a.z) / rise);
  }
  return from < to && prism.base.enters(flat(a), flat(b), from, to, true);
}

}  // namespace muster
