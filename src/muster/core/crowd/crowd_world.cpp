#include "crowd/crowd_world.hpp"

#include <algorithm>

#include "crowd/orca.hpp"

namespace muster {

namespace {

constexpr double kDeviation = 0.05;  // share of the top speed by which a velocity differs from one that is followed
constexpr double kTurned = 0.01;     // radians: the laws of [tcf-thesis] never turn a robot exactly to a heading
constexpr double kAlmost = 4.0;      // radii from its way point within which one goes there whoever stands behind it;
                                     // ORCA looks no farther ahead than it has to
constexpr double kApproach = 0.5;    // seconds over which an approach is a mean
constexpr double kWallsFor = 1.0;    // metres for which the walls once collected are enough
constexpr std::uint64_t kWheels = 0x5eed0fc0de0d0e7cULL;  // what wheels do by themselves is drawn apart from the rest

double normal(Random& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
  return radius * std::cos(2.0 * std::acos(-1.0) * random.uniform());
}

void count(CrowdRobot& robot, double metres, double counted) {
  robot.travelled += metres;
  robot.odometry += robot.counts * counted;
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
  if (body.law == Law::thesis) robot.exact = settings_.tolerances.arrival;
  const std::uint64_t seed = settings_.seed * 0x9e3779b97f4a7c15ULL + 2 * robots_.size();
  robot.noise = Random(seed);
  robot.whims = Random(seed + 1);
  robot.wheels = Random(seed ^ kWheels);
  collect_walls(robot);
  robots_.push_back(std::move(robot));
  return static_cast<int>(robots_.size()) - 1;
}

void CrowdWorld::set_walls(int i, int walls) {
  robots_[i].body.walls = walls;
  collect_walls(robots_[i]);
}

void CrowdWorld::send(int i, std::vector<Waypoint> way, int order) {
  CrowdRobot& robot = robots_[i];
  if (robot.failed) return;
  robot.told = std::move(way);
  robot.way.clear();
  for (const Waypoint& point : robot.told) robot.way.push_back(robot.belief.true_of(point));
  robot.order = order;
  robot.reference = {};
  robot.next = 0;
  robot.phase = robot.way.empty() ? Phase::idle : Phase::going;
  robot.stopping = robot.way.empty();
  robot.post = robot.position;
  robot.patience = {};
  robot.trail = {robot.position, {}, false};
  robot.waits = false;
  robot.approach = 0.0;
  robot.asked_until = kBeforeAll;
  robot.aside.clear();
}

void CrowdWorld::follow(int i, Reference reference) {
  CrowdRobot& robot = robots_[i];
  if (robot.failed || robot.way.size() != reference.times.size()) return;
  robot.reference = std::move(reference);
}

void CrowdWorld::believe(int i, const Vec<3>& place, double heading, double spread) {
  CrowdRobot& robot = robots_[i];
  robot.belief = {robot.place(), place, wrapped(robot.facing() - heading), spread};
  for (std::size_t k = robot.next; k < robot.way.size(); ++k) robot.way[k] = robot.belief.true_of(robot.told[k]);
}

void CrowdWorld::resume(long steps, const std::vector<Motion>& motions) {
  steps_ = steps;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    CrowdRobot& robot = robots_[i];
    robot.velocity = robot.velocity_before = robot.commanded = motions[i].velocity;
    robot.heading_before = robot.heading;
    robot.ahead = motions[i].ahead;
    robot.yaw_rate = motions[i].yaw_rate;
    robot.stopping = robot.under_way();
  }
}

void CrowdWorld::fail(int i) {
  robots_[i].failed = true;
  robots_[i].way.clear();
  robots_[i].aside.clear();
  robots_[i].reference = {};
  robots_[i].next = 0;
  robots_[i].phase = Phase::idle;
}

void CrowdWorld::place(int i, const Vec<3>& position) {
  CrowdRobot& robot = robots_[i];
  robot.position = robot.post = position;
  robot.velocity = robot.velocity_before = robot.commanded = robot.short_of = {};
  robot.ahead = robot.yaw_rate = robot.turn_short_of = robot.approach = 0.0;
  robot.way.clear();
  robot.aside.clear();
  robot.reference = {};
  robot.next = 0;
  robot.phase = Phase::idle;
  robot.stopping = robot.waits = false;
  robot.patience = {};
  robot.trail = {position, {}, false};
  robot.asked_until = kBeforeAll;
  collect_walls(robot);
}

std::vector<CrowdEvent> CrowdWorld::advance(double until) {
  events_.clear();
  while (events_.empty() && time() + settings_.dt <= until + 1e-6 * settings_.dt) step();
  return std::exchange(events_, {});
}

void CrowdWorld::step() {
  look();
  const AgentTree<3> tree(before_);
  decide(tree);
  for (CrowdRobot& robot : robots_) move(robot);
  conclude(tree);
}

std::vector<Command> CrowdWorld::command() {
  look();
  decide(AgentTree<3>(before_));
  std::vector<Command> commands;
  for (const CrowdRobot& robot : robots_) {
    const double full = norm(robot.commanded), kept = full > 0.0 ? norm(robot.velocity) / full : 1.0;
    commands.push_back({robot.velocity, kept * robot.ahead, robot.yaw_rate});
  }
  return commands;
}

std::vector<CrowdEvent> CrowdWorld::carried_out(const std::vector<Carried>& after, double still) {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    CrowdRobot& robot = robots_[i];
    robot.short_of = after[i].short_of;
    robot.turn_short_of = after[i].turn_short_of;
    robot.position = after[i].place + robot.short_of;
    robot.heading = wrapped(after[i].heading + robot.turn_short_of);
    robot.velocity = (1.0 / settings_.dt) * (robot.place() - places_before_[i]);
    if (norm(robot.velocity) < still) robot.velocity = {};
    const double metres = norm(robot.velocity) * settings_.dt;
    count(robot, metres, std::isnan(after[i].counted) ? metres : after[i].counted);
    robot.wheel_way = after[i].counted;
    robot.wheel_turn = after[i].turn_counted;
  }
  events_.clear();
  conclude(AgentTree<3>(before_));
  return std::exchange(events_, {});
}

