#include "station_calls.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace muster {

namespace {

constexpr double kRounding = 1e-12;
constexpr std::size_t kMostLabels = 32;  // at a stop
constexpr std::size_t kMostRemembered = 1 << 20;
constexpr int kFewStations = 3;  // of which all pairs are tried on the way to a stop

}  // namespace

void StationCalls::Labels::clear() {
  all.clear();
  at_stop.clear();
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
  copy_labels(own.labels, at);
  return run(robot, tried_, sequence_, works);
}

Called StationCalls::with_pair(int robot, int first, int at, int second, int second_at, std::span<const double> works) {
  works_ = works;
  label(robot);
  const Route& own = routes_[robot];
  sequence_.assign(1, first);
  sequence_.insert(sequence_.end(), own.tasks.begin() + at, own.tasks.begin() + second_at);
  sequence_.push_back(second);
  sequence_.insert(sequence_.end(), own.tasks.begin() + second_at, own.tasks.end());
  copy_labels(own.labels, at);
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
    own.latest[size] = problem_.available_until(robot);
    for (int k = size - 1; k >= 0; --k) {
      const int task = own.tasks[k];
      const bool goes_on = k + 1 < size || problem_.must_end(robot);
      const int next = k + 1 < size ? own.tasks[k + 1] : problem_.end(robot);
      const double in = goes_on ? problem_.travel_time(robot, task, next) : 0.0;
      const double latest = std::min(problem_.deadline(task), own.latest[k + 1] - in) - works[task];
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
  const double energy = problem_.battery(robot) < kNever ? problem_.battery_at_start(robot) : 0.0;
  labels.all.push_back({0.0, Frontier(problem_.available_from(robot), energy), -1, -1, -1});
  labels.at_stop.emplace_back(0, 1);
  if (!unloads_) return;
  for (int c = 0; c < problem_.commodities(); ++c) {
    labels.loads.push_back(problem_.load_at_start(robot, c));
    labels.pending.push_back(problem_.pending_at_start(robot, c));
  }
}

// What is tried goes on from the labels of one stop.
void StationCalls::copy_labels(const Labels& labels, int stop) {
  tried_.clear();
  if (stop >= static_cast<int>(labels.at_stop.size())) {
    tried_.at_stop.assign(stop + 1, {0, 0});
    return;
  }
  const auto [first, last] = labels.at_stop[stop];
  tried_.all.assign(labels.all.begin() + first, labels.all.begin() + last);
  tried_.at_stop.assign(stop + 1, {0, last - first});
  if (!unloads_) return;
  const auto kept = static_cast<std::ptrdiff_t>(stop + 1) * problem_.commodities();
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
  for (std::size_t k = 0; k < rest.size(); ++k) {
    if (unloads_) carry(robot, labels, rest[k]);
    if (!cross(robot, labels, from, rest[k], rest_[k], rest_[k + 1])) return {kNever, kNever};
    from = rest[k];
  }
  last_task_ = from;
  const bool moves = !rest.empty() || stop > 0;
  if (moves && problem_.must_end(robot) && !cross(robot, labels, from, problem_.end(robot), rest_[rest.size()], 0.0)) {
    return {kNever, kNever};
  }
  const int best = best_of(robot, labels);
  const Label& last = labels.all[best];
  if (moves && last.frontier.first().time > problem_.available_until(robot) * (1.0 + kRounding))
    return {kNever, kNever};
  const double end_s = ends_before_return(robot) && moves ? last.extra : last.frontier.first().time;
  return {last.usage, end_s, last.extra};
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

double StationCalls::work_usage(int robot, int task, std::span<const double> works) const {
  if (!problem_.usage_is_time()) return problem_.work_usage(robot, task);
  return std::max(works[task], problem_.work_time(robot, task));
}

// What is on board after one more stop, as if the robot never unloaded.
void StationCalls::carry(int, Labels& labels, int task) const {
  const int commodities = problem_.commodities();
  const std::size_t before = labels.loads.size() - commodities;
  for (int c = 0; c < commodities; ++c) {
    labels.loads.push_back(labels.loads[before + c] + problem_.load(task, c));
    labels.pending.push_back(labels.pending[before + c] + problem_.pending(task, c));
  }
}

// Labels of the next stop from those of the last one: directly, and by way of stations. False: there are none.
bool StationCalls::cross(int robot, Labels& labels, int from, int to, double rest_before, double rest_after) {
  const auto [first, last] = labels.at_stop.back();
  const bool is_task = to < problem_.tasks();
  layer_ = static_cast<int>(labels.all.size());
  current_.clear();
  // Labels of stations stand before those of the stop.
  for (int parent = first; parent < last; ++parent) {
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
  settle();
  for (int depth = has_few_ ? 2 : 1; depth <= problem_.stations(); ++depth) {
    const bool well = std::any_of(labels.all.begin() + layer_, labels.all.end(), [&](const Label& label) {
      return label.frontier.last().energy >= needed * (1.0 - kRounding);
    });
    if (well || current_.empty()) break;
    labels.all.resize(layer_);
    call_again(robot, labels, to, beyond);
    settle();
  }
  labels.at_stop.emplace_back(layer_, static_cast<int>(labels.all.size()));
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
      if (station == last || !serves(robot, problem_.station(station))) continue;
      const int called = call(robot, labels, parent, place, station);
      if (called >= 0) deeper_.push_back(called);
    }
  }
  if (deeper_.size() > kMostLabels * 4) deeper_.resize(kMostLabels * 4);
  current_ = deeper_;
  places_.insert(places_.end(), current_.begin(), current_.end());
}

// Whether a robot with this label cannot do the rest of the route without a call.
bool StationCalls::runs_short(int robot, const Labels& labels, const Label& label, double rest) const {
  if (problem_.battery(robot) < kNever && label.frontier.first().energy < rest) return true;
  return unloads_ && !labels.loads.empty();
}

// A label at a task once the work is done, or at the end.
bool StationCalls::arrive(int robot, Labels& labels, int parent, int from, int to, double rest_after) {
  Label label = labels.all[parent];
  const bool drains = problem_.battery(robot) < kNever;
  const double way = problem_.travel_usage(robot, from, to);
  if (!std::isfinite(way)) return false;
  const double slack = drains ? -kRounding * problem_.battery(robot) : -kNever;
  label.usage += way;
  label.parent = parent;
  label.station = -1;
  label.frontier.shift(problem_.travel_time(robot, from, to), drains ? way : 0.0);
  if (drains) label.frontier.keep_from(slack);
  if (label.frontier.empty()) return false;
  if (to >= problem_.tasks()) {
    label.frontier.keep_to(problem_.available_until(robot) * (1.0 + kRounding));
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
  const double latest = problem_.deadline(to) - takes;
  bool any = false;
  // In each of its windows; in a later one there is more time to charge before.
  for (double from_s = label.frontier.first().time;;) {
    const double opens = problem_.next_begin(to, from_s);
    if (opens > latest * (1.0 + kRounding) || opens == kNever) return any;
    Label done = label;
    const double closes = problem_.last_begin_of_window(to, opens);
    // Who charges for as long as there is time is not late by rounding.
    done.frontier.wait_until(opens);
    done.frontier.keep_to(std::max(std::min(closes, latest) * (1.0 - kRounding), opens));
    done.frontier.shift(takes, drains ? usage : 0.0);
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
  const double way = problem_.travel_usage(robot, from, place), full = problem_.battery(robot);
  if (!std::isfinite(way)) return -1;
  label.usage += way;
  label.parent = parent;
  label.station = number;
  const bool drains = full < kNever;
  label.frontier.shift(problem_.travel_time(robot, from, place), drains ? way : 0.0);
  if (drains) label.frontier.keep_from(-kRounding * full);
  if (label.frontier.empty() || !changes(robot, labels, label, station)) return -1;
  if (drains && station.swap_s >= 0.0) {
    label.frontier = Frontier(label.frontier.first().time + station.swap_s, full);
  } else if (drains && station.charge > 0.0 && station.partial) {
    label.frontier.charge(station.charge, full);
  } else if (drains && station.charge > 0.0) {
    label.frontier.fill(station.charge, full);
  }
  if (unloads_ && station.unloads) label.unloaded = static_cast<int>(labels.at_stop.size()) - 1;
  labels.all.push_back(std::move(label));
  return static_cast<int>(labels.all.size()) - 1;
}

// Whether anything is different after a visit of a station.
bool StationCalls::changes(int robot, const Labels& labels, const Label& label, const Station& station) const {
  const double full = problem_.battery(robot);
  if (full < kNever && station.gives_energy() && label.frontier.first().energy < full) return true;
  return unloads_ && station.unloads && label.unloaded != static_cast<int>(labels.at_stop.size()) - 1;
}

// Whether a load is above what the robot carries, or below nothing, after a stop.
bool StationCalls::overloaded(int robot, const Labels& labels, const Label& label, int stop) const {
  const int commodities = problem_.commodities();
  for (int c = 0; c < commodities; ++c) {
    const auto at = [&](int k) { return static_cast<std::size_t>(k) * commodities + c; };
    double load = labels.loads[at(stop)];
    if (label.unloaded >= 0) load -= labels.loads[at(label.unloaded)] - labels.pending[at(label.unloaded)];
    if (!problem_.carries(robot, c, load)) return true;
  }
  return false;
}

// Keeps a label unless another covers it.
void StationCalls::add(Labels& labels, Label&& label) {
  const auto begin = labels.all.begin() + layer_;
  const auto covers = [&](const Label& a, const Label& b) {
    return a.usage <= b.usage * (1.0 + kRounding) && a.extra <= b.extra * (1.0 + kRounding) &&
           a.unloaded == b.unloaded && a.frontier.covers(b.frontier);
  };
  if (std::any_of(begin, labels.all.end(), [&](const Label& other) { return covers(other, label); })) return;
  labels.all.erase(std::remove_if(begin, labels.all.end(), [&](const Label& other) { return covers(label, other); }),
                   labels.all.end());
  labels.all.push_back(std::move(label));
  const auto count = labels.all.size() - layer_;
  if (count <= kMostLabels) return;
  // The one that used most goes, unless it has most energy.
  const auto first = labels.all.begin() + layer_;
  const auto fullest = std::max_element(first, labels.all.end(), [](const Label& a, const Label& b) {
    return a.frontier.last().energy < b.frontier.last().energy;
  });
  auto worst = labels.all.end();
  for (auto each = first; each != labels.all.end(); ++each) {
    if (each != fullest && (worst == labels.all.end() || each->usage > worst->usage)) worst = each;
  }
  labels.all.erase(worst);
}

// The best within the robot's capacity, if any is.
int StationCalls::best_of(int robot, const Labels& labels) const {
  const auto [first, last] = labels.at_stop.back();
  int best = first;
  const auto key = [&](int k) {
    const Label& label = labels.all[k];
    const double time = label.frontier.first().time;
    const bool above = !problem_.fits(robot, label.usage);
    return in_time_ ? std::tuple(above, label.extra, time, label.usage)
                    : std::tuple(above, label.extra, label.usage, time);
  };
  for (int k = first + 1; k < last; ++k) {
    if (key(k) < key(best)) best = k;
  }
  return best;
}

// Whether the objective counts no time after the last task, and the robot may charge then.
bool StationCalls::ends_before_return(int robot) const {
  return problem_.objective() == Objective::makespan && !problem_.makespan_includes_return() &&
         problem_.must_end(robot) && problem_.available_until(robot) == kNever;
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

bool StationCalls::serves(int robot, const Station& station) const {
  return (problem_.battery(robot) < kNever && station.gives_energy()) || (unloads_ && station.unloads);
}

// The least usage from a place to a station with energy.
double StationCalls::least_onward(int robot, int from) const {
  double least = kNever;
  for (int k = 0; k < problem_.stations(); ++k) {
    if (!problem_.station(k).gives_energy()) continue;
    least = std::min(least, problem_.travel_usage(robot, from, problem_.place_of_station(k)));
  }
  return least;
}

// The stations between two places but those to and from which the ways are longer than by another of the same kind.
std::span<const int> StationCalls::stations_between(int robot, int from, int to) {
  const auto places = static_cast<std::uint64_t>(problem_.place_of_station(problem_.stations()));
  const bool energy = problem_.battery(robot) < kNever;
  const auto key =
      ((static_cast<std::uint64_t>(problem_.travel_class(robot)) * 2 + energy) * places + from) * places + to;
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
    const bool serves_as_well = one.charge >= other.charge && one.partial == other.partial &&
                                one.swap_s == other.swap_s && one.unloads == other.unloads && one.slots >= other.slots;
    const auto [in, out] = ways(a);
    const auto [in_other, out_other] = ways(b);
    if (!serves_as_well || in > in_other || out > out_other) return false;
    return in < in_other || out < out_other || one.charge > other.charge || a < b;
  };
  for (int station = 0; station < problem_.stations(); ++station) {
    if (!serves(robot, problem_.station(station))) continue;
    bool beaten = false;
    const bool keeps_all = has_few_ || problem_.has_queues();
    for (int other = 0; other < problem_.stations() && !beaten && !keeps_all; ++other) {
      beaten = other != station && beats(other, station);
    }
    if (!beaten) found->second.push_back(station);
  }
  return found->second;
}

// --- Calls -----------------------------------------------------------------------------------------------------------

// Goes back from the last label: how much energy the robot needs where it leaves a station, and by when.
void StationCalls::trace(int robot, Route& route, int best, std::span<const double> works) {
  const Labels& labels = route.labels;
  const bool drains = problem_.battery(robot) < kNever;
  int position = static_cast<int>(labels.at_stop.size()) - 1;  // of the stop that the label is at, or goes to
  const int size = static_cast<int>(route.tasks.size());
  const auto place_of_stop = [&](int k) {
    return k == 0 ? problem_.start(robot) : k <= size ? route.tasks[k - 1] : problem_.end(robot);
  };
  struct Left {
    Call call;
    double level;
  };
  std::vector<Left> left;
  Frontier::Point target = labels.all[best].frontier.first();
  for (int k = best; labels.all[k].parent >= 0; k = labels.all[k].parent) {
    const Label &label = labels.all[k], &parent = labels.all[label.parent];
    const int to = label.station >= 0 ? problem_.place_of_station(label.station) : place_of_stop(position);
    const int from = parent.station >= 0 ? problem_.place_of_station(parent.station)
                                         : place_of_stop(label.station >= 0 ? position : position - 1);
    const double way = drains ? problem_.travel_usage(robot, from, to) : 0.0;
    const double seconds = problem_.travel_time(robot, from, to);
    Frontier arrival = parent.frontier;
    arrival.shift(seconds, way);
    if (drains) arrival.keep_from(-kRounding * problem_.battery(robot));
    if (label.station >= 0) {
      const Station& station = problem_.station(label.station);
      left.push_back({{position, label.station, 0.0, 0.0, 0.0}, target.energy});
      if (drains && station.charge > 0.0 && station.partial) {
        const Frontier::Point corner = arrival.corner(station.charge);
        if (target.time >= corner.time) target = corner;
      } else if (drains && station.charge > 0.0) {
        left.back().level = problem_.battery(robot);
        target = arrival.corner(station.charge);
      } else if (drains && station.swap_s >= 0.0) {
        left.back().level = problem_.battery(robot);
        target = arrival.first();
      }
    } else {
      if (to < problem_.tasks()) {
        target.time -= std::max(works[to], problem_.work_time(robot, to));
        target.energy += drains ? work_usage(robot, to, works) : 0.0;
      }
      const double time = arrival.time_of(target.energy);
      target = {std::min(time, target.time), std::max(target.energy, arrival.energy_at(std::min(time, target.time)))};
      --position;
    }
    target.time -= seconds;
    target.energy += way;
    if (parent.station < 0 && position == size && ends_before_return(robot)) {
      // What is charged on the way to the end makes nothing later.
      const double needed = drains ? needed_after_work(robot, labels, labels.all[best].parent) : 0.0;
      target.time = parent.frontier.time_of(needed);
      target.energy = std::max(needed, parent.frontier.energy_at(target.time));
    }
  }
  std::ranges::reverse(left);
  // Forward again, as a level may be above what is needed.
  double level = drains ? problem_.battery_at_start(robot) : 0.0;
  std::size_t next = 0;
  int place = problem_.start(robot);
  for (int k = 0; k <= size; ++k) {
    for (; next < left.size() && left[next].call.at == k; ++next) {
      Call call = left[next].call;
      const Station& station = problem_.station(call.station);
      const int there = problem_.place_of_station(call.station);
      if (drains) level -= problem_.travel_usage(robot, place, there);
      if (drains && station.gives_energy()) {
        const double full = problem_.battery(robot);
        double to_level = std::min(full, left[next].level);
        if (full - to_level < 1e-9 * full) to_level = full;
        call.charged = std::max(0.0, to_level - level);
        call.takes_s = station.swap_s >= 0.0 ? station.swap_s : call.charged / station.charge;
        level += call.charged;
      }
      route.calls.push_back(call);
      place = there;
    }
    if (k == size || !drains) {
      if (k < size) place = route.tasks[k];
      continue;
    }
    level -= problem_.travel_usage(robot, place, route.tasks[k]) + work_usage(robot, route.tasks[k], works);
    place = route.tasks[k];
  }
}

std::vector<double> usage_with_calls(const Problem& problem, std::span<const int> pickups) {
  StationCalls calls(problem);
  const std::vector<double> works(problem.tasks(), 0.0);
  std::vector<int> delivery(problem.tasks(), -1);
  for (int task = 0; task < problem.tasks(); ++task) {
    if (pickups[task] >= 0) delivery[pickups[task]] = task;
  }
  std::vector<double> usages;
  for (int robot = 0; robot < problem.robots(); ++robot) {
    for (int task = 0; task < problem.tasks(); ++task) {
      std::vector<int> route;
      if (pickups[task] >= 0) route.push_back(pickups[task]);
      route.push_back(task);
      if (delivery[task] >= 0) route.push_back(delivery[task]);
      calls.measure(robot, route, works);
      usages.push_back(calls.usage(robot));
    }
  }
  return usages;
}

}  // namespace muster
