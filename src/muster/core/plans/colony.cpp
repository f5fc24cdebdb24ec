#include "plans/colony.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace muster {

Colony::Colony(const Problem& problem, double beta, std::uint64_t seed)
    : problem_(problem),
      random_(seed),
      routes_(problem),
      balanced_(problem.objective() != Objective::total),
      idle_(problem.robots()),
      sums_(problem.robots()) {
  const int n = problem.tasks();
  const double least = floor_of_distances();
  const auto desirability = [&](double distance) {
    return std::isfinite(distance) ? std::pow(std::max(distance, least) / least, -beta) : 0.0;
  };
  for (int c = 0; c < problem.classes(); ++c) {
    for (int from = 0; from < n; ++from) {
      for (int to = 0; to < n; ++to) desirability_.push_back(desirability(problem.distance(c, from, to)));
    }
  }
  for (int robot = 0; robot < problem.robots(); ++robot) {
    const int c = problem.travel_class(robot);
    for (int to = 0; to < n; ++to) desirability_.push_back(desirability(problem.distance(c, problem.start(robot), to)));
  }
}

// A thousandth of the mean way from a start to a task: places that coincide attract by this distance.
double Colony::floor_of_distances() const {
  double sum = 0.0;
  int ways = 0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    for (int task = 0; task < problem_.tasks(); ++task) {
      const double way = problem_.distance(problem_.travel_class(robot), problem_.start(robot), task);
      if (!std::isfinite(way)) continue;
      sum += way;
      ++ways;
    }
  }
  return sum > 0.0 ? 1e-3 * sum / ways : 1.0;
}

void Colony::build(std::span<const double> trail, Draft& draft) {
  trail_ = trail;
  routes_.clear();
  open_.clear();
  std::ranges::fill(sums_, 0.0);
  for (int task = 0; task < problem_.tasks(); ++task) {
    if (routes_.ready(task)) open(task);
  }
  for (int robot = next_robot(); robot != Draft::kNobody; robot = next_robot()) {
    const std::size_t k = choose(robot);
    if (k == open_.size()) {
      idle_[robot] = 1;
    } else {
      take(robot, k);
    }
  }
  routes_.put_into(draft);
}

void Colony::open(int task) {
  open_.push_back(task);
  std::ranges::fill(idle_, 0);
  if (balanced_) return;
  for (int robot = 0; robot < problem_.robots(); ++robot) sums_[robot] += attraction(robot, task);
}

void Colony::take(int robot, std::size_t k) {
  const int task = open_[k];
  open_[k] = open_.back();
  open_.pop_back();
  if (!balanced_) {
    for (int other = 0; other < problem_.robots(); ++other) sums_[other] -= attraction(other, task);
  }
  routes_.append(robot, task);
  if (!balanced_) sums_[robot] = sum_of(robot);
  for (const int dependant : problem_.dependants(task)) {
    if (routes_.ready(dependant)) open(dependant);
  }
}

int Colony::next_robot() {
  if (open_.empty()) return Draft::kNobody;
  int chosen = Draft::kNobody, some = Draft::kNobody;
  double sum = 0.0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (idle_[robot]) continue;
    if (balanced_) {
      if (chosen == Draft::kNobody || routes_.usage(robot) < routes_.usage(chosen)) chosen = robot;
      continue;
    }
    const double weight = std::max(0.0, sums_[robot]);
    some = robot;
    sum += weight;
    if (random_.uniform() * sum < weight) chosen = robot;
  }
  return chosen == Draft::kNobody ? some : chosen;
}

std::size_t Colony::choose(int robot) {
  weights_.resize(open_.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < open_.size(); ++k) {
    const bool can = routes_.can_append(robot, open_[k]);
    weights_[k] = can ? std::max(attraction(robot, open_[k]), std::numeric_limits<double>::min()) : 0.0;
    sum += weights_[k];
  }
  double left = random_.uniform() * sum;
  std::size_t chosen = open_.size();
  for (std::size_t k = 0; k < open_.size() && left >= 0.0; ++k) {
    if (weights_[k] == 0.0) continue;
    chosen = k;
    left -= weights_[k];
  }
  return chosen;
}

double Colony::attraction(int robot, int task) const {
  if (!problem_.allowed(robot, task)) return 0.0;
  const std::size_t n = problem_.tasks(), from = routes_.place(robot);
  const std::size_t row = from < n ? problem_.travel_class(robot) * n + from : problem_.classes() * n + robot;
  return trail_[from * n + task] * desirability_[row * n + task];
}

double Colony::sum_of(int robot) const {
  double sum = 0.0;
  for (const int task : open_) sum += attraction(robot, task);
  return sum;
}

}  // namespace muster
