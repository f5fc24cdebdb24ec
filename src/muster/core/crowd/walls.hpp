// What stands still: line segments in the plane, boxes in space; and the velocities that keep an agent off them.
#pragma once

#include <algorithm>
#include <vector>

#include "crowd/linear_program.hpp"
#include "vectors.hpp"

namespace muster {

struct Segment {
  Vec<2> from, to;
};

// Its sides are parallel to the axes.
struct Box {
  Vec<3> low, high;
};

template <int D>
struct WallOf;
template <>
struct WallOf<2> {
  using type = Segment;
};
template <>
struct WallOf<3> {
  using type = Box;
};
template <int D>
using Wall = typename WallOf<D>::type;

inline Vec<2> closest(const Segment& wall, const Vec<2>& p) {
  const Vec<2> along = wall.to - wall.from;
  const double squared = dot(along, along);
  const double share = squared > 0.0 ? std::clamp(dot(p - wall.from, along) / squared, 0.0, 1.0) : 0.0;
  return wall.from + share * along;
}

inline Vec<3> closest(const Box& wall, Vec<3> p) {
  for (int k = 0; k < 3; ++k) p[k] = std::clamp(p[k], wall.low[k], wall.high[k]);
  return p;
}

// The velocities that keep clear of a convex wall for `horizon`, as far as they lie on the near side of the plane
// between: [berg2011] on static obstacles, with the optimisation velocity 0, which is always among them.
// An agent that overlaps the wall is to be out of it after a step of dt.
template <int D>
HalfSpace<D> still_space(const Wall<D>& wall, const Vec<D>& p, double radius, double horizon, double dt) {
  const Vec<D> away = p - closest(wall, p);
  const double distance = norm(away);
  if (distance == 0.0) return {Vec<D>{}, 0.0};  // inside: no way is better than another
  const double time = distance < radius ? dt : horizon;
  return {(1.0 / distance) * away, (radius - distance) / time};
}

// The same with the agent's own velocity for the optimisation velocity, which makes it braver: of all lines that part
// the velocity obstacle of the segment from the free velocities, the one farthest from v on its side. With a and b the
// ends as seen from the agent, the line of normal n is n . x = (max(n . a, n . b) + radius) / horizon.
HalfSpace<2> moving_space(const Segment& wall, const Vec<2>& p, double radius, const Vec<2>& v, double horizon);

}  // namespace muster
