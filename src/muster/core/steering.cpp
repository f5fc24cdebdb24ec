#include "steering.hpp"

#include <algorithm>

namespace muster {

namespace {

constexpr double kAligned = 0.05;  // radians off its way at which a robot drives all the same

Vec<3> reached(const Vec<3>& from, const Vec<3>& to, double most) {
  const double change = norm(to - from);
  return change > most ? from + (most / change) * (to - from) : to;
}

double turn_to(const CrowdRobot& robot, double heading, double dt) {
  return std::clamp(wrapped(heading - robot.heading) / dt, -robot.body.yaw_rate, robot.body.yaw_rate);
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

Steering where_it_looks(const CrowdRobot& robot, const Vec<3>& chosen, bool free, double dt) {
  const Braking braking{dt, robot.body.acceleration};
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
  const double least = braking.slower(robot.ahead);
  ahead = std::clamp(ahead, least, std::max(least, robot.ahead + robot.body.acceleration * dt));
  // An arc: its chord looks along half of the turn.
  const double half = 0.5 * yaw_rate * dt, chord = half == 0.0 ? 1.0 : std::sin(half) / half;
  const double climb = speed > 0.0 ? chosen[2] / speed : 0.0;
  const Vec<3> way{{chord * std::cos(robot.heading + half), chord * std::sin(robot.heading + half), climb}};
  Vec<3> wanted = ahead * way;
  if (speed == 0.0) wanted[2] = chosen[2];
  const Vec<3> nose{{std::cos(robot.heading), std::sin(robot.heading), 0.0}};
  const Vec<3> after{{std::cos(robot.heading + 2.0 * half), std::sin(robot.heading + 2.0 * half), 0.0}};
  return {least * way, wanted, least, ahead, yaw_rate, least * nose, after};
}

}  // namespace

Steering steered(const CrowdRobot& robot, const Vec<3>& chosen, bool free, double dt) {
  return robot.body.faces_its_way ? where_it_looks(robot, chosen, free, dt) : in_any_direction(robot, chosen, dt);
}

}  // namespace muster
