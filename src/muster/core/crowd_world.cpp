#include "crowd_world.hpp"

#include <algorithm>

#include "orca.hpp"

namespace muster {

namespace {

constexpr double kAside = 0.05;    // share of the top speed by which a velocity differs from one that is followed
constexpr double kWallsFor = 1.0;  // metres for which the walls once collected are enough

double normal(Random& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
  return radius * std::cos(2.0 * std::acos(-1.0) * random.uniform());
}

}  // namespace

int CrowdWorld::add_walls(WallSet walls) {
  walls_.push_back(std::move(walls));
  return static_cast<int>(walls_.size()) - 1;
}

int CrowdWorld::add(const Body& body, const Vec<3>& position, double heading) {
  CrowdRobot robot;
  robot.body = body;
  robot.position = robot.post = position;
  robot.heading = wrapped(heading);
  const std::uint64_t seed = settings_.seed * 0x9e3779b97f4a7c15ULL + 2 * robots_.size();
  robot.noise = Random(seed);
  robot.whims = Random(seed + 1);
  collect_walls(robot);
  robots_.push_back(std::move(robot));
  return static_cast<int>(robots_.size()) - 1;
}

void CrowdWorld::send(int i, std::vector<Waypoint> way, int order) {
  CrowdRobot& robot = robots_[i];
  if (robot.failed) return;
  robot.way = std::move(way);
  robot.order = order;
  robot.next = 0;
  robot.phase = robot.way.empty() ? Phase::idle : Phase::going;
  robot.stopping = robot.way.empty();
  robot.post = robot.position;
  robot.patience = {};
  robot.trail = {robot.position, {}, false};
}

void CrowdWorld::fail(int i) {
  robots_[i].failed = true;
  robots_[i].way.clear();
  robots_[i].next = 0;
  robots_[i].phase = Phase::idle;
}

std::vector<CrowdEvent> CrowdWorld::advance(double until) {
  events_.clear();
  while (events_.empty() && time() + settings_.dt <= until + 1e-6 * settings_.dt) step();
  return std::exchange(events_, {});
}

void CrowdWorld::step() {
  const std::size_t n = robots_.size();
  before_.resize(n);
  for (std::size_t i = 0; i < n; ++i) before_[i] = robots_[i].position;
  const AgentTree<3> tree(before_);
  want(tree);
  chosen_ = wanted_;
  if (settings_.avoidance != Avoidance::none) avoid();
  steer();
  move(tree);
  measure(tree);
  ++steps_;
  for (std::size_t i = 0; i < n; ++i) take_note(static_cast<int>(i));
}

void CrowdWorld::want(const AgentTree<3>& tree) {
  const std::size_t n = robots_.size();
  course_.assign(n, {});
  for (std::size_t i = 0; i < n; ++i) {
    const CrowdRobot& robot = robots_[i];
    if (robot.phase == Phase::going) course_[i] = along_course(robot, settings_.tolerances, settings_.dt);
    if (robot.comes_back(time())) course_[i] = straight_to(robot, robot.post, settings_.dt);
  }
  wanted_ = course_;
  if (settings_.avoidance == Avoidance::none) return;
  const Manners manners(robots_, tree, time(), settings_.dt);
  for (std::size_t i = 0; i < n; ++i)
    if (course_[i] != Vec<3>{} && robots_[i].body.radius > 0.0)
      wanted_[i] = manners.wanted(static_cast<int>(i), course_[i]);
}

void CrowdWorld::steer() {
  const std::size_t n = robots_.size();
  steerings_.resize(n);
  choices_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    CrowdRobot& robot = robots_[i];
    const bool free = norm(chosen_[i] - course_[i]) < 1e-6;
    steerings_[i] = steered(robot, chosen_[i], free, settings_.dt);
    const Steering& steering = steerings_[i];
    choices_[i] = {steering.braked,      steering.wanted,   steering.straight,
                   steering.after,       robot.body.radius, robot.body.acceleration,
                   robot.stands(time()), &robot.near_faces, &walls_[robot.body.walls]};
  }
}

