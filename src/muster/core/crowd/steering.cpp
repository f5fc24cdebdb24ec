#include "crowd/steering.hpp"

#include <algorithm>

namespace muster {

namespace {

constexpr double kAligned = 0.05;   // radians off its way at which a robot drives all the same
constexpr double kHalfTurn = 0.01;  // the least sine by which a robot leaves a half turn

Vec<3> reached(const Vec<3>& from, const Vec<3>& to, double most) {
  const double change = norm(to - from);
  return change > most ? from + (most / change) * (to - from) : to;
}

// (4.13), (4.24): the yaw rate by the sine of the error, which no step turns beyond.
double by_sine(const CrowdRobot& robot, double off, double sine, double dt) {
  const double most = std::abs(off) / dt;
  return std::clamp(robot.body.yaw_rate * sine, -most, most);
}

// On the spot. The sine of a half turn is 0: as printed a robot would never leave it.
double turn_to(const CrowdRobot& robot, double heading, double dt) {
  const double off = wrapped(heading - robot.heading);
  if (robot.body.law != Law::thesis) return std::clamp(off / dt, -robot.body.yaw_rate, robot.body.yaw_rate);
  const bool half_turn = std::cos(off) < 0.0 && std::abs(std::sin(off)) < kHalfTurn;
  return by_sine(robot, off, half_turn ? std::copysign(kHalfTurn, off) : std::sin(off), dt);
}

double turn_to_way_point(const CrowdRobot& robot, double dt) {
  if (robot.failed || (robot.phase != Phase::going && robot.phase != Phase::turning)) return 0.0;
  const double heading = robot.way[robot.next].heading;
  return std::isnan(heading) ? 0.0 : turn_to(robot, heading, dt);
}

Steering in_any_direction(const CrowdRobot& robot, const Vec<3>& chosen, double dt) {
  const double change = robot.body.acceleration * dt;
  const Vec<3> braked = reached(robot.commanded, Vec<3>{}, change);
  return {braked, reached(robot.commanded, chosen, change), 0.0, 0.0, turn_to_way_point(robot, dt), braked, {}};
}

// Ahead at a speed (below 0 backwards) and turning: an arc, as near to it as the acceleration lets it.
Steering on_an_arc(const CrowdRobot& robot, double ahead, double yaw_rate, const Vec<3>& chosen, double dt) {
  const Braking braking{dt, robot.body.acceleration};
  const double speed = std::hypot(chosen[0], chosen[1]), gain = robot.body.acceleration * dt;
  const double braked = std::copysign(braking.slower(std::abs(robot.ahead)), robot.ahead);
  ahead = std::clamp(ahead, robot.ahead - gain, robot.ahead + gain);
  // Its chord looks along half of the turn.
  const double half = 0.5 * yaw_rate * dt, chord = half == 0.0 ? 1.0 : std::sin(half) / half;
  const double climb = speed > 0.0 ? chosen[2] / speed : 0.0;
  const double x = chord * std::cos(robot.heading + half), y = chord * std::sin(robot.heading + half);
  const auto velocity = [&](double v) { return Vec<3>{{v * x, v * y, std::abs(v) * climb}}; };
  Vec<3> wanted = velocity(ahead);
  if (speed == 0.0) wanted[2] = chosen[2];
  const Vec<3> nose{{std::cos(robot.heading), std::sin(robot.heading), 0.0}};
  const Vec<3> after{{std::cos(robot.heading + 2.0 * half), std::sin(robot.heading + 2.0 * half), 0.0}};
  const double sign = ahead < 0.0 || braked < 0.0 ? -1.0 : 1.0;
  return {velocity(braked), wanted, braked, ahead, yaw_rate, braked * nose, sign * after, chord};
}

Steering where_it_looks(const CrowdRobot& robot, const Vec<3>& chosen, bool free, double dt) {
  const double speed = std::hypot(chosen[0], chosen[1]);
  double ahead = 0.0, yaw_rate = 0.0;
  if (robot.phase == Phase::turning) {
    yaw_rate = turn_to_way_point(robot, dt);
  } else if (speed > 0.0) {
    const double off = wrapped(std::atan2(chosen[1], chosen[0]) - robot.heading);
    const double straight = std::max(kAligned, 0.5 * robot.body.yaw_rate * dt);
    yaw_rate = std::clamp(off / dt, -robot.body.yaw_rate, robot.body.yaw_rate);
    ahead = free && std::abs(off) > straight ? 0.0 : speed * std::max(0.0, std::cos(off));
  }
  return on_an_arc(robot, ahead, yaw_rate, chosen, dt);
}

// (4.21)-(4.25): forward or backward, and turning meanwhile.
Steering while_it_turns(const CrowdRobot& robot, const Vec<3>& chosen, double dt) {
  const double speed = std::hypot(chosen[0], chosen[1]);
  if (robot.phase == Phase::turning) return on_an_arc(robot, 0.0, turn_to_way_point(robot, dt), chosen, dt);
  if (speed == 0.0) return on_an_arc(robot, 0.0, 0.0, chosen, dt);
  const double off = wrapped(std::atan2(chosen[1], chosen[0]) - robot.heading);
  return on_an_arc(robot, speed * std::cos(off), by_sine(robot, off, std::sin(off), dt), chosen, dt);
}

}  // namespace

Steering steered(const CrowdRobot& robot, const Vec<3>& chosen, bool free, double dt) {
  if (!robot.body.faces_its_way) return in_any_direction(robot, chosen, dt);
  if (free && robot.reference.followed)
    return on_an_arc(robot, robot.reference.ahead, robot.reference.yaw_rate, chosen, dt);
  if (robot.body.law == Law::thesis) return while_it_turns(robot, chosen, dt);
  return where_it_looks(robot, chosen, free, dt);
}

}  // namespace muster
