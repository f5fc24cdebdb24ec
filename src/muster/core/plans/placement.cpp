#include "plans/placement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace muster {

namespace {

constexpr double kLooksAhead =
    0.7;  // how often an algorithm with random numbers looks at tasks that are not in the plan

}  // namespace

Placement::Placement(Roster& roster)
    : roster_(roster),
      problem_(roster.problem_),
      timeline_(roster.timeline_),
      calls_(roster.calls()),
      relations_(roster),
      ranges_(problem_.robots()),
      choice_(problem_),
      near_(problem_.units(), 0),
      busy_(problem_.robots(), 0) {}

const UnitInsertion* Placement::best(int unit, const Trial& trial) {
  if (roster_.barred(unit)) return nullptr;
  if (const auto whole = problem_.inseparable(unit); !whole.empty()) {
    const bool is_pair = whole.size() == 2 && alone(whole[0]) && alone(whole[1]);
    const auto task = [&](int each) { return problem_.tasks_of_unit(each).front(); };
    const bool found = is_pair ? best_transport(task(whole[0]), task(whole[1]), trial) : best_whole(whole, trial);
    return found ? &best_ : nullptr;
  }
  trial_ = &trial;
  best_.unit = unit;
  best_.score = kNever;
  best_.members.clear();
  best_.others.clear();
  labels_ = roster_.timeline_.labels_for(unit);
  if (labels_.empty()) return nullptr;
  relations_.look_at(unit, trial.robots);
  ready_ = timeline_.ready(unit);
  peak_ = roster_.peak();
  looks_ahead_ = relations_.awaits_any() && (!trial.random || trial.random->uniform() < kLooksAhead);
  try_all(unit);
  if (best_.members.empty() && std::exchange(looks_ahead_, false)) try_all(unit);
  return best_.members.empty() ? nullptr : &best_;
}

void Placement::try_all(int unit) {
  if (alone(unit)) {
    try_alone(problem_.tasks_of_unit(unit).front());
    judge_candidates();
  } else {
    try_cuts(unit);
  }
}

bool Placement::alone(int unit) const {
  const auto tasks = problem_.tasks_of_unit(unit);
  return tasks.size() == 1 && choice_.alone(tasks.front());
}

// Whether the robots of `team_` can do as well what they would have to, though it is not in the plan yet.
bool Placement::suits(int unit) {
  const int tasks = static_cast<int>(problem_.tasks_of_unit(unit).size());
  for (int k = 0; k < tasks; ++k) {
    if (relations_.awaited(k).empty()) continue;
    robots_.clear();
    for (const Part& part : team_) {
      if (part.task == k) robots_.push_back(part.offer->robot);
    }
    if (!suits(relations_.awaited(k), robots_)) return false;
  }
  return true;
}

bool Placement::suits(std::span<const int> awaited, std::span<const int> robots) {
  return std::ranges::all_of(awaited, [&](int other) {
    return choice_.does(other, robots) &&
           std::ranges::all_of(robots, [&](int robot) { return problem_.allowed(robot, other); });
  });
}

// --- One robot, one task ---------------------------------------------------------------------------------------------

bool Placement::usable_alone(int robot) {
  return !is_second_twin(robot) && relations_.allows(0, robot) &&
         (!looks_ahead_ || suits(relations_.awaited(0), {&robot, 1}));
}

// Whether a robot without tasks differs in nothing from one before it, without tasks as well.
bool Placement::is_second_twin(int robot) const {
  const int twin = problem_.twin(robot);
  return timeline_.tasks_in(robot) == 0 && empty_twin_[twin] != robot && empty_twin_[twin] >= 0;
}

// Of robots that differ in nothing the first without tasks.
void Placement::find_empty_twins() {
  empty_twin_.assign(problem_.robots(), -1);
  for (int robot = problem_.robots() - 1; robot >= 0; --robot) {
    if (timeline_.tasks_in(robot) == 0 && (!trial_->robots || (*trial_->robots)[robot]))
      empty_twin_[problem_.twin(robot)] = robot;
  }
}

