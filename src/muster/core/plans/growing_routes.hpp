// Routes that grow at their ends, task after task, and keep every rule at every moment.
#pragma once

#include <vector>

#include "plans/draft.hpp"
#include "plans/problem.hpp"

namespace muster {

class GrowingRoutes {
 public:
  explicit GrowingRoutes(const Problem& problem);

  void clear();
  // Whether the task is in no route yet and all its prerequisites are.
  bool ready(int task) const { return waiting_[task] == 0 && !taken_[task]; }
  bool taken(int task) const { return taken_[task] != 0; }
  // Whether the robot may do the task next and has the capacity for it and for the way to its end.
  bool can_append(int robot, int task) const;
  // Puts a ready task at the end of the robot's route.
  void append(int robot, int task);
  // The robot for which `append` is cheapest: by its usage then, or with the objective `total` by what is added to it;
  // Draft::kNobody if no robot can take the task.
  int cheapest(int task) const;

  double usage(int robot) const { return usage_[robot]; }
  int place(int robot) const { return place_[robot]; }
  void put_into(Draft& draft) const { draft.assign(tasks_, robots_); }

 private:
  const Problem& problem_;
  std::vector<int> waiting_;  // prerequisites in no route
  std::vector<char> taken_;
  std::vector<int> place_;
  std::vector<double> usage_;  // without the way to the end
  std::vector<int> tasks_, robots_;
};

}  // namespace muster