void CrowdWorld::look() {
  before_.resize(robots_.size());
  places_before_.resize(robots_.size());
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    before_[i] = robots_[i].position;
    places_before_[i] = robots_[i].place();
    robots_[i].velocity_before = robots_[i].velocity;
    robots_[i].heading_before = robots_[i].facing();
  }
}

Felt CrowdWorld::felt(int i) const {
  const CrowdRobot& robot = robots_[i];
  const double turned = wrapped(robot.facing() - robot.heading_before), facing = robot.heading_before + turned / 2.0;
  const Vec<3> change = (1.0 / settings_.dt) * (robot.velocity - robot.velocity_before);
  const double c = std::cos(facing), s = std::sin(facing);
  return {{{c * change[0] + s * change[1], c * change[1] - s * change[0], change[2]}}, turned / settings_.dt};
}

Counted CrowdWorld::counted(int i) const {
  const CrowdRobot& robot = robots_[i];
  if (steps_ == 0) return {{}, 0.0};
  const double turned = wrapped(robot.facing() - robot.heading_before), amid = robot.heading_before + turned / 2.0;
  const Vec<3> went = settings_.dt * robot.velocity;
  const double c = std::cos(amid), s = std::sin(amid);
  double ahead = c * went[0] + s * went[1], left = c * went[1] - s * went[0];
  if (robot.body.faces_its_way) {
    ahead = std::isnan(robot.wheel_way) ? ahead : std::copysign(robot.wheel_way, ahead);
    left = 0.0;
  }
  const double turn = std::isnan(robot.wheel_turn) ? turned : robot.wheel_turn;
  const double turn_counted = robot.turn_counts * turn + robot.turns_per_metre * std::hypot(ahead, left);
  return {robot.counts * Vec<3>{{ahead, left, went[2]}}, turn_counted};
}