void Placement::try_alone(int task) {
  find_empty_twins();
  measured_work_ = -1.0;
  if (relations_.team_size(0) > 1) return;
  const auto robots = problem_.robots_allowed(task);
  long count = 0;
  for (const int robot : robots) {
    if (!usable_alone(robot)) continue;
    measure_alone(task, problem_.work_time(robot, task));
    ranges_[robot] = places(robot);
    count += std::max(0, ranges_[robot].second - ranges_[robot].first + 1);
  }
  if (trial_->most_places > 0 && !trial_->append_only && count > 2 * trial_->most_places) return try_near(task);
  for (const int robot : robots) {
    if (!usable_alone(robot)) continue;
    for (int at = ranges_[robot].first; at <= ranges_[robot].second; ++at) try_place(robot, task, at);
  }
}

// Beside tasks that are near, and at both ends of routes.
void Placement::try_near(int task) {
  int tried = 0;
  const auto attempt = [&](int robot, int at) {
    if (!problem_.allowed(robot, task) || !usable_alone(robot) || at < ranges_[robot].first ||
        at > ranges_[robot].second)
      return false;
    try_place(robot, task, at);
    return true;
  };
  for (const int near : trial_->neighbours->of(task)) {
    for (const int number : timeline_.visits_of(problem_.unit(near))) {
      const Visit& visit = timeline_.visit(number);
      if (visit.place != near) continue;
      const bool before = attempt(visit.robot, visit.at - 1), after = attempt(visit.robot, visit.at);
      tried += before || after;
    }
    if (tried >= trial_->most_places) break;
  }
  for (const int robot : problem_.robots_allowed(task)) {
    if (!usable_alone(robot) || ranges_[robot].first > ranges_[robot].second) continue;
    attempt(robot, ranges_[robot].first);
    if (ranges_[robot].second > ranges_[robot].first) attempt(robot, ranges_[robot].second);
  }
}

// Labels, latest begins and times of leaving rise along a route, so that the places that may do are a range.
std::pair<int, int> Placement::places(int robot) const {
  const auto& route = timeline_.route(robot);
  const int size = static_cast<int>(route.size()) - 2;
  const bool calls = may_call(robot);
  const auto too_early = [&](int number) {  // the stop after the place
    const Visit& next = timeline_.visit(number);
    return next.label <= labels_.low || (!calls && !timeline_.in_time(ready_ + measured_work_, next.latest));
  };
  const auto early_enough = [&](int number) {  // the stop before it
    const Visit& last = timeline_.visit(number);
    return last.label < labels_.high && (calls || timeline_.in_time(last.leave, latest_));
  };
  const auto first = std::partition_point(route.begin() + 1, route.end(), too_early);
  const auto last = std::partition_point(route.begin(), route.end() - 1, early_enough);
  int from = static_cast<int>(first - route.begin()) - 1;
  const int to = static_cast<int>(last - route.begin()) - 1;
  from = std::max(from, problem_.fixed(robot));
  if (trial_->append_only) from = std::max(from, size);
  return {from, to};
}

void Placement::measure_alone(int task, double work) {
  if (work == measured_work_) return;
  measured_work_ = work;
  latest_ = timeline_.latest_for(problem_.unit(task), {&work, 1});
  if (problem_.objective() == Objective::makespan) tail_ = timeline_.tail_after(problem_.unit(task), {&work, 1});
}

