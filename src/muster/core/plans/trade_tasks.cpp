#include "plans/trade_tasks.hpp"

namespace muster {

// The one left out is near the task: it comes to lie beside it, in its place, or in the place of one beside it.
bool TradeTasks::improve(int task) {
  if (team_.absent().empty()) return false;
  const int robot = team_.robot_of(task);
  for (const int near : around_.near(task)) {
    if (team_.present(near) || !problem_.allowed(robot, near)) continue;
    if (put(near, task) || put(near, team_.prev(task))) return true;
    if (replace(task, near) || replace(team_.next(task), near) || replace(team_.prev(task), near)) return true;
  }
  return false;
}

bool TradeTasks::put(int absent, int after) {
  if (!around_.open(after)) return false;
  const int robot = team_.robot_of(after), on = team_.next(after);
  const double growth = team_.growth(robot, absent, after);
  if (!around_.fits(robot, growth)) return false;
  const double change = around_.cost.change(robot, growth, robot, 0.0);
  if (!around_.gains(change - around_.worth(problem_.priority(absent)))) return false;
  team_.insert(absent, after);
  return around_.changed(after, absent, on);
}

bool TradeTasks::replace(int task, int absent) {
  if (!team_.is_task(task) || team_.fixed(task)) return false;
  const int robot = team_.robot_of(task), before = team_.prev(task), on = team_.next(task);
  const double growth = growth_with(task, absent);
  if (!around_.fits(robot, growth)) return false;
  const double change = around_.cost.change(robot, growth, robot, 0.0);
  const double more = problem_.priority(absent) - problem_.priority(task);
  if (!around_.gains(change - around_.worth(more))) return false;
  team_.remove(task);
  team_.insert(absent, before);
  return around_.changed(before, absent, on);
}

}  // namespace muster
