// Robots with headings that carry out tasks without end, by the rules of the League of Robot Runners of 2024.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "traffic/errand_assignment.hpp"
#include "traffic/heading_distances.hpp"
#include "traffic/turning_grid.hpp"
#include "traffic/turning_moves.hpp"

namespace muster {

// Limits of one step, in numbers that are the same on every machine.
struct LifelongLimits {
  std::int64_t checks = 1'000'000;       // of operations, in samples of moves
  std::int64_t states = 10'000'000;      // in new tables of distances
  std::int64_t pairs = 20'000'000;       // of robots and tasks that are compared
  std::int64_t optimal_pairs = 600'000;  // up to which the cheapest assignment is found
  std::size_t table_bytes = std::size_t{1} << 30;
  int threads = 2;
};

// Tasks are lists of vertices that one robot visits in order, revealed in the order of a list that starts again at its
// end: so many are known at a time. A robot may leave its task for another until it has visited the first vertex.
class LifelongErrands {
 public:
  struct Task {
    int revealed;     // the step
    int visited = 0;  // vertices
    int robot = -1;
  };
  struct Event {
    int step, robot, task, visited;
  };
  struct Assigned {
    int step, robot, task;  // task -1: none any more
  };

  // Robots head east at first. Throws std::invalid_argument where a task is empty, or two robots start in one cell.
  LifelongErrands(TurningGrid grid, const std::vector<int>& starts, std::vector<std::vector<int>> errands,
                  int most_revealed, LifelongLimits limits, std::uint64_t seed);

  void advance();
  int step() const { return step_; }
  int finished() const { return finished_; }
  // Of the tasks that are revealed: those that no robot can finish, since no way leads to all their vertices.
  int impossible() const;
  int robots() const { return moves_.robots(); }
  const std::string& actions(int robot) const { return actions_[robot]; }
  // Steps in which a robot had a task.
  int busy_steps(int robot) const { return busy_steps_[robot]; }
  const std::vector<Event>& events() const { return events_; }
  const std::vector<Assigned>& assignments() const { return assignments_; }
  const std::vector<Task>& tasks() const { return tasks_; }  // all that were revealed

 private:
  const std::vector<int>& errands(int task) const { return errands_[task % errands_.size()]; }
  int visited(int robot) const { return tasks_[task_of_[robot]].visited; }
  int goal_of(int robot) const;
  int cost_to_goal(int robot) const;
  void reveal();
  void require_tables();
  void assign();
  void assign_cheapest(std::span<const int> robots, std::span<const int> tasks);
  void assign_in_turn(std::span<const int> robots, std::span<const int> tasks);
  std::vector<int> costs_within(std::span<const int> tasks) const;
  int assignment_cost(int robot, int task, int cost_within) const;
  void give(int robot, int task);
  void begin_goal(int robot);
  std::vector<int> order() const;
  std::vector<Aim> aims(std::span<const int> order) const;
  void visit();

  TurningGrid grid_;
  std::vector<std::vector<int>> errands_;
  std::size_t most_revealed_;
  LifelongLimits limits_;
  HeadingDistances distances_;
  TurningMoves moves_;
  std::uint64_t seed_;
  int step_ = 0, finished_ = 0;
  std::vector<Task> tasks_;
  std::vector<int> open_;               // tasks that are not finished
  std::vector<int> task_of_;            // by robot, -1 without one
  std::vector<int> since_, cost_then_;  // by robot: the step in which it got its goal, and the cost to it
  std::vector<int> busy_steps_;
  std::vector<std::string> actions_;
  std::vector<Event> events_;
  std::vector<Assigned> assignments_;
};

}  // namespace muster
