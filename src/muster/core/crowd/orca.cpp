#include "crowd/orca.hpp"

#include <algorithm>
#include <limits>

#include "parallel.hpp"
#include "traffic/agent_tree.hpp"

namespace muster {

namespace {

// The unit vector at right angles to `ahead` on the side of v, or on a side of its own choice if v is on neither.
template <int D>
Vec<D> sideways(const Vec<D>& ahead, const Vec<D>& v) {
  const Vec<D> off = v - dot(v, ahead) * ahead;
  const double length = norm(off);
  return length > kParallel * norm(v) ? (1.0 / length) * off : perpendiculars(ahead)[0];
}

// The half-space outside a velocity obstacle, whose border is nearest to v. Agents that overlap are to part in dt.
template <int D>
HalfSpace<D> outside(const Vec<D>& apart, const Vec<D>& v, double radius, double horizon, double dt) {
  const double distance = norm(apart);
  const bool overlap = distance < radius;
  const double time = overlap ? dt : horizon;
  const Vec<D> from_centre = v - (1.0 / time) * apart;
  const double length = norm(from_centre), ahead = dot(from_centre, apart);
  // On the near side of where the cone touches the ball that cuts it off.
  const bool at_ball = ahead < 0.0 && ahead * ahead > radius * radius * length * length;
  if (overlap || at_ball) {
    const Vec<D> normal = length > 0.0 ? (1.0 / length) * from_centre : perpendiculars(Vec<D>{{1.0}})[0];
    return {normal, (dot(normal, apart) + radius) / time};
  }
  const Vec<D> axis = (1.0 / distance) * apart;
  const double sine = radius / distance, cosine = std::sqrt(1.0 - sine * sine);
  return {cosine * sideways(axis, v) - sine * axis, 0.0};
}

template <int D>
class Navigator {
 public:
  Navigator(const Agents<D>& agents, const OrcaSettings& settings, double dt, const AgentTree<D>& tree,
            const std::vector<char>* choosing = nullptr)
      : agents_(agents),
        settings_(settings),
        dt_(dt),
        tree_(tree),
        choosing_(choosing),
        largest_radius_(*std::max_element(agents.radii.begin(), agents.radii.end())),
        largest_speed_(*std::max_element(agents.max_speeds.begin(), agents.max_speeds.end())) {}

  Vec<D> velocity(int i, const std::vector<Wall<D>>& all_walls) {
    Vec<D> x;
    const double most = agents_.max_speeds[i];
    const Aim<D> aim{agents_.preferred[i], false};
    spaces_.clear();
    face_walls(i, all_walls);
    const std::size_t walls = spaces_.size();
    if (settings_.apart) keep_apart(i);
    const std::size_t hard = spaces_.size();
    face_agents(i);
    std::size_t held = program_.solve(spaces_, most, aim, x);
    if (held < hard) {
      keep_still_possible(i, walls);
      held = program_.solve(spaces_, most, aim, x);
    }
    if (held < spaces_.size()) least_penetration<D>(spaces_, hard, held, most, program_, x);
    return x;
  }

 private:
  bool out_of_reach(int i, double distance) const {
    return distance > agents_.radii[i] + settings_.wall_horizon * agents_.max_speeds[i];
  }

  void face_walls(int i, const std::vector<Wall<D>>& walls) {
    near_walls_.clear();
    const Vec<D>& p = agents_.positions[i];
    for (const Wall<D>& wall : walls) {
      const double distance = norm(p - closest(wall, p));
      if (out_of_reach(i, distance)) continue;
      near_walls_.push_back(&wall);
      if constexpr (D == 2) {
        if (distance > agents_.radii[i]) {
          spaces_.push_back(moving_space(wall, p, agents_.radii[i], agents_.velocities[i], settings_.wall_horizon));
          continue;
        }
      }
      spaces_.push_back(still_space<D>(wall, p, agents_.radii[i], settings_.wall_horizon, dt_));
    }
  }

  // Instead of lines through the walls' velocity obstacles that leave nothing, those that always leave velocity 0.
  void keep_still_possible(int i, std::size_t walls) {
    for (std::size_t k = 0; k < walls; ++k) {
      spaces_[k] = still_space<D>(*near_walls_[k], agents_.positions[i], agents_.radii[i], settings_.wall_horizon, dt_);
      spaces_[k].offset = std::min(spaces_[k].offset, 0.0);
    }
  }

