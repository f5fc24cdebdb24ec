#include "plans/team.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace muster {

namespace {

constexpr std::int64_t kGap = std::int64_t{1} << 24;  // between the labels of places that follow each other

}  // namespace

Team::Team(const Problem& problem, const Routes& routes)
    : problem_(problem),
      timed_(problem.objective() == Objective::makespan),
      next_(problem.tasks() + 2 * problem.robots()),
      prev_(next_.size()),
      robot_of_(next_.size()),
      label_(next_.size()),
      way_(next_.size()),
      leaving_(next_.size()),
      size_(problem.robots()),
      last_fixed_(problem.robots()),
      usage_(problem.robots()),
      done_(problem.robots()),
      arrivals_(problem.robots()),
      stale_(problem.robots()),
      rank_(next_.size()),
      changed_(problem.robots()),
      touched_(problem.robots()),
      listed_(problem.tasks()),
      stamp_of_(problem.robots(), 0),
      earliest_(problem.robots()),
      latest_(problem.robots()),
      task_stamp_(problem.tasks(), 0) {
  begin(routes);
}

void Team::begin(const Routes& routes) {
  forget();
  std::ranges::fill(robot_of_, kAbsent);
  std::ranges::fill(changed_, 1);
  absent_.clear();
  absent_weight_ = 0.0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    const int start = problem_.start(robot), end = problem_.end(robot);
    robot_of_[start] = robot_of_[end] = robot;
    last_fixed_[robot] = start;
    int place = start, at = 0;
    for (const int task : routes[robot]) {
      robot_of_[task] = robot;
      next_[place] = task;
      prev_[task] = place;
      place = task;
      if (at++ < problem_.fixed(robot)) last_fixed_[robot] = task;
    }
    next_[place] = end;
    prev_[end] = place;
    size_[robot] = static_cast<int>(routes[robot].size());
    relabel(robot);
    for (int each = next_[start];; each = next_[each]) {
      find_way(each);
      if (each == end) break;
    }
    stale_[robot] = 1;
    measure(robot);
  }
  for (int task = 0; task < problem_.tasks(); ++task) {
    if (!present(task)) vanish(task);
  }
}

int Team::task_at(int robot, int k) const {
  int place;
  if (k < size_[robot] / 2) {
    place = next_[problem_.start(robot)];
    for (; k > 0; --k) place = next_[place];
  } else {
    place = prev_[problem_.end(robot)];
    for (k = size_[robot] - 1 - k; k > 0; --k) place = prev_[place];
  }
  return place;
}

double Team::longest_way(int robot) const {
  double longest = way_[problem_.end(robot)];
  for (int place = next_[problem_.start(robot)]; is_task(place); place = next_[place]) {
    longest = std::max(longest, way_[place]);
  }
  return longest;
}

double Team::arrivals(int robot) {
  measure(robot);
  return arrivals_[robot];
}

// The additions are those of `Problem::walk`, in its order.
void Team::measure(int robot) {
  if (!std::exchange(stale_[robot], 0)) return;
  double usage = 0.0, arrivals = 0.0, done = problem_.available_from(robot);
  int before = problem_.start(robot), rank = 0;
  leaving_[before] = 0.0;
  rank_[before] = 0;
  for (int task = next_[before]; is_task(task); before = task, task = next_[task]) {
    const double arrival = usage + way_[task];
    arrivals += arrival;
    usage = arrival + problem_.work_usage(robot, task);
    if (timed_) done = done + problem_.travel_time(robot, before, task) + problem_.work_time(robot, task);
    leaving_[task] = usage;
    rank_[task] = ++rank;
  }
  usage_[robot] = usage + way_[problem_.end(robot)];
  arrivals_[robot] = arrivals;
  done_[robot] = done;
}

double Team::growth(int robot, int task, int after) const {
  const int on = next_[after];
  return way(robot, after, task) + problem_.work_usage(robot, task) + way(robot, task, on) - way_[on];
}

double Team::later_arrivals(int robot, int task, int after, double growth) {
  measure(robot);
  const double later = static_cast<double>(size_[robot] - rank_[after]);
  return leaving_[after] + way(robot, after, task) + later * growth;
}

double Team::longer(int robot, int task, int after) const {
  const int on = next_[after];
  const double there = problem_.travel_time(robot, after, task) + problem_.work_time(robot, task);
  return there + seconds(robot, task, on) - seconds(robot, after, on);
}

// The way home does not count.
double Team::seconds(int robot, int from, int to) const {
  return is_task(to) ? problem_.travel_time(robot, from, to) : 0.0;
}

void Team::insert(int task, int after) {
  const int robot = robot_of_[after], on = next_[after];
  touch(robot);
  const double growth_here = growth(robot, task, after), longer_here = timed_ ? longer(robot, task, after) : 0.0;
  link(task, after);
  appear(task);
  find_way(on);
  add(robot, growth_here, longer_here);
  changes_.push_back({Kind::inserted, task, task, after});
}

