#include "crowd/course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crowd/tracking.hpp"

namespace muster {

namespace {

constexpr double kCourseRounding = 1e-9;  // metres
constexpr double kSure = 3.0;             // standard deviations within which a robot is of where it takes itself to be
constexpr double kHeldUp = 1.0;           // seconds
constexpr double kAnySpeed = std::numeric_limits<double>::infinity();
constexpr double kClimbs = 0.5;  // seconds: the constant interval of (4.12)

// The way between two places; over ground alone where the robot climbs by a law of its own.
Vec<3> leg(const CrowdRobot& robot, const Vec<3>& from, const Vec<3>& to) {
  Vec<3> way = to - from;
  if (robot.body.climb > 0.0) way[2] = 0.0;
  return way;
}

// The speed along a straight piece that keeps the limits of speed and of climb.
double speed_on(const CrowdRobot& robot, const Vec<3>& piece, double allowed = kAnySpeed) {
  const double rise = std::abs(piece[2]);
  const double climbing = rise > 0.0 ? robot.body.climb_rate * robot.slowed * norm(piece) / rise : robot.top_speed();
  return std::min({robot.top_speed(), climbing, allowed});
}

// (4.12): the climb towards the height of the next way point.
double climb(const CrowdRobot& robot, double dt) {
  const double off = robot.way[robot.next].at[2] - robot.position[2], most = robot.body.climb * robot.slowed;
  return std::clamp(off / std::max(kClimbs, dt), -most, most);
}

// Whether a robot that climbs by a law of its own has to wait at way point k for its height.
bool waits_for_height(const CrowdRobot& robot, std::size_t k) {
  if (robot.body.climb == 0.0) return false;
  const double from = k == robot.next ? robot.position[2] : robot.way[k - 1].at[2];
  return std::abs(robot.way[k].at[2] - from) > robot.exact;
}

// The speed along a bend of short pieces, as ways round corners have them, at which a robot that faces its way keeps to
// it: within its acceleration, and as fast as it turns.
double bend_speed(const CrowdRobot& robot, double turn, double in, double out) {
  if (!robot.body.faces_its_way) return kAnySpeed;
  const double radius = std::min(in, out) / turn;
  return std::min(std::sqrt(robot.body.acceleration * radius), robot.body.yaw_rate * radius);
}

// The speed with which a robot that comes from a place may go past way point k.
double corner_speed(const CrowdRobot& robot, const Vec<3>& from, std::size_t k, const Tolerances& tolerances,
                    double dt) {
  const auto& way = robot.way;
  const auto on = std::find_if(way.begin() + static_cast<std::ptrdiff_t>(k), way.end(),
                               [&](const Waypoint& point) { return !(point.at == way[k].at); });
  if (way[k].stops() || on == way.end() || waits_for_height(robot, k)) return 0.0;
  const Vec<3> in = leg(robot, from, way[k].at), out = leg(robot, way[k].at, on->at);
  const double top = std::min(speed_on(robot, in, way[k].speed), speed_on(robot, out, on->speed));
  const double lengths = norm(in) * norm(out);
  if (lengths == 0.0) return top;
  const double turn = std::acos(std::clamp(dot(in, out) / lengths, -1.0, 1.0));
  if (robot.body.faces_its_way && turn > 0.5 * robot.body.yaw_rate * dt) return 0.0;
  const double half = std::sin(turn / 2.0), sine = dot(in, out) > 0.0 ? std::sin(turn) : 1.0;
  if (half == 0.0) return top;
  const double cut = tolerances.corner / (dt * sine), swerve = robot.body.acceleration * dt / (2.0 * half);
  return std::min({top, cut, swerve, bend_speed(robot, turn, norm(in), norm(out))});
}

double speed_along(const CrowdRobot& robot, const Tolerances& tolerances, double dt) {
  const Braking braking{dt, robot.body.acceleration};
  const double longest = braking.distance(robot.top_speed());
  double most = robot.top_speed(), ahead = 0.0;
  Vec<3> from = robot.position;
  for (std::size_t k = robot.next; k < robot.way.size() && ahead < longest; ++k) {
    if (k == robot.next) most = speed_on(robot, leg(robot, from, robot.way[k].at), robot.way[k].speed);
    ahead += norm(leg(robot, from, robot.way[k].at));
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
    const Vec<3> way = leg(robot, from, at);
    const double length = norm(way);
    if (left < length - kCourseRounding) {
      from = from + (left / length) * way;
      break;
    }
    const double past = corner_speed(robot, from, k, tolerances, dt);
    from = at;
    left -= length;
    if (past == 0.0) break;
  }
  Vec<3> velocity = (1.0 / dt) * (from - robot.position);
  if (robot.body.climb > 0.0) velocity[2] = climb(robot, dt);
  return velocity;
}

Vec<3> along_walls(const CrowdRobot& robot, Vec<3> velocity, double dt) {
  const Braking braking{dt, robot.body.acceleration};
  for (const Upright& face : robot.near_faces) {
    const Vec<3> way = face.closest(robot.position) - robot.position;
    const double away = norm(way);
    if (away <= 0.0) continue;
    const double into = dot(velocity, way) / away, most = braking.speed(std::max(0.0, away - robot.body.radius));
    if (into > most) velocity = velocity - ((into - most) / away) * way;
  }
  return velocity;
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
  return away > 0.0 ? (std::min(speed, speed_on(robot, way)) / away) * way : Vec<3>{};
}

bool passes(const CrowdRobot& robot, const Vec<3>& before, Tolerances tolerances, double dt) {
  const Waypoint& point = robot.way[robot.next];
  if (!clock_is_at(robot)) return false;
  // What holds it up may stand there because the robot is not where it takes itself to be.
  if (robot.turned_aside && robot.patience.stuck > kHeldUp) tolerances.arrival += kSure * robot.belief.spread;
  const double away = norm(point.at - robot.position);
  const bool no_nearer = robot.turned_aside || away >= norm(point.at - before);
  if (point.stops() || robot.next + 1 == robot.way.size()) {
    const Braking braking{dt, robot.body.acceleration};
    if (norm(robot.short_of) > tolerances.arrival) return false;
    if (braking.distance(braking.slower(norm(robot.commanded))) > tolerances.arrival) return false;
    return away <= (no_nearer ? tolerances.arrival : robot.exact);
  }
  const double room = point.labelled ? tolerances.arrival : std::max(tolerances.arrival, 0.5 * robot.body.radius);
  if (robot.reference.given() && !robot.reference.astray && tracking_error(robot) <= room) return true;
  const double past = corner_speed(robot, before, robot.next, tolerances, dt);
  if (away <= robot.exact || (past == 0.0 && no_nearer && away <= tolerances.arrival)) return true;
  const double missed = norm(point.at - closest_on_piece(point.at, before, robot.position));
  if (missed <= tolerances.corner + kCourseRounding && past > 0.0) return true;
  return robot.turned_aside && missed <= room;
}

}  // namespace muster
