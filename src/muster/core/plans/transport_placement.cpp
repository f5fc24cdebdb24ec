// Where a transport costs least: a task that takes something on board, and the one that delivers it, by one robot.
#include <algorithm>

#include "plans/placement.hpp"

namespace muster {

namespace {

constexpr long kMostPairs = 40'000;  // of places; beyond it only robots near one of the two tasks are tried
constexpr int kNearTasks = 24;

}  // namespace

bool Placement::best_transport(int pickup, int delivery, const Trial& trial) {
  const int unit = problem_.unit(pickup), second = problem_.unit(delivery);
  trial_ = &trial;
  best_ = UnitInsertion{};
  best_.unit = unit;
  labels_ = roster_.timeline_.labels_for(unit);
  second_labels_ = roster_.timeline_.labels_for(second);
  if (labels_.empty() || second_labels_.empty()) return false;
  if (std::ranges::find(problem_.apart(pickup), delivery) != problem_.apart(pickup).end()) return false;
  ready_ = timeline_.ready(unit);
  second_ready_ = timeline_.ready(second);
  peak_ = roster_.peak();
  const auto before = problem_.prerequisites(delivery);
  const auto gap = std::ranges::find(before, pickup) - before.begin();
  after_ = gap < std::ssize(before) ? problem_.gap_least(delivery, static_cast<int>(gap)) : 0.0;
  within_ = gap < std::ssize(before) ? problem_.gap_most(delivery, static_cast<int>(gap)) : kNever;
  may_transport_.assign(problem_.robots(), 1);
  for (const int each : {second, unit}) {  // the first last, whose relations stay known
    relations_.look_at(each, trial.robots);
    for (int robot = 0; robot < problem_.robots(); ++robot) {
      may_transport_[robot] = may_transport_[robot] && relations_.team_size(0) <= 1 && relations_.allows(0, robot) &&
                              problem_.allowed(robot, problem_.tasks_of_unit(each).front());
    }
  }
  find_empty_twins();
  for (int robot = 0; robot < problem_.robots(); ++robot) may_transport_[robot] &= !is_second_twin(robot);
  keep_to_near_robots(pickup, delivery);
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (may_transport_[robot]) try_transport_with(robot, pickup, delivery);
  }
  judge_candidates();
  return !best_.members.empty();
}

// Of a large team the robots whose routes pass near one of the tasks, or that start there.
void Placement::keep_to_near_robots(int pickup, int delivery) {
  if (trial_->most_places == 0) return;
  long pairs = 0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    const long stops = timeline_.tasks_in(robot) + 1;
    if (may_transport_[robot]) pairs += stops * stops / 2;
  }
  if (pairs <= kMostPairs) return;
  std::vector<char> near(problem_.robots(), 0);
  for (const int task : {pickup, delivery}) {
    int seen = 0;
    for (const int other : trial_->neighbours->of(task)) {
      for (const int number : timeline_.visits_of(problem_.unit(other))) near[timeline_.visit(number).robot] = 1;
      if (++seen >= kNearTasks) break;
    }
    for (const int robot : trial_->neighbours->robots(task)) near[robot] = 1;
  }
  for (int robot = 0; robot < problem_.robots(); ++robot) may_transport_[robot] = may_transport_[robot] && near[robot];
}

void Placement::try_transport_with(int robot, int pickup, int delivery) {
  const double work = problem_.work_time(robot, pickup), second_work = problem_.work_time(robot, delivery);
  latest_ = timeline_.latest_for(problem_.unit(pickup), {&work, 1});
  second_latest_ = timeline_.latest_for(problem_.unit(delivery), {&second_work, 1});
  if (problem_.objective() == Objective::makespan) {
    tail_ = timeline_.tail_after(problem_.unit(pickup), {&work, 1});
    second_tail_ = timeline_.tail_after(problem_.unit(delivery), {&second_work, 1});
  }
  for (int at = problem_.fixed(robot); at <= timeline_.tasks_in(robot); ++at) {
    if (timeline_.stop(robot, at).label >= labels_.high || !timeline_.in_time(leave(robot, at), latest_)) break;
    if (timeline_.stop(robot, at + 1).label > labels_.low && !overlooked()) try_pickup_at(robot, at, pickup, delivery);
  }
}

