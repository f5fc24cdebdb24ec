#include "plans/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace muster {

namespace {

// After so many placements for each present unit labels are put in order of time again.
constexpr double kPlacementsPerUnit = 0.25;

int place_in_unit(const Problem& problem, int task) {
  const auto tasks = problem.tasks_of_unit(problem.unit(task));
  return static_cast<int>(std::ranges::find(tasks, task) - tasks.begin());
}

}  // namespace

Timeline::Timeline(const Problem& problem)
    : problem_(problem),
      has_openings_(problem.has_openings()),
      has_limits_(problem.has_time_limits()),
      has_gap_most_(false),
      has_tails_(problem.objective() == Objective::makespan),
      looks_back_(has_limits_ || has_tails_),
      routes_(problem.robots()),
      nodes_(problem.units()),
      work_(problem.tasks(), 0.0),
      ends_(problem.tasks(), -kNever),
      tails_(problem.units(), -kNever),
      forward_(problem.units(), UnitQueue::Order::rising),
      backward_(problem.units(), UnitQueue::Order::falling),
      stamp_of_(problem.tasks(), 0) {
  build_arcs();
  const int robots = problem.robots();
  visits_.resize(2 * robots);
  for (int robot = 0; robot < robots; ++robot) {
    Visit& start = visits_[robot];
    start.robot = robot;
    start.place = problem.start(robot);
    start.leave = problem.available_from(robot);
    Visit& last = visits_[robots + robot];
    last.robot = robot;
    last.place = problem.end(robot);
    last.label = 1.0;
    last.latest = problem.over_by(robot);
    routes_[robot] = {robot, robots + robot};
    last.at = 1;
    join(robot, robots + robot);
  }
}

void Timeline::build_arcs() {
  std::vector<std::vector<Arc>> before(problem_.units()), behind(problem_.units());
  for (int task = 0; task < problem_.tasks(); ++task) {
    const int unit = problem_.unit(task);
    const auto prerequisites = problem_.prerequisites(task);
    for (std::size_t k = 0; k < prerequisites.size(); ++k) {
      const int earlier = prerequisites[k], other = problem_.unit(earlier);
      const double after = problem_.gap_least(task, static_cast<int>(k)),
                   within = problem_.gap_most(task, static_cast<int>(k));
      before[unit].push_back({other, earlier, place_in_unit(problem_, task), after, within});
      behind[other].push_back({unit, task, place_in_unit(problem_, earlier), after, within});
      has_gap_most_ |= std::isfinite(within);
    }
  }
  for (int unit = 0; unit < problem_.units(); ++unit) {
    const auto tasks = problem_.tasks_of_unit(unit);
    if (tasks.size() == 1) nodes_[unit].task = tasks.front();
    before_.add(before[unit]);
    behind_.add(behind[unit]);
  }
}

bool Timeline::begin(const Routes& routes) {
  commit();
  for (int unit = 0; unit < problem_.units(); ++unit) {
    if (present(unit)) remove(unit);
  }
  commit();
  if (!label_topologically(routes)) return false;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    for (std::size_t k = 0; k < routes[robot].size(); ++k) {
      const int task = routes[robot][k], unit = problem_.unit(task);
      const int number = new_visit({task, robot, static_cast<int>(k)}, unit);
      nodes_[unit].visits.push_back(number);
      put(number, static_cast<int>(k) + 1);
    }
  }
  for (int unit = 0; unit < problem_.units(); ++unit) {
    if (present(unit)) measure_work(unit);
  }
  queue_all();
  const bool possible = settle();
  drop_queues();
  commit();
  if (possible) relabel();
  return possible;
}

double Timeline::ready(int unit) const {
  double ready = 0.0;
  for (const Arc& arc : before_[unit]) ready = std::max(ready, ends_[arc.task] + arc.after);
  return ready;
}

double Timeline::latest_for(int unit, std::span<const double> work) const {
  double latest = kNever;
  if (!has_limits_) return latest;
  const auto tasks = problem_.tasks_of_unit(unit);
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    latest = std::min(latest, problem_.ends_by(tasks[k]) - work[k]);
  }
  for (const Arc& arc : behind_[unit]) {
    if (present(arc.unit)) latest = std::min(latest, latest_of(arc.unit) - arc.after - work[arc.own]);
  }
  for (const Arc& arc : before_[unit]) {
    if (present(arc.unit)) latest = std::min(latest, latest_of(arc.unit) + work_[arc.task] + arc.within);
  }
  return last_open(unit, latest);
}

double Timeline::tail_after(int unit, std::span<const double> work) const {
  double tail = 0.0;
  for (const double each : work) tail = std::max(tail, each);
  for (const Arc& arc : behind_[unit]) tail = std::max(tail, work[arc.own] + arc.after + tails_[arc.unit]);
  return tail;
}

double Timeline::open(int unit, double earliest) const {
  if (!has_openings_) return earliest;
  const auto tasks = problem_.tasks_of_unit(unit);
  for (double begin = earliest;;) {
    for (const int task : tasks) begin = problem_.next_begin(task, begin);
    if (tasks.size() == 1 || begin == earliest || begin == kNever) return begin;
    earliest = begin;
  }
}

double Timeline::last_open(int unit, double latest) const {
  double begin = latest;
  for (const int task : problem_.tasks_of_unit(unit)) begin = std::min(begin, problem_.last_begin(task, latest));
  return begin;
}

int Timeline::new_visit(const Member& member, int unit) {
  int number = static_cast<int>(visits_.size());
  if (free_.empty()) {
    visits_.emplace_back();
  } else {
    number = free_.back();
    free_.pop_back();
  }
  Visit& visit = visits_[number];
  visit.robot = member.robot;
  visit.place = member.task;
  visit.unit = unit;
  visit.label = nodes_[unit].label;
  visit.leave = visit.latest = visit.tail = std::numeric_limits<double>::quiet_NaN();  // not measured yet
  return number;
}

