// Places in routes of robots that rest, or may be under way for so long at most.
#include <algorithm>

#include "plans/placement.hpp"

namespace muster {

namespace {

constexpr int kMostDepartures = 100;  // of a route that are tried

}  // namespace

// The first time from `earliest` on that the openings of a unit allow, and from which a robot can work so long without
// a rest.
double Placement::open_to(int unit, int robot, double earliest, double work) const {
  double begin = timeline_.open(unit, earliest);
  while (problem_.rests(robot) && begin < kNever) {
    const double later = problem_.set_out(robot, begin, work);
    if (later == begin) break;
    begin = timeline_.open(unit, later);
  }
  return begin;
}

// The same for all of `team_`.
double Placement::open_to_team(int unit, double earliest) const {
  double begin = timeline_.open(unit, earliest);
  for (bool rises = problem_.has_spans(); rises;) {
    const double before = begin;
    for (const Part& part : team_) begin = open_to(unit, part.offer->robot, begin, works_[part.task]);
    rises = begin > before;
  }
  return begin;
}

// Whether a robot can be at the end of its route with these tasks soon enough after it leaves its start, however late
// it leaves. What holds up others is not looked at, nor calls at stations.
bool Placement::keeps_length(int robot, std::span<const Added> added) const {
  const double most = problem_.lasts_most(robot);
  if (most == kNever) return true;
  double leave = problem_.available_from(robot);
  for (int tried = 0; tried < kMostDepartures; ++tried) {
    const double end = over(robot, added, leave);
    if (end == kNever) return false;
    if (timeline_.in_time(end - most, leave)) return true;
    leave = end - most;
  }
  return false;
}

// When it is there at the earliest if it leaves at a time; never, where its ways and work alone take too long.
double Placement::over(int robot, std::span<const Added> added, double leave) const {
  int place = problem_.start(robot);
  double time = leave, busy = 0.0;
  const auto go_to = [&](int to) {
    const double way = problem_.travel_time(robot, place, to);
    time = problem_.arrives(robot, time, way);
    busy += way;
    place = to;
  };
  const auto go_on = [&](int task, double ready, double work) {
    go_to(task);
    time = open_to(problem_.unit(task), robot, std::max(time, ready), work) + work;
    busy += work;
  };
  auto next = added.begin();
  for (int at = 0; at <= timeline_.tasks_in(robot); ++at) {
    if (at > 0) {
      const Visit& visit = timeline_.stop(robot, at);
      go_on(visit.place, timeline_.ready(visit.unit), timeline_.work_of(visit.place));
    }
    for (; next != added.end() && next->at == at; ++next) go_on(next->task, 0.0, problem_.work_time(robot, next->task));
  }
  if (problem_.must_end(robot)) go_to(problem_.end(robot));
  return timeline_.in_time(busy, problem_.lasts_most(robot)) ? time : kNever;
}

}  // namespace muster
