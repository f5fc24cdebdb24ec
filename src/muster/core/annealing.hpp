// Simulated annealing of the order of tasks in single routes (market paper, section 3.1: "optimize").
#pragma once

#include <vector>

#include "draft.hpp"
#include "random.hpp"
#include "routes.hpp"

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
  void vary(std::vector<int>& route);
  bool ordered(int robot, const std::vector<int>& route);
  double cost(int robot, const std::vector<int>& route);

  const Problem& problem_;
  Random random_;
  Evaluator evaluator_;
  Draft draft_;
};

}  // namespace muster
