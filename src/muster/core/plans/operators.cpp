#include "plans/operators.hpp"

#include <algorithm>
#include <utility>

namespace muster {

Stretch stretch(const Problem& problem, std::span<const int> route, int task) {
  Stretch result{0, static_cast<int>(route.size())};
  const auto before = problem.prerequisites(task), after = problem.dependants(task);
  if (before.empty() && after.empty()) return result;
  for (int k = 0; k < static_cast<int>(route.size()); ++k) {
    if (std::ranges::find(before, route[k]) != before.end()) result.earliest = k + 1;
  }
  for (int k = static_cast<int>(route.size()) - 1; k >= 0; --k) {
    if (std::ranges::find(after, route[k]) != after.end()) result.latest = k;
  }
  return result;
}

RandomAllocation::RandomAllocation(const Problem& problem)
    : problem_(problem), waiting_(problem.tasks()), place_(problem.robots()), usage_(problem.robots()) {}

void RandomAllocation::operator()(Random& random, Draft& draft) {
  ready_.clear();
  tasks_.clear();
  robots_.clear();
  for (int task = 0; task < problem_.tasks(); ++task) {
    waiting_[task] = static_cast<int>(problem_.prerequisites(task).size());
    if (waiting_[task] == 0) ready_.push_back(task);
  }
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    place_[robot] = problem_.start(robot);
    usage_[robot] = 0.0;
  }
  while (!ready_.empty()) {
    std::swap(ready_[random.below(static_cast<int>(ready_.size()))], ready_.back());
    const int task = ready_.back();
    ready_.pop_back();
    const int robot = pick_robot(random, task);
    if (robot == Draft::kNobody) continue;
    tasks_.push_back(task);
    robots_.push_back(robot);
    usage_[robot] = problem_.on_to(robot, usage_[robot], place_[robot], task);
    place_[robot] = task;
    for (const int dependant : problem_.dependants(task)) {
      if (--waiting_[dependant] == 0) ready_.push_back(dependant);
    }
  }
  draft.assign(tasks_, robots_);
}

int RandomAllocation::pick_robot(Random& random, int task) const {
  const auto allowed = problem_.robots_allowed(task);
  const int count = static_cast<int>(allowed.size());
  const int from = count > 1 ? random.below(count) : 0;
  for (int k = 0; k < count; ++k) {
    const int robot = allowed[(from + k) % count];
    const double usage = problem_.on_to(robot, usage_[robot], place_[robot], task);
    if (problem_.fits(robot, usage + problem_.end_usage(robot, task))) return robot;
  }
  return Draft::kNobody;
}

namespace {

// Steps 1 and 2: a random sequence that is not empty, and a random task in it; the last sequence is nobody's.
struct OperatorChoice {
  int robot;
  int at;
  int task;
};

int random_task_left_out(const Problem& problem, Random& random, const Draft& draft) {
  int skip = random.below(problem.tasks() - draft.done());
  for (int task = 0; task < problem.tasks(); ++task) {
    if (draft.robot_of(task) == Draft::kNobody && skip-- == 0) return task;
  }
  return Draft::kNobody;
}

OperatorChoice choose_task(const Problem& problem, Random& random, const Draft& draft) {
  const int sequences = problem.robots() + (draft.done() < problem.tasks() ? 1 : 0);
  const int robot = random.below(sequences);
  if (robot == problem.robots()) return {Draft::kNobody, 0, random_task_left_out(problem, random, draft)};
  if (draft.length(robot) == 0) return {robot, 0, Draft::kNobody};
  const int at = random.below(draft.length(robot));
  return {robot, at, draft.route(robot)[at]};
}

// Step 3: a random robot other than the present one that may do the task.
int choose_robot(const Problem& problem, Random& random, int task, int present) {
  const auto allowed = problem.robots_allowed(task);
  const bool has_present = present != Draft::kNobody;  // a task's present robot is one of those that may do it
  const int count = static_cast<int>(allowed.size()) - (has_present ? 1 : 0);
  if (count <= 0) return Draft::kNobody;
  const int k = random.below(count);
  const bool beyond = has_present && allowed[k] >= present;
  return allowed[k + (beyond ? 1 : 0)];
}

// Step 5: the task leaves its sequence and stands at a random place within the bounds.
Mutation moved(Random& random, const Draft& draft, const OperatorChoice& chosen, int robot, Stretch allowed,
               Draft& mutant) {
  Mutation mutation;
  mutant = draft;
  if (chosen.robot != Draft::kNobody) {
    mutant.remove(chosen.robot, chosen.at);
    mutation.changed[mutation.count++] = chosen.robot;
  }
  mutant.insert(chosen.task, robot, allowed.earliest + random.below(allowed.latest - allowed.earliest + 1));
  mutation.changed[mutation.count++] = robot;
  return mutation;
}

}  // namespace

