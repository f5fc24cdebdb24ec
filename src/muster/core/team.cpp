#include "team.hpp"

#include <algorithm>
#include <utility>

namespace muster {

Team::Team(const Problem& problem, const Routes& routes)
    : problem_(problem),
      costs_(problem.robots()),
      legs_(problem.robots()),
      robot_of_(problem.tasks()),
      at_(problem.tasks(), 0),
      listed_(problem.tasks(), 0),
      changed_(problem.robots(), 1),
      stamp_of_(problem.robots(), 0),
      earliest_(problem.robots(), 0),
      latest_(problem.robots(), 0),
      task_stamp_(problem.tasks(), 0),
      waiting_(problem.tasks(), 0),
      ends_(problem.tasks(), 0.0),
      tails_(problem.tasks(), 0.0) {
  begin(routes);
}

void Team::begin(const Routes& routes) {
  routes_ = routes;
  std::ranges::fill(robot_of_, kAbsent);
  std::ranges::fill(changed_, 1);
  absent_.clear();
  absent_weight_ = 0.0;
  saved_count_ = 0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    for (const int task : routes_[robot]) robot_of_[task] = robot;
    measure(robot, 0);
  }
  for (int task = 0; task < problem_.tasks(); ++task) {
    if (!present(task)) vanish(task);
  }
}

void Team::insert(int task, int robot, int at) {
  touch(robot);
  routes_[robot].insert(routes_[robot].begin() + at, task);
  appear(task, robot);
  measure(robot, at);
}

void Team::remove(int task) {
  const int robot = robot_of_[task];
  touch(robot);
  const int at = at_[task];
  routes_[robot].erase(routes_[robot].begin() + at);
  vanish(task);
  measure(robot, at);
}

void Team::appear(int task, int robot) {
  robot_of_[task] = robot;
  absent_[listed_[task]] = absent_.back();
  listed_[absent_.back()] = listed_[task];
  absent_.pop_back();
  absent_weight_ = absent_.empty() ? 0.0 : absent_weight_ - problem_.priority(task);
}

void Team::vanish(int task) {
  robot_of_[task] = kAbsent;
  listed_[task] = static_cast<int>(absent_.size());
  absent_.push_back(task);
  absent_weight_ += problem_.priority(task);
}

void Team::touch(int robot) {
  changed_[robot] = 1;
  for (std::size_t k = 0; k < saved_count_; ++k) {
    if (saved_[k].robot == robot) return;
  }
  if (saved_count_ == saved_.size()) saved_.emplace_back();
  Saved& saved = saved_[saved_count_++];
  saved.robot = robot;
  saved.route = routes_[robot];
  saved.cost = costs_[robot];
  saved.legs = legs_[robot];
}

void Team::rollback() {
  for (std::size_t k = 0; k < saved_count_; ++k) {
    Saved& saved = saved_[k];
    for (const int task : routes_[saved.robot]) vanish(task);
    std::swap(routes_[saved.robot], saved.route);
    std::swap(legs_[saved.robot], saved.legs);
    costs_[saved.robot] = saved.cost;
  }
  for (std::size_t k = 0; k < saved_count_; ++k) {
    const auto& route = routes_[saved_[k].robot];
    for (std::size_t at = 0; at < route.size(); ++at) {
      appear(route[at], saved_[k].robot);
      at_[route[at]] = static_cast<int>(at);
    }
  }
  saved_count_ = 0;
}

bool Team::fits() const {
  for (std::size_t k = 0; k < saved_count_; ++k) {
    if (!problem_.fits(saved_[k].robot, costs_[saved_[k].robot].usage)) return false;
  }
  return true;
}

std::vector<int> Team::take_changed() {
  std::vector<int> changed;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (std::exchange(changed_[robot], 0)) changed.push_back(robot);
  }
  return changed;
}

// Figures of a route, and the places of its tasks, from a place on.
void Team::measure(int robot, int from) {
  const auto& route = routes_[robot];
  const int size = static_cast<int>(route.size());
  auto& legs = legs_[robot];
  legs.resize(size + 1);
  if (from == 0) legs[0] = {0.0, 0.0, problem_.available_from(robot), 0.0};
  const bool timed = problem_.objective() == Objective::makespan;
  int place = from ? route[from - 1] : problem_.start(robot);
  for (int at = from; at < size; ++at) {
    const int task = route[at];
    Leg& leg = legs[at];
    leg.way = problem_.travel_usage(robot, place, task);
    const double arrival = leg.usage + leg.way;
    Leg& next = legs[at + 1];
    next.usage = arrival + problem_.work_usage(robot, task);
    next.arrivals = leg.arrivals + arrival;
    if (timed) {
      next.time = leg.time + problem_.travel_time(robot, place, task) + problem_.work_time(robot, task);
    }
    at_[task] = at;
    place = task;
  }
  Leg& last = legs[size];
  last.way = size ? problem_.end_usage(robot, place) : 0.0;
  costs_[robot] = {last.usage + last.way, last.arrivals, last.time};
}

double Team::later_arrivals(int robot, int task, int at, double growth) const {
  const auto& route = routes_[robot];
  const int before = at ? route[at - 1] : problem_.start(robot);
  const double later = static_cast<double>(route.size()) - at;
  return legs_[robot][at].usage + problem_.travel_usage(robot, before, task) + later * growth;
}

double Team::longer(int robot, int task, int at) const {
  const auto& route = routes_[robot];
  const int before = at ? route[at - 1] : problem_.start(robot);
  const double there = problem_.travel_time(robot, before, task) + problem_.work_time(robot, task);
  if (at == static_cast<int>(route.size())) return there;
  return there + problem_.travel_time(robot, task, route[at]) - problem_.travel_time(robot, before, route[at]);
}

