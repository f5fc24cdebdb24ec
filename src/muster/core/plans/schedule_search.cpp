#include "plans/schedule_search.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace muster {

namespace {

constexpr double kTie = 1e-2;        // weight of the robots' own routes where the objective does not see them
constexpr int kAdjacentUnits = 100;  // tasks that a ruin may spread to
constexpr int kNearRobotsOfUnit = 4;
// Of steps that exchange two tails of routes, where there are such: where ways are summed up, and else.
constexpr double kTailShare = 0.2, kTailShareElse = 0.05;
constexpr int kRetriedUnits = 20;  // units left out that a step tries again
constexpr int kMostPlaces = 64;    // beyond twice as many a unit is tried beside near tasks alone

// More than leaving out a unit of weight 1 can ever save.
double penalty_of(const Problem& problem) {
  double way = 0.0, work = 0.0, opens = 0.0, least = kNever;
  for (int task = 0; task < problem.tasks(); ++task) {
    least = std::min(least, problem.priority(task));
    const double open = problem.next_begin(task, 0.0);
    if (std::isfinite(open)) opens = std::max(opens, open);
    for (const int robot : problem.robots_allowed(task)) {
      const double there = problem.travel_usage(robot, problem.start(robot), task);
      const double time = problem.travel_time(robot, problem.start(robot), task);
      if (std::isfinite(there)) way = std::max({way, there, time});
      work = std::max({work, problem.work_usage(robot, task), problem.work_time(robot, task)});
    }
  }
  const bool sums = problem.objective() == Objective::average || problem.objective() == Objective::lateness;
  const double affected = sums ? static_cast<double>(problem.tasks()) : static_cast<double>(problem.robots());
  return (4.0 * way + 2.0 * work + opens) * (1.0 + affected) / (least > 0.0 ? least : 1.0);
}

}  // namespace

ScheduleSearch::ScheduleSearch(const Problem& problem, const Routes& start, std::uint64_t seed, SearchSettings settings)
    : problem_(problem),
      settings_(settings),
      random_(seed),
      neighbours_(problem, kAdjacentUnits, kNearRobotsOfUnit),
      roster_(problem),
      sees_end_(problem.objective() == Objective::makespan),
      sums_ways_(problem.objective() == Objective::total && !problem.usage_is_time()),
      penalty_(penalty_of(problem)),
      times_absent_(problem.units(), 1.0),
      ruined_(problem.robots(), 0) {
  trial_.most_places = kMostPlaces;
  trial_.blink = settings.blink;
  trial_.random = &random_;
  trial_.neighbours = &neighbours_;
  if (!roster_.begin(start)) throw std::invalid_argument("there is no schedule for the routes");
  best_.resize(problem.robots());
  best_value_.weight = -kNever;
  note_best();
  fill();
  if (roster_.finish(trial_) && roster_.admissible()) {
    roster_.commit();
  } else {
    roster_.rollback();
    roster_.begin(start);
  }
  current_ = cost();
  note_best();
}

// Puts in what the routes leave room for, the most urgent first.
void ScheduleSearch::fill() {
  std::vector<int> units = roster_.absent();
  std::ranges::sort(units);
  std::ranges::stable_sort(units, {}, [&](int unit) {
    const int task = problem_.tasks_of_unit(unit).front();
    return problem_.last_begin(task, problem_.ends_by(task));
  });
  for (bool more = true; more;) {
    more = false;
    for (int& unit : units) {
      if (unit < 0 || roster_.present(unit) || !roster_.ready(unit)) continue;
      const UnitInsertion* insertion = roster_.best_insertion(std::exchange(unit, -1), trial_);
      if (!insertion) continue;
      if (roster_.insert(*insertion) && roster_.admissible()) {
        roster_.commit();
        more = true;
      } else {
        roster_.rollback();
      }
    }
  }
}

void ScheduleSearch::go_on_from(const Routes& routes) {
  if (!roster_.begin(routes)) throw std::invalid_argument("there is no schedule for the routes");
  current_ = cost();
  note_best();
}

Routes ScheduleSearch::routes() const { return roster_.routes(); }

void ScheduleSearch::anneal(int steps, double hot, double cold) {
  if (problem_.tasks() == 0) return;
  const double cooling = std::pow(cold / hot, 1.0 / steps);
  double temperature = hot;
  for (int k = 0; k < steps; ++k, temperature *= cooling) step(temperature);
}

void ScheduleSearch::step(double temperature) {
  const double most = current_ - temperature * std::log(random_.uniform() + 1e-300);
  const double absent_weight = roster_.absent_weight(), difficulty = absent_difficulty();
  bool complete = false;
  if (random_.uniform() < (sums_ways_ ? kTailShare : kTailShareElse) && find_tails(most)) {
    complete = exchange_tails();
  } else {
    ruin();
    complete = roster_.settle() && recreate(most);
  }
  trial_.latest_end = kNever;
  if (complete) {
    const bool possible = roster_.finish(trial_) && roster_.admissible();
    const double next = possible ? cost() : kNever;
    const bool easier = possible && leaves_out_easier_than(difficulty, absent_weight);
    if (next < most || easier) {
      current_ = next;
      note_best();
      roster_.commit();
      return;
    }
  }
  roster_.rollback();
}

