#include "plans/or_opt.hpp"

namespace muster {

bool OrOpt::improve(int task) {
  const int robot = team_.robot_of(task);
  for (const bool forward : {true, false}) {
    int first = task, last = task;
    for (int length = 1; length <= kLongest; ++length) {
      if (length > 1) {
        int& more = forward ? last : first;
        more = forward ? team_.next(more) : team_.prev(more);
        if (!team_.is_task(more) || team_.fixed(more)) break;
      } else if (!forward) {
        continue;
      }
      const int before = team_.prev(first), on = team_.next(last);
      Row row{robot, first, last, length, 0.0, 0.0};
      row.saved = team_.way(first) + team_.way(on) - way(robot, before, on);
      row.inside = inside(row, robot, false);
      if (improve(task, row)) return true;
    }
  }
  return false;
}

// The task, at one end of the row, comes to lie beside one that is near.
bool OrOpt::improve(int task, const Row& row) {
  const bool leads = row.first == task, ends = row.last == task;
  const bool prune = !(around_.cost.sees_greatest() && around_.cost.is_greatest(row.robot));
  for (const int near : around_.near(task)) {
    if (prune && way(row.robot, task, near) >= row.saved) break;
    if (!team_.present(near) || contains(row, near)) continue;
    if (put(row, near, !leads)) return true;
    if (put(row, team_.prev(near), !ends)) return true;
  }
  return false;
}

bool OrOpt::put(const Row& row, int after, bool turned) {
  if (contains(row, after) || after == team_.prev(row.first) || !around_.open(after)) return false;
  if (turned && !problem_.is_symmetric()) return false;
  const int to = team_.robot_of(after), on = team_.next(after);
  const int head = turned ? row.last : row.first, tail = turned ? row.first : row.last;
  const double added = way(to, after, head) + way(to, tail, on) - team_.way(on);
  if (to == row.robot ? !around_.gains(added - row.saved) : !gains(row, to, turned, added)) return false;
  const int before = team_.prev(row.first), behind = team_.next(row.last);
  if (turned) team_.reverse(row.first, row.last);
  team_.move(head, tail, after);
  return around_.changed(before, behind, head, tail, after, on);
}

// Whether it pays that another robot does the row.
bool OrOpt::gains(const Row& row, int robot, bool turned, double added) const {
  if (!allowed(row, robot)) return false;
  const double growth = added + inside(row, robot, turned), less = -row.saved - row.inside;
  return around_.fits(robot, growth) && around_.gains(around_.cost.change(row.robot, less, robot, growth));
}

bool OrOpt::contains(const Row& row, int place) const {
  for (int each = row.first;; each = team_.next(each)) {
    if (each == place) return true;
    if (each == row.last) return false;
  }
}

double OrOpt::inside(const Row& row, int robot, bool turned) const {
  double sum = problem_.work_usage(robot, row.first);
  for (int each = row.first; each != row.last; each = team_.next(each)) {
    const int next = team_.next(each);
    sum += (turned ? way(robot, next, each) : way(robot, each, next)) + problem_.work_usage(robot, next);
  }
  return sum;
}

bool OrOpt::allowed(const Row& row, int robot) const {
  for (int each = row.first;; each = team_.next(each)) {
    if (!problem_.allowed(robot, each)) return false;
    if (each == row.last) return true;
  }
}

}  // namespace muster
