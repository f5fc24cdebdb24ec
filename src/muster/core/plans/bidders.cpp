#include "plans/bidders.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "plans/quantum.hpp"

namespace muster {

Bidders::Bidders(const Problem& problem, bool insert, Figure figure)
    : problem_(problem),
      insert_(insert),
      figure_(figure),
      evaluator_(problem),
      draft_(problem),
      precedence_(problem),
      announced_(problem.tasks()),
      missing_(problem.tasks()),
      listed_(problem.tasks()),
      growth_(static_cast<std::size_t>(problem.robots()) * problem.tasks()),
      place_(growth_.size()),
      lowest_(problem.robots()),
      stale_(problem.robots()),
      leaves_(problem.robots()),
      done_(problem.robots()) {
  set_routes(Routes(problem.robots()));
}

void Bidders::set_routes(const Routes& routes) {
  draft_ = draft_from(problem_, routes);
  if (!evaluator_.evaluate(draft_)) throw std::invalid_argument("the routes are not admissible");
  if (problem_.has_prerequisites()) {
    evaluator_.order(draft_);
    precedence_.follow(draft_, evaluator_.sequence());
  }
  for (int task = 0; task < problem_.tasks(); ++task) {
    const auto before = problem_.prerequisites(task);
    missing_[task] = static_cast<int>(
        std::ranges::count_if(before, [&](int other) { return draft_.robot_of(other) == Draft::kNobody; }));
  }
  for (int robot = 0; robot < problem_.robots(); ++robot) take_in(robot);
  std::ranges::fill(announced_, 0);
  std::ranges::fill(listed_, kClosed);
  std::ranges::fill(stale_, 1);
  open_.clear();
}

void Bidders::announce(int task) {
  if (draft_.robot_of(task) != Draft::kNobody) throw std::invalid_argument("the task is in a route");
  announced_[task] = 1;
  open_if_ready(task);
}

void Bidders::open_if_ready(int task) {
  if (!announced_[task] || missing_[task] || is_open(task)) return;
  listed_[task] = static_cast<int>(open_.size());
  open_.push_back(task);
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    look(robot, task);
    if (!stale_[robot]) prefer(robot, task);
  }
}

void Bidders::close(int task) {
  listed_[open_.back()] = listed_[task];
  open_[listed_[task]] = open_.back();
  open_.pop_back();
  listed_[task] = kClosed;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (lowest_[robot].task == task) stale_[robot] = 1;
  }
}

std::vector<double> Bidders::offers(int robot) {
  std::vector<double> offers(problem_.tasks(), kNever);
  for (const int task : open_) offers[task] = offer(robot, task);
  return offers;
}

std::vector<double> Bidders::offers_for(int task) {
  std::vector<double> offers(problem_.robots(), kNever);
  for (const int robot : problem_.robots_allowed(task)) offers[robot] = offer(robot, task);
  return offers;
}

double Bidders::offer(int robot, int task) {
  if (!is_open(task)) return kNever;
  const double growth = growth_[index(robot, task)];
  if (!problem_.fits(robot, usage(robot) + growth)) return kNever;
  switch (figure_) {
    case Figure::growth:
      break;
    case Figure::arrivals:
      return in_quanta(arrivals(robot, task));
    case Figure::end:
      return in_quanta(end(robot, task));
  }
  return in_quanta(growth);
}

const Bidders::Lowest& Bidders::lowest(int robot) {
  if (stale_[robot]) {
    lowest_[robot] = Lowest{};
    for (const int task : open_) prefer(robot, task);
    stale_[robot] = 0;
  }
  return lowest_[robot];
}

void Bidders::prefer(int robot, int task) {
  Lowest& lowest = lowest_[robot];
  const double figure = offer(robot, task);
  if (figure < lowest.figure || (figure == lowest.figure && task < lowest.task)) lowest = {task, figure};
}

void Bidders::award(int robot, int task) {
  if (!std::isfinite(offer(robot, task))) throw std::invalid_argument("the robot has no offer for this task");
  const int at = place_[index(robot, task)];
  close(task);
  announced_[task] = 0;
  draft_.insert(task, robot, at);
  take_in(robot);
  if (waiting_counts()) std::ranges::fill(stale_, 1);
  const auto later = precedence_.insert(draft_, robot, at);
  for (const int other : open_) look_again(robot, other, at);
  for (const int moved : later) {
    for (const int waiting : problem_.dependants(moved)) {
      if (!is_open(waiting)) continue;
      for (int bidder = 0; bidder < problem_.robots(); ++bidder) look(bidder, waiting);
      std::ranges::fill(stale_, 1);
    }
  }
  for (const int dependant : problem_.dependants(task)) {
    --missing_[dependant];
    open_if_ready(dependant);
  }
}