void CrowdWorld::decide(const AgentTree<3>& tree) {
  want(tree);
  chosen_ = wanted_;
  if (settings_.avoidance != Avoidance::none) avoid();
  steer();
  yield(tree);
  for (CrowdRobot& robot : robots_) disturb(robot);
}

void CrowdWorld::conclude(const AgentTree<3>& tree) {
  for (CrowdRobot& robot : robots_)
    if (norm(robot.position - robot.looked_at) > kWallsFor) collect_walls(robot);
  measure(tree);
  ++steps_;
  for (std::size_t i = 0; i < robots_.size(); ++i) take_note(static_cast<int>(i));
}

void CrowdWorld::want(const AgentTree<3>& tree) {
  const std::size_t n = robots_.size();
  course_.assign(n, {});
  for (std::size_t i = 0; i < n; ++i) course_[i] = course(robots_[i]);
  wanted_ = course_;
  if (settings_.avoidance == Avoidance::none) return;
  const double almost = settings_.avoidance == Avoidance::orca ? 1.0 : kAlmost;
  const Manners manners(robots_, walls_, tree, time(), settings_.dt, settings_.space, almost);
  for (int i = 0; i < static_cast<int>(n); ++i) {
    if (robots_[i].is_away(time())) wanted_[i] = course_[i] = manners.course_without_order(i);
    if (robots_[i].in_traffic)
      wanted_[i] = course_[i] = along_walls(robots_[i], course_[i], settings_.dt);
    else if (course_[i] != Vec<3>{} && robots_[i].body.radius > 0.0)
      wanted_[i] = manners.wanted(i, course_[i]);
  }
}

// The velocity that a robot would have, were it alone.
Vec<3> CrowdWorld::course(CrowdRobot& robot) const {
  robot.reference.followed = false;
  if (robot.phase != Phase::going) return {};
  Vec<3> velocity;
  if (!tracks(robot, settings_.dt, velocity)) return along_course(robot, settings_.tolerances, settings_.dt);
  return velocity;
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
    choices_[i] = {steering.braked,   steering.wanted,          steering.straight,       steering.after,
                   steering.chord,    robot.body.radius,        robot.body.acceleration, robot.stands(time()),
                   &robot.near_faces, &walls_[robot.body.walls]};
  }
}

void CrowdWorld::yield(const AgentTree<3>& tree) {
  RightOfWay right(before_, choices_, tree, settings_.dt, settings_.clearance);
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    CrowdRobot& robot = robots_[i];
    const Steering& steering = steerings_[i];
    const double share = settings_.avoidance == Avoidance::none ? 1.0 : right.share(static_cast<int>(i));
    if (share < 0.0) {
      robot.commanded = steering.straight;
      robot.ahead = steering.ahead_braked;
      robot.yaw_rate = 0.0;
    } else {
      robot.commanded = choices_[i].at(share);
      robot.ahead = steering.ahead_braked + share * (steering.ahead_wanted - steering.ahead_braked);
      robot.yaw_rate = steering.yaw_rate;
    }
    robot.braked = share < 1.0 - kDeviation;
    const bool left_course = robot.braked || norm(chosen_[i] - course_[i]) > kDeviation * robot.top_speed();
    robot.turned_aside = left_course && !robot.in_traffic;
  }
}

