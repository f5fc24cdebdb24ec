// Ants that build plans by pheromone and distance ([tcf-thesis], (2.24); Ant System, [dorigo1996]).
#pragma once

#include <span>
#include <vector>

#include "plans/draft.hpp"
#include "plans/growing_routes.hpp"
#include "random.hpp"

namespace muster {

// One ant a robot: from where it is, an ant chooses its next task by (2.24). The next ant to move is that of the robot
// with least usage; with the objective `total`, one drawn by how strongly it is attracted in all.
class Colony {
 public:
  // `beta`: how much distance counts.
  Colony(const Problem& problem, double beta, std::uint64_t seed);

  // One plan. `trail` is tau^alpha, (tasks + robots) x tasks: from each task, and from each robot's start, to each
  // task.
  void build(std::span<const double> trail, Draft& draft);

 private:
  double attraction(int robot, int task) const;
  double floor_of_distances() const;
  void open(int task);
  void take(int robot, std::size_t k);
  int next_robot();
  // Where in `open_` the chosen task stands; its size if there is none that the robot can do.
  std::size_t choose(int robot);
  double sum_of(int robot) const;

  const Problem& problem_;
  Random random_;
  GrowingRoutes routes_;
  bool balanced_;
  std::span<const double> trail_;
  std::vector<double> desirability_;  // d^-beta: classes x tasks x tasks, then robots x tasks
  std::vector<int> open_;             // tasks that are ready
  std::vector<char> idle_;            // robots that can do none of them
  std::vector<double> sums_;          // by robot: attraction of the open tasks in all
  std::vector<double> weights_;
};

}  // namespace muster
