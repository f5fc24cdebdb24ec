#include "plans/inspection.hpp"

#include <algorithm>
#include <stdexcept>

#include "plans/operators.hpp"

namespace muster {

namespace {

// A robot comes to a task at most once, and a task stands in one route unless a team does it.
const Routes& checked(const Problem& problem, const Routes& routes) {
  if (static_cast<int>(routes.size()) != problem.robots())
    throw std::invalid_argument("routes need one for each robot");
  for (const auto& route : routes) {
    std::vector<char> seen(problem.tasks(), 0);
    for (const int task : route) {
      if (task < 0 || task >= problem.tasks()) throw std::invalid_argument("no such task");
      if (seen[task]++) throw std::invalid_argument("a task stands twice");
    }
  }
  return routes;
}

}  // namespace

Inspection::Inspection(const Problem& problem, const Routes& routes)
    : problem_(problem), evaluator_(problem), draft_(problem), admissible_(false) {
  if (problem.is_timed()) {
    inspect_schedule(routes);
    return;
  }
  draft_ = draft_from(problem, routes);
  admissible_ = evaluator_.evaluate(draft_);
  makespan_ = evaluator_.makespan(draft_);
  if (makespan_) objective_ = evaluator_.objective(draft_);
}

void Inspection::inspect_schedule(const Routes& routes) {
  roster_ = std::make_unique<Roster>(problem_);
  scheduled_ = roster_->begin(checked(problem_, routes));
  admissible_ = scheduled_ && roster_->keeps_rules();
  if (!scheduled_) return;
  makespan_ = roster_->timeline().end();
  objective_ = roster_->value().objective;
  for (std::size_t robot = 0; robot < routes.size(); ++robot) {
    admissible_ = admissible_ && problem_.fits(static_cast<int>(robot), roster_->usage(static_cast<int>(robot)));
  }
}

std::optional<std::vector<std::vector<StopTimes>>> Inspection::stops() {
  if (!roster_) {
    roster_ = std::make_unique<Roster>(problem_);
    scheduled_ = roster_->begin(routes_of(problem_, draft_));
  }
  return scheduled_ ? std::optional(roster_->stops()) : std::nullopt;
}

std::vector<double> Inspection::usages() const {
  std::vector<double> usages;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    usages.push_back(problem_.is_timed() ? roster_->usage(robot) : draft_.figures(robot).usage);
  }
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
  const Stretch allowed = stretch(problem_, route, task);
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
  if (problem_.is_timed()) return on_schedule(robot, task);
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

std::optional<Insertion> Inspection::on_schedule(int robot, int task) {
  const int unit = problem_.unit(task);
  if (roster_->present(unit)) throw std::invalid_argument("the task is in the plan already");
  if (!scheduled_ || !roster_->ready(unit)) return std::nullopt;
  std::vector<char> robots(problem_.robots(), 0);
  robots[robot] = 1;
  Trial trial;
  trial.robots = &robots;
  const UnitInsertion* best = roster_->best_insertion(unit, trial);
  if (!best) return std::nullopt;
  return Insertion{best->members.front().at, roster_->usage(robot) + best->growth};
}

}  // namespace muster
