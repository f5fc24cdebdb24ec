#include "traffic/lifelong_errands.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace muster {

namespace {

constexpr int kNoTask = HeadingDistances::kNoWay;  // what a task costs that a robot cannot carry out
constexpr int kToStart = 2;                        // weight of the way to a task, if that of the way within it is 1
constexpr int kKeep = 6;                           // by how much another task is to cost less
constexpr int kSamePriority = 20;                  // steps in which the part of chance in a priority stays

std::vector<int> eastwards(std::vector<int> vertices) {
  for (int& vertex : vertices) vertex *= 4;
  return vertices;
}

}  // namespace

LifelongErrands::LifelongErrands(TurningGrid grid, const std::vector<int>& starts,
                                 std::vector<std::vector<int>> errands, int most_revealed, LifelongLimits limits,
                                 std::uint64_t seed)
    : grid_(std::move(grid)),
      errands_(std::move(errands)),
      most_revealed_(most_revealed),
      limits_(limits),
      distances_(grid_, limits.table_bytes),
      moves_(grid_, distances_, eastwards(starts), seed),
      seed_(seed),
      task_of_(starts.size(), -1),
      since_(starts.size(), 0),
      cost_then_(starts.size(), 0),
      busy_steps_(starts.size(), 0),
      actions_(starts.size()) {
  if (errands_.empty()) throw std::invalid_argument("errands: no task; expected at least one");
  for (const auto& vertices : errands_) {
    if (vertices.empty()) throw std::invalid_argument("errands: a task without a vertex; expected at least one");
  }
  reveal();
}

void LifelongErrands::advance() {
  require_tables();
  assign();
  const std::vector<int> by_priority = order();
  moves_.plan(aims(by_priority), by_priority, limits_.checks);
  for (int robot = 0; robot < robots(); ++robot) {
    actions_[robot] += TurningOperations::action(moves_.states()[robot], moves_.next(robot));
    busy_steps_[robot] += task_of_[robot] >= 0;
  }
  moves_.advance();
  ++step_;
  visit();
  reveal();
}

int LifelongErrands::impossible() const {
  std::vector<char> has_robot(grid_.size(), false);  // by part
  for (const int state : moves_.states()) has_robot[grid_.part(TurningGrid::vertex_of(state))] = true;
  return static_cast<int>(std::count_if(open_.begin(), open_.end(), [&](int task) {
    const int part = grid_.part(errands(task)[0]);
    return !has_robot[part] || std::any_of(errands(task).begin(), errands(task).end(),
                                           [&](int vertex) { return grid_.part(vertex) != part; });
  }));
}

int LifelongErrands::goal_of(int robot) const {
  return task_of_[robot] < 0 ? TurningGrid::kNone : errands(task_of_[robot])[visited(robot)];
}

int LifelongErrands::cost_to_goal(int robot) const {
  return distances_.to_goal(goal_of(robot), moves_.states()[robot]);
}

void LifelongErrands::reveal() {
  while (open_.size() < most_revealed_) {
    open_.push_back(static_cast<int>(tasks_.size()));
    tasks_.push_back({step_});
  }
}

// Of what robots go to first, then of what tasks begin with, then of all the rest.
void LifelongErrands::require_tables() {
  std::vector<int> goals;
  for (int robot = 0; robot < robots(); ++robot) {
    if (task_of_[robot] >= 0) goals.push_back(goal_of(robot));
  }
  for (const int task : open_) goals.push_back(errands(task)[tasks_[task].visited]);
  for (const int task : open_) {
    const auto& vertices = errands(task);
    goals.insert(goals.end(), vertices.begin() + tasks_[task].visited + 1, vertices.end());
  }
  distances_.require(goals, std::max<std::int64_t>(1, limits_.states / (4 * grid_.size())), limits_.threads);
}

void LifelongErrands::assign() {
  std::vector<int> free_robots, free_tasks;
  for (int robot = 0; robot < robots(); ++robot) {
    if (task_of_[robot] < 0 || visited(robot) == 0) free_robots.push_back(robot);
  }
  for (const int task : open_) {
    if (tasks_[task].visited == 0) free_tasks.push_back(task);
  }
  const bool are_few = static_cast<std::int64_t>(free_robots.size() * free_tasks.size()) <= limits_.optimal_pairs;
  are_few ? assign_cheapest(free_robots, free_tasks) : assign_in_turn(free_robots, free_tasks);
}

void LifelongErrands::assign_cheapest(std::span<const int> robots, std::span<const int> tasks) {
  const std::vector<int> within = costs_within(tasks);
  std::vector<int> costs;
  costs.reserve(robots.size() * tasks.size());
  for (const int robot : robots) {
    for (std::size_t k = 0; k < tasks.size(); ++k) costs.push_back(assignment_cost(robot, tasks[k], within[k]));
  }
  const std::vector<int> columns =
      cheapest_assignment(costs, static_cast<int>(robots.size()), static_cast<int>(tasks.size()));
  for (std::size_t k = 0; k < robots.size(); ++k) {
    const bool is_possible = columns[k] >= 0 && costs[k * tasks.size() + columns[k]] < kNoTask;
    give(robots[k], is_possible ? tasks[columns[k]] : -1);
  }
}

