#include "plans/station_calls.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace muster {

namespace {

constexpr double kCallRounding = 1e-12;
constexpr std::size_t kMostRemembered = 1 << 20;
constexpr int kFewStations = 3;  // of which all pairs are tried on the way to a stop

}  // namespace

void StationCalls::Labels::clear() {
  all.clear();
  at_stop.clear();
  spare.clear();
  loads.clear();
  pending.clear();
}

StationCalls::StationCalls(const Problem& problem)
    : problem_(problem),
      in_time_(problem.objective() == Objective::makespan || problem.objective() == Objective::lateness),
      unloads_(problem.unloads_at_stations()),
      has_few_(problem.stations() <= kFewStations),
      routes_(problem.robots()) {}

bool StationCalls::measure(int robot, std::span<const int> route, std::span<const double> works) {
  Route& own = routes_[robot];
  own.tasks.assign(route.begin(), route.end());
  own.calls.clear();
  own.latest.clear();
  own.labelled = true;
  begin(robot, own.labels);
  own.called = run(robot, own.labels, own.tasks, works);
  if (own.called.usage == kNever) return false;
  trace(robot, own, best_of(robot, own.labels), works);
  return true;
}

void StationCalls::restore(int robot, std::span<const int> route, const Called& called,
                           const std::vector<Call>& calls) {
  Route& own = routes_[robot];
  own.tasks.assign(route.begin(), route.end());
  own.labelled = false;
  own.latest.clear();
  own.called = called;
  own.calls = calls;
}

bool StationCalls::waits(int robot) const {
  return std::ranges::any_of(routes_[robot].calls, [](const Call& call) { return call.waits_s > 0.0; });
}

void StationCalls::forget_waits(int robot) {
  for (Call& call : routes_[robot].calls) call.waits_s = 0.0;
}

Called StationCalls::with_task(int robot, int task, int at, std::span<const double> works) {
  works_ = works;
  label(robot);
  const Route& own = routes_[robot];
  sequence_.assign(1, task);
  sequence_.insert(sequence_.end(), own.tasks.begin() + at, own.tasks.end());
  return try_from(robot, at, works);
}

Called StationCalls::with_pair(int robot, int first, int at, int second, int second_at, std::span<const double> works) {
  works_ = works;
  label(robot);
  const Route& own = routes_[robot];
  sequence_.assign(1, first);
  sequence_.insert(sequence_.end(), own.tasks.begin() + at, own.tasks.begin() + second_at);
  sequence_.push_back(second);
  sequence_.insert(sequence_.end(), own.tasks.begin() + second_at, own.tasks.end());
  return try_from(robot, at, works);
}

// Runs through `sequence_` after so many tasks of the route, from the labels that are known of them; all anew where
// the rest is so much longer than the route's own that the robot may have to call before.
Called StationCalls::try_from(int robot, int at, std::span<const double> works) {
  const Route& own = routes_[robot];
  const int from = at == 0 ? problem_.start(robot) : own.tasks[at - 1];
  const auto behind = std::span<const int>(own.tasks).subspan(at);
  const bool is_known = at < static_cast<int>(own.labels.spare.size());
  const double longer = rest_usage(robot, from, sequence_, works) - rest_usage(robot, from, behind, works);
  if (at == 0 || (is_known && longer <= own.labels.spare[at])) {
    copy_labels(own.labels, at);
  } else {
    sequence_.insert(sequence_.begin(), own.tasks.begin(), own.tasks.begin() + at);
    begin(robot, tried_);
  }
  return run(robot, tried_, sequence_, works);
}

double StationCalls::earliest_leave(int robot, int at, std::span<const double> works) {
  works_ = works;
  label(robot);
  const Labels& labels = routes_[robot].labels;
  if (at >= static_cast<int>(labels.at_stop.size())) return kNever;
  double earliest = kNever;
  for (int k = labels.at_stop[at].first; k < labels.at_stop[at].second; ++k) {
    earliest = std::min(earliest, labels.all[k].frontier.first().time);
  }
  return earliest;
}

