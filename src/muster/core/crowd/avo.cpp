#include "crowd/avo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "crowd/braking.hpp"
#include "crowd/orca.hpp"
#include "parallel.hpp"
#include "traffic/agent_tree.hpp"

namespace muster {

namespace {

constexpr int kTimes = 24;         // at which the discs of an obstacle are looked at
constexpr double kFirst = 0.1;     // the first of them, seconds
constexpr int kSides = 32;         // of the polygon within the disc of possible speeds
constexpr double kInside = 1e-6;   // by which share of its radius a point may lie in a disc and be on the border
constexpr double kReserve = 0.99;  // share of the deceleration that is counted on
constexpr double kUnreachableSpeed = 1e6;  // m/s: a centre farther away is of a disc at no time

// A place of the border of an obstacle, and the way out of it there.
struct Border {
  Vec<2> point, normal;
};

// An obstacle as its discs at some times, from the first, in geometric order, to the horizon.
class Obstacle {
 public:
  Obstacle(const Vec<2>& apart, const Vec<2>& v, double radius, const AvoSettings& settings)
      : v_(v), response_(settings.response) {
    const double first = std::min(kFirst, settings.horizon / 2.0);
    for (int i = 0; i < kTimes; ++i) {
      times_[i] = first * std::pow(settings.horizon / first, i / (kTimes - 1.0));
      discs_[i] = avo_disc(apart, v, radius, response_, times_[i]);
    }
  }

  // The place of the border nearest to w, as far as it is looked at.
  Border nearest(const Vec<2>& w) const {
    Border found = at_disc(discs_[kTimes - 1], w);
    double least = on_border(found.point) ? norm(found.point - w) : std::numeric_limits<double>::infinity();
    const auto consider = [&](const Border& place) {
      const double far = norm(place.point - w);
      if (far < least && on_border(place.point)) least = far, found = place;
    };
    for (const AvoDisc& disc : discs_)
      if (norm(w - disc.centre) >= disc.radius) consider(at_disc(disc, w));
    for (int i = 0; i < kTimes; ++i)
      for (const double side : {-1.0, 1.0}) consider(at_side(i, side));
    return found;
  }

 private:
  static Border at_disc(const AvoDisc& disc, const Vec<2>& w) {
    const Vec<2> out = w - disc.centre;
    const double length = norm(out);
    const Vec<2> normal = length > 0.0 ? (1.0 / length) * out : Vec<2>{{1.0, 0.0}};
    return {disc.centre + disc.radius * normal, normal};
  }

  // Where a disc touches the envelope of all: n . c' = -r', on one side of the way of the centre. Without an envelope
  // there, far away.
  Border at_side(int i, double side) const {
    const double rise = std::exp(-times_[i] / response_), s = times_[i] - response_ * (1.0 - rise);
    const Vec<2> way = (-1.0 / s) * (rise * v_ + (1.0 - rise) * discs_[i].centre);   // c'
    const double shrinks = (1.0 - rise) * discs_[i].radius / s, length = norm(way);  // -r'
    if (length <= shrinks) return {{{kUnreachableSpeed, kUnreachableSpeed}}, {{1.0, 0.0}}};
    const double cosine = shrinks / length, sine = side * std::sqrt(1.0 - cosine * cosine);
    const Vec<2> ahead = (1.0 / length) * way;
    const Vec<2> normal = cosine * ahead + sine * turned(ahead);
    return {discs_[i].centre + discs_[i].radius * normal, normal};
  }

  bool on_border(const Vec<2>& point) const {
    return std::all_of(discs_.begin(), discs_.end(),
                       [&](const AvoDisc& disc) { return norm(point - disc.centre) >= disc.radius * (1.0 - kInside); });
  }

  Vec<2> v_;
  double response_;
  std::array<double, kTimes> times_;
  std::array<AvoDisc, kTimes> discs_;
};

// Chooses for one agent after another, by the change y of its velocity at which it aims: v after dt seconds is
// v + q y, q = 1 - exp(-dt / delta).
class AvoChooser {
 public:
  AvoChooser(const Agents<2>& agents, const std::vector<double>& accelerations, const std::vector<Segment>& walls,
             const AvoSettings& settings, double dt, const AgentTree<2>& tree)
      : agents_(agents),
        accelerations_(accelerations),
        walls_(walls),
        settings_(settings),
        dt_(dt),
        share_(1.0 - std::exp(-dt / settings.response)),
        tree_(tree),
        largest_radius_(*std::max_element(agents.radii.begin(), agents.radii.end())) {
    for (int k = 0; k < agents.size(); ++k) longest_ = std::max(longest_, braking(k).distance(agents.max_speeds[k]));
  }

  Vec<2> velocity(int i) {
    const Vec<2>& v = agents_.velocities[i];
    const double most = std::min(settings_.response * accelerations_[i], norm(v) + agents_.max_speeds[i]);
    spaces_.clear();
    keep_off(i);
    const std::size_t hard = spaces_.size();
    face_agents(i);
    Vec<2> y;
    const std::size_t held = program_.solve(spaces_, most, {agents_.preferred[i] - v, false}, y);
    if (held < hard)
      y = brake(v, most);
    else if (held < spaces_.size())
      least_penetration<2>(spaces_, hard, held, most, program_, y);
    return within(v + share_ * y, agents_.max_speeds[i]);
  }

