// Labels of stops on a route: how much a robot can have used, and how much energy it can have by when.
#include "plans/station_calls.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace muster {

namespace {

constexpr double kLabelRounding = 1e-12;
constexpr std::size_t kMostLabels = 32;  // at a stop

}  // namespace

// Labels of the next stop from those of the last one: directly, and by way of stations. False: there are none.
bool StationCalls::cross(int robot, Labels& labels, int from, int to, double rest_before, double rest_after) {
  const auto [first, last] = labels.at_stop.back();
  const bool is_task = to < problem_.tasks();
  const bool may_call = !is_task || !problem_.is_over(to);  // what is over was done without
  layer_ = static_cast<int>(labels.all.size());
  current_.clear();
  // Labels of stations stand before those of the stop.
  for (int parent = first; may_call && parent < last; ++parent) {
    if (!runs_short(robot, labels, labels.all[parent], rest_before)) continue;
    for (const int station : stations_between(robot, from, to)) {
      const int called = call(robot, labels, parent, from, station);
      if (called >= 0) current_.push_back(called);
    }
  }
  const double needed = is_task ? std::min(rest_after, least_onward(robot, to)) : 0.0;
  const auto settle = [&] {
    layer_ = static_cast<int>(labels.all.size());
    for (int parent = first; parent < last; ++parent) arrive(robot, labels, parent, from, to, rest_after);
    for (const int parent : places_) {
      arrive(robot, labels, parent, problem_.place_of_station(labels.all[parent].station), to, rest_after);
    }
  };
  const double beyond = rest_before - problem_.travel_usage(robot, from, to);
  places_ = current_;
  if (has_few_) call_again(robot, labels, to, beyond);
  if (has_few_) refill_after_unloading(robot, labels, to, needed);
  settle();
  for (int depth = has_few_ ? 2 : 1; depth <= problem_.stations(); ++depth) {
    double most = -kNever;
    for (auto each = labels.all.begin() + layer_; each != labels.all.end(); ++each) {
      most = std::max(most, each->frontier.last().energy);
    }
    if (current_.empty()) break;
    if (most >= needed * (1.0 - kLabelRounding)) {
      spare_ = std::min(spare_, most - needed);  // with more to do, more calls would be looked at
      break;
    }
    labels.all.resize(layer_);
    call_again(robot, labels, to, beyond);
    settle();
  }
  labels.at_stop.emplace_back(layer_, static_cast<int>(labels.all.size()));
  labels.spare.push_back(spare_);
  return layer_ < static_cast<int>(labels.all.size());
}

// From the stations where the robot called last to all others.
void StationCalls::call_again(int robot, Labels& labels, int to, double beyond) {
  deeper_.clear();
  for (const int parent : current_) {
    const int last = labels.all[parent].station, place = problem_.place_of_station(last);
    const double rest = problem_.travel_usage(robot, place, to) + beyond;
    if (!runs_short(robot, labels, labels.all[parent], rest)) continue;
    for (int station = 0; station < problem_.stations(); ++station) {
      if (station == last || !serves(robot, station)) continue;
      const int called = call(robot, labels, parent, place, station);
      if (called >= 0) deeper_.push_back(called);
    }
  }
  if (deeper_.size() > kMostLabels * 4) deeper_.resize(kMostLabels * 4);
  current_ = deeper_;
  places_.insert(places_.end(), current_.begin(), current_.end());
}

// A robot may refill, unload and refill again, where it has not the energy that it needs at the stop after two calls:
// other ways to the stop may cost more.
void StationCalls::refill_after_unloading(int robot, Labels& labels, int to, double needed) {
  if (!unloads_ || problem_.energy(robot) == kNever) return;
  for (const int parent : current_) {
    const int last = labels.all[parent].station, before = labels.all[labels.all[parent].parent].station;
    if (problem_.station(last).gives_energy() || !problem_.station(before).gives_energy()) continue;
    const double way = problem_.travel_usage(robot, problem_.place_of_station(last), to);
    const double work = to < problem_.tasks() ? work_usage(robot, to, works_) : 0.0;
    if (labels.all[parent].frontier.last().energy >= way + work + needed) continue;
    for (int station = 0; station < problem_.stations(); ++station) {
      if (!problem_.station(station).gives_energy() || !serves(robot, station)) continue;
      const int called = call(robot, labels, parent, problem_.place_of_station(last), station);
      if (called >= 0) places_.push_back(called);
    }
  }
}