void Team::bound(int task) {
  ++stamp_;
  if (problem_.prerequisites(task).empty() && problem_.dependants(task).empty()) return;
  go_back(task);
  go_forth(task);
}

void Team::see(int robot) {
  if (stamp_of_[robot] == stamp_) return;
  stamp_of_[robot] = stamp_;
  earliest_[robot] = 0;
  latest_[robot] = static_cast<int>(routes_[robot].size());
}

// All that comes before a prerequisite comes before the task: in routes up to it, and what these tasks wait for. Tasks
// that are absent for now still pass on what they wait for.
void Team::go_back(int task) {
  stack_.assign(problem_.prerequisites(task).begin(), problem_.prerequisites(task).end());
  while (!stack_.empty()) {
    const int before = stack_.back();
    stack_.pop_back();
    const int robot = robot_of_[before];
    if (robot == kAbsent) {
      if (std::exchange(task_stamp_[before], stamp_) == stamp_) continue;
      for (const int other : problem_.prerequisites(before)) stack_.push_back(other);
      continue;
    }
    see(robot);
    for (int& k = earliest_[robot]; k <= at_[before]; ++k) {
      for (const int other : problem_.prerequisites(routes_[robot][k])) stack_.push_back(other);
    }
  }
}

// All that comes after a dependant comes after the task; dependants that are absent still pass it on.
void Team::go_forth(int task) {
  stack_.assign(problem_.dependants(task).begin(), problem_.dependants(task).end());
  while (!stack_.empty()) {
    const int after = stack_.back();
    stack_.pop_back();
    const int robot = robot_of_[after];
    if (robot == kAbsent) {
      if (std::exchange(task_stamp_[after], stamp_) == stamp_) continue;
      for (const int other : problem_.dependants(after)) stack_.push_back(other);
      continue;
    }
    see(robot);
    for (int& k = latest_[robot]; k > at_[after];) {
      --k;
      for (const int other : problem_.dependants(routes_[robot][k])) stack_.push_back(other);
    }
  }
}

double Team::makespan() {
  double latest = 0.0;
  if (!problem_.has_prerequisites()) {
    for (int robot = 0; robot < problem_.robots(); ++robot) {
      if (!routes_[robot].empty()) latest = std::max(latest, costs_[robot].done);
    }
    return latest;
  }
  queue_.clear();
  for (const auto& route : routes_) {
    for (std::size_t at = 0; at < route.size(); ++at) {
      int& waiting = waiting_[route[at]];
      waiting = at ? 1 : 0;
      for (const int before : problem_.prerequisites(route[at])) waiting += present(before);
      if (waiting == 0) queue_.push_back(route[at]);
    }
  }
  for (std::size_t k = 0; k < queue_.size(); ++k) {
    const int task = queue_[k], robot = robot_of_[task], at = at_[task];
    const auto& route = routes_[robot];
    const int from = at ? route[at - 1] : problem_.start(robot);
    double begin = (at ? ends_[from] : problem_.available_from(robot)) + problem_.travel_time(robot, from, task);
    for (const int before : problem_.prerequisites(task)) {
      if (present(before)) begin = std::max(begin, ends_[before]);
    }
    ends_[task] = begin + problem_.work_time(robot, task);
    latest = std::max(latest, ends_[task]);
    if (at + 1 < static_cast<int>(route.size()) && --waiting_[route[at + 1]] == 0) queue_.push_back(route[at + 1]);
    for (const int after : problem_.dependants(task)) {
      if (present(after) && --waiting_[after] == 0) queue_.push_back(after);
    }
  }
  return latest;
}

void Team::measure_tails() {
  for (auto each = queue_.rbegin(); each != queue_.rend(); ++each) {
    const int task = *each, robot = robot_of_[task], at = at_[task];
    const auto& route = routes_[robot];
    double after = 0.0;
    if (at + 1 < static_cast<int>(route.size())) {
      after = problem_.travel_time(robot, task, route[at + 1]) + tails_[route[at + 1]];
    }
    for (const int waiting : problem_.dependants(task)) {
      if (present(waiting)) after = std::max(after, tails_[waiting]);
    }
    tails_[task] = problem_.work_time(robot, task) + after;
  }
}

double Team::end_through(int robot, int task, int at) const {
  const auto& route = routes_[robot];
  const int from = at ? route[at - 1] : problem_.start(robot);
  double begin = (at ? ends_[from] : problem_.available_from(robot)) + problem_.travel_time(robot, from, task);
  for (const int before : problem_.prerequisites(task)) {
    if (present(before)) begin = std::max(begin, ends_[before]);
  }
  double after = 0.0;
  if (at < static_cast<int>(route.size())) after = problem_.travel_time(robot, task, route[at]) + tails_[route[at]];
  for (const int waiting : problem_.dependants(task)) {
    if (present(waiting)) after = std::max(after, tails_[waiting]);
  }
  return begin + problem_.work_time(robot, task) + after;
}

std::vector<int> Team::critical() const {
  std::vector<int> path;
  if (queue_.empty()) return path;
  int task = *std::ranges::max_element(queue_, {}, [&](int each) { return ends_[each]; });
  while (task != kAbsent) {
    path.push_back(task);
    const int robot = robot_of_[task], at = at_[task];
    int latest = at ? routes_[robot][at - 1] : kAbsent;
    double begin = latest == kAbsent
                       ? problem_.available_from(robot) + problem_.travel_time(robot, problem_.start(robot), task)
                       : ends_[latest] + problem_.travel_time(robot, latest, task);
    for (const int before : problem_.prerequisites(task)) {
      if (!present(before) || ends_[before] <= begin) continue;
      begin = ends_[before];
      latest = before;
    }
    task = latest;
  }
  return path;
}

}  // namespace muster