// Puts units back one by one, each where it costs least; those that wait for others after these. False: no way is left
// to come below `most`, as another unit makes nothing cheaper.
bool ScheduleSearch::recreate(double most) {
  pending_ = removed_;
  const auto& absent = roster_.absent();
  if (static_cast<int>(absent.size()) - static_cast<int>(removed_.size()) <= kRetriedUnits) {
    pending_ = absent;
  } else {
    for (int k = 0; k < kRetriedUnits; ++k) pending_.push_back(absent[random_.below(static_cast<int>(absent.size()))]);
  }
  order_pending();
  for (bool more = true; more;) {
    more = false;
    for (int& unit : pending_) {
      if (unit < 0 || roster_.present(unit) || !roster_.ready(unit)) continue;
      if (sees_end_) limit_end(most);
      const UnitInsertion* insertion = roster_.best_insertion(unit, trial_);
      const int tried = std::exchange(unit, -1);
      if (!insertion) {
        if (scale_ * penalty_ * roster_.weight(tried) > most) return false;
        continue;
      }
      if (!roster_.insert(*insertion)) return false;
      more = true;
      if (sees_end_ && roster_.peak() > trial_.latest_end) return false;
    }
    more &= problem_.has_prerequisites();
  }
  return true;
}

// Of objective `makespan`: when the mission may end, if it is to cost no more than `most`. Robots' own ends only rise
// with what is put in.
void ScheduleSearch::limit_end(double most) { trial_.latest_end = most - kTie * ties(); }

double ScheduleSearch::distance_from_start(int unit) const {
  const int task = problem_.tasks_of_unit(unit).front();
  const auto robots = neighbours_.robots(task);
  if (robots.empty()) return 0.0;
  return problem_.distance(problem_.travel_class(robots[0]), problem_.start(robots[0]), task);
}

// About so many robots do it.
double ScheduleSearch::team_size(int unit) const {
  double size = 0.0;
  for (const int task : problem_.tasks_of_unit(unit)) {
    double members = 0.0;
    for (const TeamPart& part : problem_.parts(task)) members += part.count;
    if (problem_.abilities() > 0) {
      for (const double need : problem_.needs(task)) members += need;
    }
    size += std::max(1.0, members);
  }
  return size;
}

// In random order, or by what makes a unit hard to place.
void ScheduleSearch::order_pending() {
  for (std::size_t k = pending_.size(); k > 1; --k) {
    std::swap(pending_[k - 1], pending_[random_.below(static_cast<int>(k))]);
  }
  const int kind = random_.below(10);
  if (kind == 2 || kind == 3) return;
  const auto key = [&](int unit) {
    const int task = problem_.tasks_of_unit(unit).front();
    switch (kind) {
      case 0:
      case 1:  // what was left out most often
        return -times_absent_[unit];
      case 4:
        return -distance_from_start(unit);
      case 5:
        return distance_from_start(unit);
      case 6:  // few robots, or many of them at once
        return static_cast<double>(problem_.robots_allowed(task).size()) / team_size(unit);
      case 7:  // when it began last
        return roster_.timeline().begin_of(unit);
      case 8:  // the latest begin
        return problem_.last_begin(task, problem_.ends_by(task));
      default:  // how long the mission goes on after it
        return sees_end_ ? -roster_.timeline().tail_of(unit) : problem_.next_begin(task, 0.0);
    }
  };
  std::ranges::stable_sort(pending_, {}, key);
}

double ScheduleSearch::ties() const {
  if (problem_.objective() == Objective::makespan) {
    double sum = 0.0;
    for (int robot = 0; robot < problem_.robots(); ++robot) sum += roster_.timeline().end_of_route(robot);
    return sum;
  }
  if (problem_.objective() == Objective::max || problem_.objective() == Objective::lateness) {
    double sum = 0.0;
    for (int robot = 0; robot < problem_.robots(); ++robot) sum += roster_.usage(robot);
    return sum;
  }
  return 0.0;
}

// What annealing compares: the objective (`average` as a sum), and a penalty for what is left out.
double ScheduleSearch::cost() {
  return scale_ * (roster_.objective() + kTie * ties() + penalty_ * roster_.absent_weight());
}

// From a plan in which nothing is late, ties are what is left to improve: they count as a total would.
void ScheduleSearch::note_best() {
  const Value value = roster_.value();
  if (!value.better_than(best_value_)) return;
  best_value_ = value;
  best_ = roster_.routes();
  if (problem_.objective() != Objective::lateness) return;
  scale_ = value.objective > 0.0 ? 1.0 : 1.0 / kTie;
  current_ = cost();
}

// How hard it is to place what is left out, by how often it was.
double ScheduleSearch::absent_difficulty() const {
  double sum = 0.0;
  for (const int unit : roster_.absent()) sum += times_absent_[unit];
  return sum;
}

// Whether what is left out now is no more than before, and easier to place, as in the minimisation of fleets
// [christiaens2020]. Counts it where anything was left out before.
bool ScheduleSearch::leaves_out_easier_than(double difficulty, double absent_weight) {
  if (difficulty == 0.0) return false;
  const bool easier = roster_.absent_weight() <= absent_weight && absent_difficulty() < difficulty;
  for (const int unit : roster_.absent()) ++times_absent_[unit];
  return easier;
}

double ScheduleSearch::mean_way() const {
  const bool in_time = problem_.objective() == Objective::makespan || problem_.objective() == Objective::lateness;
  double sum = 0.0;
  int ways = 0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    int last = problem_.start(robot);
    for (const int task : best_[robot]) {
      sum += in_time ? problem_.travel_time(robot, last, task) : problem_.travel_usage(robot, last, task);
      ++ways;
      last = task;
    }
  }
  return ways ? sum / ways : 0.0;
}

}  // namespace muster