void Team::remove(int task) {
  const int robot = robot_of_[task], after = prev_[task], on = next_[task];
  touch(robot);
  changes_.push_back({Kind::removed, task, task, after});
  unlink(task);
  vanish(task);
  find_way(on);
  add(robot, -growth(robot, task, after), timed_ ? -longer(robot, task, after) : 0.0);
}

void Team::reverse(int first, int last) {
  const int robot = robot_of_[first], before = prev_[first], on = next_[last];
  touch(robot);
  const double ways = way_[first] + way_[on], seconds_then = timed_ ? seconds(robot, last, on) : 0.0;
  const double seconds_there = timed_ ? seconds(robot, before, first) : 0.0;
  turn(first, last);
  changes_.push_back({Kind::reversed, last, first, before});
  add(robot, way_[last] + way_[on] - ways,
      timed_ ? seconds(robot, before, last) + seconds(robot, first, on) - seconds_there - seconds_then : 0.0);
}

void Team::move(int first, int last, int after) {
  const int from = robot_of_[first], to = robot_of_[after], before = prev_[first], on = next_[last];
  touch(from);
  touch(to);
  changes_.push_back({Kind::moved, first, last, before});
  Figures lost = figures(from, first, on), gained = figures(to, next_[after], next_[after]);
  splice(first, last, after);
  const Figures closed = figures(from, on, on), opened = figures(to, first, next_[last]);
  add(from, closed.usage - lost.usage, closed.done - lost.done);
  add(to, opened.usage - gained.usage, opened.done - gained.done);
}

// From the place before `first` to the arrival at `end`.
Team::Figures Team::figures(int robot, int first, int end) const {
  Figures sum;
  for (int place = first;; place = next_[place]) {
    sum.usage += way_[place];
    if (timed_) sum.done += seconds(robot, prev_[place], place);
    if (place == end) return sum;
    sum.usage += problem_.work_usage(robot, place);
    if (timed_) sum.done += problem_.work_time(robot, place);
  }
}

// A task's place in the list of those absent may be another after `rollback`.
void Team::appear(int task) {
  absent_[listed_[task]] = absent_.back();
  listed_[absent_.back()] = listed_[task];
  absent_.pop_back();
  absent_weight_ = absent_.empty() ? 0.0 : absent_weight_ - problem_.priority(task);
}

void Team::vanish(int task) {
  listed_[task] = static_cast<int>(absent_.size());
  absent_.push_back(task);
  absent_weight_ += problem_.priority(task);
}

// A sum that is infinite cannot become finite again but from the beginning.
void Team::add(int robot, double usage, double done) {
  usage_[robot] += usage;
  done_[robot] += done;
  if (empty(robot) || !std::isfinite(usage_[robot])) measure(robot);
}

void Team::find_way(int place) { way_[place] = way(robot_of_[place], prev_[place], place); }

void Team::link(int task, int after) {
  const int robot = robot_of_[after], on = next_[after];
  robot_of_[task] = robot;
  next_[after] = prev_[on] = task;
  prev_[task] = after;
  next_[task] = on;
  ++size_[robot];
  find_way(task);
  label_[task] = (label_[after] + label_[on]) / 2;
  if (label_[task] == label_[after]) relabel(robot);
}

void Team::unlink(int task) {
  const int before = prev_[task], on = next_[task];
  next_[before] = on;
  prev_[on] = before;
  --size_[robot_of_[task]];
  robot_of_[task] = kAbsent;
}

void Team::turn(int first, int last) {
  const int before = prev_[first], on = next_[last];
  gather(first, last);
  for (std::size_t k = 0; k < part_.size(); ++k) {
    std::swap(next_[part_[k]], prev_[part_[k]]);
    if (k + 1 < part_.size()) way_[part_[k]] = way_[part_[k + 1]];
  }
  for (std::size_t low = 0, high = part_.size() - 1; low < high; ++low, --high) {
    std::swap(label_[part_[low]], label_[part_[high]]);
  }
  next_[before] = last;
  prev_[last] = before;
  next_[first] = on;
  prev_[on] = first;
  find_way(last);
  find_way(on);
}

void Team::splice(int first, int last, int after) {
  const int from = robot_of_[first], to = robot_of_[after], before = prev_[first], on = next_[last];
  gather(first, last);
  const auto moved = static_cast<int>(part_.size());
  next_[before] = on;
  prev_[on] = before;
  size_[from] -= moved;
  size_[to] += moved;
  const int then = next_[after];
  next_[after] = first;
  prev_[first] = after;
  next_[last] = then;
  prev_[then] = last;
  const std::int64_t gap = (label_[then] - label_[after]) / (moved + 1);
  std::int64_t label = label_[after];
  for (const int task : part_) {
    robot_of_[task] = to;
    label_[task] = label += gap;
  }
  if (gap == 0) relabel(to);
  if (from == to) {
    find_way(first);
  } else {
    for (const int task : part_) find_way(task);
  }
  find_way(then);
  find_way(on);
}

