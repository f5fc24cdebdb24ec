#include "crowd/hrvo.hpp"

#include <cmath>
#include <limits>
#include <tuple>

#include "parallel.hpp"
#include "traffic/agent_tree.hpp"

namespace muster {

namespace {

constexpr double kEdge = 1e-9;  // how deep in a cone a velocity on its edge may lie by rounding, m/s

// Part of the border of what is forbidden: point + t direction for t >= first.
struct Edge {
  Vec<2> point, direction;
  double first;
};

class ClearPath {
 public:
  ClearPath(const Agents<2>& agents, const std::vector<Segment>& walls, const HrvoSettings& settings, double dt,
            const AgentTree<2>& tree)
      : agents_(agents), walls_(walls), settings_(settings), dt_(dt), tree_(tree) {}

  Vec<2> velocity(int i) {
    look_round(i);
    best_ = {std::numeric_limits<double>::infinity(), 0, 0.0};
    most_ = agents_.max_speeds[i];
    wanted_ = agents_.preferred[i];
    if (const double length = norm(wanted_); length > most_) wanted_ = (most_ / length) * wanted_;
    consider(wanted_);
    consider({});
    for (const Edge& edge : edges_) consider_along(edge);
    for (std::size_t a = 0; a < edges_.size(); ++a)
      for (std::size_t b = a + 1; b < edges_.size(); ++b) consider_crossing(edges_[a], edges_[b]);
    return chosen_;
  }

 private:
  // A velocity is the better the less it leads into a wall, then the farther the nearest agent whose obstacle holds it,
  // then the nearer it is to the preferred velocity.
  using Rank = std::tuple<double, int, double>;

  void look_round(int i) {
    tree_.near(i, settings_.neighbourhood, found_);
    cones_.clear();
    edges_.clear();
    still_.clear();
    for (const int k : found_) {
      const double yields = agents_.yields(i, k);
      if (yields == 0.0) continue;
      cones_.push_back(hybrid_obstacle(agents_.positions[k] - agents_.positions[i], agents_.velocities[i],
                                       agents_.velocities[k], agents_.radii[i] + agents_.radii[k], dt_, yields));
      edges_.push_back({cones_.back().apex, cones_.back().left, 0.0});
      edges_.push_back({cones_.back().apex, cones_.back().right, 0.0});
    }
    for (const Segment& wall : walls_) {
      still_.push_back(still_space<2>(wall, agents_.positions[i], agents_.radii[i], settings_.wall_horizon, dt_));
      const HalfSpace<2>& space = still_.back();
      if (std::abs(space.offset) < agents_.max_speeds[i])
        edges_.push_back({space.offset * space.normal, turned(space.normal), -std::numeric_limits<double>::infinity()});
    }
  }

  // The point of the edge nearest to the preferred velocity, and where it leaves the disc of possible speeds.
  void consider_along(const Edge& edge) {
    consider(edge.point + std::max(edge.first, dot(wanted_ - edge.point, edge.direction)) * edge.direction);
    const double middle = -dot(edge.point, edge.direction);
    const double squared = most_ * most_ - dot(edge.point, edge.point) + middle * middle;
    if (squared < 0.0) return;
    for (const double t : {middle - std::sqrt(squared), middle + std::sqrt(squared)})
      if (t >= edge.first) consider(edge.point + t * edge.direction);
  }

  void consider_crossing(const Edge& a, const Edge& b) {
    const double sine = cross(a.direction, b.direction);
    if (std::abs(sine) < kParallel) return;
    const Vec<2> between = b.point - a.point;
    const double s = cross(between, b.direction) / sine, t = cross(between, a.direction) / sine;
    if (s >= a.first && t >= b.first) consider(a.point + s * a.direction);
  }

  void consider(const Vec<2>& v) {
    if (norm(v) > most_ + kEdge) return;
    double into_wall = 0.0;
    for (const HalfSpace<2>& space : still_) into_wall = std::max(into_wall, space.violation(v));
    if (into_wall <= kEdge) into_wall = 0.0;
    int clear = 0;  // how many of the nearest agents it is clear of
    const int agents = static_cast<int>(cones_.size());
    while (clear < agents && !cones_[clear].holds(v)) ++clear;
    const Rank rank{into_wall, agents - clear, norm(v - wanted_)};
    if (rank >= best_) return;
    best_ = rank;
    chosen_ = v;
  }

  const Agents<2>& agents_;
  const std::vector<Segment>& walls_;
  const HrvoSettings& settings_;
  double dt_;
  const AgentTree<2>& tree_;
  std::vector<int> found_;
  std::vector<Cone> cones_;
  std::vector<Edge> edges_;
  std::vector<HalfSpace<2>> still_;
  double most_ = 0.0;
  Vec<2> wanted_, chosen_;
  Rank best_;
};

}  // namespace

bool Cone::holds(const Vec<2>& v) const {
  const Vec<2> d = v - apex;
  return cross(left, d) < -kEdge && cross(right, d) > kEdge;
}

Cone hybrid_obstacle(const Vec<2>& apart, const Vec<2>& v_a, const Vec<2>& v_b, double radius, double dt,
                     double yields) {
  const double distance = norm(apart);
  const Vec<2> ahead = distance > 0.0 ? (1.0 / distance) * apart : Vec<2>{{1.0, 0.0}};
  const Vec<2> mean = (1.0 - yields) * v_a + yields * v_b;
  const double sine = radius / distance;
  if (sine >= 1.0 - kEdge)  // they touch: apart, in the time of a step
    return {mean - (std::max(0.0, radius - distance) * yields / dt) * ahead, turned(ahead), -1.0 * turned(ahead)};
  const double cosine = std::sqrt(1.0 - sine * sine);
  const Vec<2> left = cosine * ahead + sine * turned(ahead), right = cosine * ahead - sine * turned(ahead);
  const double opening = cross(right, left);
  const Vec<2> to_vo = v_b - mean;
  if (cross(ahead, v_a - mean) < 0.0)  // to the right of the centre line: the right side stays where it is
    return {mean + (cross(to_vo, left) / opening) * right, left, right};
  return {mean - (cross(to_vo, right) / opening) * left, left, right};
}

std::vector<Vec<2>> hrvo_velocities(const Agents<2>& agents, const std::vector<Segment>& walls,
                                    const HrvoSettings& settings, double dt, int threads) {
  const AgentTree<2> tree(agents.positions);
  std::vector<Vec<2>> result(agents.positions.size());
  in_parts(agents.size(), threads, [&](int begin, int end) {
    ClearPath chooser(agents, walls, settings, dt, tree);
    for (int i = begin; i < end; ++i) result[i] = chooser.velocity(i);
  });
  return result;
}

}  // namespace muster
