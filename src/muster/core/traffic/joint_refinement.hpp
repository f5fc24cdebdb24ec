// Better paths from paths: large neighbourhood search [li2021].
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "random.hpp"
#include "traffic/directed_graph.hpp"
#include "traffic/lacam.hpp"

namespace muster {

// Takes the paths of a few robots that are in each other's way out, and plans these robots anew one after another, in
// space and time past the others; keeps what has a lower sum of costs: steps until a robot rests at its goal for good.
// No path becomes longer than the longest at first.
class JointRefinement {
 public:
  // `steps` are the vertices of all robots, step by step; the last are the goals. Throws std::invalid_argument where
  // they are no paths, or two robots are at one vertex.
  JointRefinement(std::shared_ptr<const DirectedGraph> graph, const std::vector<Configuration>& steps,
                  std::uint64_t seed);

  void advance(int neighbourhoods);
  int cost() const;
  std::vector<Configuration> solution() const;

 private:
  using Path = std::vector<int>;  // the vertex at each step, as far as it moves

  int robots() const { return static_cast<int>(paths_.size()); }
  int at(int robot, int step) const {
    const Path& path = paths_[robot];
    return path[std::min<std::size_t>(step, path.size() - 1)];
  }
  int& standing(int step, int vertex) { return standing_[static_cast<std::size_t>(step) * graph_->size() + vertex]; }
  const std::vector<int>& to_goal(int robot) {
    return tables_.to(goals_[robot], [this](int goal) { return graph_->steps_to(goal); });
  }
  void neighbourhood(std::vector<int>& chosen);
  void refine();
  void put(int robot);
  void take(int robot);
  bool replan(int robot);
  int free_from(int robot);
  void expand(int robot, int step, int vertex, std::span<const int> to_goal);

  static constexpr int kNobody = -1;
  static constexpr int kMost = 16;  // robots that are planned anew at once

  std::shared_ptr<const DirectedGraph> graph_;
  Random random_;
  int last_step_;
  std::vector<int> goals_;
  std::vector<Path> paths_;
  GoalTables<std::vector<int>> tables_;
  std::vector<int> standing_;  // the robot at each vertex at each step

  // The search of one robot: open states by the step at which the goal could be reached.
  struct State {
    int step, vertex;
  };
  std::vector<std::vector<State>> open_;
  std::vector<int> before_, found_in_;  // by step and vertex
  int search_ = 0;
};

}  // namespace muster
