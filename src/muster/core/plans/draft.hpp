// A plan that is being worked on.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "plans/problem.hpp"

namespace muster {

// What drafts are compared by: first more weight of tasks done, then a lower objective.
struct Value {
  double weight = 0.0;
  double objective = 0.0;
  double tie = 0.0;  // what breaks ties of the objective, the less the better

  bool better_than(const Value& other) const {
    if (weight != other.weight) return weight > other.weight;
    return objective != other.objective ? objective < other.objective : tie < other.tie;
  }
};

// Routes in one array, robot after robot, so that a copy is a few block moves. Figures are those of the last
// evaluation.
class Draft {
 public:
  explicit Draft(const Problem& problem)
      : order_(), first_(problem.robots() + 1, 0), robot_of_(problem.tasks(), kNobody), figures_(problem.robots()) {}

  static constexpr int kNobody = -1;

  std::span<const int> route(int robot) const {
    return {order_.data() + first_[robot], static_cast<std::size_t>(length(robot))};
  }
  int length(int robot) const { return first_[robot + 1] - first_[robot]; }
  int done() const { return static_cast<int>(order_.size()); }
  int robot_of(int task) const { return robot_of_[task]; }
  const RouteFigures& figures(int robot) const { return figures_[robot]; }
  const Value& value() const { return value_; }

  void clear();
  void insert(int task, int robot, int at);
  void remove(int robot, int at);
  void swap(int robot, int at, int with);
  // The same tasks in another order.
  void reorder(int robot, std::span<const int> route);
  // Sets the figures of one route.
  void measure(const Problem& problem, int robot) { figures_[robot] = problem.walk(robot, route(robot)); }
  // All routes at once: tasks[k] goes to robots[k], in the order given.
  void assign(std::span<const int> tasks, std::span<const int> robots);

 private:
  friend class Evaluator;

  std::vector<int> order_;
  std::vector<int> first_;
  std::vector<int> robot_of_;
  std::vector<RouteFigures> figures_;
  Value value_;
};

// Evaluates drafts. Holds the room that it needs for it, so that nothing is allocated in an algorithm's loop.
class Evaluator {
 public:
  explicit Evaluator(const Problem& problem)
      : problem_(problem),
        waiting_(problem.tasks()),
        before_(problem.tasks()),
        after_(problem.tasks()),
        ends_(problem.tasks()) {
    sequence_.reserve(problem.tasks());
  }

  // Both set the draft's figures and value, and tell whether it is admissible; `changed` names the routes that differ
  // from the last evaluation.
  bool evaluate(Draft& draft);
  bool evaluate(Draft& draft, std::span<const int> changed);

  // Puts the tasks in an order in which they can be done; false if routes and prerequisites deadlock. A prerequisite
  // that is left out is not waited for: that it makes the draft inadmissible is for `evaluate` to say.
  bool order(const Draft& draft);
  // The time at which the last task ends, waiting included; none if routes and prerequisites deadlock.
  std::optional<double> makespan(const Draft& draft);
  // When each task ends, in the last schedule that `makespan` made.
  double end_of(int task) const { return ends_[task]; }
  // The tasks in the order that `order` found last.
  std::span<const int> sequence() const { return sequence_; }
  // The problem's objective of a draft whose figures are those of its routes and that does not deadlock.
  double objective(const Draft& draft);

 private:
  bool conclude(Draft& draft);
  bool prerequisites_done(const Draft& draft) const;

  const Problem& problem_;
  std::vector<int> waiting_;   // what a task still waits for: prerequisites, and the task before it in its route
  std::vector<int> before_;    // the place before it in its route
  std::vector<int> after_;     // the task after it in its route
  std::vector<int> sequence_;  // the order found
  std::vector<double> ends_;
};

}  // namespace muster
