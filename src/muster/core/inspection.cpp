#include "inspection.hpp"

#include <algorithm>
#include <stdexcept>

#include "operators.hpp"

namespace muster {

Inspection::Inspection(const Problem& problem, const Routes& routes)
    : problem_(problem),
      evaluator_(problem),
      draft_(draft_from(problem, routes)),
      admissible_(evaluator_.evaluate(draft_)),
      makespan_(evaluator_.makespan(draft_)) {
  if (makespan_) objective_ = evaluator_.objective(draft_);
}

std::vector<double> Inspection::usages() const {
  std::vector<double> usages;
  for (int robot = 0; robot < problem_.robots(); ++robot) usages.push_back(draft_.figures(robot).usage);
  return usages;
}

std::optional<Insertion> Inspection::cheapest_insertion(int robot, int task) {
  if (robot < 0 || robot >= problem_.robots() || task < 0 || task >= problem_.tasks()) {
    throw std::invalid_argument("no such robot or task");
  }
  if (draft_.robot_of(task) != Draft::kNobody) throw std::invalid_argument("the task is in the plan already");
  std::vector<Insertion> places;
  const Window allowed = window(problem_, draft_.route(robot), task);
  for (int at = allowed.earliest; at <= allowed.latest; ++at) {
    places.push_back({at, draft_.figures(robot).usage + problem_.growth(robot, draft_.route(robot), task, at)});
  }
  std::ranges::stable_sort(places, {}, &Insertion::usage);
  for (const Insertion& place : places) {
    if (!problem_.has_prerequisites()) return place;
    draft_.insert(task, robot, place.at);
    const bool ordered = evaluator_.order(draft_);
    draft_.remove(robot, place.at);
    if (ordered) return place;
  }
  return std::nullopt;
}

}  // namespace muster