double StationCalls::latest_begin(int robot, int at, std::span<const double> works) {
  Route& own = routes_[robot];
  if (own.latest.empty()) {
    const int size = static_cast<int>(own.tasks.size());
    own.latest.resize(size + 1);
    own.latest[size] = problem_.over_by(robot);
    for (int k = size - 1; k >= 0; --k) {
      const int task = own.tasks[k];
      const bool goes_on = k + 1 < size || problem_.must_end(robot);
      const int next = k + 1 < size ? own.tasks[k + 1] : problem_.end(robot);
      const double in = goes_on ? problem_.travel_time(robot, task, next) : 0.0;
      const double latest = std::min(problem_.ends_by(task), own.latest[k + 1] - in) - works[task];
      own.latest[k] = problem_.last_begin(task, latest);
    }
  }
  return own.latest[at];
}

// --- Labels ----------------------------------------------------------------------------------------------------------

// Of a route that was restored labels are found again when they are asked for.
void StationCalls::label(int robot) {
  Route& own = routes_[robot];
  if (std::exchange(own.labelled, true)) return;
  begin(robot, own.labels);
  run(robot, own.labels, own.tasks, works_);
}

void StationCalls::begin(int robot, Labels& labels) {
  labels.clear();
  const double energy = problem_.energy(robot) < kNever ? problem_.energy_at_start(robot) : 0.0;
  labels.all.push_back({0.0, Frontier(problem_.available_from(robot), energy), -1, -1, -1});
  labels.at_stop.emplace_back(0, 1);
  labels.spare.push_back(kNever);
  if (!unloads_) return;
  for (int c = 0; c < problem_.meters(); ++c) {
    labels.loads.push_back(problem_.aboard_at_start(robot, c));
    labels.pending.push_back(problem_.pending_at_start(robot, c));
  }
}

// What is tried goes on from the labels of one stop.
void StationCalls::copy_labels(const Labels& labels, int stop) {
  tried_.clear();
  if (stop >= static_cast<int>(labels.at_stop.size())) {
    tried_.at_stop.assign(stop + 1, {0, 0});
    tried_.spare.assign(stop + 1, kNever);
    return;
  }
  const auto [first, last] = labels.at_stop[stop];
  tried_.all.assign(labels.all.begin() + first, labels.all.begin() + last);
  tried_.at_stop.assign(stop + 1, {0, last - first});
  tried_.spare.assign(stop + 1, labels.spare[stop]);
  if (!unloads_) return;
  const auto kept = static_cast<std::ptrdiff_t>(stop + 1) * problem_.meters();
  tried_.loads.assign(labels.loads.begin(), labels.loads.begin() + kept);
  tried_.pending.assign(labels.pending.begin(), labels.pending.begin() + kept);
}

// From the last stop with labels through the rest of a route.
Called StationCalls::run(int robot, Labels& labels, std::span<const int> rest, std::span<const double> works) {
  works_ = works;
  const int stop = static_cast<int>(labels.at_stop.size()) - 1;
  if (labels.at_stop.back().first == labels.at_stop.back().second) return {kNever, kNever};
  int from = problem_.start(robot);
  if (stop > 0) from = &labels == &tried_ ? routes_[robot].tasks[stop - 1] : from;
  measure_rest(robot, from, rest, works);
  if (problem_.has_gap_most()) measure_gaps(robot, stop, rest, works);
  spare_ = labels.spare.back();
  for (std::size_t k = 0; k < rest.size(); ++k) {
    if (unloads_) carry(robot, labels, rest[k]);
    gap_limit_s_ = problem_.has_gap_most() ? most_gap_s_[k] : kNever;
    if (!cross(robot, labels, from, rest[k], rest_[k], rest_[k + 1])) return {kNever, kNever};
    from = rest[k];
  }
  last_task_ = from;
  gap_limit_s_ = kNever;
  const bool moves = !rest.empty() || stop > 0;
  if (moves && problem_.must_end(robot) && !cross(robot, labels, from, problem_.end(robot), rest_[rest.size()], 0.0)) {
    return {kNever, kNever};
  }
  const int best = best_of(robot, labels);
  const Label& last = labels.all[best];
  if (moves && last.frontier.first().time > problem_.over_by(robot) * (1.0 + kCallRounding)) return {kNever, kNever};
  const double end_s = ends_before_return(robot) && moves ? last.extra : last.frontier.first().time;
  return {last.usage, end_s, last.extra};
}

