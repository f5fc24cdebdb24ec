// The avoidance of a simulated crowd: who looks at whom, with which method.
#include <algorithm>

#include "crowd/avo.hpp"
#include "crowd/crowd_world.hpp"
#include "crowd/hrvo.hpp"
#include "crowd/orca.hpp"
#include "crowd/rvo.hpp"

namespace muster {

namespace {

constexpr double kBoundless = 1e9;  // metres
constexpr double kFirm = 1e18;      // the priority of those who do not give way
constexpr double kResponse = 0.5;   // of AVO: delta, seconds

template <int D>
Vec<D> in_dimensions(const Vec<3>& v) {
  Vec<D> result;
  for (int k = 0; k < D; ++k) result[k] = v[k];
  return result;
}

// So far below the ground that a ball over it may touch it with its centre.
std::vector<Box> ground_below(const WallSet& walls, double radius) {
  if (std::isinf(walls.ground)) return {};
  return {{Vec<3>{{-kBoundless, -kBoundless, -kBoundless}}, Vec<3>{{kBoundless, kBoundless, walls.ground - radius}}}};
}

// Along the walls instead of into them: what each leaves of a velocity, where avoidance does not look at walls.
Vec<3> slid(const CrowdRobot& robot, const WallSet& walls, Vec<3> velocity, double dt) {
  const Braking braking{dt, robot.body.acceleration};
  const auto leave = [&](const Vec<3>& closest) {
    const Vec<3> way = closest - robot.position;
    const double distance = norm(way);
    if (distance == 0.0) return;
    const double closing = dot(velocity, way) / distance;
    const double most = braking.speed(std::max(0.0, distance - robot.body.radius));
    if (closing > most) velocity = velocity - ((closing - most) / distance) * way;
  };
  for (const Upright& face : robot.near_faces) leave(face.closest(robot.position));
  for (const Slab& slab : walls.slabs)
    if (slab.covers(robot.position)) leave(slab.closest(robot.position));
  return velocity;
}

template <int D>
std::vector<Vec<D>> velocities(const Agents<D>& agents, const std::vector<double>& accelerations,
                               const std::vector<std::vector<Wall<D>>>& walls, const std::vector<char>& choosing,
                               const CrowdSettings& settings) {
  double radius = 0.0, speed = 0.0;
  for (int i = 0; i < agents.size(); ++i) {
    radius = std::max(radius, agents.radii[i]);
    speed = std::max(speed, agents.max_speeds[i]);
  }
  const Neighbourhood hood{settings.neighbours, 2.0 * (radius + settings.horizon * speed)};
  if constexpr (D == 2) {
    if (settings.avoidance == Avoidance::rvo)
      return rvo_velocities(agents, {}, {0.0, 6, 0.1, 1.0, true, settings.wall_horizon, hood}, settings.dt, 1);
    if (settings.avoidance == Avoidance::hrvo)
      return hrvo_velocities(agents, {}, {settings.wall_horizon, hood}, settings.dt, 1);
    if (settings.avoidance == Avoidance::avo)
      return avo_velocities(agents, accelerations, {}, {settings.horizon, settings.wall_horizon, kResponse, hood},
                            settings.dt, 1);
  }
  return orca_velocities<D>(agents, walls, choosing, {settings.horizon, settings.wall_horizon, hood, true},
                            settings.dt);
}

}  // namespace

// In a mission in space those on the ground avoid each other in the plane; those that fly avoid all, who do not look
// up.
void CrowdWorld::avoid() {
  std::vector<int> plane, space;
  for (int i = 0; i < static_cast<int>(robots_.size()); ++i) {
    if (robots_[i].body.radius == 0.0) continue;
    if (!settings_.space || !robots_[i].body.flies) plane.push_back(i);
    if (settings_.space) space.push_back(i);
  }
  avoid_among<2>(plane);
  avoid_among<3>(space);
}

template <int D>
void CrowdWorld::avoid_among(const std::vector<int>& group) {
  Agents<D> agents;
  std::vector<std::vector<Wall<D>>> walls(group.size());
  std::vector<char> choosing;
  std::vector<double> accelerations;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const CrowdRobot& robot = robots_[group[k]];
    const Body& body = robot.body;
    const bool chooses = robot.gives_way(time()) && (D == 2 || body.flies);
    choosing.push_back(chooses);
    agents.positions.push_back(in_dimensions<D>(robot.position));
    agents.velocities.push_back(in_dimensions<D>(robot.velocity));
    agents.preferred.push_back(in_dimensions<D>(wanted_[group[k]]));
    agents.radii.push_back(body.radius * (body.faces_its_way ? 1.0 + settings_.margin : 1.0));
    const double most = robot.top_speed_here();
    agents.max_speeds.push_back(D == 3 ? std::hypot(most, robot.slowed * body.climb) : most);
    accelerations.push_back(body.acceleration);
    agents.priorities.push_back(chooses ? body.priority : kFirm);
    if constexpr (D == 2)
      walls[k] = robot.near_walls;
    else
      walls[k] = ground_below(walls_[body.walls], body.radius);
  }
  if (std::find(choosing.begin(), choosing.end(), 1) == choosing.end()) return;
  const std::vector<Vec<D>> found = velocities<D>(agents, accelerations, walls, choosing, settings_);
  for (std::size_t k = 0; k < group.size(); ++k) {
    if (!choosing[k]) continue;
    const CrowdRobot& robot = robots_[group[k]];
    const bool orca = settings_.avoidance == Avoidance::orca;
    Vec<3>& chosen = chosen_[group[k]];
    if (orca || !robot.arrives) {  // the others would rather stand than get near to those behind a way point
      if constexpr (D == 2) {      // uphill in proportion
        const double wanted = std::hypot(chosen[0], chosen[1]);
        if (wanted > 0.0) chosen[2] *= std::min(1.0, norm(found[k]) / wanted);
      }
      for (int axis = 0; axis < D; ++axis) chosen[axis] = found[k][axis];
    }
    if (D == 3 || !orca) chosen = slid(robot, walls_[robot.body.walls], chosen, settings_.dt);
  }
}

template void CrowdWorld::avoid_among<2>(const std::vector<int>&);
template void CrowdWorld::avoid_among<3>(const std::vector<int>&);

}  // namespace muster
