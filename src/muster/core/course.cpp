#include "course.hpp"

#include <algorithm>

namespace muster {

namespace {

constexpr double kExact = 1e-3;     // metres: nearer than this is there
constexpr double kRounding = 1e-9;  // metres
constexpr double kSure = 3.0;       // standard deviations within which a robot is of where it takes itself to be
constexpr double kHeldUp = 1.0;     // seconds

// The speed with which a robot that comes from a place may go past way point k.
double corner_speed(const CrowdRobot& robot, const Vec<3>& from, std::size_t k, const Tolerances& tolerances,
                    double dt) {
  const auto& way = robot.way;
  const auto on = std::find_if(way.begin() + static_cast<std::ptrdiff_t>(k), way.end(),
                               [&](const Waypoint& point) { return !(point.at == way[k].at); });
  if (way[k].stops() || on == way.end()) return 0.0;
  const Vec<3> in = way[k].at - from, out = on->at - way[k].at;
  const double lengths = norm(in) * norm(out);
  if (lengths == 0.0) return robot.top_speed();
  const double turn = std::acos(std::clamp(dot(in, out) / lengths, -1.0, 1.0));
  if (robot.body.faces_its_way && turn > 0.5 * robot.body.yaw_rate * dt) return 0.0;
  const double half = std::sin(turn / 2.0), sine = dot(in, out) > 0.0 ? std::sin(turn) : 1.0;
  if (half == 0.0) return robot.top_speed();
  const double cut = tolerances.corner / (dt * sine), swerve = robot.body.acceleration * dt / (2.0 * half);
  return std::min({robot.top_speed(), cut, swerve});
}

double speed_along(const CrowdRobot& robot, const Tolerances& tolerances, double dt) {
  const Braking braking{dt, robot.body.acceleration};
  const double top = robot.top_speed(), longest = braking.distance(top);
  double most = top, ahead = 0.0;
  Vec<3> from = robot.position;
  for (std::size_t k = robot.next; k < robot.way.size() && ahead < longest; ++k) {
    ahead += norm(robot.way[k].at - from);
    most = std::min(most, braking.speed(ahead + braking.distance(corner_speed(robot, from, k, tolerances, dt))));
    from = robot.way[k].at;
  }
  return most;
}

}  // namespace

Vec<3> along_course(const CrowdRobot& robot, const Tolerances& tolerances, double dt) {
  double left = speed_along(robot, tolerances, dt) * dt;
  Vec<3> from = robot.position;
  for (std::size_t k = robot.next; k < robot.way.size(); ++k) {
    const Vec<3>& at = robot.way[k].at;
    const double leg = norm(at - from);
    if (left < leg - kRounding) {
      from = from + (left / leg) * (at - from);
      break;
    }
    const double past = corner_speed(robot, from, k, tolerances, dt);
    from = at;
    left -= leg;
    if (past == 0.0) break;
  }
  return (1.0 / dt) * (from - robot.position);
}

Vec<3> closest_on_piece(const Vec<3>& p, const Vec<3>& from, const Vec<3>& to) {
  const Vec<3> along = to - from;
  const double squared = dot(along, along);
  const double share = squared > 0.0 ? std::clamp(dot(p - from, along) / squared, 0.0, 1.0) : 0.0;
  return from + share * along;
}

Vec<3> straight_to(const CrowdRobot& robot, const Vec<3>& place, double dt) {
  const Vec<3> way = place - robot.position;
  const double away = norm(way), speed = Braking{dt, robot.body.acceleration}.speed(away);
  return away > 0.0 ? (std::min(speed, robot.top_speed()) / away) * way : Vec<3>{};
}

bool passes(const CrowdRobot& robot, const Vec<3>& before, Tolerances tolerances, double dt) {
  const Waypoint& point = robot.way[robot.next];
  // What holds it up may stand there because the robot is not where it takes itself to be.
  if (robot.turned_aside && robot.patience.stuck > kHeldUp) tolerances.arrival += kSure * robot.belief.spread;
  const double away = norm(point.at - robot.position);
  const bool no_nearer = robot.turned_aside || away >= norm(point.at - before);
  if (point.stops() || robot.next + 1 == robot.way.size()) {
    const Braking braking{dt, robot.body.acceleration};
    if (norm(robot.lag) > tolerances.arrival) return false;
    if (braking.distance(braking.slower(norm(robot.commanded))) > tolerances.arrival) return false;
    return away <= (no_nearer ? tolerances.arrival : kExact);
  }
  const double past = corner_speed(robot, before, robot.next, tolerances, dt);
  if (away <= kExact || (past == 0.0 && no_nearer && away <= tolerances.arrival)) return true;
  const double missed = norm(point.at - closest_on_piece(point.at, before, robot.position));
  if (missed <= tolerances.corner + kRounding && past > 0.0) return true;
  const double room = point.labelled ? tolerances.arrival : std::max(tolerances.arrival, 0.5 * robot.body.radius);
  return robot.turned_aside && missed <= room;
}

}  // namespace muster