void CrowdWorld::move(const AgentTree<3>& tree) {
  const double dt = settings_.dt;
  RightOfWay right(before_, choices_, tree, dt);
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    CrowdRobot& robot = robots_[i];
    const Steering& steering = steerings_[i];
    const double share = settings_.avoidance == Avoidance::none ? 1.0 : right.share(static_cast<int>(i));
    if (share < 0.0) {
      robot.commanded = steering.straight;
      robot.ahead = steering.ahead_braked;
    } else {
      robot.commanded = choices_[i].at(share);
      robot.ahead = steering.ahead_braked + share * (steering.ahead_wanted - steering.ahead_braked);
      robot.heading = wrapped(robot.heading + steering.yaw_rate * dt);
    }
    robot.turned_aside = share < 1.0 - kAside || norm(chosen_[i] - course_[i]) > kAside * robot.top_speed();
    drive(robot);
    if (norm(robot.position - robot.looked_at) > kWallsFor) collect_walls(robot);
  }
}

// A robot never gets more than it drives by, so that noise cannot bring it into contact.
void CrowdWorld::drive(CrowdRobot& robot) {
  const CrowdNoise& noise = settings_.noise;
  robot.velocity = robot.commanded;
  if (robot.commanded == Vec<3>{}) return;
  if (noise.velocity > 0.0)
    robot.velocity = std::max(0.0, 1.0 - std::abs(noise.velocity * normal(robot.noise))) * robot.velocity;
  double counted = norm(robot.velocity) * settings_.dt;
  if (noise.odometry > 0.0) counted *= std::max(0.0, 1.0 + noise.odometry * normal(robot.noise));
  if (noise.slip > 0.0) robot.velocity = (1.0 - noise.slip * robot.noise.uniform()) * robot.velocity;
  robot.odometry += counted;
  robot.travelled += norm(robot.velocity) * settings_.dt;
  robot.position = robot.position + settings_.dt * robot.velocity;
}

void CrowdWorld::take_note(int i) {
  CrowdRobot& robot = robots_[i];
  if (robot.phase == Phase::idle) {
    settle(robot);
    return;
  }
  if (robot.phase == Phase::going) {
    while (robot.phase == Phase::going && passes(robot, before_[i], settings_.tolerances, settings_.dt)) {
      if (robot.way[robot.next].stops())
        robot.phase = Phase::turning;
      else
        next_way_point(i);
    }
    if (robot.phase == Phase::going) {
      robot.patience.note(robot, settings_.dt);
      if (robot.turned_aside || !robot.trail.crumbs.empty()) robot.trail.note(robot);
    }
  }
  if (robot.phase == Phase::turning) {
    const Waypoint& point = robot.way[robot.next];
    if (!std::isnan(point.heading) && std::abs(wrapped(point.heading - robot.heading)) > 1e-9) return;
    robot.phase = Phase::holding;
    robot.hold_until = time() + point.hold;
  }
  if (robot.phase == Phase::holding && time() >= robot.hold_until - 1e-6 * settings_.dt) next_way_point(i);
}

// Where a robot without an order comes to a stand is its post.
void CrowdWorld::settle(CrowdRobot& robot) const {
  if (robot.comes_back(time())) robot.patience.note(robot, settings_.dt);
  const bool near = norm(robot.post - robot.position) <= settings_.tolerances.arrival;
  if (near || robot.failed || robot.stopping) robot.post = robot.position;
  if (robot.commanded == Vec<3>{}) robot.stopping = false;
}

void CrowdWorld::next_way_point(int i) {
  CrowdRobot& robot = robots_[i];
  robot.trail = {robot.way[robot.next].at, {}, false};  // not where it cut past it: there may be a wall ahead
  const bool labelled = robot.way[robot.next].labelled, last = ++robot.next == robot.way.size();
  robot.phase = last ? Phase::idle : Phase::going;
  robot.patience = {};
  robot.stopping = last;
  robot.post = robot.position;
  if (labelled || last) events_.push_back({time(), i, robot.order, static_cast<int>(robot.next), last});
}

void CrowdWorld::collect_walls(CrowdRobot& robot) const {
  const Body& body = robot.body;
  const double stop = Braking{settings_.dt, body.acceleration}.distance(body.speed);
  const double reach = body.radius + std::max(settings_.wall_horizon * body.speed, stop) + kWallsFor;
  robot.looked_at = robot.position;
  robot.near_faces.clear();
  robot.near_walls.clear();
  for (const Upright& face : walls_[body.walls].faces) {
    if (norm(face.closest(robot.position) - robot.position) > reach) continue;
    robot.near_faces.push_back(face);
    robot.near_walls.push_back(face.base);
  }
}

}  // namespace muster
