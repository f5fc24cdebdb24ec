#include "draft.hpp"

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

void Draft::assign(std::span<const int> tasks, std::span<const int> robots) {
  clear();
  for (const int robot : robots) ++first_[robot + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  order_.resize(tasks.size());
  // Filling moves each robot's beginning to the next one's; shifting them back is cheaper than a second array.
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    order_[first_[robots[k]]++] = tasks[k];
    robot_of_[tasks[k]] = robots[k];
  }
  std::shift_right(first_.begin(), first_.end(), 1);
  first_.front() = 0;
}

bool Evaluator::evaluate(Draft& draft) {
  for (int robot = 0; robot < problem_.robots(); ++robot)
    draft.figures_[robot] = problem_.walk(robot, draft.route(robot));
  return conclude(draft);
}

bool Evaluator::evaluate(Draft& draft, std::span<const int> changed) {
  for (const int robot : changed) draft.figures_[robot] = problem_.walk(robot, draft.route(robot));
  return conclude(draft);
}

bool Evaluator::conclude(Draft& draft) {
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (!problem_.fits(robot, draft.figures_[robot].usage)) return false;
  }
  if (problem_.has_prerequisites()) {
    for (const int task : draft.order_) {
      for (const int before : problem_.prerequisites(task)) {
        if (draft.robot_of(before) == Draft::kNobody) return false;
      }
    }
  }
  const bool timed = problem_.objective() == Objective::makespan;
  if ((timed || problem_.has_prerequisites()) && !schedule(draft)) return false;
  double weight = 0.0;
  for (int task = 0; task < problem_.tasks(); ++task) {
    if (draft.robot_of(task) != Draft::kNobody) weight += problem_.priority(task);
  }
  draft.value_ = {weight, objective(draft)};
  return true;
}

double Evaluator::objective(const Draft& draft) const {
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
      return makespan(draft);
  }
  return total;
}

bool Evaluator::schedule(const Draft& draft) {
  const auto done = [&draft](int task) { return draft.robot_of(task) != Draft::kNobody; };
  ready_.clear();
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    const auto route = draft.route(robot);
    for (std::size_t k = 0; k < route.size(); ++k) {
      const auto before = problem_.prerequisites(route[k]);
      waiting_[route[k]] = (k > 0) + static_cast<int>(std::ranges::count_if(before, done));
      next_[route[k]] = k + 1 < route.size() ? route[k + 1] : Draft::kNobody;
      ends_[route[k]] = 0.0;  // until it is released: the time at which its robot arrives
    }
    if (route.empty()) continue;
    ends_[route[0]] = problem_.available_from(robot) + problem_.travel_time(robot, problem_.start(robot), route[0]);
    if (waiting_[route[0]] == 0) ready_.push_back(route[0]);
  }
  int released = 0;
  for (; released < static_cast<int>(ready_.size()); ++released) release(draft, ready_[released]);
  return released == draft.done();
}

void Evaluator::release(const Draft& draft, int task) {
  const int robot = draft.robot_of(task);
  double begin = ends_[task];
  for (const int before : problem_.prerequisites(task)) {
    if (draft.robot_of(before) != Draft::kNobody) begin = std::max(begin, ends_[before]);
  }
  ends_[task] = begin + problem_.work_time(robot, task);
  const int following = next_[task];
  if (following != Draft::kNobody) {
    ends_[following] = ends_[task] + problem_.travel_time(robot, task, following);
    if (--waiting_[following] == 0) ready_.push_back(following);
  }
  for (const int dependant : problem_.dependants(task)) {
    if (draft.robot_of(dependant) != Draft::kNobody && --waiting_[dependant] == 0) ready_.push_back(dependant);
  }
}

double Evaluator::makespan(const Draft& draft) const {
  double latest = 0.0;
  for (const int task : draft.order_) latest = std::max(latest, ends_[task]);
  return latest;
}

}  // namespace muster
