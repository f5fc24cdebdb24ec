#include "plans/swap_tasks.hpp"

namespace muster {

// The task comes to lie beside one that is near, where the other is now.
bool SwapTasks::improve(int task) {
  const int robot = team_.robot_of(task);
  for (const int near : around_.near(task)) {
    if (!team_.present(near) || team_.robot_of(near) == robot) continue;
    if (swap(task, team_.next(near)) || swap(task, team_.prev(near))) return true;
  }
  return false;
}

bool SwapTasks::swap(int task, int other) {
  if (!team_.is_task(other) || team_.fixed(other)) return false;
  const int robot = team_.robot_of(task), others = team_.robot_of(other);
  if (!problem_.allowed(others, task) || !problem_.allowed(robot, other)) return false;
  const double here = growth_with(task, other), there = growth_with(other, task);
  if (!around_.gains(around_.cost.change(robot, here, others, there))) return false;
  if (!around_.fits(robot, here) || !around_.fits(others, there)) return false;
  const int before = team_.prev(task), on = team_.next(task);
  const int before_other = team_.prev(other), on_other = team_.next(other);
  team_.move(task, task, other);
  team_.move(other, other, before);
  return around_.changed(task, other, before, on, before_other, on_other);
}

}  // namespace muster