Mutation reassign(const Problem& problem, Random& random, const Draft& draft, Draft& mutant) {
  const OperatorChoice chosen = choose_task(problem, random, draft);
  if (chosen.task == Draft::kNobody) return {};
  const int robot = choose_robot(problem, random, chosen.task, chosen.robot);
  if (robot == Draft::kNobody) return {};
  const Stretch allowed = stretch(problem, draft.route(robot), chosen.task);  // step 4
  return allowed.earliest > allowed.latest ? Mutation{} : moved(random, draft, chosen, robot, allowed, mutant);
}

namespace {

bool another_may(const Problem& problem, int task, int robot) {
  const auto allowed = problem.robots_allowed(task);
  return std::ranges::any_of(allowed, [&](int other) { return other != robot; });
}

// Steps 1 and 2 with tasks alone that another robot may do, from the place `first` on.
OperatorChoice choose_movable(const Problem& problem, Random& random, const Draft& draft, int first) {
  OperatorChoice choice = choose_task(problem, random, draft);
  if (choice.robot == Draft::kNobody || choice.task == Draft::kNobody) return choice;
  std::vector<int> places;
  const auto route = draft.route(choice.robot);
  for (int k = first; k < static_cast<int>(route.size()); ++k) {
    if (another_may(problem, route[k], choice.robot)) places.push_back(k);
  }
  if (places.empty()) return {choice.robot, 0, Draft::kNobody};
  choice.at = places[random.below(static_cast<int>(places.size()))];
  choice.task = route[choice.at];
  return choice;
}

// Step 4 over a scope: the latest of all lower bounds, the earliest of all upper ones.
Stretch stretch_over(const Problem& problem, const Draft& draft, const OperatorChoice& chosen, int receiver,
                     Bounds bounds) {
  Stretch result{0, draft.length(receiver)};
  for (int robot = 0; robot < problem.robots(); ++robot) {
    if (bounds.scope == Scope::kReceiver && robot != receiver) continue;
    if (bounds.scope == Scope::kOthers && robot == chosen.robot) continue;
    const auto route = draft.route(robot);
    const Stretch one = stretch(problem, route, chosen.task);
    result.earliest = std::max(result.earliest, one.earliest);
    if (one.latest < static_cast<int>(route.size())) result.latest = std::min(result.latest, one.latest);
  }
  if (bounds.inner) return {std::max(result.earliest, 1), result.latest - 1};
  return result;
}

}  // namespace

Mutation reassign_within(const Problem& problem, Random& random, const Draft& draft, Bounds bounds, Draft& mutant) {
  const OperatorChoice chosen = choose_movable(problem, random, draft, bounds.inner ? 1 : 0);
  if (chosen.task == Draft::kNobody) return {};
  const int robot = choose_robot(problem, random, chosen.task, chosen.robot);
  if (robot == Draft::kNobody) return {};
  const Stretch allowed = stretch_over(problem, draft, chosen, robot, bounds);
  return allowed.earliest > allowed.latest ? Mutation{} : moved(random, draft, chosen, robot, allowed, mutant);
}

bool Crossover::operator()(Draft& p, Draft& q) {
  bool any = false;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    const auto in_p = p.route(robot), in_q = q.route(robot);
    for (int k = 0; k < static_cast<int>(in_p.size()); ++k) place_p_[in_p[k]] = k;
    for (int k = 0; k < static_cast<int>(in_q.size()); ++k) place_q_[in_q[k]] = k;
    common_.clear();  // step 3: the same task given to the same robot, whatever its order
    for (const int task : in_p) {
      if (q.robot_of(task) == robot) common_.push_back(task);
    }
    for (const int task : common_) {
      const int from_p = place_p_[task], from_q = place_q_[task];
      if (from_p == from_q || from_q >= p.length(robot) || from_p >= q.length(robot)) continue;
      if (!swappable(p, robot, task, from_p, from_q) || !swappable(q, robot, task, from_q, from_p)) continue;
      exchange(p, place_p_, robot, task, from_q);
      exchange(q, place_q_, robot, task, from_p);
      any = true;
    }
  }
  return any;
}

// Step 5, for the task and for the one that it changes places with: both stay between their prerequisites and
// dependants of the same route. Deadlocks across routes are the evaluation's to find.
bool Crossover::swappable(const Draft& draft, int robot, int task, int from, int to) const {
  const auto route = draft.route(robot);
  const auto independent = [&](int first, int second) {  // whether `second` need not wait for `first`
    const auto before = problem_.prerequisites(second);
    return std::ranges::find(before, first) == before.end();
  };
  const int other = route[to];
  const int low = std::min(from, to), high = std::max(from, to);
  const int early = from < to ? task : other, late = from < to ? other : task;
  if (!independent(early, late)) return false;
  for (int k = low + 1; k < high; ++k) {
    if (!independent(early, route[k]) || !independent(route[k], late)) return false;
  }
  return true;
}

void Crossover::exchange(Draft& draft, std::vector<int>& place, int robot, int task, int to) const {
  const int from = place[task], other = draft.route(robot)[to];
  draft.swap(robot, from, to);
  place[task] = to;
  place[other] = from;
}

}  // namespace muster