std::vector<int> Bidders::relinquish(int task) {
  if (draft_.robot_of(task) == Draft::kNobody) throw std::invalid_argument("the task is in no route");
  std::vector<int> returned{task};
  Draft rest = draft_;
  for (std::size_t k = 0; k < returned.size(); ++k) {
    const auto route = rest.route(rest.robot_of(returned[k]));
    rest.remove(rest.robot_of(returned[k]), static_cast<int>(std::ranges::find(route, returned[k]) - route.begin()));
    for (const int dependant : problem_.dependants(returned[k])) {
      const bool known = std::ranges::find(returned, dependant) != returned.end();
      if (rest.robot_of(dependant) != Draft::kNobody && !known) returned.push_back(dependant);
    }
  }
  if (!evaluator_.evaluate(rest)) return {};
  if (problem_.has_prerequisites()) precedence_.follow(rest, evaluator_.sequence());
  std::swap(draft_, rest);
  for (const int gone : returned) {
    take_in(rest.robot_of(gone));
    for (const int dependant : problem_.dependants(gone)) {
      ++missing_[dependant];
      if (is_open(dependant)) close(dependant);
    }
  }
  std::ranges::fill(stale_, 1);
  for (const int open : open_) {
    for (int robot = 0; robot < problem_.robots(); ++robot) look(robot, open);
  }
  return returned;
}

// Works out what the robot's route, which has changed, comes to.
void Bidders::take_in(int robot) {
  draft_.measure(problem_, robot);
  scheduled_ = false;
  stale_[robot] = 1;
  auto& leaves = leaves_[robot];
  leaves.clear();
  double usage = 0.0, time = problem_.available_from(robot);
  int place = problem_.start(robot);
  for (const int task : draft_.route(robot)) {
    leaves.push_back(usage);
    usage = problem_.on_to(robot, usage, place, task);
    time += problem_.travel_time(robot, place, task) + problem_.work_time(robot, task);
    place = task;
  }
  leaves.push_back(usage);
  done_[robot] = time;
}

// The first place in the robot's route where the task may go: behind what stays, and what it waits for.
int Bidders::earliest(int robot, int task) const {
  return std::max(problem_.fixed(robot), precedence_.earliest(robot, task));
}

// Finds the robot's best place for an open task.
void Bidders::look(int robot, int task) {
  growth_[index(robot, task)] = kNever;
  if (!problem_.allowed(robot, task)) return;
  const int last = draft_.length(robot);
  for (int at = insert_ ? earliest(robot, task) : last; at <= last; ++at) consider(robot, task, at);
}

// The same after a task was put into the robot's route at a place: all other places are as they were.
void Bidders::look_again(int robot, int task, int at) {
  if (!problem_.allowed(robot, task)) return;
  int& place = place_[index(robot, task)];
  const bool had_none = !std::isfinite(growth_[index(robot, task)]);
  if (!insert_ || had_none || place == at) return look(robot, task);
  if (place > at) ++place;
  const int first = earliest(robot, task);
  for (const int candidate : {at, at + 1}) {
    if (candidate >= first) consider(robot, task, candidate);
  }
}

void Bidders::consider(int robot, int task, int at) {
  const double growth = problem_.growth(robot, draft_.route(robot), task, at);
  double& least = growth_[index(robot, task)];
  int& place = place_[index(robot, task)];
  const double here = in_quanta(growth), best = in_quanta(least);
  if (here < best || (here == best && at < place && std::isfinite(growth))) {
    least = growth;
    place = at;
  }
}

double Bidders::arrivals(int robot, int task) const {
  const auto route = draft_.route(robot);
  const int at = place_[index(robot, task)], before = at ? route[at - 1] : problem_.start(robot);
  const double later = static_cast<double>(draft_.length(robot) - at);
  return leaves_[robot][at] + problem_.travel_usage(robot, before, task) + later * growth_[index(robot, task)];
}

double Bidders::end(int robot, int task) {
  if (waiting_counts()) return end_with_waiting(robot, task);
  const auto route = draft_.route(robot);
  const int at = place_[index(robot, task)], before = at ? route[at - 1] : problem_.start(robot);
  const double done = done_[robot] + problem_.travel_time(robot, before, task) + problem_.work_time(robot, task);
  if (at == draft_.length(robot)) return done;
  return done + problem_.travel_time(robot, task, route[at]) - problem_.travel_time(robot, before, route[at]);
}

// Prerequisites in other routes end when they do now, whatever this task would change there.
double Bidders::end_with_waiting(int robot, int task) {
  if (!scheduled_) evaluator_.makespan(draft_);
  scheduled_ = true;
  const auto route = draft_.route(robot);
  const int at = place_[index(robot, task)];
  const bool first = at == 0;
  int from = first ? problem_.start(robot) : route[at - 1];
  double now = first ? problem_.available_from(robot) : evaluator_.end_of(from);
  const auto go_on = [&](int next) {
    now += problem_.travel_time(robot, from, next);
    for (const int before : problem_.prerequisites(next)) {
      if (draft_.robot_of(before) != robot) now = std::max(now, evaluator_.end_of(before));
    }
    now += problem_.work_time(robot, next);
    from = next;
  };
  go_on(task);
  for (const int next : route.subspan(at)) go_on(next);
  return now;
}

}  // namespace muster
