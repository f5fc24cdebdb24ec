#include "crowd/rvo.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "parallel.hpp"
#include "traffic/agent_tree.hpp"

namespace muster {

namespace {

constexpr double kLeastTime = 1e-3;  // t_c > 0 (A.18), where the inflated discs overlap already; seconds

using Directions = std::vector<Vec<2>>;

// phi_new = 0, n, 2 n ... 2 pi (A.9).
Directions directions(double n) {
  Directions found;
  for (int k = 0; k * n <= 2.0 * std::numbers::pi; ++k) found.push_back({{std::cos(k * n), std::sin(k * n)}});
  return found;
}

class RvoChooser {
 public:
  RvoChooser(const Agents<2>& agents, const std::vector<Segment>& walls, const RvoSettings& settings, double dt,
             const Directions& directions, const AgentTree<2>& tree)
      : agents_(agents), walls_(walls), settings_(settings), dt_(dt), directions_(directions), tree_(tree) {}

  Vec<2> optimal(int i) {
    look_round(i);
    best_ = {std::numeric_limits<double>::infinity(), true, 0.0};
    const Vec<2>& v_id = agents_.preferred[i];
    if (settings_.ideal) consider(v_id, v_id);
    const double v_max = agents_.max_speeds[i];
    const int last = settings_.magnitudes - 1;
    for (int m = 0; m <= last; ++m) {
      const double M = last == 0 ? v_max : settings_.v_min + (v_max - settings_.v_min) * m / last;
      for (const Vec<2>& direction : directions_) consider(M * direction, v_id);
    }
    return v_opt_;
  }

 private:
  // A velocity is the better the less it leads into a wall, then if it is suitable, then by (A.15) or (A.16).
  using Rank = std::tuple<double, bool, double>;

  void look_round(int i) {
    tree_.near(i, settings_.neighbourhood, found_);
    obstacles_.clear();
    for (const int k : found_)
      if (const double yields = agents_.yields(i, k); yields > 0.0)
        obstacles_.emplace_back(agents_.positions[i], agents_.positions[k], agents_.velocities[i],
                                agents_.velocities[k], agents_.radii[i] + agents_.radii[k], yields);
    still_.clear();
    for (const Segment& wall : walls_)
      still_.push_back(still_space<2>(wall, agents_.positions[i], agents_.radii[i], settings_.wall_horizon, dt_));
  }

  void consider(const Vec<2>& v, const Vec<2>& v_id) {
    double into_wall = 0.0;
    for (const HalfSpace<2>& space : still_) into_wall = std::max(into_wall, space.violation(v));
    if (into_wall <= kSlack) into_wall = 0.0;
    if (into_wall > std::get<0>(best_)) return;
    bool unsuitable = false;
    double t_c = std::numeric_limits<double>::infinity();
    for (const VelocityObstacle& obstacle : obstacles_) {
      if (obstacle.suitable(v)) continue;
      unsuitable = true;
      t_c = std::min(t_c, obstacle.time_to_collision(v));
    }
    const double difference = norm(v - v_id);
    const Rank rank{into_wall, unsuitable, unsuitable ? settings_.w / t_c + difference : difference};  // VSF (A.17)
    if (rank >= best_) return;
    best_ = rank;
    v_opt_ = v;
  }

  const Agents<2>& agents_;
  const std::vector<Segment>& walls_;
  const RvoSettings& settings_;
  double dt_;
  const Directions& directions_;
  const AgentTree<2>& tree_;
  std::vector<int> found_;
  std::vector<VelocityObstacle> obstacles_;
  std::vector<HalfSpace<2>> still_;
  Rank best_;
  Vec<2> v_opt_;
};

}  // namespace

VelocityObstacle::VelocityObstacle(const Vec<2>& x_i, const Vec<2>& x_k, const Vec<2>& v_i, const Vec<2>& v_k,
                                   double radius, double yields)
    : x_i_(x_i), apex_((1.0 - yields) * v_i + yields * v_k), distance_(norm(x_k - x_i)), radius_(radius) {
  const Vec<2> apart = x_k - x_i;
  theta_ik_ = std::atan2(apart[1], apart[0]);
  theta_R_ = distance_ > radius ? std::asin(radius / distance_) : std::numbers::pi / 2.0;
  cos_theta_R_ = std::cos(theta_R_);
  ahead_ = {{std::cos(theta_ik_), std::sin(theta_ik_)}};
}

std::array<double, 8> VelocityObstacle::boundaries() const {
  return {x_i_[0] + apex_[0],
          x_i_[1] + apex_[1],
          std::cos(theta_ik_ + theta_R_),
          std::sin(theta_ik_ + theta_R_),
          std::cos(theta_ik_ - theta_R_),
          std::sin(theta_ik_ - theta_R_),
          distance_,
          radius_};
}

double VelocityObstacle::phi_delta(const Vec<2>& v) const { return std::atan2(v[1] - apex_[1], v[0] - apex_[0]); }

double VelocityObstacle::phi_1(const Vec<2>& v) const {
  const Vec<2> relative = v - apex_;
  return std::atan2(std::abs(cross(ahead_, relative)), dot(ahead_, relative));
}

bool VelocityObstacle::suitable(const Vec<2>& v) const {
  const Vec<2> relative = v - apex_;
  return dot(ahead_, relative) <= cos_theta_R_ * norm(relative);  // phi_1 >= theta_R, without an arc
}

double VelocityObstacle::time_to_collision(const Vec<2>& v) const {
  const double phi = phi_1(v);
  const double phi_2 = std::asin(std::min(1.0, std::abs(distance_ * std::sin(phi) / radius_)));  // (A.20)
  const double way = std::abs(distance_ * std::cos(phi)) - std::abs(radius_ * std::cos(phi_2));
  return std::max(way / norm(v - apex_), kLeastTime);
}

std::vector<Vec<2>> rvo_velocities(const Agents<2>& agents, const std::vector<Segment>& walls,
                                   const RvoSettings& settings, double dt, int threads) {
  const AgentTree<2> tree(agents.positions);
  const Directions all = directions(settings.n);
  std::vector<Vec<2>> result(agents.positions.size());
  in_parts(agents.size(), threads, [&](int begin, int end) {
    RvoChooser chooser(agents, walls, settings, dt, all, tree);
    for (int i = begin; i < end; ++i) result[i] = chooser.optimal(i);
  });
  return result;
}

}  // namespace muster
