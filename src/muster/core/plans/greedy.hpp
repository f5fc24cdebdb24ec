// The state and steps of greedy task allocation ([tcf-thesis], Algorithm 1).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "plans/draft.hpp"
#include "plans/problem.hpp"

namespace muster {

// One robot, one task, and the cost c_ij of the robot going there and doing it.
struct Matching {
  int robot;
  int task;
  double cost;
};

// Tasks that nothing depends on have the dependency coefficient 1, so their debit for a robot changes only when that
// robot moves: each robot keeps its best one. The debit of a task with dependants changes at every step, because its
// coefficient does: each robot keeps those that cost it least, and looks at the others only where one of them could
// have a lower debit by its coefficient.
class Greedy {
 public:
  // `balanced`: a matching is chosen by c_ij + u_i (3.17), else by c_ij alone (3.27).
  Greedy(const Problem& problem, bool balanced);

  // Steps 2 to 5: the locally optimal admissible matching; none if no robot can do any of the tasks left.
  std::optional<Matching> select();
  // Steps 6 to 8: append the task to the robot's route and go there. A start plan may append in any order.
  void assign(int robot, int task);

  const std::vector<std::vector<int>>& routes() const { return routes_; }

 private:
  struct Preference {
    double debit = std::numeric_limits<double>::infinity();
    double cost = 0.0;
    int task = Draft::kNobody;

    bool after(double other_debit, int other_task) const {
      return other_debit < debit || (other_debit == debit && other_task < task);
    }
  };
  // Distances from a task with dependants, for one travel class: their mean to its dependants, and the sum and number
  // of those to the other tasks left. Tasks to which there is no way are left out of both.
  struct Surroundings {
    double to_dependants = 0.0;
    double sum_to_others = 0.0;
    double sum_at_first = 0.0;
    int others = 0;
  };

  // Tasks with dependants that a robot can do next, all those that cost it less than `beyond`; others cost no less.
  struct Nearby {
    bool known = false;
    double beyond = 0.0;
    std::vector<int> tasks;
  };

  void make_ready(int task);
  void drop(std::vector<int>& tasks, int task);
  void survey(int task);
  Preference plain_preference(int robot) const;
  void weigh_dependants();
  void consider_needed(int robot, Preference& best);
  void look_around(int robot);
  double cost(int robot, int task) const;
  bool admissible(int robot, int task) const;
  void consider(int robot, int task, double coefficient, Preference& best) const;
  double sum_to_others(int travel_class, int task) const;
  double dependency_coefficient(int travel_class, int task) const;

  const Problem& problem_;
  bool balanced_;
  int left_;  // N_T: tasks not yet allocated
  std::vector<char> allocated_;
  std::vector<int> waiting_;       // prerequisites not yet allocated
  std::vector<int> plain_ready_;   // ready tasks that nothing depends on
  std::vector<int> needed_ready_;  // ready tasks with dependants
  std::vector<int> needed_;        // all tasks left with dependants
  std::vector<int> place_in_list_;
  std::vector<std::vector<Surroundings>> surroundings_;  // by travel class and task
  std::vector<std::vector<double>> coefficients_;        // Kp by travel class, in the order of needed_ready_
  std::vector<double> least_coefficient_;                // of them, by travel class
  std::vector<Nearby> nearby_;                           // by robot
  std::vector<std::pair<double, int>> costs_;            // reused
  std::vector<Preference> preferred_;                    // each robot's best plain task
  std::vector<char> stale_;                              // whether it must be found anew
  std::vector<int> position_;
  std::vector<double> usage_;  // without the way to the end
  std::vector<std::vector<int>> routes_;
};

}  // namespace muster