// How long the way to each task of the rest may take: a task that must begin shortly after an earlier one of the route
// leaves little time for calls between the two.
void StationCalls::measure_gaps(int robot, int stop, std::span<const int> rest, std::span<const double> works) {
  std::vector<int> tasks(routes_[robot].tasks.begin(), routes_[robot].tasks.begin() + stop);
  tasks.insert(tasks.end(), rest.begin(), rest.end());
  offsets_.assign(tasks.size(), 0.0);  // when each would begin if the robot never waited or called
  const auto way = [&](std::size_t k) { return problem_.travel_time(robot, tasks[k - 1], tasks[k]); };
  for (std::size_t k = 1; k < tasks.size(); ++k) offsets_[k] = offsets_[k - 1] + works[tasks[k - 1]] + way(k);
  most_gap_s_.assign(rest.size(), kNever);
  for (std::size_t k = 1; k < tasks.size(); ++k) {
    const auto before = problem_.prerequisites(tasks[k]);
    for (std::size_t b = 0; b < before.size(); ++b) {
      const double within = problem_.gap_most(tasks[k], static_cast<int>(b));
      const auto from = static_cast<std::size_t>(
          std::find(tasks.begin(), tasks.begin() + static_cast<std::ptrdiff_t>(k), before[b]) - tasks.begin());
      if (within == kNever || from == k) continue;
      const double slack = within - (offsets_[k] - offsets_[from] - works[tasks[from]]);
      for (std::size_t gap = std::max(from + 1, static_cast<std::size_t>(stop)); gap <= k; ++gap) {
        double& most = most_gap_s_[gap - stop];
        most = std::min(most, way(gap) + slack);
      }
    }
  }
}

void StationCalls::measure_rest(int robot, int from, std::span<const int> rest, std::span<const double> works) {
  rest_.assign(rest.size() + 1, 0.0);
  const int last = rest.empty() ? from : rest.back();
  if (!rest.empty() || from != problem_.start(robot)) rest_.back() = problem_.end_usage(robot, last);
  for (std::size_t k = rest.size(); k-- > 0;) {
    const int before = k == 0 ? from : rest[k - 1];
    rest_[k] = rest_[k + 1] + problem_.travel_usage(robot, before, rest[k]) + work_usage(robot, rest[k], works);
  }
}

// What is used from a place to the end of a route by way of the rest of its tasks, without calls.
double StationCalls::rest_usage(int robot, int from, std::span<const int> rest, std::span<const double> works) const {
  double usage = 0.0;
  for (const int task : rest) {
    usage += problem_.travel_usage(robot, from, task) + work_usage(robot, task, works);
    from = task;
  }
  return from == problem_.start(robot) ? usage : usage + problem_.end_usage(robot, from);
}

double StationCalls::work_usage(int robot, int task, std::span<const double> works) const {
  if (!problem_.usage_is_time()) return problem_.work_usage(robot, task);
  return std::max(works[task], problem_.work_time(robot, task));
}

// What is on board after one more stop, as if the robot never unloaded.
void StationCalls::carry(int, Labels& labels, int task) const {
  const int meters = problem_.meters();
  const std::size_t before = labels.loads.size() - meters;
  for (int c = 0; c < meters; ++c) {
    labels.loads.push_back(labels.loads[before + c] + problem_.load(task, c));
    labels.pending.push_back(labels.pending[before + c] + problem_.pending(task, c));
  }
}

// The best within the limits of the robot, if any is.
int StationCalls::best_of(int robot, const Labels& labels) const {
  const auto [first, last] = labels.at_stop.back();
  int best = first;
  const auto key = [&](int k) {
    const Label& label = labels.all[k];
    const double time = label.frontier.first().time;
    const bool above = !problem_.fits(robot, label.usage) || time > problem_.over_by(robot) * (1.0 + kCallRounding);
    return in_time_ ? std::tuple(above, label.extra, time, label.usage)
                    : std::tuple(above, label.extra, label.usage, time);
  };
  for (int k = first + 1; k < last; ++k) {
    if (key(k) < key(best)) best = k;
  }
  return best;
}

