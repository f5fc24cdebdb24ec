// Simulated annealing of the order of tasks in single routes ([market-paper], section 3.1: "optimize").
#pragma once

#include <utility>
#include <vector>

#include "plans/draft.hpp"
#include "plans/routes.hpp"
#include "random.hpp"

namespace muster {

class Annealing {
 public:
  // The routes must be admissible.
  Annealing(const Problem& problem, const Routes& routes, std::uint64_t seed);

  // So many steps on one robot's route, the others as they are. The best order found stays, unless the plan would be
  // worse for it.
  void anneal(int robot, int steps);
  const Draft& draft() const { return draft_; }

 private:
  using Route = std::vector<int>;

  void look_at_others(int robot);
  double usual_change(int robot, const Route& route);
  void vary(Route& route);
  bool ordered(const Route& route);
  double cost(int robot, const Route& route);
  double end(int robot, const Route& route) const;

  const Problem& problem_;
  Random random_;
  Evaluator evaluator_;
  Draft draft_;
  std::vector<std::pair<int, int>> before_;  // tasks of the route that must come one before the other
  std::vector<double> release_;              // by task: when its prerequisites in other routes end
  std::vector<int> place_, seen_, stack_;
  int stamp_ = 0;
};

}  // namespace muster