void Placement::try_place(int robot, int task, int at) {
  if (overlooked() || !in_reach(robot, task, at) || !has_room(robot, task, at)) return;
  const double work = problem_.work_time(robot, task);
  measure_alone(task, work);
  const bool sees_usage = problem_.objective() != Objective::makespan;
  if (!sees_usage && least_score(robot, at, work) >= best_.score) return;
  Offer there = arrival(robot, task, at, work);
  if (hopeless(there)) return;
  go_on(there, task);
  if (hopeless(there)) return;
  const int unit = problem_.unit(task);
  const double begin = open_to(unit, robot, std::max(ready_, there.arrive), work);
  if (!timeline_.in_time(begin, latest_) || !timeline_.in_time(begin + work, there.latest)) return;
  if (sees_usage) measure_usage(there, task);
  InsertionScore score(problem_.objective(), peak_);
  score.add(there, begin, work, there.growth);
  double late = 0.0;
  if (problem_.objective() == Objective::lateness) late = lateness(task, begin + work) + delays(there, begin + work);
  const double value = compared(score.value(begin, tail_, late));
  if (value >= best_.score) return;
  if (!sees_usage) measure_usage(there, task);
  if (!problem_.fits(robot, there.usage + there.growth)) return;
  if (const Added added{at, task}; !keeps_length(robot, {&added, 1})) return;
  if (may_call(robot)) {
    const double ends = begin + std::max(tail_, work + there.onward);
    return keep({value, there.growth, there.usage, ends, there.in + work + there.out - there.direct, robot, at, -1});
  }
  best_.score = value;
  best_.growth = there.growth;
  best_.members.assign(1, {task, robot, at});
}

// Whether the robot, where it does a task's prerequisite or dependant too, can be at the later of the two as soon after
// the earlier as the gap between them says.
bool Placement::in_reach(int robot, int task, int at) const {
  if (!problem_.has_gap_most()) return true;
  const auto place_of = [&](int other) { return timeline_.place_of(other, robot); };
  const auto before = problem_.prerequisites(task);
  for (std::size_t k = 0; k < before.size(); ++k) {
    const double within = problem_.gap_most(task, static_cast<int>(k));
    const int from = within < kNever ? place_of(before[k]) : -1;
    if (from < 0 || from > at) continue;
    double takes = problem_.travel_time(robot, timeline_.stop(robot, at).place, task);
    for (int n = from + 1; n <= at; ++n) {
      takes += timeline_.stop(robot, n).in + problem_.work_time(robot, timeline_.stop(robot, n).place);
    }
    if (!timeline_.in_time(takes, within)) return false;
  }
  for (const int dependant : problem_.dependants(task)) {
    const auto own = problem_.prerequisites(dependant);
    const double within = problem_.gap_most(dependant, static_cast<int>(std::ranges::find(own, task) - own.begin()));
    const int to = within < kNever ? place_of(dependant) : -1;
    if (to <= at) continue;
    double takes = problem_.travel_time(robot, task, timeline_.stop(robot, at + 1).place);
    for (int n = at + 1; n < to; ++n) {
      takes += problem_.work_time(robot, timeline_.stop(robot, n).place) + timeline_.stop(robot, n + 1).in;
    }
    if (!timeline_.in_time(takes, within)) return false;
  }
  return true;
}

// Of objective `makespan`: when the mission ends at the earliest if the ways to and from a place took no time, later
// than now.
double Placement::least_score(int robot, int at, double work) const {
  const Visit &last = timeline_.stop(robot, at), &next = timeline_.stop(robot, at + 1);
  return std::max(ready_, last.leave) + std::max(tail_, work + next.tail) - peak_;
}

// The same with the way there, and what the place takes of the robot's time.
double Placement::least_score(const Offer& arrival) const {
  const double begin = std::max(ready_, arrival.arrive);
  InsertionScore score(Objective::makespan, peak_);
  score.add(arrival, begin, arrival.work, 0.0);
  return score.value(begin, tail_, 0.0);
}

// Of objective `makespan`: whether no team with this member costs less than the best that is known, or ends the mission
// in time.
bool Placement::hopeless(const Offer& offer) const {
  if (problem_.objective() != Objective::makespan) return false;
  const double begin = std::max(ready_, offer.arrive);
  const double end = begin + std::max(tail_, offer.work + offer.onward);
  return end > trial_->latest_end || least_score(offer) >= best_.score;
}