// Robots keep their tasks; those without one take the cheapest one after another. Those for which no comparisons are
// left take one in a later step.
void LifelongErrands::assign_in_turn(std::span<const int> robots, std::span<const int> tasks) {
  std::vector<int> free(tasks.begin(), tasks.end());
  std::erase_if(free, [&](int task) { return tasks_[task].robot >= 0; });
  const std::vector<int> within = costs_within(free);
  std::int64_t pairs = limits_.pairs;
  for (const int robot : robots) {
    if (task_of_[robot] >= 0) continue;
    if ((pairs -= static_cast<std::int64_t>(free.size())) < 0) return;
    int best = -1, least = kNoTask;
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (tasks_[free[k]].robot >= 0) continue;
      const int cost = assignment_cost(robot, free[k], within[k]);
      if (cost >= least) continue;
      least = cost;
      best = free[k];
    }
    give(robot, best);
  }
}

// From the first to the last vertex of each task.
std::vector<int> LifelongErrands::costs_within(std::span<const int> tasks) const {
  std::vector<int> costs;
  for (const int task : tasks) {
    const auto& vertices = errands(task);
    int sum = 0;
    for (std::size_t k = 1; k < vertices.size(); ++k)
      sum = std::min(kNoTask, sum + distances_.to_goal(vertices[k], 4 * vertices[k - 1]));
    costs.push_back(sum);
  }
  return costs;
}

int LifelongErrands::assignment_cost(int robot, int task, int cost_within) const {
  const int to_start = distances_.to_goal(errands(task)[0], moves_.states()[robot]);
  if (to_start >= kNoTask || cost_within >= kNoTask) return kNoTask;
  return kToStart * to_start + cost_within - (task_of_[robot] == task ? kKeep : 0);
}

void LifelongErrands::give(int robot, int task) {
  if (task_of_[robot] == task) return;
  if (task_of_[robot] >= 0 && tasks_[task_of_[robot]].robot == robot) tasks_[task_of_[robot]].robot = -1;
  task_of_[robot] = task;
  assignments_.push_back({step_, robot, task});
  if (task < 0) return;
  tasks_[task].robot = robot;
  begin_goal(robot);
}

void LifelongErrands::begin_goal(int robot) {
  since_[robot] = step_;
  cost_then_[robot] = cost_to_goal(robot);
}

// Robots by priority: those near to their goals first, earlier by a random part of what they were delayed on their way.
// The part changes from time to time, so that of two that block each other now this one comes first, now that one.
std::vector<int> LifelongErrands::order() const {
  std::vector<double> keys(robots(), std::numeric_limits<double>::infinity());
  for (int robot = 0; robot < robots(); ++robot) {
    if (task_of_[robot] < 0) continue;
    const int cost = cost_to_goal(robot);
    const int delay = HeadingDistances::kStep * (step_ - since_[robot]) - (cost_then_[robot] - cost);
    const std::uint64_t period = (step_ + robot % 7) / kSamePriority;
    Random random(seed_ + (static_cast<std::uint64_t>(robot) << 32) + period);
    keys[robot] = cost - random.uniform() * std::max(0, delay);
  }
  std::vector<int> robots_by_key(keys.size());
  std::iota(robots_by_key.begin(), robots_by_key.end(), 0);
  std::stable_sort(robots_by_key.begin(), robots_by_key.end(), [&](int a, int b) { return keys[a] < keys[b]; });
  return robots_by_key;
}

// The weights of robots fall with the square of their rank.
std::vector<Aim> LifelongErrands::aims(std::span<const int> order) const {
  static constexpr std::int64_t kMostWeight = 1000;
  std::vector<Aim> found(robots());
  for (std::int64_t rank = 0; rank < robots(); ++rank) {
    const int robot = order[rank];
    if (task_of_[robot] < 0) continue;
    const auto& vertices = errands(task_of_[robot]);
    const std::size_t next = visited(robot) + 1;
    const std::int64_t left = robots() - rank, all = robots();
    Aim& aim = found[robot];
    aim.goal = goal_of(robot);
    aim.weight = 1 + kMostWeight * left * left / (all * all);
    // The vertex after the goal matters only if an operation reaches the goal.
    const int vertex = TurningGrid::vertex_of(moves_.states()[robot]);
    if (next == vertices.size() || grid_.manhattan(vertex, aim.goal) > kOperationSteps) continue;
    aim.next = vertices[next];
    aim.cost_between = distances_.to_goal(aim.next, 4 * aim.goal);
  }
  return found;
}

// Robots that are at the next vertex of their task have visited it: one vertex a step.
void LifelongErrands::visit() {
  for (int robot = 0; robot < robots(); ++robot) {
    if (TurningGrid::vertex_of(moves_.states()[robot]) != goal_of(robot)) continue;
    const int number = task_of_[robot];
    Task& task = tasks_[number];
    ++task.visited;
    events_.push_back({step_, robot, number, task.visited});
    if (task.visited < static_cast<int>(errands(number).size())) {
      begin_goal(robot);
      continue;
    }
    ++finished_;
    task_of_[robot] = -1;
    std::erase(open_, number);
  }
}

}  // namespace muster
