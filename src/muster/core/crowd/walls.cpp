#include "crowd/walls.hpp"

#include <limits>

namespace muster {

namespace {

// The edge of the shadow that a disc at q throws as seen from the origin: a unit vector, left (1) or right (-1).
Vec<2> tangent(const Vec<2>& q, double radius, double side) {
  const double distance = norm(q);
  const double sine = std::min(1.0, radius / distance), cosine = std::sqrt(1.0 - sine * sine);
  const Vec<2> ahead = (1.0 / distance) * q;
  return cosine * ahead + (side * sine) * turned(ahead);
}

}  // namespace

HalfSpace<2> moving_space(const Segment& wall, const Vec<2>& p, double radius, const Vec<2>& v, double horizon) {
  const Vec<2> a = wall.from - p, b = wall.to - p;
  Vec<2> left = tangent(a, radius, 1.0), right = tangent(a, radius, -1.0);
  if (const Vec<2> other = tangent(b, radius, 1.0); cross(left, other) > 0.0) left = other;
  if (const Vec<2> other = tangent(b, radius, -1.0); cross(right, other) < 0.0) right = other;

  HalfSpace<2> best{turned(left), 0.0};
  double farthest = -best.violation(v);
  const auto consider = [&](const Vec<2>& normal) {
    if (dot(normal, left) > kParallel || dot(normal, right) > kParallel) return;  // cuts through the obstacle
    const HalfSpace<2> space{normal, (std::max(dot(normal, a), dot(normal, b)) + radius) / horizon};
    if (-space.violation(v) <= farthest) return;
    farthest = -space.violation(v);
    best = space;
  };
  const HalfSpace<2> along_right{-1.0 * turned(right), 0.0};
  if (-along_right.violation(v) > farthest) {
    farthest = -along_right.violation(v);
    best = along_right;
  }
  for (const Vec<2>& end : {a, b}) {
    const Vec<2> off = v - (1.0 / horizon) * end;
    if (const double length = norm(off); length > 0.0) consider((1.0 / length) * off);
  }
  if (const double length = norm(b - a); length > 0.0)
    for (const double side : {1.0, -1.0}) consider((side / length) * turned(b - a));
  return best;
}

}  // namespace muster
