// What robots carry on their routes, and where they call at stations.
#include <algorithm>
#include <tuple>
#include <vector>

#include "plans/roster.hpp"

namespace muster {

const std::vector<int>& Roster::tasks_of(int robot) {
  tasks_.clear();
  for (int at = 1; at <= timeline_.tasks_in(robot); ++at) tasks_.push_back(timeline_.stop(robot, at).place);
  return tasks_;
}

// The load after each stop, and the most and the least from there on. Where robots unload at stations, what is on board
// depends on that, and `StationCalls` looks to it.
bool Roster::measure_loads(int robot) {
  const int meters = problem_.meters(), size = timeline_.tasks_in(robot);
  if (meters == 0) return true;
  auto &loads = loads_[robot], &highest = highest_[robot], &lowest = lowest_[robot];
  loads.resize(static_cast<std::size_t>(size + 1) * meters);
  for (int c = 0; c < meters; ++c) loads[index(0, c)] = problem_.aboard_at_start(robot, c);
  for (int at = 1; at <= size; ++at) {
    const int task = timeline_.stop(robot, at).place;
    for (int c = 0; c < meters; ++c) loads[index(at, c)] = loads[index(at - 1, c)] + problem_.load(task, c);
  }
  highest = lowest = loads;
  for (int at = size - 1; at >= 0; --at) {
    for (int c = 0; c < meters; ++c) {
      highest[index(at, c)] = std::max(highest[index(at, c)], highest[index(at + 1, c)]);
      lowest[index(at, c)] = std::min(lowest[index(at, c)], lowest[index(at + 1, c)]);
    }
  }
  if (problem_.unloads_at_stations()) return true;
  for (int c = 0; c < meters; ++c) {
    if (!problem_.carries(robot, c, highest[index(0, c)]) || !problem_.carries(robot, c, lowest[index(0, c)]))
      return false;
  }
  return true;
}

bool Roster::call_at_stations(int robot) {
  if (!calls_ || !problem_.may_run_short(robot)) return true;
  if (!calls_->measure(robot, tasks_of(robot), timeline_.works())) return false;
  if (!calls_->calls(robot).empty()) usage_[robot] = calls_->usage(robot);
  set_ways(robot, false);
  return true;
}

// Sets the time of each way of a route, with its calls; where the route is `restored` its times are those already.
void Roster::set_ways(int robot, bool restored) {
  const auto& calls = calls_->calls(robot);
  std::size_t next = 0;
  for (int at = 1; at <= timeline_.tasks_in(robot) + 1; ++at) {
    const Visit& visit = timeline_.stop(robot, at);
    WayIn way;
    int place = timeline_.stop(robot, at - 1).place;
    for (; next < calls.size() && calls[next].at == at - 1; ++next) {
      const Call& call = calls[next];
      const int there = problem_.place_of_station(call.station);
      const double leg = problem_.travel_time(robot, place, there);
      way.seconds += leg + call.waits_s + call.takes_s;
      if (problem_.rests(robot)) way.legs.push_back({leg, call.waits_s + call.takes_s});
      place = there;
    }
    const bool goes_there = visit.unit >= 0 || problem_.must_end(robot);
    const double last = goes_there ? problem_.travel_time(robot, place, visit.place) : 0.0;
    way.seconds += last;
    if (!way.legs.empty()) way.last = last;
    if (restored) {
      timeline_.restore_way(robot, at, way);
    } else {
      timeline_.set_way(robot, at, way);
    }
  }
}

void Roster::add_calls(int robot, int at, std::vector<StopTimes>& stops) const {
  if (!calls_) return;
  int place = timeline_.stop(robot, at - 1).place;
  double time = timeline_.leave(robot, at - 1);
  for (const Call& call : calls_->calls(robot)) {
    if (call.at != at - 1) continue;
    const int there = problem_.place_of_station(call.station);
    const double arrive = problem_.arrives(robot, time, problem_.travel_time(robot, place, there));
    const double begin = arrive + call.waits_s;
    stops.push_back({there, arrive, begin, begin + call.takes_s, call.refilled});
    time = begin + call.takes_s;
    place = there;
  }
}

// Lets each station serve in order of arrival, ties by robot. Calls are looked at in order of time, as one that waits
// makes only what comes after it later. False: something is too late then.
bool Roster::serve() {
  if (!calls_ || !problem_.has_queues()) return true;
  bool waited = false;
  for (int robot = 0; robot < problem_.robots(); ++robot) waited |= calls_->waits(robot);
  if (!waited && !crowded()) return true;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (!calls_->waits(robot)) continue;
    touch(robot);
    calls_->forget_waits(robot);
    set_ways(robot, false);
  }
  unmeasured_.clear();
  if (!timeline_.settle_begins()) return false;
  std::vector<std::size_t> next(problem_.robots(), 0);
  std::vector<std::vector<double>> busy(problem_.stations());  // by station, until when its slots are
  for (;;) {
    std::tuple<double, int> first{kNever, -1};
    for (int robot = 0; robot < problem_.robots(); ++robot) {
      if (next[robot] < calls_->calls(robot).size()) first = std::min(first, {arrival(robot, next[robot]), robot});
    }
    const auto [arrives, robot] = first;
    if (robot < 0) return true;
    const Call& call = calls_->calls(robot)[next[robot]];
    auto& slots = busy[call.station];
    slots.resize(problem_.station(call.station).slots, -kNever);
    auto& slot = *std::ranges::min_element(slots);
    const double begin = std::max(arrives, slot);
    if (call.takes_s > 0.0) slot = begin + call.takes_s;
    if (begin > arrives) {
      touch(robot);
      unmeasured_.clear();
      calls_->wait(robot, next[robot], begin - arrives);
      set_ways(robot, false);
      if (!timeline_.settle_begins()) return false;
    }
    ++next[robot];
  }
}

// When a robot arrives at its call of this number.
double Roster::arrival(int robot, std::size_t number) const {
  const auto& calls = calls_->calls(robot);
  const int at = calls[number].at;
  int place = timeline_.stop(robot, at).place;
  double time = timeline_.leave(robot, at);
  for (std::size_t k = 0; k <= number; ++k) {
    if (calls[k].at != at) continue;
    const int there = problem_.place_of_station(calls[k].station);
    time = problem_.arrives(robot, time, problem_.travel_time(robot, place, there));
    if (k < number) time += calls[k].waits_s + calls[k].takes_s;
    place = there;
  }
  return time;
}

// Whether at any time more robots are at a station than it serves.
bool Roster::crowded() const {
  std::vector<std::tuple<int, double, int>> changes;  // station, time, -1 where one leaves
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    const auto& calls = calls_->calls(robot);
    for (std::size_t k = 0; k < calls.size(); ++k) {
      if (calls[k].takes_s == 0.0) continue;
      const double begin = arrival(robot, k) + calls[k].waits_s;
      changes.emplace_back(calls[k].station, begin, 1);
      changes.emplace_back(calls[k].station, begin + calls[k].takes_s, -1);
    }
  }
  std::ranges::sort(changes);
  int station = -1, there = 0;
  for (const auto& [at, time, change] : changes) {
    if (at != station) there = 0;
    station = at;
    there += change;
    if (there > problem_.station(at).slots) return true;
  }
  return false;
}

}  // namespace muster