 private:
  // By proportional control the velocity changes by q delta a in a step at most, which is less than a dt.
  Braking braking(int i) const { return {dt_, kReserve * share_ * settings_.response * accelerations_[i] / dt_}; }

  // As hard as it can, and to a stand within the step if it can.
  Vec<2> brake(const Vec<2>& v, double most) const {
    const double speed = norm(v);
    return speed > 0.0 ? (-std::min(most, speed / share_) / speed) * v : v;
  }

  static Vec<2> within(const Vec<2>& v, double most) {
    const double length = norm(v);
    return length > most ? (most / length) * v : v;
  }

  // What no choice may break: its speed, and that it can stop before a wall and within its half of the gap to another.
  void keep_off(int i) {
    const Vec<2>& v = agents_.velocities[i];
    const Braking stop = braking(i);
    const auto bound = [&](const Vec<2>& away, double speed) {
      spaces_.push_back({away, (-speed - dot(away, v)) / share_});
    };
    const double reach = agents_.radii[i] + stop.distance(agents_.max_speeds[i]);
    for (const Segment& wall : walls_) {
      const Vec<2> away = agents_.positions[i] - closest(wall, agents_.positions[i]);
      const double distance = norm(away);
      if (distance > 0.0 && distance < reach + settings_.wall_horizon * agents_.max_speeds[i])
        bound((1.0 / distance) * away, stop.speed(std::max(0.0, distance - agents_.radii[i])));
    }
    tree_.near(i, {std::numeric_limits<int>::max(), reach + largest_radius_ + longest_}, found_);
    for (const int k : found_) {
      const Vec<2> away = agents_.positions[i] - agents_.positions[k];
      const double distance = norm(away), gap = distance - agents_.radii[i] - agents_.radii[k];
      if (distance > 0.0 && gap <= stop.distance(agents_.max_speeds[i]) + longest_)
        bound((1.0 / distance) * away, stop.speed(std::max(0.0, gap) / 2.0));
    }
    keep_speed(i);
  }

  // The disc of possible speeds as a polygon with a corner in the preferred direction.
  void keep_speed(int i) {
    const Vec<2>&v = agents_.velocities[i], &wanted = agents_.preferred[i];
    const double first = std::atan2(wanted[1], wanted[0]), half = std::numbers::pi / kSides;
    for (int k = 0; k < kSides; ++k) {
      const double angle = first + (2 * k + 1) * half;
      const Vec<2> normal{{-std::cos(angle), -std::sin(angle)}};
      const double offset = -agents_.max_speeds[i] * std::cos(half) - dot(normal, v);
      spaces_.push_back({normal, std::min(offset, 0.0)});
    }
  }

  void face_agents(int i) {
    const Vec<2>& v = agents_.velocities[i];
    tree_.near(i, settings_.neighbourhood, found_);
    for (const int k : found_) {
      const double yields = agents_.yields(i, k);
      const HalfSpace<2> space = avo_space(agents_.positions[k] - agents_.positions[i], v, agents_.velocities[k],
                                           agents_.radii[i] + agents_.radii[k], settings_, dt_, yields, 1.0 - yields);
      spaces_.push_back({space.normal, space.offset - dot(space.normal, v)});
    }
  }

  const Agents<2>& agents_;
  const std::vector<double>& accelerations_;
  const std::vector<Segment>& walls_;
  const AvoSettings& settings_;
  double dt_, share_;
  const AgentTree<2>& tree_;
  double largest_radius_, longest_ = 0.0;  // the longest way that anybody brakes
  Program<2> program_;
  std::vector<HalfSpace<2>> spaces_;
  std::vector<int> found_;
};

}  // namespace

AvoDisc avo_disc(const Vec<2>& apart, const Vec<2>& v, double radius, double response, double time) {
  const double k = response * (1.0 - std::exp(-time / response));
  return {(1.0 / (time - k)) * (apart - k * v), radius / (time - k)};
}

HalfSpace<2> avo_space(const Vec<2>& apart, const Vec<2>& v_a, const Vec<2>& v_b, double radius,
                       const AvoSettings& settings, double dt, double yields, double spares) {
  if (norm(apart) <= radius) return orca_space<2>(apart, v_a, v_b, radius, settings.horizon, dt, yields, spares);
  const Vec<2> v = v_a - v_b;
  const Border border = Obstacle(apart, v, radius, settings).nearest(v);
  const double u = dot(border.normal, border.point - v);
  return {border.normal, dot(border.normal, v_a) + (u > 0.0 ? yields : spares) * u};
}

std::vector<Vec<2>> avo_velocities(const Agents<2>& agents, const std::vector<double>& accelerations,
                                   const std::vector<Segment>& walls, const AvoSettings& settings, double dt,
                                   int threads) {
  if (agents.size() == 0) return {};
  const AgentTree<2> tree(agents.positions);
  std::vector<Vec<2>> result(agents.positions.size());
  in_parts(agents.size(), threads, [&](int begin, int end) {
    AvoChooser chooser(agents, accelerations, walls, settings, dt, tree);
    for (int i = begin; i < end; ++i) result[i] = chooser.velocity(i);
  });
  return result;
}

}  // namespace muster
