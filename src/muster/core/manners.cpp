#include "manners.hpp"

#include <algorithm>

#include "course.hpp"

namespace muster {

namespace {

constexpr double kRight = -0.1;    // radians
constexpr double kPatience = 1.0;  // seconds
constexpr double kOnPiece = 0.01;  // metres
constexpr double kCrumbs = 0.05;   // metres
constexpr double kAskedFor = 3.0;  // seconds
constexpr double kPi = 3.14159265358979323846;

// Turned to the left about the vertical; what goes straight up or down leans towards x.
Vec<3> tilted(const Vec<3>& v, double angle) {
  const double level = std::hypot(v[0], v[1]), length = norm(v);
  const Vec<3> left =
      level > 1e-9 * length ? (length / level) * Vec<3>{{-v[1], v[0], 0.0}} : Vec<3>{{length, 0.0, 0.0}};
  return std::cos(angle) * v + std::sin(angle) * left;
}

}  // namespace

void Patience::note(const CrowdRobot& robot, double dt) {
  const Vec<3>& goal = robot.phase == Phase::idle ? robot.post : robot.way[robot.next].at;
  const double away = norm(goal - robot.position);
  if (away < best - 0.1 * std::min(best, robot.top_speed())) {
    best = away;
    stuck = 0.0;
  } else if (robot.turned_aside) {
    stuck += dt;
  }
}

// A large and slow robot takes longer to get past another. After a try patience begins anew.
double Patience::tilt_at(double time, const Body& body, Random& random) {
  if (time < until) return tilt;
  if (tilt != 0.0) {
    *this = {};
    return 0.0;
  }
  const double past = 2.0 * body.radius / body.speed;
  tilt = (random.uniform() < 0.75 ? -1.0 : 1.0) * kPi * (0.2 + 0.5 * random.uniform());
  until = time + 0.5 + past * (0.5 + 1.5 * random.uniform());
  return tilt;
}

void Trail::note(const CrowdRobot& robot) {
  const Vec<3>& p = robot.position;
  const double spacing = std::max(kCrumbs, 0.5 * robot.body.radius);
  const auto near = [&](const Vec<3>& crumb) { return norm(crumb - p) <= spacing; };
  if (norm(closest_on_piece(p, from, robot.way[robot.next].at) - p) <= spacing) {
    crumbs.clear();
  } else if (back) {
    while (!crumbs.empty() && near(crumbs.back())) crumbs.pop_back();
  } else if (const auto loop = std::find_if(crumbs.begin(), crumbs.end(), near); loop != crumbs.end()) {
    crumbs.erase(loop + 1, crumbs.end());
  } else {
    crumbs.push_back(p);
  }
}

Vec<3> Trail::aim(const CrowdRobot& robot) const {
  return crumbs.empty() ? closest_on_piece(robot.position, from, robot.way[robot.next].at) : crumbs.back();
}

Manners::Manners(std::vector<CrowdRobot>& robots, const AgentTree<3>& tree, double time, double dt)
    : robots_(robots), tree_(tree), time_(time), dt_(dt) {
  for (const CrowdRobot& robot : robots) largest_radius_ = std::max(largest_radius_, robot.body.radius);
}

Vec<3> Manners::wanted(int i, const Vec<3>& course) const {
  const CrowdRobot& robot = robots_[i];
  if (!robot.turned_aside) return course;
  const double radius = robot.body.radius;
  const double stop = Braking{dt_, robot.body.acceleration}.distance(robot.top_speed());
  std::vector<int> near;
  tree_.near(i, {8, radius + largest_radius_ + std::max(radius, stop)}, near);
  return robot.phase == Phase::idle ? wanted_to_post(i, course, near) : wanted_under_way(i, course, near);
}

Vec<3> Manners::wanted_under_way(int i, const Vec<3>& course, const std::vector<int>& near) const {
  CrowdRobot& robot = robots_[i];
  const Vec<3>& goal = robot.way[robot.next].at;
  const bool impatient = robot.patience.stuck > kPatience;
  for (const int k : near) {
    const CrowdRobot& other = robots_[k];
    const bool on_way_point = stands_on(k, goal, robot.body.radius);
    const bool ahead = dot(other.position - robot.position, course) > 0.0;
    const bool has_time = !other.failed && other.phase == Phase::idle && other.body.radius > 0.0;
    if (has_time && (on_way_point || (impatient && ahead))) ask(k);
    if (!has_time && on_way_point) {
      robot.patience.stuck = 0.0;
      return {};
    }
  }
  if (near.empty() && !robot.near_faces.empty() && (robot.trail.back || impatient)) return wanted_back(robot, course);
  robot.trail.back = false;
  if (impatient) return tilted(course, robot.patience.tilt_at(time_, robot.body, robot.whims));
  return norm(goal - robot.position) > 2.0 * robot.body.radius ? tilted(course, kRight) : course;
}

Vec<3> Manners::wanted_back(CrowdRobot& robot, const Vec<3>& course) const {
  const Vec<3> aim = robot.trail.aim(robot);
  robot.trail.back = norm(aim - robot.position) > kOnPiece;
  if (robot.trail.back) return straight_to(robot, aim, dt_);
  robot.patience = {};
  return course;
}

Vec<3> Manners::wanted_to_post(int i, const Vec<3>& course, const std::vector<int>& near) const {
  CrowdRobot& robot = robots_[i];
  const bool taken =
      std::any_of(near.begin(), near.end(), [&](int k) { return stands_on(k, robot.post, robot.body.radius); });
  if (!taken && robot.patience.stuck <= kPatience) return course;
  robot.post = robot.position;
  return {};
}

bool Manners::stands_on(int k, const Vec<3>& place, double radius) const {
  const CrowdRobot& other = robots_[k];
  return other.body.radius > 0.0 && other.stands(time_) && norm(other.position - place) < radius + other.body.radius;
}

void Manners::ask(int k) const { robots_[k].asked_until = time_ + kAskedFor; }

}  // namespace muster
