// Priority inheritance with backtracking [okumura2022], with the swap of [okumura-star2023]: one step of all robots at
// once.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "random.hpp"
#include "traffic/directed_graph.hpp"
#include "traffic/goal_distances.hpp"

namespace muster {

using Places = std::vector<int>;  // the vertex of each robot
constexpr int kUndecided = -1;

class Pibt {
 public:
  Pibt(std::shared_ptr<GoalDistances> distances, std::uint64_t seed);

  int robots() const { return distances_->robots(); }
  // What a robot descends: the distance of a vertex from its goal.
  int distance(int robot, int vertex) const { return followed_[robot]->to_goal(robot, vertex); }
  // From now on a robot descends these distances to the same goals.
  void follow(int robot, GoalDistances& distances) { followed_[robot] = &distances; }
  int goal(int robot) const { return distances_->goal(robot); }
  const DirectedGraph& graph() const { return graph_; }

  // Decides the next vertex of each robot that is kUndecided in `to`, those first in `order` first. False where what
  // was decided before leaves no way, or where none was found.
  bool step(const Places& from, Places& to, std::span<const int> order);

 private:
  bool conflicts(const Places& from, const Places& to);
  bool decide(int robot, const Places& from, Places& to);
  void rank(int robot, int at, std::span<int> candidates);
  // The robot to swap places with, or kNobody.
  int to_swap_with(int robot, int best, const Places& from, const Places& to);
  bool swap_is_needed(int pusher, int puller, int pusher_at, int puller_at) const;
  bool swap_is_possible(int pusher_at, int puller_at) const;
  // The vertices where the one who is pulled may go on to, but for `behind`: how many, and one of them.
  std::pair<int, int> ways_on(int at, int behind) const;

  static constexpr int kNobody = -1;

  std::shared_ptr<GoalDistances> distances_;
  std::vector<GoalDistances*> followed_;  // by robot
  const DirectedGraph& graph_;            // of distances_
  Random random_;
  std::vector<int> now_, next_;  // the robot at each vertex
  int width_;                    // most candidates of a robot
  std::vector<int> candidates_;
  std::vector<double> keys_;  // by vertex
};

}  // namespace muster