// Whether the objective counts no time after the last task, and the robot may refill then.
bool StationCalls::ends_before_return(int robot) const {
  return problem_.objective() == Objective::makespan && !problem_.makespan_includes_return() &&
         problem_.must_end(robot) && problem_.over_by(robot) == kNever;
}

// What a robot needs where it leaves its last task, to go on to its end by way of this label.
double StationCalls::needed_after_work(int robot, const Labels& labels, int last) const {
  double needed = 0.0;
  int next = problem_.end(robot);
  for (int k = last; labels.all[k].station >= 0; k = labels.all[k].parent) {
    const Station& station = problem_.station(labels.all[k].station);
    const int place = problem_.place_of_station(labels.all[k].station);
    needed = station.gives_energy() ? 0.0 : needed + problem_.travel_usage(robot, place, next);
    next = place;
  }
  return needed + problem_.travel_usage(robot, last_task_, next);
}

// The last task's label before the end.
const Frontier& StationCalls::after_work(const Labels& labels, int last) {
  int k = last;
  while (labels.all[k].station >= 0) k = labels.all[k].parent;
  return labels.all[k].frontier;
}

// --- Stations --------------------------------------------------------------------------------------------------------

bool StationCalls::serves(int robot, int number) const {
  const Station& station = problem_.station(number);
  const bool is_of_use = (problem_.energy(robot) < kNever && station.gives_energy()) || (unloads_ && station.unloads);
  return is_of_use && problem_.may_call(robot, number);
}

// The least usage from a place to a station with energy.
double StationCalls::least_onward(int robot, int from) const {
  double least = kNever;
  for (int k = 0; k < problem_.stations(); ++k) {
    if (!problem_.station(k).gives_energy() || !problem_.may_call(robot, k)) continue;
    least = std::min(least, problem_.travel_usage(robot, from, problem_.place_of_station(k)));
  }
  return least;
}

// The stations between two places but those to and from which the ways are longer than by another of the same kind.
std::span<const int> StationCalls::stations_between(int robot, int from, int to) {
  const auto places = static_cast<std::uint64_t>(problem_.place_of_station(problem_.stations()));
  const bool energy = problem_.energy(robot) < kNever;
  const auto robots = static_cast<std::uint64_t>(problem_.robots() + 1);
  const auto who = static_cast<std::uint64_t>(problem_.has_call_limits() ? robot + 1 : 0);
  const auto kind = (static_cast<std::uint64_t>(problem_.travel_class(robot)) * 2 + energy) * robots + who;
  const auto key = (kind * places + from) * places + to;
  if (between_.size() > kMostRemembered) between_.clear();
  const auto [found, is_new] = between_.try_emplace(key);
  if (!is_new) return found->second;
  const int table = problem_.travel_class(robot);
  const auto ways = [&](int station) {
    const int place = problem_.place_of_station(station);
    return std::pair(problem_.distance(table, from, place), problem_.distance(table, place, to));
  };
  const auto beats = [&](int a, int b) {
    const Station &one = problem_.station(a), &other = problem_.station(b);
    const bool serves_as_well = one.refill >= other.refill && one.partial == other.partial &&
                                one.swap_s == other.swap_s && one.unloads == other.unloads && one.slots >= other.slots;
    const auto [in, out] = ways(a);
    const auto [in_other, out_other] = ways(b);
    if (!serves_as_well || in > in_other || out > out_other) return false;
    return in < in_other || out < out_other || one.refill > other.refill || a < b;
  };
  for (int station = 0; station < problem_.stations(); ++station) {
    if (!serves(robot, station)) continue;
    bool beaten = false;
    const bool keeps_all = has_few_ || problem_.has_queues();
    for (int other = 0; other < problem_.stations() && !beaten && !keeps_all; ++other) {
      beaten = other != station && serves(robot, other) && beats(other, station);
    }
    if (!beaten) found->second.push_back(station);
  }
  return found->second;
}

}  // namespace muster
