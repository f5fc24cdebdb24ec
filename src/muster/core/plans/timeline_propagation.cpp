// How a change of routes passes through the schedule.
#include "plans/timeline.hpp"

#include <algorithm>

namespace muster {

void Timeline::queue_all() {
  for (std::size_t unit = 0; unit < nodes_.size(); ++unit) {
    if (!present(static_cast<int>(unit))) continue;
    queue_forward(static_cast<int>(unit));
    queue_backward(static_cast<int>(unit));
  }
}

bool Timeline::settle() {
  if (!settle_begins()) return false;
  backward();
  return true;
}

bool Timeline::settle_begins() {
  if (has_gap_most_ && !(forward_.empty() && backward_.empty())) return settle_cycles();
  if (forward_.empty()) return true;
  renew_budget();
  return forward();
}

// How long its tasks take, with the robots that do them.
std::span<const double> Timeline::works_of(int unit) {
  if (const int task = nodes_[unit].task; task >= 0) return {&work_[task], 1};
  works_.clear();
  for (const int task : problem_.tasks_of_unit(unit)) works_.push_back(work_[task]);
  return works_;
}

double Timeline::earliest_begin(int unit) {
  double begin = ready(unit);
  for (const int number : nodes_[unit].visits) {
    const Visit& visit = visits_[number];
    begin = std::max(begin, before(visit).leave + visit.in);
  }
  if (has_gap_most_) {
    const auto work = works_of(unit);
    for (const Arc& arc : behind_[unit]) {
      if (present(arc.unit)) begin = std::max(begin, begin_of(arc.unit) - arc.within - work[arc.own]);
    }
  }
  return open(unit, begin);
}

double Timeline::latest_begin(int unit) {
  double latest = latest_for(unit, works_of(unit));
  for (const int number : nodes_[unit].visits) {
    const Visit& visit = visits_[number];
    const Visit& next = behind(visit);
    const double bound = next.latest - next.in - work_[visit.place];
    latest = std::min(latest, problem_.last_begin(visit.place, bound));
  }
  return latest;
}

double Timeline::longest_tail(int unit) {
  double tail = tail_after(unit, works_of(unit));
  for (const int number : nodes_[unit].visits) {
    const Visit& visit = visits_[number];
    const Visit& next = behind(visit);
    const bool counts = next.unit >= 0 || problem_.makespan_includes_return();
    tail = std::max(tail, work_[visit.place] + (counts ? next.in : 0.0) + next.tail);
  }
  return tail;
}

void Timeline::set_begin(int unit, double begin) {
  nodes_[unit].begin = begin;
  for (const int number : nodes_[unit].visits) {
    Visit& visit = visits_[number];
    visit.leave = ends_[visit.place] = begin + work_[visit.place];
  }
}

void Timeline::set_latest(int unit, double latest, double tail) {
  Node& node = nodes_[unit];
  node.latest = latest;
  node.tail = tail;
  if (!node.visits.empty()) tails_[unit] = tail;
  for (const int number : node.visits) {
    visits_[number].latest = latest;
    visits_[number].tail = tail;
  }
}

// Whether a unit that begins as it does keeps its own bounds.
bool Timeline::keeps_bounds(int unit) const {
  const Node& node = nodes_[unit];
  if (node.begin == kNever) return false;
  if (!has_limits_) return true;
  for (const int number : node.visits) {
    const Visit& visit = visits_[number];
    if (!in_time(visit.leave, problem_.ends_by(visit.place))) return false;
    const Visit& next = behind(visit);
    if (next.unit < 0 && !in_time(visit.leave + next.in, next.latest)) return false;
  }
  return true;
}

void Timeline::queue_later(int unit) {
  for (const int number : nodes_[unit].visits) {
    if (const int next = behind(visits_[number]).unit; next >= 0) queue_forward(next);
  }
  for (const Arc& arc : behind_[unit]) {
    if (present(arc.unit)) queue_forward(arc.unit);
  }
  if (!has_gap_most_) return;
  for (const Arc& arc : before_[unit]) {
    if (arc.within < kNever && present(arc.unit)) queue_forward(arc.unit);
  }
}

void Timeline::queue_earlier(int unit) {
  for (const int number : nodes_[unit].visits) {
    if (const int last = before(visits_[number]).unit; last >= 0) queue_backward(last);
  }
  for (const Arc& arc : before_[unit]) {
    if (present(arc.unit)) queue_backward(arc.unit);
  }
  if (!has_gap_most_) return;
  for (const Arc& arc : behind_[unit]) {
    if (arc.within < kNever && present(arc.unit)) queue_backward(arc.unit);
  }
}

bool Timeline::forward() {
  bool possible = true;
  while (!forward_.empty()) {
    const int unit = forward_.pop();
    Node& node = nodes_[unit];
    if (node.visits.empty()) continue;
    if (--budget_ < 0) return false;
    const double begin = earliest_begin(unit);
    const Visit& first = visits_[node.visits.front()];
    const bool changed = begin != node.begin || first.leave != begin + work_[first.place];
    if (changed) {
      save(unit);
      set_begin(unit, begin);
      queue_later(unit);
    }
    possible = possible && keeps_bounds(unit);
    if (has_gap_most_ && !possible) return false;
  }
  return possible;
}

// Latest begins only fall here. Where no schedule exists they fall for ever round a cycle of maximum gaps, as begins
// rise: the propagation ends with its budget then. What it leaves is too late at worst, so that nothing is rejected by
// it that begins do not reject.
void Timeline::backward() {
  if (backward_.empty()) return;
  renew_budget();
  while (!backward_.empty()) {
    const int unit = backward_.pop();
    Node& node = nodes_[unit];
    if (node.visits.empty()) continue;
    if (--budget_ < 0) return backward_.clear();
    const double latest = has_limits_ ? latest_begin(unit) : kNever;
    const double tail = has_tails_ ? longest_tail(unit) : 0.0;
    const Visit& first = visits_[node.visits.front()];
    if (latest == first.latest && tail == first.tail) continue;
    save(unit);
    set_latest(unit, latest, tail);
    queue_earlier(unit);
  }
}

// Where maximum gaps tie begins to each other in cycles, a fixpoint that is not the least may hold itself up. So begins
// rise from nothing, and latest begins fall from the end of time.
bool Timeline::settle_cycles() {
  drop_queues();
  renew_budget();
  for (std::size_t unit = 0; unit < nodes_.size(); ++unit) {
    if (nodes_[unit].visits.empty()) continue;
    save(static_cast<int>(unit));
    set_begin(static_cast<int>(unit), 0.0);
    set_latest(static_cast<int>(unit), kNever, 0.0);
  }
  queue_all();
  if (!forward()) return false;
  backward();
  return true;
}

// Without cycles each unit is looked at about once. In a graph with cycles a fixpoint is found after each unit was
// looked at some times, or there is none.
void Timeline::renew_budget() {
  const auto units = has_gap_most_ ? std::ranges::count_if(nodes_, [](const Node& n) { return !n.visits.empty(); })
                                   : std::ssize(nodes_);
  budget_ = 1000 + 64 * static_cast<int>(units);
}

void Timeline::drop_queues() {
  forward_.clear();
  backward_.clear();
}

double Timeline::end_of_route(int robot) const {
  const auto& route = routes_[robot];
  if (route.size() == 2) return 0.0;
  const Visit& last = visits_[route[route.size() - 2]];
  return problem_.makespan_includes_return() ? last.leave + visits_[route.back()].in : last.leave;
}

double Timeline::end() const {
  double end = 0.0;
  for (int robot = 0; robot < problem_.robots(); ++robot) end = std::max(end, end_of_route(robot));
  return end;
}

void Timeline::critical(std::vector<int>& units) const {
  units.clear();
  int last = -1;
  double end = 0.0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (end_of_route(robot) <= end) continue;
    end = end_of_route(robot);
    last = visits_[routes_[robot][routes_[robot].size() - 2]].unit;
  }
  for (int unit = last; unit >= 0 && units.size() < nodes_.size(); unit = holder_of(unit)) units.push_back(unit);
}

// What a unit begins after: the unit before it in a route, or a prerequisite; none where it waits for neither.
int Timeline::holder_of(int unit) const {
  int holder = -1;
  double bound = -kNever;
  for (const int number : nodes_[unit].visits) {
    const Visit& visit = visits_[number];
    const Visit& last = before(visit);
    const double arrival = last.leave + visit.in;
    if (arrival > bound) {
      bound = arrival;
      holder = last.unit;
    }
  }
  for (const Arc& arc : before_[unit]) {
    if (end_of(arc.task) + arc.after <= bound) continue;
    bound = end_of(arc.task) + arc.after;
    holder = arc.unit;
  }
  return in_time(begin_of(unit), bound) ? holder : -1;
}

}  // namespace muster