// A robot never gets more than it drives by, so that noise cannot bring it into contact.
void CrowdWorld::disturb(CrowdRobot& robot) const {
  const CrowdNoise& noise = settings_.noise;
  robot.velocity = robot.commanded;
  robot.counts = 1.0;
  if (noise.slip > 0.0 || noise.odometry > 0.0) slip_apart(robot);
  if (robot.commanded == Vec<3>{}) return;
  if (noise.velocity > 0.0)
    robot.velocity = std::max(0.0, 1.0 - std::abs(noise.velocity * normal(robot.noise))) * robot.velocity;
  if (noise.odometry > 0.0) robot.counts = std::max(0.0, 1.0 + noise.odometry * normal(robot.noise));
  if (noise.slip > 0.0) {
    const double kept = 1.0 - noise.slip * robot.noise.uniform();  // above 0
    robot.velocity = kept * robot.velocity;
    robot.counts /= kept;
  }
}

// Each wheel slips and errs by itself, so that odometry errs about the heading, too. One without wheels errs alike.
void CrowdWorld::slip_apart(CrowdRobot& robot) const {
  const CrowdNoise& noise = settings_.noise;
  double more[2];
  for (double& of_wheel : more) {
    of_wheel = 1.0 / (1.0 - noise.slip * robot.wheels.uniform()) - 1.0;
    of_wheel += noise.odometry * normal(robot.wheels);
  }
  robot.turn_counts = 1.0 + 0.5 * (more[0] + more[1]);
  robot.turns_per_metre = 0.5 * (more[1] - more[0]) / robot.half_track();
}

void CrowdWorld::move(CrowdRobot& robot) const {
  robot.position = robot.position + settings_.dt * robot.velocity;
  robot.heading = wrapped(robot.heading + settings_.dt * robot.yaw_rate);
  const double metres = norm(robot.velocity) * settings_.dt;
  count(robot, metres, metres);
}

void CrowdWorld::take_note(int i) {
  CrowdRobot& robot = robots_[i];
  if (robot.phase == Phase::idle) {
    settle(i);
    return;
  }
  if (robot.reference.followed) {
    const double error = tracking_error(robot);
    robot.errors = {robot.errors.sum + error, std::max(robot.errors.most, error), robot.errors.steps + 1};
  }
  if (robot.phase == Phase::going) {
    const Vec<3>& goal = robot.goal();
    const double nearer = (norm(goal - before_[i]) - norm(goal - robot.position)) / settings_.dt;
    robot.approach += std::min(1.0, settings_.dt / kApproach) * (nearer - robot.approach);
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
    const double turned = robot.body.law == Law::thesis ? kTurned : 0.0;
    const double off = std::isnan(point.heading) ? 0.0 : wrapped(point.heading - robot.heading);
    if (std::abs(off) > std::max(turned, settings_.tolerances.heading)) return;
    robot.phase = Phase::holding;
    robot.hold_until = time() + point.hold;
  }
  if (robot.phase == Phase::holding && time() >= robot.hold_until - 1e-6 * settings_.dt) next_way_point(i);
}

// Where a robot without an order comes to a stand is its post.
void CrowdWorld::settle(int i) {
  CrowdRobot& robot = robots_[i];
  const double away = norm(robot.post - robot.position);
  const bool no_nearer = robot.turned_aside || away >= norm(robot.post - before_[i]);
  const bool back = away <= (no_nearer ? settings_.tolerances.arrival : robot.exact);
  if (robot.is_away(time())) robot.patience.note(robot, settings_.dt);
  if ((back && robot.asked_until < time()) || robot.failed || robot.stopping) robot.post = robot.position;
  if (robot.commanded == Vec<3>{}) robot.stopping = false;
}

void CrowdWorld::next_way_point(int i) {
  CrowdRobot& robot = robots_[i];
  robot.trail = {robot.way[robot.next].at, {}, false};  // not where it cut past it: there may be a wall ahead
  const bool labelled = robot.way[robot.next].labelled, last = ++robot.next == robot.way.size();
  robot.phase = last ? Phase::idle : Phase::going;
  if (robot.reference.given())
    robot.reference.clock = std::max(robot.reference.clock, robot.reference.times[robot.next - 1]);
  if (last) robot.reference = {};
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
