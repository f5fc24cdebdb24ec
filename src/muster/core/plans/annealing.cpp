#include "plans/annealing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "infinity.hpp"

namespace muster {

namespace {

constexpr double kCoolest = 1e-3;  // the last temperature as a share of the first
constexpr int kTrials = 50;        // changes from which the first temperature is found

}  // namespace

Annealing::Annealing(const Problem& problem, const Routes& routes, std::uint64_t seed)
    : problem_(problem),
      random_(seed),
      evaluator_(problem),
      draft_(draft_from(problem, routes)),
      release_(problem.tasks(), 0.0),
      place_(problem.tasks(), 0),
      seen_(problem.tasks(), 0) {
  if (!evaluator_.evaluate(draft_)) throw std::invalid_argument("the routes are not admissible");
}

void Annealing::anneal(int robot, int steps) {
  if (draft_.length(robot) < 2 || steps < 1) return;
  look_at_others(robot);
  const Route first(draft_.route(robot).begin(), draft_.route(robot).end());
  Route current = first, best = first, next;
  double current_cost = cost(robot, current), best_cost = current_cost;
  double temperature = usual_change(robot, current);
  const double cooling = std::pow(kCoolest, 1.0 / steps);
  for (int step = 0; step < steps; ++step, temperature *= cooling) {
    next = current;
    vary(next);
    const double next_cost = cost(robot, next);
    if (!std::isfinite(next_cost)) continue;
    if (next_cost > current_cost && random_.uniform() >= std::exp((current_cost - next_cost) / temperature)) continue;
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

// What the other routes, which stay as they are, ask of this one: for each of its tasks those that come before it by
// prerequisites, through tasks of others and what these do before; and when others are done with its prerequisites.
void Annealing::look_at_others(int robot) {
  before_.clear();
  if (!problem_.has_prerequisites()) return;
  if (problem_.objective() == Objective::makespan) evaluator_.makespan(draft_);
  for (int other = 0; other < problem_.robots(); ++other) {
    const auto route = draft_.route(other);
    for (int at = 0; at < static_cast<int>(route.size()); ++at) place_[route[at]] = at;
  }
  for (const int task : draft_.route(robot)) {
    ++stamp_;
    release_[task] = 0.0;
    stack_.assign(problem_.prerequisites(task).begin(), problem_.prerequisites(task).end());
    for (const int other : stack_) {
      if (draft_.robot_of(other) != robot) release_[task] = std::max(release_[task], evaluator_.end_of(other));
    }
    while (!stack_.empty()) {
      const int earlier = stack_.back();
      stack_.pop_back();
      if (std::exchange(seen_[earlier], stamp_) == stamp_) continue;
      if (draft_.robot_of(earlier) == robot) {
        before_.emplace_back(earlier, task);
        continue;
      }
      stack_.insert(stack_.end(), problem_.prerequisites(earlier).begin(), problem_.prerequisites(earlier).end());
      if (place_[earlier] > 0) stack_.push_back(draft_.route(draft_.robot_of(earlier))[place_[earlier] - 1]);
    }
  }
}

// The first temperature: by how much changes of the route usually change its cost.
double Annealing::usual_change(int robot, const Route& route) {
  const double now = cost(robot, route);
  double sum = 0.0;
  int counted = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Route other = route;
    vary(other);
    const double then = cost(robot, other);
    if (!std::isfinite(then) || then == now) continue;
    sum += std::abs(then - now);
    ++counted;
  }
  return counted ? sum / counted : std::numeric_limits<double>::min();
}

// Turns a part of the route round, or moves a part to another place.
void Annealing::vary(Route& route) {
  const int length = static_cast<int>(route.size());
  const int a = random_.below(length), b = (a + 1 + random_.below(length - 1)) % length;
  const auto first = route.begin() + std::min(a, b), last = route.begin() + std::max(a, b) + 1;
  if (random_.below(2) == 0) {
    std::reverse(first, last);
  } else {
    std::rotate(first, first + 1 + random_.below(static_cast<int>(last - first) - 1), last);
  }
}

// What the objective makes of one route; inf if the order is not admissible.
double Annealing::cost(int robot, const Route& route) {
  if (!ordered(route)) return kNever;
  const RouteFigures figures = problem_.walk(robot, route);
  if (!problem_.fits(robot, figures.usage)) return kNever;
  if (problem_.objective() == Objective::average) return figures.arrivals;
  return problem_.objective() == Objective::makespan ? end(robot, route) : figures.usage;
}

bool Annealing::ordered(const Route& route) {
  if (before_.empty()) return true;
  for (int at = 0; at < static_cast<int>(route.size()); ++at) place_[route[at]] = at;
  return std::ranges::all_of(before_, [&](const auto& pair) { return place_[pair.first] < place_[pair.second]; });
}

// When the robot is done, if others end when they do now.
double Annealing::end(int robot, const Route& route) const {
  double time = problem_.available_from(robot);
  int place = problem_.start(robot);
  for (const int task : route) {
    time = std::max(time + problem_.travel_time(robot, place, task), release_[task]) + problem_.work_time(robot, task);
    place = task;
  }
  return time;
}

}  // namespace muster
