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

// The usage of a route with one more task is summed up from both ends, not from the usage as it is: of a route that has
// no way without the task that is infinite, and tells nothing.
std::vector<Insertion> Inspection::insertions(int robot, int task) const {
  const auto route = draft_.route(robot);
  const int length = static_cast<int>(route.size());
  std::vector<double> rest(length, 0.0);  // usage once task k of the route is done
  if (length) rest[length - 1] = problem_.end_usage(robot, route[length - 1]);
  for (int k = length - 1; k > 0; --k) {
    rest[k - 1] = problem_.on_to(robot, rest[k], route[k - 1], route[k]);
  }
  const Window allowed = window(problem_, route, task);
  std::vector<Insertion> places;
  double usage = 0.0;
  for (int at = 0; at <= allowed.latest; ++at) {
    const int before = at ? route[at - 1] : problem_.start(robot);
    if (at >= std::max(allowed.earliest, problem_.fixed(robot))) {
      const double then =
          at < length ? problem_.on_to(robot, rest[at], task, route[at]) : problem_.end_usage(robot, task);
      places.push_back({at, problem_.on_to(robot, usage, before, task) + then});
    }
    if (at < length) usage = problem_.on_to(robot, usage, before, route[at]);
  }
  return places;
}

std::optional<Insertion> Inspection::cheapest_insertion(int robot, int task) {
  if (robot < 0 || robot >= problem_.robots() || task < 0 || task >= problem_.tasks()) {
    throw std::invalid_argument("no such robot or task");
  }
  if (draft_.robot_of(task) != Draft::kNobody) throw std::invalid_argument("the task is in the plan already");
  std::vector<Insertion> places = insertions(robot, task);
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