// Whether a robot with this label cannot do the rest of the route without a call. If it can, notes by how much the rest
// may grow until it cannot.
bool StationCalls::runs_short(int robot, const Labels& labels, const Label& label, double rest) {
  const bool drains = problem_.energy(robot) < kNever;
  if ((drains && label.frontier.first().energy < rest) || (unloads_ && !labels.loads.empty())) return true;
  if (drains) spare_ = std::min(spare_, label.frontier.first().energy - rest);
  return false;
}

// A label at a task once the work is done, or at the end.
bool StationCalls::arrive(int robot, Labels& labels, int parent, int from, int to, double rest_after) {
  Label label = labels.all[parent];
  const bool drains = problem_.energy(robot) < kNever;
  const double way = problem_.travel_usage(robot, from, to);
  if (!std::isfinite(way)) return false;
  const double slack = drains ? -kLabelRounding * problem_.energy(robot) : -kNever;
  if (label.station >= 0 && label.gap_s + problem_.travel_time(robot, from, to) > gap_limit_s_) return false;
  label.gap_s = 0.0;
  label.usage += way;
  label.parent = parent;
  label.station = -1;
  label.frontier.advance(problem_.travel_time(robot, from, to), drains ? way : 0.0);
  if (drains) label.frontier.keep_from(slack);
  if (label.frontier.empty()) return false;
  if (to >= problem_.tasks()) {
    label.frontier.keep_to(problem_.over_by(robot) * (1.0 + kLabelRounding));
    if (label.frontier.empty()) return false;
    if (ends_before_return(robot)) {
      const Frontier& worked = after_work(labels, parent);
      label.extra = drains ? worked.time_of(needed_after_work(robot, labels, parent)) : worked.first().time;
    }
    add(labels, std::move(label));
    return true;
  }
  const Objective objective = problem_.objective();
  if (objective == Objective::average) label.extra += label.usage;
  const double usage = work_usage(robot, to, works_);
  const double takes = std::max(works_[to], problem_.work_time(robot, to));
  label.usage += usage;
  if (!problem_.fits(robot, label.usage + rest_after)) return false;
  if (unloads_ && overloaded(robot, labels, label, static_cast<int>(labels.at_stop.size()))) return false;
  const double latest = problem_.ends_by(to) - takes;
  bool any = false;
  // In each of its openings; in a later one there is more time to refill before.
  for (double from_s = label.frontier.first().time;;) {
    const double opens = problem_.next_begin(to, from_s);
    if (opens > latest * (1.0 + kLabelRounding) || opens == kNever) return any;
    Label done = label;
    const double closes = problem_.last_begin_of_opening(to, opens);
    // Who refills for as long as there is time is not late by rounding.
    done.frontier.wait_until(opens);
    done.frontier.keep_to(std::max(std::min(closes, latest) * (1.0 - kLabelRounding), opens));
    done.frontier.advance(takes, drains ? usage : 0.0);
    if (drains) done.frontier.keep_from(slack);
    if (!done.frontier.empty()) {
      if (objective == Objective::lateness) {
        done.extra += problem_.priority(to) * std::max(0.0, done.frontier.first().time - problem_.due(to));
      }
      add(labels, std::move(done));
      any = true;
    }
    if (closes == kNever || closes >= label.frontier.last().time) return any;
    from_s = std::nextafter(closes, kNever);
  }
}