void Placement::try_pickup_at(int robot, int at, int pickup, int delivery) {
  const Visit &last = timeline_.stop(robot, at), &next = timeline_.stop(robot, at + 1);
  Walk walk{robot, pickup, delivery, at, pickup, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const double there = problem_.arrives(robot, leave(robot, at), problem_.travel_time(robot, last.place, pickup));
  walk.pickup_begin = open_to(problem_.unit(pickup), robot, std::max(ready_, there), problem_.work_time(robot, pickup));
  if (!timeline_.in_time(walk.pickup_begin, latest_)) return;
  walk.time = walk.pickup_end = walk.pickup_begin + problem_.work_time(robot, pickup);
  // The way there; what is left out of the route as it was, and the way on, follow with the delivery.
  walk.growth = problem_.travel_usage(robot, last.place, pickup) + problem_.work_usage(robot, pickup);
  walk.takes = problem_.travel_time(robot, last.place, pickup) + problem_.work_time(robot, pickup);
  if (problem_.objective() == Objective::lateness) walk.late = lateness(pickup, walk.pickup_end);
  if (!room_for_transport(walk, at)) return;
  const int size = timeline_.tasks_in(robot);
  const bool goes_on = next.unit >= 0 || problem_.must_end(robot);
  const double then =
      goes_on ? problem_.travel_usage(robot, pickup, next.place) - problem_.travel_usage(robot, last.place, next.place)
              : 0.0;
  const auto leg = [&](int from, int to) { return goes_on ? problem_.travel_time(robot, from, to) : 0.0; };
  const double then_s =
      problem_.objective() == Objective::makespan ? leg(pickup, next.place) - leg(last.place, next.place) : 0.0;
  for (int second_at = at;; ++second_at) {
    if (timeline_.stop(robot, second_at).label >= second_labels_.high) return;
    if (timeline_.stop(robot, second_at + 1).label > second_labels_.low) try_delivery_at(walk, second_at);
    if (second_at == size || costs_too_much(walk, walk.growth + then, walk.takes + then_s)) return;
    if (!pass_stop(walk, second_at + 1)) return;
  }
}

// Whether a transport whose pickup alone takes so much costs no less than the best that is known, wherever it is
// delivered.
bool Placement::costs_too_much(const Walk& walk, double growth, double takes) const {
  if (may_call(walk.robot)) return false;
  switch (problem_.objective()) {
    case Objective::total:
      return growth >= best_.score;
    case Objective::total_max:
      return problem_.detours_cost() && growth >= best_.score;
    case Objective::max:
    case Objective::lateness:
      return problem_.detours_cost() && InsertionScore::kTie * growth >= best_.score;
    case Objective::makespan:
      return problem_.detours_cost() && InsertionScore::kTaken * takes >= best_.score;
    case Objective::average:
      return false;
  }
  return false;
}

bool Placement::room_for_transport(const Walk& walk, int at) const {
  if (problem_.unloads_at_stations()) return true;
  for (int c = 0; c < problem_.meters(); ++c) {
    const double load = roster_.load(walk.robot, at, c) + problem_.load(walk.pickup, c);
    if (!problem_.carries(walk.robot, c, load)) return false;
  }
  return true;
}

// Goes on to a stop of the route with the load on board. False: it would be too late there, or have no room.
bool Placement::pass_stop(Walk& walk, int at) const {
  const Visit& visit = timeline_.stop(walk.robot, at);
  const double way = problem_.travel_time(walk.robot, walk.place, visit.place);
  const double arrive = problem_.arrives(walk.robot, walk.time, way);
  double begin = open_to(visit.unit, walk.robot, arrive, timeline_.work_of(visit.place));
  if (!may_call(walk.robot)) begin = std::max(begin, timeline_.begin_of(visit.unit));
  if (!timeline_.in_time(begin, latest_begin(walk.robot, at)) || !room_for_transport(walk, at)) return false;
  walk.time = begin + timeline_.work_of(visit.place);
  walk.ride += problem_.travel_time(walk.robot, walk.place, visit.place) + timeline_.work_of(visit.place);
  if (problem_.objective() == Objective::lateness) {
    walk.late += lateness(visit.place, walk.time) - lateness(visit.place, visit.leave);
  }
  walk.place = visit.place;
  return true;
}

void Placement::try_delivery_at(const Walk& walk, int at) {
  const int robot = walk.robot, delivery = walk.delivery;
  const Visit &first = timeline_.stop(robot, walk.at), &behind = timeline_.stop(robot, walk.at + 1);
  const Visit &last = timeline_.stop(robot, at), &next = timeline_.stop(robot, at + 1);
  const auto on = [&](const Visit& to) { return to.unit >= 0 || problem_.must_end(robot); };
  const auto usage = [&](int from, const Visit& to) {
    return on(to) ? problem_.travel_usage(robot, from, to.place) : 0.0;
  };
  const auto seconds = [&](int from, const Visit& to) {
    return on(to) ? problem_.travel_time(robot, from, to.place) : 0.0;
  };
  const double in = problem_.travel_time(robot, walk.place, delivery), work = problem_.work_time(robot, delivery);
  const double out = seconds(delivery, next);
  const double arrive = std::max({second_ready_, walk.pickup_end + after_, problem_.arrives(robot, walk.time, in)});
  const double begin = open_to(problem_.unit(delivery), robot, arrive, work);
  if (!timeline_.in_time(begin, second_latest_)) return;
  // A pick-up that would end too long before its delivery begins later, if it may.
  const double later = std::max(0.0, begin - walk.pickup_end - within_);
  if (later > 0.0 && (!timeline_.in_time(walk.pickup_begin + later, latest_) || walk.ride + in > within_)) return;
  const double latest_end = problem_.last_set_out(robot, latest_begin(robot, at + 1), out);
  if (!timeline_.in_time(begin + work, latest_end)) return;
  const bool beside = at == walk.at, empty = timeline_.tasks_in(robot) == 0;
  double growth = walk.growth + problem_.travel_usage(robot, walk.place, delivery) +
                  problem_.work_usage(robot, delivery) + usage(delivery, next);
  double takes = walk.takes + in + work + out;
  if (!empty) {
    growth -= usage(first.place, behind);
    takes -= seconds(first.place, behind);
    if (!beside) {
      growth += usage(walk.pickup, behind) - usage(last.place, next);
      takes += seconds(walk.pickup, behind) - seconds(last.place, next);
    }
  }
  if (may_call(robot))
    growth =
        std::min(growth, growth_beside_calls(robot, walk.pickup, walk.at) + growth_beside_calls(robot, delivery, at));
  const double before = roster_.usage(robot);
  if (!problem_.fits(robot, before + growth)) return;
  Offer offer;
  offer.robot = robot;
  offer.at = at;
  offer.work = work;
  offer.in = takes - work;
  offer.arrive = begin;
  offer.latest = latest_end;
  offer.out = 0.0;
  offer.onward = next.unit >= 0 || problem_.makespan_includes_return() ? out + next.tail : 0.0;
  offer.usage = before;
  if (problem_.objective() == Objective::average) {
    offer.late = later_arrivals(robot, walk.pickup, walk.at, 0.0) + later_arrivals(robot, delivery, at, growth);
  }
  double late = walk.late;
  if (problem_.objective() == Objective::lateness) {
    offer.out = out;
    late += lateness(delivery, begin + work) + delays(offer, begin + work);
    offer.out = 0.0;
  }
  InsertionScore score(problem_.objective(), peak_);
  score.add(offer, begin, work, growth);
  const double tail = std::max(second_tail_, walk.pickup_begin + tail_ - begin);
  const double value = compared(score.value(begin, tail, late));
  if (value >= best_.score) return;
  if (const Added added[] = {{walk.at, walk.pickup}, {at, delivery}}; !keeps_length(robot, added)) return;
  const Candidate candidate{value, growth, before,  begin + std::max(tail, work + offer.onward),
                            takes, robot,  walk.at, at};
  if (may_call(robot)) return keep(Candidate(candidate));
  take(candidate, value, growth);
}

}  // namespace muster
