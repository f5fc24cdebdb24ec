#include "plans/draft.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace muster {

void Draft::clear() {
  order_.clear();
  std::ranges::fill(first_, 0);
  std::ranges::fill(robot_of_, kNobody);
}

void Draft::insert(int task, int robot, int at) {
  order_.insert(order_.begin() + first_[robot] + at, task);
  for (std::size_t i = robot + 1; i < first_.size(); ++i) ++first_[i];
  robot_of_[task] = robot;
}

void Draft::remove(int robot, int at) {
  const auto place = order_.begin() + first_[robot] + at;
  robot_of_[*place] = kNobody;
  order_.erase(place);
  for (std::size_t i = robot + 1; i < first_.size(); ++i) --first_[i];
}

void Draft::swap(int robot, int at, int with) { std::swap(order_[first_[robot] + at], order_[first_[robot] + with]); }

void Draft::reorder(int robot, std::span<const int> route) { std::ranges::copy(route, order_.begin() + first_[robot]); }

void Draft::assign(std::span<const int> tasks, std::span<const int> robots) {
  clear();
  for (const int robot : robots) ++first_[robot + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  order_.resize(tasks.size());
  // Filling moves each robot's beginning to the next one's; moving them back is cheaper than a second array.
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    order_[first_[robots[k]]++] = tasks[k];
    robot_of_[tasks[k]] = robots[k];
  }
  std::move_backward(first_.begin(), first_.end() - 1, first_.end());
  first_.front() = 0;
}

bool Evaluator::evaluate(Draft& draft) {
  for (int robot = 0; robot < problem_.robots(); ++robot) draft.measure(problem_, robot);
  return conclude(draft);
}

bool Evaluator::evaluate(Draft& draft, std::span<const int> changed) {
  for (const int robot : changed) draft.measure(problem_, robot);
  return conclude(draft);
}

bool Evaluator::conclude(Draft& draft) {
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (!problem_.fits(robot, draft.figures_[robot].usage)) return false;
  }
  if (problem_.has_prerequisites() && !(prerequisites_done(draft) && order(draft))) return false;
  double weight = 0.0;
  for (int task = 0; task < problem_.tasks(); ++task) {
    if (draft.robot_of(task) != Draft::kNobody) weight += problem_.priority(task);
  }
  draft.value_ = {weight, objective(draft)};
  return true;
}

bool Evaluator::prerequisites_done(const Draft& draft) const {
  if (draft.done() == problem_.tasks()) return true;
  return std::ranges::all_of(draft.order_, [&](int task) {
    return std::ranges::all_of(problem_.prerequisites(task),
                               [&](int before) { return draft.robot_of(before) != Draft::kNobody; });
  });
}

double Evaluator::objective(const Draft& draft) {
  double total = 0.0, most = 0.0, arrivals = 0.0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    total += draft.figures(robot).usage;
    most = std::max(most, draft.figures(robot).usage);
    arrivals += draft.figures(robot).arrivals;
  }
  switch (problem_.objective()) {
    case Objective::total:
      return total;
    case Objective::max:
      return most;
    case Objective::total_max:
      return total + most;
    case Objective::average:
      return draft.done() ? arrivals / draft.done() : 0.0;
    case Objective::makespan:
      return *makespan(draft);
    case Objective::lateness:
      break;  // of timed problems alone, which no draft is made for
  }
  return total;
}

bool Evaluator::order(const Draft& draft) {
  const auto done = [&draft](int task) { return draft.robot_of(task) != Draft::kNobody; };
  sequence_.clear();
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    int before_it = problem_.start(robot);
    for (const int task : draft.route(robot)) {
      const auto before = problem_.prerequisites(task);
      const bool first = before_it >= problem_.tasks();
      waiting_[task] = (first ? 0 : 1) + static_cast<int>(std::ranges::count_if(before, done));
      if (!first) after_[before_it] = task;
      before_[task] = before_it;
      after_[task] = Draft::kNobody;
      if (waiting_[task] == 0) sequence_.push_back(task);
      before_it = task;
    }
  }
  for (std::size_t k = 0; k < sequence_.size(); ++k) {
    const int task = sequence_[k];
    if (after_[task] != Draft::kNobody && --waiting_[after_[task]] == 0) sequence_.push_back(after_[task]);
    for (const int dependant : problem_.dependants(task)) {
      if (done(dependant) && --waiting_[dependant] == 0) sequence_.push_back(dependant);
    }
  }
  return static_cast<int>(sequence_.size()) == draft.done();
}

std::optional<double> Evaluator::makespan(const Draft& draft) {
  if (!order(draft)) return std::nullopt;
  double latest = 0.0;
  for (const int task : sequence_) {
    const int robot = draft.robot_of(task), from = before_[task];
    const double leaves = from < problem_.tasks() ? ends_[from] : problem_.available_from(robot);
    double begin = leaves + problem_.travel_time(robot, from, task);
    for (const int before : problem_.prerequisites(task)) {
      if (draft.robot_of(before) != Draft::kNobody) begin = std::max(begin, ends_[before]);
    }
    ends_[task] = begin + problem_.work_time(robot, task);
    latest = std::max(latest, ends_[task]);
  }
  if (!problem_.makespan_includes_return()) return latest;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (!problem_.must_end(robot) || draft.length(robot) == 0) continue;
    const int last = draft.route(robot).back();
    latest = std::max(latest, ends_[last] + problem_.travel_time(robot, last, problem_.end(robot)));
  }
  return latest;
}

}  // namespace muster
