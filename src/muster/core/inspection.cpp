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
    const double usage = draft_.figures(robot).usage + growth(robot, task, at);
    if (std::isfinite(usage)) places.push_back({at, usage});
  }
  std::ranges::stable_sort(places, {}, &Insertion::usage);
  for (const Insertion& place : places) {
    if (!problem_.has_prerequisites()) return place;
    Draft trial = draft_;
    trial.insert(task, robot, place.at);
    if (evaluator_.order(trial)) return place;
  }
  return std::nullopt;
}

double Inspection::growth(int robot, int task, int at) const {
  const auto route = draft_.route(robot);
  const int before = at ? route[at - 1] : problem_.start(robot);
  const double there = problem_.travel_usage(robot, before, task) + problem_.work_usage(robot, task);
  if (at < static_cast<int>(route.size())) {
    return there + problem_.travel_usage(robot, task, route[at]) - problem_.travel_usage(robot, before, route[at]);
  }
  return there + problem_.end_usage(robot, task) - (route.empty() ? 0.0 : problem_.end_usage(robot, before));
}

}  // namespace muster