// A label at a station, once the robot is served there; -1: it cannot get there.
int StationCalls::call(int robot, Labels& labels, int parent, int from, int number) {
  Label label = labels.all[parent];
  const Station& station = problem_.station(number);
  const int place = problem_.place_of_station(number);
  const double way = problem_.travel_usage(robot, from, place), full = problem_.energy(robot);
  if (!std::isfinite(way)) return -1;
  label.usage += way;
  label.parent = parent;
  label.station = number;
  label.gap_s += problem_.travel_time(robot, from, place) + std::max(0.0, station.swap_s);
  const bool drains = full < kNever;
  label.frontier.advance(problem_.travel_time(robot, from, place), drains ? way : 0.0);
  if (drains) label.frontier.keep_from(-kLabelRounding * full);
  if (label.frontier.empty() || !changes(robot, labels, label, station)) return -1;
  if (drains && station.swap_s >= 0.0) {
    label.frontier = Frontier(label.frontier.first().time + station.swap_s, full);
  } else if (drains && station.refill > 0.0 && station.partial) {
    label.frontier.refill(station.refill, full);
  } else if (drains && station.refill > 0.0) {
    label.frontier.fill(station.refill, full);
  }
  if (unloads_ && station.unloads) {
    label.unloaded = static_cast<int>(labels.at_stop.size()) - 1;
    // What is to be delivered stays, though others may have put down some of it before.
    if (overloaded(robot, labels, label, label.unloaded)) return -1;
  }
  labels.all.push_back(std::move(label));
  return static_cast<int>(labels.all.size()) - 1;
}

// Whether anything is different after a visit of a station.
bool StationCalls::changes(int robot, const Labels& labels, const Label& label, const Station& station) const {
  const double full = problem_.energy(robot);
  if (full < kNever && station.gives_energy() && label.frontier.first().energy < full) return true;
  return unloads_ && station.unloads && label.unloaded != static_cast<int>(labels.at_stop.size()) - 1;
}

// Whether a load is above what the robot carries, or below nothing, after a stop.
bool StationCalls::overloaded(int robot, const Labels& labels, const Label& label, int stop) const {
  const int meters = problem_.meters();
  for (int c = 0; c < meters; ++c) {
    const double load = labels.loads[static_cast<std::size_t>(stop) * meters + c];
    if (!problem_.carries(robot, c, load - put_down(labels, label, c))) return true;
  }
  return false;
}

// What a robot put down up to a label: loads differ by no more between labels of one stop.
double StationCalls::put_down(const Labels& labels, const Label& label, int meter) const {
  if (label.unloaded < 0) return 0.0;
  const auto at = static_cast<std::size_t>(label.unloaded) * problem_.meters() + meter;
  return labels.loads[at] - labels.pending[at];
}

bool StationCalls::carry_alike(const Labels& labels, const Label& a, const Label& b) const {
  if (a.unloaded == b.unloaded) return true;
  for (int c = 0; c < problem_.meters(); ++c) {
    if (put_down(labels, a, c) != put_down(labels, b, c)) return false;
  }
  return true;
}

// Keeps a label unless another covers it.
void StationCalls::add(Labels& labels, Label&& label) {
  const auto begin = labels.all.begin() + layer_;
  const auto covers = [&](const Label& a, const Label& b) {
    return a.usage <= b.usage * (1.0 + kLabelRounding) && a.extra <= b.extra * (1.0 + kLabelRounding) &&
           carry_alike(labels, a, b) && a.frontier.covers(b.frontier);
  };
  if (std::any_of(begin, labels.all.end(), [&](const Label& other) { return covers(other, label); })) return;
  labels.all.erase(std::remove_if(begin, labels.all.end(), [&](const Label& other) { return covers(label, other); }),
                   labels.all.end());
  labels.all.push_back(std::move(label));
  const auto count = labels.all.size() - layer_;
  if (count <= kMostLabels) return;
  // The one that costs most goes, unless it has most energy.
  const auto first = labels.all.begin() + layer_;
  const auto fullest = std::max_element(first, labels.all.end(), [](const Label& a, const Label& b) {
    return a.frontier.last().energy < b.frontier.last().energy;
  });
  auto worst = labels.all.end();
  for (auto each = first; each != labels.all.end(); ++each) {
    const auto cost = [](const Label& one) { return std::pair(one.extra, one.usage); };
    if (each != fullest && (worst == labels.all.end() || cost(*each) > cost(*worst))) worst = each;
  }
  labels.all.erase(worst);
}

}  // namespace muster
