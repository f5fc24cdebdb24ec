// RRT*: a tree of random points that keeps shortening itself.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "paths/air.hpp"
#include "random.hpp"

namespace muster {

// Where the tree grows: a box, and what is free in it. In the plane all heights are 0.
struct Room {
  int dimensions = 2;
  Spot low, high;
  std::function<bool(Spot)> free;
  std::function<bool(Spot, Spot)> sees;
};

struct TreeSettings {
  double step;        // metres: the longest new branch
  double goal_share;  // of samples that are the goal itself
  double reach;       // times the least radius of rewiring that converges
};

// [karaman2011], algorithm 6.
class Tree {
 public:
  Tree(Room room, Spot start, Spot goal, std::uint64_t seed, TreeSettings settings);

  void grow(int samples);
  // The shortest way found so far, with its ends; empty if there is none.
  std::vector<Spot> way() const;

 private:
  struct Node {
    Spot at;
    int parent;
    double length;  // of the way from the start
    std::vector<int> children;
    int less = -1, more = -1;  // in the k-d tree
  };

  Spot sample();
  Spot steer(Spot from, Spot towards) const;
  void extend(Spot towards);
  int add(Spot at, int parent, double length);
  void rewire(int node, const std::vector<int>& near);
  void pass_on(int node, double gain);
  int nearest(Spot p) const;
  std::vector<int> within(Spot p, double radius) const;
  double radius() const;

  Room room_;
  Spot goal_;
  Random random_;
  TreeSettings settings_;
  std::vector<Node> nodes_;
  std::vector<int> at_goal_;  // nodes that see the goal within a step
};

}  // namespace muster
