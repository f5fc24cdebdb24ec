#include "plans/greedy.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace muster {

Greedy::Greedy(const Problem& problem, bool balanced)
    : problem_(problem),
      balanced_(balanced),
      left_(problem.tasks()),
      allocated_(problem.tasks(), 0),
      waiting_(problem.tasks()),
      place_in_list_(problem.tasks()),
      surroundings_(problem.classes()),
      coefficients_(problem.classes()),
      least_coefficient_(problem.classes(), 1.0),
      nearby_(problem.robots()),
      preferred_(problem.robots()),
      stale_(problem.robots(), 1),
      usage_(problem.robots(), 0.0),
      routes_(problem.robots()) {
  for (int robot = 0; robot < problem.robots(); ++robot) position_.push_back(problem.start(robot));
  for (auto& of_class : surroundings_) of_class.resize(problem.has_prerequisites() ? problem.tasks() : 0);
  for (int task = 0; task < problem.tasks(); ++task) {
    waiting_[task] = static_cast<int>(problem.prerequisites(task).size());
    if (!problem.dependants(task).empty()) {
      needed_.push_back(task);
      survey(task);
    }
    if (waiting_[task] == 0) make_ready(task);
  }
}

namespace {
// A sum that subtraction has brought below this share of its first value is added up anew: what is left of it may be
// rounding alone.
constexpr double kSumRounding = 1e-6;
constexpr std::size_t kNearby = 16;  // tasks with dependants that a robot keeps
}  // namespace

std::optional<Matching> Greedy::select() {
  std::optional<Matching> chosen;
  double lowest = 0.0;
  weigh_dependants();
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (balanced_ && chosen && usage_[robot] > lowest) continue;  // f is at least the usage
    if (stale_[robot]) {
      preferred_[robot] = plain_preference(robot);
      stale_[robot] = 0;
    }
    Preference best = preferred_[robot];
    consider_needed(robot, best);
    if (best.task == Draft::kNobody) continue;
    const double f = balanced_ ? best.cost + usage_[robot] : best.cost;
    if (!chosen || f < lowest || (f == lowest && best.task < chosen->task)) {
      chosen = Matching{robot, best.task, best.cost};
      lowest = f;
    }
  }
  return chosen;
}

void Greedy::assign(int robot, int task) {
  if (robot < 0 || robot >= problem_.robots() || task < 0 || task >= problem_.tasks()) {
    throw std::invalid_argument("no such robot or task");
  }
  if (allocated_[task]) throw std::invalid_argument("the task is allocated already");
  allocated_[task] = 1;
  --left_;
  usage_[robot] = problem_.on_to(robot, usage_[robot], position_[robot], task);
  position_[robot] = task;
  routes_[robot].push_back(task);
  stale_[robot] = 1;
  nearby_[robot].known = false;
  const bool plain = problem_.dependants(task).empty();
  if (waiting_[task] == 0) drop(plain ? plain_ready_ : needed_ready_, task);
  if (!plain) std::erase(needed_, task);
  for (int other = 0; other < problem_.robots(); ++other) {
    if (preferred_[other].task == task) stale_[other] = 1;
  }
  for (int c = 0; c < problem_.classes(); ++c) {
    for (const int needed : needed_) {
      const double distance = problem_.distance(c, needed, task);
      if (!std::isfinite(distance)) continue;
      Surroundings& around = surroundings_[c][needed];
      around.sum_to_others -= distance;
      --around.others;
      if (around.sum_to_others != 0.0 && around.sum_to_others < kSumRounding * around.sum_at_first) {
        around.sum_to_others = sum_to_others(c, needed);
      }
    }
  }
  for (const int dependant : problem_.dependants(task)) {
    if (--waiting_[dependant] == 0 && !allocated_[dependant]) make_ready(dependant);
  }
}

void Greedy::make_ready(int task) {
  const bool plain = problem_.dependants(task).empty();
  auto& list = plain ? plain_ready_ : needed_ready_;
  place_in_list_[task] = static_cast<int>(list.size());
  list.push_back(task);
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (plain && !stale_[robot]) consider(robot, task, 1.0, preferred_[robot]);
    Nearby& nearby = nearby_[robot];
    if (!plain && nearby.known && cost(robot, task) < nearby.beyond) nearby.tasks.push_back(task);
  }
}

void Greedy::drop(std::vector<int>& tasks, int task) {
  tasks[place_in_list_[task]] = tasks.back();
  place_in_list_[tasks.back()] = place_in_list_[task];
  tasks.pop_back();
}

