// What robots do so that they do not hold each other up for ever; avoidance alone would let them.
//
// - Where another stands on a robot's way point, at work or broken down, the robot waits beside it until it goes. One
//   that has nothing to do, or waits itself, is asked to make room; it comes back when nobody claims its place any
//   more.
// - A robot that another turns aside keeps a little to the right, so that two who meet choose different sides.
// - One that has not come nearer to its way point for a while tries other directions, at random and by turns with the
//   straight way, and asks those to make room who can.
// - One that nobody but a wall keeps from its way point was driven off its way: it goes back as it came.
#pragma once

#include <vector>

#include "crowd/crowd_robot.hpp"
#include "crowd/making_room.hpp"
#include "traffic/agent_tree.hpp"

namespace muster {

class Manners {
 public:
  Manners(std::vector<CrowdRobot>& robots, const std::vector<WallSet>& walls, const AgentTree<3>& tree, double time,
          double dt, bool space, double almost);

  // The velocity with which robot i, which is away from its post or asked to leave it, would go if it were alone.
  Vec<3> course_without_order(int i) const;
  // What robot i wants in place of the velocity along its course.
  Vec<3> wanted(int i, const Vec<3>& course) const;

 private:
  void ask(int k, int asker) const;
  Vec<3> course_aside(CrowdRobot& robot) const;
  void come_back(int i) const;
  void meet(int i, const Vec<3>& course, const std::vector<int>& near) const;
  Vec<3> wanted_under_way(int i, const Vec<3>& course, const std::vector<int>& near) const;
  Vec<3> wanted_back(CrowdRobot& robot, const Vec<3>& course) const;
  Vec<3> wanted_aside(int i, const Vec<3>& course, const std::vector<int>& near) const;
  bool is_before(int i, int k) const;
  bool is_on(int k, const Vec<3>& place, double radius) const;

  std::vector<CrowdRobot>& robots_;
  const AgentTree<3>& tree_;
  double time_, dt_;
  double almost_;  // radii from its way point within which a robot is almost there
  double largest_radius_;
  MakingRoom room_;
};

}  // namespace muster
