#include "plans/search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "infinity.hpp"
#include "plans/ruin_string.hpp"

namespace muster {

namespace {

constexpr int kAdjacent = 100;   // tasks that a ruin may spread to
constexpr int kNearRobots = 4;   // robots whose starts are tried for a task
constexpr int kFew = 200;        // tasks, up to which each is tried at every place, which costs little
constexpr int kRetried = 10;     // tasks left out that a step tries again
constexpr int kRetriedNear = 3;  // of these near the ruin
// Where the greatest load counts alone: what a unit of usage counts at a temperature of a usual way, and the power of
// the temperature with which that falls.
constexpr double kTotalWhenHot = 0.05, kTotalCools = 0.4;
// Where not all tasks can be done:
constexpr double kWorth = 10.0;         // what a task of mean weight counts, in what a task costs
constexpr double kSettled = 0.1;        // temperature below which no weight is given away any more, in the same unit
constexpr double kHeaviestFirst = 0.3;  // orders that put tasks in by weight
constexpr double kSeedFirst = 0.5;      // orders that begin with the task left out that the ruin made room for

// More than leaving out a task of weight 1 can ever save.
double penalty_of(const Problem& problem, const Team& team) {
  double way = 0.0, work = 0.0, least = kNever;
  for (int task = 0; task < problem.tasks(); ++task) {
    least = std::min(least, problem.priority(task));
    for (const int robot : problem.robots_allowed(task)) {
      const double there = problem.travel_usage(robot, problem.start(robot), task);
      const double time = problem.travel_time(robot, problem.start(robot), task);
      if (std::isfinite(there)) way = std::max({way, there, time});
      work = std::max({work, problem.work_usage(robot, task), problem.work_time(robot, task)});
    }
  }
  double most = 0.0;
  for (int robot = 0; robot < problem.robots(); ++robot) most = std::max(most, team.usage(robot));
  const double each = 4.0 * way + 2.0 * work;
  return (problem.objective() == Objective::average ? each + 2.0 * most : each) / (least > 0.0 ? least : 1.0);
}

double mean_weight(const Problem& problem) {
  double sum = 0.0;
  for (int task = 0; task < problem.tasks(); ++task) sum += problem.priority(task);
  return problem.tasks() ? sum / problem.tasks() : 0.0;
}

}  // namespace

Search::Search(const Problem& problem, const Routes& start, std::uint64_t seed, SearchSettings settings)
    : problem_(problem),
      settings_(settings),
      random_(seed),
      neighbours_(problem, kAdjacent, kNearRobots),
      everywhere_(problem.tasks() <= kFew),
      penalty_(0.0),
      team_(problem, start),
      team_cost_(problem, team_),
      local_search_(problem, neighbours_, team_, team_cost_),
      spared_(problem.tasks(), 0),
      is_ruined_(problem.robots(), 0),
      where_ruined_(problem.tasks(), 0) {
  forbidding_ = penalty_ = penalty_of(problem, team_);
  task_cost_ = mean_cost();
  const double weight = mean_weight(problem);
  trading_ = weight > 0.0 ? std::min(forbidding_, kWorth * task_cost_ / weight) : forbidding_;
  usual_way_ = mean_way();
  current_ = cost();
  best_.resize(problem.robots());
  best_value_.weight = -kNever;
  note_best();
  team_.commit();
}

void Search::go_on_from(const Routes& routes) {
  team_.begin(routes);
  current_ = cost();
  note_best();
}

void Search::anneal(int steps, double hot, double cold) {
  if (problem_.tasks() == 0) return;
  const double cooling = std::pow(cold / hot, 1.0 / steps);
  double temperature = hot;
  for (int k = 0; k < steps; ++k, temperature *= cooling) step(temperature);
}

void Search::step(double temperature) {
  weigh(temperature);
  ruin();
  recreate();
  drop_orphans();
  if (!settings_.oversubscribed || cost() < current_ + temperature) improve();
  if (cost() < current_ - temperature * std::log(random_.uniform() + 1e-300)) {
    team_.settle();
    if (team_.fits()) {
      current_ = cost();
      note_best();
      team_.commit();
      return;
    }
  }
  team_.rollback();
}

// Where not all tasks can be done, weight is given away for other weight while it is hot: a penalty that forbids it
// would let the first tasks that fill the routes stay for good. Where the greatest load counts alone, the others count
// a little, and less when it is cold: short routes leave room, until the longest can be no shorter.
void Search::weigh(double temperature) {
  const bool trading = settings_.oversubscribed && best_value_.weight < 0.0 && temperature > kSettled * task_cost_;
  const double penalty = trading ? trading_ : forbidding_;
  if (temperature == weighed_for_ && penalty == penalty_) return;
  weighed_for_ = temperature;
  penalty_ = penalty;
  local_search_.weigh(penalty);
  team_cost_.weigh_total(kTotalWhenHot * std::pow(std::min(1.0, temperature / usual_way_), kTotalCools));
  current_ = cost();
}

// Strings of tasks are taken out of routes that pass near one task.
void Search::ruin() {
  removed_.clear();
  for (const int robot : ruined_) is_ruined_[robot] = 0;
  for (const int task : again_) where_ruined_[task] = 0;
  ruined_.clear();
  again_.clear();
  seed_left_out_ = false;
  gaps_.clear();
  ++ruin_stamp_;
  int used = 0;
  for (int robot = 0; robot < problem_.robots(); ++robot) used += !team_.empty(robot);
  if (used == 0) {
    again_ = team_.absent();
    return;
  }
  seed_ = seed_task();
  seed_left_out_ = !team_.present(seed_);
  set_out_again();
  const double present = static_cast<double>(problem_.tasks()) - static_cast<double>(team_.absent().size());
  const double mean = std::max(1.0, present / used);
  const double scale = scale_of_ruin(mean);
  const double longest = std::min(scale * settings_.longest_string, mean);
  const double most_strings = 4.0 * scale * settings_.removed / (1.0 + longest) - 1.0;
  const int strings = std::max(1, static_cast<int>(1.0 + random_.uniform() * most_strings));
  int taken = 0;
  const auto visit = [&](int task) {
    const int robot = team_.robot_of(task);
    if (robot == Team::kAbsent || spared_[task] == ruin_stamp_ || team_.fixed(task)) return;
    if (is_ruined_[robot] && settings_.oversubscribed) return;
    const double most = std::min<double>(longest, static_cast<double>(team_.size(robot)));
    take_string(task, static_cast<int>(1.0 + random_.uniform() * most));
    ++taken;
    if (is_ruined_[robot]) return;
    is_ruined_[robot] = 1;
    ruined_.push_back(robot);
  };
  visit(seed_);
  for (const int task : neighbours_.of(seed_)) {
    if (taken >= strings) break;
    visit(task);
  }
}

// Where routes are long, some ruins are larger: two times, or four times.
double Search::scale_of_ruin(double tasks_of_route) {
  double scale = static_cast<double>(1 << random_.below(3));
  while (scale > 1.0 && scale * settings_.longest_string > tasks_of_route) scale /= 2.0;
  return scale;
}

// Of the tasks left out, all if they are few; else the seed, some near it and some from anywhere, where the ruin makes
// room.
void Search::set_out_again() {
  const auto& absent = team_.absent();
  if (static_cast<int>(absent.size()) <= kRetried) {
    again_ = absent;
    return;
  }
  const auto set_out = [&](int task) {
    if (team_.present(task) || task == seed_ || where_ruined_[task]) return;
    again_.push_back(task);
    where_ruined_[task] = 1;
  };
  if (seed_left_out_) again_.push_back(seed_);
  for (const int task : neighbours_.of(seed_)) {
    if (static_cast<int>(again_.size()) >= kRetriedNear) break;
    set_out(task);
  }
  for (int k = static_cast<int>(again_.size()); k < kRetried; ++k) set_out(any_of(absent));
}

int Search::seed_task() {
  const auto& absent = team_.absent();
  if (!absent.empty() && random_.uniform() < 0.5) return absent[random_.below(static_cast<int>(absent.size()))];
  if (team_cost_.sees_greatest() && random_.uniform() < settings_.greatest_share) {
    const int robot = team_cost_.greatest();
    if (!team_.empty(robot)) return team_.task_at(robot, random_.below(team_.size(robot)));
  }
  return random_.below(problem_.tasks());
}

int Search::any_of(const std::vector<int>& tasks) { return tasks[random_.below(static_cast<int>(tasks.size()))]; }

void Search::take_string(int task, int length) {
  constexpr int kLongestGap = 4;
  const int around = length + kLongestGap;
  string_.clear();
  for (int each = task; team_.is_task(each) && !team_.fixed(each) && static_cast<int>(string_.size()) < around;
       each = team_.prev(each)) {
    string_.push_back(each);
  }
  std::ranges::reverse(string_);
  const int at = static_cast<int>(string_.size()) - 1;
  for (int each = team_.next(task); team_.is_task(each) && static_cast<int>(string_.size()) < at + around;
       each = team_.next(each)) {
    string_.push_back(each);
  }
  for (const int each : string_) spared_[each] = ruin_stamp_;
  string_around(at, length, 0, static_cast<int>(string_.size()), random_, [&](int k) {
    const int each = string_[k];
    gaps_.push_back(team_.prev(each));
    gaps_.push_back(team_.next(each));
    team_.remove(each);
    removed_.push_back(each);
  });
}

// Puts tasks back one by one, each where it costs least; those that wait for others after these.
void Search::recreate() {
  pending_ = again_;
  pending_.insert(pending_.end(), removed_.begin(), removed_.end());
  order_pending();
  if (settings_.oversubscribed && seed_left_out_ && random_.uniform() < kSeedFirst) begin_with(seed_);
  peak_ = team_cost_.load(team_cost_.greatest());
  const auto ready = [&](int task) {
    return std::ranges::all_of(problem_.prerequisites(task), [&](int before) { return team_.present(before); });
  };
  for (bool more = true; more;) {
    more = false;
    for (int& task : pending_) {
      if (task == Team::kAbsent || team_.present(task) || !ready(task)) continue;
      more |= insert(task);
      task = Team::kAbsent;
    }
    more &= problem_.has_prerequisites();
  }
}

// In random order, the farthest first, the nearest first, or those first that few robots may do.
void Search::order_pending() {
  for (std::size_t k = pending_.size(); k > 1; --k) {
    std::swap(pending_[k - 1], pending_[random_.below(static_cast<int>(k))]);
  }
  if (settings_.oversubscribed && random_.uniform() < kHeaviestFirst) {
    std::ranges::stable_sort(pending_, std::greater{}, [&](int task) { return problem_.priority(task); });
    return;
  }
  const int kind = random_.below(8);
  if (kind < 4) return;
  const auto key = [&](int task) {
    if (kind == 7) return static_cast<double>(problem_.robots_allowed(task).size());
    const auto robots = neighbours_.robots(task);
    if (robots.empty()) return 0.0;
    const double distance = problem_.distance(problem_.travel_class(robots[0]), problem_.start(robots[0]), task);
    return kind == 6 ? distance : -distance;
  };
  std::ranges::stable_sort(pending_, {}, key);
}

void Search::begin_with(int task) {
  const auto at = std::ranges::find(pending_, task);
  std::rotate(pending_.begin(), at, at + 1);
}

bool Search::insert(int task) {
  team_.bound(task);
  place_.robot = Team::kAbsent;
  place_score_ = kNever;
  if (where_ruined_[task]) {
    for (const int robot : ruined_) {
      if (problem_.allowed(robot, task)) try_route(robot, task);
    }
  } else if (everywhere_) {
    for (const int robot : problem_.robots_allowed(task)) try_route(robot, task);
  } else {
    try_near(task);
    if (raises_greatest()) try_idlest(task);
    if (place_.robot == Team::kAbsent) try_far(task);
  }
  if (place_.robot == Team::kAbsent) return false;
  team_.insert(task, place_.after);
  peak_ = std::max(peak_, team_cost_.load(place_.robot));
  return true;
}

// The places beside tasks that are near, and the starts of robots that are.
void Search::try_near(int task) {
  int tried = 0;
  for (const int near : neighbours_.of(task)) {
    if (!team_.present(near)) continue;
    const int robot = team_.robot_of(near);
    if (problem_.allowed(robot, task)) {
      try_place(robot, task, team_.prev(near));
      try_place(robot, task, near);
    }
    if (++tried == settings_.near) break;
  }
  for (const int robot : neighbours_.robots(task)) try_place(robot, task, team_.last_fixed(robot));
}

// Every place of the routes that may have room: where all near ones are full, there may be some far away.
void Search::try_far(int task) {
  for (const int robot : problem_.robots_allowed(task)) {
    const double least = team_.usage(robot) + problem_.work_usage(robot, task) - team_.longest_way(robot);
    if (problem_.fits(robot, least)) try_route(robot, task);
  }
}

// The place where the route grows least; scores never fall with growth but for `average`.
void Search::try_route(int robot, int task) {
  const bool every_place = problem_.objective() == Objective::average;
  const double blink = where_ruined_[task] ? 0.0 : settings_.blink;  // what is tried so often may save the time
  const double work = problem_.work_usage(robot, task);
  double least = kNever;
  int best = Team::kAbsent;
  int before = team_.earliest(robot);
  const int last = team_.latest(robot);
  if (!team_.before(before, last)) return;
  double there = team_.way(robot, before, task);
  while (before != last) {
    const int on = team_.next(before);
    const double further = team_.way(robot, task, on);
    if (blink == 0.0 || random_.uniform() >= blink) {
      const double growth = there + work + further - team_.way(on);
      if (every_place) {
        propose(robot, task, before, growth);
      } else if (growth < least) {
        least = growth;
        best = before;
      }
    }
    before = on;
    if (before != last) there = problem_.is_symmetric() ? further : team_.way(robot, before, task);
  }
  if (best != Team::kAbsent) propose(robot, task, best, least);
}

void Search::try_place(int robot, int task, int after) {
  if (team_.before(after, team_.earliest(robot)) || !team_.before(after, team_.latest(robot))) return;
  if (random_.uniform() < settings_.blink) return;
  propose(robot, task, after, team_.growth(robot, task, after));
}

void Search::propose(int robot, int task, int after, double growth) {
  if (!problem_.fits(robot, team_.usage(robot) + growth)) return;
  const double value = team_cost_.score(robot, task, after, growth, peak_);
  if (value < place_score_) {
    place_score_ = value;
    place_ = {robot, after, growth};
  }
}

// Whether the best place found makes the robot that does most do more, where nothing else counts.
bool Search::raises_greatest() const {
  if (problem_.objective() != Objective::max) return false;
  return place_.robot == Team::kAbsent || team_.usage(place_.robot) + place_.growth > peak_;
}

// The routes of the robots that do least, at every place: where all near ones are full, they may be far away.
void Search::try_idlest(int task) {
  int least = Team::kAbsent, second = Team::kAbsent;
  const auto idler = [&](int robot, int other) {
    return other == Team::kAbsent || team_cost_.load(robot) < team_cost_.load(other);
  };
  for (const int robot : problem_.robots_allowed(task)) {
    if (idler(robot, least)) {
      second = std::exchange(least, robot);
    } else if (idler(robot, second)) {
      second = robot;
    }
  }
  if (least != Team::kAbsent) try_route(least, task);
  if (second != Team::kAbsent) try_route(second, task);
}

// Tasks whose prerequisites found no place cannot stay.
void Search::drop_orphans() {
  if (!problem_.has_prerequisites() || team_.absent().empty()) return;
  std::vector<int> gone = team_.absent();
  for (std::size_t k = 0; k < gone.size(); ++k) {
    for (const int dependant : problem_.dependants(gone[k])) {
      if (!team_.present(dependant)) continue;
      team_.remove(dependant);
      gone.push_back(dependant);
    }
  }
}

// Routes are improved around where tasks were taken out, and where they were put.
void Search::improve() {
  if (!local_search_.applies()) return;
  for (const int place : gaps_) local_search_.wake(place);
  for (const auto* tasks : {&removed_, &again_}) {
    for (const int task : *tasks) {
      if (!team_.present(task)) continue;
      local_search_.wake(team_.prev(task));
      local_search_.wake(task);
      local_search_.wake(team_.next(task));
    }
  }
  local_search_.improve();
}

// What annealing compares: the objective (`average` as a sum), and a penalty for what is left out.
double Search::cost() const { return team_cost_.cost() + penalty_ * team_.absent_weight(); }

void Search::note_best() {
  const double done = static_cast<double>(problem_.tasks()) - static_cast<double>(team_.absent().size());
  Value value{-team_.absent_weight(), team_cost_.objective()};
  if (problem_.objective() == Objective::average && done > 0.0) value.objective /= done;
  if (!value.better_than(best_value_)) return;
  best_value_ = value;
  for (const int robot : team_.take_changed()) best_[robot] = team_.route(robot);
}

double Search::mean_cost() {
  double sum = 0.0;
  std::size_t tasks = 0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    tasks += team_.size(robot);
    sum += problem_.objective() == Objective::average ? team_.arrivals(robot) : team_cost_.load(robot);
  }
  return tasks ? sum / static_cast<double>(tasks) : 0.0;
}

double Search::mean_way() const {
  double sum = 0.0;
  int ways = 0;
  for (int task = 0; task < problem_.tasks(); ++task) {
    if (!team_.present(task)) continue;
    sum += team_.way(task);
    ++ways;
  }
  return ways ? sum / ways : 0.0;
}

}  // namespace muster