Greedy::Preference Greedy::plain_preference(int robot) const {
  Preference best;
  for (const int task : plain_ready_) consider(robot, task, 1.0, best);
  return best;
}

// Steps 3 and 4 for one matching: it is dropped if inadmissible, and kept if its debit is the least so far.
void Greedy::consider(int robot, int task, double coefficient, Preference& best) const {
  if (!problem_.allowed(robot, task)) return;
  const double own_cost = cost(robot, task), debit = coefficient * own_cost;
  if (best.after(debit, task) && admissible(robot, task)) best = {debit, own_cost, task};
}

double Greedy::cost(int robot, int task) const {
  return problem_.travel_usage(robot, position_[robot], task) + problem_.work_usage(robot, task);
}

bool Greedy::admissible(int robot, int task) const {
  const double usage = problem_.on_to(robot, usage_[robot], position_[robot], task);
  return problem_.allowed(robot, task) && problem_.fits(robot, usage + problem_.end_usage(robot, task));
}

void Greedy::weigh_dependants() {
  for (int c = 0; c < problem_.classes(); ++c) {
    coefficients_[c].clear();
    for (const int task : needed_ready_) coefficients_[c].push_back(dependency_coefficient(c, task));
    least_coefficient_[c] = needed_ready_.empty() ? 1.0 : std::ranges::min(coefficients_[c]);
  }
}

// Step 3 and 4 for the tasks with dependants.
void Greedy::consider_needed(int robot, Preference& best) {
  Nearby& nearby = nearby_[robot];
  const int travel_class = problem_.travel_class(robot);
  const auto& coefficients = coefficients_[travel_class];
  if (!nearby.known) look_around(robot);
  std::erase_if(nearby.tasks, [&](int task) { return allocated_[task] != 0; });
  for (const int task : nearby.tasks) consider(robot, task, coefficients[place_in_list_[task]], best);
  if (std::isinf(nearby.beyond) || least_coefficient_[travel_class] * nearby.beyond > best.debit) return;
  for (std::size_t k = 0; k < needed_ready_.size(); ++k) consider(robot, needed_ready_[k], coefficients[k], best);
  nearby.known = nearby.tasks.size() >= kNearby / 2;
}

// What a robot cannot do next it cannot do later either, until it moves: its usage stays.
void Greedy::look_around(int robot) {
  costs_.clear();
  for (const int task : needed_ready_) {
    if (admissible(robot, task)) costs_.emplace_back(cost(robot, task), task);
  }
  Nearby& nearby = nearby_[robot];
  nearby = {true, Problem::kInfinity, {}};
  if (costs_.size() > kNearby) {
    std::ranges::nth_element(costs_, costs_.begin() + kNearby);
    nearby.beyond = costs_[kNearby].first;
    costs_.resize(kNearby);
  }
  for (const auto& [_, task] : costs_) nearby.tasks.push_back(task);
}

void Greedy::survey(int task) {
  const auto dependants = problem_.dependants(task);
  for (int c = 0; c < problem_.classes(); ++c) {
    Surroundings& around = surroundings_[c][task];
    int reached = 0;
    for (const int dependant : dependants) {
      const double distance = problem_.distance(c, task, dependant);
      if (!std::isfinite(distance)) continue;
      around.to_dependants += distance;
      ++reached;
    }
    if (reached) around.to_dependants /= reached;
    for (int other = 0; other < problem_.tasks(); ++other) {
      if (other != task && std::isfinite(problem_.distance(c, task, other))) ++around.others;
    }
    around.sum_to_others = around.sum_at_first = sum_to_others(c, task);
  }
}

double Greedy::sum_to_others(int travel_class, int task) const {
  double sum = 0.0;
  for (int other = 0; other < problem_.tasks(); ++other) {
    const double distance = problem_.distance(travel_class, task, other);
    if (other != task && !allocated_[other] && std::isfinite(distance)) sum += distance;
  }
  return sum;
}

// Kp of (3.20), with N_T the number of tasks not yet allocated.
double Greedy::dependency_coefficient(int travel_class, int task) const {
  const int dependants = static_cast<int>(problem_.dependants(task).size());
  if (dependants == left_ - 1) return 0.0;
  const Surroundings& around = surroundings_[travel_class][task];
  const double near = around.to_dependants;
  const double all = around.others ? around.sum_to_others / around.others : 0.0;
  const double share = near + all > 0.0 ? near / (near + all) : 0.5;
  return 1.0 - static_cast<double>(dependants) / left_ * (1.0 - share);
}

}  // namespace muster
