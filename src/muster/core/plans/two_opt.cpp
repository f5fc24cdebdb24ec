#include "plans/two_opt.hpp"

namespace muster {

// The task comes to lie beside one that is near: both before the part that is turned, or both behind it.
bool TwoOpt::improve(int task) {
  const int robot = team_.robot_of(task);
  for (const int near : around_.near(task)) {
    if (team_.robot_of(near) != robot) continue;
    const double there = way(robot, task, near);
    const bool first = team_.before(task, near);
    const bool to_next = there < team_.way(team_.next(task)), to_prev = there < team_.way(task);
    if (!to_next && !to_prev) break;
    if (to_next && turn(robot, team_.next(first ? task : near), first ? near : task)) return true;
    if (to_prev && turn(robot, first ? task : near, team_.prev(first ? near : task))) return true;
  }
  return false;
}

bool TwoOpt::turn(int robot, int first, int last) {
  const int before = team_.prev(first), on = team_.next(last);
  if (first == last || team_.before(last, first) || !around_.open(before)) return false;
  const double growth = way(robot, before, last) + way(robot, first, on) - team_.way(first) - team_.way(on);
  if (!around_.gains(growth)) return false;
  team_.reverse(first, last);
  return around_.changed(before, first, last, on);
}

}  // namespace muster