void Timeline::put(int number, int at) {
  auto& route = routes_[visits_[number].robot];
  route.insert(route.begin() + at, number);
  for (std::size_t k = at; k < route.size(); ++k) visits_[route[k]].at = static_cast<int>(k);
  join(route[at - 1], number);
  join(number, route[at + 1]);
}

void Timeline::take(int number) {
  const Visit& visit = visits_[number];
  auto& route = routes_[visit.robot];
  route.erase(route.begin() + visit.at);
  for (std::size_t k = visit.at; k < route.size(); ++k) visits_[route[k]].at = static_cast<int>(k);
  join(visit.last, visit.next);
}

// Makes one visit the next after another.
void Timeline::join(int number, int next) {
  const Visit& from = visits_[number];
  Visit& to = visits_[next];
  visits_[number].next = next;
  to.last = number;
  const bool goes_there = to.unit >= 0 || problem_.must_end(to.robot);
  to.in = goes_there ? problem_.travel_time(to.robot, from.place, to.place) : 0.0;
}

void Timeline::set_way(int robot, int at, double seconds) {
  Visit& to = visits_[routes_[robot][at]];
  if (to.in == seconds) return;
  to.in = seconds;
  const int last = before(to).unit;
  if (to.unit >= 0) queue_forward(to.unit);
  if (last >= 0) queue_backward(last);
  if (to.unit < 0 && last >= 0) queue_forward(last);
}

// A team's task takes as long as for its slowest member.
void Timeline::measure_work(int unit) {
  for (const int number : nodes_[unit].visits) work_[visits_[number].place] = 0.0;
  for (const int number : nodes_[unit].visits) {
    double& work = work_[visits_[number].place];
    work = std::max(work, problem_.work_time(visits_[number].robot, visits_[number].place));
  }
}

void Timeline::insert(int unit, std::span<const Member> members, int before) {
  const auto label_between = [&] {
    const Labels places = between(members), allowed = labels_for(unit);
    const double high = before < 0 ? places.high : std::min(places.high, nodes_[before].label);
    return std::pair{std::max(places.low, allowed.low), std::min(high, allowed.high)};
  };
  auto [low, high] = label_between();
  if (forward_.has(unit) || backward_.has(unit)) settle();
  if (0.5 * (low + high) <= low || 0.5 * (low + high) >= high) {  // no number is left between
    settle();
    auto labels = all_labels();
    std::ranges::stable_sort(labels, {}, [](const double* label) { return *label; });
    spread(labels);
    std::tie(low, high) = label_between();
  }
  save(unit);
  changes_.push_back({unit, true, 0, 0.0});
  ++unsorted_;
  Node& node = nodes_[unit];
  node.label = 0.5 * (low + high);
  for (const Member& member : members) {
    const int number = new_visit(member, unit);
    node.visits.push_back(number);
    put(number, member.at + 1);
  }
  measure_work(unit);
  queue_forward(unit);
  queue_backward(unit);
  queue_later(unit);
  queue_earlier(unit);
}

void Timeline::remove(int unit) {
  Node& node = nodes_[unit];
  save(unit);
  changes_.push_back({unit, false, static_cast<int>(taken_.size()), node.label});
  queue_later(unit);
  queue_earlier(unit);
  for (const int number : node.visits) {
    const Visit& last = before(visits_[number]);  // from which the way to the end may be longer
    if (last.unit >= 0 && behind(visits_[number]).unit < 0) queue_forward(last.unit);
    take(number);
    taken_.push_back(number);
  }
  vanish(unit);
}

// What is absent bounds nothing.
void Timeline::vanish(int unit) {
  nodes_[unit].visits.clear();
  tails_[unit] = -kNever;
  for (const int task : problem_.tasks_of_unit(unit)) {
    ends_[task] = -kNever;
    work_[task] = 0.0;  // by nobody yet: what it took the last robot says nothing of the next
  }
}

void Timeline::save(int unit) {
  Node& node = nodes_[unit];
  if (node.saved == step_) return;
  node.saved = step_;
  times_.push_back({unit, node.begin, node.latest, node.tail});
}

void Timeline::commit() {
  backward();
  free_.insert(free_.end(), taken_.begin(), taken_.end());
  taken_.clear();
  changes_.clear();
  committed_.clear();
  for (const Times& times : times_) committed_.push_back(times.unit);
  times_.clear();
  ++step_;
  if (static_cast<double>(unsorted_) > 1.0 + kPlacementsPerUnit * static_cast<double>(nodes_.size())) relabel();
}

void Timeline::rollback() {
  drop_queues();
  while (!changes_.empty()) {
    restore(changes_.back());
    changes_.pop_back();
  }
  for (const Times& times : times_) {
    set_latest(times.unit, times.latest, times.tail);
    set_begin(times.unit, times.begin);
  }
  taken_.clear();
  times_.clear();
  ++step_;
}

void Timeline::restore(const Change& change) {
  Node& node = nodes_[change.unit];
  if (change.inserted) {
    for (auto each = node.visits.rbegin(); each != node.visits.rend(); ++each) {
      take(*each);
      free_.push_back(*each);
    }
    return vanish(change.unit);
  }
  node.visits.assign(taken_.begin() + change.first, taken_.end());
  taken_.resize(change.first);
  for (auto each = node.visits.rbegin(); each != node.visits.rend(); ++each) put(*each, visits_[*each].at);
  set_label(change.unit, change.label);
  measure_work(change.unit);
}

}  // namespace muster
