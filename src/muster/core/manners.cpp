#include "manners.hpp"

#include <algorithm>

namespace muster {

namespace {

constexpr double kRight = -0.1;    // radians
constexpr double kPatience = 1.0;  // seconds
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
  const double away = norm(robot.way[robot.next].at - robot.position);
  if (away < best - 0.1 * robot.top_speed()) {
    best = away;
    stuck = 0.0;
  } else if (robot.turned_aside) {
    stuck += dt;
  }
}

// The longer a robot is large and slow, the longer it takes it to get past another.
double Patience::tilt_at(double time, const Body& body, Random& random) {
  if (time < until) return tilt;
  const double past = 2.0 * body.radius / body.speed;
  tilt = tilt != 0.0 ? 0.0 : (random.uniform() < 0.75 ? -1.0 : 1.0) * kPi * (0.2 + 0.5 * random.uniform());
  until = time + 0.5 + past * (0.5 + 1.5 * random.uniform());
  return tilt;
}

Manners::Manners(std::vector<CrowdRobot>& robots, const AgentTree<3>& tree, double time, double dt)
    : robots_(robots), tree_(tree), time_(time), dt_(dt) {
  for (const CrowdRobot& robot : robots) largest_radius_ = std::max(largest_radius_, robot.body.radius);
}

Vec<3> Manners::wanted(int i, const Vec<3>& course) const {
  CrowdRobot& robot = robots_[i];
  if (!robot.turned_aside) return course;
  const double radius = robot.body.radius;
  const double stop = Braking{dt_, robot.body.acceleration}.distance(robot.top_speed());
  const bool impatient = robot.patience.stuck > kPatience;
  std::vector<int> near;
  tree_.near(i, {8, radius + largest_radius_ + std::max(radius, stop)}, near);
  for (const int k : near) {
    const CrowdRobot& other = robots_[k];
    if (other.body.radius == 0.0 || !other.stands(time_)) continue;
    const bool on_way_point = norm(other.position - robot.way[robot.next].at) < radius + other.body.radius;
    const bool free_to_go = !other.failed && other.phase == Phase::idle;
    if (free_to_go && (on_way_point || impatient)) ask(k);
    if (!free_to_go && on_way_point) {
      robot.patience.stuck = 0.0;
      return {};
    }
  }
  if (impatient) return tilted(course, robot.patience.tilt_at(time_, robot.body, robot.whims));
  const bool far = norm(robot.way[robot.next].at - robot.position) > 2.0 * radius;
  return far ? tilted(course, kRight) : course;
}

void Manners::ask(int k) const { robots_[k].asked_until = time_ + kAskedFor; }

}  // namespace muster
