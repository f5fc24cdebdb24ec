#include "plans/part_exchange.hpp"

namespace muster {

bool PartExchange::improve(int task) {
  const int robot = team_.robot_of(task);
  return reached_anew(robot, task) || left_anew(robot, task);
}

// The task is reached from one that is near, and another way is cut near the other end.
bool PartExchange::reached_anew(int robot, int task) {
  for (const int near : around_.near(task)) {
    const double gain = team_.way(task) - way(robot, near, task);
    if (gain <= 0.0) break;
    if (team_.robot_of(near) != robot) continue;
    const int behind = team_.next(near);
    if (!team_.is_task(behind)) continue;
    const bool later = team_.before(task, near);
    for (const int other : around_.near(behind)) {
      if (team_.robot_of(other) != robot) continue;
      if (gain + team_.way(behind) - way(robot, other, behind) <= 0.0) break;
      if (later) {
        // task .. other | .. near | behind
        if (team_.before(other, task) || !team_.before(other, near)) continue;
        if (exchange(robot, task, team_.next(other), near)) return true;
      } else {
        // other | .. near | behind .. | task
        if (!team_.before(other, near)) continue;
        if (exchange(robot, team_.next(other), behind, team_.prev(task))) return true;
      }
    }
  }
  return false;
}

// The task is left to one that is near, and another way is cut near the other end.
bool PartExchange::left_anew(int robot, int task) {
  const int then = team_.next(task);
  for (const int near : around_.near(task)) {
    const double gain = team_.way(then) - way(robot, task, near);
    if (gain <= 0.0) break;
    if (team_.robot_of(near) != robot) continue;
    const int behind = team_.prev(near);
    if (!team_.is_task(behind)) continue;
    const bool later = team_.before(task, near);
    for (const int other : around_.near(behind)) {
      if (team_.robot_of(other) != robot) continue;
      if (gain + team_.way(near) - way(robot, behind, other) <= 0.0) break;
      if (later) {
        // task | then .. behind | near .. | other
        if (!team_.before(near, other)) continue;
        if (exchange(robot, then, near, team_.prev(other))) return true;
      } else {
        // behind | near .. | other .. task | then
        if (!team_.before(near, other) || team_.before(task, other)) continue;
        if (exchange(robot, near, other, task)) return true;
      }
    }
  }
  return false;
}

// first .. | second .. last: the two parts change places.
bool PartExchange::exchange(int robot, int first, int second, int last) {
  const int before = team_.prev(first), middle = team_.prev(second), on = team_.next(last);
  if (!team_.is_task(first) || !team_.is_task(second) || !around_.open(before)) return false;
  const double growth = way(robot, before, second) + way(robot, last, first) + way(robot, middle, on) -
                        team_.way(first) - team_.way(second) - team_.way(on);
  if (!around_.gains(growth)) return false;
  int one = first, other = second;
  while (one != middle && other != last) one = team_.next(one), other = team_.next(other);
  if (one == middle) {
    team_.move(first, middle, last);
  } else {
    team_.move(second, last, before);
  }
  return around_.changed(before, first, middle, second, last, on);
}

}  // namespace muster
