// Routes as they stand, and what putting one more task into them would take: for figures and explanations.
#pragma once

#include <optional>
#include <vector>

#include "draft.hpp"
#include "routes.hpp"

namespace muster {

struct Insertion {
  int at;
  double usage;
};

class Inspection {
 public:
  Inspection(const Problem& problem, const Routes& routes);

  bool admissible() const { return admissible_; }
  // Of the routes as they are, whatever the capacities; none if they deadlock.
  std::optional<double> objective() const { return objective_; }
  std::vector<double> usages() const;
  std::optional<double> makespan() const { return makespan_; }
  // Where the task adds least usage and nothing deadlocks; the usage is infinite where there is no way.
  std::optional<Insertion> cheapest_insertion(int robot, int task);

 private:
  // All places that the prerequisites in the route leave, in order.
  std::vector<Insertion> insertions(int robot, int task) const;

  const Problem& problem_;
  Evaluator evaluator_;
  Draft draft_;
  bool admissible_;
  std::optional<double> makespan_;
  std::optional<double> objective_;
};

}  // namespace muster
