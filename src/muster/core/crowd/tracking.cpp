#include "crowd/tracking.hpp"

#include <algorithm>

namespace muster {

namespace {

constexpr double kAlong = 2.0, kAcross = 4.0, kTurn = 3.0;  // gains: 1/s, 1/m^2, 1/s
constexpr double kAstrayS = 0.3, kAstrayM = 0.05;           // so far off, at top speed, a robot is astray
constexpr double kSmall = 1e-9;

double astray_m(const CrowdRobot& robot) { return kAstrayS * robot.top_speed() + kAstrayM; }

// The place and heading of the reference at a time of its clock, in the true map.
Waypoint at(const CrowdRobot& robot, double clock) {
  const Reference& r = robot.reference;
  const double steps = std::clamp(clock / r.step, 0.0, static_cast<double>(r.places.size() - 1));
  const std::size_t k = std::min(static_cast<std::size_t>(steps), r.places.size() - 1);
  const std::size_t next = std::min(k + 1, r.places.size() - 1);
  const double share = steps - static_cast<double>(k);
  const Vec<3> place = r.places[k] + share * (r.places[next] - r.places[k]);
  return robot.belief.true_of({place, r.headings[k] + share * (r.headings[next] - r.headings[k]), 0.0, false});
}

// The time of the next way point at which the robot stops; of the next one where the clock has passed it before the
// robot.
double limit(const CrowdRobot& robot) {
  const Reference& r = robot.reference;
  std::size_t k = robot.next;
  if (r.clock >= r.times[k]) return r.times[k];
  while (k + 1 < robot.way.size() && !robot.way[k].stops()) ++k;
  return r.times[k];
}

// By how much the reference is ahead of the robot, along its own way. A robot beside it is not behind: were the clock
// to wait for that, the law, whose steering to the side is in proportion to the speed, would hardly steer.
double behind(const CrowdRobot& robot, double dt) {
  const double clock = robot.reference.clock;
  const Vec<3> now = at(robot, clock).at, way = at(robot, clock + dt).at - now;
  const double length = norm(way);
  return length < kSmall ? 0.0 : std::max(0.0, dot(now - robot.position, way) / length);
}

// The clock of a robot that goes without: to the place of the reference that is nearest to it, never back.
void catch_up(CrowdRobot& robot, double most) {
  Reference& r = robot.reference;
  const auto away = [&](double clock) { return norm(at(robot, clock).at - robot.position); };
  while (r.clock + r.step <= most && away(r.clock + r.step) <= away(r.clock)) r.clock += r.step;
}

// The nonlinear law of [deluca2001] for a robot that faces its way: speed ahead and yaw rate from those of
// the reference and from the errors ahead, to the left and of the heading.
void follow(CrowdRobot& robot, const Waypoint& now, double ahead, double yaw_rate) {
  const Vec<3> off = now.at - robot.position;
  const double c = std::cos(robot.heading), s = std::sin(robot.heading);
  const double along = c * off[0] + s * off[1], left = c * off[1] - s * off[0];
  const double turn = wrapped(now.heading - robot.heading);
  const double sinc = std::abs(turn) < kSmall ? 1.0 : std::sin(turn) / turn;
  const double top = robot.top_speed(), most = robot.body.yaw_rate;
  robot.reference.ahead = std::clamp(ahead * std::cos(turn) + kAlong * along, -top, top);
  robot.reference.yaw_rate = std::clamp(yaw_rate + kAcross * ahead * sinc * left + kTurn * turn, -most, most);
}

Vec<3> on_its_arc(const CrowdRobot& robot, double climb, double dt) {
  const Reference& r = robot.reference;
  const double half = 0.5 * r.yaw_rate * dt, chord = std::abs(half) < kSmall ? 1.0 : std::sin(half) / half;
  const double speed = r.ahead * chord, heading = robot.heading + half;
  return {{speed * std::cos(heading), speed * std::sin(heading), climb}};
}

}  // namespace

bool tracks(CrowdRobot& robot, double dt, Vec<3>& velocity) {
  Reference& r = robot.reference;
  r.followed = false;
  if (!r.given()) return false;
  const double error = tracking_error(robot), most = astray_m(robot), end = limit(robot);
  r.astray = error > (r.astray ? 0.5 * most : most);
  if (r.astray) catch_up(robot, end);
  if (r.astray || r.clock >= end - kSmall) return false;
  const double rate = robot.slowed * std::clamp(2.0 - 2.0 * behind(robot, dt) / most, 0.0, 1.0);
  const double later = std::min(end, r.clock + rate * dt);
  const Waypoint now = at(robot, r.clock), then = at(robot, later);
  const Vec<3> went = (1.0 / dt) * (then.at - now.at), off = now.at - robot.position;
  r.clock = later;
  r.followed = true;
  velocity = went + kAlong * off;
  if (robot.body.faces_its_way) {
    const double turn = wrapped(then.heading - now.heading), half = 0.5 * turn;
    const double chord = std::abs(half) < kSmall ? 1.0 : std::sin(half) / half;
    follow(robot, now, std::hypot(went[0], went[1]) / chord, turn / dt);
    velocity = on_its_arc(robot, velocity[2], dt);
  }
  const double speed = norm(velocity), top = robot.top_speed();
  if (speed > top) velocity = (top / speed) * velocity;
  return true;
}

bool clock_is_at(const CrowdRobot& robot) {
  const Reference& r = robot.reference;
  return !r.given() || r.astray || r.clock >= r.times[robot.next] - kSmall;
}

double tracking_error(const CrowdRobot& robot) { return norm(at(robot, robot.reference.clock).at - robot.position); }

}  // namespace muster
