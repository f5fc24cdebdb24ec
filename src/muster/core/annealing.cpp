#include "annealing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace muster {

namespace {

// The first temperature is the usual step of a route; the last, a thousandth of it, hardly lets anything worse pass.
constexpr double kCoolest = 1e-3;

}  // namespace

Annealing::Annealing(const Problem& problem, const Routes& routes, std::uint64_t seed)
    : problem_(problem), random_(seed), evaluator_(problem), draft_(draft_from(problem, routes)) {
  if (!evaluator_.evaluate(draft_)) throw std::invalid_argument("the routes are not admissible");
}

void Annealing::anneal(int robot, int steps) {
  const int length = draft_.length(robot);
  if (length < 2 || steps < 1) return;
  std::vector<int> current(draft_.route(robot).begin(), draft_.route(robot).end());
  const std::vector<int> first = current;
  std::vector<int> best = current, next;
  double current_cost = cost(robot, current), best_cost = current_cost;
  double temperature = problem_.walk(robot, current).usage / length;
  const double cooling = std::pow(kCoolest, 1.0 / steps);
  for (int step = 0; step < steps; ++step, temperature *= cooling) {
    next = current;
    vary(next);
    const double next_cost = cost(robot, next);
    if (next_cost > current_cost && random_.uniform() >= std::exp((current_cost - next_cost) / temperature)) continue;
    if (!std::isfinite(next_cost)) continue;
    std::swap(current, next);
    current_cost = next_cost;
    if (current_cost < best_cost) {
      best = current;
      best_cost = current_cost;
    }
  }
  const Value before = draft_.value();
  draft_.reorder(robot, best);
  if (!evaluator_.evaluate(draft_) || before.better_than(draft_.value())) {
    draft_.reorder(robot, first);
    evaluator_.evaluate(draft_);
  }
}

// Turns a part of the route round, or moves a part to another place.
void Annealing::vary(std::vector<int>& route) {
  const int length = static_cast<int>(route.size());
  const int a = random_.below(length), b = random_.below(length);
  const auto first = route.begin() + std::min(a, b), last = route.begin() + std::max(a, b) + 1;
  if (random_.below(2) == 0) {
    std::reverse(first, last);
  } else {
    std::rotate(first, first + 1 + random_.below(static_cast<int>(last - first)), last);
  }
}

// What the objective makes of one route; inf if the order is not admissible.
double Annealing::cost(int robot, const std::vector<int>& route) {
  const RouteFigures figures = problem_.walk(robot, route);
  if (!problem_.fits(robot, figures.usage) || !ordered(robot, route)) return std::numeric_limits<double>::infinity();
  if (problem_.objective() == Objective::average) return figures.arrivals;
  if (problem_.objective() != Objective::makespan) return figures.usage;
  draft_.reorder(robot, route);
  evaluator_.makespan(draft_);
  return evaluator_.end_of(route.back());
}

bool Annealing::ordered(int robot, const std::vector<int>& route) {
  if (!problem_.has_prerequisites()) return true;
  draft_.reorder(robot, route);
  return evaluator_.order(draft_);
}

}  // namespace muster
