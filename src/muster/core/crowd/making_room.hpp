// Where a robot that is in the way of others goes: to the nearest place that nobody claims, by a way that is free.
//
// A robot claims where it is and the way that it is about to take. Places are looked for on a lattice around the robot,
// breadth first, so that it also finds the niche of a corridor that is around a corner.
#pragma once

#include <vector>

#include "crowd/crowd_robot.hpp"
#include "traffic/agent_tree.hpp"

namespace muster {

class MakingRoom {
 public:
  MakingRoom(const std::vector<CrowdRobot>& robots, const std::vector<WallSet>& walls, const AgentTree<3>& tree,
             double largest_radius, bool space)
      : robots_(robots), walls_(walls), tree_(tree), largest_radius_(largest_radius), space_(space) {}

  // The way of robot k out of the way of an asker; empty if it finds none. Rather to a place that nobody else claims
  // and past those who stand; else past the asker's next piece alone, through those who can be asked in turn.
  std::vector<Vec<3>> aside(int k, int asker) const;
  // The way of robot k to a place; empty if it finds none.
  std::vector<Vec<3>> way_to(int k, const Vec<3>& place) const;

  // Whether none but k is on a place, or about to come by.
  bool is_free(int k, const Vec<3>& place) const;
  // Whether robot j is so near to a place that k cannot stand there, or comes so near on its next pieces of way.
  bool claims(int j, int k, const Vec<3>& place, int pieces, double spare) const;

 private:
  const std::vector<CrowdRobot>& robots_;
  const std::vector<WallSet>& walls_;
  const AgentTree<3>& tree_;
  double largest_radius_;
  bool space_;
};

}  // namespace muster
