// Routes as they stand, and what putting one more task into them would take: for figures and explanations.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "plans/draft.hpp"
#include "plans/roster.hpp"
#include "plans/routes.hpp"

namespace muster {

struct Insertion {
  int at;
  double usage;
};

class Inspection {
 public:
  Inspection(const Problem& problem, const Routes& routes);

  const Problem& problem() const { return problem_; }
  bool admissible() const { return admissible_; }
  // Of the routes as they are, whatever the capacities; none if they deadlock.
  std::optional<double> objective() const { return objective_; }
  std::vector<double> usages() const;
  // By robot: when it arrives at each task of its route, begins and ends; none if there is no schedule.
  std::optional<std::vector<std::vector<StopTimes>>> stops();
  std::optional<double> makespan() const { return makespan_; }
  // Where the task adds least usage and nothing deadlocks; the usage is infinite where there is no way. Where tasks are
  // bound to times, teams and relations these are kept, and capacities.
  std::optional<Insertion> cheapest_insertion(int robot, int task);

 private:
  // All places that the prerequisites in the route leave, in order.
  std::vector<Insertion> insertions(int robot, int task) const;

  std::optional<Insertion> on_schedule(int robot, int task);
  void inspect_schedule(const Routes& routes);

  const Problem& problem_;
  std::unique_ptr<Roster> roster_;  // of a timed problem
  bool scheduled_ = false;          // whether there is a schedule then
  Evaluator evaluator_;
  Draft draft_;
  bool admissible_;
  std::optional<double> makespan_;
  std::optional<double> objective_;
};

}  // namespace muster
