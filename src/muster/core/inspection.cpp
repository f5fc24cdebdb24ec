#include "inspection.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "operators.hpp"

namespace muster {

Inspection::Inspection(const Problem& problem, const Routes& routes)
    : problem_(problem),
      evaluator_(problem),
      draft_(draft_from(problem, routes)),
      admissible_(evaluator_.evaluate(draft_)),
      makespan_(evaluator_.makespan(draft_)) {}

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
    Draft trial = draft_;
    trial.insert(task, robot, at);
    const double usage = problem_.walk(robot, trial.route(robot)).usage;
    if (std::isfinite(usage)) places.push_back({at, usage});
  }
  std::ranges::stable_sort(places, {}, &Insertion::usage);
  for (const Insertion& place : places) {
    Draft trial = draft_;
    trial.insert(task, robot, place.at);
    if (!problem_.has_prerequisites() || evaluator_.order(trial)) return place;
  }
  return std::nullopt;
}

}  // namespace muster