// A task between two stops up to its end, as if the way on took no time.
Offer Placement::arrival(int robot, int task, int at, double work) const {
  const Visit &last = timeline_.stop(robot, at), &next = timeline_.stop(robot, at + 1);
  Offer offer;
  offer.robot = robot;
  offer.at = at;
  offer.work = work;
  offer.in = problem_.travel_time(robot, last.place, task);
  offer.arrive = problem_.arrives(robot, leave(robot, at), offer.in);
  offer.direct = next.unit >= 0 || last.unit >= 0 ? next.in : 0.0;
  if (may_call(robot) && offer.direct > 0.0) offer.direct = problem_.travel_time(robot, last.place, next.place);
  offer.onward = next.tail;
  return offer;
}

// The way on, and what comes after it.
void Placement::go_on(Offer& offer, int task) const {
  const Visit& next = timeline_.stop(offer.robot, offer.at + 1);
  const bool goes_on = next.unit >= 0 || problem_.must_end(offer.robot);
  offer.out = goes_on ? problem_.travel_time(offer.robot, task, next.place) : 0.0;
  offer.latest = problem_.last_set_out(offer.robot, latest_begin(offer.robot, offer.at + 1), offer.out);
  offer.onward = next.unit >= 0 || problem_.makespan_includes_return() ? offer.out + next.tail : 0.0;
  if (next.unit >= 0) offer.next = timeline_.begin_of(next.unit);
}

// What it takes of what is limited by the robot's capacity.
void Placement::measure_usage(Offer& offer, int task) const {
  const int robot = offer.robot;
  const Visit &last = timeline_.stop(robot, offer.at), &next = timeline_.stop(robot, offer.at + 1);
  const bool goes_on = next.unit >= 0 || problem_.must_end(robot);
  const bool went_on = next.unit >= 0 || (last.unit >= 0 && problem_.must_end(robot));
  offer.usage = roster_.usage(robot);
  offer.growth = problem_.travel_usage(robot, last.place, task) + problem_.work_usage(robot, task);
  if (goes_on) offer.growth += problem_.travel_usage(robot, task, next.place);
  if (went_on) offer.growth -= problem_.travel_usage(robot, last.place, next.place);
  if (may_call(robot)) offer.growth = std::min(offer.growth, growth_beside_calls(robot, task, offer.at));
  if (problem_.objective() == Objective::average) offer.late = later_arrivals(robot, task, offer.at, offer.growth);
}

// --- Figures ---------------------------------------------------------------------------------------------------------

double Placement::lateness(int task, double end) const {
  return problem_.priority(task) * std::max(0.0, end - problem_.due(task));
}

// What the lateness of the tasks after a place grows by in that route.
double Placement::delays(const Offer& offer, double end) const {
  const auto& route = timeline_.route(offer.robot);
  double sum = 0.0, arrival = problem_.arrives(offer.robot, end, offer.out);
  for (std::size_t at = offer.at + 1; at + 1 < route.size(); ++at) {
    const Visit& visit = timeline_.visit(route[at]);
    const double begin = open_to(visit.unit, offer.robot, arrival, timeline_.work_of(visit.place));
    const double now = timeline_.begin_of(visit.unit);
    if (begin <= now || begin == kNever) break;
    const double leave = visit.leave + (begin - now);
    sum += lateness(visit.place, leave) - lateness(visit.place, visit.leave);
    const Visit& next = timeline_.visit(route[at + 1]);
    const double way = problem_.travel_time(offer.robot, visit.place, next.place);
    arrival = problem_.arrives(offer.robot, leave, way);
  }
  return sum;
}

double Placement::later_arrivals(int robot, int task, int at, double growth) const {
  const auto& route = timeline_.route(robot);
  double usage = 0.0;
  for (int k = 1; k <= at; ++k) {
    usage = problem_.on_to(robot, usage, timeline_.visit(route[k - 1]).place, timeline_.visit(route[k]).place);
  }
  usage += problem_.travel_usage(robot, timeline_.visit(route[at]).place, task);
  return usage + static_cast<double>(timeline_.tasks_in(robot) - at) * growth;
}

}  // namespace muster