  // Where the program has no solution ORCA promises nothing. This does: two agents that come nearer to each other by at
  // most half of the gap each do not touch within the step. Velocity 0 is always left.
  void keep_apart(int i) {
    const double reach = agents_.radii[i] + largest_radius_ + dt_ * (agents_.max_speeds[i] + largest_speed_);
    tree_.near(i, {std::numeric_limits<int>::max(), reach}, found_);
    for (const int k : found_) {
      const Vec<D> apart = agents_.positions[k] - agents_.positions[i];
      const double distance = norm(apart), gap = distance - agents_.radii[i] - agents_.radii[k];
      if (distance > 0.0) spaces_.push_back({(-1.0 / distance) * apart, -std::max(0.0, gap) / (2.0 * dt_)});
    }
  }

  void face_agents(int i) {
    tree_.near(i, settings_.neighbourhood, found_);
    for (const int k : found_) {
      const bool firm = choosing_ != nullptr && !(*choosing_)[k];
      const double yields = firm ? 1.0 : agents_.yields(i, k), spares = firm ? 1.0 : 1.0 - yields;
      spaces_.push_back(orca_space(agents_.positions[k] - agents_.positions[i], agents_.velocities[i],
                                   agents_.velocities[k], agents_.radii[i] + agents_.radii[k], settings_.horizon, dt_,
                                   yields, spares));
    }
  }

  const Agents<D>& agents_;
  const OrcaSettings& settings_;
  double dt_;
  const AgentTree<D>& tree_;
  const std::vector<char>* choosing_;  // null: all
  double largest_radius_, largest_speed_;
  Program<D> program_;
  std::vector<HalfSpace<D>> spaces_;
  std::vector<const Wall<D>*> near_walls_;
  std::vector<int> found_;
};

}  // namespace

template <int D>
HalfSpace<D> orca_space(const Vec<D>& apart, const Vec<D>& v_a, const Vec<D>& v_b, double radius, double horizon,
                        double dt, double yields, double spares) {
  const Vec<D> v = v_a - v_b;
  const HalfSpace<D> free = outside(apart, v, radius, horizon, dt);
  const double u = free.violation(v);  // along the normal: the least change of the relative velocity
  return {free.normal, dot(free.normal, v_a) + (u > 0.0 ? yields : spares) * u};
}

template <int D>
std::vector<Vec<D>> orca_velocities(const Agents<D>& agents, const std::vector<Wall<D>>& walls,
                                    const OrcaSettings& settings, double dt, int threads) {
  if (agents.size() == 0) return {};
  const AgentTree<D> tree(agents.positions);
  std::vector<Vec<D>> result(agents.positions.size());
  in_parts(agents.size(), threads, [&](int begin, int end) {
    Navigator<D> navigator(agents, settings, dt, tree);
    for (int i = begin; i < end; ++i) result[i] = navigator.velocity(i, walls);
  });
  return result;
}

template <int D>
std::vector<Vec<D>> orca_velocities(const Agents<D>& agents, const std::vector<std::vector<Wall<D>>>& walls,
                                    const std::vector<char>& choosing, const OrcaSettings& settings, double dt) {
  std::vector<Vec<D>> result = agents.velocities;
  if (agents.size() == 0) return result;
  const AgentTree<D> tree(agents.positions);
  Navigator<D> navigator(agents, settings, dt, tree, &choosing);
  for (int i = 0; i < agents.size(); ++i)
    if (choosing[i]) result[i] = navigator.velocity(i, walls[i]);
  return result;
}

template HalfSpace<2> orca_space(const Vec<2>&, const Vec<2>&, const Vec<2>&, double, double, double, double, double);
template HalfSpace<3> orca_space(const Vec<3>&, const Vec<3>&, const Vec<3>&, double, double, double, double, double);
template std::vector<Vec<2>> orca_velocities(const Agents<2>&, const std::vector<Segment>&, const OrcaSettings&, double,
                                             int);
template std::vector<Vec<3>> orca_velocities(const Agents<3>&, const std::vector<Box>&, const OrcaSettings&, double,
                                             int);
template std::vector<Vec<2>> orca_velocities(const Agents<2>&, const std::vector<std::vector<Segment>>&,
                                             const std::vector<char>&, const OrcaSettings&, double);
template std::vector<Vec<3>> orca_velocities(const Agents<3>&, const std::vector<std::vector<Box>>&,
                                             const std::vector<char>&, const OrcaSettings&, double);

}  // namespace muster
