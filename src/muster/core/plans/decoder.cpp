#include "plans/decoder.hpp"

#include <algorithm>
#include <limits>

namespace muster {

Decoder::Decoder(const Problem& problem)
    : problem_(problem), routes_(problem), seen_(problem.tasks()), at_(problem.robots()), tasks_(problem.robots()) {}

void Decoder::in_order(std::span<const int> tasks, std::span<const int> robots, Draft& draft) {
  routes_.clear();
  std::ranges::fill(seen_, 0);
  std::ranges::fill(at_, 0);
  for (auto& own : tasks_) own.clear();
  for (const int task : tasks) tasks_[robots[task]].push_back(task);
  while (advance(robots) || pass_over()) {
  }
  routes_.put_into(draft);
}

// Each robot goes on until it would have to wait.
bool Decoder::advance(std::span<const int> robots) {
  bool more = false;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    const std::vector<int>& own = tasks_[robot];
    for (; at_[robot] < own.size() && routes_.ready(own[at_[robot]]); ++at_[robot], more = true) {
      put(own[at_[robot]], robots);
    }
  }
  return more;
}

// Where all robots wait for each other, or for what is left out, the first leaves its task for when it is ready.
bool Decoder::pass_over() {
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (at_[robot] == tasks_[robot].size()) continue;
    seen_[tasks_[robot][at_[robot]++]] = 1;
    return true;
  }
  return false;
}

void Decoder::put(int task, std::span<const int> robots) {
  next_.assign(1, task);
  while (!next_.empty()) {
    const int next = next_.back();
    next_.pop_back();
    seen_[next] = 1;
    if (!routes_.ready(next)) continue;
    const int meant = robots[next];
    const int robot = routes_.can_append(meant, next) ? meant : routes_.cheapest(next);
    if (robot == Draft::kNobody) continue;
    routes_.append(robot, next);
    for (const int dependant : problem_.dependants(next)) {
      if (seen_[dependant] && routes_.ready(dependant)) next_.push_back(dependant);
    }
  }
}

void Decoder::nearest_next(std::span<const int> robots, Draft& draft) {
  routes_.clear();
  for (auto& own : tasks_) own.clear();
  for (int task = 0; task < problem_.tasks(); ++task) tasks_[robots[task]].push_back(task);
  for (bool more = true; more;) {
    more = false;
    for (int robot = 0; robot < problem_.robots(); ++robot) more |= go_to_nearest(robot);
  }
  std::ranges::fill(seen_, 1);
  for (int task = 0; task < problem_.tasks(); ++task) {
    if (!routes_.taken(task)) put(task, robots);
  }
  routes_.put_into(draft);
}

bool Decoder::go_to_nearest(int robot) {
  std::vector<int>& own = tasks_[robot];
  double least = std::numeric_limits<double>::infinity();
  std::size_t nearest = own.size();
  for (std::size_t k = 0; k < own.size(); ++k) {
    const double way = problem_.travel_usage(robot, routes_.place(robot), own[k]);
    if (way >= least || !routes_.ready(own[k]) || !routes_.can_append(robot, own[k])) continue;
    least = way;
    nearest = k;
  }
  if (nearest == own.size()) return false;
  routes_.append(robot, own[nearest]);
  own[nearest] = own.back();
  own.pop_back();
  return true;
}

}  // namespace muster
