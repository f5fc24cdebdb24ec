#include "traffic/turning_moves.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace muster {

TurningMoves::TurningMoves(const TurningGrid& grid, const HeadingDistances& distances, std::vector<int> states,
                           std::uint64_t seed)
    : grid_(grid),
      distances_(distances),
      random_(seed),
      states_(std::move(states)),
      plans_(states_.size()),
      occupants_(static_cast<std::size_t>(grid.size()) * (kOperationSteps + 1), kNobody),
      choices_(states_.size()),
      costs_(states_.size()),
      weights_(states_.size()),
      ranks_(states_.size()),
      searched_in_(states_.size(), 0),
      visits_(states_.size(), 0),
      is_waiting_(states_.size(), false) {
  for (int robot = 0; robot < robots(); ++robot) {
    int& there = occupant(TurningGrid::vertex_of(states_[robot]), 0);
    if (there != kNobody) throw std::invalid_argument("states: two robots in one cell; expected a cell for each");
    there = robot;
    Operation waits;
    waits.fill(states_[robot]);
    put(robot, waits);
  }
}

void TurningMoves::plan(std::span<const Aim> aims, std::span<const int> order, std::int64_t checks) {
  rank_operations(aims);
  const Decision inherited{plans_, costs_};
  Decision best = sample(order, checks);
  std::int64_t least = weighted_sum();
  for (checks -= checks_done_; checks > 0; checks -= checks_done_) {
    take(inherited);
    Decision other = sample(disturbed(order), checks);
    const std::int64_t sum = weighted_sum();
    if (sum >= least) continue;
    least = sum;
    best = std::move(other);
  }
  take(best);
}

TurningMoves::Decision TurningMoves::sample(std::span<const int> order, std::int64_t checks) {
  checks_done_ = 0;
  inherit_by_priority(order);
  improve(std::min(checks, kSampleChecks));
  return {plans_, costs_};
}

void TurningMoves::take(const Decision& decision) {
  for (int robot = 0; robot < robots(); ++robot) lift(robot);
  for (int robot = 0; robot < robots(); ++robot) put(robot, decision.plans[robot]);
  costs_ = decision.costs;
}

// The same order, but for places that change by up to a tenth of all.
std::vector<int> TurningMoves::disturbed(std::span<const int> order) {
  std::vector<double> keys(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    keys[order[k]] = static_cast<double>(k) + 0.1 * static_cast<double>(order.size()) * random_.uniform();
  std::vector<int> robots_by_key(order.begin(), order.end());
  std::stable_sort(robots_by_key.begin(), robots_by_key.end(), [&](int a, int b) { return keys[a] < keys[b]; });
  return robots_by_key;
}

std::int64_t TurningMoves::weighted_sum() const {
  return std::inner_product(weights_.begin(), weights_.end(), costs_.begin(), std::int64_t{0});
}

void TurningMoves::advance() {
  for (int robot = 0; robot < robots(); ++robot) {
    occupant(TurningGrid::vertex_of(states_[robot]), 0) = kNobody;
    lift(robot);
  }
  for (int robot = 0; robot < robots(); ++robot) {
    Operation rest = plans_[robot];
    states_[robot] = rest[0];
    std::copy(rest.begin() + 1, rest.end(), rest.begin());
    occupant(TurningGrid::vertex_of(states_[robot]), 0) = robot;
    put(robot, rest);
  }
}

void TurningMoves::rank_operations(std::span<const Aim> aims) {
  for (int robot = 0; robot < robots(); ++robot) {
    auto& choices = choices_[robot];
    choices.clear();
    operations_.for_each(grid_, states_[robot], [&](const Operation& operation) {
      choices.push_back({cost_of(aims[robot], states_[robot], operation), operation});
    });
    // Shuffled before, so that those of equal cost come in any order.
    for (std::size_t k = choices.size(); k > 1; --k)
      std::swap(choices[k - 1], choices[random_.below(static_cast<int>(k))]);
    std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) { return a.cost < b.cost; });
    costs_[robot] = cost_of(aims[robot], states_[robot], plans_[robot]);
    weights_[robot] = aims[robot].weight;
  }
}

// The sum of what is left to go after each step of an operation: after the last one it counts most, the others make
// robots go first and wait then. Without a goal the robot is to stay.
std::int64_t TurningMoves::cost_of(const Aim& aim, int state, const Operation& operation) const {
  static constexpr int kLast = 8;
  std::int64_t cost = 0, left = 0;
  int reached = -1;  // the step in which the robot comes to the goal
  for (int step = 0; step < kOperationSteps; ++step) {
    const int at = operation[step];
    if (reached < 0 && TurningGrid::vertex_of(at) == aim.goal) reached = step;
    if (aim.goal == TurningGrid::kNone) {
      left = at == state ? 0 : 1;
    } else if (reached < 0) {
      left = distances_.to_goal(aim.goal, at) + aim.cost_between;
    } else if (aim.next != TurningGrid::kNone) {
      left = distances_.to_goal(aim.next, at);
    } else {
      left = -HeadingDistances::kStep * (step - reached);  // whatever comes then, it begins earlier
    }
    cost += step + 1 == kOperationSteps ? kLast * left : left;
  }
  return cost;
}

