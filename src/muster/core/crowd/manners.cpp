#include "crowd/manners.hpp"

#include <algorithm>
#include <utility>

#include "crowd/course.hpp"

namespace muster {

namespace {

constexpr double kTiltToRight = -0.1;  // radians
constexpr double kPatience = 1.0;      // seconds
constexpr double kOnPiece = 0.01;      // metres
constexpr double kCrumbs = 0.05;       // metres
constexpr double kAskedFor = 3.0;      // seconds
constexpr double kLooks = 0.5;         // seconds between two looks for room
constexpr double kYields = 5.0;        // seconds for which one waits for another to make room
constexpr double kPi = 3.14159265358979323846;

// Turned to the left about the vertical; what goes straight up or down leans towards x.
Vec<3> tilted(const Vec<3>& v, double angle) {
  const double level = std::hypot(v[0], v[1]), length = norm(v);
  const Vec<3> left =
      level > 1e-9 * length ? (length / level) * Vec<3>{{-v[1], v[0], 0.0}} : Vec<3>{{length, 0.0, 0.0}};
  return std::cos(angle) * v + std::sin(angle) * left;
}

double largest_radius(const std::vector<CrowdRobot>& robots) {
  double largest = 0.0;
  for (const CrowdRobot& robot : robots) largest = std::max(largest, robot.body.radius);
  return largest;
}

}  // namespace

void Patience::note(const CrowdRobot& robot, double dt) {
  const double away = norm(robot.goal() - robot.position);
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

Manners::Manners(std::vector<CrowdRobot>& robots, const std::vector<WallSet>& walls, const AgentTree<3>& tree,
                 double time, double dt, bool space, double almost)
    : robots_(robots),
      tree_(tree),
      time_(time),
      dt_(dt),
      almost_(almost),
      largest_radius_(largest_radius(robots)),
      room_(robots, walls, tree, largest_radius_, space) {}

Vec<3> Manners::course_without_order(int i) const {
  if (robots_[i].asked_until < time_) come_back(i);
  return course_aside(robots_[i]);
}

Vec<3> Manners::wanted(int i, const Vec<3>& course) const {
  CrowdRobot& robot = robots_[i];
  // Turned aside by others in every other step, one that faces its way would turn to and fro.
  const bool arrived_before = std::exchange(robot.arrives, false) && robot.body.faces_its_way;
  const double radius = robot.body.radius;
  const double stop = Braking{dt_, robot.body.acceleration}.distance(robot.top_speed());
  std::vector<int> near;
  if (robot.turned_aside || arrived_before) {
    const double beside = radius + std::max(radius, stop);
    tree_.near(i, {8, beside + largest_radius_}, near);
    // A large robot far away widens the search, and not what counts as near to others.
    std::erase_if(near,
                  [&](int k) { return norm(robots_[k].position - robot.position) > beside + robots_[k].body.radius; });
  }
  if (!robot.turned_aside && near.empty()) {
    robot.waits = false;
    return course;
  }
  if (robot.phase == Phase::idle) return wanted_aside(i, course, near);
  if (robot.waits && robot.asked_until >= time_) return wanted_aside(i, course_aside(robot), near);
  robot.aside.clear();
  return wanted_under_way(i, course, near);
}

Vec<3> Manners::wanted_under_way(int i, const Vec<3>& course, const std::vector<int>& near) const {
  CrowdRobot& robot = robots_[i];
  const Vec<3>& goal = robot.way[robot.next].at;
  const auto on_way_point = [&](int k) { return is_on(k, goal, robot.body.radius); };
  robot.waits = std::any_of(near.begin(), near.end(), [&](int k) {
    return on_way_point(k) && !robots_[k].has_time() && robots_[k].stands(time_);
  });
  if (robot.waits) {
    robot.patience.stuck = 0.0;
    return {};
  }
  meet(i, course, near);
  const bool yields = std::any_of(near.begin(), near.end(), [&](int k) {
    return on_way_point(k) && robots_[k].has_time() && !robots_[k].aside.empty();
  });
  const bool almost_there = norm(goal - robot.position) < almost_ * robot.body.radius &&
                            std::none_of(near.begin(), near.end(), [&](int k) { return is_before(i, k); });
  const bool impatient = robot.patience.stuck > (almost_there ? kYields : kPatience);
  robot.arrives = almost_there && !impatient;
  if (yields && robot.patience.stuck < kYields) return {};
  if (near.empty() && !robot.near_faces.empty() && (robot.trail.back || impatient)) return wanted_back(robot, course);
  robot.trail.back = false;
  if (impatient) return tilted(course, robot.patience.tilt_at(time_, robot.body, robot.whims));
  return norm(goal - robot.position) > 2.0 * robot.body.radius ? tilted(course, kTiltToRight) : course;
}

Vec<3> Manners::wanted_aside(int i, const Vec<3>& course, const std::vector<int>& near) const {
  CrowdRobot& robot = robots_[i];
  if (course == Vec<3>{}) return course;
  meet(i, course, near);
  if (robot.patience.stuck <= kPatience) return course;
  return tilted(course, robot.patience.tilt_at(time_, robot.body, robot.whims));
}

// Ask those who stand where robot i wants to be, and if it is held up those ahead of it, too. Who only comes back asks
// nobody: robots without orders would drive each other about for ever.
void Manners::meet(int i, const Vec<3>& course, const std::vector<int>& near) const {
  const CrowdRobot& robot = robots_[i];
  if (robot.phase == Phase::idle && robot.asked_until < time_) return;
  const bool impatient = robot.patience.stuck > kPatience;
  for (const int k : near) {
    const bool ahead = dot(robots_[k].position - robot.position, course) > 0.0;
    if (robots_[k].has_time() && (is_on(k, robot.goal(), robot.body.radius) || (impatient && ahead))) ask(k, i);
  }
}

void Manners::ask(int k, int asker) const {
  CrowdRobot& robot = robots_[k];
  robot.asked_until = time_ + kAskedFor;
  const Vec<3>& stays = robot.aside.empty() ? robot.position : robot.aside.back();
  if (time_ < robot.look_again || !room_.claims(asker, k, stays, 1, 0.0)) return;
  robot.look_again = time_ + kLooks;
  if (auto way = room_.aside(k, asker); !way.empty()) {
    robot.aside = std::move(way);
    robot.patience = {};
  }
}

// If nobody claims its post; else it stays where it is for now.
void Manners::come_back(int i) const {
  CrowdRobot& robot = robots_[i];
  const bool on_its_way = !robot.aside.empty() && robot.aside.back() == robot.post;
  if (on_its_way && robot.patience.stuck <= kYields && room_.is_free(i, robot.post)) return;
  robot.aside.clear();
  if (time_ < robot.look_again || !room_.is_free(i, robot.post)) return;
  robot.look_again = time_ + kLooks;
  robot.aside = room_.way_to(i, robot.post);
  robot.patience = {};
}

// The velocity to the first of the places by which it makes room.
Vec<3> Manners::course_aside(CrowdRobot& robot) const {
  auto& aside = robot.aside;
  while (!aside.empty() && norm(aside.front() - robot.position) <= (aside.size() > 1 ? kCrumbs : robot.exact))
    aside.erase(aside.begin());
  return aside.empty() ? Vec<3>{} : straight_to(robot, aside.front(), dt_);
}

Vec<3> Manners::wanted_back(CrowdRobot& robot, const Vec<3>& course) const {
  const Vec<3> aim = robot.trail.aim(robot);
  robot.trail.back = norm(aim - robot.position) > kOnPiece;
  if (robot.trail.back) return straight_to(robot, aim, dt_);
  robot.patience = {};
  return course;
}

// Robot i would touch k on the straight way to its way point.
bool Manners::is_before(int i, int k) const {
  const CrowdRobot &robot = robots_[i], &other = robots_[k];
  if (other.body.radius == 0.0) return false;
  const double now = norm(other.position - robot.position);
  const Vec<3> closest = closest_on_piece(other.position, robot.position, robot.goal());
  return norm(closest - other.position) < std::min(robot.body.radius + other.body.radius, now - kOnPiece);
}

bool Manners::is_on(int k, const Vec<3>& place, double radius) const {
  const CrowdRobot& other = robots_[k];
  return other.body.radius > 0.0 && norm(other.position - place) < radius + other.body.radius;
}

}  // namespace muster