void Team::gather(int first, int last) {
  part_.clear();
  for (int task = first; task != last; task = next_[task]) part_.push_back(task);
  part_.push_back(last);
}

void Team::relabel(int robot) {
  std::int64_t label = 0;
  const int end = problem_.end(robot);
  for (int place = problem_.start(robot); place != end; place = next_[place], label += kGap) label_[place] = label;
  label_[end] = label;
}

void Team::touch(int robot) {
  stale_[robot] = changed_[robot] = 1;
  if (std::exchange(touched_[robot], 1)) return;
  saved_.push_back({robot, usage_[robot], done_[robot]});
}

void Team::settle() {
  for (const Saved& saved : saved_) measure(saved.robot);
}

bool Team::fits() const {
  return std::ranges::all_of(saved_,
                             [&](const Saved& saved) { return problem_.fits(saved.robot, usage_[saved.robot]); });
}

void Team::commit() {
  settle();
  forget();
}

void Team::forget() {
  for (const Saved& saved : saved_) touched_[saved.robot] = 0;
  saved_.clear();
  changes_.clear();
}

void Team::rollback() {
  for (auto change = changes_.rbegin(); change != changes_.rend(); ++change) {
    const auto [kind, first, last, before] = *change;
    const int on = next_[last];
    switch (kind) {
      case Kind::inserted:
        unlink(first);
        vanish(first);
        find_way(on);
        break;
      case Kind::removed:
        link(first, before);
        appear(first);
        find_way(next_[first]);
        break;
      case Kind::reversed:
        turn(first, last);
        break;
      case Kind::moved:
        splice(first, last, before);
        break;
    }
  }
  for (const Saved& saved : saved_) {
    usage_[saved.robot] = saved.usage;
    done_[saved.robot] = saved.done;
    stale_[saved.robot] = 1;
  }
  forget();
}

std::vector<int> Team::route(int robot) const {
  std::vector<int> route;
  route.reserve(size_[robot]);
  for (int task = next_[problem_.start(robot)]; is_task(task); task = next_[task]) route.push_back(task);
  return route;
}

Routes Team::routes() const {
  Routes routes;
  for (int robot = 0; robot < problem_.robots(); ++robot) routes.push_back(route(robot));
  return routes;
}

std::vector<int> Team::take_changed() {
  std::vector<int> changed;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (std::exchange(changed_[robot], 0)) changed.push_back(robot);
  }
  return changed;
}

void Team::bound(int task) {
  ++stamp_;
  if (problem_.prerequisites(task).empty() && problem_.dependants(task).empty()) return;
  go_back(task);
  go_forth(task);
}

void Team::see(int robot) {
  if (stamp_of_[robot] == stamp_) return;
  stamp_of_[robot] = stamp_;
  earliest_[robot] = problem_.start(robot);
  latest_[robot] = problem_.end(robot);
}

// All that comes before a prerequisite comes before the task: in routes up to it, and what these tasks wait for. Tasks
// that are absent for now still pass on what they wait for.
void Team::go_back(int task) {
  stack_.assign(problem_.prerequisites(task).begin(), problem_.prerequisites(task).end());
  while (!stack_.empty()) {
    const int awaited = stack_.back();
    stack_.pop_back();
    const int robot = robot_of_[awaited];
    if (robot == kAbsent) {
      if (std::exchange(task_stamp_[awaited], stamp_) == stamp_) continue;
      for (const int other : problem_.prerequisites(awaited)) stack_.push_back(other);
      continue;
    }
    see(robot);
    for (int& place = earliest_[robot]; before(place, awaited);) {
      place = next_[place];
      for (const int other : problem_.prerequisites(place)) stack_.push_back(other);
    }
  }
}

// All that comes after a dependant comes after the task; dependants that are absent still pass it on.
void Team::go_forth(int task) {
  stack_.assign(problem_.dependants(task).begin(), problem_.dependants(task).end());
  while (!stack_.empty()) {
    const int waiting = stack_.back();
    stack_.pop_back();
    const int robot = robot_of_[waiting];
    if (robot == kAbsent) {
      if (std::exchange(task_stamp_[waiting], stamp_) == stamp_) continue;
      for (const int other : problem_.dependants(waiting)) stack_.push_back(other);
      continue;
    }
    see(robot);
    for (int& place = latest_[robot]; before(waiting, place);) {
      place = prev_[place];
      for (const int other : problem_.dependants(place)) stack_.push_back(other);
    }
  }
}

}  // namespace muster