void TurningMoves::inherit_by_priority(std::span<const int> order) {
  for (int k = 0; k < robots(); ++k) ranks_[order[k]] = k;
  for (rank_ = 0; rank_ < robots(); ++rank_) try_to_improve(order[rank_], kPriorityChecks);
}

void TurningMoves::improve(std::int64_t checks) {
  rank_ = kImproving;
  for (const std::int64_t end = checks_done_ + checks; checks_done_ < end; ++checks_done_) {
    const int robot = random_.below(robots());
    if (costs_[robot] > choices_[robot].front().cost) try_to_improve(robot, kImprovementChecks);
  }
}

// Gives a robot a better operation than it has, if one is found.
void TurningMoves::try_to_improve(int robot, int checks) {
  ++search_;
  checks_left_ = checks;
  const Operation before = plans_[robot];
  lift(robot);
  if (!is_found(robot, 0, 0)) put(robot, before);
  checks_done_ += checks - checks_left_;
}

// Finds an operation for a robot that has none. `change` is by how much those that displaced it have changed the
// weighted sum. If there is none, all is as before.
bool TurningMoves::is_found(int robot, std::int64_t change, int depth) {
  visits_[robot] = searched_in_[robot] == search_ ? visits_[robot] + 1 : 1;
  searched_in_[robot] = search_;
  is_waiting_[robot] = true;
  const bool found = is_any_choice_taken(robot, change, depth);
  is_waiting_[robot] = false;
  return found;
}

bool TurningMoves::is_any_choice_taken(int robot, std::int64_t change, int depth) {
  const std::int64_t cost_before = costs_[robot];
  for (const Choice& choice : choices_[robot]) {  // the cheapest first
    if (depth == 0 && choice.cost >= cost_before) return false;
    if (--checks_left_ < 0) return false;
    const std::int64_t sum = change + weights_[robot] * (choice.cost - cost_before);
    const int other = in_the_way(robot, choice.operation);
    if (other == kSeveral) continue;
    if (other == kNobody) {
      if (is_improving() && sum > 0) return false;
      put(robot, choice.operation);
    } else if (depth == kDeepest || !may_be_displaced(other, sum) || !is_displaced(other, robot, choice, sum, depth)) {
      continue;
    }
    costs_[robot] = choice.cost;
    return true;
  }
  return false;
}

bool TurningMoves::may_be_displaced(int robot, std::int64_t change) const {
  if (is_waiting_[robot] || (searched_in_[robot] == search_ && visits_[robot] == kMostVisits)) return false;
  if (!is_improving()) return ranks_[robot] > rank_;
  return change + weights_[robot] * (choices_[robot].front().cost - costs_[robot]) <= 0;
}

bool TurningMoves::is_displaced(int other, int robot, const Choice& choice, std::int64_t change, int depth) {
  const Operation before = plans_[other];
  lift(other);
  put(robot, choice.operation);
  if (is_found(other, change, depth + 1)) return true;
  lift(robot);
  put(other, before);
  return false;
}

// The robot that an operation collides with; kNobody, or kSeveral.
int TurningMoves::in_the_way(int robot, const Operation& operation) const {
  int found = kNobody, before = TurningGrid::vertex_of(states_[robot]);
  for (int step = 0; step < kOperationSteps; ++step) {
    const int vertex = TurningGrid::vertex_of(operation[step]);
    const int there = occupant(vertex, step + 1);
    const int coming = before == vertex ? kNobody : occupant(vertex, step);
    const int swapping = coming != kNobody && occupant(before, step + 1) == coming ? coming : kNobody;
    for (const int other : {there, swapping}) {
      if (other == kNobody || other == found) continue;
      if (found != kNobody) return kSeveral;
      found = other;
    }
    before = vertex;
  }
  return found;
}

void TurningMoves::put(int robot, const Operation& operation) {
  plans_[robot] = operation;
  for (int step = 0; step < kOperationSteps; ++step)
    occupant(TurningGrid::vertex_of(operation[step]), step + 1) = robot;
}

void TurningMoves::lift(int robot) {
  for (int step = 0; step < kOperationSteps; ++step)
    occupant(TurningGrid::vertex_of(plans_[robot][step]), step + 1) = kNobody;
}

}  // namespace muster
