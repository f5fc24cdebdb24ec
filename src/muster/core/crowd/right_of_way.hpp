// What keeps simulated robots from touching, whatever method of avoidance they use and however slowly they brake.
//
// At any time all robots could brake as hard as they can, and none would touch another or a wall. A step is made so
// that this holds after it as well: of the gap between two robots that is left once both have braked, each may use
// half. A robot that would use more takes the part of its step that does not; the last resort is to brake.
#pragma once

#include <vector>

#include "crowd/upright.hpp"
#include "traffic/agent_tree.hpp"

namespace muster {

// The velocities that a robot may have in a step: from `braked`, as little as it can, to `wanted`.
struct Choice {
  Vec<3> braked, wanted;
  Vec<3> straight;  // braked too, and without turning: what is always left
  Vec<3> after;     // the direction in which it brakes after the step; 0: in that of the step
  double chord;     // of the way of the step, which may be an arc, its share that leads on
  double radius;    // 0: it is not looked at
  double acceleration;
  bool stands;
  const std::vector<Upright>* faces;  // near ones
  const WallSet* walls;

  Vec<3> at(double share) const { return braked + share * (wanted - braked); }
};

// For each robot the greatest share that it may have, 1 where nothing is in its way; below 0 where it may not even
// turn.
class RightOfWay {
 public:
  // `clearance`: metres that robots keep between them.
  RightOfWay(const std::vector<Vec<3>>& positions, const std::vector<Choice>& choices, const AgentTree<3>& tree,
             double dt, double clearance);

  double share(int i);

 private:
  // Someone or something in a direction, and how far the robot may go that way until it stands.
  struct Limit {
    Vec<3> towards;
    double most;
    double rounding;  // by which it may be more
  };
  void look_at_robots(int i);
  void look_at_walls(int i);
  bool allowed(int i, double share) const;
  double stopping(int i, const Vec<3>& velocity, const Vec<3>& after, const Vec<3>& towards) const;

  const std::vector<Vec<3>>& positions_;
  const std::vector<Choice>& choices_;
  const AgentTree<3>& tree_;
  double dt_, clearance_;
  double largest_radius_ = 0.0, longest_stop_ = 0.0;
  std::vector<Limit> limits_;
  std::vector<int> found_;
};

}  // namespace muster
